"""State of a joint in addition to Exudyn's coordinates, and the check that a stored state belongs to a joint."""

from __future__ import annotations

import dataclasses
import math

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index, require_system
from exudyn_ehd.coupling.element.nodal import ModalFilmElement
from exudyn_ehd.coupling.element.outputs import add_sensor, reader
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.exudyn_solvers import require_end
from exudyn_ehd.coupling.record.history import QUANTITIES, JointHistory, Quantity
from exudyn_ehd.joint.balance.limits import HIGHEST_PEAK
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.joint.time_step import WEIGHTS, StepStart
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.turning_journal import TurningJournal
from exudyn_ehd.status import SMALL, InputError, require_number, require_type, warn_user
from exudyn_ehd.storage import fingerprint

FILE = "it is that of joint.state(); files of SaveState are for ehd.SolveDynamic(..., restart=path)."


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class JointState:
    """Memory of one joint in a `SystemState`: oil content, wear, temperature, and the record of its steps.

    Attributes
    ----------
    name : str
    bearing : str
        Digest of the bearing's description, by which a joint with another bearing rejects the state.
    time : float
        Time of the last accepted step, s.
    memory : History or None
        Oil content, wear, temperature and deflection at that time; None if the film has no memory.
    rows : (n, k) array
        The record of accepted steps up to that time.
    begin : StepStart or None
        Start of the next step, from which the film's rates are computed (`exudyn_ehd.joint.time_step`); None if the
        film uses the velocities.
    modes : (p, k) array or None
        Displacements and stiffness of the bore's modes, by which a joint with other modes rejects the state.

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


class Joint:
    """Common part of all lubricated joints.

    Attributes
    ----------
    name : str
    mbs : exudyn.MainSystem
        The system it belongs to.
    bearing : JournalBearing
        Bearing as given by the user.
    objectNumber : exudyn.ObjectIndex
        The film element's object in Exudyn.
    element : FilmElement
        The film between the two frames.
    """

    _quantities = QUANTITIES

    def __init__(self, mbs: exu.MainSystem, element: FilmElement, numbers: tuple[Index, Index | None]) -> None:
        self.mbs, self.name = mbs, element.failures.name
        self.element: FilmElement = element
        self.bearing: JournalBearing = element.model.bearing
        self.objectNumber, self.constraintNumber = numbers

    @property
    def history(self) -> JointHistory:
        """Return all accepted steps up to now as NumPy arrays; rejected steps are not recorded.

        `exudyn_ehd/API.md` and `JointHistory` describe the arrays with their units and signs.

        The last row is the end of the last run; during a run, the start of the current step. A run that starts at the
        end of the record continues the record, e.g. after ``SolveDynamic(..., updateInitialValues=True)``. Any other
        run starts a new one, also a run at that time from the old initial values. A last state without a film is
        omitted, and a warning says why.

        After Exudyn's own ``mbs.SolveDynamic`` read the history before you change the system's state (by a
        linearisation or Assemble): its last row is computed only then.

        A new record does not reset wear, oil content and temperature of the film: see `forget`. Before Assemble the
        history is empty, and a warning says so; after it, before a run, it holds the initial state.
        """
        history = self._history()
        if not history.time.size and not np.isfinite(self.element.steps.began):
            warn_user(f"Joint '{self.name}': its history is empty before a run; run a solver first.", UserWarning)
        return history

    def _history(self) -> JointHistory:
        """Return the record like `history`, without a warning."""
        return self.element.steps.history(self.mbs, complete=self.element.presence.found(self.mbs) is not None)

    def state(self) -> JointState:
        """Return the state in addition to Exudyn's coordinates at the last accepted step: film memory and record.

        See `SaveState` for the whole system.
        """
        self._require_end("state")
        time, memory, begin, rows = self.element.steps.remembered(self.mbs)
        return JointState(
            name=self.name,
            bearing=digest(self.bearing),
            time=time,
            memory=memory,
            rows=rows,
            begin=begin,
            modes=bore_modes_of(self.element),
        )

    def _require_end(self, method: str) -> None:
        """Raise `InputError` unless the system, with the joint's items, is in the end state of its run."""
        where = f"{type(self).__name__}.{method}"
        require_system(where, self.mbs, assembled=True, of=f" of joint '{self.name}'")
        self.element.presence.require(self.mbs)
        require_end(where, self.mbs, self.element.steps.solver)

    def _audited(self) -> JointHistory:
        """Return the record for an audit, which needs steps, and all of them."""
        history, where = self._history(), f"{type(self).__name__}.audit: joint '{self.name}'"
        if history.time.size == 0:
            raise InputError(f"{where} has no accepted steps yet; run a solver first.")
        if history.is_thinned:
            raise InputError(
                f"{where} keeps {history.time.size} of {history.step_count[-1] + 1} states, and forces that ring, heat "
                "and films that remember need every step: audit a shorter run without Every or Period, e.g. one that "
                "goes on from ehd.SaveState in a model without them."
            )
        return history

    def forget(self) -> None:
        """Let the next run start with a new record and a new film: full of oil, not worn, at its first temperature.

        Without this call the film of the next run (oil content, wear, temperature) depends on the state at which that
        run starts:

        - where the last run has ended: the film of its end, at whatever time and with static solves in between;
        - where the last run has started: the film of its start;
        - at any other state: the film of the last end, with a `MemoryWarning`.
        """
        self.element.steps.forget()
        if (recorder := self.element.steps.recorder) is not None:
            recorder.begin_anew()

    def stop_at(self, *, force: float = math.inf, pressure: float = HIGHEST_PEAK) -> None:
        """End runs with a `FilmError` at the first accepted step whose film exceeds a limit of yours.

        Use it to end a run early at loads that your machine can't have. Without it a run ends at: a pressure beyond 3
        GPa, which neither oil nor steel bears (`SolveDynamic` and `SolveDynamicSparse` first try smaller steps); rigid
        surfaces pressed through each other by more than the clearance; a force that alternates from step to step with
        many times its mean. Accepted steps with a mean pressure above 1 GPa, or with a peak above 3 GPa where you allow
        it, give an `OverloadWarning`. Mean pressures are force over projected area.

        Parameters
        ----------
        force : float, default inf
            Largest allowed force of film and contact, N.
        pressure : float, default 3e9
            Largest allowed pressure, Pa, for the film's peak and for the mean pressure of film and contact; `math.inf`
            allows any.
        """
        for name, value, unit in (("force", force, "N"), ("pressure", pressure, "Pa")):
            if value != math.inf:
                require_number(f"{type(self).__name__}.stop_at.{name}", value, unit, above=0.0)
        failures = self.element.failures
        failures.largest_force, failures.largest_pressure = force, pressure

    def restore_state(self, state: JointState) -> None:
        """Let the next run go on with the memory of a state, and with its record if it starts at its time.

        ``SolveDynamic(restart=...)`` does this for all joints.

        Raises
        ------
        InputError
            If the state is of another joint or bearing.
        """
        check_owner(self, state)
        self.element.steps.resume(state.time, state.memory, state.rows, state.begin)

    def AddSensor(
        self,
        quantity: Quantity | exu.OutputVariableType | str,
        *,
        fileName: str = "",
        name: str = "",
        writeToFile: bool | None = None,
    ) -> Index:
        """Add an Exudyn sensor of one quantity, e.g. for ``mbs.PlotSensor`` and ``mbs.GetSensorStoredData``.

        Parameters
        ----------
        quantity : Quantity, exudyn.OutputVariableType or str
            A quantity of the film, by its name in `JointHistory` or as a `Quantity`: vectors are in the joint frame,
            loads act on the journal. Of a ball ``eccentricity_ratio``, ``force`` (on the ball, socket's frame),
            ``minimum_gap``, ``peak_pressure``, ``power_loss`` or ``contact_load``. Or an output of Exudyn's joints, as
            of one with the markers [housing, journal], film, end faces and constraint together: in the housing's joint
            frame ForceLocal, TorqueLocal, DisplacementLocal, VelocityLocal, Rotation (Tait-Bryan angles),
            AngularVelocityLocal, HomogeneousTransformationLocal; global Force, Torque, Displacement, AngularVelocity,
            and Position, Velocity, HomogeneousTransformation of the housing's joint point. Forces and torques of these
            outputs act from the journal on the housing, torques about the bearing's centre.
        fileName : str, default ""
            File to write to, as in Exudyn's sensors.
        name : str, default ""
            Name of the sensor; by default joint and quantity.
        writeToFile : bool or None, default None
            Write the file; None: if a file name is given. The sensor stores its values in any case.

        Returns
        -------
        exudyn.SensorIndex
        """
        where = f"{type(self).__name__}.AddSensor"
        title, read = reader(self.element, self.constraintNumber, quantity, self._quantities, where)
        self.element.presence.require(self.mbs)
        write = bool(fileName) if writeToFile is None else writeToFile
        return add_sensor(self.mbs, self.element, read, name or f"{self.name} {title}", fileName, write)


