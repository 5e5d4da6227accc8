"""States from which runs start: stored states with the films' memory, in memory or in a file, and equilibria.

An equilibrium is a consistent start: the journal is placed at the position in which its film carries a steady load.
"""

from __future__ import annotations

import dataclasses
import json
import pathlib
from collections.abc import Sequence
from typing import Any, TypeVar

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import exudyn_solvers
from exudyn_ehd.coupling.contract import CURRENT, INITIAL, START_OF_STEP, Side, require_system
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.sides import NodeSide
from exudyn_ehd.coupling.run.joint_state import Joint, JointState, check_owner
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.joint.spherical.model import SphericalModel
from exudyn_ehd.joint.static.equilibrium import EquilibriumResult, equilibrium
from exudyn_ehd.joint.thrust import ThrustModel, seen_by_faces
from exudyn_ehd.joint.time_step import StepStart
from exudyn_ehd.status import InputError, Status, require_number, require_vector
from exudyn_ehd.storage import read_arrays, replacing, require_path

_FORMAT = "exudyn_ehd SystemState 10"
Part = TypeVar("Part", History, StepStart)
_PARTS = ("ODE2", "ODE2_t", "ODE1", "AE", "Data")


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class SystemState:
    """State at the end of a run, with that of all joints, from `SaveState`: `SolveDynamic` restarts from it.

    Attributes
    ----------
    time : float
        Time of the state, s.
    coordinates : tuple of 5 arrays
        As Exudyn's ``systemData.GetSystemState``: ODE2 coordinates and velocities, ODE1, algebraic and data
        coordinates.
    accelerations : (n,) array
        Second time derivatives of the ODE2 coordinates.
    algorithmic : (n,) array or None
        Algorithmic accelerations of an implicit integrator; None for other solvers.
    joints : tuple of JointState
        One for each lubricated joint, in the order in which they were created.

    Examples
    --------
    After the example of `SaveState`:

    >>> round(state.time, 6), len(state.joints)
    (0.002, 1)
    """

    time: float
    coordinates: tuple[np.ndarray, ...]
    accelerations: np.ndarray
    algorithmic: np.ndarray | None
    joints: tuple[JointState, ...]

    def __repr__(self) -> str:
        names = ", ".join(repr(joint.name) for joint in self.joints)
        return f"<SystemState at {self.time:.6g} s, with the joints {names}>"

    @classmethod
    def of(cls, mbs: exu.MainSystem, joints: Sequence[Joint]) -> SystemState:
        """Take the last accepted state of a system and its joints after a run."""
        solver = mbs.sys.get("dynamicSolver")
        if not mbs.systemIsConsistent or solver is None:
            raise InputError("SystemState: the system has no run to take a state from; call SolveDynamic before.")
        finished = exudyn_solvers.is_finished(solver)
        configuration = CURRENT if finished else START_OF_STEP
        data, algorithmic = mbs.systemData, None
        exudyn_solvers.require_end("SystemState", mbs, solver)
        if isinstance(solver, exu.MainSolverImplicitSecondOrder):
            implicit: Any = solver
            last = implicit.GetAAlgorithmic if finished else implicit.GetStartOfStepStateAAlgorithmic
            algorithmic = np.array(last(), dtype=float)
        return cls(
            time=float(data.GetTime(configuration)),
            coordinates=tuple(np.array(part, dtype=float) for part in data.GetSystemState(configuration)),
            accelerations=np.array(data.GetODE2Coordinates_tt(configuration), dtype=float),
            algorithmic=algorithmic,
            joints=tuple(joint.state() for joint in joints),
        )

    def put_into(self, mbs: exu.MainSystem, joints: Sequence[Joint]) -> None:
        """Make this the initial state of a system of the same build, and of its joints."""
        data, initial = mbs.systemData, INITIAL
        own = [np.size(part) for part in data.GetSystemState(initial)]
        given = [part.size for part in self.coordinates]
        if own != given:
            raise InputError(
                f"SystemState: it belongs to another system: {dict(zip(_PARTS, given, strict=True))} coordinates are "
                f"stored, this one has {dict(zip(_PARTS, own, strict=True))}."
            )
        if len(joints) != len(self.joints):
            raise InputError(
                f"SystemState: it belongs to another system: {len(self.joints)} lubricated joints are stored, this one "
                f"has {len(joints)}."
            )
        for joint, state in zip(joints, self.joints, strict=True):
            check_owner(joint, state)
        data.SetSystemState([part.tolist() for part in self.coordinates], initial)
        accelerations = self.accelerations if self.algorithmic is None else self.algorithmic
        data.SetODE2Coordinates_tt(accelerations.tolist(), initial)
        data.SetTime(self.time, initial)
        for joint, state in zip(joints, self.joints, strict=True):
            joint.restore_state(state)

    def save(self, path: str | pathlib.Path) -> None:
        """Write to a NumPy file (npz), whole or not at all."""
        require_path("SystemState.save", path, ".npz")
        arrays: dict[str, Any] = dict(zip(_PARTS, self.coordinates, strict=True))
        arrays |= {"accelerations": self.accelerations, "algorithmic": self.algorithmic}
        for k, joint in enumerate(self.joints):
            arrays |= {f"{k} rows": joint.rows, f"{k} modes": joint.modes}
            for what, part in (("memory", joint.memory), ("begin", joint.begin)):
                fields = () if part is None else dataclasses.fields(part)
                arrays |= {f"{k} {what} {field.name}": getattr(part, field.name) for field in fields}
        known = {name: value for name, value in arrays.items() if value is not None}
        joints = [{"name": joint.name, "bearing": joint.bearing, "time": joint.time} for joint in self.joints]
        with replacing(path, binary=True) as file:
            np.savez_compressed(file, format=_FORMAT, head=json.dumps({"time": self.time, "joints": joints}), **known)


