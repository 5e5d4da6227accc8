"""The rupture line of a mass-conserving film inside the cells.

Module map
----------
curve    what pressure and fill of a vertex at the line have to do with each other, and its derivatives
newton   Newton's method for a film with it
"""
