"""Film solvers: from gap and rates to pressure and fill.

Module map
----------
linear         linear for given sets: rigid surfaces, incompressible
liner          film on a liner
compliant      gap that yields to the pressure, with contact and laws
compressible   density that follows the pressure
impedance_map  fitted map for plain bearings
sor            finite differences and successive over-relaxation
"""
