"""Steady films in balance: with their own heat, and with a load.

Module map
----------
film      film at a motion, its temperature and oil content settled; steady temperature
limits    temperatures and pressures that no oil or steel bears; what to do about films without a solution
position  journal's position under a load
steadiest of several positions the one that a journal keeps
faces     films on the end faces beside it
resolution  whether the grid resolves the pressure peak
"""
