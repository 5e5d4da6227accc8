"""Elastic bore.

Module map
----------
shapes       displacement of the bore on the film's grid; transfer between its vertices and the faces of the bore
equilibrium  bore in balance with its film
solid        the same for the mesh of a nodal bush, at any strain
"""
