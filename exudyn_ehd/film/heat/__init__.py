"""Temperature of the film.

Module map
----------
options     options of a bearing: LumpedThermal, FilmEnergy, Conduction; finite volumes of a wall
energy      energy equation on the film's grid; heat through the film's surfaces; viscosity at its temperatures
"""
