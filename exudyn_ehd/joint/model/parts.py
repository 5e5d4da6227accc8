"""Grid, solver and buffers of a bearing model: what stays from evaluation to evaluation."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.grid import Directions, FilmGrid
from exudyn_ehd.film.models import film_grid, film_solver
from exudyn_ehd.film.solvers.liner.winkler import Liner
from exudyn_ehd.film.supply.cuts import SupplyMap
from exudyn_ehd.film.surfaces.contact import Contact, LandContact
from exudyn_ehd.joint.seams import Effects
from exudyn_ehd.joint.solved_film import ContactFields, Evaluations, FilmParts, LimiterFields


def _supply_map(bearing: JournalBearing, grid: FilmGrid) -> SupplyMap | None:
    around = getattr(bearing.film, "circumferential_pressure_flow", True)
    return SupplyMap(bearing.supply, grid, around) if bearing.supply else None


def grid_of(bearing: JournalBearing, start_angle: float = 0.0, open_ring: bool = False) -> FilmGrid:
    """Grid of a bearing's film that starts at ``start_angle``, rad."""
    return film_grid(
        bearing.film,
        bearing.journal_radius,
        bearing.length,
        start_angle=start_angle,
        open_ring=open_ring,
        supply=bearing.supply,
        conserves_mass=bearing.closure.conserves_mass,
        arc=bearing.arc,
    )


def film_parts(bearing: JournalBearing, effects: Effects, start_angle: float) -> FilmParts:
    """Parts of the model of a bearing with its effects, on the grid that starts at ``start_angle``, rad."""
    R, c = bearing.journal_radius, bearing.radial_clearance
    open_ring = isinstance(bearing.inlet, MaximumGap)
    grid = grid_of(bearing, start_angle, open_ring)
    supply = _supply_map(bearing, grid)
    grid = grid if supply is None else supply.grid
    touching: list[Contact] = list(effects.contacts)
    if supply is not None:
        touching = [LandContact(contact, supply.land) for contact in effects.contacts]
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
    liner = None if effects.liner is None else solver.elements
    contacts = None
    if touching:
        contacts = ContactFields(grid.shape, touching)
        if liner is not None:
            # contact and film gap on a liner come out of its film solve
            contacts.P, contacts.slope = [liner.contact_pressure], [liner.contact_slope]
    pose_scale = np.array([1.0 / c, 1.0 / c, R / c, R / c])
    return FilmParts(
        bearing=bearing,
        grid=grid,
        solver=solver,
        liner=liner,
        compressible=None if effects.density is None else solver,
        supply=supply,
        contacts=contacts,
        limiter=LimiterFields(grid.shape) if effects.limiter is not None and liner is None else None,
        directions=Directions(*grid.directions),
        half_length=0.5 * bearing.length / R,
        pose_scale=pose_scale,
        motion_scale=np.concatenate((pose_scale, pose_scale, (0.5, 0.5 / R))),
        flow_scale=c * R**2,
        uneven_drag=effects.uneven_drag,
        evaluations=Evaluations(),
    )
