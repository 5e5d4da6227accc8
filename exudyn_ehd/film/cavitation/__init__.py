"""Cavitation closures.

Module map
----------
closures          FullSommerfeld, Gumbel, SwiftStieber
active_set        the film on a set of unknown pressures, and how the set is found
elrod_adams       mass-conserving closure
lagging_void      its flows out of a cavity, averaged over the step
pseudo_time       the way to a film that is far from where its solution starts
cavity_transport  factor along the flow through the cavity
cavity_adjoint    its transpose
"""
