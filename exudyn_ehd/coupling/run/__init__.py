"""Solver runs.

Module map
----------
solve              SolveDynamic, SolveStatic; initial velocities that fit no joint
newton             where Newton starts in a step, how far it goes, where it ends, which of its results are refused
periodic           runs that end when their orbits have closed; how far a run is, where somebody looks
step_size          steps chosen by their error
restart            states to go on from; joints placed in equilibrium
joint_state        what a joint knows besides coordinates, and whose it is
sparse             SolveDynamicSparse
system_matrix      its iteration matrix
"""
