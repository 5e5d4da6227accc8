"""Items, joint frame and joint points, checked, from the arguments of `CreateLubricatedJoint`.

The module also adds the constraint of the option `Held`, which holds a journal along the joint's axis or against
tilting.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, cast

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.rigidBodyUtilities import (
    AngularVelocity2EulerParameters_t,
    HomogeneousTransformation,
    RigidBodyInertia,
    RotationMatrix2EulerParameters,
)
from numpy.typing import ArrayLike

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import INITIAL, Index, Side
from exudyn_ehd.coupling.items.beams import node_coordinates
from exudyn_ehd.coupling.items.bodies import Item, body_of_node
from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.coupling.items.reduced_bodies import initial_frame
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.coupling.kinematics.relative import BoreGap, eccentricity_ratios
from exudyn_ehd.coupling.kinematics.rigid_nodes import PLACE, POINT, SPIN, VELOCITY
from exudyn_ehd.coupling.kinematics.sides import MarkerSide
from exudyn_ehd.solid.mesh import frame_of
from exudyn_ehd.status import InputError, require_vector

_WHERE = "CreateLubricatedJoint"


def place_joint(
    where: str,
    mbs: exu.MainSystem,
    itemNumbers: Sequence[object],
    position: Sequence[float] | np.ndarray,
    axis: Sequence[float] | np.ndarray,
    matrix: ArrayLike | None,
    use_global: bool,
    names: tuple[str, str] = ("housing", "journal"),
) -> tuple[Item, Item, tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Return both items, their joint points (3,) and the joint frame (3, 3), global, with checks named ``where``."""
    with in_the_name_of(where, *names):
        housing, journal = resolve_pair(mbs, itemNumbers)
        rotation = joint_rotation(housing, axis, matrix, use_global)
        return housing, journal, joint_points(housing, journal, position, use_global), rotation


def resolve_pair(mbs: exu.MainSystem, itemNumbers: Sequence[object]) -> tuple[Item, Item]:
    """Housing and journal of ``itemNumbers``; `InputError` for unsupported items."""
    where = f"{_WHERE}.itemNumbers"
    if not isinstance(itemNumbers, (list, tuple)) or len(itemNumbers) != 2:
        raise InputError(f"{where} must be [housing, journal], got {itemNumbers!r}.")
    housing, journal = (resolve(mbs, f"{where}[{k}]", number) for k, number in enumerate(itemNumbers))
    if not housing.nodes and not journal.nodes:
        raise InputError(f"{where}: both items are ground; one of them must move, got {list(itemNumbers)!r}.")
    shared = {int(node) for node in housing.nodes} & {int(node) for node in journal.nodes}
    # two points that move relative to each other may share a node: Exudyn adds both contributions of an object to it
    inner = {int(item.marker) for item in (housing, journal) if item.inner and item.marker is not None}
    if shared and len(inner) < 2:
        raise InputError(
            f"{where}: housing and journal are the same body, got {list(itemNumbers)!r}; give two different bodies."
        )
    return housing, journal


def joint_rotation(
    housing: Item, axis: Sequence[float] | np.ndarray, matrix: ArrayLike | None, use_global: bool
) -> np.ndarray:
    """Joint frame (3, 3) in the reference configuration, columns x, y, z global."""
    to_global = np.eye(3) if use_global else housing.rotation
    given = np.size(axis) > 0
    z = np.zeros(3)
    if given:
        z = require_vector(f"{_WHERE}.axis", axis, 3)
        if not np.linalg.norm(z) > 0.0:
            raise InputError(f"{_WHERE}.axis must not be zero, got {axis!r}.")
        z = to_global @ (z / np.linalg.norm(z))
    if matrix is not None:
        rotation = to_global @ checked_rotation(f"{_WHERE}.rotationMatrixAxes", matrix)
        # 1e-9: an axis and a matrix typed or computed in double precision agree far better
        if given and np.linalg.norm(np.cross(z, rotation[:, 2])) + max(0.0, -z @ rotation[:, 2]) > 1e-9:
            raise InputError(
                f"{_WHERE}.axis and the third column of rotationMatrixAxes must agree, got {axis!r} and "
                f"{np.asarray(matrix)[:, 2]}; leave axis=[]."
            )
        return rotation
    if not given:
        raise InputError(f"{_WHERE}.axis is missing; give the direction of the joint axis, e.g. axis=[0, 0, 1].")
    x, y, _ = housing.rotation.T
    # only if they are parallel to round-off: otherwise the projection is defined
    return frame_of(z, x if np.linalg.norm(np.cross(z, x)) > 1e-6 else y)


