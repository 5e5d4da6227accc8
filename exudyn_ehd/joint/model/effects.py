"""Effects of a bearing's model from its description: profile, wear, roughness and contact of the surfaces, and
the laws of the lubricant.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import LumpedThermal
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.film.surfaces.asperity import AsperityContact
from exudyn_ehd.film.surfaces.average_gap import AverageGap
from exudyn_ehd.film.surfaces.flow_factors import RoughFlow
from exudyn_ehd.film.surfaces.profile import ProfileTerm
from exudyn_ehd.film.surfaces.wear import WearDepth
from exudyn_ehd.joint.heat.temperature import LumpedTemperature, ViscosityField
from exudyn_ehd.joint.model.parts import grid_of
from exudyn_ehd.joint.seams import Effects, GapTerm, Wear, shear_product
from exudyn_ehd.joint.solved_film import History, SolvedFilm


def surface_effects(bearing: JournalBearing, start_angle: float) -> Effects:
    """Scaled effects of profile, wear, roughness and asperities, on the grid that starts at ``start_angle``."""
    c = bearing.radial_clearance
    gap_terms: list[GapTerm] = []
    wear = None
    if bearing.profiles or bearing.wear is not None:
        grid = grid_of(bearing, start_angle)
        if bearing.profiles:
            gap_terms.append(ProfileTerm(bearing.profiles, grid.x, grid.z * grid.reference_length, bearing.length, c))
        if bearing.wear is not None:
            wear = WearDepth(bearing.wear, grid.shape, c)
            gap_terms.append(WearTerm(wear))
    if bearing.asperity is None and bearing.roughness is None:
        return Effects(gap_terms=tuple(gap_terms))
    return replace(_rough_effects(bearing), gap_terms=tuple(gap_terms), wear=wear)


class WearTerm:
    """The worn depth at the start of the step as a gap term."""

    def __init__(self, wear: WearDepth) -> None:
        self.wear = wear

    def field(self, history: History | None) -> np.ndarray:
        """Scaled depth (n, m)."""
        return self.wear.depth(None if history is None else history.wear)


def _rough_effects(bearing: JournalBearing) -> Effects:
    c = bearing.radial_clearance
    contact = None if bearing.asperity is None else AsperityContact(bearing.asperity, c)
    if bearing.roughness is None:
        return Effects(limiter=contact, contacts=() if contact is None else (contact,))
    residual = 0.0 if contact is None else contact.residual
    rough = RoughFlow(bearing.roughness, c, residual)
    return Effects(
        limiter=AverageGap(bearing.roughness.composite_roughness / c, residual) if contact is None else contact,
        contacts=() if contact is None else (contact,),
        flux=(rough,),
        shear_factor=rough,
        uneven_drag=bearing.roughness.journal_share != 0.5,
    )


def worn_depth(wear: Wear, film: SolvedFilm) -> np.ndarray:
    """Scaled wear depth at the end of a solved film's step."""
    contacts, history = film.parts.contacts, film.history
    assert contacts is not None
    speed = math.hypot(film.grid.reference_length * film.journal.omega, film.journal.axial_speed)
    pressure, *others = contacts.P
    for other in others:
        pressure = pressure + other
    return wear.grown(None if history is None else history.wear, pressure, speed, film.step)


def collect_rheology(bearing: JournalBearing) -> Effects:
    """Laws of the lubricant and the thermal effect of a bearing."""
    oil, thermal = bearing.lubricant, bearing.thermal
    effects = Effects(pressure_law=transform_of(oil))
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
    if isinstance(thermal, LumpedThermal):
        lumped = LumpedTemperature(thermal, bearing)
        if turbulent is not None:
            turbulent.field = lumped.field = ViscosityField()
        return replace(effects, thermal=lumped)
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
    # imported here: other films have no field of temperatures
    from exudyn_ehd.joint.heat.walls import FilmTemperature, Growth

    kind = FilmTemperature if thermal.across == 1 else CubicTemperature
    heated = kind(thermal, bearing, field, grid_of(bearing).shape)
    return replace(effects, thermal=heated, gap_terms=(Growth(heated),) if heated.grows else ())
