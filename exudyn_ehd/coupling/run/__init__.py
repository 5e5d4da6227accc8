"""Solver runs.

Module map
----------
solve              SolveDynamic, SolveStatic; warning of initial velocities that fit no joint
newton             initial guess, step limits, tolerances and rejected results of Newton's method
periodic           runs that end when their orbits have closed; progress of a run
step_size          steps chosen by their error
restart            states from which runs continue; joints placed in equilibrium
joint_state        state of a joint in addition to coordinates, and the check of its owner
sparse             SolveDynamicSparse
system_matrix      iteration matrix of SolveDynamicSparse
"""
