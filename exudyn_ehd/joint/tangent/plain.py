"""Tangent of a plain film in one kernel.

Plain films lie between rigid surfaces, with an oil of constant viscosity, and are linear in their active set. Supply
areas with a known pressure may feed them. `exudyn_ehd.joint.tangent.wrench.wrench_tangent` calls the same kernels one
by one for any film; on small grids the calls from Python take longer than the kernels.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.compilation import YES
from exudyn_ehd.film.banded.substitution import solve_ldl
from exudyn_ehd.film.banded.workspace import dense_band
from exudyn_ehd.film.cavitation.linear_film import column_gradients, couple_columns, rows_of_linear
from exudyn_ehd.film.cavitation.rupture_line import line_gradients, weigh_line
from exudyn_ehd.film.loads import (
    couette_gradient,
    load_adjoint_rhs,
    wrench_gradient,
)
from exudyn_ehd.film.reynolds.balance import link_derivatives
from exudyn_ehd.film.reynolds.gap import add_columns, functional_gradients, link_rows
from exudyn_ehd.film.solvers.matrix import factor_symmetric
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm


def has_plain_tangent(film: SolvedFilm) -> bool:
    """Return whether `plain_tangent` holds for this film.

    The pressures of its supply areas are known, nothing is sheared in them, its ends are open, and no pressure acts on
    the cross sections at which films of arcs end.
    """
    s, p, oil, b = film.solver, film.parts, film.oil, film.parts.bearing
    feeds = p.supply is not None and (p.supply.fed.any() or any(area.depth for area in p.supply.supply))
    pressed = b.bore_arcs and any((*b.edge_pressures, *b.end_pressures))
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
        and b.end_seals is None
        and not (feeds or pressed)
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
