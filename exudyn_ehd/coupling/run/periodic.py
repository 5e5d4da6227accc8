"""Runs that end when the orbits of all joints have closed, and progress lines of runs.

A cycle is compared with the one before at the same phases. The difference of two successive cycles is smaller than the
difference from the limit: if differences d_1, d_2, ... shrink by a factor q = d_k / d_(k-1), the remaining difference
is d q / (1 - q). For a film whose temperature approaches its limit by 1 % per cycle, it is 99 times the last
difference. So a run continues until both are small. Orbit and temperatures have differences of their own, since an
orbit settles in a few cycles while its film warms up in hundreds. Of the last two factors q the larger one counts: at
first a fast change hides a slow one.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import pairwise
from typing import ClassVar

import exudyn as exu
import numpy as np
import scipy

from exudyn_ehd.coupling.exudyn_solvers import hooked
from exudyn_ehd.coupling.kinematics.relative import JOURNAL
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.progress import Progress, is_shown
from exudyn_ehd.status import POSITIVE, ROUNDING, Checked, InputError, RunError, require_number

# Compared quantities, with upper bounds of the remaining difference over the last one, also for differences that do not
# shrink, such as round-off. Larger: runs with slow changes last longer.
MOST_LEFT = {"orbit": 100.0} | dict.fromkeys(
    ("film_temperature", "sump_temperature", "bush_temperature", "journal_temperature"), 1000.0
)
# Lower bound, K, of the temperature rise over which changes of the temperature are measured.
SMALLEST_RISE = 1.0


@dataclasses.dataclass(frozen=True, kw_only=True)
class UntilPeriodic(Checked):
    """End a run as soon as the orbits of all joints repeat themselves: ``SolveDynamic(..., until_periodic=...)``.

    ``endTime`` of the settings limits the run; leave room for four periods or more. Before the fourth cycle ends, the
    orbits only count as closed if they change by less than a hundredth of the tolerance. Choose the step size so that a
    period is a whole number of steps. If the orbits have not closed by ``endTime``, `SolveDynamic` raises a `RunError`.

    Parameters
    ----------
    period : float
        Period of the loads and motions, s: one turn of a crank, two of a four-stroke engine.
    tolerance : float, default 0.01
        Largest difference of the last cycle from the cycle before it, and largest estimated difference from the limit
        that the cycles approach; 1e-6 to 0.5. Differences of the journal's axis at both ends of the bearing, and of the
        journal's place between its thrust faces, are over the radial clearance. Differences of the temperatures of
        film, sump and walls are over their rise since the start of the run, at least 1 K. What takes more than a
        thousand cycles to warm up may still be some per cent off: start it at its final temperature, or give it less
        heat capacity, which does not change the limit.

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

    checks: ClassVar = {
        "period": partial(POSITIVE, unit="s"),
        "tolerance": partial(require_number, at_least=1e-6, at_most=0.5),
    }


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class LastCycle:
    """Result of a run with `UntilPeriodic`: its last cycle, at whose end the orbits had closed.

    Attributes
    ----------
    start, end : float
        First and last instant of the cycle, s.
    cycles : int
        Number of cycles of the run, this one included.
    changes : (cycles - 1,) array
        Largest change of all joints from each cycle to the next, measured as ``tolerance`` of `UntilPeriodic`.
    left : float
        Estimated difference of the last cycle from the limit that the cycles approach, measured alike.
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


class Closing:
    """User function after a step that ends a run whose orbits have closed.

    Parameters
    ----------
    joints : sequence of Joint
        All of a system.
    aim : UntilPeriodic
    settings : exudyn.SimulationSettings
    """

    def __init__(self, joints: Sequence[Joint], aim: UntilPeriodic, settings: exu.SimulationSettings) -> None:
        run, where = settings.timeIntegration, "SolveDynamic.until_periodic"
        if not joints:
            raise InputError(f"{where}: the system has no lubricated joints whose orbits could close.")
        for joint in joints:
            if joint.element.kinematics is not JOURNAL or getattr(joint.bearing, "thrust", None) is joint.bearing:
                raise InputError(
                    f"{where}: joint '{joint.name}' holds a ball or a thrust pad, whose record has no orbit; leave out "
                    "until_periodic."
                )
            if joint.element.steps.record.is_thinned:
                raise InputError(
                    f"{where} compares all steps of a cycle, and joint '{joint.name}' keeps some of them; leave out "
                    "Every and Period of its record (File alone keeps memory small, too)."
                )
        if run.endTime - run.startTime < (3.0 - ROUNDING) * aim.period:
            raise InputError(
                f"{where}: the run must have room for three periods of {aim.period:.6g} s, got {run.startTime:.6g} to "
                f"{run.endTime:.6g} s; endTime says how long it may take."
            )
        self.films = {joint.name: joint.element.steps for joint in joints}
        self.aim, self.begin, self.last = aim, run.startTime, run.startTime
        self.changes: list[float] = []
        self.left = math.inf
        # last changes of every quantity of every joint
        self._past: dict[tuple[str, str], list[float]] = {}

    def after_step(self, own: Callable[..., object], mbs: exu.MainSystem, time: float) -> bool:
        """Return whether the run goes on after the step to ``time``; the user's function is called first."""
        goes_on = bool(own(mbs, time))
        # joints have recorded the steps before this one
        self.look(mbs, self.last)
        self.last = time
        return goes_on and not self.closed

    @property
    def cycles(self) -> int:
        """Number of whole cycles that were compared, the first one included."""
        return len(self.changes) + 1

    @property
    def closed(self) -> bool:
        """Return whether the last whole cycle is close enough to the one before and to the limit."""
        return bool(self.changes) and max(self.changes[-1], self.left) <= self.aim.tolerance

    def look(self, mbs: exu.MainSystem, time: float, *, complete: bool = False) -> None:
        """Compare the cycle that has ended by ``time``, if one has; its end is the state now if ``complete``."""
        period, cycles = self.aim.period, self.cycles + 1
        if self.closed or time < self.begin + (cycles - ROUNDING) * period:
            return
        end = self.begin + cycles * period
        self.left, largest = 0.0, 0.0
        for name, steps in self.films.items():
            for what, change in _changes(steps.history(mbs, complete=complete), self.begin, end, period).items():
                past = self._past[name, what] = [*self._past.get((name, what), [])[-2:], change]
                self.left = max(self.left, _left(past, MOST_LEFT[what]))
                largest = max(largest, change)
        self.changes.append(largest)

    def last_cycle(self, mbs: exu.MainSystem) -> LastCycle:
        """Return the last cycle, after the run.

        Raises
        ------
        RunError
            If the orbits have not closed.
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
            histories={name: steps.history(mbs).between(start, end) for name, steps in self.films.items()},
        )


def _left(changes: Sequence[float], most: float) -> float:
    """Difference from the limit of cycles with these last changes, up to three; at most ``most`` times the last one."""
    quotients = [b / a if a > 0.0 else 1.0 for a, b in pairwise(changes)] + [1.0] * (3 - len(changes))
    slowest = max(quotients)
    return changes[-1] * (slowest / (1.0 - slowest) if slowest < most / (1.0 + most) else most)


def _changes(history: JointHistory, begin: float, end: float, period: float) -> dict[str, float]:
    """Largest changes of an orbit and of temperatures from the previous cycle to the cycle that ends at ``end``."""
    last = history.between(end - period, end)
    if last.time.size < 2:
        return {"orbit": math.inf}
    before = np.maximum(last.time - period, history.time[0])
    orbit = scipy.interpolate.CubicHermiteSpline(history.time, history.motion[:, :4], history.motion[:, 4:8])
    moved = last.motion[:, :4] - orbit(before)
    half = 0.5 * history.length
    ends = [np.hypot(*(moved[:, :2] + side * moved[:, 2:]).T) for side in (-half, half)]
    place = history.axial_position
    if np.isfinite(place).all():
        ends.append(last.axial_position - np.interp(before, history.time, place))
    out = {"orbit": float(np.abs(ends).max()) / history.radial_clearance}
    for name in [*MOST_LEFT][1:]:
        warm, now = getattr(history, name), getattr(last, name)
        if np.isfinite(warm).all():
            rise = max(float(np.abs(now - np.interp(begin, history.time, warm)).max()), SMALLEST_RISE)
            out[name] = float(np.abs(now - np.interp(before, history.time, warm)).max()) / rise
    return out


@contextmanager
def run_progress(mbs: exu.MainSystem, settings: exu.SimulationSettings, joints: Sequence[Joint]) -> Iterator[None]:
    """Context that shows the progress of a run, unless Exudyn shows it; user functions are restored at its end."""
    if not is_shown() or settings.timeIntegration.verboseMode > 0:
        yield
        return
    start, end, lines = settings.timeIntegration.startTime, settings.timeIntegration.endTime, list[Progress]()

    def after_step(own: Callable[..., object], mbs: exu.MainSystem, t: float) -> bool:
        goes_on = bool(own(mbs, t))
        for line in lines:
            line.step((t - start) / (end - start), lambda rate: f", t = {t:.4g} s, {rate:.3g} steps/s{_worst(joints)}")
        # kernels are compiled before the first call, which is behind the initial state
        lines[:] = lines or [Progress("exudyn_ehd")]
        return goes_on

    with hooked(mbs, "PostStep", after_step):
        try:
            yield
        finally:
            for line in lines:
                line.close()


def _worst(joints: Sequence[Joint]) -> str:
    """Text about the thinnest film."""
    gap, name = min(((joint.element.steps.record.thinnest, joint.name) for joint in joints), default=(math.inf, ""))
    return f", minimum film thickness {shown('length', gap)} in '{name}'" if math.isfinite(gap) else ""