def load_state(path: str | pathlib.Path) -> SystemState:
    """Read what `SaveState` has written.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If it is damaged or holds something else.
    """
    if not isinstance(path, (str, pathlib.Path)):
        raise InputError(
            f"SolveDynamic.restart must be a SystemState or the path of a file written by SaveState, got {path!r}."
        )
    require_path("SolveDynamic.restart", path)
    if (arrays := read_arrays(path, _FORMAT)) is None:
        raise InputError(
            f"SolveDynamic.restart: '{path}' is damaged or holds no state of this version; give a file written by "
            "SaveState."
        )
    head = json.loads(str(arrays["head"]))
    return SystemState(
        time=head["time"],
        coordinates=tuple(arrays[name] for name in _PARTS),
        accelerations=arrays["accelerations"],
        algorithmic=arrays.get("algorithmic"),
        joints=tuple(
            JointState(
                **joint,
                memory=_part(arrays, f"{k} memory ", History),
                rows=arrays[f"{k} rows"],
                begin=_part(arrays, f"{k} begin ", StepStart),
                modes=arrays.get(f"{k} modes"),
            )
            for k, joint in enumerate(head["joints"])
        ),
    )


def _part(arrays: dict[str, np.ndarray], prefix: str, kind: type[Part]) -> Part | None:
    """Memory or start of a step from its arrays; None if there are none."""
    if not any(name.startswith(prefix) for name in arrays):
        return None
    stored = {field.name: arrays.get(prefix + field.name) for field in dataclasses.fields(kind)}
    values: dict[str, Any] = {
        name: value if value is None or value.ndim else float(value) for name, value in stored.items()
    }
    return kind(**values)


_WHERE = "LubricatedJoint.place_in_equilibrium"


def equilibrium_task(
    where: str, journal: Side, subject: str, motion: np.ndarray, load: Sequence[float] | np.ndarray, speed: float | None
) -> tuple[NodeSide, tuple[float, float], float]:
    """Check the arguments of a placement: return the journal, the load (2,) on it and its speed.

    The default of the speed is that of the motion (10,).
    """
    if not isinstance(journal, NodeSide) or not journal.nodes:
        raise InputError(
            f"{where}: the journal of {subject} must be a rigid body or node that moves; place other bodies by a "
            "static solve (ehd.SolveStatic)."
        )
    x, y = require_vector(f"{where}: load", load, 2, "N")
    spin = float(motion[8]) if speed is None else require_number(f"{where}: speed", speed, "rad/s")
    if spin == 0.0:
        raise InputError(
            f"{where}: {subject} does not turn in the initial state, and a film without speed carries no steady load; "
            "give speed=..., or the bodies an initial angular velocity."
        )
    return journal, (x, y), spin


