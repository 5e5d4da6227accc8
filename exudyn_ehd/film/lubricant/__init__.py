"""Oil.

Module map
----------
lubricant           Lubricant, the option of a bearing, and viscosity grades; Reynolds, Vogel, Walther
pressure_viscosity  Barus, Roelands and the Kirchhoff transform
shear_thinning      Carreau
shear_profile       velocity profile across a film of shear-thinning oil
density             Dowson-Higginson, and the interface of a density law; density at the vertices of a film
"""
