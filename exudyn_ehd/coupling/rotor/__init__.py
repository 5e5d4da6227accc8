"""Rotors in several films: equilibrium over the speed, eigenvalues, response to unbalance.

Module map
----------
api         `SolveEquilibrium`, `SolveThreshold`, `stability_map`
result      results: coefficients, eigenvalues, response to unbalance
vibrations  eigenvalues and modes, also in films that follow with a delay
solve       equilibrium of all films from speed to speed; checks of the theory's assumptions
films       the films about a state in which rotors spin
system      an Exudyn system about such a state, without its films; flexible bushes and journals in it
spinning    which nodes turn with a rotor, and about which axis
"""
