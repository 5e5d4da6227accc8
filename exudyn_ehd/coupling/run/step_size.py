"""Steps chosen by the error that they make in the films.

Behind Newton's method of a step, `exudyn_ehd.joint.step_error.next_error` says for every joint what the step has missed
over what it may miss. Far too much, and Exudyn repeats the step by half of it or more (its function after Newton's
method recommends the size); else the function after the step sets the size of the next one. What a step misses grows
with the cube of its size, and what it may miss with its size: a step's demand is the root of the quotient over its
size, and the next one follows the largest demand of late.

A step in which a load jumps is repeated as long as the jump would make more than what earlier errors leave of the error
that is asked for, or more than half of it where they leave less. Where the load is a function of time its jump is found
within the step; the integration takes jumps to be in the middle of their step, and the next step, or the one after it,
has the jump there. So a pulse within a step is met, too. Jumps of other loads count as at an end of the step, which is
halved.

A change of the size costs an error of its own: velocities carry an error of h^2 along, that of the size before, and go
over to the new one within a step or two. So sizes grow by a tenth at a time, and smaller changes are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.exudyn_solvers import hooked
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.step_error import REFUSED, SMALLEST_GAP_SHARE, FilmLoad, next_error, no_error
from exudyn_ehd.status import SMALL, Status

# First and largest step, in steps of the settings.
FIRST, LARGEST = 0.125, 4.0
# Changes of the size at once: the smallest factor, the largest, and below which none is worth it.
SHRINK, GROW, WORTH = 0.5, 1.1, 0.9
# Part of its demand that a step hands on.
KEPT = 0.94
# Allowed error of steps over the error asked for: errors of successive steps cancel in part. Larger: longer steps.
CANCELLED = 1.5
# Least share of a step, at its beginning and its end, in which none ends that is repeated for a jump in its middle.
END_OF_STEP = 0.25
# Least share of the error asked for that a jump may make beside the error that is left from earlier ones.
LEAST_OF_ERROR = 0.5


_StepState: TypeAlias = tuple[float, np.ndarray, tuple[float, float], FilmLoad, np.ndarray | None]


class _JointError:
    """The error of one joint: at the start of the step, and behind the one at hand."""

    def __init__(self, film: FilmElement, error: float) -> None:
        self.film, self.error = film, error
        # start and size of the last step tried, and what a jump in it may make
        self.jump = (math.nan, 0.0, 0.0)
        self.lags = isinstance(getattr(film.model.bearing, "bush", None), ElasticLiner)
        self.states: list[_StepState] = []
        self.now: _StepState | None = None
        self.before = no_error(film.parts)
        self.after, self.wanted = self.before, math.inf

    def used(self, mbs: exu.MainSystem, time: float) -> float | None:
        """Return the error of the step to ``time`` over the allowed error; None if it is unknown."""
        self.wanted = math.inf
        trial, tangent, bearing = self.film.last, self.film.steps.tangent, self.film.model.bearing
        if trial is None or trial.evaluation is None or trial.status != Status.CONVERGED:
            self.now = None
            return None
        film = trial.evaluation.quantities()
        w, angle = (film["bore_displacement"], film["peak_angle"]) if self.lags else (0.0, 0.0)
        load = self.film.outer.at(mbs, CURRENT, trial)
        self.now = (time, trial.motion[:10], (w * math.cos(angle), w * math.sin(angle)), load, tangent)
        if len(self.states) < 2 or tangent is None:
            return None
        states = *self.states, self.now
        times, motions, deflections = map(np.array, zip(*(state[:3] for state in states), strict=True))
        loads = FilmLoad(*map(np.stack, zip(*(state[3] for state in states), strict=True)))
        gap = max(film["minimum_gap"], SMALLEST_GAP_SHARE * bearing.radial_clearance)
        deflection = deflections if self.lags else None
        allowed = CANCELLED * self.error * gap
        before = self.states[-1][4]
        tangents = (tangent if before is None else before), tangent
        self.after, used, moved = next_error(
            self.film.parts, times, motions, tangents, loads, self.before, bearing.length, allowed, deflection
        )
        start, step, asked = times[-2], times[-1] - times[-2], self.error * gap
        functions, jump = self.film.outer.functions, moved[0]
        if functions is not None:
            share, place = functions.largest_change(mbs, time)
            jump = jump if math.isfinite(loads.offset[-1, 0]) else share * moved[2]
            asked = max(asked - moved[3], LEAST_OF_ERROR * asked)
            if jump > asked:
                most = step * min(1.0 - END_OF_STEP, max(END_OF_STEP, math.sqrt(asked / jump)))
                # a whole number of steps and a half to the jump, so that the last one has it in its middle
                centred = (place - start) / (max(1.0, math.ceil((place - start) / most + 0.5)) - 0.5)
                self.wanted = max(centred, min(most, 0.5 * step * asked / jump))
                return max(used, REFUSED)
        less = self._asks_for_less(start, step, moved[1], asked)
        return max(used, REFUSED) if less else used

    def _asks_for_less(self, start: float, step: float, error: float, allowed: float) -> bool:
        """Return whether a shorter step is worth its while for a jump that may make an ``error``.

        In half a step a jump makes half the error at most. Loads that ring grow as 1 / h and make the same error: a
        step is not repeated again where the error falls by less than the root of what the step does.
        """
        (last_start, last_step, last_error), self.jump = self.jump, (start, step, error)
        rings = start == last_start and error > last_error * math.sqrt(step / last_step)
        return error > allowed and not rings

    def accept(self) -> None:
        """Go on behind the step at hand."""
        self.before = self.after
        # without a film there is no error, and the next ones are known two steps later
        self.states = [] if self.now is None else [*self.states[-4:], self.now]


class StepSize:
    """User functions of a run that repeat steps and choose their sizes.

    Parameters
    ----------
    settings : exudyn.SimulationSettings
    films : sequence of FilmElement
        Elements of all joints.
    error : float
        Share of the minimum film thickness.
    sensors : bool
        Whether the system has sensors.
    """

    def __init__(
        self,
        settings: exu.SimulationSettings,
        films: Sequence[FilmElement],
        error: float,
        *,
        sensors: bool,
    ) -> None:
        run, solution = settings.timeIntegration, settings.solution
        self.begin, self.end = run.startTime, run.endTime
        self.usual = (self.end - self.begin) / run.numberOfSteps
        # joints with nothing but faces have no estimate
        known = (film for film in films if getattr(film.model.bearing, "thrust", None) is not film.model.bearing)
        self.joints = [_JointError(film, error) for film in known]
        self.periods = [solution.file.writePeriod] if solution.file.write else []
        self.periods += [solution.sensors.writePeriod] if sensors else []
        self.beyond = 2.0 * run.discontinuous.iterationTolerance
        self.size = self.planned = FIRST * self.usual
        self.time = math.nan
        self.demand = 0.0
        self.used: float | None = None

    def look(self, own: Any, mbs: exu.MainSystem, time: float) -> list[float]:
        """User function after Newton's method and the user's own: error, and step size to repeat the step with."""
        error, wanted = own(mbs, time)
        known = [used for joint in self.joints if (used := joint.used(mbs, time)) is not None]
        self.used = max(known, default=None)
        step = time - mbs.systemData.GetTime(START_OF_STEP)
        smallest = mbs.sys["dynamicSolver"].it.minStepSize
        if self.used is None or self.used < REFUSED or step <= smallest * (1.0 + SMALL):
            return [error, wanted]
        step = min(step * max(SHRINK, self.used**-0.5), *(joint.wanted for joint in self.joints))
        return [max(error, self.beyond), min(step, wanted) if wanted >= 0.0 else step]

    def choose(self, own: Any, mbs: exu.MainSystem, time: float) -> bool:
        """User function after the user's own, behind an accepted step and before the first one: sets the next size."""
        goes_on = bool(own(mbs, time))
        if not math.isnan(self.time):
            for joint in self.joints:
                joint.accept()
            self._adapt(time - self.time)
        self.time = time
        self.planned = self._landing(time)
        mbs.sys["dynamicSolver"].it.currentStepSize = self.planned
        return goes_on

    def _adapt(self, step: float) -> None:
        """The size to go on with, behind an accepted step."""
        if step < (1.0 - SMALL) * self.planned:
            # repeated, here or by Exudyn
            self.size, self.demand = step, max(self.demand, 1.0 / step)
        elif self.used is not None:
            self.demand = max(math.sqrt(self.used) / step, KEPT * self.demand)
            wanted = min(1.0 / self.demand if self.demand > 0.0 else math.inf, LARGEST * self.usual)
            factor = wanted / self.size
            if factor < WORTH or factor > GROW:
                self.size *= min(GROW, max(SHRINK, factor))

    def _landing(self, time: float) -> float:
        """The next step, which ends at the next time that is asked for or is at most half the way there."""
        stops = [self.end]
        for period in self.periods:
            if period > SMALL * self.usual:
                stops.append(self.begin + period * (math.floor((time - self.begin) / period + SMALL) + 1))
        rest = min(stops) - time
        if self.size >= rest * (1.0 - SMALL):
            return rest
        return min(self.size, 0.5 * rest)


@contextmanager
def steps_by_error(
    mbs: exu.MainSystem, settings: exu.SimulationSettings, films: Sequence[FilmElement], error: float
) -> Iterator[None]:
    """Choose the steps of the run within; the user's functions and settings come back then."""
    control = StepSize(settings, films, error, sensors=mbs.systemData.NumberOfSensors() > 0)
    run = settings.timeIntegration
    kept = run.adaptiveStepRecoverySteps, run.discontinuous.useRecommendedStepSize
    # Exudyn itself never doubles a step
    run.adaptiveStepRecoverySteps, run.discontinuous.useRecommendedStepSize = 10**9, True
    with (
        hooked(mbs, "PostNewton", control.look),
        hooked(mbs, "PostStep", control.choose),
    ):
        try:
            for film in films:
                film.steps.chosen = True
            yield
        finally:
            for film in films:
                film.steps.chosen = False
            run.adaptiveStepRecoverySteps, run.discontinuous.useRecommendedStepSize = kept
