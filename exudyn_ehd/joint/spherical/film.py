"""One ball in its socket as a pure function of their relative motion.

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
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.energy import film_flows, film_heat
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.film import shear_share
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.joint.heat.temperature import LumpedTemperature
from exudyn_ehd.joint.solved_film import History, LimiterFields
from exudyn_ehd.joint.spherical.bearing import SphereFlow, SphericalBearing, drag_of_moments, skew, sphere_patch
from exudyn_ehd.status import Status

PLACE, VELOCITY, SPIN = slice(0, 3), slice(4, 7), slice(8, 11)
SIZE = SPIN.stop
"""Motion: place (m), 0, velocity (m/s), 0, angular velocity (rad/s). The zeros are there because
`exudyn_ehd.joint.time_step` expects four places and four rates."""
# Matrices that select the place (3,), and velocity and angular velocity (6,), of a motion.
PLACES, SPEEDS = np.eye(SIZE)[PLACE], np.eye(SIZE)[np.r_[VELOCITY, SPIN]]


class BallFilm(NamedTuple):
    """A solved film; fields (n, m).

    Attributes
    ----------
    pressure : Pa; gap of the film : m; unbroken : bool; fill : oil over gap, 1 unless the film conserves mass
    wrench : (6,) array
        Wrench on the ball, moment about O.
    torque : (3,) array
        Torque on the ball about its centre, N m.
    contact : (3,) array
        Force of the wall in ``wrench``, N.
    drag : (6, 6) array
        Force and torque of the Couette shear per velocity and angular velocity.
    stored_power : W, stored by the wall
    pressure_q, ratio, ratio_q : (n, m) arrays
        Derivative of the pressure to the solver's unknown; viscosity over that at ambient pressure, and its derivative.
    motion : (11,) array
    temperature : K, None for an isothermal film
    history, step : History, float
        History at the start of the step, and the time since then, s.
    parts, grid : model and its grid, under the names that `SolvedFilm` has
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
    pressure_q: np.ndarray
    ratio: np.ndarray
    ratio_q: np.ndarray
    motion: np.ndarray
    temperature: float | None
    history: History
    step: float
    parts: SphericalFilm
    grid: FilmGrid
    walls: None = None
    beside: None = None


