"""Bushes reduced to modes.

Module map
----------
static   static modes of the bore
dynamic  what these lack in motion: vibrations, responses to body forces
"""
