"""Flow through the film.

Module map
----------
gap         gap of a rigid journal in its bore, additional gap terms, steps; derivatives of sums over a film to the gap
links       conductance, carrier, effects on them; flows out of a cavity over a step
balance     right-hand side; mass balance with fill and density; derivatives, also of flows to gaps and speeds
turbulence  NgPan, Hirs
"""
