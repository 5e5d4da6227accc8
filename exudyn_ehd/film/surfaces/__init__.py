"""Effects of the surfaces on the film.

Module map
----------
profile    shape of the surfaces
roughness  rough surfaces: Greenwood-Tripp, average gap; PatirCheng, its fits as tables, flow, friction and drag
contact    protocols of contacts and gap limiters, their forces; RegularisedWall; Archard; ElasticLiner, the option
"""
