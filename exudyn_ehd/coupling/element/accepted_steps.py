"""Accepted steps of one joint: its record, and the memory of its film.

Exudyn does not report accepted steps. A step is known to be accepted when the solver's start-of-step time has changed.
The state at the new start is then evaluated once more, recorded, and checked for ringing and chatter. The film's memory
there is used in the next step. A rejected step changes neither record nor memory.

The memory of a film belongs to a state of the system. A run that starts at the end state, or at the initial state, of
the previous run begins with the film's memory at that state. The time does not matter. Static solves in between, in
which films are steady, do not change the memory.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Protocol

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import doubts, exudyn_solvers
from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, JointModel, Side, Trial
from exudyn_ehd.coupling.element.failures import Failures
from exudyn_ehd.coupling.element.outer_load import OuterLoad
from exudyn_ehd.coupling.exudyn_solvers import GapWatch
from exudyn_ehd.coupling.items.objects import Presence
from exudyn_ehd.coupling.record.history import MINIMUM_GAP, PEAK_PRESSURE, JointHistory
from exudyn_ehd.coupling.record.record import FilmRecorder, Record
from exudyn_ehd.joint.audit.resolution import LIMIT, RingingWatch, warn_of_ringing
from exudyn_ehd.joint.balance.limits import HOT, lacks_oil
from exudyn_ehd.joint.model.results import FilmFields
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.time_step import StepStart, next_start
from exudyn_ehd.status import OverloadWarning, Status, warn_user

# Largest difference, over a step, between the start of a run and the end of the previous one, up to which the run
# continues it. The sum of a million steps has a round-off of 1e-4 of a step.
SAME_TIME = 1e-3


class SteppedElement(Protocol):
    """Interface of a joint's element for `AcceptedSteps`.

    Attributes
    ----------
    model : JointModel
    sides : pair of Side
        Carriers of the joint frame and of the journal's frame.
    failures : Failures
    outer : OuterLoad
    presence : Presence
    is_massless : bool
        True if the element has additional coordinates without mass, which explicit solvers do not support.
    """

    model: JointModel
    sides: tuple[Side, Side]
    failures: Failures
    outer: OuterLoad
    is_massless: bool
    presence: Presence

    def read(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> tuple[list[float], list[float]]:
        """Coordinates and rates of all nodes of the element."""

    def look(self, mbs: exu.MainSystem, time: float, configuration: exu.ConfigurationType) -> Trial:
        """Evaluate the film at Exudyn's state in ``configuration``."""

    def motion(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> np.ndarray:
        """Motion of the journal at the state in ``configuration``, without evaluating the film."""

    def row(self, time: float, trial: Trial) -> np.ndarray | None:
        """Row of the record; None without a film."""

    def fields(self, time: float, trial: Trial, configuration: exu.ConfigurationType) -> FilmFields:
        """Fields of the film at a trial, which must be the last one."""

    def forget(self) -> None:
        """Drop the last evaluation, so that the film is evaluated again at the next state."""


class AcceptedSteps:
    """Record, memory and checks of the accepted steps of one joint.

    Parameters
    ----------
    film : SteppedElement
        The element.

    Attributes
    ----------
    start : float
        Time of the last accepted step, s; nan before the first.
    began : float
        Time at which the last run began, s.
    solvers : pair
        Exudyn's stored solvers in the run under way, see `exudyn_solvers.stored_solvers`.
    solver : object or None
        The running one of them.
    memory : History or None
        Memory of the film at ``start``; it is kept unchanged during static solves. None for a film without memory.
    asked : (float, list of float)
        Time and coordinates of the last call by a solver.
    begin : StepStart or None
        Start of the present step; None if the film uses the velocities without correction.
    control : GapWatch or None
        Rejects steps that are too coarse.
    record : Record
        Record of the accepted steps.
    recorder : FilmRecorder or None
        Recorder of films.
    observers : list of functions
        Functions that are called with every accepted trial that has a film.
    in_own_run : bool
        True during a run that was started by a function of this package, such as `SolveDynamic`.
    unseen : int
        Number of successive steps by a solver that is not stored in ``mbs.sys``.
    tolerance : float or None
        Newton's absolute tolerance of the settings, if the run raises it because of the round-off of meshes.
    chosen : bool
        True if the present run chooses its steps by their error.
    tangent : (m,) array or None
        `recorded_entries` of the last tangent of the film's wrench in Newton's method of an implicit run.
    """

    def __init__(self, film: SteppedElement) -> None:
        # weak reference, since the element refers to its steps: without a cycle it is freed with its system
        self.film: SteppedElement = weakref.proxy(film)
        self.start = self.began = np.nan
        self.solver: exudyn_solvers.Solver | None = None
        self.control: GapWatch | None = None
        self.recorder: FilmRecorder | None = None
        self.observers: list[Callable[[Trial], None]] = []
        self.record = Record(film.model.bearing)
        self._uses_memory = self.in_own_run = self.chosen = False
        self.unseen = 0
        self.tangent: np.ndarray | None = None
        self.tolerance: float | None = None
        self._told = True
        self.asked: tuple[float, list[float]] = (np.nan, [])
        self.forget()

    def forget(self) -> None:
        """Let the next run start with a new record and a film without memory."""
        self._resumed: tuple[float, History | None, StepStart | None] | None = None
        # coordinates and memory where the run began
        self._first: list[float] = []
        self._first_memory: History | None = None
        self.memory: History | None = None
        self.begin: StepStart | None = None
        self.start = np.nan
        self.record.clear()
        # the next run is a new one, whatever was run before
        self.solvers = exudyn_solvers.NO_RUN
        self.film.forget()

    def accept(self, mbs: exu.MainSystem, start: float, solvers: exudyn_solvers.Stored) -> None:
        """Record the state at the start of the current step as accepted.

        Raises
        ------
        FilmError
            If the film at that state ends the run.
        """
        # without a stored solver a new run is recognised by a time that runs back
        begins = solvers != self.solvers or start < self.start
        resumed = begins and self._begin_run(mbs, start, solvers)
        self.unseen = 0 if begins or not self.is_idle else self.unseen + 1
        if self.unseen == 2:
            exudyn_solvers.warn_unknown(self.film.failures.name)
        if self._uses_memory and self.memory is None:
            self.start = start
            motion = self.film.motion(mbs, START_OF_STEP)
            self.memory = self.film.model.initial_history(motion) if np.isfinite(motion.sum()) else None
        trial, row = self._look(mbs, start, START_OF_STEP)
        self.begin = self._begin_of_next(start, trial)
        if self.control is not None:
            self.control.start(trial, np.nan if row is None else row[MINIMUM_GAP])
        if row is not None:
            # a resumed state was recorded at the end of its step
            if not resumed or start > self.record.last_time:
                self.record.append(row)
                if self.recorder is not None:
                    self.recorder.offer(start, lambda: self.film.fields(start, trial, START_OF_STEP))
            for observe in self.observers:
                observe(trial)
            if start > self.start:
                if self._uses_memory:
                    self.memory = trial.found.history()
                    self.film.forget()
                if begins:
                    self._first_memory = self.memory
        last, self.start = self.start, start
        self._check(start, trial, start - last, row)

    def _look(
        self, mbs: exu.MainSystem, time: float, configuration: exu.ConfigurationType
    ) -> tuple[Trial, np.ndarray | None]:
        """Evaluate the film at an accepted state, with the load on it; return the trial and its row of the record."""
        trial = self.film.look(mbs, time, configuration)
        self.film.outer.take(mbs, configuration, trial)
        return trial, self.film.row(time, trial)

    def _begin_run(self, mbs: exu.MainSystem, start: float, solvers: exudyn_solvers.Stored) -> bool:
        """Prepare for the run of a new solver; return whether the run continues from a stored state."""
        self.film.presence.require(mbs)
        film, place, before = self.film, self.film.read(mbs, START_OF_STEP)[0], self._first
        # the run continues the record if its time is later and its state is not the start of the previous run; if
        # nothing has moved in that run, its start is its end as well
        goes_on = start > self.record.last_time and (place != before or self.asked[1] == before)
        resumed = self._resumed is not None and start == self._resumed[0]
        solver = self.solver if solvers == self.solvers else exudyn_solvers.running_solver(self.solvers, solvers)
        if self._resumed is None and place == before and not goes_on:
            memory, self.begin, self.start = self._first_memory, None, start
        else:
            memory = self._take_up(mbs, start, place, solver)
        self.solver, self.solvers = solver, solvers
        if exudyn_solvers.is_explicit(self.solver) and film.is_massless:
            raise film.failures.no_mass()
        # in a static solve time is a load parameter, and the film is the steady one
        self._uses_memory = film.model.remembers and not exudyn_solvers.is_static(self.solver)
        self._watch_anew(mbs)
        self.film.outer.begin(self.solver)
        self.tangent = self.tolerance = None
        self.memory = self._first_memory = memory
        self._first, self.began, self.asked = place, start, (start, place)
        film.failures.refused = film.failures.refused if self.in_own_run else {}
        if not resumed and not goes_on:
            self.record.clear()
            if self.recorder is not None:
                self.recorder.begin_anew()
        return resumed

    def _watch_anew(self, mbs: exu.MainSystem) -> None:
        """Reset the checks of films, forces and steps for a new run; every warning is given once per run."""
        bearing, solver = self.film.model.bearing, self.solver
        self._chatter = doubts.ChatterWatch(bearing) if exudyn_solvers.is_explicit(solver) else None
        area = 2.0 * bearing.journal_radius * bearing.length
        may_ring = solver is None or exudyn_solvers.is_implicit(solver)
        self._ringing = RingingWatch(area) if may_ring else None
        self._turning = doubts.TurnWatch(mbs, self.film.sides, solver)
        doubts.warn_of_radius(solver)
        self._may_starve = self._uses_memory and lacks_oil(bearing)
        self._thin, self._told, self._overloaded = doubts.smooth_limit(bearing), False, False
        self._cool, self._grid = HOT, doubts.GridWatch()

    def _take_up(
        self, mbs: exu.MainSystem, start: float, place: list[float], solver: exudyn_solvers.Solver | None
    ) -> History | None:
        """Return the memory for a run that continues from a stored state, or from the end of the previous run.

        Sets ``start`` and ``begin`` of its first step. For a run that continues the last one in time, these are those
        of the last step, whose end has still to be accepted.
        """
        film, memory, last = self.film, self.memory, self.start
        if self._resumed is not None:
            (time, memory, begin), self._resumed = self._resumed, None
            self.start, self.begin = start, begin if start == time else None
            return memory
        end = last
        if exudyn_solvers.is_finished(self.solver):
            end = self.asked[0] if self.solver is None else self.solver.it.currentTime
        static = exudyn_solvers.is_static(self.solver) or exudyn_solvers.is_static(solver)
        if not static and abs(start - end) <= SAME_TIME * (end - last):
            return memory
        if memory is not None:
            # explicit solvers do not evaluate the film at the end of a step
            if place != self.asked[1] and not exudyn_solvers.is_explicit(self.solver):
                film.failures.warn_of_memory(start, end)
            if self._uses_memory and end > last:
                trial = film.look(mbs, end, START_OF_STEP)
                if trial.evaluation is not None and trial.status == Status.CONVERGED:
                    memory = trial.evaluation.history()
                film.forget()
        self.start, self.begin = start, None
        return memory

    def _begin_of_next(self, time: float, trial: Trial) -> StepStart | None:
        """Return the start of the next step; None if the solver's formulas or the state's motion are unknown."""
        known = trial.status == Status.CONVERGED or np.isfinite(trial.bodies.sum())
        if not (known and exudyn_solvers.is_implicit(self.solver)):
            return None
        return next_start(self.begin, trial.bodies, time, self.film.model.bearing.radial_clearance)

    def _check(self, start: float, trial: Trial, step: float, row: np.ndarray | None) -> None:
        """Raise `FilmError` for a film that ends the run; warn of dry or thin films and of forces that ring."""
        failures = self.film.failures
        if trial.status == Status.NO_PRESSURE and (step > 0.0 or exudyn_solvers.is_implicit(self.solver)):
            raise failures.no_film(start, trial, explicit=False)
        if row is not None and (absurd := failures.absurd(start, row, trial)) is not None:
            raise absurd
        self._cool = failures.check_heat(start, trial, self.film_memory, self._cool)
        if self._may_starve and self.memory is not None and (lost := doubts.lost_share(self.memory)) > 0.0:
            self._may_starve = False
            doubts.warn_of_starvation(failures.name, start, lost)
        self._turning.take(failures.name, start)
        if row is None:
            return
        self._warn_of_film(start, trial, row)
        if self._ringing is not None:
            force = trial.found.wrench[: failures.axes].tolist()
            rang = self._ringing.most >= LIMIT
            if self._ringing.take(start, *force) and not rang:
                warn_of_ringing(failures.name, self._ringing, starts_well=self.in_own_run)
            if self._ringing.throws:
                raise failures.thrown(start, trial, *self._ringing.worst)
        if self._chatter is not None and self._chatter.sees_chatter(start, trial.motion):
            raise failures.chatter(start, trial, step=step, miss=self._chatter.error)

    def _warn_of_film(self, start: float, trial: Trial, row: np.ndarray) -> None:
        """Warn, once per run, of a film that is too thin for smooth surfaces or has too high a pressure."""
        failures = self.film.failures
        self._grid.take(start, row[PEAK_PRESSURE], getattr(trial.found, "film", None))
        if (gap := row[MINIMUM_GAP]) < self._thin:
            self._thin = -np.inf
            doubts.warn_of_thin_film(failures.name, start, gap, failures.tilting(trial.motion))
        if not self._overloaded and failures.overload(row) > 1.0:
            self._overloaded = True
            warn_user(failures.overloaded(start, row, trial.motion), OverloadWarning)

    @property
    def film_memory(self) -> History | None:
        """Memory of the film in the present run; None for a steady film."""
        return self.memory if self._uses_memory else None

    @property
    def is_idle(self) -> bool:
        """Return whether no solver is running; False after a run that an exception has ended."""
        return exudyn_solvers.is_finished(self.solver)

    @property
    def _accepted(self) -> exu.ConfigurationType:
        # during a run, and after a run that ended with an exception, the current state may not be an accepted one
        return CURRENT if self.is_idle else START_OF_STEP

    def look_at_accepted(self, mbs: exu.MainSystem) -> tuple[float, Trial, exu.ConfigurationType]:
        """Time of the last accepted state, the film there, and the configuration of this state."""
        configuration = self._accepted
        time = mbs.systemData.GetTime(configuration)
        return time, self.film.look(mbs, time, configuration), configuration

    def remembered(self, mbs: exu.MainSystem) -> tuple[float, History | None, StepStart | None, np.ndarray]:
        """Time of the last accepted state, the film's memory there, where the next step begins, and the record."""
        time, memory = mbs.systemData.GetTime(self._accepted), self.memory
        trial, row = self._look(mbs, time, self._accepted)
        begin = self._begin_of_next(time, trial)
        if self._uses_memory and time > self.start and row is not None:
            memory = trial.found.history()
            self.film.forget()
        return time, memory, begin, self.record.rows(row)

    def resume(
        self, time: float, memory: History | None, rows: np.ndarray | None = None, begin: StepStart | None = None
    ) -> None:
        """Continue in a run from ``time`` with the given memory, record and start of the next step; default: none."""
        self.forget()
        if rows is not None:
            self.record.restore(rows)
        self._resumed = (time, memory, begin)

    def tell(self, mbs: exu.MainSystem) -> None:
        """Log the summary line of the finished run, once, and write its record to its file, if it has one.

        For explicit solvers and for a run with steps chosen by error, repeated steps are normal: the line omits them.
        """
        self.record.write()
        if self._told:
            return
        self._told = True
        failures, bearing, history = self.film.failures, self.film.model.bearing, self.history(mbs)
        self._grid.tell(failures.name)
        doubts.warn_of_tiny_forces(failures.name, self.solver, self.tolerance, bearing, history)
        if doubts.is_on() and history.time.size > 1:
            why = () if self.chosen or exudyn_solvers.is_explicit(self.solver) else failures.refused.values()
            doubts.LOGGER.info("%s", doubts.line(failures.name, bearing, history, why))

    def history(self, mbs: exu.MainSystem, *, complete: bool = True) -> JointHistory:
        """Return the record, completed by the end of the run or by the current state if it is later.

        Warns if that state has no film.
        """
        if self.solver is not None and self.is_idle:
            self.tell(mbs)
        if complete and mbs.systemIsConsistent:
            self._look_at_end(mbs)
        return self.record.snapshot(self.record.end)

    def _look_at_end(self, mbs: exu.MainSystem) -> None:
        """Store the row of the current state, unless it is recorded already or was changed after the run."""
        time, solver = mbs.systemData.GetTime(self._accepted), self.solver if self.is_idle else None
        known = solver is not None and (self.record.end is not None or time != solver.it.currentTime)
        if known or time <= self.record.last_time:
            return
        trial, self.record.end = self._look(mbs, time, self._accepted)
        if self.record.end is None and self.is_idle:
            self.film.failures.warn_of_end(time, trial)
