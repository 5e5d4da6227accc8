"""Elastic bore.

Module map
----------
shapes       displacement of the bore on the film's grid; transfer between the grid's vertices and the bore's faces
equilibrium  bore in balance with its film
solid        mesh of a nodal bush in balance with its film, at any strain
"""
