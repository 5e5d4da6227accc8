"""Temperature of a film over time.

Module map
----------
temperature  one temperature for the whole film; energy equation of a solved film
across       two temperatures across the film: their profile, viscosity and heat balance
walls        field of temperatures; bush and journal that conduct, store heat and grow
power        mechanical power dissipated or stored by film and contacts; oil that enters and leaves
"""
