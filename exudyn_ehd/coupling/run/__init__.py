"""Solver runs.

Module map
----------
solve              SolveDynamic, SolveStatic
settings           ConfigureSolver
start_guess        where Newton starts in a step, and which results of it are refused
periodic           runs that end when their orbits have closed; how far a run is, where somebody looks
newton_limits      how far it goes in one of its own steps; where it ends, in the measure of the films' forces
step_size          steps chosen by their error
equilibrium_start  joints placed in equilibrium
restart            states to go on from
joint_state        what a joint knows besides coordinates, and whose it is
sparse             SolveDynamicSparse
system_matrix      its iteration matrix
"""
