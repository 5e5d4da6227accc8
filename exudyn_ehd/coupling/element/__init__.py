"""Film as an object of Exudyn.

Module map
----------
attach          from a joint's description to its element and films on end faces; bores in balance at the start
rigid           `FilmElement`: user functions for the film of a rigid bore, and those on end faces
accepted_steps  what was accepted: record, memory, watches, runs that go on
failures        messages of films that can't go on
nodal           bore by nodes or by modes
outer_load      load on a film from everything else, also of functions of time
outputs         drawing in Exudyn's renderer, Exudyn sensors
"""
