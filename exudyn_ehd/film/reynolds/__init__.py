"""Flow through the film.

Module map
----------
gap               rigid journal in its bore; gaps with steps
links             conductance, carrier, right-hand side; effects on them; flows out of a cavity, averaged over the step
balance           mass balance with fill and density, and its derivatives
link_derivatives  derivatives of the flow through a link, and their sums with adjoint solutions
turbulence        NgPan, Hirs
"""
