"""Rigid markers as items of a joint, those on finite elements in absolute coordinates too; items by their number."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import REFERENCE, Data, Index, MarkerIndex, NodeIndex, ObjectIndex, Side
from exudyn_ehd.coupling.items.beams import CABLES, EXACT_BEAMS, SLOPE_NODES, element_nodes, node_coordinates
from exudyn_ehd.coupling.items.bodies import (
    MASS_POINTS,
    POINT_KINDS,
    Item,
    beam_item,
    body_item,
    cable_item,
    node_item,
)
from exudyn_ehd.coupling.kinematics.fitted_sides import FittedSide, fitted_rotation
from exudyn_ehd.coupling.kinematics.sides import NODE_KINDS, FloatingSide, MarkerSide, TreeSide, node_side
from exudyn_ehd.status import InputError

_RIGID_MARKERS = ("BodyRigid", "NodeRigid", "SuperElementRigid", "KinematicTreeRigid")
# How far weights may be from adding up to one; they are typed, or sums of many.
WEIGHTS = 1e-6


def marker_item(mbs: exu.MainSystem, where: str, marker: Index) -> Item:
    """Rigid marker, or marker of a position on a cable or a mass point."""
    data = mbs.GetMarker(marker)
    item = _known_marker_item(mbs, where, data)
    if item is not None:
        return dataclasses.replace(item, marker=marker, is_marker=True)
    if data["markerType"] == "SuperElementRigid":
        body = mbs.GetObject(data["bodyNumber"])
        if body["objectType"] not in ("FFRF", "FFRFreducedOrder"):
            return mesh_item(mbs, where, marker, data, body)
    if data["markerType"] not in _RIGID_MARKERS:
        raise InputError(
            f"{where}: a marker of type {data['markerType']} has no orientation; give a rigid marker, e.g. "
            "MarkerBodyRigid or MarkerNodeRigid."
        )
    reference, output = REFERENCE, exu.OutputVariableType
    rotation = np.array(mbs.GetMarkerOutput(marker, output.RotationMatrix, reference), dtype=float).reshape(3, 3)
    make, nodes = _marker_side(mbs, marker, data)
    return Item(
        position=np.array(mbs.GetMarkerOutput(marker, output.Position, reference), dtype=float),
        rotation=rotation,
        is_marker=True,
        kind=None,
        inner=data["markerType"] in ("KinematicTreeRigid", "SuperElementRigid"),
        marker=marker,
        nodes=nodes,
        build=lambda point, joint: make(rotation.T @ joint),
    )


def _known_marker_item(mbs: exu.MainSystem, where: str, data: Data) -> Item | None:
    """Item of a marker on a body or node whose kinematics are known here; None for any other."""
    kind = data["markerType"]
    if kind in ("NodeRigid", "NodePosition"):
        node = NodeIndex(int(data["nodeNumber"]))
        node_type = mbs.GetNode(node)["nodeType"]
        if node_type in SLOPE_NODES:
            return cable_item(mbs, where, (node,), SLOPE_NODES[node_type], None, 0.0)
        if kind == "NodeRigid" and node_type in NODE_KINDS:
            return _transformed(node_item(mbs, where, node), data)
        if node_type in POINT_KINDS:
            return node_item(mbs, where, node)
    if kind in ("BodyRigid", "BodyPosition"):
        body = mbs.GetObject(data["bodyNumber"])
        if body["objectType"] in CABLES:
            local = np.array(data["localHT"])[:3, 3] if kind == "BodyRigid" else np.array(data["localPosition"])
            item = cable_item(
                mbs,
                where,
                element_nodes(body),
                CABLES[body["objectType"]],
                float(body["length"]),
                float(local[0]),
            )
            turn = np.array(data["localHT"])[:3, :3] if kind == "BodyRigid" else np.eye(3)
            return dataclasses.replace(
                item, position=item.position + item.rotation[:, 1:] @ local[1:], rotation=item.rotation @ turn
            )
        if kind == "BodyRigid" and body["objectType"] in EXACT_BEAMS:
            return beam_item(mbs, where, element_nodes(body), float(body["length"]), np.array(data["localHT"]))
        if kind == "BodyRigid" and body["objectType"] in ("Ground", "RigidBody", "RigidBody2D"):
            return _transformed(body_item(mbs, where, data["bodyNumber"]), data)
        if body["objectType"] in MASS_POINTS:
            item = body_item(mbs, where, data["bodyNumber"])
            return dataclasses.replace(item, position=item.position + np.array(data["localPosition"]))
    return None


def _transformed(base: Item, data: Data) -> Item:
    transform = np.array(data["localHT"], dtype=float)
    return dataclasses.replace(
        base,
        position=base.position + base.rotation @ transform[:3, 3],
        rotation=base.rotation @ transform[:3, :3],
    )


def _marker_side(
    mbs: exu.MainSystem, marker: Index, data: Data
) -> tuple[Callable[[np.ndarray], Side], tuple[Index, ...]]:
    """Function from the rotation of the joint frame in the marker's to the side, and the nodes it depends on."""
    if "nodeNumber" in data:
        nodes: tuple[Index, ...] = (NodeIndex(int(data["nodeNumber"])),)
    else:
        nodes = element_nodes(mbs.GetObject(data["bodyNumber"] if "bodyNumber" in data else data["objectNumber"]))
    if data["markerType"] == "SuperElementRigid":
        return (lambda rotation: FloatingSide(marker, list(nodes), rotation, node_side(mbs, nodes[0]))), nodes
    side = TreeSide if data["markerType"] == "KinematicTreeRigid" else MarkerSide
    return (lambda rotation: side(marker, list(nodes), rotation)), nodes


