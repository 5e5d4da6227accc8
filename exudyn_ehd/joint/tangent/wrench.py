"""Exact tangent of a bearing's wrench: adjoint solves for the load integrals, then the chain rule to the motion.

For an integral S = sum w p with the film's residual r(p, H, H_t, v) = 0: ``dS = -lam . dr`` at fixed p with ``A^T lam = w``, plus what depends on
the motion directly. Four integrals carry force and moments; shear needs a fifth where fill or pressure enter it, and gap terms
and uneven drag together two more.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.loads import couette_gradient, load_adjoint_rhs, shear_adjoint_rhs, slope_adjoint_rhs, weigh_rows
from exudyn_ehd.film.reynolds.gap import contract_ends, contract_pose
from exudyn_ehd.film.reynolds.link_derivatives import LinkDerivatives, pose_gradient, wrench_gradient
from exudyn_ehd.film.sensitivity.bore_stencil import integral_weights
from exudyn_ehd.film.solvers.compliant_links import compliant_shear_row
from exudyn_ehd.film.solvers.liner_newton import liner_shear_rhs
from exudyn_ehd.film.surfaces.contact_wrench import (
    chain_limiter,
    chain_links,
    contact_adjoint_rhs,
    contact_tangent,
    contact_weights,
    couette_gradient_ratio,
)
from exudyn_ehd.joint.tangent.drag import add_drag_by_pose, add_drag_rows, drag_by_deflection

if TYPE_CHECKING:
    from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver
    from exudyn_ehd.film.solvers.linear import Sensitivities
    from exudyn_ehd.film.solvers.liner import LinerFilmSolver
    from exudyn_ehd.joint.buffers import ContactFields
    from exudyn_ehd.joint.model.rigid import BearingModel

SIZE = 10


def wrench_tangent(model: BearingModel, slow_motion: bool = False, gradient: np.ndarray | None = None) -> np.ndarray:
    """d wrench / d motion (6, 10) in SI units for the last evaluation of ``model``.

    With ``slow_motion`` the columns of the rates include what a liner's deflection adds to the squeeze when it follows a slow motion,
    ``dH/dt = rigid rate + beta dP/d(pose) rate``: the damping of a steady state. ``gradient`` (k, 10) of the integrals of
    `adjoint_rows`, if they are known already.
    """
    through_film = None
    if gradient is None and _pressed_contact(model):
        # six rows instead of the film's and the contact's ten and more
        through_film = film_gradient(model, slow_motion, _wrench_weights(model)) * _motion_scale(model)
        gradient = np.zeros((shape_rows(model), SIZE))
    elif gradient is None:
        gradient = film_gradient(model, slow_motion)
    ds, dc, extra = _integral_gradients(model, gradient)
    ends = np.zeros(4)
    if _film_gap_slope(model) is not None and any(model.bearing.end_pressures):
        ends = _end_gradient(model)
    out = np.empty((6, SIZE))
    wrench_gradient(
        ds, dc, extra, ends, model.pose, model.integrals, model.pose_scale, model.grid.reference_length, model.force_scale,
        model.shear_scale, model.omega, model.axial_speed, model.couette, out,
    )  # fmt: skip
    if model.pressing is not None:
        _add_contacts(model, model.pressing, out)
    return out if through_film is None else out + through_film


def film_gradient(model: BearingModel, slow_motion: bool, weights: np.ndarray | None = None) -> np.ndarray:
    """Gradients (k, 10) of the film's integrals, or of their sums with ``weights`` (k, integrals), to (scaled pose, scaled rates, vx, vz)."""
    s = model.solver
    rows = adjoint_rows(model)
    if weights is not None:
        rows = weights @ rows
    lam = s.adjoint(rows)
    gradient = np.zeros((rows.shape[0], SIZE))
    if model.compliant is not None and not slow_motion:
        model.compliant.pose_gradient(lam, model.cos_x, model.sin_x, model.cos_f, model.sin_f, gradient)
    elif s.plain_links and not slow_motion:
        swept_gradient(model, lam, gradient)
    else:
        field_gradient(model, lam, gradient, slow_motion)
    return gradient


