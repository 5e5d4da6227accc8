"""Oil supply: areas in which the pressure is prescribed, with edges anywhere on the film's grid.

Module map
----------
areas        options of a bearing: AxialGroove, CircumferentialGroove, Hole, Pocket; round holes on the grid
restrictors  Orifice, Capillary, GivenFlow and EndSeal; pressures behind them, which follow from the film
rows         rows of the grid on the areas' axial edges; checks of the areas
cuts         prescribed vertices, shares of the control volumes, links that end at an edge; shear of the oil
"""
