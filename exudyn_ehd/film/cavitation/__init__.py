"""Cavitation closures.

Module map
----------
closures          FullSommerfeld, Gumbel, SwiftStieber
active_set        the film on a set of unknown pressures, and how the set is found
elrod_adams       mass-conserving closure
cavity_transport  factor along the flow through the cavity
cavity_adjoint    its transpose
"""
