"""Motion of the two sides of a joint.

sides            pose, rates and Jacobians of a side; loads between two
rigid_nodes      nodes of rigid bodies
flexible_bodies  points of beams and cables; equations of motion of a body in a floating frame with modes
relative         motion of a journal or a ball in the housing's frame, place along the axis, smallest gap
"""
