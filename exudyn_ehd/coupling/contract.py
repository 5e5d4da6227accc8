"""Protocols of a film, of a side of a joint and of a joint's element in the coupling; names for Exudyn's types."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, SupportsInt, TypeAlias

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import Skew

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.thrust import ThrustEvaluation
from exudyn_ehd.joint.time_step import StepStart
from exudyn_ehd.status import InputError, Status

# Exudyn's index types exist at run time, but not in its type stubs.
_indices: Any = exu
NodeIndex, ObjectIndex, MarkerIndex = _indices.NodeIndex, _indices.ObjectIndex, _indices.MarkerIndex
CURRENT, START_OF_STEP = exu.ConfigurationType.Current, exu.ConfigurationType.StartOfStep
INITIAL, REFERENCE = exu.ConfigurationType.Initial, exu.ConfigurationType.Reference
Data: TypeAlias = dict[str, Any]
"""An item's data as Exudyn's GetNode, GetObject and GetMarker return them."""
Index: TypeAlias = SupportsInt
"""Number of an item as Exudyn gives it: a NodeIndex, ObjectIndex, MarkerIndex or SensorIndex."""


def require_system(where: str, mbs: exu.MainSystem, *, assembled: bool | None = None, of: str = "") -> None:
    """Raise `InputError` unless ``mbs`` is a system of Exudyn and, if ``assembled`` is given, assembled or not.

    ``of``: description of the system, for the message.
    """
    if not isinstance(mbs, exu.MainSystem):
        raise InputError(
            f"{where}.mbs must be an exudyn.MainSystem, got {type(mbs).__name__}; give what "
            "SystemContainer().AddSystem() returns."
        )
    if assembled is not None and mbs.systemIsConsistent != assembled:
        state = (
            "not assembled; call mbs.Assemble() first" if assembled else "assembled already; do it before Assemble()"
        )
        raise InputError(f"{where}: the system{of} is {state}.")


def objects_of(mbs: exu.MainSystem) -> Iterator[tuple[Index, Data]]:
    """Numbers and data of all objects of a system."""
    for number in map(ObjectIndex, range(mbs.systemData.NumberOfObjects())):
        yield number, mbs.GetObject(number)


class JointEvaluation(Protocol):
    """Result of one film evaluation.

    ``wrench`` (6,) = [Fx, Fy, Fz, Mx, My, Mz] acts on the journal, in the joint frame, with the moment about its origin
    O. Minus this wrench, about the same point, acts on the housing. It is nan unless ``status`` is `Status.CONVERGED`.
    """

    status: Status
    wrench: np.ndarray

    def tangent(self) -> np.ndarray:
        """Derivative (6, 10) of the wrench to the motion; it must be called before the model's next evaluation."""

    def quantities(self) -> Mapping[str, float]:
        """Scalars by name: minimum_gap, peak_pressure, friction_torque, power_loss, leakage, contact_load."""

    def history(self) -> History | None:
        """Return the film's history after this state, for an accepted step."""


@dataclass(slots=True, eq=False)
class Trial:
    """One state and the films' evaluation there; ``evaluation`` is None if the film was not evaluated.

    ``motion`` is the film's input. It follows from the motion of the ``bodies`` in the step from ``begin``. ``faces``
    is the evaluation of films on end faces, whose motion is that of the bodies; None without them.
    """

    q: list[float]
    q_t: list[float]
    memory: History | None
    step: float
    begin: StepStart | None
    bodies: np.ndarray
    motion: np.ndarray
    evaluation: JointEvaluation | None = None
    faces: ThrustEvaluation | None = None
    status: Status = Status.NO_FILM

    def __post_init__(self) -> None:
        # a sum is finite only if all its terms are
        if not math.isfinite(sum(self.q)):
            self.status = Status.NOT_FINITE

    def take(self, evaluation: JointEvaluation) -> None:
        """Store the evaluation of the journal's film."""
        self.evaluation, self.status = evaluation, evaluation.status

    def take_faces(self, faces: ThrustEvaluation) -> None:
        """Store the evaluation of the films on the end faces, whose heat goes into the journal's film."""
        self.faces, self.status = faces, max(self.status, faces.status)
        if faces.status is Status.CONVERGED and isinstance(self.evaluation, Evaluation):
            self.evaluation.heat_with(faces.heat)

    @property
    def found(self) -> JointEvaluation:
        """Evaluation of the film, which must exist."""
        assert self.evaluation is not None
        return self.evaluation


class JointModel(Protocol):
    """Model of a film: a pure function of its memory and of the motion (10,) of the journal axis in the joint frame."""

    bearing: JournalBearing

    @property
    def remembers(self) -> bool:
        """Return whether the force depends on earlier accepted steps; if not, the film needs no memory."""

    @property
    def needs_spin(self) -> bool:
        """Return whether the force depends on the journal's angle (supply areas in the journal)."""

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History at the start of a run, for this motion."""

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> JointEvaluation:
        """Evaluate the film at [x, y, bx, by, x_t, y_t, bx_t, by_t, omega, w] (m, rad, m/s, rad/s).

        ``history`` is the memory at the last accepted step (None: the steady film), ``step`` the time since then [s],
        ``spin`` the journal's angle against the housing about the axis [rad].
        """


class Side:
    """Frame of one side of a joint as a function of the coordinates of its nodes.

    The work arrays belong to the solver's state. For another state use a `copy.deepcopy` of the side.

    Parameters
    ----------
    nodes : list
        Nodes it depends on.
    size : int
        Number n of their coordinates.

    Attributes
    ----------
    frame : ndarray (3, 6)
    jac : ndarray (4, 3, n)
        Work arrays of `exudyn_ehd.coupling.kinematics.rigid_nodes`.
    arm : ndarray (3,)
        Last arm of `move_point`.
    """

    def __init__(self, nodes: list[Index], size: int) -> None:
        self.nodes, self.size = nodes, size
        self.frame, self.jac = np.zeros((3, 6)), np.zeros((4, 3, size))
        self.arm = np.zeros(3)

    def bind(self, mbs: exu.MainSystem) -> None:
        """Find what is known only in an assembled system; sides on nodes know everything before."""

    def move_point(self, arm: np.ndarray) -> None:
        """Move the point of the frame and of Jp by an arm (3,) that turns with the frame, global [m]."""
        self.arm = arm
        lever = Skew(arm)
        self.frame[:, 3] += arm
        self.frame[:, 4] -= lever @ self.frame[:, 5]
        self.jac[0] -= lever @ self.jac[1]

    def update(self, mbs: exu.MainSystem, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        raise NotImplementedError

    def change(self, mbs: exu.MainSystem, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        raise NotImplementedError
