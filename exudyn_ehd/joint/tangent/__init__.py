"""Derivatives of the wrench.

Module map
----------
wrench     rigid bore; one-sided ones of films that rupture as soon as they move
bore       flexible bore: wrench and loads on its shapes
nodes      flexible bore: wrench and forces on its nodes, pressure and shear; a wrench carried by them
true_gap   derivatives to the true gap: drag of unlike surfaces, rupture line in the cells
"""
