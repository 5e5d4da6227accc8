"""From the item numbers of a scene (body, ground, node, rigid marker) to the carriers of a joint frame."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Index, MarkerIndex, NodeIndex, ObjectIndex, Side
from exudyn_ehd.coupling.items import beams
from exudyn_ehd.coupling.items.beams import CABLES, EXACT_BEAMS, SLOPE_NODES
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.beam_sides import BeamSide
from exudyn_ehd.coupling.kinematics.sides import FloatingSide, MarkerSide, MeshSide, NodeSide, TreeSide
from exudyn_ehd.status import InputError

_NODE_KINDS = {
    "RigidBodyEP": rigid_nodes.EULER_PARAMETERS,
    "RigidBodyRxyz": rigid_nodes.TAIT_BRYAN,
    "RigidBodyRotVecLG": rigid_nodes.ROTATION_VECTOR,
    "RigidBody2D": rigid_nodes.PLANAR,
}
_MESH_HINT = "give MarkerSuperElementRigid on nodes of its mesh"
_RIGID_MARKERS = ("BodyRigid", "NodeRigid", "SuperElementRigid", "KinematicTreeRigid")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Item:
    """One entry of itemNumbers, resolved.

    Attributes
    ----------
    position, rotation : ndarray (3,), (3, 3)
        Its frame in the reference configuration, global: the body's, the node's or the marker's; of a beam element that of its local
        coordinates, x along it.
    is_marker : bool
        Whether it fixes the joint point itself.
    kind : int or None
        How its node turns, None for anything but a rigid body, a rigid node or ground.
    planar : bool
        Whether it moves in the global x-y plane only.
    inner : bool
        Whether it moves against other points of its own body by coordinates of the body's one node (link of a tree, point of a mesh).
    node : exudyn.NodeIndex or None
        The rigid node.
    marker : exudyn.MarkerIndex or None
        The rigid marker that was given.
    nodes : tuple
        Nodes it depends on.
    node_position, node_rotation : ndarray (3,), (3, 3)
        Frame of its node (or of global space for ground) in the reference configuration.
    reference_coordinates, initial_coordinates, initial_velocities : ndarray (n,)
        Of its nodes; empty if only Exudyn's marker knows.
    body, node_kind : exudyn.ObjectIndex, int
        The reduced finite-element body, and how its rigid node turns; None for any other item.
    build : function of point (3,) and joint rotation (3, 3), or None
        Makes the side; None for rigid nodes and ground.
    """

    position: np.ndarray
    rotation: np.ndarray
    is_marker: bool
    kind: int | None
    planar: bool = False
    inner: bool = False
    node: Index | None = None
    marker: Index | None = None
    nodes: tuple[Index, ...] = ()
    node_position: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))
    node_rotation: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(3))
    reference_coordinates: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    initial_coordinates: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    initial_velocities: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    body: Index | None = None
    node_kind: int | None = None
    build: Callable[[np.ndarray, np.ndarray], Side] | None = None

    def side(self, point: np.ndarray, joint_rotation: np.ndarray) -> Side:
        """Carrier of the frame that has global position ``point`` and ``joint_rotation`` in the reference state."""
        if self.build is not None:
            return self.build(point, joint_rotation)
        assert self.kind is not None
        reference = np.zeros(0) if self.node is None else self.reference_coordinates
        rho = self.node_rotation.T @ (point - self.node_position)
        return NodeSide(self.kind, self.node, reference, rho, self.node_rotation.T @ joint_rotation)


def resolve(mbs: exu.MainSystem, where: str, number: Index) -> Item:
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
            return _marker_item(mbs, where, number)
        if isinstance(number, NodeIndex):
            return _node_item(mbs, where, number)
        if isinstance(number, ObjectIndex) or (isinstance(number, int) and not isinstance(number, bool)):
            return _body_item(mbs, where, ObjectIndex(int(number)))
    except exu.ExudynError as error:
        raise InputError(f"{where} is not an item of this system: {number!r} ({error}).") from None
    raise InputError(
        f"{where} must be an ObjectIndex (body or ground), a NodeIndex (rigid-body, beam or cable node) or a MarkerIndex (rigid "
        f"marker), got {number!r}; pass what AddObject, AddNode, AddMarker or mbs.Create... returned."
    )


def _node_item(mbs: exu.MainSystem, where: str, node: Index) -> Item:
    data = mbs.GetNode(node)
    if data["nodeType"] in SLOPE_NODES:
        return _cable_item(mbs, where, (node,), SLOPE_NODES[data["nodeType"]], None)
    if data["nodeType"] == "PointSlope23":
        return _slope_pair_item(mbs, where, node)
    kind = _NODE_KINDS.get(data["nodeType"])
    if kind is None:
        raise InputError(
            f"{where}: a node of type {data['nodeType']} has no rotation of its own; give a node of a rigid body, a beam or a cable, or a "
            "rigid marker on the flexible body."
        )
    reference = np.array(data["referenceCoordinates"], dtype=float)
    nt = 2 if kind == rigid_nodes.PLANAR else 3
    position = np.zeros(3)
    position[:nt] = reference[:nt]
    rotation, _ = rigid_nodes.node_rotation(kind, reference[nt:])
    return Item(
        position=position,
        rotation=rotation,
        is_marker=False,
        kind=kind,
        planar=kind == rigid_nodes.PLANAR,
        node=node,
        nodes=(node,),
        node_position=position,
        node_rotation=rotation,
        reference_coordinates=reference,
        initial_coordinates=np.array(data["initialCoordinates"], dtype=float),
        initial_velocities=np.array(data["initialVelocities"], dtype=float),
    )


def _body_item(mbs: exu.MainSystem, where: str, body: Index) -> Item:
    data = mbs.GetObject(body)
    kind = data["objectType"]
    if kind == "Ground":
        return Item(
            position=np.array(data["referencePosition"], dtype=float),
            rotation=np.array(data["referenceRotation"], dtype=float),
            is_marker=False,
            kind=rigid_nodes.GROUND,
        )
    if kind in ("RigidBody", "RigidBody2D"):
        return _node_item(mbs, where, NodeIndex(int(data["nodeNumber"])))
    nodes = beams.element_nodes(data) if "nodeNumbers" in data or "nodeNumber" in data else ()
    if kind in CABLES:
        return _cable_item(mbs, where, nodes, CABLES[kind], float(data["length"]))
    if kind in EXACT_BEAMS:
        return _beam_item(mbs, where, nodes, float(data["length"]))
    if kind in ("ObjectANCFBeam", "RotationalMass1D"):
        output, reference = exu.OutputVariableType, exu.ConfigurationType.Reference
        place = [
            mbs.GetObjectOutputBody(body, o, [0.0] * 3, reference) for o in (output.Position, output.RotationMatrix)
        ]
        return Item(
            position=np.array(place[0]),
            rotation=np.array(place[1]).reshape(3, 3),
            is_marker=False,
            kind=None,
            nodes=nodes,
            build=lambda point, rotation: beams.marker_on_body(mbs, where, body, nodes, point, rotation),
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
    """Reduced finite-element body, which can hold a film in its bore and nothing else without a marker."""
    rigid = _node_item(mbs, where, nodes[0])
    reference, initial, velocities = beams.node_coordinates(mbs, nodes)

    def refuse(point: np.ndarray, rotation: np.ndarray) -> Side:
        raise InputError(
            f"{where}: an object of type FFRFreducedOrder is no rigid body; {_MESH_HINT}, or give the bearing bush=FEBore(fem=...) for a housing "
            "whose bore deforms under the film."
        )

    return dataclasses.replace(
        rigid,
        kind=None,
        node_kind=rigid.kind,
        body=body,
        nodes=nodes,
        reference_coordinates=reference,
        initial_coordinates=initial,
        initial_velocities=velocities,
        build=refuse,
    )


def _slope_pair_item(mbs: exu.MainSystem, where: str, node: Index) -> Item:
    """Node of an ANCF beam."""
    output, reference = exu.OutputVariableType, exu.ConfigurationType.Reference
    place = np.array(mbs.GetNodeOutput(node, output.Position, reference))
    frame = np.array(mbs.GetNodeOutput(node, output.RotationMatrix, reference)).reshape(3, 3)
    return Item(
        position=place,
        rotation=frame,
        is_marker=False,
        kind=None,
        nodes=(node,),
        build=lambda point, rotation: beams.marker_on_node(mbs, where, node, place, frame, point, rotation),
    )


def _cable_item(
    mbs: exu.MainSystem,
    where: str,
    nodes: tuple[Index, ...],
    dimension: int,
    length: float | None,
    x: float | None = None,
) -> Item:
    """Node (``length`` None) or element of cables; ``x`` is the place of a marker along the element."""
    reference, initial, velocities = beams.node_coordinates(mbs, nodes)
    place, slope = beams.cable_maps(dimension, length, 0.0 if x is None else x)
    return Item(
        position=place @ reference,
        rotation=beams.frame_along(slope @ reference, dimension == 2),
        is_marker=x is not None,
        kind=None,
        planar=dimension == 2,
        nodes=nodes,
        build=lambda point, rotation: beams.cable_side(where, nodes, reference, length, x, point, rotation),
        reference_coordinates=reference,
        initial_coordinates=initial,
        initial_velocities=velocities,
    )


def _beam_item(
    mbs: exu.MainSystem, where: str, nodes: tuple[Index, ...], length: float, transform: np.ndarray | None = None
) -> Item:
    """Element of a geometrically exact beam; ``transform`` (4, 4) that of a marker in the element's local coordinates."""
    ends = beams.beam_ends(mbs, nodes, _NODE_KINDS)
    reference, initial, velocities = beams.node_coordinates(mbs, nodes)
    share = None if transform is None else 0.5 + float(transform[0, 3]) / length
    position = 0.5 * (ends[0].frame[:, 3] + ends[1].frame[:, 3])
    rotation = BeamSide(ends, 0.5 if share is None else share, position, np.eye(3)).section()
    if transform is not None:
        assert share is not None
        position = (1.0 - share) * ends[0].frame[:, 3] + share * ends[1].frame[:, 3]
        position = position + rotation[:, 1:] @ transform[1:3, 3]
        rotation = rotation @ transform[:3, :3]
    return Item(
        position=position,
        rotation=rotation,
        is_marker=transform is not None,
        kind=None,
        planar=ends[0].kind == rigid_nodes.PLANAR,
        nodes=nodes,
        build=lambda point, joint: beams.beam_side(where, ends, share, point, joint),
        reference_coordinates=reference,
        initial_coordinates=initial,
        initial_velocities=velocities,
    )


