"""Cavitation closures.

Module map
----------
closures          interface of a closure; the four closures; one film problem as arrays; steady films without a unique
                  solution
linear_film       linear film on given vertices; Gümbel's condition; rupture line of short bearings
rupture_line      rupture line inside a cell: its terms in balances and derivatives, also where gaps follow the pressure
states            one unknown per vertex for Newton's method, from which pressure and fill follow
oil_line          rupture line inside a cell of a mass-conserving film
"""
