"""Prescribed positions and loads.

Module map
----------
solve_film          film in any gap
steady              prescribed position
steady_temperature  its temperature
equilibrium         position under a load, stiffness and damping
stribeck            friction over speed
"""
