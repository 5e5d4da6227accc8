"""Flexible bush as an object of Exudyn.

Module map
----------
object     CreateFlexibleBush
equations  its forces, matrices and Jacobians, and what Exudyn asks of it
rigid_part what its housing has of it
linear     the factor of a system with bushes
"""
