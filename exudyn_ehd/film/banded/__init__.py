"""Banded factors.

Module map
----------
workspace     buffers of a film; matrices in them from the derivatives of flows between vertices
factors       numbering of unknowns on a ring of columns, cut or folded; blocked L D L^T of symmetric matrices;
              L U without pivoting of the others; vectors of four numbers
substitution  solutions with both factors: few right-hand sides as rows, dozens as columns
"""
