"""Steady films in balance: with their own heat, and with a load.

Module map
----------
newton      position and temperature together in balance; film at a motion
position    journal's position under a load
limits      temperatures and pressures that no oil or steel bears; what to do about films without a solution
resolution  whether the grid resolves the pressure peak
"""
