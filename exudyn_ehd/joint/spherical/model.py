"""One ball in its socket as a pure function of their relative motion.

Frame: the socket's, origin O in its centre, z its axis; n is the direction from O to a point of the socket. With the
ball's centre at e, its velocity v and its angular velocity w, both as seen from the socket, the gap is

    h = c - e n,        dh/dt = -v n,

and the mean velocity of the surfaces w x R n / 2, which has no divergence on the sphere. Reynolds' equation then is

    div(h^3 / (12 mu) grad p) = w x R n / 2 grad h + dh/dt = -n u,        u = v + e x w / 2 :

in a frame that turns with half the relative angular velocity there is squeeze alone. A film that conserves mass has oil
in a part of the gap only, which moves with the mean velocity. Its links have Couette flows instead, and u = v: the same
in a full film, to round-off (`exudyn_ehd.joint.spherical.bearing.SphereFlow`). The edges have p = 0. Only what is
relative counts: a motion of ball and socket together changes none of it. Left out, as in every Reynolds film, is what
is c / R of what is there: the ball's translation along the film in the flow, and the pressure's shear forces.

With u = 0 (a ball at rest, or one that spins about the line to its place) nothing presses. The pressure is homogeneous
of degree one in u, so that a film that ruptures at the edges' pressure has one-sided derivatives only: it carries where
u closes the gap.

Loads on the ball, N and A the integrals of n and of 1 over the control volumes, f = 12 mu R^4 / c^2, P = p c^2 / (12 mu
R^2), H = h / c:

    pressure    F_p = -f sum P N, through the ball's centre
    Couette     F_c = -mu R^2 / c (K v + R w x a),  T_c = -mu R^2 / c (R a x v + R^2 K w),
                a = sum n / H dA,  K = sum (1 - n n) / H dA : a symmetric, dissipative pair
    Poiseuille  T_p = (f / 2) e x sum P N: of the shear -(h / 2) grad p by parts. The socket has the same torque about
                its own centre, so that both halves of e x F_p are found and all moments cancel.

The wrench is F = F_p + F_c and the moment about O, T_c + T_p + e x F; the socket gets minus that about O. With the same
N in loads and sources, work and heat match link by link: -(F v + T w) = sum H^3 (dP)^2 + Couette's heat >= 0.

Where a wall limits the film's gap to H(g), g the true one, sources and T_p carry dH/dg (closed gaps in
`exudyn_ehd.film.surfaces.patir_cheng`); what the slopes leave of the pressure goes from solid to solid, without torque.

With a pressure law the solver's unknown is q, dq = dp mu_0 / mu(p) (`exudyn_ehd.film.lubricant.pressure_viscosity`),
loads take p(q) and the viscosity of every vertex; heat is sum H^3 dq dP.

The pressure comes from the film solver of cylindrical bearings on the grid of `exudyn_ehd.joint.spherical.bearing`:
with -N u / c for the storage of a control volume it needs no other input. Second order in both directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.cavitation.linear_film import rows_of_linear
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.film.reynolds.differences import on_links
from exudyn_ehd.film.solvers.film import shear_by_unknown, shear_share
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.joint.solved_film import History, LimiterFields
from exudyn_ehd.joint.spherical.bearing import (
    SphereFlow,
    SphericalBearing,
    drag_of_moments,
    skew,
    sphere_patch,
)
from exudyn_ehd.joint.tangent.one_sided import BESIDE, CENTRE, quotients
from exudyn_ehd.status import Status

PLACE, VELOCITY, SPIN = slice(0, 3), slice(4, 7), slice(8, 11)
SIZE = 11
"""Motion: place (m), 0, velocity (m/s), 0, angular velocity (rad/s); `exudyn_ehd.joint.step_rates` knows four places
and four rates."""
# Place (3,), velocity and angular velocity (6,) of a motion as products with it.
_PLACE, _SPEEDS = np.eye(SIZE)[PLACE], np.eye(SIZE)[[4, 5, 6, 8, 9, 10]]


class BallFilm(NamedTuple):
    """A solved film; fields (n, m).

    Attributes
    ----------
    pressure : Pa; gap of the film : m; unbroken : bool; fill : oil over gap, 1 unless the film conserves mass
    wrench : (6,) array
        On the ball, moment about O.
    torque : (3,) array
        On the ball about its centre, N m.
    contact : (3,) array
        Force of the wall in ``wrench``, N.
    drag : (6, 6) array
        Force and torque of the Couette shear by velocity and angular velocity.
    stored_power : W, taken up by the wall
    ratio, ratio_q : (n m,) arrays or floats
        Viscosity over the reference, and its derivative to the solver's unknown.
    """

    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray
    wrench: np.ndarray
    torque: np.ndarray
    contact: np.ndarray
    drag: np.ndarray
    stored_power: float
    ratio: np.ndarray | float
    ratio_q: np.ndarray | float


@dataclass(eq=False)
class SphericalEvaluation:
    """One film evaluation; as `exudyn_ehd.coupling.contract.JointEvaluation`.

    Attributes
    ----------
    status : Status
    motion : (11,) array
    wrench : (6,) array
        On the ball, moment about O; nan without a film.
    minimum_gap : float
        Minimum gap of the rigid surfaces, exact, m.
    film : BallFilm or None
    before, step : History or None, float
        At the start of the step, and the time since then, s.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    minimum_gap: float
    film: BallFilm | None = field(repr=False)
    model: SphericalModel = field(repr=False)
    serial: int = field(repr=False)
    before: History | None = field(repr=False)
    step: float = field(repr=False)

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 11), exact for the current active set; until the model's next evaluation.

        Of a ball at rest the mean of `sides`.
        """
        if self.film is None:
            return np.full((6, SIZE), np.nan)
        if (sides := self.sides()) is not None:
            return np.asarray(sides.mean(axis=0))
        return self.model.tangent(self.motion, self.film)

    def steady_tangent(self) -> np.ndarray:
        """Return the tangent: nothing follows the motion of rigid surfaces."""
        return self.tangent()

    def sides(self) -> np.ndarray | None:
        """One-sided derivatives (2, 6, 11) of the film of a ball at rest; None of one that has derivatives."""
        self._require_current()
        if not self.model.is_at_rest(self.motion):
            return None
        spin = float(np.linalg.norm(self.motion[SPIN])) or 1.0
        length = BESIDE * self.model.bearing.radial_clearance
        steps = np.repeat([length, 0.0, spin * length, 0.0, BESIDE * spin], [3, 1, 3, 1, 3])
        # a model of its own keeps this film in the buffers
        beside = SphericalModel(self.model.bearing)
        return quotients(lambda at: beside.evaluate(at, self.before, self.step).wrench, self.motion, steps)

    def quantities(self) -> dict[str, float]:
        """Scalars of this state: m, Pa, N m, W, N."""
        f = self.film
        if f is None:
            return {"minimum_gap": self.minimum_gap}
        power = -float(f.wrench[:3] @ self.motion[VELOCITY] + f.torque @ self.motion[SPIN])
        return {
            "minimum_gap": self.minimum_gap,
            "peak_pressure": float(f.pressure.max()),
            "friction_torque": float(np.linalg.norm(f.torque)),
            "power_loss": power - f.stored_power,
            "contact_load": float(np.linalg.norm(f.contact)),
            "stored_power": f.stored_power,
        }

    def history(self) -> History | None:
        """Return the film's memory after this state; None of a film that remembers nothing."""
        if not self.model.remembers:
            return None
        self._require_current()
        s, old = self.model.solver, History() if self.before is None else self.before
        void, mass = s.stored(old.mass, self.step)
        return History(void=void, mass=mass, outflow=s.outflow())

    def _require_current(self) -> None:
        if self.serial != self.model.serial:
            raise RuntimeError("Evaluation: the model has evaluated another state since; evaluate this state again.")


