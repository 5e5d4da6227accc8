"""Pictures and texts of the tables.

Module map
----------
front     Pareto front, cheapest setting within an error
pictures  work-precision diagrams, one-page summary
guide     texts and tables of the README
"""
