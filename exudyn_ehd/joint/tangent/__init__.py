"""Derivatives of a film's wrench to the motion.

Module map
----------
wrench  rigid bore; derivatives to the true gap
bore    flexible bore: wrench and loads on its shapes
nodes   flexible bore: wrench and forces of pressure and shear on its nodes, which balance the wrench
plain   plain films: all in one kernel
"""