def digest(bearing: JournalBearing) -> str:
    """Digest of a bearing's description, arrays by content; modes of a body are compared by `bore_modes_of`."""
    bush, pin = bearing.bush, getattr(bearing, "journal", None)
    if isinstance(bush, ReducedBore):
        return fingerprint((dataclasses.replace(bearing, bush=None), bush.radius, bush.length))
    if isinstance(pin, TurningJournal):
        return fingerprint((dataclasses.replace(bearing, journal=None), pin.surface.radius, pin.surface.length))
    return fingerprint(bearing)


def bore_modes_of(element: FilmElement) -> np.ndarray | None:
    """Modes (p, k) of a film's bore: radial displacements at some places and stiffness.

    Signs and combinations of modes depend on the eigenvalue solver: the same bush may have other modes.
    """
    if not isinstance(element, ModalFilmElement):
        return None
    # arbitrary angles, rad, and shares of the length, at which modes differ
    angles, places = np.linspace(0.3, 6.1, 7), element.model.bearing.length * np.array([-0.43, 0.11, 0.37])
    return np.vstack((element.bore.radial(angles, places).reshape(-1, element.stiffness.size), element.stiffness))


def check_owner(joint: Joint, state: JointState) -> None:
    """Raise `InputError` for a state of another joint or bearing."""
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
    if own is None or stored is None or own.shape != stored.shape:
        return own is stored
    scale = np.max(np.abs(own), axis=1, keepdims=True)
    return bool(np.all(np.abs(own - stored) <= SMALL * scale))


