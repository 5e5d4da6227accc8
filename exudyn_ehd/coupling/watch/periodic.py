"""Runs that end when the orbits of all joints have closed.

A cycle is compared with the one before at the same phases. What two cycles in a row differ by is not yet how far the
last one is from the limit: differences d_1, d_2, ... that shrink by a factor q = d_k / d_(k-1) leave d q / (1 - q),
99 times the difference where a film warms up by 1 % of the rest in a cycle. So a run goes on until both are small.

How far a run is, where somebody looks: steps per second, time left, the thinnest film so far.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Protocol

import exudyn as exu
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.record.record import Record
from exudyn_ehd.coupling.watch.solver_state import hooked
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.progress import Progress, is_shown
from exudyn_ehd.status import InputError, RunError, require_number

# Largest number of differences that may be left, also of those that do not shrink: rounding never does.
MOST_LEFT = 100.0
# Rise of the temperature from which on its changes count as shares of it, K.
SMALLEST_RISE = 1.0
# Times that count as the same, share of a period.
SAME = 1e-9


@dataclasses.dataclass(frozen=True, kw_only=True)
class UntilPeriodic:
    """End a run as soon as the orbits of all joints repeat themselves: ``SolveDynamic(..., until_periodic=...)``.

    ``endTime`` of the settings says how long the run may take, at least three periods; the steps are those of the
    settings, best a whole number in a period.

    Parameters
    ----------
    period : float
        Period of the loads and motions, s: one turn of a crank, two of a four-stroke engine.
    tolerance : float
        Largest difference of the last cycle from the one before, and from the limit of the changes from cycle to
        cycle. Distances of the journal's axis at both ends, and of the journal between its thrust faces, count over
        the radial clearance. The film's temperature counts over its rise since the start of the run.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> load = mbs.CreateForce(itemNumber=shaft, loadVector=[0, -500, 0])
    >>> mbs.Assemble()
    >>> settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.2, 400
    >>> cycle = ehd.SolveDynamic(mbs, settings, until_periodic=ehd.UntilPeriodic(period=0.01, tolerance=0.01))
    >>> cycle.end < 0.2, round(cycle.end - cycle.start, 6)
    (True, 0.01)
    """

    period: float
    tolerance: float = 0.01

    def __post_init__(self) -> None:
        require_number("UntilPeriodic.period", self.period, "s", above=0.0)
        require_number("UntilPeriodic.tolerance", self.tolerance, at_least=1e-6, at_most=0.5)


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class LastCycle:
    """The cycle at whose end a run's orbits had closed.

    Attributes
    ----------
    start, end : float
        s.
    cycles : int
        Cycles that the run has taken, this one included.
    changes : (cycles - 1,) array
        Largest change of a joint from each cycle to the next, in the measure of `UntilPeriodic`.
    left : float
        Estimated distance of the last cycle from the limit, in that measure.
    histories : dict
        `JointHistory` of this cycle by the names of the joints.

    Examples
    --------
    After the example of `UntilPeriodic`:

    >>> cycle.cycles == len(cycle.changes) + 1, bool(cycle.left <= 0.01)
    (True, True)
    >>> cycle.histories["main"].minimum_gap.shape
    (21,)
    """

    start: float
    end: float
    cycles: int
    changes: np.ndarray
    left: float
    histories: Mapping[str, JointHistory]

    def __repr__(self) -> str:
        thinnest = {name: float(h.minimum_gap.min()) for name, h in self.histories.items()}
        films = ", ".join(f"'{name}' {shown('length', gap)}" for name, gap in thinnest.items())
        return (
            f"<LastCycle {self.cycles}, {self.start:.6g} to {self.end:.6g} s, {self.left:.2g} left to the limit; "
            f"minimum film thickness: {films}>"
        )


class Steps(Protocol):
    """Accepted steps of a joint, as this module uses them.

    Attributes
    ----------
    record : Record
        Record of all steps.
    """

    record: Record

    def history(self, mbs: exu.MainSystem, *, complete: bool = True) -> JointHistory:
        """Return the record of the steps, with the current state if ``complete``."""


class Closing:
    """Function after a step of Exudyn that ends a run whose orbits have closed.

    Parameters
    ----------
    films : sequence of pairs
        Names of the joints and their steps.
    aim : UntilPeriodic
    begin : float
        Start of the run, s.
    after_step : function or 0
        The user's own, called first.
    """

    def __init__(
        self,
        films: Sequence[tuple[str, Steps]],
        aim: UntilPeriodic,
        begin: float,
        after_step: Callable[..., object] | None,
    ) -> None:
        self.films, self.aim, self.begin, self.after_step = films, aim, begin, after_step
        self.changes: list[float] = []
        self.left = math.inf
        self.cycles = 0
        self.last = begin

    def __call__(self, mbs: exu.MainSystem, time: float) -> bool:
        """Return whether the run goes on after the step to ``time``."""
        goes_on = bool(self.after_step(mbs, time)) if self.after_step else True
        # joints have recorded the steps before this one
        self.look(mbs, self.last)
        self.last = time
        return goes_on and not self.closed

    @property
    def closed(self) -> bool:
        """Return whether the last whole cycle is close enough to the one before and to the limit."""
        return bool(self.changes) and max(self.changes[-1], self.left) <= self.aim.tolerance

    def look(self, mbs: exu.MainSystem, time: float, *, complete: bool = False) -> None:
        """Compare the cycle that has ended by ``time``, if one has; its end is the state now if ``complete``."""
        period = self.aim.period
        if self.closed or time < self.begin + (self.cycles + 1 - SAME) * period:
            return
        self.cycles += 1
        if self.cycles == 1:
            return
        end = self.begin + self.cycles * period
        histories = [steps.history(mbs, complete=complete) for _, steps in self.films]
        change = max(_change(history, self.begin, end, period) for history in histories)
        quotient = change / self.changes[-1] if self.changes and self.changes[-1] > 0.0 else 1.0
        self.left = change * (quotient / (1.0 - quotient) if quotient < MOST_LEFT / (1.0 + MOST_LEFT) else MOST_LEFT)
        self.changes.append(change)

    def last_cycle(self, mbs: exu.MainSystem) -> LastCycle:
        """The cycle that has closed, behind the run.

        Raises
        ------
        RunError
            If none has.
        """
        time = mbs.systemData.GetTime()
        self.look(mbs, time, complete=True)
        if not self.closed:
            changes = ", ".join(f"{change:.2g}" for change in self.changes[-5:]) or "none"
            raise RunError(
                f"SolveDynamic.until_periodic: the orbits have not closed to {self.aim.tolerance:g} within "
                f"{self.cycles} cycles of {self.aim.period:.6g} s, up to t = {time:.9g} s; the last changes from cycle "
                f"to cycle are {changes} (clearances, or rises of the film's temperature), {self.left:.2g} are left to "
                "the limit. If they shrink, give a later endTime; if they do not, the motion has another period or "
                "none, as in whirl, or what wears or dries never repeats. joint.history holds all steps."
            )
        end = self.begin + self.cycles * self.aim.period
        start = end - self.aim.period
        return LastCycle(
            start=start,
            end=end,
            cycles=self.cycles,
            changes=np.array(self.changes),
            left=self.left,
            histories={name: steps.history(mbs).between(start, end) for name, steps in self.films},
        )


def closing(
    mbs: exu.MainSystem, films: Sequence[tuple[str, Steps]], aim: UntilPeriodic, settings: exu.SimulationSettings
) -> AbstractContextManager[Closing]:
    """End the run within when its orbits have closed; the user's function comes back then."""
    run = settings.timeIntegration
    if not films:
        raise InputError("SolveDynamic.until_periodic: the system has no lubricated joints whose orbits could close.")
    for name, steps in films:
        if steps.record.is_thinned:
            raise InputError(
                f"SolveDynamic.until_periodic compares all steps of a cycle, and joint '{name}' keeps some of them; "
                "leave out Every and Period of its record (File alone keeps memory small, too)."
            )
    if run.endTime - run.startTime < (3.0 - SAME) * aim.period:
        raise InputError(
            f"SolveDynamic.until_periodic: the run must have room for three periods of {aim.period:.6g} s, got "
            f"{run.startTime:.6g} to {run.endTime:.6g} s; endTime says how long it may take."
        )
    return hooked(mbs, "PostStep", lambda own: Closing(films, aim, run.startTime, own))


