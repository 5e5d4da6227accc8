"""Motion of the two sides of a joint.

Module map
----------
sides        pose, rates and Jacobians of a side
rigid_nodes  nodes of rigid bodies
beam_sides   points of beams
cables       points of cables
relative     motion of the journal in the housing's frame
"""
