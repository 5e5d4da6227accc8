"""Subject of an audit: films of a bearing, their numbers, and the changes by another description of the bearing.

Changes are computed from films. At a steady state a search finds the position at which the other bearing's film
carries the same load. Minimum film thickness, peak pressure and loss are compared there; the load is compared at the
first position. Films of a record with a memory are compared at the same motion with the same memory. The change of the
peak is then divided by that of the load, and the minimum film thickness is estimated from the load: under squeeze a
film carries about 1 / h^2.
"""

from __future__ import annotations

import math
import timeit
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import ClassVar

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.film.thrust.annulus import ThrustFaces
from exudyn_ehd.joint.audit.resolution import Resolution, resolution
from exudyn_ehd.joint.audit.samples import (
    FilmState,
    RecordedSteps,
    Sources,
    film_numbers,
    recorded_numbers,
    recorded_states,
    sources,
    squeeze_rate,
    squeeze_share,
)
from exudyn_ehd.joint.audit.switches import Switch, two_dimensional
from exudyn_ehd.joint.balance.steady_film import FREE_STEP, ROOM, evaluate_at
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.newton import PATIENCE, DampedNewton, SearchState
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.status import SMALL, FilmError, InputError, Status, require_type

# Relative change above which an effect matters, and change below which an effect that is on is not needed. Smaller
# values: more effects count as important, and fewer as needless.
MATTERS, NOTHING = 0.03, 0.02


@dataclass(frozen=True, kw_only=True)
class Change:
    """Changes by another description, relative to the bearing as it is, at the state where they are largest.

    Attributes
    ----------
    load : float
        Change at the same position or motion; nan if there is no such film.
    minimum_gap, peak_pressure, power_loss : float
        Changes at the same load; nan if no film was found that carries it.
    """

    load: float
    minimum_gap: float
    peak_pressure: float
    power_loss: float

    @property
    def found(self) -> bool:
        """Return whether a film was found that carries the same load."""
        return not math.isnan(self.minimum_gap)

    @property
    def size(self) -> float:
        """Largest change at the same load; inf without a film."""
        return max(abs(self.minimum_gap), abs(self.peak_pressure), abs(self.power_loss)) if self.found else math.inf

    def __str__(self) -> str:
        load = "" if math.isnan(self.load) else f"load {self.load:+.1%} at the same position; "
        if not self.found:
            return f"{load}no film found that carries the same load"
        rest = f"minimum film thickness {self.minimum_gap:+.1%}, peak {self.peak_pressure:+.1%}"
        return f"{load}{rest}, loss {self.power_loss:+.1%} at the same load"


class LoadedFilm(SearchState[Evaluation | None]):
    """Film at a position ``x`` of the journal; ``unbalance`` is the wanted force less its own, N."""

    @property
    def residual(self) -> float:
        """Largest component of the unbalance, N."""
        return float(np.abs(self.unbalance).max())


class EqualLoadSearch(DampedNewton[LoadedFilm]):
    """Search for the position at which the film of another bearing has a given force.

    Parameters
    ----------
    steady : function
        Function of a motion that evaluates the steady film.
    motion : (n,) array
        Motion at the first position.
    force : (k,) array
        N.
    free_step : float or None
        Largest step, m; None: 60 % of the minimum film thickness.

    Attributes
    ----------
    share : float
        Size of the force at the first position over the wanted one; nan without a film there.
    """

    progress = 1.0

    def __init__(
        self,
        steady: Callable[[np.ndarray], Evaluation],
        motion: np.ndarray,
        force: np.ndarray,
        free_step: float | None,
    ) -> None:
        self.steady, self.motion, self.force, self.free_step, self.share = steady, motion, force, free_step, math.nan

    def moved(self, state: LoadedFilm, step: np.ndarray) -> LoadedFilm | None:
        """Film after a step."""
        x, k, size, self.count = state.x + step, self.force.size, state.size, self.count + 1
        try:
            film = self.steady(np.concatenate((x, self.motion[k:])))
        except FilmError:
            return None
        if film.status is not Status.CONVERGED:
            return None
        left = self.force - film.wrench[:k]
        if self.count == 1:
            self.share = float(np.linalg.norm(film.wrench[:k])) / size

        @cache
        def newton_step(resistance: float) -> np.ndarray:
            step, *_ = np.linalg.lstsq(film.steady_tangent()[:k, :k], left, rcond=1e-9)
            longest = self.free_step or ROOM * film.minimum_gap
            return step * min(1.0, longest / max(float(np.linalg.norm(step)), 1e-300))

        return LoadedFilm(x, left, size, newton_step, film)


