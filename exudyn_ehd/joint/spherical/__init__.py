"""A ball in its socket as a pure function of its motion.

Module map
----------
bearing  `SphericalBearing`, the description of a ball joint; film grid of a patch of a sphere
model    gap, loads, heat, evaluations, steady film and exact tangent of one film
steady   film at a prescribed position; audit of a ball joint
"""
