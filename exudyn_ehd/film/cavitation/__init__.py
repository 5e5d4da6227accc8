"""Cavitation closures.

Module map
----------
closures          what a closure offers; the four closures; pseudo-transient continuation
system            one film problem as arrays; steady films that are not determined
linear_film       the linear film on given vertices; Gümbel's condition; the rupture line of short bearings
swift_stieber     Newton's method for films of Swift and Stieber
rupture_line      where the film's edge lies inside a cell, and what it adds to balances and derivatives
states            one unknown per vertex of a film that conserves mass or whose density follows the pressure
solve             Newton's method in it
oil_line          the film's edge inside a cell
"""
