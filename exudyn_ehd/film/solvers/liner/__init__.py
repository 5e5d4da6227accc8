"""A film on an elastic liner, whose gap yields to its pressure.

Module map
----------
elements      Winkler elements: pressure on them, deflection
gap_response  derivatives of flows over gaps that follow the pressure
kernels       balance as kernels
film          the film on them: gaps, links, balance, derivatives
line          its edge inside the cells
line_kernels  the same in steps of Newton's method
balance       the film as Newton's method sees it
newton        the driver of Newton's method
continuation  dry guess and pseudo time
parts         contact, gap limiter and oil, as the elements take them
"""
