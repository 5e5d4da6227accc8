"""Elastic journals: cylinders whose surface gives way under the film.

Module map
----------
harmonics    finite elements of a cylinder, wave by wave around it
modes        `ElasticJournal`, which a scene writes; its reduction to modes of its surface under the film
turning      a finite-element body's own modes, which turn under the film: `FEJournal`
"""
