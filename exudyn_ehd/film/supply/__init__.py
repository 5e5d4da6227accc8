"""Oil supply: areas in which the pressure is prescribed, with edges anywhere on the film's grid.

Module map
----------
areas        options of a bearing: AxialGroove, CircumferentialGroove, Hole, Pocket
restrictors  Orifice, Capillary, GivenFlow and EndSeal; pressures behind them, which follow from the film
rows         rows of the grid on the areas' axial edges; checks of the areas
holes        round holes, down to a source within a cell
cuts         prescribed vertices, shares of the control volumes, links that end at an edge; shear of the oil
"""
