"""Cavitation closures.

Module map
----------
closures          FullSommerfeld, Gumbel, SwiftStieber
elrod_adams       mass-conserving closure
cavity_transport  factor along the flow through the cavity
cavity_adjoint    its transpose
"""
