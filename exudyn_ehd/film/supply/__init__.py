"""Oil supply: areas in which the pressure is prescribed, with edges anywhere on the film's grid.

Module map
----------
areas    what a scene names: AxialGroove, CircumferentialGroove, Hole, Pocket
rows     rows of the grid on the areas' axial edges
holes    round holes, down to a source within a cell
cuts     prescribed vertices, and links that end at an edge between two columns
coverage shares of the control volumes that areas cover
recess   shear of the oil in areas
checks   what is refused
"""
