"""Effects of the surfaces on the film.

Module map
----------
profile         shape of the surfaces
patir_cheng     PatirCheng, its fits as tables
flow_factors    Patir and Cheng's factors as effects on flow and friction
average_gap     mean gap of rough surfaces
asperity        Greenwood-Tripp
wall            RegularisedWall
contact         protocols of contacts and gap limiters
contact_wrench  forces of the contacts
drag            force of a pressure gradient, where the surfaces share it unevenly
elastic_liner   ElasticLiner, the option
wear            Archard
"""
