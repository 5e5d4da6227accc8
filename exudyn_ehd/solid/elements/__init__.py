"""The elements of a bush and what is common to them; kernels take them as arrays.

Module map
----------
element   `Element`, what a kind is described by; `Quadrature`
shapes    cells, shape functions of simplices
faces     kinds of element faces: shape functions, quadratures, outlines
hex20     the 20-node hexahedron
tet10     the 10-node tetrahedron
kinds     which element a connectivity has; its boundary
kernels   compiled laws of the materials and loops over elements: the tangent
blocks    force of a mesh and the least volume ratio, by blocks of elements
"""
