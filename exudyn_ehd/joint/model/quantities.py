"""Scalars of the state that a bearing model has evaluated last: gap, peak, friction, losses and flows, in SI units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film import loads
from exudyn_ehd.film.reynolds.gap import largest_eccentricity
from exudyn_ehd.status import Status

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.rigid import BearingModel


def quantities(model: BearingModel) -> dict[str, float]:
    """Scalars of the last evaluation.

    The mechanical power that enters the film becomes heat of shear and pressure flow, and work on the oil that it presses out,

        power_loss = int (mu U^2 share / h + h^3 / (12 mu) |grad p|^2) dA + sum (p - pc) outflow - pc dV/dt - w sum p h ds,

    with pc the cavity pressure, V the volume between the surfaces, ds along the ends (+ at z > 0, - at z < 0). It follows from Reynolds'
    equation times p - pc, summed by parts; only the heat is left if ends and cavity are at gauge 0. The last term is the pressure on the
    ends' cross section, which the journal's wrench carries. Compressible oil takes its elastic energy along: p - pc becomes the integral
    of dp / (rho / rho_0), the outflow the mass flow over rho_0, and the rate of the energy that the film holds is added. What bends an
    elastic bore is not in it: that is the bush's.

    Returns
    -------
    dict
        ``minimum_gap`` (m, over the whole bearing with its edges), ``minimum_gap_angle`` and ``minimum_gap_z`` (its place, rad and m),
        ``eccentricity_ratio`` (at the mid-plane), ``largest_eccentricity_ratio`` (over the length), ``peak_pressure`` (Pa, from
        parabolas through the largest vertex) at ``peak_angle`` (rad),
        ``friction_torque`` (Nm, on the journal about its own axis, film and contact),
        ``friction_torque_unbroken`` (the film's with shear of its unbroken part only), ``friction_torque_bush``
        (Nm, on the housing about the bearing axis), ``power_loss`` (W, mechanical power that stays in film and
        contact), ``leakage`` (m3/s out of both ends), ``leakage_lower`` and ``leakage_upper``, ``contact_load`` (N, carried
        by contact), ``contact_torque`` (Nm, its friction on the journal about its own axis), ``contact_power_loss`` (W, the part
        of ``power_loss`` that this friction takes), ``peak_contact_pressure`` (Pa, largest vertex); with supply areas also
        ``supply_flow`` (m3/s, out of all of them), with a thermal effect ``film_temperature`` and ``peak_temperature`` (K), with a liner or a flexible
        bore ``bore_displacement`` (m, the largest).
    """
    out = {
        "minimum_gap": model.minimum_gap,
        "eccentricity_ratio": math.hypot(model.pose[0], model.pose[1]),
        "largest_eccentricity_ratio": float(largest_eccentricity(model.pose, model.half_length)),
    }
    if model.status is not Status.CONVERGED:
        return out
    out["minimum_gap_angle"], out["minimum_gap_z"] = minimum_place(model)
    R = model.grid.reference_length
    torque_scale = model.shear_scale * R**2
    lower, upper = leakages(model)
    poiseuille = 6.0 * model.s_theta
    load = model.pressing.integrals.sum(axis=0) * R**2 if model.pressing is not None else np.zeros(5)
    peak, peak_angle, _ = refined_peak(model)
    out |= {
        "peak_pressure": peak,
        "peak_angle": peak_angle % (2.0 * math.pi),
        "friction_torque": friction_torque(model),
        "friction_torque_unbroken": -torque_scale * (model.omega * model.couette_unbroken - poiseuille),
        "friction_torque_bush": -float(model.wrench[5]),
        "power_loss": model.power_loss(),
        "leakage": model.flow_scale * (lower + upper),
        "leakage_lower": model.flow_scale * lower,
        "leakage_upper": model.flow_scale * upper,
        "contact_load": math.hypot(load[0], load[1]),
        "contact_torque": contact_torque(model),
        "contact_power_loss": 0.0
        - contact_torque(model) * model.omega
        - float(model.contact_wrench[2]) * model.axial_speed,
        "peak_contact_pressure": 0.0 if model.pressing is None else max(float(p.max()) for p in model.pressing.P),
    }
    if model.supply is not None:
        out["supply_flow"] = float(supply_flows(model).sum())
    if model.effects.thermal is not None:
        out |= model.effects.thermal.quantities()
    if model.liner_solver is not None:
        out["bore_displacement"] = float(np.abs(model.liner_solver.deflection).max()) * model.bearing.radial_clearance
    return out


def power_loss(model: BearingModel) -> float:
    """Mechanical power that the last evaluation's film and contacts keep, W; see `quantities`."""
    bx, by, x_t, y_t, bx_t, by_t = model.motion[2:8].tolist()
    fx, fy, fz, mx, my, _ = model.wrench.tolist()
    along = fz + bx * fx + by * fy  # a tilted journal slides along its own axis, not along z
    power = fx * x_t + fy * y_t - mx * by_t + my * bx_t
    power += friction_torque(model) * model.omega
    power += along * model.axial_speed
    if model.liner_solver is not None:
        power += model.liner_solver.stored_power() * model.pressure_scale * model.flow_scale
    return -power


def friction_torque(model: BearingModel) -> float:
    """Friction of film and contacts on the journal about its own axis, Nm."""
    torque_scale = model.shear_scale * model.grid.reference_length**2
    return -torque_scale * (model.omega * model.couette - 6.0 * model.s_theta) + contact_torque(model)


def supply_flows(model: BearingModel) -> np.ndarray:
    """What every area of ``bearing.supply`` feeds into the film, m3/s; empty without supply."""
    if model.supply is None:
        return np.zeros(0)
    return model.supply.flows(model.solver.inflow()) * model.bearing.radial_clearance * model.grid.reference_length**2


def contact_torque(model: BearingModel) -> float:
    """Contact friction on the journal about its own axis, Nm."""
    if model.pressing is None:
        return 0.0
    x, y, bx, by = model.motion[:4].tolist()
    fx, fy, _, mx, my, mz = model.contact_wrench.tolist()
    return mz - (x * fy - y * fx - bx * mx - by * my)


def leakages(model: BearingModel) -> tuple[float, float]:
    """Scaled flows out of the lower and the upper end; times ``flow_scale`` in m3/s."""
    s, g = model.solver, model.grid
    if not g.link_z.any():
        return 0.0, 0.0
    if s.closure.conserves_mass:
        inflow = s.inflow()
        return -float(inflow[:, 0].sum()), -float(inflow[:, -1].sum())
    fx, fz, rate = s.couette_flows()
    full = s.work.active if model.supply is None else np.logical_or.reduce([s.work.active, *model.supply.masks])
    return loads.end_flows(s.pressure, s.system.kz, fz, fx, rate, g.width_x, g.width_z, s.squeeze, full)


def minimum_place(model: BearingModel) -> tuple[float, float]:
    """theta (rad, 0 to 2 pi) and z (m) of the smallest gap.

    Of rigid cylinders exactly, at one of the ends, or at z = 0 where the gap is the same along the bearing; with a profile, wear or
    an elastic bore the vertex of the smallest gap.
    """
    R, half = model.grid.reference_length, model.half_length
    if model.effects.gap_terms or model.liner_solver is not None:
        i, j = divmod(int(np.argmin(model.solver.H)), model.grid.z.size)
        return float(model.grid.x[i] % (2.0 * math.pi)), float(model.grid.z[j] * R)
    x, y, bx, by = model.pose.tolist()
    # |e|^2 at either end differs by 4 half (x bx + y by)
    lean = x * bx + y * by
    end = math.copysign(half, lean) if lean != 0.0 or bx != 0.0 or by != 0.0 else 0.0
    return math.atan2(y + end * by, x + end * bx) % (2.0 * math.pi), end * R


def refined_peak(model: BearingModel) -> tuple[float, float, float]:
    """Peak pressure (Pa) with its angle (rad) and z (m), from parabolas through the largest vertex."""
    peak, theta, z = loads.refined_peak(model.P, model.grid.x, model.grid.z, True)
    return peak * model.pressure_scale, theta, z * model.grid.reference_length
