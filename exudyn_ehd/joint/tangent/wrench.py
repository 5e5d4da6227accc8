"""Exact tangent of a bearing's wrench: adjoint solves for its rows, then the chain rule to the motion.

The wrench is linear in integrals S = sum w p of the film, with weights that depend on the motion. With the film's
residual r(p, H, H_t, v) = 0 an integral changes by ``-lam . dr`` with ``A^T lam = w``, plus terms that depend on the
motion at fixed pressure. Four integrals give force and moments. A fifth one is the shear, if it depends on fill or
pressure. Gap terms and uneven drag together add two integrals, a contact on a liner adds five.

The true gap is that of the surfaces. If a limiter acts, the film's gap differs from it. If they differ, or if the
surfaces' roughnesses differ, a pressure gradient exerts different drag on both surfaces, see
`exudyn_ehd.film.surfaces.roughness`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.linear_film import rows_of_linear
from exudyn_ehd.film.loads import couette_gradient, integral_weights, load_adjoint_rhs, wrench_gradient
from exudyn_ehd.film.reynolds.gap import Gradients, functional_gradients, join, to_ends
from exudyn_ehd.film.solvers.film import at_beside_ends, shear_by_unknown
from exudyn_ehd.film.solvers.liner import LinerFilm
from exudyn_ehd.film.solvers.sor import ClassicSolver
from exudyn_ehd.film.surfaces import roughness
from exudyn_ehd.film.surfaces.contact import contact_tangent, contact_weights
from exudyn_ehd.joint.solved_film import MOTION_SIZE, ContactFields, SolvedFilm
from exudyn_ehd.joint.tangent.plain import has_plain_tangent, plain_tangent


def wrench_tangent(film: SolvedFilm, slow_motion: bool = False) -> np.ndarray:
    """d wrench / d motion (6, 10) of a solved film in SI units.

    With ``slow_motion`` the columns of the rates include the squeeze by a liner whose deflection follows a slow motion,
    ``dH/dt = rigid rate + beta dP/d(pose) rate``: the damping of a steady state.
    """
    if has_plain_tangent(film):
        return plain_tangent(film)
    rows = adjoint_rows(film)
    if len(rows) <= 7:
        return motion_tangent(film, film_gradient(film, rows, slow_motion))
    # adjoint solves for the six components of the wrench, which are fewer than the integrals
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
    """d wrench / d motion (6, 10), SI units, for a ``gradient`` of the integrals of `adjoint_rows`.

    ``gradient`` None: derivative at fixed unknowns.
    """
    p, w, scales = film.parts, film.journal, film.scales
    changes, fills = np.zeros((8, MOTION_SIZE)), true_fills(film)
    shear, extra = changes[4], changes[5:7]
    if gradient is not None:
        changes[:4] = gradient[:4]
        if shear_needs_adjoint(film):
            shear[:] = gradient[4]
        if has_extra_rows(film):
            extra[:] = gradient[-2:]
    if fills is not None:
        shear += fills.weighed(shear_of_fills(film)).columns(p.grid.gap_shapes, 1)[:, 0]
    by_gap, by_speed = couette_field(film)
    shear[:4] += p.grid.by_pose(by_gap[None])[0]
    shear[8] += by_speed
    if film.loads.drag is not None:
        add_drag_by_pose(film, extra)
    ends, edges = _boundary_gradients(film)
    changes[7, :4] = ends
    extra[0, :4] -= edges
    out, loads = np.empty((6, MOTION_SIZE)), (w.pose, film.loads.integrals, film.loads.couette, p.pose_scale)
    size = scales.force, scales.shear, p.grid.reference_length
    wrench_gradient(changes, *loads, size, (w.omega, w.axial_speed), out)
    if film.pressing is not None:
        _add_contacts(film, film.pressing, out)
    return out


def _following_storage(film: SolvedFilm, lam: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Gradient (k, 4) of adjoint functionals lam (k, .) to the scaled rates through `FilmAnswers.surroundings`.

    It needs a second adjoint solve. ``columns``: `balance_gradients`. The rupture line has no part in it, since the
    liner's rate is not included in its position.
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
    """Return `balance_gradients` of the solver with central differences."""
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
    """Weights (6, 8) in the wrench of S_c, S_s, S_zc, S_zs, C, slopes in theta and z, and the ends' force."""
    w, scales, out = film.journal, film.scales, np.empty((6, 8))
    size = scales.force, scales.shear, film.grid.reference_length
    integral_weights(w.pose, size, (w.omega, w.axial_speed), out)
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
    """Weights (k, count) of the unknowns in the integrals; those of supply areas come last."""
    s, w = film.solver, film.solver.work
    rows = _rows_at(film, w.order[: w.count], s.system.continued)
    if (r := s.reservoirs) is None:
        return rows
    by_unknown = _rows_at(film, r.at, None) @ r.within() / s.pressure_scale
    return np.hstack((rows, by_unknown * r.transformed()[1][r.live]))


