"""Flexible bush as an object of Exudyn.

Module map
----------
object     CreateFlexibleBush
equations  its forces, matrices and Jacobians, what Exudyn asks of it, and what its housing has of it
"""
