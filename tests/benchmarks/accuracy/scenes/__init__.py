"""Bearings at work.

Module map
----------
setting     what a rung of a ladder changes, what a run gives back, what a scene is
steady      a journal at a prescribed position
moving      a journal that moves in an Exudyn model
mechanisms  the Exudyn models of moving scenes
measured    the scenes that are measured
"""
