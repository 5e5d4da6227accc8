"""Film solvers: from gap and rates to pressure and fill.

Module map
----------
film            arrays, links, oil and rupture line of one film; flows at prescribed vertices
answers         matrix, derivatives and flows of a solved film
solver          solution of a film for given gaps
sets            choice of the method if neither gaps nor conductances follow the pressure; pseudo-transient continuation
newton          Newton's method for all films that are not linear
matrix          Newton's matrix, its factor and steps
liner           film on an elastic liner, or with conductances that follow the pressure; dry guess, continuation
winkler         Winkler elements of one film: loads, contact, gaps, mass balances
winkler_kernels kernels of Winkler elements: pressure on them, deflection, gaps, derivatives
impedance_map   fitted map for plain bearings
sor             finite differences and successive over-relaxation
"""