def mesh_item(mbs: exu.MainSystem, where: str, marker: Index, data: Data, body: Data) -> Item:
    """Item of a MarkerSuperElementRigid on nodes that are points.

    Raises
    ------
    InputError
        Nodes that are no points, weights that don't add up to one, nodes on one line.
    """
    numbers = element_nodes(body)
    own = [mbs.GetNode(numbers[int(i)]) for i in np.array(data["meshNodeNumbers"], dtype=int)]
    for node in own:
        if node["nodeType"] not in ("Point", "PointGround"):
            raise InputError(
                f"{where}: MarkerSuperElementRigid on a node of type {node['nodeType']} has a rotation that is linear "
                "in the displacements, wrong for a body that turns; give one on NodePoint, or a marker on a rigid body "
                "that is joined to the mesh."
            )
    moving = np.array([node["nodeType"] == "Point" for node in own])
    nodes = tuple(numbers[int(i)] for i, moves in zip(data["meshNodeNumbers"], moving, strict=True) if moves)
    weights = np.array(data["weightingFactors"], dtype=float)
    if not abs(weights.sum() - 1.0) <= WEIGHTS:
        raise InputError(
            f"{where}: weightingFactors of the marker must add up to 1, got {weights.sum():.9g}; divide them by it."
        )
    weights = weights / weights.sum()
    points = np.array([node["referenceCoordinates"] for node in own], dtype=float)
    if fitted_rotation(weights, points - weights @ points, points) is None:
        raise InputError(f"{where}: the nodes of the marker lie on one line and fix no rotation; give more of them.")
    size = 3 * len(nodes)
    places = np.flatnonzero(np.repeat(moving, 3)), np.arange(size)
    reference, initial, velocities = node_coordinates(mbs, nodes)
    output, configuration = exu.OutputVariableType, REFERENCE
    return Item(
        position=np.array(mbs.GetMarkerOutput(marker, output.Position, configuration), dtype=float),
        rotation=np.array(mbs.GetMarkerOutput(marker, output.RotationMatrix, configuration)).reshape(3, 3),
        is_marker=True,
        kind=None,
        inner=True,
        marker=marker,
        nodes=nodes,
        build=lambda point, rotation: FittedSide(list(nodes), size, points, places, weights, point, rotation),
        reference_coordinates=reference,
        initial_coordinates=initial,
        initial_velocities=velocities,
    )


def resolve(mbs: exu.MainSystem, where: str, number: object) -> Item:
    """Find out what an item number stands for.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system.
    where : str
        Name of the argument for messages.
    number : exudyn.ObjectIndex, NodeIndex or MarkerIndex
        The item; an int counts as an object, as in Exudyn.

    Raises
    ------
    InputError
        If it is no such item, or nothing that can turn.
    """
    try:
        if isinstance(number, MarkerIndex):
            return marker_item(mbs, where, number)
        if isinstance(number, NodeIndex):
            return node_item(mbs, where, number)
        if isinstance(number, ObjectIndex) or (isinstance(number, int) and not isinstance(number, bool)):
            return body_item(mbs, where, ObjectIndex(int(number)))
    except exu.ExudynError as error:
        raise InputError(f"{where} is not an item of this system: {number!r} ({error}).") from None
    raise InputError(
        f"{where} must be an ObjectIndex (body or ground), a NodeIndex (rigid-body, beam, cable or point node) or a "
        f"MarkerIndex (rigid marker), got {number!r}; pass what AddObject, AddNode, AddMarker or mbs.Create... "
        "returned."
    )