def _marker_item(mbs: exu.MainSystem, where: str, marker: Index) -> Item:
    data = mbs.GetMarker(marker)
    item = _known_marker_item(mbs, where, data)
    if item is not None:
        return dataclasses.replace(item, marker=marker, is_marker=True)
    if data["markerType"] not in _RIGID_MARKERS:
        raise InputError(
            f"{where}: a marker of type {data['markerType']} has no orientation; give a rigid marker, e.g. MarkerBodyRigid or "
            "MarkerNodeRigid."
        )
    reference, output = exu.ConfigurationType.Reference, exu.OutputVariableType
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


def _known_marker_item(mbs: exu.MainSystem, where: str, data: dict[str, Any]) -> Item | None:
    """Item of a marker on a body or node whose kinematics are known here; None for any other."""
    kind = data["markerType"]
    if kind in ("NodeRigid", "NodePosition"):
        node = NodeIndex(int(data["nodeNumber"]))
        node_type = mbs.GetNode(node)["nodeType"]
        if node_type in SLOPE_NODES:
            return _cable_item(mbs, where, (node,), SLOPE_NODES[node_type], None, 0.0)
        if kind == "NodeRigid" and node_type in _NODE_KINDS:
            return _transformed(_node_item(mbs, where, node), data)
    if kind in ("BodyRigid", "BodyPosition"):
        body = mbs.GetObject(data["bodyNumber"])
        if body["objectType"] in CABLES:
            local = np.array(data["localHT"])[:3, 3] if kind == "BodyRigid" else np.array(data["localPosition"])
            item = _cable_item(
                mbs,
                where,
                beams.element_nodes(body),
                CABLES[body["objectType"]],
                float(body["length"]),
                float(local[0]),
            )
            turn = np.array(data["localHT"])[:3, :3] if kind == "BodyRigid" else np.eye(3)
            return dataclasses.replace(
                item, position=item.position + item.rotation[:, 1:] @ local[1:], rotation=item.rotation @ turn
            )
        if kind == "BodyRigid" and body["objectType"] in EXACT_BEAMS:
            return _beam_item(mbs, where, beams.element_nodes(body), float(body["length"]), np.array(data["localHT"]))
        if kind == "BodyRigid" and body["objectType"] in ("Ground", "RigidBody", "RigidBody2D"):
            return _transformed(_body_item(mbs, where, data["bodyNumber"]), data)
    return None


