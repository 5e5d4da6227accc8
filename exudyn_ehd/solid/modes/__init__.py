"""Bushes reduced to modes.

Module map
----------
films   pressures of oil films, and the modes that they need
static  static modes of the bore
"""
