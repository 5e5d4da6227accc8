"""Elastic journals: cylinders whose surface gives way under the film.

Module map
----------
description  what a scene writes: `ElasticJournal` and where its body holds it
harmonics    finite elements of a cylinder, wave by wave around it
modes        a journal reduced to modes of its surface under the film
turning      a finite-element body's own modes, which turn under the film: `FEJournal`
"""
