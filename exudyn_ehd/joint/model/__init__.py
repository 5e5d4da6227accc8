"""Model of a bearing.

Module map
----------
build           the only place that asks whether an effect is present
build_flexible  the same for flexible bushes
compile         kernels compiled before the first step
rigid           rigid journal in a rigid bore
flexible        elastic bore
impedance       fitted map
rheology        oil laws
surfaces        profile, roughness, contact
film_laws       pressures of a film with oil laws
loads           integrals and wrench of a solved film
quantities      scalars of a state
fields          fields of a state
"""
