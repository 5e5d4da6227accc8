"""Cavitation closures.

Module map
----------
closures          what a closure offers; the four closures
system            one film problem as arrays; steady films that are not determined
linear_film       the linear film on given vertices; Gümbel's condition; the rupture line of short bearings
rupture_line      where the film's edge lies inside a cell, and what it adds to balances and derivatives
states            one unknown per vertex for Newton's method, with pressure and fill
oil_line          the film's edge inside a cell
"""
