"""Derivatives of loads.

Module map
----------
rigid            from the balances to the motion of a rigid journal, and the wrench
mirror_symmetry  even and odd halves of the film
bore_stencil     from the adjoint film to the elastic bore
"""