def _integral_gradients(model: BearingModel, gradient: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gradients to (scaled pose, scaled rates, vx, vz) of the film's S (4, 10), C (10,), slopes' S (2, 10)."""
    dc, extra = np.zeros(SIZE), np.zeros((2, SIZE))
    at = 4
    if shear_needs_adjoint(model):
        dc = gradient[at]
        at += 1
    _add_couette_direct(model, dc)
    if has_extra_rows(model):
        extra = gradient[at : at + 2]
    if model.effects.uneven_drag:
        add_drag_by_pose(model, extra)
    return gradient[:4], dc, extra


def _following_deflection(
    model: BearingModel, solver: LinerFilmSolver | CompliantFilmSolver, by_rate: np.ndarray
) -> np.ndarray:
    """Gradient (k, 4) to the scaled rates through the deflection's rate: a second adjoint solve, of ``by_rate`` (k, n, m) times beta."""
    w, z = solver.work, model.grid.z
    rows = (by_rate * solver.deflection_by_pressure).reshape(by_rate.shape[0], -1)[:, w.order[: w.count]]
    sens = solver.sensitivities(solver.adjoint(np.ascontiguousarray(rows)))
    out = np.zeros((by_rate.shape[0], 4))
    contract_pose(sens.cell, model.cos_x, model.sin_x, z, out)
    contract_pose(sens.face, model.cos_f, model.sin_f, z, out)
    if model.compliant is not None:
        contract_pose(by_rate * model.compliant.columns.D_r, model.cos_x, model.sin_x, z, out)
    return out


def swept_gradient(model: BearingModel, lam: np.ndarray, gradient: np.ndarray) -> None:
    """Gradients (k, 10) of adjoint functionals lam (k, n, m) in one sweep, for films on `FilmSolver`'s own links."""
    d, slope, by_rate, by_gap = swept_derivatives(model)
    pose_gradient(
        lam, d.DX, d.DZ, d.SX, d.SZ, d.SZX, slope, by_rate, by_gap, model.cos_x, model.sin_x, model.cos_f, model.sin_f,
        model.grid.z, gradient,
    )  # fmt: skip


def swept_derivatives(model: BearingModel) -> tuple[LinkDerivatives, np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives to the true gap: of the links, and slope, AR, AC (n, m) as `sweep.pose_gradient` takes them."""
    s = model.solver
    d = s.link_derivatives()
    by_rate, by_gap = s.storage_weights()
    slope, f = s.ones, model.limited
    if f is not None:
        slope = f.slope
        chain_links(slope, f.bend, f.face_slope, by_rate, by_gap, d.DX, f.by_rate, f.by_gap)
        by_rate, by_gap = f.by_rate, f.by_gap
    return d, slope, by_rate, by_gap


def field_gradient(
    model: BearingModel, lam: np.ndarray, gradient: np.ndarray, slow_motion: bool = False
) -> Sensitivities:
    """Gradients (k, 10) of adjoint functionals lam (k, n, m) through the fields of sensitivities, which come back; for any film."""
    s, g = model.solver, model.grid
    sens = s.sensitivities(lam)
    if model.limited is not None:
        _chain_limiter(model, sens)
    pose, rates = np.zeros((lam.shape[0], 4)), np.zeros((lam.shape[0], 4))
    contract_pose(sens.cell, model.cos_x, model.sin_x, g.z, pose)
    contract_pose(sens.face, model.cos_f, model.sin_f, g.z, pose)
    if sens.rate is not None:
        contract_pose(sens.rate, model.cos_x, model.sin_x, g.z, rates)
    if slow_motion and sens.rate is not None and model.liner_solver is not None:
        rates += _following_deflection(model, model.liner_solver, sens.rate)
    gradient[:, :4], gradient[:, 4:8], gradient[:, 8:] = pose, rates, sens.speed
    return sens


def shear_needs_adjoint(model: BearingModel) -> bool:
    """Whether fill or pressure enter the Couette shear."""
    return model.solver.closure.conserves_mass or model.ratio_q is not None or model.liner_solver is not None


def has_extra_rows(model: BearingModel) -> bool:
    """Whether `adjoint_rows` has two rows for the slopes of gap terms and for uneven drag."""
    return model.extra_slope_x is not None or model.effects.uneven_drag


def shape_rows(model: BearingModel) -> int:
    """Number of the film's own integrals: four of the pressure, of the shear, and two as `has_extra_rows` says."""
    return 4 + shear_needs_adjoint(model) + 2 * has_extra_rows(model)


def _pressed_contact(model: BearingModel) -> bool:
    """Whether a contact acts on a liner, and so answers to the film's pressure."""
    return model.compliant is not None and model.pressing is not None


def _motion_scale(model: BearingModel) -> np.ndarray:
    """(scaled pose, scaled rates, vx, vz) per motion in SI units (10,)."""
    return np.concatenate((model.pose_scale, model.pose_scale, (0.5, 0.5 / model.grid.reference_length)))


def _wrench_weights(model: BearingModel) -> np.ndarray:
    """Weights (6, k) of the integrals of `adjoint_rows` in the wrench, with a contact that presses on a liner."""
    assert model.pressing is not None
    # the last of the film's eight is the ends', which no row of `adjoint_rows` has
    film = np.empty((6, shape_rows(model) + 5))
    own = np.empty((6, 8))
    R = model.grid.reference_length
    integral_weights(model.pose, R, model.force_scale, model.shear_scale, model.omega, model.axial_speed, own)
    film[:, : shape_rows(model)] = own[:, : shape_rows(model)]
    contact_weights(model.motion, *model.pressing.friction[0], R, film[:, shape_rows(model) :])
    return film


def adjoint_rows(model: BearingModel) -> np.ndarray:
    """Weights of the integrals at the unknowns, (k, count)."""
    g, w = model.grid, model.solver.work
    shear, own = shear_needs_adjoint(model), shape_rows(model)
    rows = np.empty((own + 5 * _pressed_contact(model), w.count))
    load_adjoint_rhs(w.order, w.count, g.weight, model.cos_x, model.sin_x, g.z, w.active, rows)
    P_q = None
    if model.effects.pressure_law is not None:
        assert model.P_q is not None
        P_q = model.P_q
        weigh_rows(w.order, w.count, P_q, rows[:4])
    if shear:
        _shear_row(model, rows[4])
    if has_extra_rows(model):
        extra = rows[own - 2 : own]
        extra[:] = 0.0
        if model.extra_slope_x is not None and model.extra_slope_z is not None:
            slope_adjoint_rhs(w.order, w.count, g.weight, w.active, model.extra_slope_x, model.extra_slope_z, extra)
        if model.effects.uneven_drag:
            add_drag_rows(model, extra)
        if P_q is not None:
            weigh_rows(w.order, w.count, P_q, extra)
        if model.effects.uneven_drag and model.compliant is not None:
            extra += drag_by_deflection(model, model.compliant).reshape(2, -1)[:, w.order[: w.count]]
    if rows.shape[0] > own and model.compliant is not None:
        contact_adjoint_rhs(
            w.order, w.count, g.weight, model.compliant.contact_by_pressure, model.cos_x, model.sin_x, g.z, rows[own:]
        )
    return rows


def _shear_row(model: BearingModel, row: np.ndarray) -> None:
    """Weights of the Couette integral at the unknowns: through pressure where they are pressures, through fill elsewhere."""
    s, g, w = model.solver, model.grid, model.solver.work
    if model.compliant is not None:
        # by the pressure's deflection at unknown pressures, by the fill elsewhere
        film, none = model.compliant, s.nothing
        compliant_shear_row(
            film.fields, w.order, w.count, g.weight, w.active, s.closure.conserves_mass,
            s.ones if model.ratio is None else model.ratio, none if model.ratio_q is None else model.ratio_q,
            none if model.ratio_h is None else model.ratio_h, row,
        )  # fmt: skip
        return
    if model.liner_solver is not None:
        liner_shear_rhs(w.order, w.count, g.weight, s.H, w.active, model.liner_solver.beta, row)
        return
    by_pressure = s.nothing if model.ratio_q is None else model.ratio_q
    by_fill = s.nothing
    if s.closure.conserves_mass:
        by_fill = s.ones if model.ratio is None else model.ratio
    shear_adjoint_rhs(w.order, w.count, g.weight, s.H, w.active, by_pressure, by_fill, row)


def _add_couette_direct(model: BearingModel, dc: np.ndarray) -> None:
    """Add the direct gradient of C to the scaled pose and speeds, at fixed pressure and fill."""
    s, g = model.solver, model.grid
    gradient = np.empty((1, *g.shape))
    if model.ratio is not None and model.ratio_h is not None and model.ratio_v is not None:
        if not s.closure.conserves_mass:
            dc[8] += couette_gradient_ratio(
                s.H, g.weight, model.ratio, model.ratio_h, model.ratio_v, s.work.active, g.fixed, s.closure.cavity_shear,
                gradient[0],
            )  # fmt: skip
            _contract_couette(model, gradient, dc)
            return
        density = g.weight * model.share() / s.H
        gradient[0] = density * (model.ratio_h - model.ratio / s.H)
        dc[8] += float(np.sum(density * model.ratio_v))
    elif s.closure.conserves_mass:
        gradient[0] = -g.weight * s.fill / s.H**2
    else:
        couette_gradient(s.H, g.weight, s.work.active, g.fixed, s.closure.cavity_shear, gradient[0])
    _contract_couette(model, gradient, dc)


def _contract_couette(model: BearingModel, gradient: np.ndarray, dc: np.ndarray) -> None:
    """Add dC/dH (1, n, m) to the gradient of C to the scaled pose."""
    slope = _film_gap_slope(model)
    if slope is not None:
        gradient[0] *= slope
    out = np.zeros((1, 4))
    contract_pose(gradient, model.cos_x, model.sin_x, model.grid.z, out)
    dc[:4] += out[0]


def _film_gap_slope(model: BearingModel) -> np.ndarray | None:
    """d(film gap)/d(gap of the undeformed surfaces) (n, m) at fixed pressure; None where it is one."""
    if model.compliant is not None:
        return model.compliant.columns.H_r
    return None if model.limited is None else model.limited.slope


def _chain_limiter(model: BearingModel, sens: Sensitivities) -> None:
    """From the film's gap to the true gap."""
    f = model.limited
    assert f is not None
    rate = sens.cell if sens.rate is None else sens.rate
    chain_limiter(f.slope, f.bend, f.face_slope, sens.rate is not None, sens.cell, sens.face, rate)


def _add_contacts(model: BearingModel, f: ContactFields, out: np.ndarray) -> None:
    """Add the gradient of the contacts' wrench, pressures and friction, to ``out`` (6, 10), SI units."""
    g, R = model.grid, model.grid.reference_length
    for k, (friction, transition) in enumerate(f.friction):
        if f.integrals[k, 4] != 0.0:
            contact_tangent(
                f.slope[k], g.weight, model.cos_x, model.sin_x, g.z, model.motion, model.pose_scale, friction, transition, R,
                f.integrals[k], f.gradients, out,
            )  # fmt: skip


def _end_gradient(model: BearingModel) -> np.ndarray:
    """Gradient (4,) of the ends' pressure force to the scaled pose, where a limiter or a liner's contact acts on the gap."""
    slope = _film_gap_slope(model)
    assert slope is not None
    lower, upper = (model.end_pressures * model.grid.width_x[0]).tolist()
    return contract_ends(slope, -lower, upper, model.cos_x, model.sin_x, model.grid.z)