def _change(history: JointHistory, begin: float, end: float, period: float) -> float:
    """Largest change of an orbit from the cycle before to that which ends at ``end``."""
    last = history.between(end - period, end)
    if last.time.size < 2:
        return math.inf
    before = np.maximum(last.time - period, history.time[0])
    orbit = CubicHermiteSpline(history.time, history.motion[:, :4], history.motion[:, 4:8])
    moved = last.motion[:, :4] - orbit(before)
    half = 0.5 * history.length
    ends = [np.hypot(*(moved[:, :2] + side * moved[:, 2:]).T) for side in (-half, half)]
    place = history.axial_position
    if np.isfinite(place).all():
        ends.append(last.axial_position - np.interp(before, history.time, place))
    change = float(np.abs(ends).max()) / history.radial_clearance
    warm = history.film_temperature
    if not np.isfinite(warm).all():
        return change
    first = float(np.interp(begin, history.time, warm))
    rise = max(float(np.abs(last.film_temperature - first).max()), SMALLEST_RISE)
    return max(change, float(np.abs(last.film_temperature - np.interp(before, history.time, warm)).max()) / rise)


class RunProgress:
    """Function after a step of Exudyn.

    Parameters
    ----------
    settings : exudyn.SimulationSettings
    films : sequence of pairs
        Names of the joints and their steps.
    after_step : function or None
        The user's own, called first.
    """

    def __init__(
        self,
        settings: exu.SimulationSettings,
        films: Sequence[tuple[str, Steps]],
        after_step: Callable[[exu.MainSystem, float], object] | None,
    ) -> None:
        run = settings.timeIntegration
        self.films, self.after_step = films, after_step
        self.start, self.span = run.startTime, run.endTime - run.startTime
        self.line: Progress | None = None
        self.steps, self.last = 0, (0, 0.0)

    def __call__(self, mbs: exu.MainSystem, t: float) -> bool:
        """Return whether the run goes on after the step to ``t``."""
        goes_on = bool(self.after_step(mbs, t)) if self.after_step else True
        if self.line is None:
            # kernels are compiled before the first call, which is behind the initial state
            self.line, self.last = Progress("exudyn_ehd"), (0, time.perf_counter())
            return goes_on
        self.steps += 1
        if self.line.is_due:
            now = time.perf_counter()
            rate = (self.steps - self.last[0]) / (now - self.last[1])
            self.last = self.steps, now
            self.line.tell((t - self.start) / self.span, f", t = {t:.4g} s, {rate:.3g} steps/s{self._worst()}")
        return goes_on

    def close(self) -> None:
        """Take the line away."""
        if self.line is not None:
            self.line.close()

    def _worst(self) -> str:
        """The thinnest film, in words."""
        films = [(steps.record.thinnest, name) for name, steps in self.films]
        gap, name = min(((gap, name) for gap, name in films if np.isfinite(gap)), default=(np.nan, ""))
        return f", minimum film thickness {shown('length', gap)} in '{name}'" if name else ""


@contextmanager
def run_progress(
    mbs: exu.MainSystem, settings: exu.SimulationSettings, films: Sequence[tuple[str, Steps]]
) -> Iterator[None]:
    """Show the progress of the run within, unless Exudyn's own does; the user's function comes back then."""
    if not is_shown() or settings.timeIntegration.verboseMode > 0:
        yield
        return
    with hooked(mbs, "PostStep", lambda own: RunProgress(settings, films, own)) as progress:
        try:
            yield
        finally:
            progress.close()
