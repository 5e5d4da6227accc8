"""A ball in its socket as a pure function of its motion.

Module map
----------
bearing  `SphericalBearing`, what a scene writes; the film grid of a patch of a sphere
film     one film: gaps, solution, loads on the ball, heat
model    evaluations, what a film remembers, exact tangent
steady   prescribed position; audit: what mattered in its films, and what they leave out
"""
