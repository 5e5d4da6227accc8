"""Derivatives of the wrench.

Module map
----------
wrench  rigid bore
bore    flexible bore: wrench and loads on its shapes
nodes   flexible bore: wrench and forces on its nodes, pressure and shear
spread  a wrench carried by the nodes
drag    pull of the pressure gradient on two unlike surfaces
fields  from sensitivities of the gap to the motion
"""
