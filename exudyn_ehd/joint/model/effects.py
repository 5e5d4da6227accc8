"""Effects of a bearing's model from its description: the only place that checks which options are present.

Also grid, solver and buffers of a bearing model: the parts that are kept from evaluation to evaluation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce
from typing import Protocol

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.arcs import LobeTerm, lobe_term, mixing_grooves
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.heat.options import LumpedThermal, known_supply
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.models import film_grid, film_solver
from exudyn_ehd.film.reynolds.gap import add_gap
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkLaw, ShearFactor, ShearProduct
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.solvers.winkler import Liner
from exudyn_ehd.film.supply.areas import Hole
from exudyn_ehd.film.supply.cuts import SupplyMap
from exudyn_ehd.film.supply.restrictors import Reservoirs
from exudyn_ehd.film.surfaces.contact import ArchardWear, Contact, ElasticLiner, GapLimiter, WallContact
from exudyn_ehd.film.surfaces.profile import ProfileTerm
from exudyn_ehd.film.surfaces.roughness import AsperityContact, AverageGap, RoughFlow
from exudyn_ehd.joint.heat.temperature import LumpedTemperature, OilTemperature
from exudyn_ehd.joint.solved_film import ContactFields, ExtraGap, FilmParts, History, LimiterFields, SolvedFilm


class GapTerm(Protocol):
    """Addition to the gap of the rigid surfaces, which must not depend on the motion."""

    def field(self, history: History | None) -> np.ndarray:
        """Scaled addition to the gap at the vertices (n, m), by the history at the start of the step."""


class Wear(GapTerm, Protocol):
    """Depth by which the contact pressure of accepted steps has enlarged the gap."""

    def grown(self, film: SolvedFilm) -> np.ndarray:
        """Scaled depth (n, m) at the end of a solved film's step."""


@dataclass(frozen=True)
class Effects:
    """Effects of a bearing model in addition to the plain film; empty by default.

    Attributes
    ----------
    gap_terms : tuple of GapTerm
    limiter : GapLimiter or None
    contacts : tuple of Contact
    flux : tuple of FluxEffect
    pressure_law : PressureTransform or None
    shear_factor : ShearFactor or None
    thermal : OilTemperature or None
    density : CompressibleLaw or None
        Density law of a compressible film; ``pressure_law`` is then the same object.
    wear : Wear or None
        Wear by the pressure of the contacts; also one of ``gap_terms``.
    liner : ElasticLiner or None
    lobes : LobeTerm or None
        Shape of arcs; also one of ``gap_terms``.
    """

    gap_terms: tuple[GapTerm, ...] = ()
    limiter: GapLimiter | None = None
    contacts: tuple[Contact, ...] = ()
    flux: tuple[FluxEffect, ...] = ()
    pressure_law: PressureTransform | None = None
    shear_factor: ShearFactor | None = None
    thermal: OilTemperature | None = None
    density: CompressibleLaw | None = None
    wear: Wear | None = None
    liner: ElasticLiner | None = None
    lobes: LobeTerm | None = None

    def add_gap_terms(
        self, solver: FilmSolver, history: History | None, displacement: np.ndarray | None, rate: np.ndarray
    ) -> tuple[float, ExtraGap]:
        """Add the gap terms, and the displacement of a flexible bore with its rate, to the gaps in ``solver``.

        Returns the smallest gap, scaled, and the added fields.
        """
        s, surfaces = solver, [term.field(history) for term in self.gap_terms]
        fields = surfaces if displacement is None else [*surfaces, displacement]
        height = fields[0] if len(fields) == 1 else np.sum(fields, axis=0)
        rate = rate if s.squeeze else s.nothing
        if history is not None and history.growth is not None:
            rate = rate + history.growth
        if self.lobes is not None:
            s.HF += self.lobes.between
        smallest, slopes = add_gap(height, rate, s.grid, s.H, s.HF, s.H_t)
        if self.lobes is not None:
            slopes += self.lobes.slopes
        return smallest, ExtraGap(height, slopes[0], slopes[1], surfaces)


