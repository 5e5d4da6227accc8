"""Many bearings at once: studies over parameters, and which film keeps an error.

Module map
----------
parameters      `parameter_study`: a function over lists of parameters, in processes, under MPI, on hosts
accuracy_table  measured errors of film models over (eps, L/D, tilt, elasticity)
recommend       `recommend`: the cheapest film that keeps an error, from that table
"""
