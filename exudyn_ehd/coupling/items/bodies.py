"""Nodes and bodies of a scene, rigid and flexible, as items of a joint.

Each entry of itemNumbers is resolved to its position, its kinematics, and the side that it becomes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Data, Index, NodeIndex, Side, objects_of
from exudyn_ehd.coupling.items import beams
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.flexible_bodies import BeamSide
from exudyn_ehd.coupling.kinematics.sides import NODE_KINDS, NodeSide, node_side
from exudyn_ehd.status import InputError

POINT_KINDS = dict.fromkeys(("Point", "Point2D", "PointGround"), rigid_nodes.POINT)
MASS_POINTS = ("MassPoint", "MassPoint2D")
_MESH_HINT = "give MarkerSuperElementRigid on nodes of its mesh"


@dataclasses.dataclass(frozen=True, kw_only=True)
class Item:
    """One entry of itemNumbers, resolved.

    Attributes
    ----------
    position, rotation : ndarray (3,), (3, 3)
        Frame of the body, node or marker in the reference configuration, global; for a beam element that of its local
        coordinates, x along it.
    is_marker : bool
        True if it sets the joint point.
    kind : int or None
        Kind of rotation coordinates of its node; None unless it is a rigid body, a rigid node, a point or ground.
    planar : bool
        True if it moves in the global x-y plane only.
    inner : bool
        True if it moves relative to other points of the same body by coordinates of the body's only node (link of a
        tree, point of a mesh).
    marker : exudyn.MarkerIndex or None
        The given rigid marker.
    nodes : tuple
        Nodes on which it depends; a rigid body or a rigid node has one.
    node_position, node_rotation : ndarray (3,), (3, 3)
        Frame of its node (or of global space for ground) in the reference configuration.
    body : exudyn.ObjectIndex or None
        The reduced finite-element body; None for any other item.
    side : function of point (3,) and joint rotation (3, 3)
        Function that returns the side whose frame has this point and rotation in the reference state, global.
    """

    position: np.ndarray
    rotation: np.ndarray
    is_marker: bool
    kind: int | None
    side: Callable[[np.ndarray, np.ndarray], Side]
    planar: bool = False
    inner: bool = False
    marker: Index | None = None
    nodes: tuple[Index, ...] = ()
    node_position: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))
    node_rotation: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(3))
    body: Index | None = None


def ground_item(position: np.ndarray, rotation: np.ndarray) -> Item:
    """Item of ground with a given frame."""
    return Item(
        position=position,
        rotation=rotation,
        is_marker=False,
        kind=rigid_nodes.POINT,
        side=lambda point, joint: NodeSide(rigid_nodes.POINT, None, np.zeros(0), point, joint),
    )


def node_item(mbs: exu.MainSystem, where: str, node: Index) -> Item:
    """Node of a rigid body, a beam, a cable or a mass point."""
    data = mbs.GetNode(node)
    if data["nodeType"] in beams.SLOPE_NODES:
        return cable_item(mbs, where, (node,), None)
    if data["nodeType"] == "PointSlope23":
        place, frame = beams.reference_pose(mbs.GetNodeOutput, node)
        return Item(
            position=place,
            rotation=frame,
            is_marker=False,
            kind=None,
            nodes=(node,),
            side=lambda point, rotation: beams.marker_on_node(mbs, where, node, place, frame, point, rotation),
        )
    kind = (NODE_KINDS | POINT_KINDS).get(data["nodeType"])
    if kind is None:
        raise InputError(
            f"{where}: a node of type {data['nodeType']} has no rotation of its own and is no mass point; give a node "
            "of a rigid body, a beam or a cable, a mass point, or a rigid marker on the flexible body."
        )
    reference = np.array(data["referenceCoordinates"], dtype=float)
    if data["nodeType"] == "PointGround":
        return ground_item(reference, np.eye(3))
    if data["nodeType"] in POINT_KINDS:
        _require_point(mbs, where, node)
    nt = rigid_nodes.translations(kind, reference.size)
    position = np.zeros(3)
    position[:nt] = reference[:nt]
    rotation = rigid_nodes.rotation_of(kind, reference)
    return Item(
        position=position,
        rotation=rotation,
        is_marker=False,
        kind=kind,
        side=lambda point, joint: NodeSide(kind, node, reference, rotation.T @ (point - position), rotation.T @ joint),
        planar=nt == 2,
        nodes=(node,),
        node_position=position,
        node_rotation=rotation,
    )


def _require_point(mbs: exu.MainSystem, where: str, node: Index) -> None:
    """Raise `InputError` for a node without rotation that belongs to a body that turns, such as a mesh."""
    owners = _owners(mbs, node)
    if owners and not any(data["objectType"] in MASS_POINTS for _, data in owners):
        number, data = owners[0]
        raise InputError(
            f"{where}: node {int(node)} has no rotation of its own and is one of object {int(number)} '{data['name']}' "
            f"({data['objectType']}), which may turn; {_MESH_HINT}."
        )


def _owners(mbs: exu.MainSystem, node: Index) -> list[tuple[Index, Data]]:
    """Objects on a node, and their data."""
    return [(item, data) for item, data in objects_of(mbs) if int(node) in map(int, beams.element_nodes(data))]


def body_item(mbs: exu.MainSystem, where: str, body: Index) -> Item:
    """Body or ground."""
    data = mbs.GetObject(body)
    kind = data["objectType"]
    if kind == "Ground":
        place, turn = (np.array(data[name], dtype=float) for name in ("referencePosition", "referenceRotation"))
        return ground_item(place, turn)
    if kind in ("RigidBody", "RigidBody2D", *MASS_POINTS):
        return node_item(mbs, where, NodeIndex(int(data["nodeNumber"])))
    nodes = beams.element_nodes(data)
    if kind in beams.CABLES:
        return cable_item(mbs, where, nodes, float(data["length"]))
    if kind in beams.EXACT_BEAMS:
        return beam_item(mbs, where, nodes, float(data["length"]))
    if kind in ("ObjectANCFBeam", "RotationalMass1D", "Mass1D"):
        position, rotation = beams.reference_pose(mbs.GetObjectOutputBody, body, [0.0, 0.0, 0.0])
        return Item(
            position=position,
            rotation=rotation,
            is_marker=False,
            kind=None,
            nodes=nodes,
            side=lambda point, rotation: beams.marker_on_body(mbs, where, body, nodes, point, rotation),
        )
    if kind == "FFRFreducedOrder":
        return _reduced_body_item(mbs, where, body, nodes)
    hints = {
        "KinematicTree": "give MarkerKinematicTreeRigid on one of its links",
        "FFRF": _MESH_HINT,
        "GenericODE2": _MESH_HINT,
    }
    raise InputError(
        f"{where}: an object of type {kind} is no rigid body; "
        + hints.get(kind, "give a rigid body, a beam or cable element, a ground object, or a rigid marker on it")
        + "."
    )


def _reduced_body_item(mbs: exu.MainSystem, where: str, body: Index, nodes: tuple[Index, ...]) -> Item:
    """Reduced finite-element body, which without a marker supports a film on its bore or journal only."""
    rigid = node_item(mbs, where, nodes[0])

    def refuse(point: np.ndarray, rotation: np.ndarray) -> Side:
        raise InputError(
            f"{where}: an object of type FFRFreducedOrder is no rigid body; {_MESH_HINT}, or give the bearing "
            "bush=FEBore(fem=...) for a housing whose bore deforms under the film, journal=FEJournal(fem=...) for a "
            "journal that does."
        )

    return dataclasses.replace(
        rigid,
        kind=None,
        body=body,
        nodes=nodes,
        side=refuse,
    )


def cable_item(
    mbs: exu.MainSystem,
    where: str,
    nodes: tuple[Index, ...],
    length: float | None,
    x: float | None = None,
) -> Item:
    """Node (``length`` None) or element of cables; ``x`` is the place of a marker along the element."""
    reference = beams.node_coordinates(mbs, nodes)[0]
    dimension = beams.dimension_of(nodes, reference)
    place, slope = beams.cable_maps(dimension, length, 0.0 if x is None else x)
    return Item(
        position=place @ reference,
        rotation=beams.frame_along(slope @ reference, dimension == 2),
        is_marker=x is not None,
        kind=None,
        planar=dimension == 2,
        nodes=nodes,
        side=lambda point, rotation: beams.cable_side(where, nodes, reference, length, x, point, rotation),
    )


def beam_item(
    mbs: exu.MainSystem, where: str, nodes: tuple[Index, ...], length: float, transform: np.ndarray | None = None
) -> Item:
    """Element of a geometrically exact beam, or a marker on one at ``transform`` (4, 4), local coordinates."""
    ends = node_side(mbs, nodes[0]), node_side(mbs, nodes[1])
    local = np.eye(4) if transform is None else transform
    share = 0.5 + float(local[0, 3]) / length
    section = BeamSide(ends, share, np.zeros(3), np.eye(3)).section()
    place = (1.0 - share) * ends[0].frame[:, 3] + share * ends[1].frame[:, 3]
    return Item(
        position=place + section[:, 1:] @ local[1:3, 3],
        rotation=section @ local[:3, :3],
        is_marker=transform is not None,
        kind=None,
        planar=ends[0].kind == rigid_nodes.PLANAR,
        nodes=nodes,
        side=lambda point, joint: beams.beam_side(where, ends, None if transform is None else share, point, joint),
    )


def body_of_node(mbs: exu.MainSystem, node: Index) -> Index | None:
    """The rigid body or mass point that moves ``node``, or None if there is none yet."""
    kinds = ("RigidBody", "RigidBody2D", *MASS_POINTS)
    return next((item for item, data in _owners(mbs, node) if data["objectType"] in kinds), None)
