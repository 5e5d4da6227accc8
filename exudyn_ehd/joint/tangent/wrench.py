"""Exact tangent of a bearing's wrench: adjoint solves for its rows, then the chain rule to the motion.

The wrench is linear in integrals S = sum w p of the film, with weights that follow the motion. With the film's residual
r(p, H, H_t, v) = 0 a sum of them changes by ``-lam . dr`` with ``A^T lam = w``, and by what depends on the motion at
fixed pressure. Four integrals carry force and moments, a fifth the shear where fill or pressure enter it; gap terms and
uneven drag together have two more, a contact on a liner five.

Films that rupture as soon as they move have one-sided derivatives.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.cavitation.linear_film import rows_of_linear
from exudyn_ehd.film.gradients import functional_gradients
from exudyn_ehd.film.loads import couette_gradient, integral_weights, load_adjoint_rhs, wrench_gradient
from exudyn_ehd.film.solvers.film import shear_by_unknown
from exudyn_ehd.film.solvers.sor import ClassicSolver
from exudyn_ehd.film.surfaces.contact import add_contact_tangent, contact_weights
from exudyn_ehd.joint.solved_film import MOTION_SIZE, ContactFields, SolvedFilm
from exudyn_ehd.joint.tangent.plain import is_plain, plain_tangent
from exudyn_ehd.joint.tangent.true_gap import (
    add_drag_by_pose,
    drag_by_deflection,
    ratio_of,
    shear_of_fills,
    true_fills,
    true_gradients,
)

# Shares of the clearance. Eccentricity up to which a journal is at the centre: larger than the round-off of a position
# of 1 m in a clearance of 1 um. Eccentricity of the films beside it, by which K and C differ from their limits.
CENTRE, BESIDE = 1e-9, 1e-6
# Share of the wrench, above the square of `BESIDE` and the round-off: larger changes are of first order in the step.
SECOND_ORDER = 10.0 * BESIDE**2
# Largest difference of K or C between a direction and the mean of all, over the mean, up to which that is given; on few
# columns n 2 / n. Bearings that are the same in all directions have at most 0.12 on 17 columns, 0.057 on 31, 0.023 from
# 48 on; an axial groove of 0.3 rad at the cavity pressure over two thirds of the length has 0.16.
LARGEST_SPREAD = 0.05


def quotients(wrench: Callable[[np.ndarray], np.ndarray], motion: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """One-sided derivatives (2, 6, n) of a wrench to the entries of a motion (n,) with a step, from above and below.

    Steps are `BESIDE` of what changes the wrench as a whole: changes of second order are omitted.
    """
    out, middle = np.zeros((2, 6, motion.size)), wrench(motion)
    least = SECOND_ORDER * np.abs(middle).max()
    for k in np.flatnonzero(steps):
        for side, step in zip(out, (steps[k], -steps[k]), strict=True):
            change = wrench(motion + step * np.eye(motion.size)[k]) - middle
            side[:, k] = np.where(np.abs(change) > least, change, 0.0) / step
    return out


def wrench_tangent(film: SolvedFilm, slow_motion: bool = False) -> np.ndarray:
    """d wrench / d motion (6, 10) of a solved film in SI units.

    With ``slow_motion`` the columns of the rates include what a liner's deflection adds to the squeeze when it
    follows a slow motion, ``dH/dt = rigid rate + beta dP/d(pose) rate``: the damping of a steady state.
    """
    if is_plain(film):
        return plain_tangent(film)
    rows = adjoint_rows(film)
    if len(rows) <= 7:
        return motion_tangent(film, film_gradient(film, rows, slow_motion))
    # six rows instead of the film's and the contact's ten and more
    through_film = film_gradient(film, wrench_weights(film) @ rows, slow_motion) * film.parts.motion_scale
    return motion_tangent(film) + through_film


def film_gradient(film: SolvedFilm, rows: np.ndarray, slow_motion: bool) -> np.ndarray:
    """Gradients (k, 10) of sums over the unknowns with weights (k, count) to (scaled pose and rates, vx, vz)."""
    p, s, gradient = film.parts, film.solver, np.empty((len(rows), MOTION_SIZE))
    s.solve_transposed(rows)
    columns = balance_gradients(film)
    functional_gradients(rows, columns, gradient)
    if slow_motion and (p.liner is not None or s.reservoirs is not None):
        gradient[:, 4:8] += _following_storage(film, rows, columns)
    return gradient


def motion_tangent(film: SolvedFilm, gradient: np.ndarray | None = None) -> np.ndarray:
    """d wrench / d motion (6, 10) for a ``gradient`` of the integrals of `adjoint_rows`, SI units; None: at fixed
    unknowns."""
    p, w, scales = film.parts, film.journal, film.scales
    shear, extra, fills = np.zeros(MOTION_SIZE), np.zeros((2, MOTION_SIZE)), true_fills(film)
    if gradient is None:
        gradient = np.zeros((4, MOTION_SIZE))
    else:
        if shear_needs_adjoint(film):
            shear = gradient[4]
        if has_extra_rows(film):
            extra = gradient[-2:]
    if fills is not None:
        shear += fills.weighed(shear_of_fills(film)).columns(p.grid.gap_shapes, 1)[:, 0]
    _contract_couette(film, shear)
    if film.loads.drag is not None:
        add_drag_by_pose(film, extra)
    out = np.empty((6, MOTION_SIZE))
    known = w.pose, film.loads.integrals, p.pose_scale, p.grid.reference_length, scales.force, scales.shear
    sliding = w.omega, w.axial_speed, film.loads.couette
    wrench_gradient(gradient[:4], shear, extra, _boundary_gradients(film), *known, *sliding, out)
    if film.pressing is not None:
        _add_contacts(film, film.pressing, out)
    return out


def _following_storage(film: SolvedFilm, lam: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Gradient (k, 4) of adjoint functionals lam (k, .) to the scaled rates through `FilmAnswers.surroundings`.

    A second adjoint solve. ``columns``: `balance_gradients`. The rupture line adds nothing, since its liner rests.
    """
    p, s, gradient = film.parts, film.solver, np.empty((len(lam), MOTION_SIZE))
    rows = -lam * s.surroundings()
    s.solve_transposed(rows)
    functional_gradients(rows, columns, gradient)
    if p.liner is None:
        return gradient[:, :4]
    at = s.work.order[: s.work.count]
    by_rate = -lam[:, : at.size] * (s.storage_weights()[0] * p.liner.gap_slopes.D_r).reshape(-1)[at]
    followed: np.ndarray = gradient[:, :4] + by_rate @ film.grid.gap_shapes[0].reshape(-1, 4)[at]
    return followed


