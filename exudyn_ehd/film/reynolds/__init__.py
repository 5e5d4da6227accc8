"""Flow through the film.

Module map
----------
gap               rigid journal in its bore
links             conductance, carrier, right-hand side; effects on them
balance           mass balance with fill and density, and its derivatives
link_derivatives  derivatives of the flow through a link, and their sums with adjoint solutions
stepped_gap       gaps with steps
turbulence        NgPan, Hirs
"""
