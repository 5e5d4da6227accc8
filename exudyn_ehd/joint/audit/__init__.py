"""Audit of effects: those that mattered, and those without effect.

Module map
----------
audit     rows of the flow, grid, time step and ringing; all rows that an audit goes through
effects   rows of elasticity, profile, roughness, contact and wear; of the oil's viscosity and heat
findings  table of findings, verdict about an effect; the limits from which on each matters
case      the audited films, to compare with those of another description at the same load
samples   recorded steps, their worst states, numbers of motions and films
switches  effects added to a description, with typical numbers, and taken away
ringing   forces that alternate from step to step
"""
