"""Banded factors.

Module map
----------
numbering     numbering of unknowns on a ring of columns, which is cut or folded
workspace     buffers of a film
factors       symmetric matrices: blocked L D L^T; non-symmetric ones: L U without pivoting; vectors of four numbers
assemble      matrices from the derivatives of flows between vertices
substitution  solutions with both factors: few right-hand sides as rows, dozens as columns
"""
