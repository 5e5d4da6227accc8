"""Compilation of the first films of an installation by two processes.

Module map
----------
ahead  which kernels a scene needs, by the table ``first_films.txt``, shared out between this process and a helper
"""
