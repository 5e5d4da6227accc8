"""Items of a system that a joint connects.

Module map
----------
bodies          what becomes of an item number; nodes and bodies
markers         rigid markers; the best rigid fit of nodes of finite elements; item numbers of any kind
joint_frame     where the joint is, and what is held of its axial freedom
beams           beams and cables
reduced_bodies  reduced finite-element bodies; what carries a bush
bush            a nodal bush as an object of a model
bush_equations  its equations of motion
objects         whose user functions an object has, its mass; equations of reduced bodies with an exact Jacobian
"""
