"""Many bearings at once: studies over parameters, and which film keeps an error.

Module map
----------
parameters      `parameter_study`: a function over lists of parameters, in processes, under MPI, on hosts
places          where rows are computed, and what becomes of a row whose process dies
rows            one row, and the file of finished ones
accuracy_table  measured errors of film models over (eps, L/D, tilt, elasticity)
recommend       `recommend`: the cheapest film that keeps an error, from that table
"""
