"""Films on the end faces that the journal's film feeds.

Module map
----------
films  both films at the pressures at which their flows are the same; flows through the ends of the journal's film
"""
