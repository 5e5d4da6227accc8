"""Rotors in several films: equilibrium over the speed, eigenvalues, response to unbalance.

Module map
----------
api        `SolveEquilibrium`, `SolveThreshold`, `stability_map`
result     what was found: coefficients, eigenvalues, unbalance response
solve      equilibrium of all films from speed to speed; what the theory asks of a system
films      the films about a state in which rotors spin
bores      flexible bushes and journals in such a system
system     an Exudyn system about such a state, without its films
vibrations eigenvalues of a linear system, and of one with films that follow with a delay
spinning   which nodes turn with a rotor, and about which axis
"""
