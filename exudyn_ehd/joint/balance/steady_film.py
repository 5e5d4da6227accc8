"""Steady film in balance with its heat and, under a load, the position of the journal.

The unknowns are the free coordinates x of the journal and the temperature T. F is the force of the films, W the load,
and T* the temperature in balance with the heat of the film at x and T:

    F(x, T) + W = 0,    T*(x, T) - T = 0.

`DampedNewton` searches for x. A round solves one film, with a flexible bore in balance with it, and makes the step from
T to T* beside Newton's step in x. For Newton's step, the forces are multiplied by the ratio of the mean viscosities at
T* and at T. The derivative of T* is not known. So, near the solution, Anderson's acceleration of both steps together
accounts for it and for the coupling of x and T.

A search for a temperature field begins with a transport along theta of first order. The limiter of the second order
depends on the temperature itself and leads searches from a cold film astray. It is used as soon as the search is near.

Free coordinates are x and y, and the place z along the axis if films on the end faces carry an axial load.

`evaluate_at` finds the steady film at a prescribed motion of the journal, with its temperature and oil content.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.linalg import norm

from exudyn_ehd.joint.balance.limits import NO_OIL, WAY_OUT, no_film, require_bearable, require_oil_bears
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.newton import (
    HALVINGS,
    MOST_FILMS,
    ROUNDS,
    SETTLED,
    Acceleration,
    DampedNewton,
    SearchState,
    damped_step,
)
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History, SolvedFilm
from exudyn_ehd.joint.thrust import ThrustEvaluation, ThrustModel, seen_by_faces
from exudyn_ehd.joint.time_step import part_that_closes
from exudyn_ehd.status import SMALL, FilmError, Status

# Tolerance of the unbalance, as a share of the load; `ROUNDED` at the end of a slow search. A temperature's change, as
# a share of the film's rise over its coldest source, has the tolerance `SETTLED`; `SMALL` at the end of a slow search.
LOAD_TOLERANCE = 1e-10
# Damping factor of steps below which a search without progress gives up. Smaller: hopeless searches take longer.
WEAKEST = 0.02
# Changes of the temperature in K: the largest one in a round, of the same scaled size as a move by the clearance;
# their root mean square below which Anderson's acceleration is used, even if single vertices still change by more.
LARGEST_CHANGE, ACCELERATED = 50.0, 2.0
# Temperature in K above which a search fails. It is far above `HOTTEST`, because films during a search may be hotter
# than the solution.
DIVERGED = 2000.0
# Longest step of a search: as a share of the smallest gap; over the clearance where surfaces may touch or deflect.
# Larger: fewer rounds, more steps without a film.
ROOM, FREE_STEP = 0.6, 0.3


@dataclass(eq=False)
class Place(SearchState[SolvedFilm]):
    """A film of a search; ``x`` are the free coordinates, ``unbalance`` is the force of films and load, N, at T*.

    Attributes
    ----------
    motion : (11,) array
        Motion of the journal (10,), and its axial position between the end faces, m.
    temperature, change : arrays
        T and T* - T, K, of any shape; ``change`` is empty if no temperature is sought.
    evaluation : Evaluation
        Evaluation of the steady film there.
    slope : (k, k) array
        Derivative of the unbalance to the free coordinates, N/m.
    faces : ThrustEvaluation or None
        Films on the end faces, which ``unbalance`` contains.
    """

    motion: np.ndarray
    temperature: np.ndarray
    change: np.ndarray
    evaluation: Evaluation
    slope: np.ndarray
    faces: ThrustEvaluation | None

    def largest_change(self) -> float:
        """Largest component of ``change``, K; not 0, so that it may divide."""
        return float(np.abs(self.change).max(initial=1e-300))

    def mean_change(self) -> float:
        """Root mean square of ``change``, K."""
        return float(norm(self.change)) / math.sqrt(max(self.change.size, 1))


class Balance(DampedNewton[Place]):
    """Search for the temperature and, under a load, the position of a model's steady film.

    Without a resistance a step may increase the unbalance: Newton's method converges from the thin side of a film,
    where the unbalance is larger.

    Parameters
    ----------
    model : BearingModel
    where : str
        Name of the caller, for error messages.
    load : (k,) array, optional
        Force on the journal in x and y, N; a third component is the axial force, which the faces carry. None: the
        journal's position is prescribed.
    size : float, optional
        Force, N, over which the unbalance in x and y is measured; by default the load's size in x and y.
    faces : ThrustModel, optional
        Films on the end faces beside the journal's.
    held : History, optional
        Memory whose temperature is prescribed; None: the temperature is sought.

    Attributes
    ----------
    share : float
        Share of the load in the present search; below 1 in a continuation from smaller loads.
    strongest : float, (float, float)
        Largest force of the film in this search, N, and the eccentricity ratio there.
    rough : bool
        Whether the temperature is transported along theta with first order.
    """

    growth = math.inf

    def __init__(
        self,
        model: BearingModel,
        where: str,
        load: np.ndarray | None = None,
        *,
        size: float | None = None,
        faces: ThrustModel | None = None,
        held: History | None = None,
    ) -> None:
        self.model, self.where, self.faces, self.held = model, where, faces, held
        self.load = np.zeros(0) if load is None else load
        self.free, self.share = [0, 1, MOTION_SIZE][: self.load.size], 1.0
        self.size = float(norm(self.load[:2])) if size is None else size
        self._sizes = np.array([self.size, self.size, *np.hypot(self.size, self.load[2:])])[: self.load.size]
        self.thermal = model.effects.thermal if held is None else None
        cold = np.zeros(0) if self.thermal is None else self.thermal.initial_temperature()
        self.cold = np.asarray(cold, dtype=float)
        self.first, self.strongest, self.rough = model.parts.evaluations, (0.0, 0.0), False
        self._acceleration = Acceleration()
        self._before: Place | None = None

    def temperature_of(self, near: History | None) -> np.ndarray:
        """Initial guess of the temperature, K: that of the memory ``near``, else that of the thermal option."""
        known = None if near is None else near.temperature
        return np.asarray(self.cold if known is None or self.thermal is None else known, dtype=float)

    def at(self, motion: np.ndarray, temperature: np.ndarray) -> Place:
        """The steady film at a motion (11,) and a temperature; `FilmError` without one."""
        self.count += 1
        T, thermal, k = temperature, self.thermal, len(self.free)
        history = self.held if thermal is None else History(temperature=T if T.ndim else float(T))
        evaluation = self.model.evaluate_steady(motion[: self.model.motion_size], history)
        film = evaluation.film
        if film is None or evaluation.status is not Status.CONVERGED:
            raise FilmError(no_film(evaluation, self.where))
        beside = None
        if self.faces is not None:
            beside = self.faces.evaluate(motion, seen_by_faces(film, self.model.effects.thermal))
            beside.require_film(self.where)
            film = evaluation.heat_with(beside.heat) or film
        thinner, change = 1.0, np.zeros(0)
        if thermal is not None:
            thermal.upwind = self.rough
            change = thermal.steady_temperature(film) - T
            size = float(np.abs(change).max())
            if not size < math.inf:
                raise FilmError(f"{self.where}: the film is heated, and its heat has no way out; {WAY_OUT}")
            if not float(T.max()) < DIVERGED:
                raise FilmError(f"{self.where}: the film is beyond {DIVERGED:g} K, {NO_OIL}")
            after = T + change * min(1.0, LARGEST_CHANGE / max(size, 1e-300))
            thinner = float(thermal.viscosity_ratio(after).mean() / thermal.viscosity_ratio(T).mean())
        unbalance, slope = self.share * self.load, np.zeros((k, k))
        if k:
            carried = float(np.hypot(*evaluation.wrench[:2]))
            ratio = float(np.hypot(*motion[:2])) / self.model.bearing.radial_clearance
            self.strongest = max(self.strongest, (carried, ratio))
            unbalance += thinner * evaluation.wrench[:k]
            slope[:, :2] = thinner * evaluation.steady_tangent()[:k, :2]
        if beside is not None:
            unbalance += beside.wrench[:k]
            slope += beside.tangent()[:k, self.free] if k else 0.0
            if k > 2:  # plane faces at rest have no stiffness: with this one a step goes to the loaded face
                slope[2, 2] = min(slope[2, 2], -SMALL * self._sizes[2] / self.model.bearing.radial_clearance)
        motion, step = motion.copy(), partial(damped_step, -slope, unbalance)
        x, size = motion[self.free], self.size
        return Place(x, unbalance, size, step, film, motion, T, change, evaluation, slope, beside)

    def residual(self, place: Place) -> float:
        """Largest component of the unbalance over the load."""
        return float((np.abs(place.unbalance) / self._sizes).max(initial=0.0)) / self.share

    def error(self, place: Place) -> float:
        """The larger of the residual and of the temperature's mean change over `LARGEST_CHANGE`.

        A few hot vertices at the edge of a groove change by far more than the mean, up to the end of the search.
        """
        return max(self.residual(place), place.mean_change() / LARGEST_CHANGE)

    def is_balanced(self, place: Place, tolerance: float = LOAD_TOLERANCE, settled: float = SETTLED) -> bool:
        """Return whether the residual is below a tolerance, and the change of the temperature below ``settled``.

        With a transport of first order, return whether the search is near enough for the second order.
        """
        T, change = place.temperature, place.change
        if self.rough:
            return self.residual(place) < 1.0 and place.mean_change() < ACCELERATED
        if self.residual(place) > tolerance or not change.size:
            return self.residual(place) <= tolerance
        rise = max(float(np.ptp(T + change)), float(np.abs(T - self.cold).max()), 1e-3)
        return float(np.abs(change).max()) <= settled * rise

    def solve(
        self,
        motion: np.ndarray,
        temperature: np.ndarray,
        tolerance: float = LOAD_TOLERANCE,
        *,
        resistance: float = 0.0,
        rounds: int = ROUNDS,
    ) -> Place:
        """Return the film in balance; if the search makes no progress, the last film that it reached.

        ``motion`` (11,) and ``temperature`` are the initial guess. The returned film is the one that the model
        evaluated last.

        Raises
        ------
        FilmError
            If there is no film at the initial guess; under a load, none at smaller eccentricities either.
        """
        self.rough, self.tolerance = self.cold.ndim > 1, tolerance
        self._acceleration, self._before = Acceleration(), None
        found, first = self._first(motion, temperature), self.count
        if self.rough:
            found = self.search(found, resistance=resistance, rounds=rounds)
            is_near, self.rough = self.is_balanced(found), False
            found = self.at(found.motion, found.temperature)
            if not is_near:
                return found
            self._acceleration.restart()
        found = self.search(found, resistance=resistance, rounds=rounds - self.count + first)
        if found.film.serial != self.model.parts.evaluations:
            found = self.at(found.motion, found.temperature)
        return found

    def resumes(self) -> bool:
        """Return whether a search for a temperature goes on with smaller steps."""
        if self.thermal is None or self._acceleration.damping < WEAKEST:
            return False
        self._acceleration.restart()
        self._acceleration.damping *= 0.6
        return True

    def _first(self, motion: np.ndarray, temperature: np.ndarray) -> Place:
        """The film at a motion (11,), or that of a free journal at a smaller eccentricity if there is none."""
        for _ in range(HALVINGS if self.free else 0):
            try:
                return self.at(motion, temperature)
            except FilmError:
                motion = np.concatenate([0.8 * motion[:2], motion[2:]])
        return self.at(motion, temperature)

    def _scales(self, size: int) -> np.ndarray:
        """Units (k + size,) of the unknowns: clearance for positions, `LARGEST_CHANGE` of all temperatures, K."""
        c = self.model.bearing.radial_clearance
        return np.append(np.full(len(self.free), c), np.full(size, LARGEST_CHANGE * math.sqrt(max(size, 1))))

    def step(self, place: Place, resistance: float) -> np.ndarray:
        """Newton's step from a place and the temperature's change (k + m,), scaled, with Anderson's acceleration."""
        scales, again, self._before = self._scales(place.change.size), place is self._before, place
        change = place.change * min(1.0, LARGEST_CHANGE / place.largest_change())
        step = np.append(place.newton_step(resistance), change) / scales
        # steps that were rejected or that are long lead to no acceleration
        if again or place.mean_change() >= ACCELERATED:
            self._acceleration.restart()
        if not place.change.size or place.mean_change() >= ACCELERATED:
            return self._acceleration.damping * step
        return self._acceleration.step(np.append(place.x, place.temperature) / scales, step)

    def moved(self, place: Place, step: np.ndarray) -> Place | None:
        """Evaluate the film after a scaled step (k + m,) from a place; None without one, or after too many films.

        Moves are limited by the gaps, temperature changes to four times the change at the place.
        """
        if self.model.parts.evaluations - self.first > MOST_FILMS:
            return None
        k, motion, size = len(self.free), place.motion.copy(), place.largest_change()
        step = step * self._scales(place.change.size)
        if k:
            motion[:2] += room(self.model, motion, np.append(step[:2], (0.0, 0.0))) * step[:2]
        if place.faces is not None and k > 2:
            motion[MOTION_SIZE] += room_of_faces(place.faces, float(step[2])) * step[2]
        change = step[k:].reshape(place.change.shape)
        change = change * min(1.0, 4.0 * size / float(np.abs(change).max(initial=size)))
        try:
            return self.at(motion, place.temperature + change)
        except FilmError:
            return None


