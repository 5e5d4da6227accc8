"""Items of a system that a joint connects.

Module map
----------
bodies          resolution of item numbers; nodes and bodies
markers         rigid markers; the best rigid fit of nodes of finite elements; item numbers of any kind
joint_frame     position and frame of the joint; constraint of the option `Held`
beams           beams and cables
reduced_bodies  reduced finite-element bodies; what carries a bush
bush            a nodal bush as an object of a model
bush_equations  equations of motion of a nodal bush
objects         owner of an object's user functions, its mass; equations of reduced bodies with an exact Jacobian
"""
