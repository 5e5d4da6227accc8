"""Exact tangent of a film on a flexible bore: the journal's wrench and the bore's loads to motion, q and q_t.

The bore's loads are more integrals S = sum w p of the film, with weights w = W S_k; one adjoint solve each (all in one sweep over the
factor) gives their gradients ``-lam . dr``. The balances' derivatives dr to q are a five-point stencil on S, since the gap on a link is
the mean of its two columns; those to the motion are ten columns. What an integrator asks for is one combination of the derivatives to
q and q_t, which costs as much as one of them.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.banded.many_sides import make_tiles
from exudyn_ehd.film.loads import couette_gradient, unknown_weights
from exudyn_ehd.film.sensitivity.bore_stencil import (
    gap_stencil,
    integral_weights,
    motion_columns,
    shear_fields,
    spread_gradient,
)
from exudyn_ehd.joint.tangent.drag import drag_by_gap
from exudyn_ehd.joint.tangent.wrench import (
    SIZE,
    adjoint_rows,
    shear_needs_adjoint,
    swept_derivatives,
    wrench_tangent,
)

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.flexible import ElasticBearingModel

# Columns of the weights of all integrals where pressure and fill don't enter the Couette shear.
_WITHOUT_SHEAR = np.array([0, 1, 2, 3, 5, 6])


def elastic_tangent(model: ElasticBearingModel, *combinations: tuple[float, float]) -> np.ndarray:
    """Tangent of wrench and bore loads of the last evaluation of ``model``, SI units.

    Parameters
    ----------
    model : ElasticBearingModel
    combinations : pairs of float
        Factors (a, b), each of which asks for the k columns ``a d/dq + b d/dq_t``.

    Returns
    -------
    (6 + k, 10 + k * combinations) array
        d/d motion, then the combinations.
    """
    k = model.bore.size
    lam, count = _adjoints(model, whole=True)
    balances = Balances(model)
    gradient = balances.gradient(lam)
    out = np.empty((6 + k, SIZE + k * len(combinations)))
    out[:6, :SIZE] = wrench_tangent(model, gradient=np.negative(gradient[0, :, :count].T, order="C"))
    weights, direct = wrench_weights(model)
    for i, (by_gap, by_rate) in enumerate(combinations):
        block = out[:, SIZE + i * k : SIZE + (i + 1) * k]
        by_bore = model.bore.project(*balances.stencil(-by_gap, -by_rate), lam, count + k)
        spread_gradient(
            gradient, by_bore, model.bore.order, weights, direct, by_gap, model.force_scale, model.motion_scale, out[6:, :SIZE], block,
        )  # fmt: skip
        if model.pressing is not None:
            _add_contact_loads(model, block[6:], by_gap)
    if model.pressing is not None:
        _add_contact_motion(model, out[6:, :4])
    return out


class Balances:
    """Derivatives of the film's balances at its unknowns for the last evaluation of ``model``.

    Attributes
    ----------
    places : (count,) array
        Flat vertices of the unknowns.
    motion : (count, 10) array
        To (scaled pose, scaled rates, vx, vz).
    """

    def __init__(self, model: ElasticBearingModel) -> None:
        work = model.solver.work
        self.clearance = model.bearing.radial_clearance
        self.places = work.order[: work.count]
        self.links, self.slope, self.by_rate, self.by_gap = swept_derivatives(model)
        links, self.motion = self.links, np.empty((work.count, SIZE))
        motion_columns(
            self.places, work.count, links.DX, links.DZ, links.SX, links.SZ, links.SZX, self.slope, self.by_rate, self.by_gap,
            model.cos_x, model.sin_x, model.cos_f, model.sin_f, model.grid.z, self.motion,
        )  # fmt: skip

    def gradient(self, lam: np.ndarray) -> np.ndarray:
        """Minus the gradients (tiles, 10, TILE) of adjoint functionals ``lam`` in tiles to the motion."""
        return self.motion.T @ lam[:, : len(self.places)]

    def stencil(self, by_place: float, by_rate: float) -> tuple[np.ndarray, np.ndarray]:
        """Weights and flat vertices (count, 5) of ``by_place d/d delta + by_rate d/d delta_t``, SI units."""
        count, c = len(self.places), self.clearance
        weight, vertices = np.empty((count, 5)), np.empty((count, 5), dtype=np.int64)
        gap_stencil(
            self.places, count, self.links.DX, self.links.DZ, self.slope, self.by_rate, self.by_gap, by_place / c,
            by_rate / c, weight, vertices,
        )  # fmt: skip
        return weight, vertices


def wrench_rows(model: ElasticBearingModel, balances: Balances) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """d wrench / d motion (6, 10), / dq and / dq_t (6, k): the upper rows of `elastic_tangent` alone."""
    lam, count = _adjoints(model, whole=False)
    weights, direct = wrench_weights(model)
    by_place, by_rate = (
        weights @ model.bore.project(*balances.stencil(*f), lam, count) for f in ((-1.0, 0.0), (0.0, -1.0))
    )
    wrench = wrench_tangent(model, gradient=np.negative(balances.gradient(lam)[0, :, :count].T, order="C"))
    return wrench, by_place + direct, by_rate


def load_weights(model: ElasticBearingModel) -> np.ndarray:
    """Weight of every unknown (count,) in the scaled pressure integral over the bore."""
    w = model.solver.work
    weight = np.empty(w.count)
    unknown_weights(w.order, w.count, model.grid.weight, w.active, weight)
    if model.P_q is not None:
        weight *= model.P_q.ravel()[w.order[: w.count]]
    return weight


def _adjoints(model: ElasticBearingModel, whole: bool) -> tuple[np.ndarray, int]:
    """Adjoint solutions as tiles of integrals, then k loads of the bore only if ``whole``, and the number of integrals."""
    integrals = adjoint_rows(model)
    count, unknowns = integrals.shape
    lam = make_tiles(integrals, count + (model.bore.size if whole else 0))
    if whole:
        model.bore.fill_rows(model.solver.work.order[:unknowns], load_weights(model), count, lam)
    model.solver.adjoint_columns(lam)
    return lam, count


def _direct(model: ElasticBearingModel, weights: np.ndarray) -> np.ndarray:
    """What the wrench owes to q at fixed film pressure (6, k): gap, slopes and contacts."""
    g = model.grid
    # force and moment across the axis owe nothing to the gap
    factors, rows = weights[2::3, 4:] / model.bearing.radial_clearance, np.empty((2, *g.shape))
    couette, ends = couette_field(model), _end_field(model)
    shear_fields(model.P, g.weight, g.width_x[0], g.z, couette, ends, factors, rows)
    if model.effects.uneven_drag:
        face, cell = drag_by_gap(model)
        # the gap on a link is the mean of its two columns
        rows += factors[:, 1, None, None] * (0.5 * (face[0] + np.roll(face[0], 1, axis=0)))
        rows += factors[:, 2, None, None] * cell[1]
    out = np.zeros((6, model.bore.size))
    out[2::3] = model.bore.contract(rows)
    return out if model.pressing is None else out + _contact_wrench(model)


def couette_field(model: ElasticBearingModel) -> np.ndarray:
    """dC/dH (n, m) with the true gap H, at fixed pressure and fill."""
    s, g = model.solver, model.grid
    if model.ratio is not None and model.ratio_h is not None:
        field = g.weight * model.share() / s.H * (model.ratio_h - model.ratio / s.H)
    elif s.closure.conserves_mass:
        field = -g.weight * s.fill / s.H**2
    else:
        field = np.empty(g.shape)
        couette_gradient(s.H, g.weight, s.work.active, g.fixed, s.closure.cavity_shear, field)
    return field if model.limited is None else field * model.limited.slope


def _end_field(model: ElasticBearingModel) -> np.ndarray:
    """Gradient (n, m) of the ends' pressure force to the true gap."""
    if not model.end_pressures.any():
        return model.solver.nothing
    field = np.zeros(model.grid.shape)
    step = model.grid.width_x[0]
    field[:, -1] = model.end_pressures[1] * step
    field[:, 0] = -model.end_pressures[0] * step
    return field if model.limited is None else field * model.limited.slope