def _rows_at(film: SolvedFilm, at: np.ndarray, continued: np.ndarray | None) -> np.ndarray:
    """Return `adjoint_rows` at vertices with the flat indices ``at``; ``continued`` as for `FilmSystem`."""
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
        rows[4] = shear_weights(film, g.shear_weight).ravel()[at]
    if continued is not None:
        rows_of_linear(continued, y.fixed, y.linked, y.cavity_pressure, s.work.active, s.work.number, rows)
    # terms that depend on the pressure of the vertex itself
    if liner is not None or oil.ratio_g is not None:
        rows[4] += _shear_of_vertices(film, active).ravel()[at]
    if liner is not None and film.loads.drag is not None:
        rows[own - 2 : own] += drag_by_deflection(film, liner).reshape(2, -1)[:, at]
    if liner is not None and pressed:
        # d(contact pressure)/dP, Pa
        by_pressure = g.weight * liner.touching * liner.contact_G * liner.scale * liner.deflection_by_pressure
        load_adjoint_rhs(at, at.size, by_pressure, g.gap_shapes, active, rows[own:])
        rows[own + 4] = by_pressure.ravel()[at]
    return rows


def shear_weights(film: SolvedFilm, weight: np.ndarray) -> np.ndarray:
    """Weights (n, m) of the unknowns in the integral of the Couette shear with the integration weights ``weight``.

    Pressures act through the viscosity ratio, fills through the sheared share.
    """
    s, y, g, oil, out = film.solver, film.solver.system, film.grid, film.oil, np.empty(film.grid.shape)
    active = s.work.active | g.fixed
    by_pressure = s.nothing if oil.ratio_q is None else oil.ratio_q
    if not s.closure.conserves_mass:
        return weight / s.H * by_pressure * active
    rise = s.nothing if s.oil_line is None else s.oil_line.rise
    oils = ratio_of(film), by_pressure, s.fill, rise
    shear_by_unknown(weight, s.H, *oils, active, g.fixed, s.pressure, y.cavity_pressure, out)
    return out


def _shear_of_vertices(film: SolvedFilm, active: np.ndarray) -> np.ndarray:
    """Return the part of the shear weights (n, m) through the liner's deflection and the pressure's gradients."""
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


def couette_field(film: SolvedFilm) -> tuple[np.ndarray, float]:
    """dC/dH (n, m) with the true gap H, and dC/dvx, at fixed pressure and fill."""
    slope, (gradient, by_speed) = _film_gap_slope(film), couette_slopes(film)
    return gradient if slope is None else gradient * slope, by_speed


def _film_gap_slope(film: SolvedFilm) -> np.ndarray | None:
    """d(film gap)/d(gap of the undeformed surfaces) (n, m) at fixed pressure; None if it is one everywhere."""
    if film.parts.liner is not None:
        return film.parts.liner.gap_slopes.H_r
    return None if film.limited is None else film.limited.slope


def _add_contacts(film: SolvedFilm, f: ContactFields, out: np.ndarray) -> None:
    """Add the gradient of the contacts' wrench, pressures and friction, to ``out`` (6, 10), SI units."""
    p, g, motion = film.parts, film.grid, film.journal.motion
    for k, (friction, transition) in enumerate(f.friction):
        if f.integrals[k, 4] != 0.0:
            law = friction, transition, g.reference_length
            out += contact_tangent(f.slope[k], g.weight, g.moments, motion, p.pose_scale, *law, f.integrals[k])


def boundary_fields(film: SolvedFilm) -> np.ndarray:
    """Gradients (2, n, m), to the true gap, of the pressure force on the ends and on the edges of arcs."""
    slope, edges, g = _film_gap_slope(film), film.scales.edges, film.grid
    fields = np.zeros((2, *g.shape))
    fields[0][:, [0, -1]] = np.outer(g.width_x, film.scales.ends * (-1.0, 1.0))
    if edges is not None:
        fields[1, g.edges.ravel()] = np.outer(edges, g.weight_z)
    return fields if slope is None else fields * slope


