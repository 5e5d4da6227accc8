"""One ball in its socket as a pure function of their relative motion: evaluations, steady film and tangent.

Equations and symbols: `exudyn_ehd.joint.spherical.film`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.joint.balance.limits import no_film
from exudyn_ehd.joint.balance.newton import settled_history
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import BESIDE, History, JournalMotion, SolvedFilm
from exudyn_ehd.joint.spherical.bearing import SphereFlow, skew
from exudyn_ehd.joint.spherical.film import PLACE, PLACES, SIZE, SPEEDS, SPIN, VELOCITY, SphericalFilm, loads_of
from exudyn_ehd.joint.tangent.wrench import ratio_of, shear_needs_adjoint, shear_weights
from exudyn_ehd.joint.thrust import quotients
from exudyn_ehd.status import ROUNDING, FilmError, Status


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


class SphericalModel(SphericalFilm):
    """Film between a rigid ball and a rigid socket, by motions (11,): place, 0, velocity, 0, angular velocity.

    Parameters
    ----------
    bearing : SphericalBearing
    """

    motion_size = SIZE

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
