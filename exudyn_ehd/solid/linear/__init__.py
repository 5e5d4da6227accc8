"""Linear equations of meshes.

Module map
----------
triplets  sparse matrices from triplets whose places stay
solvers   factors of sparse matrices, equations known by products alone
"""
