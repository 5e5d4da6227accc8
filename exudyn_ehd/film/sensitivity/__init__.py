"""Derivatives of loads.

Module map
----------
mirror_symmetry  even and odd halves of the film
bore_stencil     from the adjoint film to the elastic bore
"""
