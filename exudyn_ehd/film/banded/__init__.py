"""Banded factors.

Module map
----------
ldl        symmetric matrices: blocked L D L^T, folded ring
lu         non-symmetric matrices, without pivoting
columns    many right-hand sides side by side
tiles      the same in tiles
"""