def _check_memory(joint: Joint, state: JointState) -> None:
    """Raise `InputError` for a memory or a start of a step that does not fit this film."""
    model, memory, begin = joint.element.model, state.memory, state.begin
    bore = model.size if isinstance(model, ElasticBearingModel) else 0
    size = getattr(model, "motion_size", MOTION_SIZE) + 2 * bore
    known = 0 if begin is None else min(len(np.atleast_1d(begin.misses)), len(WEIGHTS) - 1)
    start = StepStart(time=0.0, motion=np.zeros(size), step=0.0, misses=np.zeros((known, 4 + bore)), clearance=0.0)
    film = model.initial_history(np.zeros(size))
    for what, given, own in (("memory", memory, film), ("begin", begin, start)):
        if given is not None and _shapes(given) != _shapes(own):
            raise InputError(
                f"LubricatedJoint.restore_state: {what} of joint '{state.name}' must hold finite numbers of the shapes "
                f"{_shapes(own)}, got {_shapes(given)}; the file was changed, or written for another film."
            )


def _shapes(part: History | StepStart | None) -> dict[str, tuple[int, ...]]:
    fields = () if part is None else dataclasses.fields(part)
    values = {field.name: getattr(part, field.name) for field in fields}
    return {name: np.shape(value) for name, value in values.items() if value is not None and np.all(np.isfinite(value))}
