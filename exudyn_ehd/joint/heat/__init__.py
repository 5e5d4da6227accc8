"""Temperature of a film over time.

Module map
----------
temperature  one temperature of a film; energy equation of one solved film
across       two temperatures across the film
walls        field of temperatures; bush and journal that conduct, store heat and grow
power        mechanical power that film and contacts keep; oil that enters and leaves
"""