def room(model: BearingModel, motion: np.ndarray, change: np.ndarray) -> float:
    """Largest part of a change (4,) of the pose that closes at most 60 % of the smallest gap of the rigid surfaces.

    Where surfaces may touch or deflect, the journal may move by 30 % of the clearance instead; in lobed bores both
    limits hold.
    """
    c, touches, lobed = model.bearing.radial_clearance, model.effects.contacts or model.flexible, model.bearing.is_lobed
    part = min(1.0, FREE_STEP * c / float(np.hypot(*change[:2]) + 1e-300)) if touches or lobed else 1.0
    if touches:
        return part
    if lobed:
        # in a lobed bore the journal's eccentricity may exceed the clearance
        closed = 1.0 - gaps_of_arcs(model, motion[:4] + part * change) / gaps_of_arcs(model, motion)
        return part * min(1.0, ROOM / max(float(closed.max()), 1e-300))
    return part_that_closes(ROOM, motion, motion[:4] + change, c, model.bearing.length)


def gaps_of_arcs(model: BearingModel, motion: np.ndarray) -> np.ndarray:
    """Gaps (n, m) between rigid surfaces at the pose ``motion[:4]``, m."""
    g, lobes = model.grid, model.effects.lobes
    away = np.array(g.directions[:2]).T @ (motion[:2, None] + motion[2:4, None] * g.z * g.reference_length)
    return np.asarray(model.bearing.radial_clearance * (1.0 + (0.0 if lobes is None else lobes.values)) - away)


