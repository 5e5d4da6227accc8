"""Linear equations of meshes.

Module map
----------
triplets     sparse matrices from triplets whose places stay
tree         what a symmetric pattern's factor looks like
elimination  the factor of a symmetric matrix, by fronts
supernodal   substitutions with it, in dense panels
gmres        equations known by products alone
"""
