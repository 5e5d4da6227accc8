"""Search for the position in which a film carries a load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.film import ACCELERATED, DEPTH, LARGEST_CHANGE, evaluate_at, foreseen, is_settled
from exudyn_ehd.joint.balance.limits import HOTTEST, is_above, too_hot
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import FilmError, Status

if TYPE_CHECKING:
    from exudyn_ehd.joint.balance.faces import FacesShare, FacesUnderLoad

LARGEST_LOAD_STEPS = 100
LARGEST_DAMPED_STEPS = 300
# Steps that may pass without the unbalance falling to this share of what it was, of Newton's method and of a damped
# one, which is slower where a film starves. More steps, and shares nearer to 1, give up later.
PATIENCE, FALLS, FALLS_DAMPED = 25, 0.1, 0.9
# Second start of damped steps, eccentricity ratio in the direction of the load: inside, where neither a gap is thin nor
# a cavity large. Larger ones are nearer to both.
INSIDE = 0.3
# Film solves of one search; a position on a flexible bore takes some ten, one with a temperature field some thirty.
LARGEST_EFFORT = 6000
STEP_HALVINGS = 8
# Rounds of a search for position and temperature together, from anywhere and from a film nearby, where those that find
# one take some ten; and the change, K, that weighs as much as a clearance.
HEATED_ROUNDS, NEARBY_ROUNDS = 60, 20
TYPICAL_CHANGE = 30.0
LOAD_TOLERANCE = 1e-10
# Continuation from small loads: first and smallest step, shares of the load.
FIRST_SHARE, SMALLEST_SHARE = 0.25, 0.01
# Rounding of the film's force in units of L D mu omega / psi^2, which a tiny load can't fall below.
FORCE_ROUNDING = 1e-16


@dataclass(eq=False)
class Carried:
    """A position of a search.

    Attributes
    ----------
    motion : (10,) array
    evaluation, film : Evaluation, SolvedFilm
        Evaluation and solution of the steady film there.
    unbalance : (2,) array
        Force of the film and load, N.
    tangent : (6, 10) array
        d wrench / d motion at the temperature of this film.
    faces : FacesShare or None
        Contribution of the thrust faces, which ``unbalance`` contains.
    """

    motion: np.ndarray
    evaluation: Evaluation
    film: SolvedFilm
    unbalance: np.ndarray
    tangent: np.ndarray
    faces: FacesShare | None = None

    @property
    def slope(self) -> np.ndarray:
        """Derivative (2, 2) of the unbalance to the position."""
        own = self.tangent[:2, :2]
        return own if self.faces is None else own + self.faces.slope


class LoadSearch:
    """Search for the position in which the steady film of a model carries a load.

    Newton's method, and where it fails damped steps, first from the same place, then from inside the bearing. Where a
    temperature follows the position, both are sought together first, `heated`. Where that
    fails and no film is known yet, the load grows from a quarter of it, `climb`; where this does too, the temperature
    settles in every position. The tangent at a held temperature misses what the temperature
    adds; Broyden's update of that part, D, from the forces of successive positions replaces it::

        (dF/dx + D) step = -(F + load),    D += (dF - (mean of dF/dx + D) step) step^T / step^2.

    Parameters
    ----------
    model : BearingModel
    force : (2,) array
        Load on the journal, N.
    where : str
        Name of the caller, for error messages.
    effort : int
        Film solves after which it gives up.
    faces : FacesUnderLoad, optional
        Films on the end faces, which carry their part.
    size : float, optional
        Force that the residual is divided by, N; by default that of the load.
    """

    def __init__(
        self,
        model: BearingModel,
        force: np.ndarray,
        where: str,
        effort: int = LARGEST_EFFORT,
        faces: FacesUnderLoad | None = None,
        size: float | None = None,
    ) -> None:
        self.model, self.force, self.where, self.effort, self.faces = model, force, where, effort, faces
        self.size, self.carried = float(np.hypot(*force)) if size is None else size, 0.0
        self.count, self.first = 0, model.parts.evaluations.count
        self.strongest = (0.0, 0.0)
        self._history: History | None = None
        self._follows = np.zeros((2, 2))

    def find(self, motion: np.ndarray, near: Carried | None = None) -> Carried:
        """Position, from that of a motion (10,) on, in which the film carries the load.

        It starts at the temperature of the film ``near``, by default of the last that it has solved.

        Raises
        ------
        FilmError
            If none was found.
        """
        b = self.model.bearing
        tolerance = max(LOAD_TOLERANCE, FORCE_ROUNDING * b.reference_force(motion[8]) / self.size)
        self.first = self.model.parts.evaluations.count
        self._history = self._history if near is None else near.film.history
        self.carried, most = 0.0, LARGEST_LOAD_STEPS
        fresh, place = self._history is None, self.heated(motion, tolerance)
        if place is motion and fresh and self.model.effects.thermal is not None:
            place = self.climb(motion, tolerance)
            # a search from the last of the films that follow from smaller loads takes long and finds none
            most = 0 if 0.0 < self.carried < self.size else most
        found = self.newton(self._start(place), tolerance, most)
        for start in (motion, self.loaded(motion, INSIDE)) if self.carried == 0.0 else ():
            if self.residual(found) > tolerance:
                found = self.damped(start, tolerance)
        if found.film.serial != self.model.parts.evaluations.count:
            found = self.at(found.motion)
        if self.residual(found) > tolerance:
            raise FilmError(
                f"{self.where}: no position found that carries {self.size:.4g} N in {self.count} steps; the nearest "
                f"is off by {self.residual(found):.2g} of the load, at eccentricity ratio "
                f"{np.hypot(*found.motion[:2]) / b.radial_clearance:.4f}. {self._remedy()} A supply area in the loaded "
                "zone or a starved film may carry no such load at any position: look at ehd.steady(...) around "
                f"there.{too_hot(found.film.temperature, self.carried)}"
            )
        return found

    def loaded(self, motion: np.ndarray, ratio: float) -> np.ndarray:
        """A motion (10,) with the journal moved along the load, by a share of the gap that its tilt leaves."""
        b, motion = self.model.bearing, motion.copy()
        room = max(1.0 - 0.5 * b.length * float(np.hypot(*motion[2:4])) / b.radial_clearance, 0.0)
        motion[:2] = ratio * room * b.radial_clearance * self.force / self.size
        return motion

    def damped(self, motion: np.ndarray, tolerance: float) -> Carried:
        """Return the result of damped Newton steps from a motion (10,); see `newton`."""
        self._follows = np.zeros((2, 2))
        held_back = 10.0 * self.size / self.model.bearing.radial_clearance
        return self.newton(self._start(motion), tolerance, LARGEST_DAMPED_STEPS, held_back)

    def _remedy(self) -> str:
        """Return the remedy for a load that was not found, with the largest load carried during the search."""
        if self.strongest[0] > self.size:
            return (
                f"On the way a film has carried more, {self.strongest[0]:.4g} N at eccentricity ratio "
                f"{self.strongest[1]:.4f}."
            )
        return (
            "A load this high may need asperity=GreenwoodTripp(...) or contact=RegularisedWall(...), or a finer film "
            "grid."
        )

    def heated(self, motion: np.ndarray, tolerance: float, rounds: int = HEATED_ROUNDS) -> np.ndarray:
        """Motion (10,) in which a film with the temperature that it gives itself carries the load, which is kept.

        The motion that came in for an isothermal bearing, or where none was found.

        A round solves one film. It takes Newton's step at the film's temperature, with the forces multiplied by what
        the mean viscosity will change, and the temperature in balance with the film's heat; Anderson's acceleration of
        both.
        """
        thermal, c = self.model.effects.thermal, self.model.bearing.radial_clearance
        if thermal is None:
            return motion
        cold, place = thermal.initial_temperature(self.model.grid.shape), motion.copy()
        known = cold if self._history is None else self._history.temperature
        T = np.array(known, dtype=float)
        scale = np.append(np.full(2, c), np.full(T.size, TYPICAL_CHANGE * math.sqrt(T.size)))
        past: list[tuple[np.ndarray, np.ndarray]] = []
        for _ in range(rounds):
            self.count += 1
            history = History(temperature=T if T.ndim else float(T))
            reached = self._near(place, history)
            if reached.film is None or reached.status is not Status.CONVERGED:
                break
            change, tangent = thermal.steady_temperature(reached.film) - T, reached.steady_tangent()
            size = max(float(np.abs(change).max()), 1e-300)
            if is_settled(T, change, cold) and np.abs(reached.wrench[:2] + self.force).max() <= tolerance * self.size:
                if is_above(HOTTEST, T):
                    break
                self._history = history
                return place
            if not size < math.inf:
                break
            change = change * min(1.0, LARGEST_CHANGE / size)
            thinner = thermal.viscosity_ratio(T + change).mean() / thermal.viscosity_ratio(T).mean()
            try:
                step = np.linalg.solve(-thinner * tangent[:2, :2], thinner * reached.wrench[:2] + self.force)
            except np.linalg.LinAlgError:
                break
            step = np.append(step, change) / scale
            past = [*past, (np.append(place[:2], T) / scale, step)][-min(DEPTH, step.size) - 1 :]
            past = past if size < ACCELERATED else []
            if len(past) > 1:
                step = step - foreseen(past)
            step = step * scale
            place[:2] += limited_step(self.model, place, step[:2])
            T = T + step[2:].reshape(T.shape) * min(1.0, 4.0 * size / max(float(np.abs(step[2:]).max()), size))
        return motion

    def _near(self, motion: np.ndarray, history: History) -> Evaluation:
        """The steady film at a motion (10,), if a flexible bore comes to it straight."""
        if not isinstance(self.model, ElasticBearingModel):
            return self.model.evaluate_steady(motion, history)
        self.model.elasticity.straight = True
        try:
            return self.model.evaluate_steady(motion, history)
        finally:
            self.model.elasticity.straight = False

    def climb(self, motion: np.ndarray, tolerance: float) -> np.ndarray:
        """Motion (10,) of the largest load up to the whole one, ``carried``, to which films follow from smaller ones.

        Every load starts from where the last two lead, at the last temperature, which is kept. A load without a film
        halves the way to it, and is tried again from nearby; where heat lets a film carry no more, the smallest step
        fails.
        """
        whole, size, place, motion = self.force, self.size, motion, motion.copy()
        share, step, failed, self._history = 0.0, FIRST_SHARE, math.inf, None
        motion[:2] = first_guess(self.model.bearing, motion[8], FIRST_SHARE * whole, motion[2:4])
        rate = np.zeros(2)
        while share < 1.0 and not self._spent():
            target = min(1.0, share + step)
            self.force, self.size = target * whole, target * size
            start = motion.copy()
            start[:2] += (target - share) * rate
            found = self.heated(start, tolerance, NEARBY_ROUNDS)
            if found is start:
                if step <= SMALLEST_SHARE:
                    break
                failed, step = target, max(0.5 * step, SMALLEST_SHARE)
                continue
            rate = (found[:2] - motion[:2]) / (target - share) if share else rate
            place = motion = found
            failed = failed if target < failed else math.inf
            share, step, self.carried = target, max(min(1.5 * step, 0.5 * (failed - target)), SMALLEST_SHARE), self.size
        self.force, self.size = whole, size
        return place

    def _start(self, motion: np.ndarray) -> Carried:
        """The steady film at a motion (10,), or that at a smaller eccentricity if there is none."""
        for _ in range(STEP_HALVINGS):
            try:
                return self.at(motion)
            except FilmError:
                motion = np.concatenate([0.8 * motion[:2], motion[2:]])
        return self.at(motion)

    def _spent(self) -> bool:
        return self.model.parts.evaluations.count - self.first > self.effort

    def residual(self, place: Carried) -> float:
        """Largest component of film force + load, over the load."""
        return float(np.max(np.abs(place.unbalance))) / self.size

    def at(self, motion: np.ndarray) -> Carried:
        """The steady film at a motion (10,), which is kept."""
        self.count += 1
        evaluation, film = evaluate_at(self.model, motion, self.where, self._history)
        self._history = film.history
        unbalance, tangent, share = evaluation.wrench[:2] + self.force, evaluation.steady_tangent(), None
        ratio = float(np.hypot(*motion[:2])) / self.model.bearing.radial_clearance
        self.strongest = max(self.strongest, (float(np.hypot(*evaluation.wrench[:2])), ratio))
        if self.faces is not None:
            share = self.faces.share(motion, evaluation.wrench, tangent)
            unbalance += share.evaluation.wrench[:2]
        return Carried(motion.copy(), evaluation, film, unbalance, tangent, share)

    def _moved(self, place: Carried, step: np.ndarray) -> Carried:
        """The film a step (2,), shortened, on; in a flexible bore after the part of the step that leaves a film."""
        step = np.pad(limited_step(self.model, place.motion, step), (0, place.motion.size - 2))
        for _ in range(STEP_HALVINGS if self.model.flexible else 0):
            try:
                return self._learnt(place, self.at(place.motion + step))
            except FilmError:
                step = 0.5 * step
        return self._learnt(place, self.at(place.motion + step))

    def _learnt(self, place: Carried, reached: Carried) -> Carried:
        """Broyden's update of what the temperature adds to the tangent."""
        if self.model.effects.thermal is not None:
            step = reached.motion[:2] - place.motion[:2]
            expected = (0.5 * (place.tangent + reached.tangent)[:2, :2] + self._follows) @ step
            missed = reached.unbalance - place.unbalance - expected
            self._follows = self._follows + np.outer(missed, step) / float(step @ step + 1e-300)
        return reached

    def newton(
        self, place: Carried, tolerance: float, most: int = LARGEST_LOAD_STEPS, resistance: float = 0.0
    ) -> Carried:
        """Newton's method from a place on, until the unbalance is below ``tolerance`` of the load, or ``most`` steps.

        It also ends where it makes no progress, or reaches no film. With a resistance r, N/m, it is damped after
        Levenberg (1944) and Marquardt (1963): with K = -dF/dx and the unbalance U

            (K^T K + r^2 I) step = K^T U

        goes downhill in |U|^2 for r large enough, whatever K; r falls as |U| does, and a step that increases it is
        taken back and r grows. Slow and sure where Newton's method jumps over a film that starves or touches, and where
        a film without a cavity turns the journal across the load.
        """
        residuals: list[float] = []
        highest = 1e12 * resistance
        for _ in range(most):
            residuals.append(self.residual(place))
            falls = FALLS_DAMPED if resistance else FALLS
            stuck = len(residuals) > PATIENCE and residuals[-1] > falls * residuals[-1 - PATIENCE]
            if residuals[-1] <= tolerance or stuck or self._spent() or resistance > highest:
                break
            try:
                K, step = -place.slope - self._follows, place.unbalance
                if resistance:
                    K, step = K.T @ K + resistance**2 * np.eye(2), K.T @ step
                reached = self._moved(place, np.linalg.solve(K, step))
            except (np.linalg.LinAlgError, FilmError):  # a film that carries nothing, or no film whatever the step
                if not resistance:
                    break
                reached = place
            if resistance and not np.hypot(*reached.unbalance) < np.hypot(*place.unbalance):
                resistance *= 4.0
            else:
                place, resistance = reached, resistance / 5.0
        return place