def balance_gradients(film: SolvedFilm) -> np.ndarray:
    """Gradients (10, count) of the balances at the unknowns to (scaled pose and rates, vx, vz)."""
    s, shapes = film.solver, film.grid.gap_shapes
    if isinstance(s, ClassicSolver):
        return _difference_columns(film, s)
    return true_gradients(film).columns(shapes, s.unknowns)


def _difference_columns(film: SolvedFilm, solver: ClassicSolver) -> np.ndarray:
    """Return `balance_gradients` of central differences."""
    shapes, f = film.grid.gap_shapes[0].reshape(-1, 4), film.limited
    none = np.zeros_like(shapes)
    if f is None:
        return solver.difference_columns(np.hstack((shapes, none)), np.hstack((none, shapes)))
    slope, bend = f.slope.reshape(-1, 1) * shapes, f.bend.reshape(-1, 1) * shapes
    return solver.difference_columns(np.hstack((slope, none)), np.hstack((bend, slope)))


def shear_needs_adjoint(film: SolvedFilm) -> bool:
    """Return whether fill or pressure enter the Couette shear."""
    s, oil = film.solver, film.oil
    by_pressure = oil.ratio_q is not None or oil.ratio_g is not None
    return s.closure.conserves_mass or by_pressure or film.parts.liner is not None


def has_extra_rows(film: SolvedFilm) -> bool:
    """Return whether `adjoint_rows` has two rows for the slopes of gap terms and for uneven drag."""
    return film.extra is not None or film.loads.drag is not None