def room_of_faces(faces: ThrustEvaluation, shift: float, slope: float = 0.0) -> float:
    """Largest part of an axial shift, m, and a change of the tilt, rad, for which the films on end faces have room.

    It closes at most 60 % of the smallest gap, or with a contact 30 % of the clearance.
    """
    options = faces.model.bearing.thrust
    assert options is not None
    longest = ROOM * faces.minimum_gap if options.contact is None else FREE_STEP * options.clearance
    return min(1.0, longest / max(abs(shift) + options.outer_radius * slope, 1e-300))


def settled_history(
    model: BearingModel,
    motion: np.ndarray,
    near: History | None = None,
    where: str = "steady",
    faces: ThrustModel | None = None,
) -> History | None:
    """History whose temperature is in balance with the steady film at a motion; None for an isothermal bearing.

    Parameters
    ----------
    model : BearingModel
    motion : (10,) array
        As for `BearingModel.evaluate_steady`; (11,) with faces, as for them.
    near : History, optional
        Memory of a film nearby, whose temperature is the initial guess; it saves time.
    where : str
        Name of the caller, for error messages.
    faces : ThrustModel, optional
        Films on the end faces, which take part in the balance of heat.

    Raises
    ------
    FilmError
        Without a film, without a sink for the heat, or if the temperature does not converge.
    """
    balance = Balance(model, where, faces=faces)
    if balance.thermal is None:
        return None
    found = balance.solve(motion, balance.temperature_of(near))
    if not balance.is_balanced(found, settled=SMALL):
        require_oil_bears(found.film.temperature, model.grid, where)
        raise FilmError(
            f"{where}: the film's temperature does not converge, its last change is {np.abs(found.change).max():.3g} "
            "K; the heating is too strong for a steady film, check speed, clearance and the temperature law."
        )
    return found.film.history


