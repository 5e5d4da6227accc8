"""Compilation of the first films of an installation by two processes.

Module map
----------
ahead         which kernels a scene needs, shared out between this process and a helper
helper        the second process
signatures    the table ``first_films.txt``: kernels and the types of their arguments
"""
