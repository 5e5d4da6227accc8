"""What a running solver does.

Module map
----------
solver_state  which solver runs, with which step
step_control  steps that follow the film
chatter       warnings about alternating forces
"""
