"""A plain film with its loads in one kernel, and its tangent in another one.

Plain films lie between rigid surfaces, with an oil of constant viscosity, by Swift-Stieber's condition; the tangent is
that of any film that is linear in its active set. Supply areas with a known pressure may feed the film.

`exudyn_ehd.joint.model.rigid.BearingModel.evaluate` and `exudyn_ehd.joint.tangent.wrench.wrench_tangent` call the same
kernels one by one for any film. On small grids the calls from Python take longer than the kernels.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.compilation import YES
from exudyn_ehd.film.banded.substitution import solve_ldl
from exudyn_ehd.film.banded.workspace import dense_band
from exudyn_ehd.film.cavitation.linear_film import column_gradients, couple_columns, extend_film, rows_of_linear
from exudyn_ehd.film.cavitation.rupture_line import line_gradients, weigh_line
from exudyn_ehd.film.loads import (
    couette_gradient,
    couette_integral,
    journal_wrench,
    load_adjoint_rhs,
    pressure_integrals,
    wrench_gradient,
)
from exudyn_ehd.film.reynolds.balance import link_derivatives, right_hand_side
from exudyn_ehd.film.reynolds.gap import add_columns, functional_gradients, link_rows, rigid_gaps
from exudyn_ehd.film.reynolds.links import set_links
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.matrix import factor_symmetric
from exudyn_ehd.film.solvers.newton import solve_rupturing
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.joint.solved_film import MOTION_SIZE, FilmParts, History, JournalMotion, Loads, Scales, SolvedFilm


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


def has_plain_tangent(film: SolvedFilm) -> bool:
    """Return whether `plain_tangent` holds for this film."""
    s, p, oil = film.solver, film.parts, film.oil
    return (
        type(s) is FilmSolver
        and s.axial
        and s.symmetric
        and not s.closure.clips
        and s.flux is None
        and oil.P_q is None
        and oil.ratio is None
        and film.extra is None
        and film.limited is None
        and film.pressing is None
        and has_plain_supply(p)
        and has_plain_edges(p.bearing)
    )


def plain_tangent(film: SolvedFilm) -> np.ndarray:
    """d wrench / d motion (6, 10) in SI units of a film for which `has_plain_tangent` holds."""
    s, p, g, w, scales, out = film.solver, film.parts, film.grid, film.journal, film.scales, np.empty((6, MOTION_SIZE))
    y, line, work = s.system, s.line, s.work
    _plain_tangent(
        y.film,
        line is not None,
        y.column_line,
        work.symmetric,
        (work.count, work.width),
        work.exact,
        (s.area if s.squeeze else s.nothing, s.nothing, g.weight, g.shear_weight, s.metric),
        work.active,
        g.gap_shapes,
        g.mesh,
        (s.vx, s.vz, s.flow_x, s.closure.cavity_shear, s.squeeze, y.cavity_pressure),
        (w.pose, film.loads.integrals, film.loads.couette, p.pose_scale),
        ((scales.force, scales.shear, g.reference_length), (w.omega, w.axial_speed)),
        out,
    )
    work.exact = True
    return out


@njit(cache=True, nogil=True)
def _plain_tangent(film, ends, between, matrix, size, exact, fields, active, shapes, mesh, speeds, loads, scales, out):
    """Write the tangent to ``out``.

    ``film``: `FilmSystem.film`; ``ends``: whether the rupture line may lie inside cells; ``between``: `ColumnLine` or
    None;
    ``exact``: whether the factor is that of the solution.
    """
    (order, number, _, upper, inv_diag, _, _), (count, width) = matrix, size
    terms, fixed, _, line = film
    H, HF, P = terms[11], terms[12], terms[14]
    by_rate, by_gap, weight, shear_weight, metric = fields
    vx, vz, flow_x, cavity_shear, squeeze, pc = speeds
    if not exact:
        factor_symmetric(film, matrix, active, (YES, count, width))
    lam = np.empty((4, count))
    load_adjoint_rhs(order, count, weight, shapes, active, lam)
    if between is not None:
        _, linked, _, P, u = between
        rows_of_linear(u, fixed, linked, pc, active, number, lam)
        couple_columns(between, active, matrix, count, lam.T, True)
    solve_ldl(dense_band(upper, count, width), inv_diag, count, width, lam)
    by_links, by_speed = np.empty((4, H.size)), np.empty((3, H.size))
    columns, whole = np.zeros((10, count)), np.empty((10, count))
    up = np.ones((2, H.size))
    link_derivatives(P, H, HF, None, up, None, metric, vx, vz, by_links, by_speed)
    link_rows(order, count, H.shape[1], by_links, by_speed, None, (by_rate, by_gap), whole)
    add_columns(np.arange(count), order[:count], whole, shapes, columns)
    if ends:
        rows, places, weights = weigh_line(line, number)
        by = np.zeros((10, places.size))
        line_gradients(places, weights, H, HF, None, None, vx, vz, flow_x, squeeze, mesh, by)
        add_columns(rows, places, by, shapes, columns)
    if between is not None:
        rows, places, by = column_gradients(between, active, order, count, pc, H, None)
        add_columns(rows, places, by, shapes, columns)
    changes, field = np.zeros((8, 10)), np.empty(H.shape)
    functional_gradients(lam, columns, changes[:4])
    couette_gradient(H, shear_weight, active, fixed, cavity_shear, field)
    by_gap, by_pose = field.reshape(-1), shapes[0].reshape(-1, 4)
    for c in range(by_gap.size):
        for q in range(4):
            changes[4, q] += by_gap[c] * by_pose[c, q]
    wrench_gradient(changes, *loads, *scales, out)