class SphericalFilm:
    """Film between a rigid ball and a rigid socket, with buffers that all evaluations use.

    Parameters
    ----------
    bearing : SphericalBearing
    """

    def __init__(self, bearing: SphericalBearing) -> None:
        self.bearing = b = bearing
        R, c = b.ball_radius, b.radial_clearance
        self.patch = p = sphere_patch(R, b.socket_angles, b.n_phi, b.n_chi)
        self.grid: FilmGrid = p.grid
        self.remembers_mass, self.flow_scale = b.cavitation.conserves_mass, c * R**2
        self.law, self._cavity, oil = transform_of(b.lubricant), b.cavitation.cavity_pressure, b.lubricant
        density = self.law if isinstance(self.law, CompressibleLaw) else None
        self.remembers = self.remembers_mass or b.thermal is not None
        # Couette flows of a full film; the solver needs them if fill or density vary with the position
        self.couette = SphereFlow(p, c) if self.remembers or density is not None else None
        self.flow = self.couette if self.remembers_mass or density is not None else None
        flows = () if self.flow is None else (self.flow,)
        if self.flow is not None:
            p.grid.area[:] = p.area  # the content of control volumes is that on the sphere
        self.solver = FilmSolver(p.grid, b.cavitation, flux_effects=flows, density=density)
        self.thermal, volume = None, self.flow_scale * float(p.area.sum())
        if b.thermal is not None:
            self.thermal = LumpedTemperature(b.thermal, oil, volume, self.heat_and_exchange)
        self.limiter = None if b.contact is None else WallContact(b.contact, c)
        if self.law is not None:
            self._cavity = float(self.law.transform(np.array(self._cavity)))
        # over control volumes: normals, and storage of a velocity (m/s) per area of the grid
        self._vector = p.vector.reshape(3, -1)
        self._moments = np.vstack([part.reshape(-1, p.area.size) for part in (p.area, p.vector, p.tensor)])
        self._storage = -(p.vector / (c * p.grid.area)).reshape(3, -1)
        self._gap_slope, self._link_slope = (-n.reshape(3, -1) / c for n in (p.normals, p.link_normals))
        self._of_moments = -drag_of_moments(R)
        self._set_viscosity(1.0)
        self._closed, (self._wall, self._wall_slope) = LimiterFields(p.grid.shape), np.zeros((2, *p.grid.shape))
        self._closed.slope[:] = self._closed.face_slope[:] = 1.0
        self._limits, self.serial = False, 0

    def _set_viscosity(self, ratio: float) -> None:
        """Scale the film to ``ratio`` times the lubricant's viscosity."""
        b, self.viscosity_ratio = self.bearing, ratio
        mu, R, c = ratio * b.lubricant.viscosity, b.ball_radius, b.radial_clearance
        self.pressure_scale = self.solver.pressure_scale = 12.0 * mu * R**2 / c**2
        self.force_scale, self._drag = self.pressure_scale * R**2, mu * R**2 / c * self._of_moments

    def heat_and_exchange(self, film: BallFilm, carry_over: float) -> tuple[float, float]:
        """Heat of shear and pressure flow, W, and the scaled flow that leaves and is replaced by oil from outside.

        The flow out of a socket over its edges is the balance of the control volumes there, with Couette flows. With a
        closure that does not conserve mass, oil lost in cavities leaves too, less the share ``carry_over`` of the oil
        found there, as in `exudyn_ehd.joint.heat.power.OilFlows`.
        """
        s, y, flow, speeds = self.solver, self.solver.system, self.couette, SPEEDS @ film.motion
        assert flow is not None
        k, P = np.array((y.kx, y.kz)), film.pressure / self.pressure_scale
        energy = P if s.law is None else s.flow_work(P)
        pressed = self.force_scale * self.bearing.radial_clearance * film_heat(energy, y.flow_pressure, k).sum()
        heat = float(pressed - speeds @ film.drag @ speeds)
        if self.remembers_mass:
            return heat, -float(np.minimum(s.inflow(), 0.0).sum())
        if self.flow is None:
            flow.take(film.motion[SPIN], film.motion[PLACE], on_links(self._closed.slope))
            (x, z), rate = flow.flows(s.HF, on_links(s.H)[1]), film.motion[VELOCITY] @ self._storage
            z[:, -1], rate = 0.0, self._closed.slope * rate.reshape(s.H.shape)
        else:
            x, z, rate = s.couette_flows()
        balance = film_flows(y.flow_pressure, s.ones, k, np.stack([x, z]))[1] + s.area * rate
        out, lost = (-float(np.minimum(balance, 0.0).sum(where=at)) for at in (self.grid.fixed, ~self.grid.fixed))
        found = float(np.maximum(balance, 0.0).sum(where=~self.grid.fixed))
        return heat, out + lost - carry_over * min(lost, found)

    def _film(
        self, motion: np.ndarray, gap: float, temperature: float | None, past: History, step: float
    ) -> tuple[Status, BallFilm | None]:
        """Return the status and the film of a motion with the smallest gap, m; None without a film."""
        if math.isnan(gap):
            return Status.NOT_FINITE, None
        if not gap > 0.0 and self.limiter is None:
            return Status.NO_FILM, None
        speeds, s = self._set_gap(motion), self.solver
        s.system.pressure[self.grid.fixed] = s.system.linear_pressure[self.grid.fixed] = 0.0
        status, _ = s.advance(*speeds, self._cavity / self.pressure_scale, past.void, past.outflow, step)
        if status is not Status.CONVERGED or not np.isfinite(s.pressure.sum()):
            return (Status.NOT_CONVERGED if status is Status.CONVERGED else status), None
        oil = s.oil_fields(self.law, None)
        if oil is None:
            return Status.NO_PRESSURE, None
        return Status.NO_PRESSURE if oil.beyond else status, self._loads(motion, oil, (temperature, past, step))

    def _set_gap(self, motion: np.ndarray) -> tuple[float, float]:
        """Write gap and storage into the solver's buffers, and set wall pressures and the limiter's slopes.

        Returns the speeds for the solver, 0 if the film needs no Couette flows.
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
        return (0.0, 0.0) if self.flow is None else self.flow.take(motion[SPIN], place, on_links(f.slope))

    def _share(self) -> np.ndarray:
        """Couette shear over that of a full film (n m,)."""
        s = self.solver
        return shear_share(s.system, s.work.active, s.closure).ravel()

    def _loads(self, motion: np.ndarray, oil: OilFields, state: tuple[float | None, History, float]) -> BallFilm:
        s, R2, velocity, cross = self.solver, self.bearing.ball_radius**2, motion[VELOCITY], skew(motion[PLACE])
        P, given = oil.P, ((oil.P_q, s.ones), (oil.ratio, s.ones), (oil.ratio_q, s.nothing))
        pressure_q, ratio, ratio_q = (usual if field is None else field for field, usual in given)
        normal = self._vector @ P.ravel()
        pulled = normal if not self._limits else self._vector @ (P * self._closed.slope).ravel()
        contact = -R2 * (self._vector @ self._wall.ravel())
        drag = (self._drag @ (self._moments @ (self._share() * (ratio / s.H).ravel()))).reshape(6, 6)
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
            pressure_q=pressure_q,
            ratio=ratio,
            ratio_q=ratio_q,
            motion=motion,
            temperature=state[0],
            history=state[1],
            step=state[2],
            parts=self,
            grid=self.grid,
        )
