"""One ball in its socket as a pure function of their relative motion: gap, loads, heat, evaluations and tangent.

Frame: the socket's, origin O in its centre, z its axis; n is the direction from O to a point of the socket. With the
ball's centre at e, its velocity v and its angular velocity w, both as seen from the socket, the gap is

    h = c - e n,        dh/dt = -v n,

and the mean velocity of the surfaces is w x R n / 2, which has no divergence on the sphere. Reynolds' equation then is

    div(h^3 / (12 mu) grad p) = w x R n / 2 grad h + dh/dt = -n u,        u = v + e x w / 2 :

in a frame that turns with half the relative angular velocity the only source is squeeze. If the film conserves mass or
has a density law, fill or density vary with the position. The links then have Couette flows, and u = v. In a full film
of constant density both formulations agree to round-off (`exudyn_ehd.joint.spherical.bearing.SphereFlow`). The edges
have p = 0. Only relative motions count: a motion of ball and socket together has no effect. As in every Reynolds film,
terms of the relative size c / R are omitted: the ball's translation along the film in the flow, and the shear forces of
the pressure.

With u = 0 (a ball at rest, or one that spins about the line from O to its centre) the film has no pressure. The
pressure is homogeneous of degree one in u. So a film that ruptures at the edges' pressure has one-sided derivatives
only: it carries where u closes the gap.

Loads on the ball, N and A the integrals of n and of 1 over the control volumes, f = 12 mu R^4 / c^2, P = p c^2 / (12 mu
R^2), H = h / c:

    pressure    F_p = -f sum P N, through the ball's centre
    Couette     F_c = -mu R^2 / c (K v + R w x a),  T_c = -mu R^2 / c (R a x v + R^2 K w),
                a = sum n / H dA,  K = sum (1 - n n) / H dA : a symmetric, dissipative pair
    Poiseuille  T_p = (f / 2) e x sum P N, from the shear -(h / 2) grad p, integrated by parts. The same torque acts on
                the socket about its own centre. Each torque is half of e x F_p, so that all moments cancel.

The wrench is F = F_p + F_c and the moment about O, T_c + T_p + e x F; minus this wrench about O acts on the socket.
With the same N in loads and sources, work and heat agree: -(F v + T w) = sum H^3 (dP)^2 + Couette's heat >= 0.

If a wall limits the film's gap to H(g), with the true gap g, sources and T_p contain the factor dH/dg (closed gaps in
`exudyn_ehd.film.surfaces.roughness`). The share 1 - dH/dg of the pressure acts from solid to solid, without torque.

With a pressure law the solver's unknown is q, dq = dp mu_0 / mu(p) (`exudyn_ehd.film.lubricant.pressure_viscosity`).
Loads are computed from p(q) and the viscosity of every vertex; heat is sum H^3 dq dP. With a density law q is that of
`exudyn_ehd.film.lubricant.density`, and the flow work replaces P in the heat.

The pressure comes from the film solver of cylindrical bearings on the grid of `exudyn_ehd.joint.spherical.bearing`. Its
input is the storage -N u / c of each control volume. The scheme is of second order in both directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple, cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.energy import film_flows, film_heat
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.film import shear_share
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.joint.balance.limits import no_film
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.heat.temperature import LumpedTemperature
from exudyn_ehd.joint.model.effects import Effects
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import BESIDE, GapState, History, JournalMotion, LimiterFields, Loads, SolvedFilm
from exudyn_ehd.joint.spherical.bearing import SphereFlow, SphericalBearing, drag_of_moments, skew, sphere_patch
from exudyn_ehd.joint.tangent.wrench import ratio_of, shear_needs_adjoint, shear_weights
from exudyn_ehd.joint.thrust import quotients
from exudyn_ehd.status import ROUNDING, FilmError, Status

PLACE, VELOCITY, SPIN = slice(0, 3), slice(4, 7), slice(8, 11)
SIZE = SPIN.stop
"""Motion: place (m), 0, velocity (m/s), 0, angular velocity (rad/s). The zeros are there because
`exudyn_ehd.joint.time_step` expects four places and four rates."""
# Matrices that select the place (3,), and velocity and angular velocity (6,), of a motion.
PLACES, SPEEDS = np.eye(SIZE)[PLACE], np.eye(SIZE)[np.r_[VELOCITY, SPIN]]


class BallLoads(NamedTuple):
    """Loads of a film on the ball.

    wrench : (6,) array, moment about O
    torque : (3,) array, about the ball's centre, N m
    contact : (3,) array, force of the wall in ``wrench``, N
    drag : (6, 6) array, force and torque of the Couette shear per velocity and angular velocity
    stored_power : W, stored by the wall
    """

    wrench: np.ndarray
    torque: np.ndarray
    contact: np.ndarray
    drag: np.ndarray
    stored_power: float


def loads_of(film: SolvedFilm) -> BallLoads:
    """Loads of the film of a ball."""
    return cast(BallLoads, film.loads)


@dataclass(eq=False)
class SphericalEvaluation(Evaluation):
    """One film evaluation of a ball; ``motion`` (11,), wrench on the ball."""

    model: SphericalModel = field(repr=False)

    @property
    def place(self) -> str:
        """Place of the ball, for messages."""
        return f"place {self.motion[PLACE]} m"

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 11), exact for the current active set; for a ball at rest the mean of `sides`."""
        if (film := self._current()) is None:
            return np.full((6, SIZE), np.nan)
        sides = self.sides()
        return self.model.tangent(film) if sides is None else np.asarray(sides.mean(axis=0))

    def sides(self) -> np.ndarray | None:
        """One-sided derivatives (2, 6, 11) of the film of a ball at rest; None if the film has two-sided ones."""
        if (film := self._current()) is None or not self.model.is_at_rest(self.motion):
            return None
        spin = float(np.linalg.norm(self.motion[SPIN])) or 1.0
        length = BESIDE * self.model.bearing.radial_clearance
        steps = np.repeat([length, 0.0, spin * length, 0.0, BESIDE * spin], [3, 1, 3, 1, 3])
        # with another model, so that the buffers of this one are not overwritten
        beside = SphericalModel(self.model.bearing)
        return quotients(lambda at: beside.evaluate(at, film.history, film.step).wrench, self.motion, steps)

    def quantities(self) -> dict[str, float]:
        """Scalars of this state: m, Pa, N m, W, N."""
        if (film := self.film) is None:
            return {"minimum_gap": self.minimum_gap}
        loads, past = loads_of(film), film.history
        power = -float(loads.wrench[:3] @ self.motion[VELOCITY] + loads.torque @ self.motion[SPIN])
        warm = {} if film.temperature is None else {"film_temperature": float(film.temperature)}
        warm |= {} if past is None or past.sump is None else {"sump_temperature": past.sump}
        return warm | {
            "minimum_gap": self.minimum_gap,
            "peak_pressure": float(film.pressure.max()),
            "friction_torque": float(np.linalg.norm(loads.torque)),
            "power_loss": power - loads.stored_power,
            "contact_load": float(np.linalg.norm(loads.contact)),
            "stored_power": loads.stored_power,
        }


