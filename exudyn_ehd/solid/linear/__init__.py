"""Linear equations of meshes.

Module map
----------
supernodal  substitutions with the factor of a symmetric matrix, by dense panels
"""
