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
    couette_field,
    field_gradient,
    friction_row,
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
    out[:6, :SIZE] = wrench_tangent(model, gradient[:count])
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
        slope = np.zeros(g.shape)
        if model.contact_fields is not None:
            pressure = pressure + np.sum(model.contact_fields.P, axis=0) * g.weight / model.pressure_scale
            slope = np.sum(model.contact_fields.slope, axis=0) * g.weight / model.pressure_scale
        assert model.extra_slope_x is not None and model.extra_slope_z is not None
        # transposed of the central differences that give the slopes of the gap terms
        along_x = (np.roll(pressure, 1, axis=0) - np.roll(pressure, -1, axis=0)) / (2.0 * g.width_x[0])
        along_z = pressure @ np.gradient(np.eye(g.z.size), g.z, axis=0)
        cos, sin = slope * model.cos_x[:, None], slope * model.sin_x[:, None]
        fields = np.stack(
            [
                cos,
                sin,
                cos * g.z,
                sin * g.z,
                couette_field(model)[0],
                along_x + slope * model.extra_slope_x,
                along_z + slope * model.extra_slope_z,
                _end_field(model),
            ]
        )
        rows = model.bore.contract(fields) / c
        self.contact, self.couette, self.slopes, self.ends = rows[:4], rows[4], rows[5:7], rows[7]
        self.friction = _contact_friction(model)


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
    ends, friction = np.zeros_like(dc), np.zeros((6, dc.size))
    if direct is not None:
        ds, dc, slopes = ds + direct.contact, dc + direct.couette, slopes + direct.slopes
        ends, friction = direct.ends, direct.friction
    x, y, bx, by = model.pose
    R, fs, c0 = model.grid.reference_length, model.force_scale, model.shear_scale
    ds_theta = x * ds[1] - y * ds[0] + bx * ds[3] - by * ds[2] + slopes[0]
    ds_z = -(bx * ds[0] + by * ds[1]) + slopes[1] - ends
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
    return out + friction


def _contact_friction(model: ElasticBearingModel) -> np.ndarray:
    """Gradient (6, k) of the contacts' friction wrench to q."""
    g, R = model.grid, model.grid.reference_length
    out = np.zeros((6, model.bore.size))
    f = model.contact_fields
    for i, contact in enumerate(model.effects.contacts):
        if f is None or contact.friction_coefficient == 0.0:
            continue
        g_theta, g_z, _ = model.slip(contact)
        slope = f.slope[i] * g.weight * contact.friction_coefficient * R**2
        cos, sin = slope * model.cos_x[:, None], slope * model.sin_x[:, None]
        rows = model.bore.contract(np.stack([cos, sin, cos * g.z, sin * g.z, slope])) / model.bearing.radial_clearance
        out += (g_theta * friction_row(R, 1.0, 0.0) + g_z * friction_row(R, 0.0, 1.0)) @ rows
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
