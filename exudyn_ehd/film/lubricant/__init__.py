"""Oil.

Module map
----------
lubricant              what a scene names, and viscosity grades
pressure_viscosity     Barus, Roelands and the Kirchhoff transform
temperature_viscosity  Reynolds, Vogel, Walther
shear_thinning         Carreau
shear_profile          its profile across the film
density                Dowson-Higginson, and what any density law offers; density at the vertices of a film
"""
