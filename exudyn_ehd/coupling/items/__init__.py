"""Items of a system that a joint connects.

Module map
----------
item            what becomes of an item number
bodies          nodes and bodies
markers         rigid markers, those on finite elements in absolute coordinates too; item numbers of any kind
joint_frame     where the joint is, and what is held of its axial freedom
beams           beams and cables
reduced_bodies  reduced finite-element bodies
own_equations   their equations with an exact Jacobian
carrier         what carries a bush
object_mass     mass of an object
"""
