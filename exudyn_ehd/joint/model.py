"""One lubricated bearing between two rigid surfaces as a pure function of its relative motion.

Joint frame: origin O on the bearing's mid-plane, z = bearing axis, fixed in the housing. The motion of the journal in it is

    motion = [x, y, bx, by, dx/dt, dy/dt, dbx/dt, dby/dt, omega, w]

with the journal axis (x + bx z, y + by z), the relative spin omega about it and the relative axial speed w. The wrench acts on
the journal, moment about O; the housing receives exactly the opposite about the same point.

Effects with a memory keep it in a `History`, which belongs to an accepted step: ``evaluate(motion, history, step)`` reads the history
at the start of the step and the time since, and ``evaluation.history()`` is the history at its end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.contact import limit_gap, wall_pressure
from exudyn_ehd.film.gap import contract_pose, largest_eccentricity, rigid_gap
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.loads import (
    couette_adjoint_rhs,
    couette_gradient,
    couette_integral,
    couette_integral_fill,
    end_flows,
    load_adjoint_rhs,
    peak_of,
    pressure_integrals,
    refined_peak,
)
from exudyn_ehd.film.solver import FilmSolver, Sensitivities
from exudyn_ehd.status import Status

MOTION_SIZE = 10


@dataclass(frozen=True, eq=False)
class History:
    """What a bearing remembers between accepted steps.

    Attributes
    ----------
    mass : (n, m) array or None
        Scaled film content, fill times gap / c, at the vertices (mass-conserving closures).
    """

    mass: np.ndarray | None = None


class Wall:
    """Buffers and scaled parameters of a `RegularisedWall`; present only if the scene names one."""

    def __init__(self, shape: tuple[int, int], onset: float, pressure: float, residual: float) -> None:
        self.onset, self.pressure, self.residual = onset, pressure, residual
        self.P, self.P_slope = np.zeros(shape), np.zeros(shape)
        self.slope, self.curvature = np.zeros(shape), np.zeros(shape)
        self.face_slope, self.face_curvature = np.zeros(shape), np.zeros(shape)


@dataclass(eq=False)
class Evaluation:
    """One film evaluation.

    Attributes
    ----------
    status : Status
    motion : (10,) array
    wrench : (6,) array
        Force (N) and moment about O (Nm) on the journal, joint frame; nan if there is no film.
    iterations : int
        Linear solves spent.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    iterations: int
    _model: RigidBearingModel
    _serial: int

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10), exact for the current active set, from the stored factor.

        Raises
        ------
        RuntimeError
            If the model has evaluated another state since.
        """
        self._require_current()
        return self._model.tangent()

    def quantities(self) -> dict[str, float]:
        """Scalars of this state in SI units; see `RigidBearingModel.quantities`."""
        self._require_current()
        return self._model.quantities()

    def history(self) -> History | None:
        """What the bearing remembers if this state is accepted; None without effects that remember."""
        self._require_current()
        return self._model.history()

    def _require_current(self) -> None:
        if self._model.serial != self._serial:
            raise RuntimeError("Evaluation: the model has evaluated another state since; evaluate this state again.")


class RigidBearingModel:
    """Film between a rigid journal and a rigid bore.

    Parameters
    ----------
    bearing : JournalBearing
    start_angle : float
        theta of the first grid column, rad; the line of ambient pressure if the bearing's inlet is `MaximumGap`.
    """

    def __init__(self, bearing: JournalBearing, start_angle: float = 0.0) -> None:
        R, c, mu = bearing.journal_radius, bearing.radial_clearance, bearing.lubricant.viscosity
        self.bearing = bearing
        self.grid = bearing_grid(
            R, bearing.length, bearing.film.n_theta, bearing.film.n_z, stretch=bearing.film.stretch,
            start_angle=start_angle, open_ring=isinstance(bearing.inlet, MaximumGap),
        )  # fmt: skip
        self.solver = FilmSolver(
            self.grid, bearing.cavitation, squeeze=bearing.squeeze,
            circumferential_pressure_flow=bearing.film.circumferential_pressure_flow,
        )  # fmt: skip
        self.cos_x, self.sin_x = np.cos(self.grid.x), np.sin(self.grid.x)
        self.cos_f, self.sin_f = np.cos(self.grid.x_face), np.sin(self.grid.x_face)
        self.pressure_scale = 12.0 * mu * R**2 / c**2
        self.force_scale = self.pressure_scale * R**2
        self.shear_scale = mu * R**2 / c
        self.half_length = 0.5 * bearing.length / R
        self.pose_scale = np.array([1.0 / c, 1.0 / c, R / c, R / c])
        self.end_pressures = np.array(bearing.end_pressures) / self.pressure_scale
        self.cavity_pressure = bearing.cavitation.cavity_pressure / self.pressure_scale
        self.wall: Wall | None = None
        if bearing.contact is not None:
            self.wall = Wall(
                self.grid.shape, bearing.contact.onset / c, bearing.contact.pressure / self.pressure_scale,
                bearing.contact.residual,
            )  # fmt: skip
        self.remembers = bearing.cavitation.conserves_mass and bearing.squeeze
        self.serial = 0
        self.status = Status.NOT_FINITE
        self.integrals = np.zeros(4)
        self.wall_integrals = np.zeros(4)

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the time it takes."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded bearing (every gap full of oil) at this motion; None without effects that remember."""
        if not self.remembers:
            return None
        self._set_motion(motion)
        self._set_gap()
        return History(mass=self.solver.H.copy())

    def history(self) -> History | None:
        """History after the last evaluation."""
        if not self.remembers:
            return None
        return History(mass=self.solver.fill * self.solver.H)

    def evaluate(self, motion: np.ndarray, history: History | None = None, step: float = 0.0) -> Evaluation:
        """Evaluate the film.

        Parameters
        ----------
        motion : (10,) array
            Relative motion in the joint frame, SI units; see the module's docstring.
        history : History, optional
            At the last accepted step; None asks for the steady film.
        step : float
            Time since then, s; 0 asks for the force at that very instant.

        Returns
        -------
        Evaluation
            With ``status`` other than CONVERGED the wrench is nan.
        """
        self.serial += 1
        self._set_motion(motion)
        self.wrench = np.full(6, np.nan)
        self.iterations = 0
        self.status = self._solve(history, step)
        if self.status is Status.CONVERGED:
            self.wrench = self._loads()
        return Evaluation(self.status, self.motion, self.wrench, self.iterations, self, self.serial)

    def _set_motion(self, motion: np.ndarray) -> None:
        self.motion = np.array(motion, dtype=float)
        self.pose = self.motion[:4] * self.pose_scale
        self.rate = self.motion[4:8] * self.pose_scale
        self.omega, self.axial_speed = float(self.motion[8]), float(self.motion[9])

    def _set_gap(self) -> None:
        """Gaps of the present motion into the film solver."""
        s, z = self.solver, self.grid.z
        rigid_gap(self.pose, self.cos_x, self.sin_x, z, 1.0, s.H)
        rigid_gap(self.pose, self.cos_f, self.sin_f, z, 1.0, s.HF)
        if s.squeeze:
            rigid_gap(self.rate, self.cos_x, self.sin_x, z, 0.0, s.H_t)
        if self.wall is not None:
            self._apply_wall(self.wall)

    def _solve(self, history: History | None, step: float) -> Status:
        if not np.all(np.isfinite(self.motion)):
            return Status.NOT_FINITE
        self.eccentricity = float(largest_eccentricity(self.pose, self.half_length))
        if self.wall is None and self.eccentricity >= 1.0:
            return Status.NO_FILM
        self._set_gap()
        P = self.solver.pressure
        P[:, 0], P[:, -1] = self.end_pressures
        mass = history.mass if history is not None and self.remembers else None
        status, self.iterations = self.solver.solve(
            0.5 * self.omega, 0.5 * self.axial_speed / self.grid.reference_length, self.cavity_pressure, mass, step
        )
        return status

    def _apply_wall(self, wall: Wall) -> None:
        """Contact pressure from the true gap; then the gap that the film sees, and its rate."""
        s = self.solver
        wall_pressure(s.H, wall.onset, wall.pressure, wall.P, wall.P_slope)
        limit_gap(s.H, wall.onset, wall.residual, wall.slope, wall.curvature)
        limit_gap(s.HF, wall.onset, wall.residual, wall.face_slope, wall.face_curvature)
        if s.squeeze:
            wall.curvature *= s.H_t
            s.H_t *= wall.slope

    def _loads(self) -> np.ndarray:
        s, g = self.solver, self.grid
        pressure_integrals(s.pressure, g.weight, self.cos_x, self.sin_x, g.z, self.integrals)
        total = self.integrals
        if self.wall is not None:
            pressure_integrals(self.wall.P, g.weight, self.cos_x, self.sin_x, g.z, self.wall_integrals)
            total = self.integrals + self.wall_integrals
        if s.closure.conserves_mass:
            self.couette, self.couette_unbroken = couette_integral_fill(s.H, g.weight, s.fill)
        else:
            self.couette, self.couette_unbroken = couette_integral(
                s.H, g.weight, s.work.active, g.fixed, s.closure.cavity_shear
            )
        x, y, bx, by = self.pose
        sc, ss, szc, szs = total
        self.s_theta = x * ss - y * sc + bx * szs - by * szc
        self.s_z = -(bx * sc + by * ss)
        R, fs = g.reference_length, self.force_scale
        ends = self.end_pressures[1] * _ring_mean(s.H[:, -1]) - self.end_pressures[0] * _ring_mean(s.H[:, 0])
        return np.array(
            [
                -fs * sc,
                -fs * ss,
                -self.shear_scale * (self.axial_speed * self.couette + 6.0 * R * (self.s_z - ends)),
                fs * R * szs,
                -fs * R * szc,
                -self.shear_scale * R**2 * (self.omega * self.couette + 6.0 * self.s_theta),
            ]
        )

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10) of the last evaluation; nan without a film."""
        if self.status is not Status.CONVERGED:
            return np.full((6, MOTION_SIZE), np.nan)
        ds, dc = self._integral_gradients()
        g = self.grid
        x, y, bx, by = self.pose
        sc, ss, szc, szs = self.integrals + self.wall_integrals
        ds_theta = x * ds[1] - y * ds[0] + bx * ds[3] - by * ds[2]
        ds_theta[:4] += (ss, -sc, szs, -szc)
        ds_z = -(bx * ds[0] + by * ds[1])
        ds_z[2:4] -= (sc, ss)
        R, fs, c0 = g.reference_length, self.force_scale, self.shear_scale
        out = np.empty((6, MOTION_SIZE))
        out[0], out[1], out[3], out[4] = -fs * ds[0], -fs * ds[1], fs * R * ds[3], -fs * R * ds[2]
        out[2] = -6.0 * c0 * R * ds_z
        out[5] = -6.0 * c0 * R**2 * ds_theta
        out[2] -= c0 * self.axial_speed * dc
        out[5] -= c0 * R**2 * self.omega * dc
        out[:, :4] *= self.pose_scale
        out[:, 4:8] *= self.pose_scale
        out[:, 8] *= 0.5
        out[:, 9] *= 0.5 / R
        out[2, 9] -= c0 * self.couette
        out[5, 8] -= c0 * R**2 * self.couette
        if self.wall is not None:
            out[2, :4] += 6.0 * c0 * R * self._end_gradient()
        return out

    def _end_gradient(self) -> np.ndarray:
        """Gradient (4,) of the ends' pressure force with respect to the pose where a wall limits the gap."""
        assert self.wall is not None
        out = np.zeros((1, 4))
        field = np.zeros((1, *self.grid.shape))
        step = self.grid.width_x[0]
        field[0, :, -1] = self.end_pressures[1] * step * self.wall.slope[:, -1]
        field[0, :, 0] = -self.end_pressures[0] * step * self.wall.slope[:, 0]
        contract_pose(field, self.cos_x, self.sin_x, self.grid.z, out)
        return out[0] * self.pose_scale

    def _integral_gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Gradients of (S_c, S_s, S_zc, S_zs), (4, 10), and of C, (10,), to the scaled pose and rates, vx, vz."""
        s, g, w = self.solver, self.grid, self.solver.work
        fills = s.closure.conserves_mass
        rhs = np.empty((5 if fills else 4, w.count))
        load_adjoint_rhs(w.order, w.count, g.weight, self.cos_x, self.sin_x, g.z, w.active, rhs)
        if fills:
            couette_adjoint_rhs(w.order, w.count, g.weight, s.H, w.active, rhs[4])
        sens = s.sensitivities(s.adjoint(rhs))
        if self.wall is not None:
            self._chain_wall(self.wall, sens)
        out = np.zeros((5, MOTION_SIZE))
        k = rhs.shape[0]
        pose, rates = np.zeros((k, 4)), np.zeros((k, 4))
        contract_pose(sens.cell, self.cos_x, self.sin_x, g.z, pose)
        contract_pose(sens.face, self.cos_f, self.sin_f, g.z, pose)
        if sens.rate is not None:
            contract_pose(sens.rate, self.cos_x, self.sin_x, g.z, rates)
        out[:k, :4], out[:k, 4:8], out[:k, 8:] = pose, rates, sens.speed
        out[4, :4] += self._couette_direct()
        return out[:4], out[4]

    def _couette_direct(self) -> np.ndarray:
        """Direct gradient (4,) of C to the scaled pose, at fixed pressure and fill."""
        s, g = self.solver, self.grid
        gradient = np.empty((1, *g.shape))
        if s.closure.conserves_mass:
            gradient[0] = -g.weight * s.fill / s.H**2
        else:
            couette_gradient(s.H, g.weight, s.work.active, g.fixed, s.closure.cavity_shear, gradient[0])
        if self.wall is not None:
            gradient[0] *= self.wall.slope
        out = np.zeros((1, 4))
        contract_pose(gradient, self.cos_x, self.sin_x, g.z, out)
        return out[0]

    def _chain_wall(self, wall: Wall, sens: Sensitivities) -> None:
        """From the film's gap to the true gap, and the contact pressure's own part."""
        g = self.grid
        sens.face *= wall.face_slope
        sens.cell *= wall.slope
        if sens.rate is not None:
            sens.cell += sens.rate * wall.curvature
            sens.rate *= wall.slope
        for k, factor in enumerate((self.cos_x[:, None], self.sin_x[:, None])):
            direct = wall.P_slope * g.weight * factor
            sens.cell[k] += direct
            sens.cell[k + 2] += direct * g.z

    def quantities(self) -> dict[str, float]:
        """Scalars of the last evaluation.

        Returns
        -------
        dict
            ``minimum_gap`` (m, over the whole bearing with its edges), ``eccentricity_ratio`` (at the mid-plane),
            ``largest_eccentricity_ratio`` (over the length), ``peak_pressure`` (Pa, the film's largest vertex),
            ``friction_torque`` (Nm, of the film on the journal about its own axis),
            ``friction_torque_unbroken`` (the same with shear of the unbroken film only), ``friction_torque_bush`` (Nm, on
            the housing about the bearing axis), ``power_loss`` (W, mechanical power that enters the film), ``leakage``
            (m3/s out of both ends), ``leakage_lower`` and ``leakage_upper``, ``contact_load`` (N, carried by the wall).
        """
        b = self.bearing
        c = b.radial_clearance
        gap = c * (1.0 - float(largest_eccentricity(self.pose, self.half_length)))
        out = {
            "minimum_gap": gap,
            "eccentricity_ratio": math.hypot(self.pose[0], self.pose[1]),
            "largest_eccentricity_ratio": 1.0 - gap / c,
        }
        if self.status is not Status.CONVERGED:
            return out
        s, g, R = self.solver, self.grid, self.grid.reference_length
        peak = peak_of(s.pressure)[0]
        torque_scale = self.shear_scale * R**2
        if s.closure.conserves_mass:
            inflow = s.inflow()
            lower, upper = -float(inflow[:, 0].sum()), -float(inflow[:, -1].sum())
        else:
            y = s.system
            lower, upper = end_flows(
                s.pressure, y.kz, y.fz, y.fx, s.H_t, g.width_x, g.width_z, s.squeeze, s.work.active, g.fixed
            )
        flow_scale = c * R**2
        friction = -torque_scale * (self.omega * self.couette - 6.0 * self.s_theta)
        v, f = self.motion, self.wrench
        along = f[2] + v[2] * f[0] + v[3] * f[1]  # a tilted journal slides along its own axis, not along z
        power = f[0] * v[4] + f[1] * v[5] - f[3] * v[7] + f[4] * v[6] + friction * self.omega + along * self.axial_speed
        out |= {
            "peak_pressure": peak * self.pressure_scale,
            "friction_torque": friction,
            "friction_torque_unbroken": -torque_scale * (self.omega * self.couette_unbroken - 6.0 * self.s_theta),
            "friction_torque_bush": -float(self.wrench[5]),
            "power_loss": -power,
            "leakage": flow_scale * (lower + upper),
            "leakage_lower": flow_scale * lower,
            "leakage_upper": flow_scale * upper,
            "contact_load": self.force_scale * math.hypot(self.wall_integrals[0], self.wall_integrals[1]),
        }
        return out

    def refined_peak(self) -> tuple[float, float, float]:
        """Peak pressure (Pa) with its angle (rad) and z (m), from parabolas through the largest vertex."""
        peak, theta, z = refined_peak(self.solver.pressure, self.grid.x, self.grid.z, True)
        return peak * self.pressure_scale, theta, z * self.grid.reference_length


def _ring_mean(row: np.ndarray) -> float:
    """Integral over the circumference of a row of vertex values."""
    return float(row.mean() * 2.0 * math.pi)
