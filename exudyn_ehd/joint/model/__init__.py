"""Model of a bearing.

Module map
----------
build     model from a description; turning journals, impedance maps; compilation of kernels before the first step
rigid     rigid journal in a rigid bore; one-sided derivatives at the exact centre
flexible  flexible bore, flexible journal or both
effects   protocols of effects; effects of a description, the only place that checks for options; grid, solver, buffers
loads     integrals of pressure and shear, and the wrench
results   scalars and fields of a state
"""
