"""Exact tangent of a film on a flexible bore: the journal's wrench and the bore's loads to motion, q and q_t.

The bore's loads are more integrals S = sum w p of the film, with weights w = W S_k; one adjoint solve each gives their gradients to gap
and gap rate, which S^T contracts to q and q_t. The gap on a link is the mean of its two columns, so that its gradient is shared
by both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.joint.gradients import (
    SIZE,
    adjoint_rows,
    field_gradient,
    friction_rows,
    shear_needs_adjoint,
    wrench_tangent,
)

if TYPE_CHECKING:
    from exudyn_ehd.joint.elastic import ElasticBearingModel


def elastic_tangent(model: ElasticBearingModel) -> np.ndarray:
    """d (wrench, Q) / d (motion, q, q_t), (6 + k, 10 + 2 k), SI units, for the last evaluation of ``model``."""
    bore, c = model.bore, model.bearing.radial_clearance
    k = bore.size
    integrals = adjoint_rows(model)
    count = len(integrals)
    lam = model.solver.adjoint(np.concatenate((integrals, _bore_rows(model))))
    gradient = np.empty((count + k, SIZE))
    sens = field_gradient(model, lam, gradient)
    sens.cell += 0.5 * sens.face
    sens.cell[:, 1:] += 0.5 * sens.face[:, :-1]
    sens.cell[:, 0] += 0.5 * sens.face[:, -1]
    by_q = bore.contract(sens.cell) / c
    by_rate = np.zeros_like(by_q) if sens.rate is None else bore.contract(sens.rate) / c
    out = np.empty((6 + k, SIZE + 2 * k))
    out[:6, :SIZE] = wrench_tangent(model, gradient=gradient[:count])
    out[:6, SIZE : SIZE + k] = _wrench_by_bore(model, by_q[:count], _Direct(model))
    out[:6, SIZE + k :] = _wrench_by_bore(model, by_rate[:count], None)
    out[6:, :SIZE] = _scaled(model, gradient[count:])
    out[6:, SIZE : SIZE + k] = model.force_scale * by_q[count:]
    out[6:, SIZE + k :] = model.force_scale * by_rate[count:]
    if model.contact_fields is not None:
        _add_contact_loads(model, out)
    return out


def _bore_rows(model: ElasticBearingModel) -> np.ndarray:
    """Weights of the bore's loads at the film's unknowns, (k, count)."""
    w = model.solver.work
    at = w.order[: w.count]
    weight = np.where(w.active.ravel()[at], model.grid.weight.ravel()[at], 0.0)
    if model.P_q is not None:
        weight = weight * model.P_q.ravel()[at]
    return model.bore.rows(at, weight)


def _scaled(model: ElasticBearingModel, gradient: np.ndarray) -> np.ndarray:
    """Gradients (k, 10) of scaled loads in SI units."""
    out = model.force_scale * gradient
    out[:, :4] *= model.pose_scale
    out[:, 4:8] *= model.pose_scale
    out[:, 8] *= 0.5
    out[:, 9] *= 0.5 / model.grid.reference_length
    return out


class _Direct:
    """What the wrench owes to q at fixed film pressure: gap, slopes and contacts."""

    def __init__(self, model: ElasticBearingModel) -> None:
        g, c = model.grid, model.bearing.radial_clearance
        pressure = model.P * g.weight
        # transposed of the central differences that give the slopes of the gap terms
        along_x = (np.roll(pressure, 1, axis=0) - np.roll(pressure, -1, axis=0)) / (2.0 * g.width_x[0])
        along_z = pressure @ np.gradient(np.eye(g.z.size), g.z, axis=0)
        rows = model.bore.contract(np.stack([_couette_field(model), along_x, along_z, _end_field(model)])) / c
        self.couette, self.slopes, self.ends = rows[0], rows[1:3], rows[3]
        self.contact = _contact_wrench(model)


def _couette_field(model: ElasticBearingModel) -> np.ndarray:
    """dC/dH (n, m) with the true gap H, at fixed pressure and fill."""
    s, g = model.solver, model.grid
    share = model.share()
    if model.ratio is not None and model.ratio_h is not None:
        field = g.weight * share / s.H * (model.ratio_h - model.ratio / s.H)
    else:
        field = -g.weight * share / s.H**2
    return field if model.limiter_fields is None else field * model.limiter_fields.slope


def _end_field(model: ElasticBearingModel) -> np.ndarray:
    """Gradient (n, m) of the ends' pressure force to the true gap."""
    field = np.zeros(model.grid.shape)
    step = model.grid.width_x[0]
    field[:, -1] = model.end_pressures[1] * step
    field[:, 0] = -model.end_pressures[0] * step
    if model.limiter_fields is not None:
        field *= model.limiter_fields.slope
    return field


def _wrench_by_bore(model: ElasticBearingModel, gradient: np.ndarray, direct: _Direct | None) -> np.ndarray:
    """Columns (6, k) of the wrench from gradients of the integrals (4 + ..., k)."""
    ds, at = gradient[:4], 4
    dc = np.zeros(gradient.shape[1])
    if shear_needs_adjoint(model):
        dc, at = gradient[4], 5
    slopes = gradient[at : at + 2]
    ends, contact = np.zeros_like(dc), np.zeros((6, dc.size))
    if direct is not None:
        dc, slopes, ends, contact = dc + direct.couette, slopes + direct.slopes, direct.ends, direct.contact
    x, y, bx, by = model.pose
    R, fs, c0 = model.grid.reference_length, model.force_scale, model.shear_scale
    ds_theta = x * ds[1] - y * ds[0] + bx * ds[3] - by * ds[2] - slopes[0]
    ds_z = -(bx * ds[0] + by * ds[1]) - slopes[1] - ends
    out = np.stack(
        [
            -fs * ds[0],
            -fs * ds[1],
            -c0 * (6.0 * R * ds_z + model.axial_speed * dc),
            fs * R * ds[3],
            -fs * R * ds[2],
            -c0 * R**2 * (6.0 * ds_theta + model.omega * dc),
        ]
    )
    return out + contact


def _contact_wrench(model: ElasticBearingModel) -> np.ndarray:
    """Gradient (6, k) of the contacts' wrench, pressures and friction, to q."""
    g, R = model.grid, model.grid.reference_length
    out = np.zeros((6, model.bore.size))
    f = model.contact_fields
    if f is None:
        return out
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


def _add_contact_loads(model: ElasticBearingModel, out: np.ndarray) -> None:
    """Add the gradient of the contacts' part of the bore's loads to pose and q."""
    f, g = model.contact_fields, model.grid
    assert f is not None
    k = model.bore.size
    slope = np.sum(f.slope, axis=0) * g.weight * g.reference_length**2
    cos, sin = slope * model.cos_x[:, None], slope * model.sin_x[:, None]
    out[6:, :4] -= model.bore.contract(np.stack([cos, sin, cos * g.z, sin * g.z])).T * model.pose_scale
    out[6:, SIZE : SIZE + k] += model.bore.product(slope) / model.bearing.radial_clearance
