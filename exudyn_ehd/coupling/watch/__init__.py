"""Supervision of a running solver.

Module map
----------
solver_state  which solver runs, with which step; implicit steps too coarse for a film, rejected
doubts        explicit steps beyond their stability limit; meshes that turn too far in a step; films that run dry, are
              too thin, too steep or too light; a run in one line
"""
