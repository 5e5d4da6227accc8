"""What lies on the walls.

Module map
----------
profile         shape of the surfaces
flow_factors    Patir-Cheng
average_gap     mean gap of rough surfaces
asperity        Greenwood-Tripp
wall            RegularisedWall
contact_wrench  forces of the contacts
wear            Archard
"""