def first_guess(bearing: JournalBearing, omega: float, force: np.ndarray, tilt: np.ndarray) -> np.ndarray:
    """Eccentricity (2,) in m from the mean of the short and the long bearing's load, both half Sommerfeld.

    The guess only saves steps. It stays inside the gap that the tilt leaves.
    """
    target = float(np.hypot(*force)) / bearing.reference_force(omega)
    ratio = (0.5 * bearing.length / bearing.journal_radius) ** 2
    room = 1.0 - 0.5 * bearing.length * float(np.hypot(*tilt)) / bearing.radial_clearance
    lower, upper = 0.0, 1.0
    for _ in range(40):
        eps = 0.5 * (lower + upper)
        s = 1.0 - eps * eps
        short = ratio * eps / (2.0 * s * s) * math.sqrt(math.pi**2 * s + 16.0 * eps * eps)
        long = 3.0 * eps * math.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0)) / ((2.0 + eps * eps) * s)
        lower, upper = (eps, upper) if short * long / (short + long + 1e-300) < target else (lower, eps)
    eps = lower * max(room, 0.02)
    angle = math.atan2(force[1], force[0]) + math.copysign(
        math.atan2(math.pi * math.sqrt(1.0 - eps * eps), 4.0 * eps), omega
    )
    return eps * bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])


def limited_step(model: BearingModel, motion: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Shorten a step (2,) so that it uses up at most 60 % of the smallest gap at either end.

    A wall or a flexible bush limits nothing.
    """
    if model.effects.contacts or model.flexible:
        longest = 0.3 * model.bearing.radial_clearance
        return step * min(1.0, longest / float(np.hypot(*step) + 1e-300))
    c, half = model.bearing.radial_clearance, 0.5 * model.bearing.length
    scale = 1.0
    for s in (-half, half):
        e = motion[:2] + s * motion[2:4]
        allowed = float(np.hypot(*e)) + 0.6 * (c - float(np.hypot(*e)))
        a, b, d = float(step @ step), float(e @ step), float(e @ e) - allowed**2
        if a > 0.0:
            scale = min(scale, (-b + math.sqrt(b * b - a * d)) / a)
    return scale * step
