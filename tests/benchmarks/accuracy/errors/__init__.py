"""Errors of settings against converged references.

Module map
----------
study       scene + ladder + references -> table; repeated in turns, or in parallel without times
ladders     which settings a ladder has
"""
