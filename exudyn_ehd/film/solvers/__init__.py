"""Film solvers: from gap and rates to pressure and fill.

Module map
----------
film            arrays, links, oil and rupture line of one film; flows at prescribed vertices
answers         its matrix, derivatives and flows
solver          its solution from the gaps
sets            which film is solved how, if neither gaps nor conductances follow its pressure; pseudo time
newton          Newton's method for all films that are not linear
matrix          its matrix, the factor and the steps
liner           film on an elastic liner, or with conductances that follow the pressure
impedance_map   fitted map for plain bearings
sor             finite differences and successive over-relaxation
"""
