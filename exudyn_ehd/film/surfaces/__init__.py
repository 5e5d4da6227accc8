"""What lies on the walls.

Module map
----------
profile         shape of the surfaces
patir_cheng     PatirCheng, its fits as tables
flow_factors    the same as effects on flow and friction
average_gap     mean gap of rough surfaces
asperity        Greenwood-Tripp
wall            RegularisedWall
contact         what a contact and a gap limiter must offer
contact_wrench  forces of the contacts
drag            of a pressure gradient, where the surfaces share it unevenly
elastic_liner   ElasticLiner, the option
wear            Archard
"""
