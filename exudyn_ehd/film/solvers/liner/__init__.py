"""Film on an elastic liner, whose gap follows the pressure.

Module map
----------
elements      Winkler elements: pressure on them, deflection, gaps, derivatives
gap_response  derivatives of the links' flows over gaps that follow the pressure
kernels       mass balances as kernels
film          film on the elements: gaps, links, mass balances, derivatives
line          rupture line inside the cells
line_kernels  kernels of the rupture line
steps         Newton steps, from one residual to the next
balance       Newton's method: a film as `steps` takes it
continuation  dry guess and pseudo-transient continuation
parts         contact, gap limiter and oil laws of a film
"""
