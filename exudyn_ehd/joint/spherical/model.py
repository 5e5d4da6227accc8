"""One ball in its socket as a pure function of their relative motion: evaluations, memory and tangent.

Equations and symbols: `exudyn_ehd.joint.spherical.film`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
import scipy

from exudyn_ehd.film.cavitation.linear_film import rows_of_linear
from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.film.solvers.film import shear_by_unknown
from exudyn_ehd.joint.balance.limits import WAY_OUT, require_oil_bears
from exudyn_ehd.joint.solved_film import BESIDE, History, SolvedFilm
from exudyn_ehd.joint.spherical.bearing import SphereFlow, skew
from exudyn_ehd.joint.spherical.film import PLACE, PLACES, SIZE, SPEEDS, SPIN, VELOCITY, BallFilm, SphericalFilm
from exudyn_ehd.joint.thrust import quotients
from exudyn_ehd.status import ROUNDING, SMALL, FilmError, Status


@dataclass(eq=False)
class SphericalEvaluation:
    """One film evaluation, with the interface of `exudyn_ehd.coupling.contract.JointEvaluation`.

    Attributes
    ----------
    status : Status
    motion : (11,) array
    wrench : (6,) array
        Wrench on the ball, moment about O; nan without a film.
    minimum_gap : float
        Minimum gap of the rigid surfaces, exact, m.
    film : BallFilm or None
        None if ``status`` is not CONVERGED, except for films beyond the end of a pressure law (NO_PRESSURE), whose
        forces lead Newton's method back.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    minimum_gap: float
    film: BallFilm | None = field(repr=False)
    model: SphericalModel = field(repr=False)
    serial: int = field(repr=False)

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 11), exact for the current active set.

        It must be called before the model's next evaluation. For a ball at rest it is the mean of `sides`.
        """
        if self.film is None:
            return np.full((6, SIZE), np.nan)
        if (sides := self.sides()) is not None:
            return np.asarray(sides.mean(axis=0))
        return self.model.tangent(self.motion, self.film)

    def steady_tangent(self) -> np.ndarray:
        """Return `tangent`: rigid surfaces have no deflection that could follow the motion."""
        return self.tangent()

    def sides(self) -> np.ndarray | None:
        """One-sided derivatives (2, 6, 11) of the film of a ball at rest; None if the film has two-sided ones."""
        self._require_current()
        if (f := self.film) is None or not self.model.is_at_rest(self.motion):
            return None
        spin = float(np.linalg.norm(self.motion[SPIN])) or 1.0
        length = BESIDE * self.model.bearing.radial_clearance
        steps = np.repeat([length, 0.0, spin * length, 0.0, BESIDE * spin], [3, 1, 3, 1, 3])
        # with another model, so that the buffers of this one are not overwritten
        beside = SphericalModel(self.model.bearing)
        return quotients(lambda at: beside.evaluate(at, f.history, f.step).wrench, self.motion, steps)

    def quantities(self) -> dict[str, float]:
        """Scalars of this state: m, Pa, N m, W, N."""
        if (f := self.film) is None:
            return {"minimum_gap": self.minimum_gap}
        power = -float(f.wrench[:3] @ self.motion[VELOCITY] + f.torque @ self.motion[SPIN])
        warm = {} if f.temperature is None else {"film_temperature": f.temperature}
        warm |= {} if f.history.sump is None else {"sump_temperature": f.history.sump}
        return warm | {
            "minimum_gap": self.minimum_gap,
            "peak_pressure": float(f.pressure.max()),
            "friction_torque": float(np.linalg.norm(f.torque)),
            "power_loss": power - f.stored_power,
            "contact_load": float(np.linalg.norm(f.contact)),
            "stored_power": f.stored_power,
        }

    def history(self) -> History | None:
        """Return the film's history after this state; None for a film without memory."""
        if not self.model.remembers or self.film is None:
            return None
        self._require_current()
        return self.model.next_history(self.film)

    def _require_current(self) -> None:
        if self.serial != self.model.serial:
            raise RuntimeError("Evaluation: the model has evaluated another state since; evaluate this state again.")


