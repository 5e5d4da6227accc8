"""Flow through the film.

Module map
----------
gap         gap of a rigid journal in its bore, additional gap terms, steps; derivatives of sums over a film to the gap
links       conductance, carrier, right-hand side; effects on them; flows out of a cavity, averaged over the step
balance     mass balance with fill and density, its derivatives, and those of a link's flow to gaps and speeds
turbulence  NgPan, Hirs
"""
