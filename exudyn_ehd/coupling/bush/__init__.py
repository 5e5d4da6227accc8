"""Flexible bush as an object of Exudyn.

Module map
----------
object     CreateFlexibleBush
functions  what Exudyn asks of it
equations  its forces, matrices and Jacobians
rigid_part  what its housing has of it
residual   of a system with bushes
factor     of the iteration matrix of a system with bushes
recycled   linear equations with a film's operator
"""