class SphericalModel:
    """Film between a rigid ball and a rigid socket.

    Parameters
    ----------
    bearing : SphericalBearing
    """

    needs_spin = flexible = False
    motion_size = SIZE

    def __init__(self, bearing: SphericalBearing) -> None:
        self.bearing = b = bearing
        mu, R, c = b.lubricant.viscosity, b.ball_radius, b.radial_clearance
        self.patch = p = sphere_patch(R, b.socket_angles, b.n_phi, b.n_chi)
        self.grid: FilmGrid = p.grid
        self.remembers = self.remembers_mass = b.cavitation.conserves_mass
        self.flow = SphereFlow(p, c) if self.remembers_mass else None
        if self.flow is not None:
            p.grid.area[:] = p.area  # what control volumes hold is above them on the sphere
        self.solver = FilmSolver(p.grid, b.cavitation, flux_effects=() if self.flow is None else (self.flow,))
        self.limiter = None if b.contact is None else WallContact(b.contact, c)
        self.pressure_scale = 12.0 * mu * R**2 / c**2
        self.force_scale, self.shear_scale = self.pressure_scale * R**2, mu * R**2 / c
        self.law, self._cavity = transform_of(b.lubricant), b.cavitation.cavity_pressure
        if self.law is not None:
            self._cavity = float(self.law.transform(np.array(self._cavity)))
        # over control volumes: normals, and storage of a velocity (m/s) per area of the grid
        self._vector = p.vector.reshape(3, -1)
        self._moments = np.concatenate([p.area[None], p.vector, p.tensor]).reshape(10, -1)
        self._storage = -(p.vector / (c * p.grid.area)).reshape(3, -1)
        self._gap_slope, self._link_slope = (-n.reshape(3, -1) / c for n in (p.normals, p.link_normals))
        self._drag = -self.shear_scale * drag_of_moments(R)
        self._closed, (self._wall, self._wall_slope) = LimiterFields(p.grid.shape), np.zeros((2, *p.grid.shape))
        self._closed.slope[:] = self._closed.face_slope[:] = 1.0
        self._limits, self.serial = False, 0

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the time it takes."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded socket at this motion; None of a film that remembers nothing."""
        if not self.remembers:
            return None
        self.serial += 1
        self._set_gap(motion)
        void, mass, outflow = self.solver.flooded()
        return History(void=void, mass=mass, outflow=outflow)

    def is_at_rest(self, motion: np.ndarray) -> bool:
        """Return whether the last film, at this motion, has no source and may rupture at any."""
        source = CENTRE * self.bearing.radial_clearance * float(np.linalg.norm(motion[SPIN]))
        entrained = motion[VELOCITY] + 0.5 * skew(motion[PLACE]) @ motion[SPIN]
        return self._cavity == 0.0 and float(np.linalg.norm(entrained)) <= source

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> SphericalEvaluation:
        """Film at a motion (11,): place, 0, velocity, 0, angular velocity of the ball against the socket.

        ``history`` and ``step`` as for `exudyn_ehd.joint.model.rigid.BearingModel.evaluate`.
        """
        motion = np.array(motion, dtype=float)
        self.serial += 1
        gap = self.bearing.smallest_gap(motion[PLACE]) if np.isfinite(motion.sum()) else math.nan
        status, film = self._film(motion, gap, History() if history is None else history, step)
        wrench = np.full(6, np.nan) if film is None else film.wrench
        return SphericalEvaluation(status, motion, wrench, gap, film, self, self.serial, history, step)

    def _film(self, motion: np.ndarray, gap: float, past: History, step: float) -> tuple[Status, BallFilm | None]:
        """Film of a motion with the smallest gap, m; None with a status that says why there is none."""
        if math.isnan(gap):
            return Status.NOT_FINITE, None
        if not gap > 0.0 and self.limiter is None:
            return Status.NO_FILM, None
        speeds, s = self._set_gap(motion), self.solver
        s.system.pressure[self.grid.fixed] = s.system.linear_pressure[self.grid.fixed] = 0.0
        status, _ = s.advance(*speeds, self._cavity / self.pressure_scale, past.void, past.outflow, step)
        if status is not Status.CONVERGED or not np.isfinite(s.pressure.sum()):
            return (Status.NOT_CONVERGED if status is Status.CONVERGED else status), None
        oil = self._oil()
        return (Status.NO_PRESSURE, None) if oil is None else (status, self._loads(motion, *oil))

    def _set_gap(self, motion: np.ndarray) -> tuple[float, float]:
        """Gap and storage of the film into the solver's buffers; wall pressures and the limiter's slopes.

        Returns the speeds of the solver, which are 0 where the film needs no Couette flows.
        """
        s, place = self.solver, motion[PLACE]
        s.H[:] = 1.0 + (place @ self._gap_slope).reshape(s.H.shape)
        s.HF[:] = 1.0 + (place @ self._link_slope).reshape(s.H.shape)
        entrained = motion[VELOCITY] if self.flow is not None else motion[VELOCITY] + 0.5 * skew(place) @ motion[SPIN]
        s.H_t[:] = (entrained @ self._storage).reshape(s.H.shape)
        wall, f = self.limiter, self._closed
        if wall is not None:
            self._limits = bool(min(s.H.min(), s.HF.min()) < wall.limits_below)
            wall.pressure(s.H, self._wall, self._wall_slope)
            f.rate[:] = s.H_t
            wall.limit(s.H, s.HF, np.ones_like(s.H), f.slope, f.bend, f.face_slope)
            s.H_t *= f.slope
        if self.flow is None:
            return 0.0, 0.0
        return self.flow.take(motion[SPIN], place, on_links(f.slope))

    def _share(self) -> np.ndarray:
        """Share (n m,) of a full film's Couette shear."""
        s = self.solver
        return shear_share(s.system, s.work.active, s.closure).ravel()

    def _oil(self) -> tuple[np.ndarray, np.ndarray | float, np.ndarray | float] | None:
        """Scaled pressure, viscosity ratio and its derivative to the unknown; None where no pressure is high enough."""
        q = self.solver.pressure
        if self.law is None:
            return q, 1.0, 0.0
        p, ratio, ratio_q = np.empty((3, *q.shape))
        known = self.law.inverse(q * self.pressure_scale, p, ratio, ratio_q)
        return (p / self.pressure_scale, ratio.ravel(), ratio_q.ravel() * self.pressure_scale) if known else None

    def _loads(
        self, motion: np.ndarray, P: np.ndarray, ratio: np.ndarray | float, ratio_q: np.ndarray | float
    ) -> BallFilm:
        s, R2, cross = self.solver, self.bearing.ball_radius**2, skew(motion[PLACE])
        velocity = motion[VELOCITY]
        normal = self._vector @ P.ravel()
        pulled = normal if not self._limits else self._vector @ (P * self._closed.slope).ravel()
        contact = -R2 * (self._vector @ self._wall.ravel())
        drag = (self._drag @ (self._moments @ (self._share() * ratio / s.H.ravel()))).reshape(6, 6)
        loads = drag @ np.concatenate([velocity, motion[SPIN]])
        force = loads[:3] - self.force_scale * normal + contact
        torque = loads[3:] + 0.5 * self.force_scale * cross @ pulled
        return BallFilm(
            pressure=P * self.pressure_scale,
            gap=s.H * self.bearing.radial_clearance,
            unbroken=s.work.active | self.grid.fixed,
            fill=s.fill.copy() if self.remembers_mass else s.ones,
            wrench=np.concatenate([force, torque + cross @ force]),
            torque=torque,
            contact=contact,
            drag=drag,
            stored_power=float((self.force_scale * (normal - pulled) - contact) @ velocity),
            ratio=ratio,
            ratio_q=ratio_q,
        )

    def tangent(self, motion: np.ndarray, film: BallFilm) -> np.ndarray:
        """d wrench / d motion (6, 11) for the film that the solver holds."""
        s, w, f = self.solver, self.solver.work, self._closed
        cross, R2, force, speeds = skew(motion[PLACE]), self.bearing.ball_radius**2, self.force_scale, _SPEEDS @ motion
        # derivatives of normal and pulled (3 rows each), of Couette's loads by the viscosity (6), by adjoint solves
        rows = self._vector if not self._limits else np.concatenate([self._vector, self._vector * f.slope.ravel()])
        n, P, share = len(rows), film.pressure / self.pressure_scale, self._share()
        rows = rows * w.active.ravel()
        if follows := self.law is not None or self.flow is not None:
            sheared = np.tensordot(self._drag.reshape(6, 6, 10), speeds, (1, 0)) @ self._moments
            rows = np.concatenate([rows * film.ratio, self._shear_rows(sheared, film, share)])
        at, k = w.order[: w.count], len(rows)
        lam, y = np.ascontiguousarray(rows[:, at]), s.system
        if y.continued is not None:
            rows_of_linear(y.continued, y.fixed, y.linked, y.cavity_pressure, w.active, w.number, lam)
        s.solve_transposed(lam)
        cell, face, rate, _ = s.gradients().fields(lam, self.grid.shape)
        by_gap = cell if not self._limits else cell * f.slope + rate * f.bend * f.rate
        by_place = by_gap.reshape(k, -1) @ self._gap_slope.T
        by_place += (face * f.face_slope).reshape(k, -1) @ self._link_slope.T
        by_entrained = (rate * f.slope).reshape(k, -1) @ self._storage.T
        entrained = _SPEEDS[:3] + 0.5 * (cross @ _SPEEDS[3:] - skew(motion[SPIN]) @ _PLACE)
        pressed = by_place @ _PLACE + by_entrained @ (entrained if self.flow is None else _SPEEDS[:3])
        if self.flow is not None:
            pressed += self._by_flow(self.flow, lam)
        pulled = pressed[n - 3 : n] + (P * f.bend).ravel() * self._vector @ self._gap_slope.T @ _PLACE
        thinner = -share * film.ratio * f.slope.ravel() / s.H.ravel() ** 2
        drag = self._drag @ (self._moments @ (thinner * self._gap_slope).T)
        out = film.drag @ _SPEEDS + np.tensordot(drag.reshape(6, 6, 3), speeds, (1, 0)) @ _PLACE
        if follows:
            out += pressed[n:]
        out[:3] -= force * pressed[:3] + R2 * (self._vector * self._wall_slope.ravel()) @ self._gap_slope.T @ _PLACE
        out[3:] += 0.5 * force * (cross @ pulled - skew(self._vector @ (P * f.slope).ravel()) @ _PLACE)
        # from the ball's centre to O
        out[3:] += cross @ out[:3] - skew(film.wrench[:3]) @ _PLACE
        return np.asarray(out)

    def _shear_rows(self, sheared: np.ndarray, film: BallFilm, share: np.ndarray) -> np.ndarray:
        """Weights (k, n m) of the unknowns in sums of the Couette shear over H with the weights ``sheared``."""
        s, active = self.solver, self.solver.work.active
        if not self.remembers_mass:
            return np.asarray(sheared * (film.ratio_q * share / s.H.ravel()) * active.ravel())
        y, fixed, out = s.system, self.grid.fixed, np.empty((len(sheared), *s.H.shape))
        ratio, ratio_q = ((x * s.ones.ravel()).reshape(s.H.shape) for x in (film.ratio, film.ratio_q))
        oil = s.H, ratio, ratio_q, s.fill, s.nothing, active | fixed, fixed, s.pressure, y.cavity_pressure
        for weights, row in zip(sheared.reshape(out.shape), out, strict=True):
            shear_by_unknown(weights, *oil, row)
        return out.reshape(len(out), -1)

    def _by_flow(self, flow: SphereFlow, lam: np.ndarray) -> np.ndarray:
        """Gradients (k, 11) of functionals with adjoints ``lam`` (k, count) through flows, links' gaps held."""
        s, fields = self.solver, np.zeros((len(lam), self.grid.weight.size))
        fields[:, s.work.order[: s.work.count]] = -lam
        by_spin, by_place, by_slope = flow.gradients(fields, s.taken_along(), (s.HF, on_links(s.H)[1]))
        by_place += (by_slope * self._closed.bend).reshape(len(lam), -1) @ self._gap_slope.T
        return np.asarray(by_spin @ _SPEEDS[3:] + by_place @ _PLACE)
