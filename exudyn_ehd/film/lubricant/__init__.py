"""Oil.

Module map
----------
lubricant              Lubricant, the option of a bearing, and viscosity grades
pressure_viscosity     Barus, Roelands and the Kirchhoff transform
temperature_viscosity  Reynolds, Vogel, Walther
shear_thinning         Carreau
shear_profile          velocity profile across a film of shear-thinning oil
density                Dowson-Higginson, and the interface of a density law; density at the vertices of a film
"""
