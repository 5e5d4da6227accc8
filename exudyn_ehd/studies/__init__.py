"""Many bearings at once: studies over parameters, and which film keeps an error.

Module map
----------
parameters      `parameter_study`: a function over lists of parameters, in processes, by an executor
rows            computation of the rows in this process or by an executor, and the file of finished ones
recommend       `recommend`: the cheapest film that keeps an error
steps           `recommend_steps`: time steps in a mechanism
film_errors     what a steady film says of a bearing, how far two grids are apart in it; converged values from three
"""
