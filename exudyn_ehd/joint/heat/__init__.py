"""Temperature of a film over time.

Module map
----------
temperature  history and balance of heat
oil_flows    oil that enters and leaves
power        mechanical power that film and contacts keep
"""
