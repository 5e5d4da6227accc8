"""Temperature of a film over time.

Module map
----------
temperature   history and balance of heat
heat_balance  energy equation of one solved film
across        two temperatures across the film
walls         bush and journal that conduct, store heat and grow
power         mechanical power that film and contacts keep; oil that enters and leaves
"""
