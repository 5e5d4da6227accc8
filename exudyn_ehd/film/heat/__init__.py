"""Temperature of the film.

Module map
----------
options   what a scene names: LumpedThermal, FilmEnergy
energy    energy equation on the film's grid
"""
