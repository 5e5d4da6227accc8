"""Motion of the two sides of a joint.

Module map
----------
sides          pose, rates and Jacobians of a side
rigid_nodes    nodes of rigid bodies
beam_sides     points of beams and cables
floating_body  equations of motion of a body in a floating frame with modes
fitted_sides   best rigid fit of the nodes of finite elements
relative       motion of the journal in the housing's frame
spherical      motion of a ball in the frame of its socket
bore_gap       smallest gap of the rigid surfaces
axial          place of the journal along its bearing's axis
"""
