"""Film solvers: from gap and rates to pressure and fill.

Module map
----------
film            arrays, links, oil and rupture line of one film
answers         its matrix, derivatives and flows
solver          its solution from the gaps
liner           its part on an elastic liner, or with conductances that follow the pressure
edge_flows      flows at prescribed vertices, where films end within a link
impedance_map   fitted map for plain bearings
sor             finite differences and successive over-relaxation
"""
