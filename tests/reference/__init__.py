"""Closed forms to compare with: small functions of floats, one module per topic.

long_bearing   infinitely long journal bearing, full and half Sommerfeld condition
short_bearing  Ocvirk's short bearing: load, stiffness, damping, whirl threshold, pure squeeze
petroff        concentric journal: friction torque and power
slider         plane slider of infinite width; axial flow through a conical gap
elastic_rings  Lamé's cylinder under pressure; thin ring under two opposite forces

Angles in radians, SI units; ``eps`` is the eccentricity ratio e/c, ``So = F psi^2 / (L D mu omega)`` the Sommerfeld
number, attitude angles count from the load to the eccentricity in the sense of rotation.
"""
