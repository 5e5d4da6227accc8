"""Supervision of a running solver.

Module map
----------
solver_state  which solver runs, with which step; implicit steps too coarse for a film, rejected
long_steps    explicit steps beyond their stability limit; meshes on absolute coordinates that turn too far in a step
poor_films    films that run dry, are thinner than the surfaces are rough, or carry too little; a run in one line
"""
