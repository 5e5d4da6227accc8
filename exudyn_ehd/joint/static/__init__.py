"""Films at prescribed positions and under loads, without a multibody model.

Module map
----------
solve_film          film in any given gap
steady              film at a prescribed position; films on the end faces there
equilibrium         position under a load, the steadiest of several; stiffness and damping
pads                tilting pads: description, film of one pad
pad_equilibrium     journal and tilting pads under a load; stiffness and damping of both
dynamic_stiffness   stiffness and damping at any frequency, for films with a memory and for flexible surfaces
thrust_pads         film and tilts of thrust pads under an axial load; stiffness and damping with pads that tilt
stribeck            friction over speed
"""
