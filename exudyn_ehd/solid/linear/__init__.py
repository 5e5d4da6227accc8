"""Linear equations of meshes.

Module map
----------
solvers   factors of sparse matrices, equations known by products alone
"""
