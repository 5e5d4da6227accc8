"""From a lubricant's laws to the seams of a bearing model."""

from __future__ import annotations

from dataclasses import replace

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.joint.heat.temperature import FilmTemperature, LumpedTemperature, ViscosityField
from exudyn_ehd.joint.model.parts import grid_of
from exudyn_ehd.joint.seams import Effects, PressureLaw, shear_product
from exudyn_ehd.status import InputError


def collect_rheology(bearing: JournalBearing) -> Effects:
    """Laws of the lubricant and the thermal effect of a bearing.

    Raises
    ------
    InputError
        For a thermal effect whose lubricant has no temperature law, or a journal's wall thicker than the journal.
    """
    oil, thermal = bearing.lubricant, bearing.thermal
    effects = Effects(pressure_law=transform_law(oil))
    if isinstance(effects.pressure_law, CompressibleLaw):
        effects = replace(effects, density=effects.pressure_law)
    thinning = None
    if oil.shear_law is not None:
        thinning = oil.shear_law.bound(bearing.journal_radius, bearing.radial_clearance)
        effects = replace(effects, flux=(thinning,), shear_factor=thinning)
    turbulent = None
    if bearing.turbulence is not None:
        R, c = bearing.journal_radius, bearing.radial_clearance
        turbulent = bearing.turbulence.bound(R, c, oil.density, oil.viscosity)
        effects = replace(effects, flux=(turbulent,), shear_factor=turbulent)
    if thermal is None:
        return effects
    if oil.temperature_law is None:
        raise InputError(
            f"JournalBearing.thermal={type(thermal).__name__}(...) needs a lubricant whose viscosity depends on "
            'temperature, got Lubricant.temperature_law=None; name a law or take a named oil, oil("ISO VG 46").'
        )
    if isinstance(thermal, LumpedThermal):
        lumped = LumpedTemperature(thermal, bearing)
        if turbulent is not None:
            turbulent.field = lumped.field = ViscosityField()
        return replace(effects, thermal=lumped)
    _check_field(bearing, thermal)
    if thermal.across == 2:
        # imported here: other films have no profile across them
        from exudyn_ehd.joint.heat.across import CubicTemperature, FluidityField

        field: ViscosityField = FluidityField()
    else:
        field = ViscosityField()
    for law in (thinning, turbulent):
        if law is not None:
            law.field = field
    effects = replace(
        effects,
        flux=(*effects.flux, field),
        shear_factor=shear_product(field, effects.shear_factor),
        uneven_drag=field.changes_carriers,
    )
    if thermal.across == 1 and thermal.bush is None and thermal.journal is None:
        return replace(effects, thermal=FilmTemperature(thermal, bearing, field))
    # imported here: other films need no walls
    from exudyn_ehd.joint.heat.walls import Growth, WalledTemperature

    kind = WalledTemperature if thermal.across == 1 else CubicTemperature
    walled = kind(thermal, bearing, field, grid_of(bearing).shape)
    return replace(effects, thermal=walled, gap_terms=(Growth(walled),) if walled.grows else ())


def _check_field(bearing: JournalBearing, thermal: FilmEnergy) -> None:
    """Refuse a temperature field that does not go with the bearing."""
    if thermal.across == 2 and bearing.lubricant.shear_law is not None:
        raise InputError(
            f"FilmEnergy.across=2 does not go with Lubricant.shear_law={type(bearing.lubricant.shear_law).__name__}(): "
            "both change the viscosity across the film, and either leaves out the other's profile; take across=1, or "
            "leave the shear_law out."
        )
    if thermal.journal is not None and thermal.journal.thickness > bearing.journal_radius * (1.0 + 1e-12):
        raise InputError(
            f"FilmEnergy.journal=Conduction(thickness={thermal.journal.thickness:g} m) is thicker than the journal, "
            f"whose radius is {bearing.journal_radius:g} m; a solid journal's thickness is its radius."
        )


def transform_law(lubricant: Lubricant) -> PressureLaw | None:
    """The law by which pressure becomes the solver's unknown, a `CompressibleLaw` with a density law; None: none."""
    viscosity = None if lubricant.pressure_law is None else lubricant.pressure_law.bound(lubricant.viscosity)
    return viscosity if lubricant.density_law is None else lubricant.density_law.bound(viscosity)
