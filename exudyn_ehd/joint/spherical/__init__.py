"""A ball in its socket as a pure function of its motion.

Module map
----------
bearing  `SphericalBearing`, what a scene writes; the film grid of a patch of a sphere
model    loads on the ball and their exact tangent
steady   prescribed position; audit: what mattered in its films, and what they leave out
"""
