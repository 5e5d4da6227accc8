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
from operator import is_

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.loads import (
    couette_integral,
    couette_integral_fill,
    couette_integral_ratio,
    pressure_integrals,
    slope_integrals,
)
from exudyn_ehd.film.models import film_grid, film_solver, liner_film_solver
from exudyn_ehd.film.reynolds.gap import add_to_gap, largest_eccentricity, rigid_gap
from exudyn_ehd.film.sensitivity.bore_stencil import gap_slopes
from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver
from exudyn_ehd.film.solvers.compressible import CompressibleFilmSolver
from exudyn_ehd.film.solvers.liner import LinerFilmSolver
from exudyn_ehd.film.supply import SupplyMap
from exudyn_ehd.film.surfaces.contact_wrench import contact_wrench, couette_integral_law
from exudyn_ehd.joint.buffers import ContactFields, LimiterFields
from exudyn_ehd.joint.evaluation import Evaluation
from exudyn_ehd.joint.model.film_laws import apply_laws
from exudyn_ehd.joint.model.quantities import power_loss, quantities, refined_peak, supply_flows
from exudyn_ehd.joint.seams import Contact, Effects, History, Wear
from exudyn_ehd.joint.tangent.drag import drag_integrals
from exudyn_ehd.joint.tangent.wrench import wrench_tangent
from exudyn_ehd.status import Status

MOTION_SIZE = 10


