"""What records, pictures and sensors ask of a joint's film element."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import JointModel, Side, Trial


class Steps(Protocol):
    """The accepted steps of an element.

    Attributes
    ----------
    observers : list of functions
        Called with every accepted trial that has a film.
    """

    observers: list[Callable[[Trial], None]]

    @property
    def is_idle(self) -> bool:
        """Whether no solver is at work."""

    def look_at_accepted(self, mbs: exu.MainSystem) -> tuple[float, Trial, exu.ConfigurationType]:
        """Time of the last accepted state, the film there, and the configuration that holds it."""


class Element(Protocol):
    """The film between two sides."""

    @property
    def model(self) -> JointModel:
        """The film."""

    @property
    def sides(self) -> tuple[Side, Side]:
        """Carriers of the joint frame and of the journal's frame."""

    @property
    def steps(self) -> Steps:
        """The accepted steps."""

    def require_items(self, mbs: exu.MainSystem) -> None:
        """Refuse a system of which items were deleted that the joint was made on."""

    def faces_wrench(self) -> np.ndarray:
        """What films on the end faces do to the journal (6,), joint frame, at the state that was looked at last."""

    def current_row(self, mbs: exu.MainSystem) -> np.ndarray | None:
        """Row of the record for Exudyn's current state, None if the film can't be evaluated there."""