def _reservoirs(bearing: JournalBearing, supply: SupplyMap, effects: Effects) -> Reservoirs:
    """Supply areas with a restrictor, whose oil has the viscosity of the supply temperature."""
    oil, thermal, viscosity = bearing.lubricant, bearing.thermal, bearing.lubricant.viscosity
    if thermal is not None and oil.temperature_law is not None:
        viscosity = float(oil.temperature_law.viscosity(known_supply(thermal), oil.density))
    scale = bearing.radial_clearance * bearing.journal_radius**2
    masks = [mask for mask, fed in zip(supply.masks, supply.fed, strict=True) if fed]
    restrictors = [area.supply for area in bearing.supply if area.supply is not None]
    return Reservoirs(restrictors, masks, (viscosity, oil.density), scale, effects.pressure_law)


def grid_of(bearing: JournalBearing, start_angle: float = 0.0) -> FilmGrid:
    """Grid of a bearing's film that starts at ``start_angle``, rad."""
    return film_grid(
        bearing.film,
        bearing.journal_radius,
        bearing.length,
        start_angle=start_angle,
        open_ring=isinstance(bearing.inlet, MaximumGap),
        supply=bearing.supply,
        conserves_mass=bearing.closure.conserves_mass,
        arcs=bearing.bore_arcs,
        seals=bearing.seals,
    )


def film_parts(bearing: JournalBearing, effects: Effects, grid: FilmGrid) -> FilmParts:
    """Parts of the model of a bearing with its effects on a grid."""
    R, c, supply = bearing.journal_radius, bearing.radial_clearance, None
    if bearing.supply:
        supply = SupplyMap(bearing.supply, grid, getattr(bearing.film, "circumferential_pressure_flow", True))
        grid = supply.grid
    mixing = [*(mixing_grooves(grid) if bearing.bore_arcs else ()), *(() if supply is None else supply.masks)]
    touching: list[Contact] = list(effects.contacts)
    if supply is not None:
        touching = [contact.on_land(supply.land) for contact in effects.contacts]
    solver = film_solver(
        bearing.film,
        grid,
        bearing.closure,
        squeeze=bearing.squeeze,
        flux_effects=effects.flux,
        density=effects.density,
        liner=None
        if effects.liner is None
        else Liner(next(iter(touching), None), effects.limiter, effects.pressure_law),
    )
    if supply is not None and any(area.supply is not None for area in bearing.supply):
        solver.reservoirs = _reservoirs(bearing, supply, effects)
    grooves = np.zeros(grid.shape)
    grooves[grid.edges.ravel()] = 1.0
    if supply is not None and solver.complementary and grid.flows_along_z:
        for area, mask, (share, _) in zip(bearing.supply, supply.masks, supply.rows, strict=True):
            # oil passes a hole at its sides; oil into an area with a restrictor is that of the restrictor
            if not isinstance(area, Hole) and area.supply is None and not area.rotating:
                grooves = np.maximum(grooves, mask * share)
    liner = None if effects.liner is None else solver.elements
    contacts = None
    if touching:
        contacts = ContactFields(grid.shape, touching)
        if liner is not None:
            # on a liner, contact pressure and film gap are results of the film solve
            contacts.P, contacts.slope = [liner.contact_pressure], [liner.contact_slope]
    pose_scale = np.array([1.0 / c, 1.0 / c, R / c, R / c])
    return FilmParts(
        bearing=bearing,
        grid=grid,
        solver=solver,
        liner=liner,
        supply=supply,
        mixing=mixing,
        grooves=grooves,
        contacts=contacts,
        limiter=LimiterFields(grid.shape) if effects.limiter is not None and liner is None else None,
        half_length=0.5 * bearing.length / R,
        pose_scale=pose_scale,
        motion_scale=np.concatenate((pose_scale, pose_scale, (0.5, 0.5 / R))),
        flow_scale=c * R**2,
        uneven_drag=any(effect.changes_carriers for effect in effects.flux),
    )


class WearTerm:
    """The worn depth at the start of the step as a gap term, and its growth.

    Parameters
    ----------
    wear : ArchardWear
    shape : (int, int)
    clearance : float
        Radial clearance, m.
    """

    def __init__(self, wear: ArchardWear, shape: tuple[int, int], clearance: float) -> None:
        self.wear, self.clearance, self.unworn = wear, clearance, np.zeros(shape)

    def field(self, history: History | None) -> np.ndarray:
        """Scaled depth (n, m)."""
        return self.unworn if history is None or history.wear is None else history.wear

    def grown(self, film: SolvedFilm) -> np.ndarray:
        """Scaled depth (n, m) at the end of a solved film's step."""
        contacts = film.parts.contacts
        assert contacts is not None
        speed = math.hypot(film.grid.reference_length * film.journal.omega, film.journal.axial_speed)
        growth = self.wear.growth(np.sum(contacts.P, axis=0), speed, film.step)
        return self.field(film.history) + growth / self.clearance


