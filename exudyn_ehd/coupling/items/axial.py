"""The constraint that holds a journal along the axis of its joint, or against tilting, for the option `Held`."""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.items.bodies import body_of_node
from exudyn_ehd.coupling.items.item import Item
from exudyn_ehd.coupling.kinematics.rigid_nodes import POINTS
from exudyn_ehd.status import InputError

_WHERE = "CreateLubricatedJoint"


def hold(
    mbs: exu.MainSystem,
    name: str,
    housing: Item,
    journal: Item,
    points: tuple[np.ndarray, np.ndarray],
    rotation: np.ndarray,
    *,
    axial: bool,
    tilt: bool,
) -> Index:
    """Constrain the relative displacement along the joint axis, and the axes' angles to each other, to their values in
    the reference configuration."""
    asked, turns = ("tilt" if tilt else "axial"), []
    axial_offset = float(rotation[:, 2] @ (points[1] - points[0]))
    markers = []
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
                    f"reference configuration, got an axial distance of {axial_offset:.6g} m."
                )
            markers.append(item.marker)
            turns.append(item.rotation.T @ rotation)
            continue
        if axial and item.kind in POINTS:
            raise InputError(
                f"{_WHERE}: axial=Held() can't hold a mass point, which is the {label}; use axial=Free(), and "
                "constrain the point's own coordinates."
            )
        if item is journal:
            point = point - rotation[:, 2] * axial_offset
        transform = np.eye(4)
        transform[:3, :3] = item.node_rotation.T @ rotation
        transform[:3, 3] = item.node_rotation.T @ (point - item.node_position)
        markers.append(_rigid_marker(mbs, f"{name} {label}", item, transform, asked))
        turns.append(np.eye(3))
    if housing.kind is None:
        raise InputError(f"{_WHERE}: {asked}=Held() needs a rigid body, a rigid node or ground as housing.")
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


def _rigid_marker(mbs: exu.MainSystem, name: str, item: Item, transform: np.ndarray, asked: str) -> Index:
    """Marker at ``transform`` (4, 4) in the item's node frame, or in global space for ground."""
    if item.node is None or item.kind in POINTS:
        # a ground object of our own at the origin holds the marker; a point turns as little
        body = mbs.AddObject(eii.ObjectGround(name=name, visualization=eii.VObjectGround(show=False)))
    else:
        body = body_of_node(mbs, item.node)
        if body is None:
            raise InputError(f"{_WHERE}: {asked}=Held() needs the rigid body of node {int(item.node)}, add it before.")
    return mbs.AddMarker(eii.MarkerBodyRigid(name=name, bodyNumber=body, localHT=transform))
