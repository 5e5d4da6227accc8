"""Items of a system that a joint connects.

Module map
----------
resolve         item numbers: bodies, nodes and markers
item            what becomes of one
bodies          nodes and bodies
markers         rigid markers
joint_frame     where the joint is
beams           beams and cables
reduced_bodies  reduced finite-element bodies
own_equations   their equations with an exact Jacobian
meshes          finite elements in absolute coordinates
carrier         what carries a bush
object_mass     mass of an object
axial           axial freedom
"""
