"""The film element: force and exact Jacobian of a film between two marker frames, for an ObjectGenericODE2.

The element has no mass and shares the nodes of the two bodies. Its user functions get the coordinates q (without
reference values) and q_t of those nodes, housing's first, and return the generalized force Q on the right-hand side and
the derivative of -Q. The film is evaluated once per state; the record of accepted steps is advanced from the force
user function alone, when the start of the step has moved on, so that a rejected step leaves nothing behind.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import advice
from exudyn_ehd.coupling.contract import Evaluation, JointModel, Side
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, read_state
from exudyn_ehd.coupling.record.display import FilmDisplay
from exudyn_ehd.coupling.record.films import FilmRecorder
from exudyn_ehd.coupling.record.history import Record, eccentricity_ratios, make_row
from exudyn_ehd.coupling.watch import solver_state
from exudyn_ehd.coupling.watch.chatter import ChatterWatch
from exudyn_ehd.coupling.watch.step_control import GapWatch
from exudyn_ehd.joint.audit import ringing
from exudyn_ehd.joint.model.fields import FilmFields, film_fields
from exudyn_ehd.joint.static.steady_temperature import HOTTEST, WAY_OUT, is_too_hot
from exudyn_ehd.status import FilmError, Status

_CURRENT = exu.ConfigurationType.Current
_START_OF_STEP = exu.ConfigurationType.StartOfStep
# Largest eccentricity ratio of an accepted step in a rigid bore: contacts that give way by more than the clearance are none.
DEEPEST = 2.0


class Trial:
    """One state handed to the film, and what came back; ``evaluation`` is None if the film was not asked."""

    __slots__ = ("evaluation", "memory", "motion", "q", "q_t", "status", "step")

    def __init__(
        self,
        q: list[float],
        q_t: list[float],
        memory: Any,
        step: float,
        motion: np.ndarray,
        evaluation: Evaluation | None,
    ) -> None:
        self.q = q
        self.q_t = q_t
        self.memory = memory
        self.step = step
        self.motion = motion
        self.evaluation = evaluation
        if evaluation is not None:
            self.status = evaluation.status
        else:
            self.status = Status.NO_FILM if np.all(np.isfinite(q)) else Status.NOT_FINITE


class FilmElement:
    """Film between two sides.

    Parameters
    ----------
    model : JointModel
        The film.
    housing, journal : NodeSide or MarkerSide
        Carriers of the joint frame and of the journal's frame (z = its axis).
    name : str
        For messages.
    """

    def __init__(self, model: JointModel, housing: Side, journal: Side, name: str) -> None:
        self.model = model
        self.sides = (housing, journal)
        self.name = name
        self.evaluations = 0
        self.latest: Evaluation | None = None
        self.recorder: FilmRecorder | None = None
        self.display = FilmDisplay(self)
        self.watch: GapWatch | None = None
        self._chatter: ChatterWatch | None = None
        self._ringing: ringing.RingingWatch | None = None
        self._record = Record(model.bearing)
        self._trial: Trial | None = None
        self._start = np.nan
        self._run: tuple[Any, Any] = (self, self)
        self._solver: Any = None
        self._uses_memory = False
        self._memory: Any = None
        self._resumed: tuple[float, Any] | None = None
        # coordinates at the start of the run, and where the film was asked for last
        self._first: list[float] = []
        self._seen: list[float] = []
        self._bound = False
        self._loads = np.zeros((4, 3))

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: generalized force (n,) on the nodes; nan asks for a smaller step."""
        start = mbs.systemData.GetTime(_START_OF_STEP)
        run = solver_state.stored_solvers(mbs)
        if start != self._start or run[0] is not self._run[0] or run[1] is not self._run[1]:
            self._accept(mbs, start, run)
        trial = self._try(mbs, q, q_t, _CURRENT, t)
        if trial.status != Status.CONVERGED:
            self._fail(t, trial)
            return np.full(len(q), np.nan)
        if self.watch is not None and t > start and self.watch.rejects(trial.motion, self._solver):
            return np.full(len(q), np.nan)
        return self._generalized_force(trial)

    def jacobian(
        self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> np.ndarray:
        """User function of Exudyn: -(f_q dQ/dq + f_qt dQ/dq_t) (n, n)."""
        trial = self._try(mbs, q, q_t, _CURRENT, t)
        if trial.status != Status.CONVERGED:
            self._fail(t, trial)
            return np.full((len(q), len(q)), np.nan)
        return self._jacobian(mbs, trial, f_q, f_qt)

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        """Q (n,) at the trial, to which the sides' arrays belong."""
        assert trial.evaluation is not None
        housing, journal = self.sides
        relative.global_loads(housing.frame, journal.frame, trial.evaluation.wrench, self._loads)
        force = np.empty(len(trial.q))
        relative.generalized_force(housing.jac, journal.jac, self._loads, force)
        return force

    def _try(
        self, mbs: exu.MainSystem, q: list[float], q_t: list[float], configuration: exu.ConfigurationType, time: float
    ) -> Trial:
        """Evaluate the film at a state, unless it is the last one evaluated; bring the sides' arrays there."""
        # a list compares as a whole; other callers than Exudyn may hand over arrays
        q, q_t = list(q), list(q_t)
        # before the start of the step (a linearisation about the initial state after a run) nothing is remembered
        memory = self._memory if time >= self._start else None
        step = 0.0 if memory is None else time - self._start
        last = self._trial
        if last is not None and last.q == q and last.q_t == q_t and last.step == step and last.memory is memory:
            return last
        motion = self._move(mbs, q, q_t, configuration)
        self._seen = q
        evaluation = None
        # a sum is finite only if all its terms are
        if np.isfinite(motion.sum()):
            evaluation = self.model.evaluate(motion, memory, step, self._spin() if self.model.needs_spin else 0.0)
            self.evaluations += 1
        self.latest = evaluation
        self._trial = Trial(q, q_t, memory, step, motion, evaluation)
        return self._trial

    def _move(
        self, mbs: exu.MainSystem, q: list[float], q_t: list[float], configuration: exu.ConfigurationType
    ) -> np.ndarray:
        """Motion (10,) at a state, to which the sides' frames and Jp, Jr are brought."""
        return self._move_rigid(mbs, np.array(q), np.array(q_t), configuration)

    def _move_rigid(
        self, mbs: exu.MainSystem, qv: np.ndarray, qv_t: np.ndarray, configuration: exu.ConfigurationType
    ) -> np.ndarray:
        if not self._bound:
            self._bind(mbs)
        housing, journal = self.sides
        n = housing.size
        housing.update(mbs, qv[:n], qv_t[:n], configuration)
        journal.update(mbs, qv[n:], qv_t[n:], configuration)
        motion = np.empty(10)
        relative.relative_motion(housing.frame, journal.frame, motion)
        return motion

    def _spin(self) -> float:
        """Angle of the journal against the housing about the bearing's axis [rad], 0 in the reference configuration."""
        housing, journal = self.sides
        turn = housing.frame[:, :3].T @ journal.frame[:, 0]
        return math.atan2(turn[1], turn[0])

    def _bind(self, mbs: exu.MainSystem) -> None:
        for side in self.sides:
            if isinstance(side, MarkerSide):
                side.bind(mbs)
        self._bound = True

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """-(f_q dQ/dq + f_qt dQ/dq_t) (n, n) at the trial."""
        stiffness, damping = self._derivatives(mbs, trial)
        return -(f_q * stiffness + f_qt * damping)

    def _derivatives(self, mbs: exu.MainSystem, trial: Trial) -> tuple[np.ndarray, np.ndarray]:
        """dQ/dq and dQ/dq_t (n, n) at the trial, to which the sides' arrays belong."""
        assert trial.evaluation is not None
        stiffness, damping, _, _ = self._rigid_derivatives(mbs, trial, np.ascontiguousarray(trial.evaluation.tangent()))
        return stiffness, damping

    def _rigid_derivatives(
        self, mbs: exu.MainSystem, trial: Trial, tangent: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """dQ/dq and dQ/dq_t (n, n) of the two sides for a tangent (6, 10), and the motion's derivatives (10, n)."""
        assert trial.evaluation is not None
        housing, journal = self.sides
        n_h, n = housing.size, housing.size + journal.size
        q, q_t = np.array(trial.q[:n]), np.array(trial.q_t[:n])
        relative.global_loads(housing.frame, journal.frame, trial.evaluation.wrench, self._loads)
        housing.vary(mbs, q[:n_h], q_t[:n_h])
        journal.vary(mbs, q[n_h:], q_t[n_h:])
        motion_q, motion_qt = np.empty((10, n)), np.empty((10, n))
        relative.motion_variation(housing.frame, journal.frame, housing.jac, journal.jac, motion_q, motion_qt)
        stiffness, damping = np.zeros((n, n)), np.empty((n, n))
        housing.geometric(mbs, q[:n_h], self._loads[0], self._loads[1], stiffness[:n_h, :n_h])
        journal.geometric(mbs, q[n_h:], self._loads[2], self._loads[3], stiffness[n_h:, n_h:])
        relative.tangent_matrices(
            housing.frame,
            journal.frame,
            housing.jac,
            journal.jac,
            self._loads,
            tangent,
            motion_q,
            motion_qt,
            stiffness,
            damping,
        )
        return stiffness, damping, motion_q, motion_qt

    def _fail(self, t: float, trial: Trial) -> None:
        """Return if the solver can still reject the step, else raise."""
        if not solver_state.can_reject_step(self._solver):
            raise FilmError(self._message(t, trial))

    def _message(self, t: float, trial: Trial) -> str:
        bearing = self.model.bearing
        where = f"LubricatedJoint '{self.name}' can't be evaluated at t = {t:.9g} s: "
        if not np.all(np.isfinite(trial.motion)):
            state = (
                "the state is not finite; "
                if trial.status == Status.NOT_FINITE
                else "the journal's axis has left the bearing's (tilt near 90 degrees); "
            )
        else:
            state = self._place(trial)
        explicit = (
            " An explicit solver can't repeat a step: use smaller ones, or an implicit solver."
            if solver_state.is_explicit(self._solver)
            else ""
        )
        return where + state + advice(trial.status, bearing) + explicit

    def _place(self, trial: Trial) -> str:
        bearing = self.model.bearing
        mid, largest = eccentricity_ratios(trial.motion, bearing.radial_clearance, bearing.length)
        gap = bearing.radial_clearance * (1.0 - largest)
        return (
            f"eccentricity ratio {mid:.6g} in the mid-plane, {largest:.6g} at an end, minimum gap of the rigid "
            f"surfaces {gap:.6g} m; "
        )

    def _chatter_message(self, t: float, step: float, trial: Trial, error: float) -> str:
        assert trial.evaluation is not None
        damping = -trial.evaluation.tangent()[:2, 4:6]
        largest = float(np.linalg.eigvalsh(0.5 * (damping + damping.T))[-1])
        return (
            f"LubricatedJoint '{self.name}' at t = {t:.9g} s: the explicit solver's step of {step:.3g} s is too large for this film, the "
            f"journal chatters: its last velocities miss its last displacement by {error:.3g} m; {self._place(trial)}with the journal's mass m "
            f"and the film's damping C, here about {largest:.2g} N s/m, steps must stay below 2 m / C with forward Euler and 2.8 m / C with RK44, "
            "tilting motions alike: use smaller steps, DOPRI5 with its automatic steps, or an implicit solver."
        )

    def _is_pressed_through(self, trial: Trial) -> bool:
        """Whether the journal is so deep in a rigid bore that no contact stands for it."""
        bearing = self.model.bearing
        if getattr(bearing, "bush", None) is not None:
            return False
        return eccentricity_ratios(trial.motion, bearing.radial_clearance, bearing.length)[1] > DEEPEST

    def _through_message(self, t: float, trial: Trial) -> str:
        return (
            f"LubricatedJoint '{self.name}' at t = {t:.9g} s: the journal was pressed through its contact by more than the clearance; "
            f"{self._place(trial)}check load, mass and units; give the contact more stiffness (RegularisedWall.pressure), or take smaller steps or "
            "a StepControl if the step has overshot."
        )

    def _heat_message(self, t: float, trial: Trial) -> str:
        contact = (
            "with the friction of asperities: they heat spots through which hardly any oil flows; "
            if getattr(self.model.bearing, "asperity", None) is not None and np.ndim(self._memory.temperature) > 0
            else ""
        )
        return (
            f"LubricatedJoint '{self.name}' at t = {t:.9g} s: the film is hotter than {HOTTEST:g} K, {contact}{self._place(trial)}its heat has no "
            f"way out; {WAY_OUT}"
        )

    def _accept(self, mbs: exu.MainSystem, start: float, run: tuple[Any, Any]) -> None:
        """Record the state at the start of the current step, exactly as accepted, and let the film remember it."""
        resumed = False
        if run[0] is not self._run[0] or run[1] is not self._run[1]:
            self._solver = solver_state.running_solver(self._run, run)
            self._run = run
            self._chatter = ChatterWatch(self.model.bearing) if solver_state.is_explicit(self._solver) else None
            self._ringing = self._ringing_watch()
            # the time of a static solve is a load parameter: the film is the steady one
            self._uses_memory = self.model.remembers and not solver_state.is_static(self._solver)
            goes_on = self._goes_on(mbs, start)
            if not self._uses_memory or not goes_on:
                self._memory = None
            resumed = self._resumed is not None and start == self._resumed[0]
            if resumed:
                assert self._resumed is not None
                self._memory, self._start = self._resumed[1], start
            elif not goes_on:
                self._record.clear()
                if self.recorder is not None:
                    self.recorder.begin_anew()
            self._resumed = None
        elif start < self._start:
            self._memory = None
        if self._uses_memory and self._memory is None:
            self._start = start
            self._memory = self._first_memory(mbs)
        trial = self._look(mbs, start, _START_OF_STEP)
        if self.watch is not None:
            self.watch.start(trial.motion)
        row = self._row(start, trial)
        if row is not None:
            # the row of a resumed state was recorded at the end of its step; memory sees it now as the beginning of the next
            if not resumed or start > self._record.last_time:
                self._record.append(row)
                if self.recorder is not None:
                    self.recorder.offer(start, lambda: self.fields(mbs, start, _START_OF_STEP))
            if self.display.wanted:
                self.display.take()
            if self._uses_memory and start > self._start:
                assert trial.evaluation is not None
                self._memory = trial.evaluation.history()
                self._trial = None
        last, self._start = self._start, start
        if row is not None and self._is_pressed_through(trial):
            raise FilmError(self._through_message(start, trial))
        if is_too_hot(getattr(self._memory, "temperature", None)):
            raise FilmError(self._heat_message(start, trial))
        if self._ringing is not None and row is not None:
            assert trial.evaluation is not None
            if self._ringing.take(start, float(trial.evaluation.wrench[0]), float(trial.evaluation.wrench[1])):
                watch, self._ringing = self._ringing, None
                ringing.warn(self.name, watch)
        if self._chatter is not None and row is not None and self._chatter.sees_chatter(start, trial.motion):
            raise FilmError(self._chatter_message(start, start - last, trial, self._chatter.error))

    def _goes_on(self, mbs: exu.MainSystem, start: float) -> bool:
        """Whether a run goes on with the record: it starts behind it, and elsewhere than the run before, whose end has become the initial state.

        Where nothing has moved either run starts where the other ended.
        """
        before, self._first = self._first, self._read(mbs, _START_OF_STEP)[0]
        return start > self._record.last_time and (self._first != before or self._seen == before)

    def _ringing_watch(self) -> ringing.RingingWatch | None:
        if solver_state.is_explicit(self._solver) or solver_state.is_static(self._solver):
            return None
        bearing = self.model.bearing
        return ringing.RingingWatch(2.0 * bearing.journal_radius * bearing.length)

    def _read(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> tuple[list[float], list[float]]:
        """Coordinates and rates of all nodes of the element in a configuration."""
        return read_state(mbs, self.sides, configuration)

    def _first_memory(self, mbs: exu.MainSystem) -> Any:
        q, q_t = self._read(mbs, _START_OF_STEP)
        motion = self._move(mbs, q, q_t, _START_OF_STEP)
        self._trial = None
        return self.model.initial_history(motion) if np.isfinite(motion.sum()) else None

    def _look(self, mbs: exu.MainSystem, time: float, configuration: exu.ConfigurationType) -> Trial:
        """Evaluate the film at the state that Exudyn holds in ``configuration``."""
        q, q_t = self._read(mbs, configuration)
        trial = self._try(mbs, q, q_t, configuration, time)
        if configuration != _CURRENT and any(isinstance(side, MarkerSide) for side in self.sides):
            # the markers' Jacobians were not brought to this state: never reuse it
            self._trial = None
        return trial

    def _row(self, time: float, trial: Trial) -> np.ndarray | None:
        if trial.evaluation is None or trial.status != Status.CONVERGED:
            return None
        bearing = self.model.bearing
        ratios = eccentricity_ratios(trial.motion, bearing.radial_clearance, bearing.length)
        return make_row(time, trial.motion[:10], ratios, trial.evaluation.wrench, self._quantities(trial.evaluation))

    def _quantities(self, evaluation: Evaluation) -> Mapping[str, Any]:
        """Scalars of an evaluation, to which the sides' arrays belong."""
        return evaluation.quantities()

    def current_row(self, mbs: exu.MainSystem) -> np.ndarray | None:
        """Row of the record for Exudyn's current state, None if the film can't be evaluated there."""
        time = mbs.systemData.GetTime(_CURRENT)
        return self._row(time, self._look(mbs, time, _CURRENT))

    def _accepted(self) -> Any:
        """Configuration that holds the last accepted state."""
        # during a run, and after one that an exception has ended, the current state need not be an accepted one
        return _CURRENT if self.is_idle else _START_OF_STEP

    @property
    def is_idle(self) -> bool:
        """Whether no solver is at work; after a run that an exception has ended it still seems to be."""
        return solver_state.is_finished(self._solver)

    def look_at_accepted(self, mbs: exu.MainSystem) -> tuple[float, Trial, Any]:
        """Time of the last accepted state, the film there, and the configuration; the model then holds that film's fields."""
        configuration = self._accepted()
        time = mbs.systemData.GetTime(configuration)
        return time, self._look(mbs, time, configuration), configuration

    def fields(self, mbs: exu.MainSystem, time: float, configuration: exu.ConfigurationType) -> FilmFields:
        """Fields of the film that was evaluated last, at the state in ``configuration``."""
        evaluation: Any = self.latest
        return film_fields(evaluation, time, self.bush_displacement(mbs, configuration))

    def bush_displacement(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> np.ndarray | None:
        """Displacement (k, 3) of the mesh of a bush against the housing, joint frame; None without one."""
        return None

    def remembered(self, mbs: exu.MainSystem) -> tuple[float, Any, np.ndarray]:
        """Time of the last accepted state, what the film remembers there, and the record up to it."""
        time, trial, _ = self.look_at_accepted(mbs)
        row, memory = self._row(time, trial), self._memory
        if self._uses_memory and time > self._start and row is not None:
            assert trial.evaluation is not None
            memory = trial.evaluation.history()
            self._trial = None
        return time, memory, self._record.rows(row)

    def no_rows(self) -> np.ndarray:
        """A record (0, k) without steps."""
        return self._record.rows(None)[:0]

    def resume(self, time: float, memory: Any, rows: np.ndarray) -> None:
        """Go on with ``memory`` and record in a run that starts at ``time``."""
        self._record.restore(rows)
        self._resumed = (time, memory)
        self._memory, self._trial, self._start = None, None, np.nan
        # the next run is a new one, whatever was run before
        self._run = (self, self)

    def snapshot(self, mbs: exu.MainSystem) -> Any:
        """The record, completed by the current state if that is later than the last recorded step."""
        final = None
        configuration = self._accepted()
        if mbs.systemIsConsistent:
            time = mbs.systemData.GetTime(configuration)
            if time > self._record.last_time:
                final = self._row(time, self._look(mbs, time, configuration))
        return self._record.snapshot(final)
