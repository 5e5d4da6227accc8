"""Prescribed positions and loads.

Module map
----------
solve_film          film in any gap
steady              prescribed position; films on the end faces there
equilibrium         position under a load, the steadiest of several; stiffness and damping
pads                tilting pads: description, film of one pad
pad_equilibrium     journal and tilting pads under a load; stiffness and damping of both
dynamic_stiffness   both at any frequency, for films that remember their oil and between surfaces that yield
thrust_pads         film and tilts of thrust pads under an axial load; stiffness and damping with pads that follow
stribeck            friction over speed
"""
