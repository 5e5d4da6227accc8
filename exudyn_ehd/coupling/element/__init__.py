"""Film as an object of Exudyn.

Module map
----------
attach         from a joint's description to its element
rigid          rigid bore
modal          bore by modes
modal_inertia  inertia of the modes
nodal          bore by nodes
"""
