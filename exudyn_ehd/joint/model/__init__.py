"""Model of a bearing.

Module map
----------
build           model from a description; its kernels compiled before the first step
build_flexible  the same for flexible bushes
rigid           rigid journal in a rigid bore
centre          one-sided derivatives at the exact centre
flexible        elastic bore
impedance       fitted map
effects         the only place that asks whether an effect is present; grid, solver and buffers
loads           pressure and viscosity by the oil's laws; integrals and wrench
quantities      scalars of a state
fields          fields of a state
"""
