"""Effects of the surfaces on the film.

Module map
----------
profile         shape of the surfaces
patir_cheng     PatirCheng, its fits as tables, flow, friction and drag of rough surfaces
asperity        Greenwood-Tripp; mean gap of rough surfaces
contact         protocols of contacts and gap limiters, their forces; RegularisedWall; Archard
elastic_liner   ElasticLiner, the option
"""
