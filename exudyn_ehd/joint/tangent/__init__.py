"""Derivatives of the wrench.

Module map
----------
wrench           rigid bore
bore             elastic bore by modes
elastic_product  derivatives of the elastic bore's loads
nodes            elastic bore by nodes
traction         loads on the nodes of the bore
drag             pull of the pressure gradient on the two surfaces
"""
