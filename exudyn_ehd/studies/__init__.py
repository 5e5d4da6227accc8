"""Studies of many runs.

Module map
----------
parameters  `parameter_study`: a function over lists of parameters, in processes, under MPI or on a cluster; `StudyTable`
"""