def _transformed(base: Item, data: dict[str, Any]) -> Item:
    transform = np.array(data["localHT"], dtype=float)
    return dataclasses.replace(
        base,
        position=base.position + base.rotation @ transform[:3, 3],
        rotation=base.rotation @ transform[:3, :3],
    )


def _marker_side(
    mbs: exu.MainSystem, marker: Index, data: dict[str, Any]
) -> tuple[Callable[[np.ndarray], Side], tuple[Index, ...]]:
    """Function from the rotation of the joint frame in the marker's to the side, and the nodes it depends on."""
    if "nodeNumber" in data:
        nodes: tuple[Index, ...] = (NodeIndex(int(data["nodeNumber"])),)
        return (lambda rotation: MarkerSide(marker, list(nodes), rotation)), nodes
    body = mbs.GetObject(data["bodyNumber"] if "bodyNumber" in data else data["objectNumber"])
    nodes = beams.element_nodes(body)
    kind = data["markerType"]
    if kind == "KinematicTreeRigid":
        return (lambda rotation: TreeSide(marker, list(nodes), rotation)), nodes
    if kind == "SuperElementRigid" and body["objectType"] in ("FFRF", "FFRFreducedOrder"):
        frame = _node_item(mbs, "", nodes[0]).side(np.zeros(3), np.eye(3))
        assert isinstance(frame, NodeSide)
        frame.rho[:] = 0.0
        return (lambda rotation: FloatingSide(marker, list(nodes), rotation, frame)), nodes
    if kind == "SuperElementRigid" and all(mbs.GetNode(node)["nodeType"] == "Point" for node in nodes):
        own = np.array(data["meshNodeNumbers"], dtype=int)
        used = tuple(nodes[i] for i in own)
        columns = (3 * own[:, None] + np.arange(3)).ravel()
        return (lambda rotation: MeshSide(marker, list(used), rotation, columns)), used
    return (lambda rotation: MarkerSide(marker, list(nodes), rotation)), nodes


def body_of_node(mbs: exu.MainSystem, node: Index) -> Any:
    """The rigid body that moves ``node``, or None if there is none yet."""
    for i in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(i)
        if body["objectType"] in ("RigidBody", "RigidBody2D") and int(body["nodeNumber"]) == int(node):
            return ObjectIndex(i)
    return None