def checked_rotation(where: str, matrix: ArrayLike) -> np.ndarray:
    """Return the argument ``where`` as an array (3, 3); `InputError` unless it is a rotation."""
    try:
        rotation = np.array(matrix, dtype=float)
    except (TypeError, ValueError, OverflowError):
        rotation = np.zeros(0)
    if rotation.shape != (3, 3) or not np.all(np.isfinite(rotation)):
        raise InputError(f"{where} must be a rotation matrix (3, 3), got {matrix!r}.")
    # 1e-8: a matrix computed in double precision is orthonormal to 1e-15, one typed with few digits is not meant
    if np.abs(rotation.T @ rotation - np.eye(3)).max() > 1e-8 or np.linalg.det(rotation) < 0.0:
        raise InputError(f"{where} must be orthonormal and right-handed, got {matrix!r}; its columns are the axes.")
    return rotation


def joint_points(
    housing: Item, journal: Item, position: Sequence[float] | np.ndarray, use_global: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Joint point of either side in the reference configuration, global [m]."""
    if housing.is_marker or journal.is_marker:
        if np.size(position):
            raise InputError(f"{_WHERE}.position must be [] if a marker is given, which sets it; got {position!r}.")
        known = [item.position for item in (housing, journal) if item.is_marker]
        return known[0].copy(), known[-1].copy()
    point = require_vector(f"{_WHERE}.position", position, 3, "m")
    if not use_global:
        point = housing.position + housing.rotation @ point
    return point, point.copy()


def move_to_start(mbs: exu.MainSystem, items: tuple[Item, Item], sides: tuple[Side, Side]) -> bool:
    """Update both sides to the initial configuration; return False for markers, whose state needs Assemble."""
    if any(isinstance(side, MarkerSide) for side in sides):
        return False
    for k, (item, side) in enumerate(zip(items, sides, strict=True)):
        reference, q, q_t = node_coordinates(mbs, item.nodes)
        if not np.isfinite(np.concatenate((reference, q))).all():
            raise InputError(f"{_WHERE}.itemNumbers[{k}]: the initial coordinates of its node are not finite.")
        side.update(mbs, q, q_t, INITIAL)
    return True


def check_start(bearing: JournalBearing, sides: tuple[Side, Side], yields: Callable[[np.ndarray], bool]) -> None:
    """Raise `InputError` if the journal is not inside the bore in the initial state of the updated sides.

    ``yields``: function of a motion (10,) that tells whether a flexible bore has a film there.
    """
    motion, bore, length = relative.motion_of(*(side.frame for side in sides)), BoreGap(bearing), bearing.length
    gap = bore.smallest(motion)
    tilt = math.hypot(motion[2], motion[3]) if math.isfinite(motion[2]) else math.inf
    if gap > 0.0 or (math.isfinite(gap) and yields(motion)):
        return
    if tilt * length >= 2.0 * bore.widest:
        raise InputError(
            f"{_WHERE}: the axes of the two bodies are not parallel within the clearance in the initial configuration: "
            f"tilt {tilt:.6g} rad, at most {2.0 * bore.widest / length:.6g} rad fit (2 c / L); check "
            "the initial rotations."
        )
    c = bearing.radial_clearance
    ratios = eccentricity_ratios(motion, c, length)
    raise InputError(
        f"{_WHERE}: the journal is outside the bore in the initial configuration: eccentricity "
        f"{c * ratios[0]:.6g} m in the mid-plane, {c * ratios[1]:.6g} m at an end, radial clearance "
        f"{c:.6g} m, smallest gap {gap:.6g} m; check the initial positions, and whether the "
        "clearance is radial."
    )


def hold(
    mbs: exu.MainSystem,
    name: str,
    items: tuple[Item, Item],
    points: tuple[np.ndarray, np.ndarray],
    rotation: np.ndarray,
    *,
    axial: bool,
    tilt: bool,
) -> Index | None:
    """Constrain the relative axial displacement, and the angles between the axes, to their reference values.

    Returns None if neither is to be held.
    """
    # planar bodies cannot move axially or tilt, points cannot turn: a constraint would be empty and singular
    moves = not all(item.planar or not item.nodes for item in items)
    axial, tilt = axial and moves, tilt and moves and not all(item.kind == POINT for item in items)
    if not (axial or tilt):
        return None
    housing, journal = items
    asked, axial_offset = ("tilt" if tilt else "axial"), float(rotation[:, 2] @ (points[1] - points[0]))
    markers, turns = [], []
    for label, item, point in (("housing", housing, points[0]), ("journal", journal, points[1])):
        if item.kind is None:
            if item.marker is None or mbs.GetMarker(item.marker)["markerType"].endswith("Position"):
                raise InputError(
                    f"{_WHERE}: {asked}=Held() needs a rigid marker where the {label} is a flexible body, and none "
                    f"exists on spatial cables; use {asked}=Free(), with a constraint of your own if one is needed."
                )
            if axial and abs(axial_offset) > 0.0:
                raise InputError(
                    f"{_WHERE}: with axial=Held() the two markers must lie in one plane normal to the axis in the "
                    f"reference configuration, got an axial distance of {axial_offset:.6g} m; shift one of them along "
                    "the axis, or take axial=Free()."
                )
            markers.append(item.marker)
            turns.append(item.rotation.T @ rotation)
            continue
        if axial and item.nodes and item.kind == POINT:
            raise InputError(
                f"{_WHERE}: axial=Held() can't hold a mass point, which is the {label}; use axial=Free(), and "
                "constrain the point's own coordinates."
            )
        if item is journal:
            point = point - rotation[:, 2] * axial_offset
        markers.append(rigid_marker(mbs, f"{name} {label}", item, point, rotation, f"{asked}=Held()"))
        turns.append(np.eye(3))
    if housing.kind is None:
        raise InputError(
            f"{_WHERE}: {asked}=Held() needs a rigid body, a rigid node or ground as housing, not a link of a "
            "kinematic tree or a flexible body; exchange housing and journal (itemNumbers; in ReplaceJoint "
            f"journal=0 in place of 1), or take {asked}=Free() and a constraint of your own if one is needed."
        )
    return mbs.AddObject(
        eii.ObjectJointGeneric(
            name=f"{name} {'held' if tilt else 'axial'}",
            markerNumbers=markers,
            rotationMarker0=turns[0],
            rotationMarker1=turns[1],
            constrainedAxes=[0, 0, int(axial), int(tilt), int(tilt), 0],
            visualization=eii.VObjectJointGeneric(show=False),
        )
    )


def rigid_marker(
    mbs: exu.MainSystem, name: str, item: Item, point: np.ndarray, rotation: np.ndarray, asked: str
) -> Index:
    """Marker on the body of a rigid item, or on ground, at a point (3,) with a frame (3, 3), global."""
    local = item.node_rotation.T
    transform = HomogeneousTransformation(local @ rotation, local @ (point - item.node_position))
    if item.kind == POINT:
        # on a new ground object at the origin, also for a moving point, which does not turn either
        body = mbs.AddObject(eii.ObjectGround(name=name, visualization=eii.VObjectGround(show=False)))
    else:
        if (body := body_of_node(mbs, item.nodes[0])) is None:
            raise InputError(f"{_WHERE}: {asked} needs the rigid body of node {int(item.nodes[0])}, add it before.")
    return mbs.AddMarker(eii.MarkerBodyRigid(name=name, bodyNumber=body, localHT=transform))


def add_body_on(
    mbs: exu.MainSystem,
    name: str,
    item: Item,
    point: np.ndarray,
    rotation: np.ndarray,
    inertia: RigidBodyInertia,
    gravity: ArrayLike,
    **shown: Any,
) -> Index:
    """Add a rigid body at a point (3,) with a frame (3, 3), global, that moves with an item at the start."""
    frame = initial_frame(mbs, item.side(point, rotation))
    # Exudyn takes angular velocities as those of the reference rotation
    turning = AngularVelocity2EulerParameters_t(frame[:, SPIN], RotationMatrix2EulerParameters(frame[:, :3]))
    body = mbs.CreateRigidBody(
        name=name,
        inertia=inertia,
        referencePosition=point,
        referenceRotationMatrix=rotation,
        initialDisplacement=frame[:, PLACE] - point,
        initialRotationMatrix=rotation.T @ frame[:, :3],
        gravity=gravity,
        returnDict=True,
        **shown,
    )
    mbs.SetNodeParameter(body["nodeNumber"], "initialVelocities", [*frame[:, VELOCITY], *turning])
    return cast(Index, body["bodyNumber"])


def hold_at_pivot(
    mbs: exu.MainSystem,
    name: str,
    items: tuple[Item, Item],
    pivot: np.ndarray,
    frame: np.ndarray,
    held: Sequence[int],
    spring: tuple[list[float], float | None, float],
) -> list[Index]:
    """Hold a pad on its housing at a pivot (3,) with a frame (3, 3), global, in the axes ``held`` (6,) of the frame.

    ``spring`` is an axis (3,) of the frame, along which the pivot has a stiffness, N/m, and a damping, N s/m; a
    stiffness of None adds no spring.
    """
    markers = [
        rigid_marker(mbs, f"{name} {part}", item, pivot, frame, "a pad")
        for part, item in zip(("seat", "pivot"), items, strict=True)
    ]
    axis, stiffness, damping = spring
    joint = eii.ObjectJointGeneric(
        name=f"{name} pivot",
        markerNumbers=markers,
        constrainedAxes=list(held),
        visualization=eii.VObjectJointGeneric(show=False),
    )
    support = eii.ObjectConnectorLinearSpringDamper(
        name=f"{name} spring",
        markerNumbers=markers,
        stiffness=stiffness or 0.0,
        damping=damping,
        axisMarker0=axis,
        visualization=eii.VObjectConnectorLinearSpringDamper(show=False),
    )
    return [mbs.AddObject(item) for item in (joint, support)[: 1 if stiffness is None else 2]]


@contextmanager
def in_the_name_of(where: str, housing: str, journal: str) -> Iterator[None]:
    """Context in which error messages of `CreateLubricatedJoint` name another call and its two items."""
    try:
        yield
    except InputError as error:
        said = str(error).replace(_WHERE, where).replace("housing", housing)
        raise InputError(said.replace("journal", journal)) from None
