"""Cavitation closures.

Module map
----------
closures          what a closure offers; FullSommerfeld, Gumbel, SwiftStieber
active_set        the film on a set of unknown pressures, and how the set is found
rupture_line      where the film's edge lies inside a cell, and what it adds to balances and derivatives
line_newton       Newton's method for a film with it
line_steps        what one of its steps does
line_kernels      the same in Newton's method for liners, density and shear laws
elrod_adams       mass-conserving closure
states            one unknown per vertex of a film that conserves mass
solve             Newton's method in it
oil_line          the film's edge inside a cell
pseudo_time       the way to a film that is far from where its solution starts
"""
