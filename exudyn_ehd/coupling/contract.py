"""What the film element needs from a joint's film model, and what it gives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from exudyn_ehd.status import Status


class Geometry(Protocol):
    """The dimensions of a bearing that the coupling looks at."""

    @property
    def radial_clearance(self) -> float: ...
    @property
    def journal_radius(self) -> float: ...
    @property
    def length(self) -> float: ...


class Evaluation(Protocol):
    """Result of one film evaluation.

    ``wrench`` (6,) = [Fx, Fy, Fz, Mx, My, Mz] acts on the journal, in the joint frame, moment about its origin O; the
    housing gets exactly minus it about the same point. It is nan unless ``status`` is `Status.CONVERGED`.
    """

    @property
    def status(self) -> Status: ...
    @property
    def wrench(self) -> np.ndarray: ...
    def tangent(self) -> np.ndarray:
        """Derivative (6, 10) of the wrench with respect to the motion; only until the model's next evaluation."""
        ...

    def quantities(self) -> Mapping[str, Any]:
        """Scalars by name: minimum_gap, peak_pressure, friction_torque, power_loss, leakage, contact_load."""
        ...

    def history(self) -> Any:
        """What the film remembers if this state is accepted; opaque to the coupling."""
        ...


class JointModel(Protocol):
    """A film: a pure function of the motion (10,) of the journal axis in the housing's joint frame, and of its memory."""

    @property
    def bearing(self) -> Any: ...
    @property
    def remembers(self) -> bool:
        """Whether the force depends on accepted steps before; if not, memory is neither asked for nor handed over."""
        ...

    @property
    def needs_spin(self) -> bool:
        """Whether the journal's angle matters (supply areas in the journal)."""
        ...

    def initial_history(self, motion: np.ndarray) -> Any:
        """Memory at the start of a run, at this motion."""
        ...

    def evaluate(self, motion: np.ndarray, history: Any = None, step: float = 0.0, spin: float = 0.0) -> Evaluation:
        """Evaluate the film at [x, y, bx, by, x_t, y_t, bx_t, by_t, omega, w] (m, rad, m/s, rad/s).

        ``history`` is the memory at the last accepted step (None: the steady film), ``step`` the time since then [s],
        ``spin`` the journal's angle against the housing about the axis [rad].
        """
        ...