class SphericalModel(BearingModel):
    """Film between a rigid ball and a rigid socket, by motions (11,): place, 0, velocity, 0, angular velocity.

    Parameters
    ----------
    bearing : SphericalBearing
    """

    bearing: SphericalBearing  # type: ignore[assignment]
    motion_size = SIZE

    def __init__(self, bearing: SphericalBearing) -> None:
        R, c = bearing.ball_radius, bearing.radial_clearance
        self.patch = p = sphere_patch(R, bearing.socket_angles, bearing.n_phi, bearing.n_chi)
        law, thermal = transform_of(bearing.lubricant), None
        wall = None if bearing.contact is None else WallContact(bearing.contact, c)
        density = law if isinstance(law, CompressibleLaw) else None
        carries = bearing.cavitation.conserves_mass or density is not None
        # Couette flows of a full film; the solver needs them if fill or density vary with the position
        self.couette = SphereFlow(p, c) if carries or bearing.thermal is not None else None
        self.flow = self.couette if carries else None
        if carries:
            p.grid.area[:] = p.area  # the content of control volumes is that on the sphere
        if bearing.thermal is not None:
            volume = c * R**2 * float(p.area.sum())
            thermal = LumpedTemperature(bearing.thermal, bearing.lubricant, volume, self.heat_and_exchange)
        effects = Effects(
            limiter=wall,
            contacts=() if wall is None else (wall,),
            flux=() if self.flow is None else (self.flow,),
            pressure_law=law,
            thermal=thermal,
            density=density,
        )
        super().__init__(cast(JournalBearing, bearing), effects=effects, grid=p.grid)
        # over control volumes: normals, and storage of a velocity (m/s) per area of the grid
        self._vector = p.vector.reshape(3, -1)
        self._moments = np.vstack([part.reshape(-1, p.area.size) for part in (p.area, p.vector, p.tensor)])
        self._storage = -(p.vector / (c * p.grid.area)).reshape(3, -1)
        self._gap_slope, self._link_slope = (-n.reshape(3, -1) / c for n in (p.normals, p.link_normals))
        self._of_moments = -drag_of_moments(R)

    def heat_and_exchange(self, film: SolvedFilm, carry_over: float) -> tuple[float, float]:
        """Heat of shear and pressure flow, W, and the scaled flow that leaves and is replaced by oil from outside.

        The flow out of a socket over its edges is the balance of the control volumes there, with Couette flows. With a
        closure that does not conserve mass, oil lost in cavities leaves too, less the share ``carry_over`` of the oil
        found there, as in `exudyn_ehd.joint.heat.power.OilFlows`.
        """
        s, y, flow, motion = self.solver, self.solver.system, self.couette, film.journal.motion
        assert flow is not None
        k, P, speeds = np.array((y.kx, y.kz)), film.oil.P, SPEEDS @ motion
        energy = P if s.law is None else s.flow_work(P)
        pressed = film.scales.force * self.bearing.radial_clearance * film_heat(energy, y.flow_pressure, k).sum()
        heat = float(pressed - speeds @ loads_of(film).drag @ speeds)
        if self.remembers_mass:
            return heat, -float(np.minimum(s.inflow(), 0.0).sum())
        if self.flow is None:
            slope = self._slope(film.limited)
            flow.take(motion[SPIN], motion[PLACE], on_links(slope))
            (x, z), rate = flow.flows(s.HF, on_links(s.H)[1]), motion[VELOCITY] @ self._storage
            z[:, -1], rate = 0.0, slope * rate.reshape(s.H.shape)
        else:
            x, z, rate = s.couette_flows()
        balance = film_flows(y.flow_pressure, s.ones, k, np.stack([x, z]))[1] + s.area * rate
        out, lost = (-float(np.minimum(balance, 0.0).sum(where=at)) for at in (self.grid.fixed, ~self.grid.fixed))
        found = float(np.maximum(balance, 0.0).sum(where=~self.grid.fixed))
        return heat, out + lost - carry_over * min(lost, found)

    def _slope(self, limited: LimiterFields | None) -> np.ndarray:
        """Derivative (n, m) of the film's gap to that of the surfaces."""
        return self.solver.ones if limited is None else limited.slope

    def _journal(self, motion: np.ndarray, spin: float) -> JournalMotion:
        """Set a motion (11,), with scaled place and velocity (3,); without Couette flows the spins are 0."""
        motion = np.array(motion, dtype=float)
        scaled, turn = motion / self.bearing.radial_clearance, motion[SPIN] * (self.flow is not None)
        # a spin about the socket's axis moves oil along the rows only
        across = self.grid.reference_length * math.hypot(turn[0], turn[1])
        return JournalMotion(motion, scaled[PLACE], scaled[VELOCITY], float(np.linalg.norm(turn)), across)

    def _set_gap(self, journal: JournalMotion, history: History | None) -> GapState:
        """Write gap and storage into the solver's buffers, and set Couette flows."""
        found = super()._set_gap(journal, history)
        if self.flow is not None:
            self.flow.take(journal.motion[SPIN], journal.motion[PLACE], on_links(self._slope(found.limited)))
        return found

    def _set_surfaces(self, journal: JournalMotion, history: History | None) -> tuple[float, None]:
        s, place, entrained = self.solver, journal.motion[PLACE], journal.motion[VELOCITY]
        s.H[:] = 1.0 + (place @ self._gap_slope).reshape(s.H.shape)
        s.HF[:] = 1.0 + (place @ self._link_slope).reshape(s.H.shape)
        if self.flow is None:
            entrained = entrained + 0.5 * skew(place) @ journal.motion[SPIN]
        s.H_t[:] = (entrained @ self._storage).reshape(s.H.shape)
        return self.bearing.smallest_gap(place) / self.bearing.radial_clearance, None

    def _solve(self, journal: JournalMotion, history: History | None, step: float) -> tuple[Status, int]:
        status, count = super()._solve(journal, history, step)
        finite = status is not Status.CONVERGED or np.isfinite(self.solver.pressure.sum())
        return status if finite else Status.NOT_CONVERGED, count

    def _loads(
        self, journal: JournalMotion, oil: OilFields, gap: GapState, temperature: float | np.ndarray | None
    ) -> Loads:
        s, scales, motion, cross = self.solver, self.scales, journal.motion, skew(journal.motion[PLACE])
        normal, pulled = (self._vector @ P.ravel() for P in (oil.P, oil.P * self._slope(gap.limited)))
        contact = np.zeros(3)
        if gap.pressing is not None:
            contact -= self.bearing.ball_radius**2 * (self._vector @ gap.pressing.P[0].ravel())
        sheared = shear_share(s.system, s.work.active, s.closure) * (s.ones if oil.ratio is None else oil.ratio) / s.H
        drag = (scales.shear * self._of_moments @ (self._moments @ sheared.ravel())).reshape(6, 6)
        loads = drag @ SPEEDS @ motion
        force = loads[:3] - scales.force * normal + contact
        torque = loads[3:] + 0.5 * scales.force * cross @ pulled
        stored = float((scales.force * (normal - pulled) - contact) @ motion[VELOCITY])
        return cast(Loads, BallLoads(np.append(force, torque + cross @ force), torque, contact, drag, stored))

    def _result(
        self, status: Status, journal: JournalMotion, iterations: int, gap: float, film: SolvedFilm | None = None
    ) -> SphericalEvaluation:
        return SphericalEvaluation(**vars(super()._result(status, journal, iterations, gap, film)))

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> SphericalEvaluation:
        """Evaluate the film with the oil content of the steady film at rest, at the temperature of ``history``."""
        if self.remembers_mass and np.any(motion[VELOCITY]) and (history is None or history.void is None):
            at_rest = motion.copy()
            at_rest[VELOCITY] = 0.0
            if (found := self.evaluate(at_rest, history)).film is not None:
                content, T = found.history(), None if history is None else history.temperature
                history = None if content is None else replace(content, temperature=T)
        found = self.evaluate(motion, history, step, spin)
        assert isinstance(found, SphericalEvaluation)
        return found

    def is_at_rest(self, motion: np.ndarray) -> bool:
        """Return whether a film at this motion has no source, and would rupture under any small source."""
        source = ROUNDING * self.bearing.radial_clearance * float(np.linalg.norm(motion[SPIN]))
        entrained = motion[VELOCITY] + 0.5 * skew(motion[PLACE]) @ motion[SPIN]
        return self.scales.cavity == 0.0 and float(np.linalg.norm(entrained)) <= source

    def tangent(self, film: SolvedFilm) -> np.ndarray:
        """d wrench / d motion (6, 11) for the film in the solver's buffers."""
        s, f, motion, force, loads = self.solver, film.limited, film.journal.motion, film.scales.force, loads_of(film)
        cross, speeds, P, drag = skew(motion[PLACE]), SPEEDS @ motion, film.oil.P, film.scales.shear * self._of_moments
        slope, face_slope = (s.ones, s.ones) if f is None else (f.slope, f.face_slope)
        bend = self._bend(film)
        # adjoint solves for normal and pulled (3 rows each), and for Couette's loads by viscosity and fill (6 rows)
        rows = self._vector if f is None else np.concatenate([self._vector, self._vector * slope.ravel()])
        n, rows = len(rows), (rows * s.work.active.ravel()).reshape(-1, *slope.shape)
        if film.oil.P_q is not None:
            rows = rows * film.oil.P_q
        if follows := shear_needs_adjoint(film):
            sheared = np.tensordot(drag.reshape(6, 6, -1), speeds, (1, 0)) @ self._moments
            by_oil = [shear_weights(film, weights) for weights in sheared.reshape(6, *slope.shape)]
            rows = np.concatenate([rows, by_oil])
        lam = s.adjoint(rows)
        k = len(lam)
        cell, face, rate, _ = s.gradients().fields(lam, slope.shape)
        by_gap = cell if f is None else cell * slope + rate * f.bend
        by_place = by_gap.reshape(k, -1) @ self._gap_slope.T
        by_place += (face * face_slope).reshape(k, -1) @ self._link_slope.T
        by_entrained = (rate * slope).reshape(k, -1) @ self._storage.T
        entrained = SPEEDS[:3] + 0.5 * (cross @ SPEEDS[3:] - skew(motion[SPIN]) @ PLACES)
        pressed = by_place @ PLACES + by_entrained @ (entrained if self.flow is None else SPEEDS[:3])
        if self.flow is not None:
            pressed += self._by_flow(self.flow, lam, bend)
        pulled = pressed[n - 3 : n] + (P * bend).ravel() * self._vector @ self._gap_slope.T @ PLACES
        thinner = -film.share() * ratio_of(film) * slope / s.H**2
        thinned = drag @ (self._moments @ (thinner.ravel() * self._gap_slope).T)
        out = loads.drag @ SPEEDS + np.tensordot(thinned.reshape(6, 6, 3), speeds, (1, 0)) @ PLACES
        if follows:
            out += pressed[n:]
        out[:3] -= force * pressed[:3]
        if film.pressing is not None:
            stiffness = (self._vector * film.pressing.slope[0].ravel()) @ self._gap_slope.T @ PLACES
            out[:3] -= self.bearing.ball_radius**2 * stiffness
        out[3:] += 0.5 * force * (cross @ pulled - skew(self._vector @ (P * slope).ravel()) @ PLACES)
        # from the ball's centre to O
        out[3:] += cross @ out[:3] - skew(loads.wrench[:3]) @ PLACES
        return np.asarray(out)

    def _bend(self, film: SolvedFilm) -> np.ndarray:
        """Second derivative (n, m) of the film's gap to that of the surfaces."""
        out, f, limiter = np.zeros(self.grid.shape), film.limited, self.effects.limiter
        if f is not None and limiter is not None:
            limiter.film_gap(f.gap.copy(), f.slope, out)
        return out

    def _by_flow(self, flow: SphereFlow, lam: np.ndarray, bend: np.ndarray) -> np.ndarray:
        """Gradients (k, 11), through the Couette flows at constant gaps, of functionals with adjoints (k, count)."""
        s, fields = self.solver, np.zeros((len(lam), self.grid.weight.size))
        fields[:, s.work.order[: s.work.count]] = -lam
        by_spin, by_place, by_slope = flow.gradients(fields, s.taken_along(), (s.HF, on_links(s.H)[1]))
        by_place += (by_slope * bend).reshape(len(lam), -1) @ self._gap_slope.T
        return np.asarray(by_spin @ SPEEDS[3:] + by_place @ PLACES)


def steady_film(model: SphericalModel, motion: np.ndarray, where: str) -> SphericalEvaluation:
    """Film at a motion (11,): temperature in balance with the film, oil content of the film at rest.

    Raises
    ------
    FilmError
        In the name of ``where``, if there is no film or no sink for the heat.
    """
    found = model.evaluate_steady(motion, settled_history(model, motion, where=where))
    if found.film is None:
        raise FilmError(no_film(found, where))
    return found
