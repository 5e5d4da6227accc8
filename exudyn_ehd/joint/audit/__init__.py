"""Audit of effects: those that mattered, and those without effect.

Module map
----------
audit       rows of the flow, grid, time step and ringing; table of all rows
effects     rows of elasticity, profile, roughness, contact and wear; of the oil's viscosity and heat
findings    table of findings, verdict about an effect; limit beyond which each effect matters
case        the audited films, and their comparison with films of a changed description at the same load
samples     recorded steps, their worst states, numbers of motions and films
switches    functions that add an effect to a description, with typical numbers, or remove it
resolution  resolution by the grid and by time steps: pressure peaks, forces that alternate from step to step
"""
