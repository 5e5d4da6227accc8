"""What a running solver does.

Module map
----------
solver_state  which solver runs, with which step
step_control  implicit steps too coarse for a film, rejected
chatter       explicit steps beyond their stability limit, recognised
starvation    films that run dry, recognised
thin_films    films thinner than the surfaces are rough
tiny_forces   films that carry less than Newton's tolerance
periodic      runs that end when their orbits have closed
run_progress  how far a run is, where somebody looks
turning_meshes  finite elements on absolute coordinates that turn too far in a step
"""
