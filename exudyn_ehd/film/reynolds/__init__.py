"""Flow through the film.

Module map
----------
gap               rigid journal in its bore
links             conductance, carrier, right-hand side; effects on them
balance           mass balance with fill and density, and its derivatives
lagging_void      flows out of a cavity, averaged over the step
link_derivatives  derivatives of the flow through a link, and their sums with adjoint solutions
stepped_gap       gaps with steps
turbulence        NgPan, Hirs
"""
