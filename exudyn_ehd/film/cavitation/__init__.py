"""Cavitation closures.

Module map
----------
closures          what a closure offers, and how its films are found; FullSommerfeld, Gumbel, SwiftStieber
system            one film problem as arrays
linear_film       the linear film on given vertices; Gümbel's condition; the rupture line of short bearings
swift_stieber     Newton's method for films of Swift and Stieber
line_steps        what one of its steps does
rupture_line      where the film's edge lies inside a cell, and what it adds to balances and derivatives
elrod_adams       mass-conserving closure
states            one unknown per vertex of a film that conserves mass or whose density follows the pressure
solve             Newton's method in it
oil_line          the film's edge inside a cell
pseudo_time       the way to a film that is far from where its solution starts
"""