def history_at(
    model: BearingModel, motion: np.ndarray, where: str, near: History | None = None, faces: ThrustModel | None = None
) -> History | None:
    """History of the steady film at ``motion``; None if the film has neither a temperature nor a memory of its oil.

    It has the temperature in balance with the film and, if the motion has rates, the oil content of the steady film at
    the same pose without rates. ``near``: history of a film nearby, whose temperature is the initial guess.
    """
    history = settled_history(model, motion, near, where, faces)
    if not model.remembers_mass or not np.any(motion[4:8]):
        return history
    at_rest = motion.copy()
    at_rest[4:8] = 0.0
    content = evaluate_at(model, at_rest, where, None, faces).evaluation.history()
    assert content is not None
    return replace(content, temperature=None if history is None else history.temperature, pockets=None)


def evaluate_at(
    model: BearingModel, motion: np.ndarray, where: str, near: History | None = None, faces: ThrustModel | None = None
) -> Place:
    """Return the steady film at ``motion``.

    `FilmError`, in the name of ``where``, if there is none, if it is too hot for any oil or outside the oil's table, or
    if the walls have grown by the whole clearance. ``near`` as for `history_at`, ``motion`` and ``faces`` as for
    `settled_history`.
    """
    balance = Balance(model, where, faces=faces, held=history_at(model, motion, where, near, faces))
    found = balance.at(motion, balance.cold)
    require_bearable(found.film, where)
    return found
