"""Derivatives of the wrench.

Module map
----------
wrench  rigid bore; derivatives to the true gap
bore    flexible bore: wrench and loads on its shapes
nodes   flexible bore: wrench and forces on its nodes, pressure and shear; a wrench carried by them
"""
