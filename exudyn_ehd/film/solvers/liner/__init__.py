"""Film on an elastic liner, whose gap follows the pressure.

Module map
----------
elements      their kernels: pressure on them, deflection, gaps, derivatives
gap_response  derivatives of the links' flows over gaps that follow the pressure
kernels       mass balances as kernels
winkler       the elements of one film: loads, contact, gaps
film          film on the elements: links, mass balances, derivatives, Newton's method
line          rupture line inside the cells
line_kernels  kernels of the rupture line
steps         Newton steps, from one residual to the next
continuation  dry guess and pseudo-transient continuation
"""
