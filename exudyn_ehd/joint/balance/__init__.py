"""Steady films in balance: with their own heat, and with a load.

Module map
----------
film         film at a motion, its temperature and oil content settled
temperature  steady temperature
hot_oil      temperatures that oil does not bear
overload     pressures that no material bears
advice       what to do about films that can't be evaluated
position     journal's position under a load
faces        films on the end faces beside it
"""
