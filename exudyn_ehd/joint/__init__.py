"""One bearing as a pure function of its motion.

Module map
----------
solved_film  one evaluation as a record: what all below read
plain_film   a film without further effects in one kernel
step_rates   rates of a step that agree with its positions
step_error   what the steps of a run miss in the gap
bore         shapes of an elastic bore and their balance
tangent      derivatives of the wrench
heat         temperature over time
thrust       films on both end faces
model        from a bearing's description to its evaluation
balance      steady films: their temperature, their position under a load
spherical    a ball in its socket
audit        which effects mattered
static       steady films, equilibrium, Stribeck curve
"""