class BearingModel:
    """Film between a rigid journal and a rigid bore, with the effects that a scene names.

    Parameters
    ----------
    bearing : JournalBearing
    start_angle : float
        theta of the first grid column, rad; the line of ambient pressure if the bearing's inlet is `MaximumGap`.
    effects : Effects
    """

    def __init__(self, bearing: JournalBearing, *, start_angle: float = 0.0, effects: Effects | None = None) -> None:
        R, c = bearing.journal_radius, bearing.radial_clearance
        self.bearing = bearing
        self.effects = Effects() if effects is None else effects
        self.grid = film_grid(
            bearing.film, R, bearing.length, start_angle=start_angle, open_ring=isinstance(bearing.inlet, MaximumGap)
        )
        self.supply = SupplyMap(bearing.supply, self.grid) if bearing.supply else None
        self.needs_spin = self.supply is not None and self.supply.rotating
        self.liner_solver: LinerFilmSolver | CompliantFilmSolver | None = None
        if self.effects.liner is not None:
            self.liner_solver = liner_film_solver(
                self.grid,
                bearing.cavitation,
                squeeze=bearing.squeeze,
                contact=next(iter(self.effects.contacts), None),
                limiter=self.effects.limiter,
                flux_effects=self.effects.flux,
                oil=self.effects.pressure_law,
            )
        self.solver = self.liner_solver or film_solver(
            bearing.film, self.grid, bearing.cavitation, squeeze=bearing.squeeze, flux_effects=self.effects.flux,
            density=self.effects.density,
        )  # fmt: skip
        self.compressible = self.solver if isinstance(self.solver, CompressibleFilmSolver) else None
        self.cos_x, self.sin_x = np.cos(self.grid.x), np.sin(self.grid.x)
        self.cos_f, self.sin_f = np.cos(self.grid.x_face), np.sin(self.grid.x_face)
        self.half_length = 0.5 * bearing.length / R
        self.pose_scale = np.array([1.0 / c, 1.0 / c, R / c, R / c])
        shape = self.grid.shape
        self.contact_fields = ContactFields(shape, self.effects.contacts) if self.effects.contacts else None
        self.limiter_fields: LimiterFields | None = None
        # a liner's contact and film gap come out of its film solve
        self.compliant = self.liner_solver if isinstance(self.liner_solver, CompliantFilmSolver) else None
        if self.effects.limiter is not None and self.compliant is None:
            self.limiter_fields = LimiterFields(shape)
        if self.compliant is not None and self.contact_fields is not None:
            self.contact_fields.P, self.contact_fields.slope = (
                [self.compliant.contact_pressure],
                [self.compliant.contact_slope],
            )
        # The same, if the surfaces were close enough for them to act in the last evaluation.
        self.pressing: ContactFields | None = None
        self.limited: LimiterFields | None = None
        self.extra: np.ndarray | None = None
        self.extra_link: np.ndarray | None = None
        self.extra_slope_x: np.ndarray | None = None
        self.extra_slope_z: np.ndarray | None = None
        self.ratio: np.ndarray | None = None
        self.ratio_q: np.ndarray | None = None
        self.ratio_h: np.ndarray | None = None
        self.ratio_v: np.ndarray | None = None
        self.P_q: np.ndarray | None = None
        self.flow_scale = c * R**2
        if self.effects.pressure_law is not None:
            self.known = self.effects.pressure_law.transform(
                np.array([*bearing.end_pressures, bearing.cavitation.cavity_pressure])
            )
        self.known_ends = np.array(bearing.end_pressures)
        self.set_viscosity_ratio(1.0)
        self.remembers_mass = bearing.cavitation.conserves_mass and bearing.squeeze
        self.remembers_density = (
            self.remembers_mass and self.compressible is not None and self.effects.thermal is not None
        )
        self.remembers_deflection = self.effects.liner is not None and bearing.squeeze
        self.remembers = self.remembers_mass or self.remembers_deflection
        self.remembers = self.remembers or self.effects.thermal is not None or self.effects.wear is not None
        self.start: tuple[History | None, float] = (None, 0.0)
        self.gap_fields: list[np.ndarray] = []
        self.serial = 0
        self.status = Status.NOT_FINITE
        self.integrals = np.zeros(4)

    def set_viscosity_ratio(self, ratio: float) -> None:
        """Scale the film to ``ratio`` times the lubricant's reference viscosity (one temperature for the whole film)."""
        b = self.bearing
        mu, R, c = ratio * b.lubricant.viscosity, b.journal_radius, b.radial_clearance
        self.pressure_scale = 12.0 * mu * R**2 / c**2
        self.force_scale = self.pressure_scale * R**2
        self.shear_scale = mu * R**2 / c
        self.end_pressures = self.known_ends / self.pressure_scale
        self.cavity_pressure = b.cavitation.cavity_pressure / self.pressure_scale
        if self.liner_solver is not None and self.effects.liner is not None:
            self.liner_solver.beta = self.effects.liner.compliance * self.pressure_scale / c
        if self.compliant is not None:
            self.compliant.pressure_scale = self.pressure_scale
        if self.compressible is not None:
            self.compressible.pressure_scale = self.pressure_scale

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the time it takes."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded bearing (every gap full of oil) at this motion; None without effects that remember."""
        if not self.remembers:
            return None
        thermal = self.effects.thermal
        temperature = None if thermal is None else thermal.initial_temperature(self)
        self._set_motion(motion)
        self._set_gap(None)
        wear = None if self.effects.wear is None else self.effects.wear.depth(None).copy()
        deflection = self._steady_deflection(motion) if self.remembers_deflection else None
        mass = self.solver.H.copy() if self.remembers_mass else None
        density = self.solver.ones if self.remembers_density else None
        return History(mass=mass, wear=wear, deflection=deflection, temperature=temperature, density=density)

    def _steady_deflection(self, motion: np.ndarray) -> np.ndarray | None:
        """Scaled deflection of the steady film at this motion; None if there is no such film."""
        if self.evaluate(motion).status is not Status.CONVERGED or self.liner_solver is None:
            return None
        return self.liner_solver.deflection

    def history(self) -> History | None:
        """History after the last evaluation.

        Raises
        ------
        RuntimeError
            If that evaluation found no film.
        """
        if self.status is not Status.CONVERGED:
            raise RuntimeError(
                f"BearingModel.history: the last evaluation ended with {self.status.name}; there is no history to keep."
            )
        if not self.remembers:
            return None
        mass = self.solver.content if self.remembers_mass else None
        wear = None if self.effects.wear is None else self.worn(self.effects.wear)
        deflection = None
        if self.remembers_deflection and self.liner_solver is not None:
            deflection = self.liner_solver.deflection
        thermal = self.effects.thermal
        temperature = None if thermal is None else thermal.advance(self)
        density = None
        if self.remembers_density and self.compressible is not None:
            density = self.compressible.rho.copy()
        return History(mass=mass, wear=wear, deflection=deflection, temperature=temperature, density=density)

    def worn(self, wear: Wear) -> np.ndarray:
        """Scaled wear depth after the last evaluation."""
        assert self.contact_fields is not None
        history, step = self.start
        speed = math.hypot(self.grid.reference_length * self.omega, self.axial_speed)
        pressure, *others = self.contact_fields.P
        for other in others:
            pressure = pressure + other
        return wear.grown(None if history is None else history.wear, pressure, speed, step)

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> Evaluation:
        """Evaluate the film.

        Parameters
        ----------
        motion : (10,) array
            Relative motion in the joint frame, SI units; see the module's docstring.
        history : History, optional
            At the last accepted step; None asks for the steady film.
        step : float
            Time since then, s; 0 asks for the force at that very instant.
        spin : float
            Angle of the journal against the housing about the bearing's axis, rad; only read if ``needs_spin`` (supply areas in
            the journal).

        Returns
        -------
        Evaluation
            With ``status`` other than CONVERGED the wrench is nan.
        """
        self.serial += 1
        self.start = (history, step)
        self._set_motion(motion)
        if self.effects.thermal is not None:
            self.effects.thermal.begin(self, history)
        self.iterations = 0
        if self.supply is not None and self.supply.turn(spin):
            self.solver.refresh_fixed()
        self.status = self._solve(history, step)
        self.wrench = self._loads() if self.status is Status.CONVERGED else np.full(6, np.nan)
        return Evaluation(self.status, self.motion, self.wrench, self.iterations, self, self.serial)

    def _set_motion(self, motion: np.ndarray) -> None:
        self.motion = np.array(motion, dtype=float)
        self.pose = self.motion[:4] * self.pose_scale
        self.rate = self.motion[4:8] * self.pose_scale
        self.omega, self.axial_speed = float(self.motion[8]), float(self.motion[9])

    def _set_gap(self, history: History | None) -> float:
        """Gaps of the present motion into the film solver; returns the smallest true gap, scaled."""
        s, z = self.solver, self.grid.z
        rigid_gap(self.pose, self.cos_x, self.sin_x, z, 1.0, s.H)
        rigid_gap(self.pose, self.cos_f, self.sin_f, z, 1.0, s.HF)
        if s.squeeze:
            rigid_gap(self.rate, self.cos_x, self.sin_x, z, 0.0, s.H_t)
        smallest = 1.0 - float(largest_eccentricity(self.pose, self.half_length))
        if self.effects.gap_terms:
            smallest = self._add_gap_terms(history)
        if self.compliant is not None:
            return smallest
        if self.contact_fields is not None:
            self._set_contacts(self.contact_fields, smallest)
        self.limited = None
        if self.effects.limiter is not None and smallest < self.effects.limiter.limits_below:
            self.limited = f = self.limiter_fields
            assert f is not None
            self.effects.limiter.limit(s.H, s.HF, s.H_t, f.slope, f.bend, f.face_slope)
        return smallest

    def _set_contacts(self, f: ContactFields, smallest: float) -> None:
        """Pressures of the contacts at the true gap."""
        if smallest < f.presses_below:
            self.pressing = f
            for k, contact in enumerate(self.effects.contacts):
                contact.pressure(self.solver.H, f.P[k], f.slope[k])
        elif self.pressing is not None:
            self.pressing = None
            f.clear()

    def _add_gap_terms(self, history: History | None) -> float:
        """Add the gap terms; their slopes (central differences; one-sided at the ends) are kept. Returns the smallest gap."""
        s, g = self.solver, self.grid
        fields = [term.field(history) for term in self.effects.gap_terms]
        if self.extra is None or self.extra_link is None or not all(map(is_, fields, self.gap_fields)):
            self.gap_fields = fields
            self.extra = fields[0] if len(fields) == 1 else np.sum(fields, axis=0)
            self.extra_link, self.extra_slope_x, self.extra_slope_z = (np.empty(g.shape) for _ in range(3))
            gap_slopes(self.extra, g.width_x[0], g.z, self.extra_link, self.extra_slope_x, self.extra_slope_z)
        return float(add_to_gap(self.extra, self.extra_link, s.H, s.HF))

    def _solve(self, history: History | None, step: float) -> Status:
        if not all(map(math.isfinite, self.motion.tolist())):
            return Status.NOT_FINITE
        self.minimum_gap = self.bearing.radial_clearance * self._set_gap(history)
        if self.minimum_gap <= 0.0 and not self.effects.contacts and self.liner_solver is None:
            return Status.NO_FILM
        ends, cavity = self.end_pressures, self.cavity_pressure
        law = self.effects.pressure_law
        if law is not None:
            known = self.known / self.pressure_scale
            ends, cavity = known[:2], float(known[2])
        P = self.solver.pressure
        P[:, 0], P[:, -1] = ends
        if self.supply is not None:
            fed = self.supply.pressures()
            self.supply.prescribe((fed if law is None else law.transform(fed)) / self.pressure_scale, P)
        mass = history.mass if history is not None and self.remembers_mass else None
        if self.liner_solver is not None:
            self.liner_solver.delta_old = None if history is None else history.deflection
        status, self.iterations = self.solver.solve(
            0.5 * self.omega, 0.5 * self.axial_speed / self.grid.reference_length, cavity, mass, step
        )
        if status is Status.CONVERGED and (law is not None or self.effects.shear_factor is not None):
            status = apply_laws(self)
        elif status is Status.CONVERGED:
            self.P = self.solver.pressure
        if status is Status.CONVERGED and self.liner_solver is not None:
            smallest = self.liner_solver.smallest_gap()
            self.minimum_gap = self.bearing.radial_clearance * smallest
            if self.compliant is not None and self.contact_fields is not None:
                self.pressing = self.contact_fields if smallest < self.contact_fields.presses_below else None
        return status

    def share(self) -> np.ndarray:
        """Share of a full film's shear that acts at each vertex (n, m)."""
        s = self.solver
        if s.closure.conserves_mass:
            return s.fill
        return np.where(s.work.active | self.grid.fixed, 1.0, s.closure.cavity_shear)

    def _couette(self) -> tuple[float, float]:
        s, g = self.solver, self.grid
        if self.ratio is not None and s.closure.conserves_mass:
            return couette_integral_ratio(s.H, g.weight, self.ratio, s.fill, s.fill >= 1.0)
        if self.ratio is not None:
            return couette_integral_law(s.H, g.weight, self.ratio, s.work.active, g.fixed, s.closure.cavity_shear)
        if s.closure.conserves_mass:
            return couette_integral_fill(s.H, g.weight, s.fill)
        return couette_integral(s.H, g.weight, s.work.active, g.fixed, s.closure.cavity_shear)

    def _loads(self) -> np.ndarray:
        s, g = self.solver, self.grid
        pressure_integrals(self.P, g.weight, self.cos_x, self.sin_x, g.z, self.integrals)
        self.extra_theta = self.extra_z = 0.0
        if self.extra_slope_x is not None and self.extra_slope_z is not None:
            self.extra_theta, self.extra_z = slope_integrals(self.P, g.weight, self.extra_slope_x, self.extra_slope_z)
        if self.liner_solver is not None:
            # The deflection's slope in the Poiseuille shear: p d(beta p)/dz integrates to beta p^2 / 2 at the ends.
            self.extra_z += (
                math.pi * self.liner_solver.beta * float(self.end_pressures[1] ** 2 - self.end_pressures[0] ** 2)
            )
        if self.effects.uneven_drag:
            drag = drag_integrals(self)
            self.extra_theta += drag[0]
            self.extra_z += drag[1]
        self.couette, self.couette_unbroken = self._couette()
        x, y, bx, by = self.pose.tolist()
        sc, ss, szc, szs = self.integrals.tolist()
        self.s_theta = x * ss - y * sc + bx * szs - by * szc + self.extra_theta
        self.s_z = -(bx * sc + by * ss) + self.extra_z
        # On the bore, gap terms act twice: by half of p dh/ds as in every shear, and by -p dh/ds of the pressure on their slope. Uneven drag
        # pulls the journal by as much as it holds the bore back.
        R, fs = g.reference_length, self.force_scale
        ends, (lower, upper) = 0.0, self.end_pressures.tolist()
        if lower != 0.0 or upper != 0.0:
            ends = upper * _ring_integral(s.H[:, -1]) - lower * _ring_integral(s.H[:, 0])
        wrench = np.array(
            [
                -fs * sc,
                -fs * ss,
                -self.shear_scale
                * (self.axial_speed * self.couette + 6.0 * R * (self.s_z - 2.0 * self.extra_z - ends)),
                fs * R * szs,
                -fs * R * szc,
                -self.shear_scale * R**2 * (self.omega * self.couette + 6.0 * (self.s_theta - 2.0 * self.extra_theta)),
            ]
        )
        self.contact_wrench = np.zeros(6)
        if self.pressing is not None:
            self._add_contacts(self.pressing, wrench)
        return wrench

    def _add_contacts(self, f: ContactFields, wrench: np.ndarray) -> None:
        """Add the contacts' pressures and friction to ``wrench`` (6,); their friction stays in ``contact_wrench``."""
        g, R = self.grid, self.grid.reference_length
        for k, (friction, transition) in enumerate(f.friction):
            contact_wrench(
                f.P[k], g.weight, self.cos_x, self.sin_x, g.z, self.motion, friction, transition, R, f.integrals[k],
                self.contact_wrench, wrench,
            )  # fmt: skip

    def slip(self, contact: Contact) -> tuple[float, float, np.ndarray]:
        """Regularised slip direction (theta, z) and its derivatives (2, 2) to (omega, w): v / sqrt(|v|^2 + v0^2)."""
        R = self.grid.reference_length
        v, w = R * self.omega, self.axial_speed
        size = math.sqrt(v * v + w * w + contact.transition_speed**2)
        a, b = v / size, w / size
        slope = np.array([[(1.0 - a * a) * R, -a * b], [-a * b * R, 1.0 - b * b]]) / size
        return a, b, slope

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10) of the last evaluation; nan without a film.

        ``slow_motion`` lets a liner follow the rates, for the damping of a steady state; without a liner it changes nothing.
        """
        if self.status is not Status.CONVERGED:
            return np.full((6, MOTION_SIZE), np.nan)
        return wrench_tangent(self, slow_motion)

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> Evaluation:
        """Evaluate the film at a motion (10,) that lasts; a flexible bore settles under it. The rest as for `evaluate`."""
        return self.evaluate(motion, history, step, spin)

    def shape(self) -> np.ndarray | None:
        """Scaled height of profile and wear (n, m), of undeformed surfaces, at the last evaluation; None for cylinders."""
        return self.extra

    def bore_fields(self) -> dict[str, np.ndarray]:
        """Displacement and coordinates of a flexible bore by name; empty for a rigid one."""
        return {}

    def steady_tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10) after `evaluate_steady`; a flexible bore follows."""
        return self.tangent()

    def quantities(self) -> dict[str, float]:
        """Scalars of the last evaluation by name, SI units; see `exudyn_ehd.joint.model.quantities.quantities`."""
        return quantities(self)

    def power_loss(self) -> float:
        """Mechanical power that the last evaluation's film and contacts keep, W; see `exudyn_ehd.joint.model.quantities.quantities`."""
        return power_loss(self)

    def supply_flows(self) -> np.ndarray:
        """What every area of ``bearing.supply`` feeds into the film, m3/s; empty without supply."""
        return supply_flows(self)

    def refined_peak(self) -> tuple[float, float, float]:
        """Peak pressure (Pa) with its angle (rad) and z (m), from parabolas through the largest vertex."""
        return refined_peak(self)


def _ring_integral(row: np.ndarray) -> float:
    """Integral over the circumference of a row of vertex values."""
    return float(row.sum() * (2.0 * math.pi / row.size))