def collect_effects(bearing: JournalBearing, start_angle: float = 0.0) -> Effects:
    """Collect the effects of a bearing's options, in scaled form, on the grid that starts at ``start_angle``, rad."""
    c, grid, law = bearing.radial_clearance, grid_of(bearing, start_angle), transform_of(bearing.lubricant)
    lobes = lobe_term(bearing.bore_arcs, grid, c) if bearing.bore_arcs else None
    gap_terms: list[GapTerm] = [] if lobes is None else [lobes]
    if bearing.profiles:
        gap_terms.append(ProfileTerm(bearing.profiles, grid, bearing.length, c))
    wear = None if bearing.wear is None else WearTerm(bearing.wear, grid.shape, c)
    if wear is not None:
        gap_terms.append(wear)
    limiter, contacts, rough = _touching_surfaces(bearing)
    thermal, growth, flux, factors = _rheology(bearing, grid)
    factors += rough
    return Effects(
        gap_terms=(*gap_terms, *growth),
        limiter=limiter,
        contacts=tuple(contacts),
        flux=(*rough, *flux),
        pressure_law=law,
        shear_factor=reduce(ShearProduct, factors) if factors else None,
        thermal=thermal,
        density=law if isinstance(law, CompressibleLaw) else None,
        wear=wear,
        liner=bearing.bush if isinstance(bearing.bush, ElasticLiner) else None,
        lobes=lobes,
    )


def _touching_surfaces(bearing: JournalBearing) -> tuple[GapLimiter | None, list[Contact], list[RoughFlow]]:
    """Limiter and contacts of roughness, asperities and wall, and the flow between rough surfaces."""
    c, rough, residual = bearing.radial_clearance, bearing.roughness, 0.0
    limiter: GapLimiter | None = None
    contacts: list[Contact] = []
    flows: list[RoughFlow] = []
    if bearing.asperity is not None:
        limiter = asperities = AsperityContact(bearing.asperity, c)
        contacts, residual = [asperities], asperities.residual
    if rough is not None:
        limiter = AverageGap(rough.composite_roughness / c, residual) if limiter is None else limiter
        flows = [RoughFlow(rough, c, residual)]
    if bearing.contact is not None:
        limiter = wall = WallContact(bearing.contact, c)
        contacts = [wall, *contacts]
    return limiter, contacts, flows


def _rheology(
    bearing: JournalBearing, grid: FilmGrid
) -> tuple[OilTemperature | None, list[GapTerm], list[FluxEffect], list[ShearFactor]]:
    """Collect the thermal effect, the growth of its walls, flux effects and shear factors.

    The last two come from shear thinning, turbulence and a temperature field.
    """
    oil, spec, R, c = bearing.lubricant, bearing.thermal, bearing.journal_radius, bearing.radial_clearance
    laws: list[LinkLaw] = []
    if oil.shear_law is not None:
        laws.append(oil.shear_law.bound(R, c))
    if bearing.turbulence is not None:
        laws.append(bearing.turbulence.bound(R, c, oil.density, oil.viscosity))
    if spec is None:
        return None, [], [*laws], [*laws]
    if isinstance(spec, LumpedThermal):
        around = sum(arc.extent for arc in bearing.bore_arcs) or 2.0 * math.pi
        volume = around * R * bearing.length * c
        if (faces := bearing.thrust) is not None:
            ring = math.pi * (faces.outer_radius**2 - faces.inner_radius**2) * faces.clearance
            volume += (faces.lower + faces.upper) * ring
        lumped = LumpedTemperature(spec, oil, volume)
        if bearing.turbulence is not None:
            laws[0].field = lumped.field = ViscosityField()
        return lumped, [], [*laws], [*laws]
    # imported here: only needed for a temperature field, or for temperatures across the film
    from exudyn_ehd.joint.heat.walls import FilmTemperature, Growth

    kind, field = FilmTemperature, ViscosityField()
    if spec.across == 2:
        from exudyn_ehd.joint.heat.across import CubicTemperature, FluidityField

        kind, field = CubicTemperature, FluidityField()
    for law in laws:
        law.field = field
    thermal = kind(spec, bearing, field, grid.shape)
    return thermal, [Growth(thermal)] if thermal.grows else [], [*laws, field], [field, *laws]
