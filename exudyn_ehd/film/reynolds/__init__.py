"""Flow through the film.

Module map
----------
gap               rigid journal in its bore
links             conductance, carrier, right-hand side
flux              factors on the flow through the links
link_derivatives  derivatives of the flow through a link
density_sweep     the same for a compressible film
stepped_gap       gaps with steps
"""
