"""Steps chosen by the error that they make in the films.

After Newton's method of a step, `exudyn_ehd.joint.step_error.next_error` returns for every joint the local error over
the allowed one. If it is far too large, Exudyn repeats the step with half its size or less (the user function after
Newton's method recommends the size). Otherwise the user function after the step sets the size of the next one. The
local error grows with the cube of the step size, the allowed error in proportion to it. So the demand of a step is the
root of their ratio over its size, and the next size follows from the largest recent demand.

A step in which a load jumps is repeated as long as the error by the jump exceeds a limit: the requested error minus
earlier errors, but at least half of the requested error. If the load is a function of time, its jump is found within
the step. The integration assumes jumps in the middle of their step, so that steps are chosen with the jump in the
middle of the next one, or of the one after it. So a pulse within a step is found, too. Jumps of other loads count as
lying at an end of the step, which is halved.

A change of the step size causes an error: velocities have an error of h^2 with the previous size, which adapts to the
new size within a step or two. So sizes grow by a tenth at a time, and smaller changes are omitted.
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
from exudyn_ehd.coupling.record.history import unseen_errors
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.step_error import REFUSED, SMALLEST_GAP_SHARE, FilmLoad, next_error, no_error
from exudyn_ehd.status import SMALL, Status, warn_user

# First and largest step, over the step of the settings.
FIRST, LARGEST = 0.125, 4.0
# Factors of the size from step to step: the smallest and the largest one. Sizes that would change by less than the
# largest factor are kept.
SHRINK, GROW = 0.5, 1.1
# Factor by which the demand of earlier steps decays per step. Larger: steps grow later after a difficult one.
KEPT = 0.94
# Allowed error of steps over the error asked for: errors of successive steps cancel in part. Larger: longer steps.
CANCELLED = 1.5
# Least allowed error of a jump, over the requested error. Larger: fewer repeated steps, larger errors.
LEAST_OF_ERROR = 0.5


_StepState: TypeAlias = tuple[float, np.ndarray, tuple[float, float], FilmLoad, np.ndarray | None]


class _JointError:
    """Errors of one joint: at the start of the present step, and after it."""

    def __init__(self, film: FilmElement, error: float) -> None:
        self.film, self.error = film, error
        # start and size of the last step tried, and the possible error by a jump in it
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
                most = SHRINK * step
                # such that the jump is n + 1/2 steps away and lies in the middle of the last step
                centred = (place - start) / (max(1.0, math.ceil((place - start) / most + 0.5)) - 0.5)
                self.wanted = max(centred, most * asked / jump)
                return max(used, REFUSED)
        less = self._asks_for_less(start, step, moved[1], asked)
        return max(used, REFUSED) if less else used

    def _asks_for_less(self, start: float, step: float, error: float, allowed: float) -> bool:
        """Return whether a shorter step would reduce the possible ``error`` of a jump.

        In half a step the error of a jump is at most half. Loads that ring grow as 1 / h, with the same error in
        shorter steps. So a step is not repeated again if the error has fallen by less than the root of the step's
        ratio.
        """
        (last_start, last_step, last_error), self.jump = self.jump, (start, step, error)
        rings = start == last_start and error > last_error * math.sqrt(step / last_step)
        return error > allowed and not rings

    def accept(self) -> None:
        """Continue after the present step, which is accepted."""
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
        Requested error of the gap over the minimum film thickness.
    sensors : bool
        True if the system has sensors.
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
        for film in films:
            if unseen := unseen_errors(film.model.bearing):
                warn_user(
                    f"StepControl.error: of joint '{film.failures.name}' errors by {unseen} are not estimated, and may "
                    "exceed the error asked for by far; take equal steps, as many as ehd.recommend_steps(...) says.",
                    UserWarning,
                )
        self.periods = [solution.file.writePeriod] if solution.file.write else []
        self.periods += [solution.sensors.writePeriod] if sensors else []
        self.beyond = 2.0 * run.discontinuous.iterationTolerance
        self.size = self.planned = FIRST * self.usual
        self.time = math.nan
        self.demand = 0.0
        self.used: float | None = None

    def look(self, own: Any, mbs: exu.MainSystem, time: float) -> list[float]:
        """User function after Newton's method and the user's own: return the error and a recommended step size."""
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
        """User function after an accepted step and before the first one: set the next size, after the user's own."""
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
        """Set the size and the demand after an accepted step."""
        if step < (1.0 - SMALL) * self.planned:
            # repeated, here or by Exudyn
            self.size, self.demand = step, max(self.demand, 1.0 / step)
        elif self.used is not None:
            self.demand = max(math.sqrt(self.used) / step, KEPT * self.demand)
            wanted = min(1.0 / self.demand if self.demand > 0.0 else math.inf, LARGEST * self.usual)
            factor = wanted / self.size
            if not 1.0 / GROW <= factor <= GROW:
                self.size *= min(GROW, max(SHRINK, factor))

    def _landing(self, time: float) -> float:
        """Next step, which ends at the next output time or goes at most half of the way to it."""
        stops = [self.end]
        for period in self.periods:
            if period > SMALL * self.usual:
                stops.append(self.begin + period * (math.floor((time - self.begin) / period + SMALL) + 1))
        rest = min(stops) - time
        return rest if self.size >= rest * (1.0 - SMALL) else min(self.size, 0.5 * rest)


@contextmanager
def steps_by_error(
    mbs: exu.MainSystem, settings: exu.SimulationSettings, films: Sequence[FilmElement], error: float
) -> Iterator[None]:
    """Context in which the steps of a run are chosen by error; user functions and settings are restored at its end."""
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