class SphericalModel(SphericalFilm):
    """Film between a rigid ball and a rigid socket.

    Parameters
    ----------
    bearing : SphericalBearing
    """

    needs_spin = flexible = False
    motion_size = SIZE

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the computing time."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded socket at this motion; None for a film without memory."""
        if not self.remembers:
            return None
        self.serial += 1
        self._set_gap(motion)
        void, mass, outflow = self.solver.flooded() if self.remembers_mass else (None, None, None)
        temperatures = History() if self.thermal is None else self.thermal.first_memory()
        return replace(temperatures, void=void, mass=mass, outflow=outflow)

    def next_history(self, film: BallFilm) -> History:
        """History at the end of a film's step."""
        s, thermal = self.solver, self.thermal
        temperatures = History() if thermal is None else thermal.memory(cast(SolvedFilm, film))
        if not self.remembers_mass:
            return temperatures
        void, mass, outflow = s.memory(film.history.mass, film.step)
        return replace(temperatures, void=void, mass=mass, outflow=outflow)

    def is_at_rest(self, motion: np.ndarray) -> bool:
        """Return whether a film at this motion has no source, and would rupture under any small source."""
        source = ROUNDING * self.bearing.radial_clearance * float(np.linalg.norm(motion[SPIN]))
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
        past, T = History() if history is None else history, None
        if self.thermal is not None:
            T = float(self.thermal.extrapolated(past, step))
            if (thicker := self.thermal.set_viscosity(T)) != self.viscosity_ratio:
                self._set_viscosity(thicker)
        gap = self.bearing.smallest_gap(motion[PLACE]) if np.isfinite(motion.sum()) else math.nan
        status, film = self._film(motion, gap, T, past, step)
        wrench = np.full(6, np.nan) if film is None else film.wrench
        return SphericalEvaluation(status, motion, wrench, gap, film, self, self.serial)

    def tangent(self, motion: np.ndarray, film: BallFilm) -> np.ndarray:
        """d wrench / d motion (6, 11) for the film in the solver's buffers."""
        s, w, f = self.solver, self.solver.work, self._closed
        cross, R2, force, speeds = skew(motion[PLACE]), self.bearing.ball_radius**2, self.force_scale, SPEEDS @ motion
        # adjoint solves for normal and pulled (3 rows each), and for Couette's loads by viscosity and fill (6 rows)
        rows = self._vector if not self._limits else np.concatenate([self._vector, self._vector * f.slope.ravel()])
        n, P, share = len(rows), film.pressure / self.pressure_scale, self._share()
        rows = rows * w.active.ravel()
        if follows := self.law is not None or self.remembers_mass:
            sheared = np.tensordot(self._drag.reshape(6, 6, -1), speeds, (1, 0)) @ self._moments
            rows = np.concatenate([rows * film.pressure_q.ravel(), self._shear_rows(sheared, film, share)])
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
        entrained = SPEEDS[:3] + 0.5 * (cross @ SPEEDS[3:] - skew(motion[SPIN]) @ PLACES)
        pressed = by_place @ PLACES + by_entrained @ (entrained if self.flow is None else SPEEDS[:3])
        if self.flow is not None:
            pressed += self._by_flow(self.flow, lam)
        pulled = pressed[n - 3 : n] + (P * f.bend).ravel() * self._vector @ self._gap_slope.T @ PLACES
        thinner = -share * (film.ratio * f.slope / s.H**2).ravel()
        drag = self._drag @ (self._moments @ (thinner * self._gap_slope).T)
        out = film.drag @ SPEEDS + np.tensordot(drag.reshape(6, 6, 3), speeds, (1, 0)) @ PLACES
        if follows:
            out += pressed[n:]
        out[:3] -= force * pressed[:3] + R2 * (self._vector * self._wall_slope.ravel()) @ self._gap_slope.T @ PLACES
        out[3:] += 0.5 * force * (cross @ pulled - skew(self._vector @ (P * f.slope).ravel()) @ PLACES)
        # from the ball's centre to O
        out[3:] += cross @ out[:3] - skew(film.wrench[:3]) @ PLACES
        return np.asarray(out)

    def _shear_rows(self, sheared: np.ndarray, film: BallFilm, share: np.ndarray) -> np.ndarray:
        """Weights (k, n m) of the unknowns in sums of viscosity ratio / H with the weights ``sheared``."""
        s, active = self.solver, self.solver.work.active
        if not self.remembers_mass:
            return np.asarray(sheared * (share * (film.ratio_q / s.H * active).ravel()))
        y, fixed, out = s.system, self.grid.fixed, np.empty((len(sheared), *s.H.shape))
        oil = s.H, film.ratio, film.ratio_q, s.fill, s.nothing, active | fixed, fixed, s.pressure, y.cavity_pressure
        for weights, row in zip(sheared.reshape(out.shape), out, strict=True):
            shear_by_unknown(weights, *oil, row)
        return out.reshape(len(out), -1)

    def _by_flow(self, flow: SphereFlow, lam: np.ndarray) -> np.ndarray:
        """Gradients (k, 11), through the Couette flows at constant gaps, of functionals with adjoints (k, count)."""
        s, fields = self.solver, np.zeros((len(lam), self.grid.weight.size))
        fields[:, s.work.order[: s.work.count]] = -lam
        by_spin, by_place, by_slope = flow.gradients(fields, s.taken_along(), (s.HF, on_links(s.H)[1]))
        by_place += (by_slope * self._closed.bend).reshape(len(lam), -1) @ self._gap_slope.T
        return np.asarray(by_spin @ SPEEDS[3:] + by_place @ PLACES)


def steady_history(model: SphericalModel, motion: np.ndarray, where: str = "audit") -> History | None:
    """History for a film at a motion (11,): temperature in balance with the film, oil content of the film at rest.

    None for an isothermal film that does not conserve mass or has no velocity.

    Raises
    ------
    FilmError
        In the name of ``where``, if there is no sink for the heat, or if the temperature exceeds that of any oil.
    """
    thermal, at_rest = model.thermal, motion.copy()
    at_rest[VELOCITY] = 0.0
    moves = model.remembers_mass and bool(np.any(motion[VELOCITY]))
    if thermal is None and not moves:
        return None

    def memory(T: float | None) -> History:
        found = model.evaluate(at_rest, History(temperature=T)) if moves else None
        known = None if found is None or found.film is None else found.history()
        return History(temperature=T) if known is None else replace(known, temperature=T)

    def rise(T: float) -> float:
        found = model.evaluate(motion, memory(T))
        if found.status is not Status.CONVERGED or thermal is None:
            return math.inf
        return thermal.steady_temperature(cast(SolvedFilm, found.film)) - T

    if thermal is None:
        return memory(None)
    low = min(thermal.supply, thermal.housing)
    if model.evaluate(motion, memory(low)).status is not Status.CONVERGED:
        return memory(low)
    if not (change := rise(low)) < math.inf:
        raise FilmError(f"{where}: the film is heated, and its heat has no way out; {WAY_OUT}")
    high = low + max(change, SMALL)
    while rise(high) > 0.0:
        require_oil_bears(high, model.grid, where)
        low, high = high, 3.0 * high - 2.0 * low
    return memory(float(scipy.optimize.brentq(rise, low, high, xtol=SMALL)))
