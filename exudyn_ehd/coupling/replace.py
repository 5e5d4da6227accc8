"""`ReplaceJoint`: a film that replaces a joint of a model; `ReplaceReducedBody`.

A joint of two markers with the frames A R (A of the marker, R the joint's ``rotationMarker``) has all data for
`CreateLubricatedJoint`. The markers are the two sides. The joint frame is the housing's frame with z along the free
rotation, whatever the sense of the journal's axis. The old joint stays in the model, inactive and hidden, since
deleting it would renumber all later objects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.api import CreateLubricatedJoint, Free, Held
from exudyn_ehd.coupling.contract import Data, Index, MarkerIndex, ObjectIndex, objects_of, require_system
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.coupling.items.bodies import MASS_POINTS, POINT_KINDS
from exudyn_ehd.coupling.items.markers import marker_item
from exudyn_ehd.coupling.items.objects import own_equations
from exudyn_ehd.coupling.run.solve import joints_of
from exudyn_ehd.status import ROUNDING, InputError, require_type

TYPES = ("JointRevoluteZ", "JointGeneric", "JointRevolute2D")
_LEAVE = "leave this joint as it is (ReplaceJoints: bearing as a function that returns None for it)"


def ReplaceJoint(
    mbs: exu.MainSystem,
    objectNumber: Index,
    *,
    bearing: JournalBearing,
    name: str = "",
    journal: int = 1,
    **options: Any,
) -> LubricatedJoint:
    """Replace a revolute or cylindrical joint of a model by a film; before Assemble.

    The joint stays in the model, switched off and hidden (``activeConnector=False``), so that every number of the model
    stays valid. The film holds the journal along the axis (`Held`) if the joint did. Use implicit solvers: Exudyn's
    explicit ones do not accept systems with constraints, not even inactive ones.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system.
    objectNumber : exudyn.ObjectIndex
        A joint as ``mbs.CreateRevoluteJoint`` and ``mbs.CreateGenericJoint`` make it, ObjectJointRevoluteZ,
        ObjectJointGeneric or ObjectJointRevolute2D.
    bearing : JournalBearing
        Geometry, lubricant, film and effects.
    name : str, default ""
        Name of the film; by default "film of" and the name of the joint.
    journal : int, default 1
        Position of the journal's marker in the joint, 0 or 1; the other marker is on the housing.
    options
        Further arguments of `CreateLubricatedJoint`: axial, tilt, stepControl, bushGravity, show, record. Give
        ``tilt=Held()`` if the joint was the only one that carried a tilting moment: a short film carries little of it.

    Returns
    -------
    LubricatedJoint

    Raises
    ------
    InputError
        For an object that is no such joint; a joint that does not leave one rotation free and hold the journal across
        it, that has an offset function or that a sensor reads; and as `CreateLubricatedJoint`.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> crank = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.1, 0.05, 2))
    >>> ideal = mbs.CreateRevoluteJoint(itemNumbers=[mbs.CreateGround(), crank], position=[0, 0, 0], axis=[0, 0, 1])
    >>> film = ehd.ReplaceJoint(mbs, ideal, bearing=joint.bearing, tilt=ehd.Held())
    >>> mbs.GetObject(ideal)["activeConnector"]
    False
    """
    require_system("ReplaceJoint", mbs, assembled=False)
    joint, where = _joint(mbs, objectNumber)
    if journal not in (0, 1):
        raise InputError(f"ReplaceJoint.journal must be 0 or 1, the place of its marker in the joint, got {journal!r}.")
    free, held = _freedom(joint, where)
    for k in range(mbs.systemData.NumberOfSensors()):
        sensor = mbs.GetSensor(k)
        if int(sensor.get("objectNumber", -1)) == int(objectNumber):
            raise InputError(
                f"{where} is read by sensor {k} '{sensor['name']}', which would find nothing there; make the sensor by "
                "AddSensor of the film."
            )
    markers, frames = zip(*(_side(mbs, joint, k, where) for k in (0, 1)), strict=True)
    axes = [frame[:, free] for frame in frames]
    # of either sense, as in Exudyn: the film has that of the housing
    if np.linalg.norm(np.cross(*axes)) > ROUNDING:
        raise InputError(
            f"{where}: the axes of its two markers, {axes[0]} and {axes[1]}, must be parallel in the reference "
            "configuration; turn one of the markers by its localHT, or of the joint by rotationMarker0 or 1."
        )
    rotation = np.roll(frames[1 - journal], 2 - free, axis=1)
    try:
        film = CreateLubricatedJoint(
            mbs,
            name or _free_name(mbs, joint, int(objectNumber)),
            [markers[1 - journal], markers[journal]],
            rotationMatrixAxes=rotation,
            bearing=bearing,
            **({"axial": Held() if held else Free()} | options),
        )
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    mbs.SetObjectParameter(objectNumber, "activeConnector", False)
    mbs.SetObjectParameter(objectNumber, "Vshow", False)
    return film


def ReplaceJoints(
    mbs: exu.MainSystem,
    *,
    bearing: JournalBearing | Callable[[int], JournalBearing | None],
    types: Sequence[str] = TYPES,
    **options: Any,
) -> dict[int, LubricatedJoint]:
    """Replace all active revolute and cylindrical joints of a model by films; see `ReplaceJoint`.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system, before Assemble.
    bearing : JournalBearing or function
        One bearing for all joints, or a function that gets a joint's object number and returns its bearing, or None to
        leave that joint as it is.
    types : sequence of str, default ("JointRevoluteZ", "JointGeneric", "JointRevolute2D")
        Types of Exudyn's objects that are replaced.
    options
        As for `ReplaceJoint`.

    Returns
    -------
    dict
        The `LubricatedJoint` of each replaced joint, by the joint's object number.

    Raises
    ------
    InputError
        For unknown types, a system without such joints, and as `ReplaceJoint`.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> crank = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.1, 0.05, 2))
    >>> ideal = mbs.CreateRevoluteJoint(itemNumbers=[mbs.CreateGround(), crank], position=[0, 0, 0], axis=[0, 0, 1])
    >>> films = ehd.ReplaceJoints(mbs, bearing=joint.bearing)
    >>> len(films)
    1
    """
    require_system("ReplaceJoints", mbs)
    unknown = [kind for kind in types if kind not in TYPES]
    if isinstance(types, str) or unknown:
        raise InputError(f"ReplaceJoints.types must be some of {', '.join(TYPES)}, got {types!r}.")
    if not callable(bearing):
        require_type("ReplaceJoints.bearing", bearing, JournalBearing)
    films: dict[int, LubricatedJoint] = {}
    found = False
    for number, joint in objects_of(mbs):
        if joint["objectType"] not in types or not joint["activeConnector"] or not _turns(joint):
            continue
        found = True
        own = bearing if isinstance(bearing, JournalBearing) else bearing(int(number))
        if own is not None:
            films[int(number)] = ReplaceJoint(mbs, number, bearing=own, **options)
    if not found:
        raise InputError(
            f"ReplaceJoints: the system has no active joint of type {', '.join(types)} with one rotation free; make "
            "the joints first, or put films in place with CreateLubricatedJoint."
        )
    return films


def ReplaceReducedBody(mbs: exu.MainSystem, objectNumber: Index) -> Index:
    """Give a finite-element body (ObjectFFRFreducedOrder) its exact Jacobian, for faster runs; before Assemble.

    Exudyn differentiates the body numerically: every Jacobian costs two evaluations of all its forces for each
    coordinate, which with many modes is most of the time of a step. This adds an ObjectGenericODE2 that has the same
    equations with exact derivatives. The body keeps its markers, sensors, loads and drawing. Its matrices are read
    again at the start of every run. Bodies of an `FEBore` or `FEJournal` get this without a call.

    Results differ from Exudyn's on nodes of Tait-Bryan angles (``NodeType.RotationRxyz``) if more than one angle
    changes. Exudyn's equations lack the angular acceleration at constant rates of the angles: a tumbling body does not
    keep its angular momentum. With this replacement it does. On the other types of nodes both agree to round-off.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    objectNumber : exudyn.ObjectIndex
        An ObjectFFRFreducedOrder, as ``ObjectFFRFreducedOrderInterface.AddObjectFFRFreducedOrder`` makes it.

    Returns
    -------
    exudyn.ObjectIndex
        The new object, which has the equations.

    Raises
    ------
    InputError
        For another object; a body whose equations are user functions or already replaced; an assembled system.

    Examples
    --------
    After the example of `add_bore_modes`:

    >>> from exudyn.FEM import ObjectFFRFreducedOrderInterface
    >>> mbs = exu.SystemContainer().AddSystem()
    >>> parts = ObjectFFRFreducedOrderInterface(fem).AddObjectFFRFreducedOrder(mbs)
    >>> equations = ehd.ReplaceReducedBody(mbs, parts["oFFRFreducedOrder"])
    """
    require_system("ReplaceReducedBody", mbs, assembled=False)
    require_type("ReplaceReducedBody.objectNumber", objectNumber, ObjectIndex)
    body = mbs.GetObject(objectNumber)
    where = f"ReplaceReducedBody: object {int(objectNumber)} '{body['name']}' ({body['objectType']})"
    if body["objectType"] != "FFRFreducedOrder":
        raise InputError(f"{where} is no ObjectFFRFreducedOrder, the only body that has other equations.")
    if not body["computeFFRFterms"]:
        raise InputError(f"{where} has user functions for equations, or is replaced already; leave it as it is.")
    return own_equations(mbs, objectNumber)


def _joint(mbs: exu.MainSystem, number: Index) -> tuple[Data, str]:
    """Data of the joint, and its name for messages."""
    index = f"exu.ObjectIndex({number if isinstance(number, int) else '...'})"
    require_type("ReplaceJoint.objectNumber", number, ObjectIndex, hint=f"give {index}, as Exudyn returns it.")
    if not 0 <= int(number) < mbs.systemData.NumberOfObjects():
        raise InputError(f"ReplaceJoint.objectNumber: the system has no object {int(number)}.")
    joint = mbs.GetObject(number)
    kind = joint["objectType"]
    where = f"ReplaceJoint: object {int(number)} '{joint['name']}' ({kind})"
    if kind not in TYPES:
        raise InputError(
            f"{where} is none of the joints that a film can replace: {', '.join(TYPES)}; put a film between two bodies "
            "with CreateLubricatedJoint."
        )
    if not joint["activeConnector"]:
        raise InputError(
            f"{where} is inactive, or replaced already: a film would act where the model has no joint; set its "
            "activeConnector to True if it is to be replaced."
        )
    return joint, where


def _free_name(mbs: exu.MainSystem, joint: Data, number: int) -> str:
    """Name of the film: that of the joint, with its number if another joint has the same name."""
    name = f"film of {joint['name']}"
    return f"{name} (object {number})" if name in {known.name for known in joints_of(mbs)} else name


def _turns(joint: Data) -> bool:
    """Return whether a joint leaves one rotation free."""
    return joint["objectType"] != "JointGeneric" or sum(not held for held in joint["constrainedAxes"][3:]) == 1


def _freedom(joint: Data, where: str) -> tuple[int, bool]:
    """Axis of the free rotation in the joint's frame, and whether the joint holds the journal along it."""
    if joint["objectType"] != "JointGeneric":
        return 2, joint["objectType"] == "JointRevoluteZ"
    if joint["offsetUserFunction"] != 0 or joint["offsetUserFunction_t"] != 0:
        raise InputError(
            f"{where} has an offset function, which moves the joint, and a film can't follow it; {_LEAVE}, or move a "
            "body by a joint of its own."
        )
    if np.any(joint["offsetUserFunctionParameters"]):
        raise InputError(f"{where} has offsets, which a film can't have; move the markers instead.")
    held = [bool(axis) for axis in joint["constrainedAxes"]]
    if not _turns(joint):
        raise InputError(
            f"{where} has constrainedAxes={joint['constrainedAxes']}; of the last three, rotations, exactly one must "
            "be free for a film. At a shaft's end that may tilt, set its activeConnector to False and take "
            "CreateLubricatedJoint, whose axis says about what the shaft turns."
        )
    free = held[3:].index(False)
    if not (held[free - 1] and held[free - 2]):
        raise InputError(
            f"{where} has constrainedAxes={joint['constrainedAxes']}, which leaves the journal free across the axis "
            f"of its rotation, where a film would hold it; {_LEAVE}, or set these axes to 1."
        )
    return free, held[free]


def _side(mbs: exu.MainSystem, joint: Data, place: int, where: str) -> tuple[Index, np.ndarray]:
    """Rigid marker of a side, and the joint's frame (3, 3) on it in the reference configuration."""
    number = MarkerIndex(int(joint["markerNumbers"][place]))
    data = mbs.GetMarker(number)
    if joint["objectType"] == "JointRevolute2D":
        # such joints take positions; a film takes frames, or points that don't turn
        show = {"show": False}
        if data["markerType"] == "BodyPosition" and mbs.GetObject(data["bodyNumber"])["objectType"] not in MASS_POINTS:
            number = mbs.AddMarker(
                eii.MarkerBodyRigid(
                    bodyNumber=data["bodyNumber"], localPosition=data["localPosition"], visualization=show
                )
            )
        elif data["markerType"] == "NodePosition" and mbs.GetNode(data["nodeNumber"])["nodeType"] not in POINT_KINDS:
            number = mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=data["nodeNumber"], visualization=show))
        marker_item(mbs, f"{where}, markerNumbers[{place}]", number)
        return number, np.eye(3)
    item = marker_item(mbs, f"{where}, markerNumbers[{place}]", number)
    return number, item.rotation @ np.array(joint[f"rotationMarker{place}"], dtype=float)
