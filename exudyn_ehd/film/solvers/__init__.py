"""Film solvers: from gap and rates to pressure and fill.

Module map
----------
linear          linear for given sets: rigid surfaces, incompressible
edge_flows      flows at prescribed vertices, where films end within a link
newton          rules of Newton's method for films on liners or with conductances that follow the pressure
answers         adjoints and small changes by the matrix of a solution
compiled        the driver compiled as a whole, for plain liners
steps           their matrix, steps and sets
nonlinear       film on an elastic liner, with contact, laws of the oil and density
liner           what it is made of
thinning        conductances that follow the pressure, on rigid surfaces; density with a rupture line in the cells
compressible    density that follows the pressure, between rigid surfaces
impedance_map   fitted map for plain bearings
sor             finite differences and successive over-relaxation
"""
