"""Temperature of the film.

Module map
----------
options     what a scene names: LumpedThermal, FilmEnergy, Conduction
energy      energy equation on the film's grid
across      two temperatures across the film
passage     heat through the film's surfaces
conduction  rings of a wall
"""
