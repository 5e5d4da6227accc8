"""Audit of effects: those that mattered, and those without effect.

Module map
----------
audit        table of findings
findings     what is said about an effect; the limits from which on each matters
indicators   dimensionless numbers of the worst films, one per effect; those of films on the end faces
surfaces     those of elasticity, profile, roughness and contact
oil          those of its viscosity
changes      films with and without an effect at the same load
switches     effects added to a description, with typical numbers, and taken away
assumptions  the same of laminar flow, grid and time step
samples      states of a run that the audit looks at
ringing      forces that alternate from step to step
"""