def integrals_in_wrench(film: SolvedFilm) -> np.ndarray:
    """Weights (6, 8) of S_c, S_s, S_zc, S_zs, C, slopes in theta and z, and the ends' force in the wrench."""
    w, scales, out = film.journal, film.scales, np.empty((6, 8))
    size = film.grid.reference_length
    integral_weights(w.pose, size, scales.force, scales.shear, w.omega, w.axial_speed, out)
    return out


def wrench_weights(film: SolvedFilm) -> np.ndarray:
    """Weights (6, k) of the integrals of `adjoint_rows` in the wrench."""
    whole, shear, extra = integrals_in_wrench(film), shear_needs_adjoint(film), has_extra_rows(film)
    parts = [whole[:, : 4 + shear], whole[:, 5 : 5 + 2 * extra]]
    if film.parts.liner is not None and film.pressing is not None:
        motion, R = film.journal.motion, film.grid.reference_length
        parts.append(contact_weights(motion, *film.pressing.friction[0], R))
    return np.concatenate(parts, axis=1)


def wrench_rows(film: SolvedFilm) -> np.ndarray:
    """Weights (6, count) of the unknowns in the wrench, N and Nm."""
    rows: np.ndarray = wrench_weights(film) @ adjoint_rows(film)
    return rows


def adjoint_rows(film: SolvedFilm) -> np.ndarray:
    """Weights of the unknowns in the integrals that they enter, (k, count); those of supply areas come last."""
    s, w = film.solver, film.solver.work
    rows = _rows_at(film, w.order[: w.count], s.system.continued)
    if (r := s.reservoirs) is None:
        return rows
    by_unknown = _rows_at(film, r.at, None) @ r.within() / s.pressure_scale
    return np.hstack((rows, by_unknown * r.transformed()[1][r.live]))


def _rows_at(film: SolvedFilm, at: np.ndarray, continued: np.ndarray | None) -> np.ndarray:
    """Return `adjoint_rows` of flat vertices ``at``, by the solver's unknown; ``continued`` as for `FilmSystem`."""
    g, s, y, oil, liner = film.grid, film.solver, film.solver.system, film.oil, film.parts.liner
    active, shear, extra = s.work.active | g.fixed, shear_needs_adjoint(film), has_extra_rows(film)
    pressed = liner is not None and film.pressing is not None
    own = 4 + shear + 2 * extra
    rows = np.zeros((own + 5 * pressed, at.size))
    load_adjoint_rhs(at, at.size, g.weight, g.gap_shapes, active, rows)
    if extra:
        slopes = np.zeros((2, *g.shape)) if film.loads.drag is None else film.loads.drag
        if film.extra is not None:
            slopes = slopes + g.weight * np.stack((film.extra.slope_x, film.extra.slope_z))
        rows[own - 2 : own] = (slopes * active).reshape(2, -1)[:, at]
    if oil.P_q is not None:
        rows[:4] *= oil.P_q.ravel()[at]
        rows[own - 2 * extra : own] *= oil.P_q.ravel()[at]
    if shear:
        rows[4] = _shear_weights(film, active).ravel()[at]
    if continued is not None:
        rows_of_linear(continued, y.fixed, y.linked, y.cavity_pressure, s.work.active, s.work.number, rows)
    # what follows the pressure of a vertex itself
    if liner is not None or oil.ratio_g is not None:
        rows[4] += _shear_of_vertices(film, active).ravel()[at]
    if liner is not None and film.loads.drag is not None:
        rows[own - 2 : own] += drag_by_deflection(film, liner).reshape(2, -1)[:, at]
    if liner is not None and pressed:
        by_pressure = g.weight * liner.contact_by_pressure
        load_adjoint_rhs(at, at.size, by_pressure, g.gap_shapes, active, rows[own:])
        rows[own + 4] = by_pressure.ravel()[at]
    return rows


