"""Films on the end faces that the journal's film feeds.

Module map
----------
ends   flows through the ends of the journal's film, and what their pressures do
films  both films at the pressures at which their flows are the same
"""
