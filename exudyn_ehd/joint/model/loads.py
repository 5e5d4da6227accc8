"""Loads of a film on the journal."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.loads import Scales, couette_integral, journal_wrench, pressure_integrals
from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.film import shear_share
from exudyn_ehd.film.supply.cuts import RecessShear, recess_shear
from exudyn_ehd.film.surfaces import roughness
from exudyn_ehd.film.surfaces.contact import add_contact
from exudyn_ehd.joint.heat.temperature import OilTemperature
from exudyn_ehd.joint.solved_film import (
    FilmParts,
    GapState,
    JournalMotion,
    LimiterFields,
    Loads,
)


def film_loads(
    parts: FilmParts,
    scales: Scales,
    journal: JournalMotion,
    oil: OilFields,
    gap: GapState,
    recess: RecessShear | None = None,
) -> Loads:
    """Loads of the film whose solution is in the buffers of ``parts.solver``."""
    s, g, P, (_, extra, pressing, limited) = parts.solver, parts.grid, oil.P, gap
    integrals = np.empty(4)
    pressure_integrals(P, g.weight, g.gap_shapes, integrals)
    extra_theta = extra_z = 0.0
    if extra is not None:
        pressed = P * g.weight
        extra_theta, extra_z = float(np.vdot(pressed, extra.slope_x)), float(np.vdot(pressed, extra.slope_z))
    if parts.liner is not None:
        # Poiseuille shear by the slope of the deflection: p d(beta p)/dz integrates to beta p^2 / 2 at the ends.
        half, signs = 0.5 * parts.liner.beta, np.tile([-1.0, 1.0], len(g.edges))
        around = float(g.width_x.sum()) if signs.size else 2.0 * math.pi
        extra_z += half * around * float(scales.ends[1] ** 2 - scales.ends[0] ** 2)
        if scales.edges is not None:
            extra_theta += half * float(signs @ scales.edges**2) * float(g.weight_z.sum())
    # where the shear of a pressure gradient on a surface differs from half its force on the true gap
    lined, drag = parts.liner is not None and parts.liner.limiter is not None, None
    if parts.uneven_drag or limited is not None or lined:
        drag = drag_weights(parts, limited)
        extra_theta += float(np.vdot(drag[0], P))
        extra_z += float(np.vdot(drag[1], P))
    if oil.ratio is None and not s.closure.conserves_mass:
        couette = couette_integral(s.H, g.shear_weight, s.work.active, g.fixed, s.closure.cavity_shear)
    else:
        sheared = g.shear_weight * shear_share(s.system, s.work.active, s.closure)
        couette = float(np.vdot(sheared, (1.0 if oil.ratio is None else oil.ratio) / s.H))
    if recess is not None:
        couette += float(recess.density.sum())
    if scales.edges is not None:
        # gap times pressure over the trailing edges of arcs, minus that over their leading edges
        extra_theta -= float(np.dot(scales.edges, s.H[g.edges.ravel()] @ g.weight_z))
    wrench = np.empty(6)
    s_theta = journal_wrench(
        journal.pose,
        integrals,
        couette,
        extra_theta,
        extra_z,
        s.H,
        g.width_x,
        scales.ends,
        (scales.force, scales.shear, g.reference_length),
        (journal.omega, journal.axial_speed),
        wrench,
    )
    contact = np.zeros(6)
    if pressing is not None:
        for P_c, sums, (friction, transition) in zip(pressing.P, pressing.integrals, pressing.friction, strict=True):
            at = friction, transition, g.reference_length
            add_contact(P_c, g.weight, g.moments, journal.motion, *at, sums, contact, wrench)
    return Loads(wrench, contact, integrals, couette, s_theta, recess, drag)


def drag_weights(parts: FilmParts, limited: LimiterFields | None) -> np.ndarray:
    """Weights (2, n, m) of the pressures in the drag integrals E_x and E_z, for the film in ``parts.solver``."""
    s, liner = parts.solver, parts.liner
    gap, link = s.H, s.HF
    if limited is not None:
        gap, link = limited.gap, limited.link
    elif liner is not None and liner.limiter is not None:
        gap, link = liner.true_gap, liner.true_link
    carriers = (s.HF, on_links(s.H)[1])
    if parts.uneven_drag and s.flux is not None:
        carriers = s.flux.cx, s.flux.cz
    return roughness.drag_weights(carriers, gap, link, parts.grid.link_widths)


def recess_of(
    parts: FilmParts,
    scales: Scales,
    journal: JournalMotion,
    thermal: OilTemperature | None,
    temperature: float | np.ndarray | None,
) -> RecessShear | None:
    """Shear of the oil in supply areas at a film temperature, K; None if no area has a depth."""
    supply = parts.supply
    if supply is None or all(area.depth is None for area in supply.supply):
        return None
    b, R, c = parts.bearing, parts.grid.reference_length, parts.bearing.radial_clearance
    viscosity = np.asarray(b.lubricant.viscosity)
    if thermal is not None and temperature is not None:
        viscosity = viscosity * thermal.viscosity_ratio(temperature)
    oil = viscosity * R**2 / (c * scales.shear), b.lubricant.density * R / viscosity
    return recess_shear([area.depth for area in supply.supply], supply.parts, c, journal.omega, oil)
