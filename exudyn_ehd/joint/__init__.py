"""One bearing as a pure function of its motion.

Module map
----------
newton       damped Newton's method and continuation, by which all searches for a steady balance proceed
solved_film  record of one evaluation, from which all modules below read
time_step    rates of a step that agree with its positions; error of a step within which the load jumps
step_error   error of the gap by the time steps of a run
bore         shapes of an elastic bore and their balance
tangent      derivatives of the wrench
heat         temperature over time
thrust       films on both end faces
model        from a bearing's description to its evaluation
balance      steady films: their temperature, their position under a load
spherical    a ball in its socket
audit        effects that mattered, and omitted ones that would have
static       steady films, equilibrium, Stribeck curve
"""
