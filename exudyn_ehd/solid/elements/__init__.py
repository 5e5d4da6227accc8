"""The elements of a bush and what is common to them; kernels take them as arrays.

Module map
----------
element   `Element`, what describes a kind; `Quadrature`; cells, their shape functions, points in them; kinds of faces;
          the 20-node hexahedron and the 10-node tetrahedron; which element a connectivity has
kernels   compiled laws of the materials and loops over elements: the tangent
blocks    force of a mesh and the least volume ratio, by blocks of elements
"""
