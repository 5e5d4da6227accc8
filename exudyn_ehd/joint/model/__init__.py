"""Model of a bearing.

Module map
----------
build      model from a description, turning journals; kernels compiled before the first step
rigid      rigid journal in a rigid bore; one-sided derivatives at the exact centre
flexible   elastic bore
impedance  fitted map
effects    what an effect must offer, and the only place that asks which are present; grid, solver and buffers
loads      integrals of pressure and shear, and the wrench
results    scalars and fields of a state
"""