def shift_journal(
    mbs: exu.MainSystem,
    journal: NodeSide,
    state: tuple[np.ndarray, np.ndarray],
    frame: np.ndarray,
    position: np.ndarray,
    motion: np.ndarray,
) -> None:
    """Move a journal with a motion (10,) in a frame (3, 3) to a position (2,), without a velocity across the axis.

    ``state``: coordinates and rates of the system, changed in place.
    """
    places = np.array(mbs.systemData.GetNodeLTGODE2(int(journal.nodes[0])))[
        : rigid_nodes.translations(journal.kind, journal.size)
    ]
    # the position is changed, and the velocity relative to the bearing is subtracted
    for values, change in zip(state, (position - motion[:2], -motion[4:6]), strict=True):
        values[places] += (frame[:, :2] @ change)[: places.size]


def place(
    mbs: exu.MainSystem, element: FilmElement, name: str, load: Sequence[float] | np.ndarray, speed: float | None
) -> EquilibriumResult:
    """Move the journal's node to its equilibrium; see `LubricatedJoint.place_in_equilibrium`."""
    require_system(_WHERE, mbs, assembled=True, of=f" of joint '{name}'")
    if getattr(element, "bush", None) is not None:
        raise InputError(
            f"{_WHERE}: joint '{name}' has an ANCFBush, whose nodes would have to move too; place the journal's body "
            "before the joint is created (initialDisplacement), at ehd.equilibrium(...).position: the bush then "
            "starts in equilibrium with its film."
        )
    motion = element.motion(mbs, INITIAL)[:MOTION_SIZE]
    journal, force, motion[8] = equilibrium_task(_WHERE, element.sides[1], f"joint '{name}'", motion, load, speed)
    bearing = element.model.bearing
    result = equilibrium(
        bearing,
        speed=float(motion[8]),
        load=force,
        tilt=(motion[2], motion[3]),
        axial_position=0.0 if element.faces is None else float(element.collars.motion_of(*element.frames)[-1]),
    )
    housing = element.sides[0].frame[:, :3]
    coordinates = np.array(mbs.systemData.GetODE2Coordinates(INITIAL), dtype=float)
    rates = np.array(mbs.systemData.GetODE2Coordinates_t(INITIAL), dtype=float)
    shift_journal(mbs, journal, (coordinates, rates), housing, result.position, motion)
    bore = np.zeros(0) if result.film.bore_coordinates is None else result.film.bore_coordinates
    for node in element.bore_nodes:
        where = np.array(mbs.systemData.GetNodeLTGODE2(int(node)), dtype=int)
        coordinates[where], bore = bore[: where.size], bore[where.size :]
        rates[where] = 0.0
    mbs.systemData.SetODE2Coordinates(coordinates.tolist(), INITIAL)
    mbs.systemData.SetODE2Coordinates_t(rates.tolist(), INITIAL)
    settle(mbs, element)
    return result


def settle(mbs: exu.MainSystem, element: FilmElement, heated: bool = True) -> None:
    """Let the next run start from the initial state with the memory of the steady film there.

    ``heated``: the film has the temperature in balance with its heat, else its initial one.
    """
    model, memory = element.model, None
    if not isinstance(model, BearingModel) or isinstance(model, SphericalModel):
        return
    if model.remembers:
        motion = element.motion(mbs, INITIAL)
        motion[4:8] = motion[(MOTION_SIZE + motion.size) // 2 :] = 0.0
        place = None if element.faces is None else np.append(motion, element.collars.motion_of(*element.frames)[-1])
        memory = _memory(model, motion, place, element.faces, heated)
    element.steps.resume(float(mbs.systemData.GetTime(INITIAL)), memory)


def _memory(
    model: BearingModel, motion: np.ndarray, place: np.ndarray | None, faces: ThrustModel | None, heated: bool
) -> History | None:
    """Memory of the steady film at a motion of the film; ``place`` (11,): that of the faces."""
    first = model.initial_history(motion)
    settled = settled_history(model, motion if place is None else place, faces=faces) if heated else None
    evaluation = model.evaluate(motion, settled)
    if faces is not None and place is not None:
        evaluation.heat_with(faces.evaluate(place, seen_by_faces(evaluation.film, model.effects.thermal)).heat)
    if first is None or evaluation.status is not Status.CONVERGED:
        return first
    last = evaluation.history()
    assert last is not None
    temperature = first.temperature if settled is None else settled.temperature
    return dataclasses.replace(
        first,
        void=last.void,
        mass=last.mass,
        outflow=last.outflow,
        deflection=last.deflection,
        temperature=temperature,
        pockets=last.pockets,
        sump=last.sump,
        leaving=last.leaving,
    )
