"""A plain film with its loads in one kernel: rigid surfaces, an oil of constant viscosity, Swift-Stieber's condition.

Supply areas with a known pressure may feed the film.

`exudyn_ehd.joint.model.rigid.BearingModel.evaluate` calls the same kernels one by one for any film. On small grids the
calls from Python take longer than the kernels.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.linear_film import extend_film
from exudyn_ehd.film.loads import couette_integral, journal_wrench, pressure_integrals
from exudyn_ehd.film.reynolds.gap import rigid_gaps
from exudyn_ehd.film.reynolds.links import right_hand_side, set_links
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.newton import solve_rupturing
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.joint.solved_film import FilmParts, History, JournalMotion, Loads, Scales, SolvedFilm


def has_plain_edges(bearing: JournalBearing) -> bool:
    """Return whether the ends are open, and no pressure acts on the cross sections at which films of arcs end."""
    pressed = bearing.bore_arcs and any((*bearing.edge_pressures, *bearing.end_pressures))
    return bearing.end_seals is None and not pressed


def has_plain_supply(parts: FilmParts) -> bool:
    """Return whether all supply areas have a known pressure, and nothing is sheared in them."""
    supply = parts.supply
    return supply is None or not (supply.fed.any() or any(area.depth for area in supply.supply))


def is_plain(parts: FilmParts) -> bool:
    """Return whether `solve_plain` can solve films of these parts, without further effects."""
    s = parts.solver
    return (
        type(s) is FilmSolver
        and s.axial
        and s.complementary
        and not s.closure.conserves_mass
        and has_plain_supply(parts)
        and has_plain_edges(parts.bearing)
    )


def solve_plain(
    parts: FilmParts,
    scales: Scales,
    motion: np.ndarray,
    known: np.ndarray,
    least: float,
    begin: tuple[History | None, float, float | np.ndarray | None],
) -> tuple[SolvedFilm | None, int]:
    """Solve the film of a motion (10,), and return it with the number of linear solves.

    The previous film is the initial guess. The film is None if the smallest scaled gap is not above ``least`` or no
    solution was found. ``known`` (3,): scaled pressures at both ends and in the cavity; ``begin``: ``history``,
    ``step`` and ``temperature`` of `SolvedFilm`.
    """
    s = parts.solver
    y, line, work, g = s.system, s.line, s.work, parts.grid
    out = np.empty(18)
    end, count, smallest, couette, s_theta = _plain_film(
        motion,
        parts.motion_scale,
        known,
        (scales.force, scales.shear, g.reference_length, parts.half_length, s.closure.cavity_shear, least),
        (s.squeeze, line is not None, work.warm),
        (g.directions, g.gap_shapes),
        (g.mesh, s.metric),
        (g.weight, g.shear_weight),
        work.active,
        y.film,
        y.column_line,
        work.size,
        (work.symmetric, (work.u, work.above, None), work.residual, work.unknowns),
        out,
    )
    if end[2] < 0:
        return None, 0
    work.warm, steps = work.take_end(*end)
    work.count = count
    if y.column_line is not None:
        work.ready, work.exact = False, work.warm
    if not work.warm:
        return None, steps
    _, _, _, _, _, _, _, _, omega, axial_speed = motion.tolist()
    s.vx, s.vz = 0.5 * omega, 0.5 * axial_speed / g.reference_length
    y.cavity_pressure = float(known[2])
    journal = JournalMotion(motion, out[10:14], out[14:], omega, axial_speed)
    film = SolvedFilm(
        parts,
        g,
        s,
        scales,
        journal,
        *begin,
        None,
        None if parts.contacts is None else parts.contacts.press(s.H, smallest),
        None,
        OilFields(y.pressure),
        Loads(out[:6], np.zeros(6), out[6:10], couette, s_theta),
        parts.bearing.radial_clearance * smallest,
        None,
        parts.evaluations,
    )
    return film, steps


@njit(cache=True, nogil=True)
def _plain_film(motion, scale, known, sizes, kinds, normals, links, weights, active, film, columns, size, work, out):
    """Return (end of `solve_film`, number of unknowns, smallest gap, integral of the Couette shear, s_theta).

    If the gap is not above the smallest one allowed, the number of steps is -1.

    ``kinds``: whether there is a squeeze, whether the rupture line lies inside the cells, whether the start is warm;
    ``weights``: integration weights (n, m) of the pressure and of the shear;
    ``columns``: `ColumnLine` or None; ``out`` (18,): wrench, integrals of the pressure, scaled pose and rates.
    """
    force, shear, radius, half_length, cavity_shear, least = sizes
    (squeeze, in_cells, warm), (mesh, metric), pc = kinds, links, known[2]
    vx, vz = 0.5 * motion[8], 0.5 * motion[9] / radius
    fields, fixed, _, _ = film
    fx, fz, b = fields[2], fields[3], fields[10]
    H, HF, H_t, P = fields[11], fields[12], fields[13], fields[14]
    (matrix, state, residual, x), (at, shapes) = work, normals
    for q in range(8):
        out[10 + q] = motion[q] * scale[q]
    pose, rate, integrals = out[10:14], out[14:], out[6:10]
    smallest = rigid_gaps(pose, rate, squeeze, at, half_length, mesh[2][-1] != 0.0, H, HF, H_t)
    # the comparison is False for gaps that are not finite
    if not (smallest > least and np.isfinite(vx + vz + rate[0] + rate[1] + rate[2] + rate[3])):
        return (False, False, -1, size[1], size[2]), size[1], smallest, 0.0, 0.0
    set_links(H, HF, None, metric, vx, vz, fields)
    right_hand_side(fx, fz, squeeze, H_t, fields[7], b)
    places = P, residual, x, None
    end = solve_rupturing(size, pc, in_cells, warm, H_t, active, state, film, matrix, places)
    count = end[3]
    if columns is not None:
        count = extend_film(columns, b, (fixed, active), pc, matrix, end[3:], P)
    pressure_integrals(P, weights[0], shapes, integrals)
    couette = couette_integral(H, weights[1], active, fixed, cavity_shear)
    speeds = motion[8], motion[9]
    scales, ends = (force, shear, radius), (H, mesh[0], known)
    s_theta = journal_wrench(pose, integrals, couette, 0.0, 0.0, *ends, scales, speeds, out)
    return end, count, smallest, couette, s_theta
