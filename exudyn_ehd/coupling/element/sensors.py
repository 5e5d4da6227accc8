"""Exudyn sensors that read a joint: quantities of its film, and what Exudyn's own joints give.

The latter are those of a joint whose first marker is on the housing and whose second is on the journal: what is local
is in the housing's joint frame A0, loads are those that the journal hands on to the housing (minus those on the
journal), of films, thrust faces and constraint together. Torques are vectors about the bearing's centre, as Exudyn's
spring-dampers have them; ``TorqueLocal`` of its ideal joints holds multipliers, of ``CreateRevoluteJoint``
(-M_y, M_x).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.rigidBodyUtilities import RotationMatrix2RotXYZ

from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.history import COLUMNS, WIDTH, Quantity
from exudyn_ehd.status import InputError, Status

_NO_ROW = np.full(WIDTH, np.nan)
QUANTITIES = tuple(member.value for member in Quantity)


class _SensedState(NamedTuple):
    """Frames (3, 6) of housing and journal (see `kinematics`), local force and torque (3,) on the housing."""

    housing: np.ndarray
    journal: np.ndarray
    force: np.ndarray
    torque: np.ndarray

    def local(self, column: int) -> np.ndarray:
        """Difference of a column of the frames, in the housing's."""
        return self.housing[:, :3].T @ (self.journal[:, column] - self.housing[:, column])

    def turn(self) -> np.ndarray:
        """Rotation (3, 3) of the journal against the housing."""
        return self.housing[:, :3].T @ self.journal[:, :3]


def _transformation(rotation: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The 16 components of a homogeneous transformation, row by row."""
    return np.vstack([np.column_stack([rotation, place]), [0.0, 0.0, 0.0, 1.0]]).ravel()


OUTPUTS: dict[str, Callable[[_SensedState], np.ndarray]] = {
    "Position": lambda s: s.housing[:, 3],
    "Velocity": lambda s: s.housing[:, 4],
    "HomogeneousTransformation": lambda s: _transformation(s.housing[:, :3], s.housing[:, 3]),
    "HomogeneousTransformationLocal": lambda s: _transformation(s.turn(), s.local(3)),
    "Displacement": lambda s: s.journal[:, 3] - s.housing[:, 3],
    "DisplacementLocal": lambda s: s.local(3),
    "VelocityLocal": lambda s: s.local(4),
    "Rotation": lambda s: RotationMatrix2RotXYZ(s.turn()),
    "AngularVelocity": lambda s: s.journal[:, 5] - s.housing[:, 5],
    "AngularVelocityLocal": lambda s: s.local(5),
    "Force": lambda s: s.housing[:, :3] @ s.force,
    "ForceLocal": lambda s: s.force,
    "Torque": lambda s: s.housing[:, :3] @ s.torque,
    "TorqueLocal": lambda s: s.torque,
}
"""Functions that read a sensor's value, by the names of Exudyn's OutputVariableType."""


def reader(
    element: FilmElement,
    constraint: Index | None,
    quantity: Quantity | exu.OutputVariableType | str,
    known: Sequence[str] = QUANTITIES,
    where: str = "LubricatedJoint.AddSensor",
) -> tuple[str, Callable[[exu.MainSystem], np.ndarray]]:
    """Name of a quantity, and the function that reads it at a system's current state; nan without a film.

    Raises
    ------
    InputError
        In the name of ``where``, for what is none of the ``known`` quantities.
    """
    asked = getattr(quantity, "name" if isinstance(quantity, exu.OutputVariableType) else "value", quantity)
    if isinstance(asked, str) and asked in OUTPUTS:
        output = OUTPUTS[asked]
        return asked, lambda mbs: output(_state(mbs, element, constraint))
    if not isinstance(asked, str) or asked not in known:
        raise InputError(
            f"{where}: quantity must be a member of Quantity or its name, one of {', '.join(known)}, or an "
            f"exu.OutputVariableType or its name, one of {', '.join(OUTPUTS)}; got {quantity!r}."
        )

    def read(mbs: exu.MainSystem) -> np.ndarray:
        row = element.row(*element.current(mbs))
        return np.atleast_1d((_NO_ROW if row is None else row)[COLUMNS[asked]])

    return asked, read


def _state(mbs: exu.MainSystem, element: FilmElement, constraint: Index | None) -> _SensedState:
    """State of the joint; its sides are there once the film was asked."""
    trial = element.current(mbs)[1]
    load = np.full(6, np.nan) if trial.status is not Status.CONVERGED else -trial.found.wrench
    if trial.faces is not None:
        load -= trial.faces.wrench
    if constraint is not None:
        output = exu.OutputVariableType
        load[:3] += mbs.GetObjectOutput(constraint, output.ForceLocal)
        multipliers = mbs.GetObjectOutput(constraint, output.TorqueLocal)
        load[3:] += [multipliers[1], -multipliers[0], 0.0]
    housing, journal = (side.frame.copy() for side in element.sides)
    return _SensedState(housing, journal, load[:3], load[3:])


def add_sensor(
    mbs: exu.MainSystem,
    element: FilmElement,
    read: Callable[[exu.MainSystem], np.ndarray],
    name: str,
    file_name: str,
    write_to_file: bool,
) -> Index:
    """Add a sensor of what a `reader` reads; its values are stored in the sensor.

    The sensor looks at the state Exudyn shows it, which after an accepted step is exactly the state the record gets, so
    that both agree bit for bit.
    """

    def values(
        mbs: exu.MainSystem,
        t: float,
        sensorNumbers: list[int],
        factors: list[float],
        configuration: exu.ConfigurationType,
    ) -> list[float]:
        element.require_items(mbs)
        return read(mbs).tolist()

    return mbs.AddSensor(
        eii.SensorUserFunction(
            name=name,
            sensorNumbers=[],
            factors=[],
            sensorUserFunction=values,
            storeInternal=True,
            fileName=file_name,
            writeToFile=write_to_file,
        )
    )
