"""A ball in its socket as a pure function of its motion.

Module map
----------
bearing  `SphericalBearing`, the description of a ball joint; film grid of a patch of a sphere
film     one film: gap, loads on the ball, heat
model    evaluations, steady film, exact tangent
steady   film at a prescribed position; audit of a ball joint
"""
