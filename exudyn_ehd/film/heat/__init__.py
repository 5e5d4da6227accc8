"""Temperature of the film.

Module map
----------
options     what a scene names: LumpedThermal, FilmEnergy, Conduction
energy      energy equation on the film's grid; heat through the film's surfaces
across      two temperatures across the film
conduction  rings of a wall
"""