def _boundary_gradients(film: SolvedFilm) -> np.ndarray:
    """Gradients (2, 4) of `boundary_fields` to the scaled pose.

    For the ends of a full ring they vanish unless a limiter or a contact acts on the gap.
    """
    whole = _film_gap_slope(film) is None and not film.grid.edges.size
    if film.scales.edges is None and (whole or not film.scales.ends.any()):
        return np.zeros((2, 4))
    return film.grid.by_pose(boundary_fields(film))


def drag_by_gap(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients of the drag integrals E_x and E_z to the true gap, at fixed pressure.

    The first is that of E_x on the links i -> i+1 (1, n, m), the second that of E_z at the vertices (1, n, m). On a
    liner they are gradients to the gap of the undeformed surfaces, with the contact's deflection; the second one then
    has E_x and E_z at the vertices (2, n, m).
    """
    face, cell = _slopes(film)
    if film.parts.liner is None:
        return face[None], cell[None]
    deflection = film.parts.liner.gap_slopes.D_r
    return face[None], np.stack((to_ends(face, 0) * deflection, cell * (1.0 + deflection)))


def add_drag_by_pose(film: SolvedFilm, gradient: np.ndarray) -> None:
    """Add the gradients of E_x and E_z at fixed pressure to the scaled pose to ``gradient`` (2, 10)."""
    face, cell = drag_by_gap(film)
    gradient[:1, :4] += film.grid.by_pose(face, 1)
    gradient[-len(cell) :, :4] += film.grid.by_pose(cell)


def drag_by_deflection(film: SolvedFilm, liner: LinerFilm) -> np.ndarray:
    """Gradients (2, n, m) of E_x and E_z to the unknown pressures, through the deflection of a liner."""
    face, cell = _slopes(film)
    return np.stack((to_ends(face, 0), cell)) * liner.deflection_by_pressure


def _slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Gradients to the true gap, of E_x on the links i -> i+1 and of E_z at the vertices (n, m)."""
    ones, flux, limited, liner = film.solver.ones, film.solver.flux, film.limited, film.parts.liner
    slope, face_slope = (ones, ones) if limited is None else (limited.slope, limited.face_slope)
    if liner is not None:
        slope, face_slope = liner.gap_slopes.rate_t, liner.gap_slopes.link
    carriers = (ones, ones) if flux is None else (flux.cx_h, flux.cz_h)
    return roughness.drag_by_gap(film.oil.P, carriers, slope, face_slope, film.grid.link_widths)


def true_gradients(film: SolvedFilm) -> Gradients:
    """`FilmAnswers.gradients` to the true gap, followed by those of supply areas with an unknown pressure.

    The balance of such an area is a sum over the balances at its vertices.
    """
    s, found = film.solver, to_true_gap(film, film.solver.gradients())
    if (r := s.reservoirs) is None:
        return found
    flows = to_true_gap(film, s.gradients(r.at))
    rows, entries = np.nonzero(r.within().T[:, flows.rows])
    by = flows.by[:, entries] * r.weights()[rows]
    return join(found, Gradients(s.work.count + rows, flows.places[entries], by))


def true_fills(film: SolvedFilm) -> Gradients | None:
    """Derivatives of the fills to the true gap, from `FilmSolver.fill_gradients`; None if there are none."""
    fills = film.solver.fill_gradients()
    return None if fills is None else to_true_gap(film, fills[1])


def to_true_gap(film: SolvedFilm, gradients: Gradients) -> Gradients:
    """Convert derivatives to the film's gap into derivatives to the true gap, where a limiter acts."""
    f = film.limited
    return gradients if f is None else gradients.to_true_gap(f.slope, f.bend, f.face_slope)


def shear_of_fills(film: SolvedFilm) -> np.ndarray:
    """Couette shear (n, m) per fill of every vertex."""
    shear: np.ndarray = ratio_of(film) * film.grid.shear_weight / film.solver.H
    # ends have the fill of the neighbouring vertices
    return shear + at_beside_ends(film.solver.system, shear)


def ratio_of(film: SolvedFilm) -> np.ndarray:
    """Viscosity ratio (n, m) for the shear; ones if it is constant."""
    return film.solver.ones if film.oil.ratio is None else film.oil.ratio
