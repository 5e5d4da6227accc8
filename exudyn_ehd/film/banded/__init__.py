"""Banded factors.

Module map
----------
numbering     unknowns on a ring of columns: cut or folded
workspace     every buffer of a film
factors       symmetric matrices: blocked L D L^T; non-symmetric ones: L U without pivoting; vectors of four numbers
assemble      matrices from the derivatives of flows between vertices
substitution  right-hand sides for both factors: a handful as rows, dozens as columns
"""