def wrench_weights(model: ElasticBearingModel) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the integrals of `adjoint_rows` in the wrench, and what the wrench owes to q at fixed film pressure (6, k)."""
    weights, shear = np.empty((6, 8)), shear_needs_adjoint(model)
    integral_weights(
        model.pose, model.grid.reference_length, model.force_scale, model.shear_scale, model.omega, model.axial_speed, weights
    )  # fmt: skip
    direct = _direct(model, weights)
    return weights[:, :7] if shear else weights[:, _WITHOUT_SHEAR], direct


def _contact_wrench(model: ElasticBearingModel) -> np.ndarray:
    """Gradient (6, k) of the contacts' wrench, pressures and friction, to q."""
    g, R = model.grid, model.grid.reference_length
    f = model.pressing
    assert f is not None
    out = np.zeros((6, model.bore.size))
    x, y, bx, by = model.motion[:4].tolist()
    theta, axial = friction_rows(R)
    for i, contact in enumerate(model.effects.contacts):
        slope = f.slope[i] * g.weight * R**2
        cos, sin = slope * model.cos_x[:, None], slope * model.sin_x[:, None]
        fields = np.stack([cos, sin, cos * g.z, sin * g.z, slope])
        rows = model.bore.contract(fields) / model.bearing.radial_clearance
        c, s, zc, zs, _ = rows
        out += np.stack([-c, -s, 0.0 * c, R * zs, -R * zc, y * c - x * s + R * (by * zc - bx * zs)])
        if contact.friction_coefficient > 0.0:
            g_theta, g_z, _ = model.slip(contact)
            out += contact.friction_coefficient * (g_theta * theta + g_z * axial) @ rows
    return out


def contact_slope(model: ElasticBearingModel) -> np.ndarray:
    """Change of the contacts' force at every vertex with the scaled gap (n, m), N."""
    f, g = model.pressing, model.grid
    assert f is not None
    return np.sum(f.slope, axis=0) * g.weight * g.reference_length**2


def _add_contact_motion(model: ElasticBearingModel, block: np.ndarray) -> None:
    """Add the gradient of the contacts' part of the bore's loads to the pose, (k, 4)."""
    slope, z = contact_slope(model), model.grid.z
    cos, sin = slope * model.cos_x[:, None], slope * model.sin_x[:, None]
    block -= model.bore.contract(np.stack([cos, sin, cos * z, sin * z])).T * model.pose_scale


def _add_contact_loads(model: ElasticBearingModel, block: np.ndarray, by_gap: float) -> None:
    """Add ``by_gap`` times the gradient of the contacts' part of the bore's loads to q, (k, k)."""
    block += model.bore.product(contact_slope(model)) * (by_gap / model.bearing.radial_clearance)


@functools.cache
def friction_rows(R: float) -> tuple[np.ndarray, np.ndarray]:
    """Maps (6, 5) from the friction-weighted integrals (c, s, zc, zs, 1) to the wrench, for slip along theta and along z."""
    theta, axial = np.zeros((6, 5)), np.zeros((6, 5))
    theta[0, 1], theta[1, 0], theta[3, 2], theta[4, 3], theta[5, 4] = 1.0, -1.0, R, R, -R
    axial[2, 4], axial[3, 1], axial[4, 0] = -1.0, -R, R
    return theta, axial
