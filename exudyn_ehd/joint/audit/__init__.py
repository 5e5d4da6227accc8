"""Which effects mattered, and which had no effect.

Module map
----------
audit       table of findings
indicators  dimensionless numbers with their limits
samples     states of a run that the audit looks at
ringing     pressures that alternate from step to step
"""