class Case:
    """Films of a journal bearing at some states; ball joints have a subclass.

    Parameters
    ----------
    model : BearingModel
    states : sequence of FilmState
    record : RecordedSteps, optional
        Record of the states. With it the audit also knows when contacts acted, the mean heating and the time step.
    liner : ElasticLiner, optional
        Liner whose elasticity is assessed, for bearings without one.
    faces : ThrustFaces, optional
        Thrust faces of the recorded joint; ``model`` is without them.
    measure_time : bool
        Measure the share of the computing time of each effect that is on and can be switched off.

    Attributes
    ----------
    bearing : JournalBearing
    numbers : dict of str to (n,) arrays
        Numbers of the films, see `film_numbers`.
    resolutions : list of Resolution
    axes : int
        Number of components of the film's force that are compared.
    tolerance : float
        Unbalance over the load up to which two films carry the same load. Larger: less accurate changes.
    replays : bool
        True: films with a memory get it from the steps of the record before their state.
    surface, steel : str
        Names of the surface around the film and of the deflecting steel, for messages.
    omitted : dict of str to str
        Advice by the name of an effect that such a bearing cannot have.

    Raises
    ------
    FilmError
        If there is no film at any state.
    """

    axes, tolerance, replays = 2, 1e-3, True
    surface, steel = "bore", "a steel ring"
    omitted: ClassVar[Mapping[str, str]] = {}

    def __init__(
        self,
        model: BearingModel,
        states: Sequence[FilmState],
        record: RecordedSteps | None = None,
        *,
        liner: ElasticLiner | None = None,
        faces: ThrustFaces | None = None,
        measure_time: bool = False,
    ) -> None:
        require_type("audit: liner", liner, ElasticLiner, type(None))
        self.bearing, self.model, self.states, self.record = model.bearing, model, states, record
        self.liner, self.faces, self.measures_time = liner, faces, measure_time
        films = [found for state in states if (found := self._film(state)) is not None]
        if not films:
            raise FilmError(
                "audit: none of the states has a film that can be evaluated; audit a joint after its run, or a result "
                "of `steady`."
            )
        self.numbers = {name: np.array([row[name] for row, _ in films]) for name in films[0][0]}
        self.resolutions = [seen for _, seen in films]
        is_map = isinstance(model.bearing.film, ImpedanceMap)
        # a map has no field to compare
        self._own = self.build(two_dimensional(model.bearing)) if is_map else model

    def _film(self, state: FilmState) -> tuple[dict[str, float], Resolution] | None:
        """Evaluate a state and read its numbers; None if there is no film."""
        evaluation = state.evaluate(self.model)
        if evaluation.film is None:
            return None
        q, by_motion = evaluation.quantities(), self.sources(evaluation.motion[None])
        numbers = {name: q[name] for name in ("peak_pressure", "contact_load", "power_loss")}
        numbers["load"] = float(np.linalg.norm(evaluation.wrench[: self.axes]))
        numbers["squeeze_share"] = float(squeeze_share(by_motion)[0])
        numbers["squeeze_rate"] = squeeze_rate(by_motion, self.bearing.radial_clearance)
        own, seen = self.own_numbers(evaluation)
        numbers |= own
        if self.record is not None and state.recorded is not None and self.model.flexible:
            numbers |= recorded_numbers(self.record, state.recorded)
        return numbers, seen

    def build(self, bearing: JournalBearing) -> BearingModel:
        """Model of another bearing, whose grid starts at the same angle."""
        return build_study_model(bearing, float(self.model.grid.x[0]))

    def sources(self, motions: np.ndarray) -> Sources:
        """Sources of Reynolds' equation by motions (n, k)."""
        return sources(self.bearing, motions)

    def slide(self, motions: np.ndarray) -> np.ndarray:
        """Size (n,) of the relative spin of motions (n, k), rad/s."""
        return np.abs(motions[:, 8])

    def turns(self, motions: np.ndarray) -> np.ndarray:
        """Spin (n,) of motions (n, k), rad/s, by which steps per turn are counted."""
        return motions[:, 8]

    def own_numbers(self, evaluation: Evaluation) -> tuple[dict[str, float], Resolution]:
        """Numbers of a film as in `film_numbers`, and the resolution of its pressure peak by the grid."""
        return film_numbers(self.model, evaluation), resolution(evaluation.solved)

    def compared(self, evaluation: Evaluation) -> tuple[float, float, float]:
        """Minimum film thickness, m, refined peak pressure, Pa, and loss, W, of a film."""
        q = evaluation.quantities()
        return q["minimum_gap"], q["peak_pressure"], q["power_loss"]

    def steady(self, other: BearingModel, mine: FilmState) -> Callable[[np.ndarray], Evaluation]:
        """Return the function of a motion of rigid surfaces that evaluates the steady film of another bearing.

        If both bearings have the same thermal option, the temperature of this one is kept: its change has an effect of
        second order. A temperature field is computed anew for another grid.
        """
        if not (other.remembers or other.flexible):
            return other.evaluate
        thermal, known, near = other.bearing.thermal, mine.history, None
        if known is not None and thermal is not None and thermal == self._own.bearing.thermal:
            held = known.temperature
            if other.grid.shape == self._own.grid.shape or not isinstance(held, np.ndarray):
                return lambda motion: other.evaluate_steady(motion, History(temperature=held))

        def settled(motion: np.ndarray) -> Evaluation:
            """Evaluate the film at its steady temperature; the initial guess is the previous film's temperature."""
            nonlocal near
            found = evaluate_at(other, motion, "audit", near)
            near = found.film.history
            return found.evaluation

        return settled

    def change(self, switch: Switch) -> Change | None:
        """Largest change by a switch over all states; None if no state could be compared."""
        own, record = self._own, self.record
        try:
            other = self.build(switch(own.bearing))
        except InputError:
            return None
        states: Sequence[FilmState] = self.states
        remembers = self.replays and record is not None and (other.remembers or own.remembers or own.needs_spin)
        # a bearing that gains a memory of its oil, or has another grid, needs histories of its own
        gains = other.remembers_mass and not own.remembers_mass
        if record is not None and remembers and (gains or other.grid.shape != own.grid.shape):
            if other.flexible:  # tens of steps before every state, each a search for the bore's balance: seconds
                return None
            states = recorded_states(other, record)
        found = [self._at(other, mine, its, remembers) for mine, its in zip(self.states, states, strict=True)]
        changes = [change for change in found if change is not None]
        return max(changes, key=lambda change: change.size, default=None)

    def _at(self, other: BearingModel, mine: FilmState, its: FilmState, remembers: bool) -> Change | None:
        film = mine.evaluate(self._own)
        if film.status is not Status.CONVERGED:
            return None
        force, own, motion = film.wrench[: self.axes].copy(), self.compared(film), mine.motion[None]
        size, b, reached = float(np.linalg.norm(force)), self.bearing, None
        rates = np.linalg.norm(self.sources(motion)[1], axis=2).max() / b.radial_clearance
        # smaller loads have no relative changes
        if not size > SMALL * b.reference_force(float(self.slide(motion)[0] + rates)):
            return None
        if remembers:
            reached = other.evaluate_steady(its.motion[: other.motion_size], its.history, its.step, its.spin)
            if reached.status is not Status.CONVERGED:
                return None
            share = max(float(np.linalg.norm(reached.wrench[: self.axes])) / size, 1e-12)
        else:
            if other.flexible and other.bearing.bush is b.bush and other.bearing.journal is b.journal:
                other.evaluate(mine.motion, mine.history)  # start its search for the bore's shape at this one's shape
            share, reached = self._carrying(other, mine, force, size)
        if reached is None:
            return Change(load=share - 1.0, minimum_gap=math.nan, peak_pressure=math.nan, power_loss=math.nan)
        pairs = zip(self.compared(reached), own, strict=True)
        gap, peak, loss = (new / old if old > 0.0 else 1.0 for new, old in pairs)
        if remembers:  # at the same motion, so estimated for the same load
            gap, peak = gap * math.sqrt(share), peak / share
        return Change(load=share - 1.0, minimum_gap=gap - 1.0, peak_pressure=peak - 1.0, power_loss=loss - 1.0)

    def _carrying(
        self, other: BearingModel, mine: FilmState, force: np.ndarray, size: float
    ) -> tuple[float, Evaluation | None]:
        """Load of another bearing's film at a state over this bearing's load, and its film with the same force.

        The load is nan without a film at the first position, the film None if the search fails.
        """
        b, motion = other.bearing, mine.motion[: other.motion_size]
        touches = other.flexible or b.contact is not None or b.asperity is not None
        free_step = FREE_STEP * b.radial_clearance if touches else None
        search = EqualLoadSearch(self.steady(other, mine), motion, force, free_step)
        search.tolerance = self.tolerance
        # the first step goes from the centre to the state's position; halved steps reach a film between both
        k, unknown = force.size, np.full_like(force, math.inf)
        centre = LoadedFilm(np.zeros(k), unknown, size, lambda resistance: motion[:k], None)
        found = search.search(centre, rounds=3 * PATIENCE)
        return search.share, found.film if search.is_balanced(found, self.tolerance) else None

    def time_share(self, switch: Switch) -> float | None:
        """Share of the computing time, evaluations with tangent, that is saved by a switch which removes an effect.

        None if no state has a film with and without the effect, or if time is not measured.
        """
        if not self.measures_time:
            return None
        model, plain = self.model, self.build(switch(self.bearing))
        # both models get the same history: a model without an effect does not read the part of that effect
        pairs = [(s, replace(s, motion=_known_to(plain, s.motion))) for s in self.states]
        both = [(s, t) for s, t in pairs if s.evaluate(model).status is t.evaluate(plain).status is Status.CONVERGED]
        if not both:
            return None
        with_it, without_it = (_seconds(m, states) for m, states in zip((model, plain), zip(*both), strict=True))
        return max(0.0, 1.0 - without_it / with_it)


def _known_to(model: BearingModel, motion: np.ndarray) -> np.ndarray:
    """Motion of ``model``: without the coordinates and rates of a bore or journal that is rigid there."""
    q, q_t = np.split(motion[MOTION_SIZE:], 2)
    size = model.size if isinstance(model, ElasticBearingModel) else 0
    kept = slice(size) if model.bearing.bush is not None else slice(q.size - size, None)
    return np.concatenate((motion[:MOTION_SIZE], q[kept], q_t[kept]))


def _seconds(model: BearingModel, states: Sequence[FilmState]) -> float:
    """Time of evaluations with tangent and history, s."""

    def films() -> None:
        for state in states:
            evaluation = state.evaluate(model)
            evaluation.tangent()
            evaluation.history()

    return min(timeit.repeat(films, number=1))
