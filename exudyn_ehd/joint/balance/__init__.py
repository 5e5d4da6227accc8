"""Steady films in balance with their own heat, and with a load.

Module map
----------
steady_film  search for temperature and position of a steady film; film at a motion
position     journal's position under a load
limits       temperatures and pressures beyond which a film causes a warning; advice for films without a solution
"""
