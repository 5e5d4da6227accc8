"""Steady films in balance: with their own heat, and with a load.

Module map
----------
newton      one damped Newton's method for position and temperature
film        film at a motion, with its temperature and oil content
position    journal's position under a load
steadiest   of several positions the one that a journal keeps
limits      temperatures and pressures that no oil or steel bears; what to do about films without a solution
resolution  whether the grid resolves the pressure peak
"""
