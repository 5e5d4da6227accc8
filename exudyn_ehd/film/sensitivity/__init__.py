"""Derivatives of loads.

Module map
----------
rigid         from the balances to the motion of a rigid journal, and the wrench
bore_stencil  from the adjoint film to the elastic bore
"""
