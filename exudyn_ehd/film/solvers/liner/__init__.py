"""Film on an elastic liner, whose gap follows the pressure.

Module map
----------
elements      kernels of Winkler elements: pressure on them, deflection, gaps, derivatives
winkler       elements of one film: loads, contact, gaps, mass balances
film          film on the elements: links, mass balances, derivatives, dry guess, continuation
line          rupture line inside the cells
"""
