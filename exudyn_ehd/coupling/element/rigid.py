"""The film element: force and exact Jacobian of a joint's films between two marker frames, for an ObjectGenericODE2.

The element has no mass and shares the nodes of the two bodies. Its user functions get the coordinates q (without
reference values) and q_t of those nodes, housing's first, and return the generalized force Q on the right-hand side and
the derivative of -Q. The film is evaluated once per state. `accepted_steps` records accepted steps, triggered by the
force user function alone; `failures` has the messages for films that cannot be evaluated.

Films on end faces are evaluated together with the journal's film. If that has one temperature, they have the same;
with a temperature field they have that of the oil that left it at the start of the step. They have no other memory, and
use the velocities as rates. Their heat is part of the heat balance of accepted steps. Their wrench acts on journal and
housing, also if the journal's film acts on a flexible bush.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import exudyn_solvers
from exudyn_ehd.coupling.contract import CURRENT, START_OF_STEP, Index, JointEvaluation, JointModel, Side, Trial
from exudyn_ehd.coupling.element.accepted_steps import AcceptedSteps
from exudyn_ehd.coupling.element.failures import Failures
from exudyn_ehd.coupling.element.outer_load import OuterLoad
from exudyn_ehd.coupling.items.objects import Presence
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.relative import eccentricity_ratios
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, derivatives_between, motion_between
from exudyn_ehd.coupling.record.history import make_row
from exudyn_ehd.joint import step_error
from exudyn_ehd.joint.model.results import FilmFields
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.thrust import ThrustModel
from exudyn_ehd.status import InputError, Status


class FilmElement:
    """Film between two sides.

    Parameters
    ----------
    model : JointModel
        The film.
    housing, journal : Side
        Carriers of the joint frame and of the journal's frame (z = its axis).
    name : str
        Name of the joint, for messages.
    bore_nodes : sequence
        Nodes of a flexible bore, whose coordinates follow those of housing and journal.

    Attributes
    ----------
    steps : AcceptedSteps
    presence : Presence
        Set once the element is in a system.
    faces : ThrustModel or None
        Films on the end faces.
    collars : Kinematics
        Kinematics of the motion (11,) for the faces; without faces that of the journal.
    failures : Failures
    is_massless : bool
        True if the element has additional coordinates with a numerical mass only.
    evaluations : int
        Number of film evaluations.
    last : Trial or None
        The state evaluated last; None if it was dropped.
    kinematics, parts, messages
        Kinematics of the film's motion, parts of the motion for errors of steps, class of its failures.
    """

    kinematics, parts, messages = relative.JOURNAL, step_error.JOURNAL, Failures

    def __init__(
        self, model: JointModel, housing: Side, journal: Side, name: str, bore_nodes: Sequence[Index] = ()
    ) -> None:
        self.model = model
        self.sides, self.bore_nodes = (housing, journal), bore_nodes
        self.failures = self.messages(name, model.bearing)
        self.is_massless = False
        self.evaluations = 0
        self.last: Trial | None = None
        self._peeked: tuple[list[float], list[float], np.ndarray] | None = None
        self.steps = AcceptedSteps(self)
        self.outer = OuterLoad(self.sides, self.parts)
        self.presence: Presence
        self.faces: ThrustModel | None = None
        self.collars = relative.JOURNAL
        # indices of the coordinates in the system's vectors, known once it is assembled
        self._places: np.ndarray | None = None

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> np.ndarray:
        """User function of Exudyn: generalized force (n,) on the nodes; nan makes Exudyn try a smaller step."""
        start, steps, solvers = mbs.systemData.GetTime(START_OF_STEP), self.steps, exudyn_solvers.stored_solvers(mbs)
        if start != steps.start or solvers != steps.solvers:
            steps.accept(mbs, start, solvers)
        trial = self._try(mbs, q, q_t, CURRENT, t, stepping=not steps.is_idle)
        if steps.solver is None or not steps.is_idle:
            self.failures.ask(steps.start, t, steps.asked[0])
            steps.asked = t, q
        if self._refuses(t, trial):
            self.failures.blame(steps.start, t, trial.status.advice.partition(";")[0])
            return np.full(len(q), np.nan)
        if steps.control is not None and t > steps.start and steps.control.rejects(trial, steps.solver):
            self.failures.blame(steps.start, t, "the gap changed by more than StepControl.largest_gap_change")
            return np.full(len(q), np.nan)
        force = self._generalized_force(trial)
        if trial.faces is not None:
            force[: self.rigid_size] += self._wrench_map() @ trial.faces.wrench
        return force

    def jacobian(
        self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> np.ndarray:
        """User function of Exudyn: -(f_q dQ/dq + f_qt dQ/dq_t) (n, n)."""
        trial = self._try(mbs, q, q_t, CURRENT, t, stepping=not self.steps.is_idle)
        if self._refuses(t, trial):
            return np.full((len(q), len(q)), np.nan)
        jacobian = self._jacobian(mbs, trial, f_q, f_qt)
        if trial.faces is not None:
            n = self.rigid_size
            jacobian[:n, :n] += self.faces_jacobian(mbs, trial, f_q, f_qt)
        return jacobian

    def _refuses(self, t: float, trial: Trial) -> bool:
        """Return whether the step has to be rejected; raise if there is no film and the step cannot be repeated.

        A film beyond the end of a pressure law is not rejected: its forces lead Newton's method back. The first iterate
        may lie there for any step size, if cavities have closed since the last step.
        """
        if trial.status == Status.CONVERGED:
            return False
        if not exudyn_solvers.can_reject_step(self.steps.solver):
            raise self.failures.no_film(t, trial, explicit=exudyn_solvers.is_explicit(self.steps.solver))
        found = trial.evaluation
        return trial.status != Status.NO_PRESSURE or found is None or not np.isfinite(found.wrench.sum())

    def _try(
        self,
        mbs: exu.MainSystem,
        q: list[float],
        q_t: list[float],
        configuration: exu.ConfigurationType,
        time: float,
        stepping: bool = True,
    ) -> Trial:
        """Return the film at a state, evaluated unless it is the last one; the sides' arrays are updated.

        ``stepping``: the state is the end of a step. Otherwise (a linearisation after a run) the film uses the
        velocities without correction.
        """
        # lists, which can be compared as a whole; other callers than Exudyn may pass arrays
        q, q_t = list(q), list(q_t)
        # no memory before the start of the step (a linearisation about the initial state after a run)
        memory = self.steps.film_memory if time >= self.steps.start else None
        step = 0.0 if memory is None else time - self.steps.start
        begin = self.steps.begin if stepping else None
        begin = begin if begin is not None and time > begin.time else None
        last = self.last
        known = last is not None and last.q == q and last.q_t == q_t and last.step == step and last.memory is memory
        if last is not None and known and last.begin is begin:
            return last
        peeked, self._peeked = self._peeked, None
        here = peeked is not None and peeked[0] == q and peeked[1] == q_t
        bodies = motion = peeked[2] if peeked is not None and here else self._move(mbs, q, q_t, configuration)
        if begin is not None:
            motion = begin.film_motion(bodies, time)
        # an interrupt may leave the model between two states, so that the last trial is not valid any more
        self.last = None
        trial = Trial(q, q_t, memory, step, begin, bodies, motion)
        # a sum is finite only if all its terms are
        if math.isfinite(trial.motion.dot(trial.motion)):
            spin = relative.angle_of(*self.frames) if self.model.needs_spin else 0.0
            trial.take(self.model.evaluate(motion, memory, step, spin))
            if self.faces is not None:
                film, seen = getattr(trial.evaluation, "film", None), memory
                if film is not None and seen is not None:
                    seen = dataclasses.replace(seen, temperature=film.temperature)
                trial.take_faces(self.faces.evaluate(self.collars.motion_of(*self.frames), seen))
            self.evaluations += 1
        self.last = trial
        return trial

    def _move(
        self, mbs: exu.MainSystem, q: list[float], q_t: list[float], configuration: exu.ConfigurationType
    ) -> np.ndarray:
        """Return the motion at a state, and update the sides' frames and Jp, Jr to it.

        It is the motion of the rigid surfaces (10,), followed by the coordinates and rates of a flexible bore (2 k,).
        """
        self._find_places(mbs)
        n = self.rigid_size
        rigid = motion_between(mbs, self.sides, np.array(q[:n]), np.array(q_t[:n]), configuration, self.kinematics)
        if not self.bore_nodes:
            return rigid
        return np.concatenate((rigid, *self._bore_motion(np.array(q[n:]), np.array(q_t[n:]))))

    def _find_places(self, mbs: exu.MainSystem) -> np.ndarray:
        """Return the indices of the element's coordinates in an assembled system; the first call binds the sides."""
        if self._places is None:
            self.presence.require(mbs)
            for side in self.sides:
                side.bind(mbs)
            places = [place for node in self.nodes for place in mbs.systemData.GetNodeLTGODE2(int(node))]
            self._places = np.array(places, dtype=int)
        return self._places

    def _bore_motion(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Convert coordinates and rates of the bore's nodes to those of the bore in the film model."""
        return q, q_t

    def _generalized_force(self, trial: Trial) -> np.ndarray:
        """Q (n,) at the trial, to which the sides' arrays belong."""
        return self._wrench_map() @ trial.found.wrench

    def _wrench_map(self) -> np.ndarray:
        """Map (n, 6) from the wrench on the journal, joint frame, to generalized forces on housing and journal."""
        return np.asarray(relative.wrench_map(*self.frames, self.sides[0].jac, self.sides[1].jac))

    def _jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """-(f_q dQ/dq + f_qt dQ/dq_t) (n, n) of the journal's film at the trial."""
        tangent = np.ascontiguousarray(trial.found.tangent())
        stiffness, damping, _, _ = self._rigid_derivatives(mbs, trial, tangent)
        return -(f_q * stiffness + f_qt * damping)

    def faces_jacobian(self, mbs: exu.MainSystem, trial: Trial, f_q: float, f_qt: float) -> np.ndarray:
        """-(f_q dQ/dq + f_qt dQ/dq_t) (n, n) of the films on the end faces at the trial; zero without them."""
        n = self.rigid_size
        if trial.faces is None:
            return np.zeros((n, n))
        state, loads = (np.array(trial.q[:n]), np.array(trial.q_t[:n])), (trial.faces.wrench, trial.faces.tangent())
        stiffness, damping, _, _ = derivatives_between(mbs, self.sides, state, *loads, self.collars)
        return -(f_q * stiffness + f_qt * damping)

    def _rigid_derivatives(
        self, mbs: exu.MainSystem, trial: Trial, tangent: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """dQ/dq and dQ/dq_t (n, n) of the two sides for a tangent (6, 10), and the motion's derivatives (10, n)."""
        if exudyn_solvers.is_implicit(self.steps.solver):
            self.steps.tangent = tangent[step_error.recorded_entries(self.parts)]
        n = self.rigid_size
        state = np.array(trial.q[:n]), np.array(trial.q_t[:n])
        return derivatives_between(mbs, self.sides, state, trial.found.wrench, tangent, self.kinematics)

    @property
    def frames(self) -> tuple[np.ndarray, np.ndarray]:
        """Frames (3, 6) of housing and journal at the state to which the sides were brought."""
        return self.sides[0].frame, self.sides[1].frame

    @property
    def nodes(self) -> list[Index]:
        """Nodes of housing, journal and bore."""
        return [*self.sides[0].nodes, *self.sides[1].nodes, *self.bore_nodes]

    @property
    def rigid_size(self) -> int:
        """Number of coordinates of housing and journal."""
        return self.sides[0].size + self.sides[1].size

    def has_result(self) -> bool:
        """Return whether the state evaluated last can be accepted as the end of a step."""
        trial = self.last
        return trial is None or not (trial.status == Status.NO_PRESSURE or self.failures.crushes(trial))

    def require_film(self, time: float) -> None:
        """Raise if the run has ended beyond the end of a pressure law, or with a film that no bearing can have."""
        trial = self.last
        if trial is not None and trial.status == Status.NO_PRESSURE:
            raise self.failures.no_film(time, trial, explicit=False)
        row = None if trial is None else self.row(time, trial)
        if row is not None and trial is not None and (absurd := self.failures.absurd(time, row, trial)) is not None:
            raise absurd

    def read(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> tuple[list[float], list[float]]:
        """Coordinates and rates of all nodes of the element in a configuration."""
        data, places = mbs.systemData, self._find_places(mbs)
        q, q_t = data.GetODE2Coordinates(configuration), data.GetODE2Coordinates_t(configuration)
        return np.asarray(q)[places].tolist(), np.asarray(q_t)[places].tolist()

    def look(self, mbs: exu.MainSystem, time: float, configuration: exu.ConfigurationType) -> Trial:
        """Evaluate the film at the state that Exudyn holds in ``configuration``."""
        q, q_t = self.read(mbs, configuration)
        trial = self._try(mbs, q, q_t, configuration, time)
        if configuration != CURRENT and any(isinstance(side, MarkerSide) for side in self.sides):
            # the markers' Jacobians were not updated to this state: the trial must not be reused
            self.forget()
        return trial

    def motion(self, mbs: exu.MainSystem, configuration: exu.ConfigurationType) -> np.ndarray:
        """Motion at Exudyn's state in ``configuration``, without evaluating the film."""
        q, q_t = self.read(mbs, configuration)
        motion = self._move(mbs, q, q_t, configuration)
        self.forget()
        if configuration == CURRENT:
            # stored, because the film is evaluated at this state next
            self._peeked = q, q_t, motion
        return motion

    def forget(self) -> None:
        """Drop the last evaluation, so that the film is evaluated again at the next state."""
        self.last = self._peeked = None

    def row(self, time: float, trial: Trial) -> np.ndarray | None:
        """Row of the record, None without a film."""
        if trial.evaluation is None or trial.status != Status.CONVERGED:
            return None
        motion, ratios = self.recorded(trial.motion)
        quantities = self._quantities(trial.evaluation)
        if trial.faces is not None:
            quantities = {**quantities, **trial.faces.quantities()}
        tangent, load = self.steps.tangent, self.outer.load
        return make_row(time, motion, ratios, trial.evaluation.wrench, quantities, tangent, load)

    def recorded(self, motion: np.ndarray) -> tuple[np.ndarray, tuple[float, float]]:
        """Return the motion (10,) for the record, and the eccentricity ratios in the mid-plane and at an end."""
        bearing = self.model.bearing
        return motion[:10], eccentricity_ratios(motion, bearing.radial_clearance, bearing.length)

    def fields(self, time: float, trial: Trial, configuration: exu.ConfigurationType) -> FilmFields:
        """Fields of the film at the last trial, which must be that of the state in ``configuration``."""
        if not isinstance(trial.evaluation, Evaluation):
            raise InputError(f"'{self.failures.name}' has no film around a journal; see thrust_... in its history.")
        return trial.evaluation.fields(time, self.bush_displacement(trial, configuration))

    def bush_displacement(self, trial: Trial, configuration: exu.ConfigurationType) -> np.ndarray | None:
        """Displacement (k, 3) of the mesh of a bush against the housing, joint frame; None without one."""
        return None

    def _quantities(self, evaluation: JointEvaluation) -> Mapping[str, float]:
        """Scalars of an evaluation; the sides' arrays must belong to it."""
        return evaluation.quantities()

    def current(self, mbs: exu.MainSystem) -> tuple[float, Trial]:
        """Time of Exudyn's current state, and the film there."""
        time = mbs.systemData.GetTime(CURRENT)
        return time, self.look(mbs, time, CURRENT)
