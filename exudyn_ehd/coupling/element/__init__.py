"""Film as an object of Exudyn.

Module map
----------
attach          from a joint's description to its element and films on end faces; initial equilibrium of bores
rigid           `FilmElement`: user functions for the film of a rigid bore, and films on end faces
accepted_steps  accepted steps: record, memory, checks, continuation of runs
failures        error messages of films that end a run
nodal           film elements on bores with nodes or modes
outer_load      load on a film by the rest of the system, with loads that are functions of time
outputs         drawing in Exudyn's renderer, Exudyn sensors
"""
