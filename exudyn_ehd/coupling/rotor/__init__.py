"""Rotors in several films: equilibrium over the speed, eigenvalues, response to unbalance.

Module map
----------
solve      equilibrium of all films from speed to speed, thresholds
result     what was found: coefficients, eigenvalues, unbalance response
system     an Exudyn system about a state in which rotors spin, without its films
films      the films about such a state
spinning   which nodes turn with a rotor, and about which axis
"""
