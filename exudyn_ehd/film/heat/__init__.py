"""Temperature of the film.

Module map
----------
options     what a scene names: LumpedThermal, FilmEnergy, Conduction; rings of a wall
energy      energy equation on the film's grid; heat through the film's surfaces; viscosity of its temperatures
across      two temperatures across the film, and their viscosity
"""
