"""One bearing as a pure function of its motion.

Module map
----------
seams       what an effect must offer to take part
model       from a bearing's description to its evaluation
bore        shapes of an elastic bore and their balance
tangent     derivatives of the wrench
heat        temperature over time
static      steady films, equilibrium, Stribeck curve
audit       which effects mattered
"""
