"""What a joint knows besides Exudyn's coordinates, and whether a stored state is that of a joint."""

from __future__ import annotations

import dataclasses
from typing import Protocol

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.element.modal import ModalFilmElement
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.joint.step_rates import WEIGHTS, StepStart
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.journal.turning import TurningJournal
from exudyn_ehd.status import InputError, require_type
from exudyn_ehd.storage import fingerprint

FILE = "it is that of joint.state(); files of SaveState are for ehd.SolveDynamic(..., restart=path)."
# Where the modes of a bore are compared: angles, shares of the length, and the part of the largest that is rounding
_ANGLES, _PLACES, _SAME_MODES = np.linspace(0.3, 6.1, 7), np.array([-0.43, 0.11, 0.37]), 1e-6


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class JointState:
    """What a joint knows besides Exudyn's coordinates.

    Attributes
    ----------
    name : str
    bearing : str
        Digest of the bearing's description: a state is for the bearing that it came from.
    time : float
        s, of the last accepted step.
    memory : History or None
        Oil content, wear, temperature and deflection at that time; None if the film remembers nothing.
    rows : (n, k) array
        The record of accepted steps up to it.
    begin : StepStart or None
        Where the next step begins, if its rates follow the positions.
    modes : (p, k) array or None
        Displacements and stiffness of the bore's modes, whose coordinates are part of the state.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> state = joint.state()
    >>> state.name, round(state.time, 6)
    ('main', 0.002)
    >>> joint.restore_state(state)
    """

    name: str
    bearing: str
    time: float
    memory: History | None
    rows: np.ndarray
    begin: StepStart | None = None
    modes: np.ndarray | None = None

    def __repr__(self) -> str:
        return f"<JointState of '{self.name}' at {self.time:.6g} s, {len(self.rows)} steps recorded>"


class Joint(Protocol):
    """What runs ask of a lubricated joint."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def bearing(self) -> JournalBearing:
        """What was given as bearing."""

    @property
    def objectNumber(self) -> Index:
        """The film element's object in Exudyn."""

    @property
    def element(self) -> FilmElement:
        """The film between the two frames."""

    @property
    def history(self) -> JointHistory:
        """All accepted steps."""

    def state(self) -> JointState:
        """Memory and record at the last accepted state."""

    def restore_state(self, state: JointState) -> None:
        """Let the next run go on from a state."""


def digest(bearing: JournalBearing) -> str:
    """Digest of a bearing's description, arrays by content; modes of a body are told by `bore_modes_of`."""
    bush, pin = bearing.bush, getattr(bearing, "journal", None)
    if isinstance(bush, ReducedBore):
        return fingerprint((dataclasses.replace(bearing, bush=None), bush.radius, bush.length))
    if isinstance(pin, TurningJournal):
        return fingerprint((dataclasses.replace(bearing, journal=None), pin.surface.radius, pin.surface.length))
    return fingerprint(bearing)


def bore_modes_of(element: FilmElement) -> np.ndarray | None:
    """Modes (p, k) of a film's bore: radial displacements at some places and stiffness.

    Solvers of eigenvalue problems leave their signs and combinations open: modes of the same bush may be others.
    """
    if not isinstance(element, ModalFilmElement):
        return None
    places = element.model.bearing.length * _PLACES
    return np.vstack((element.bore.radial(_ANGLES, places).reshape(-1, element.stiffness.size), element.stiffness))


def check_owner(joint: Joint, state: JointState) -> None:
    """Refuse a state of another joint or bearing."""
    require_type("LubricatedJoint.restore_state: state", state, JointState, hint=FILE)
    if state.name != joint.name:
        raise InputError(
            f"LubricatedJoint.restore_state: the state is of joint '{state.name}', this one is '{joint.name}'."
        )
    if state.bearing != digest(joint.bearing):
        raise InputError(
            f"LubricatedJoint.restore_state: the state of joint '{state.name}' comes from another bearing (geometry, "
            "oil, grid or effects differ); build the joint with the bearing of the stored run."
        )
    modes = bore_modes_of(joint.element)
    if not _same_modes(modes, state.modes):
        raise InputError(
            f"LubricatedJoint.restore_state: the modes of joint '{state.name}' are others than those of the stored run "
            "(another body or basis, or the same one computed again with other signs); keep the modes of the body with "
            "its model, or the folder of EXUDYN_EHD_CACHE with the state."
        )
    _check_memory(joint, state)


def _same_modes(own: np.ndarray | None, stored: np.ndarray | None) -> bool:
    if own is None or stored is None:
        return own is stored
    if own.shape != stored.shape:
        return False
    scale = np.max(np.abs(own), axis=1, keepdims=True)
    return bool(np.all(np.abs(own - stored) <= _SAME_MODES * scale))


def _check_memory(joint: Joint, state: JointState) -> None:
    """Refuse a memory or a start of a step that is none of this film's."""
    model, memory, begin = joint.element.model, state.memory, state.begin
    bore = model.size if isinstance(model, ElasticBearingModel) else 0
    size = getattr(model, "motion_size", MOTION_SIZE + 2 * bore)
    parts: list[tuple[str, dict[str, tuple[int, ...]], dict[str, tuple[int, ...]]]] = []
    if memory is not None:
        own = model.initial_history(np.zeros(size))
        parts.append(("memory", _shapes(memory), {} if own is None else _shapes(own)))
    if begin is not None:
        known = min(len(np.atleast_1d(begin.misses)), len(WEIGHTS) - 1)
        expected = {"time": (), "motion": (size,), "step": (), "misses": (known, 4 + bore), "clearance": ()}
        parts.append(("begin", _shapes(begin), expected))
    for what, given, expected in parts:
        if given != expected:
            raise InputError(
                f"LubricatedJoint.restore_state: {what} of joint '{state.name}' must hold finite numbers of the shapes "
                f"{expected}, got {given}; the file was changed, or written for another film."
            )


def _shapes(part: History | StepStart) -> dict[str, tuple[int, ...]]:
    values = {field.name: getattr(part, field.name) for field in dataclasses.fields(part)}
    return {name: np.shape(value) for name, value in values.items() if value is not None and np.all(np.isfinite(value))}
