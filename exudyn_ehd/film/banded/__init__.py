"""Banded factors.

Module map
----------
numbering     unknowns on a ring of columns: cut or folded
workspace     every buffer of a film
lanes         vectors of four neighbouring numbers
ldl           symmetric matrices: blocked L D L^T
assemble      matrices from the derivatives of flows between vertices
lu            non-symmetric matrices, without pivoting
substitution  a handful of right-hand sides, for both factors
many_sides    dozens of them, as columns
"""
