"""Cost of options in time.

Module map
----------
effects  effects, closures and reduced films over the plain film
bushes   bores in a run, the film's Jacobian, assembly of elements
growth   cost over grid, modes and joints
once     what is paid once: kernels, maps, modes
"""
