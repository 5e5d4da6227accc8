"""Flow through the film.

Module map
----------
gap               gap of a rigid journal in its bore; slopes of additional gap terms; gaps with steps
links             conductance, carrier, right-hand side; effects on them; flows out of a cavity, averaged over the step
balance           mass balance with fill and density, and its derivatives
link_derivatives  derivatives of the flow through a link to gaps and speeds
turbulence        NgPan, Hirs
"""
