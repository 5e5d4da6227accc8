"""Derivatives of the wrench.

Module map
----------
wrench     rigid bore
bore       flexible bore: wrench and loads on its shapes
nodes      flexible bore: wrench and forces on its nodes, pressure and shear
spread     a wrench carried by the nodes
drag       pull of the pressure gradient on two unlike surfaces
one_sided  of films that rupture as soon as they move
line       rupture line in the cells: derivatives to the true gap
"""
