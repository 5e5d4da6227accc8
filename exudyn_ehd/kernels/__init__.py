"""Compilation of kernels.

Module map
----------
ahead         kernels of first films by the table ``first_films.txt``, shared out between this process and a helper
compilations  what goes along with every compilation: a line for the user, a pause of the garbage collector
"""