def _shear_weights(film: SolvedFilm, active: np.ndarray) -> np.ndarray:
    """Weights of the Couette integral at the vertices (n, m).

    Through the oil's pressure where they are pressures, through fill elsewhere.
    """
    s, y, g, oil, out = film.solver, film.solver.system, film.grid, film.oil, np.empty(film.grid.shape)
    by_pressure = s.nothing if oil.ratio_q is None else oil.ratio_q
    if not s.closure.conserves_mass:
        return g.shear_weight / s.H * by_pressure * active
    rise = s.nothing if s.oil_line is None else s.oil_line.rise
    oils = ratio_of(film), by_pressure, s.fill, rise
    shear_by_unknown(g.shear_weight, s.H, *oils, active, g.fixed, s.pressure, y.cavity_pressure, out)
    return out


def _shear_of_vertices(film: SolvedFilm, active: np.ndarray) -> np.ndarray:
    """Return what in `_shear_weights` follows the liner's deflection and the pressure's gradients."""
    p, s, g, oil, out = film.parts, film.solver, film.grid, film.oil, np.zeros(film.grid.shape)
    if p.liner is not None:
        out += couette_slopes(film)[0] * p.liner.gap_slopes.H_P * active
    if oil.ratio_g is not None:
        out += film.gather_shear(oil.ratio_g * g.shear_weight * film.share() / s.H)
    return out


def couette_slopes(film: SolvedFilm) -> tuple[np.ndarray, float]:
    """dC/d(film gap) (n, m) and dC/dvx at fixed pressure and fill."""
    s, g, oil, recess = film.solver, film.grid, film.oil, film.loads.recess
    by_speed = 0.0 if recess is None else 2.0 * float(recess.by_spin.sum())  # vx = omega / 2
    if oil.ratio is None and not s.closure.conserves_mass:
        by_gap = np.empty(g.shape)
        couette_gradient(s.H, g.shear_weight, s.work.active, g.fixed, s.closure.cavity_shear, by_gap)
        return by_gap, by_speed
    density = g.shear_weight * film.share() / s.H
    by_gap = density * ((0.0 if oil.ratio_h is None else oil.ratio_h) - ratio_of(film) / s.H)
    return by_gap, by_speed if oil.ratio_v is None else by_speed + float(np.vdot(density, oil.ratio_v))


def _contract_couette(film: SolvedFilm, dc: np.ndarray) -> None:
    """Add the gradient of C at fixed pressure and fill to ``dc`` (10,)."""
    slope, (gradient, by_speed) = _film_gap_slope(film), couette_slopes(film)
    dc[8] += by_speed
    if slope is not None:
        gradient *= slope
    dc[:4] += film.grid.by_pose(gradient[None])[0]


def _film_gap_slope(film: SolvedFilm) -> np.ndarray | None:
    """d(film gap)/d(gap of the undeformed surfaces) (n, m) at fixed pressure; None where it is one."""
    if film.parts.liner is not None:
        return film.parts.liner.gap_slopes.H_r
    return None if film.limited is None else film.limited.slope


def _add_contacts(film: SolvedFilm, f: ContactFields, out: np.ndarray) -> None:
    """Add the gradient of the contacts' wrench, pressures and friction, to ``out`` (6, 10), SI units."""
    p, g, motion = film.parts, film.grid, film.journal.motion
    for k, (friction, transition) in enumerate(f.friction):
        if f.integrals[k, 4] != 0.0:
            add_contact_tangent(
                f.slope[k],
                g.weight,
                g.moments,
                motion,
                p.pose_scale,
                friction,
                transition,
                g.reference_length,
                f.integrals[k],
                out,
            )


def _boundary_gradients(film: SolvedFilm) -> np.ndarray:
    """Gradients (2, 4) of the pressure force of the ends, and of the edges of arcs, to the scaled pose.

    That of a ring's ends vanishes but where a limiter or a contact acts on the gap.
    """
    slope, edges, g = _film_gap_slope(film), film.scales.edges, film.grid
    whole = slope is None and not g.edges.size
    if edges is None and (whole or not film.scales.ends.any()):
        return np.zeros((2, 4))
    fields = np.zeros((2, *g.shape))
    fields[0][:, [0, -1]] = np.outer(g.width_x, film.scales.ends * (-1.0, 1.0))
    if edges is not None:
        fields[1, g.edges.ravel()] = np.outer(edges, g.weight_z)
    return g.by_pose(fields if slope is None else fields * slope)
