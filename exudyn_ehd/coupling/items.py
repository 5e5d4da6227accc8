"""From the item numbers of a scene (body, ground, node, rigid marker) to the carriers of a joint frame."""

from __future__ import annotations

import dataclasses
from typing import Any

import exudyn
import numpy as np

from exudyn_ehd.coupling import kinematics
from exudyn_ehd.coupling.sides import MarkerSide, NodeSide, Side
from exudyn_ehd.status import InputError

# the index types exist at run time, but not in the type stubs
exu: Any = exudyn

_NODE_KINDS = {
    "RigidBodyEP": kinematics.EULER_PARAMETERS,
    "RigidBodyRxyz": kinematics.TAIT_BRYAN,
    "RigidBodyRotVecLG": kinematics.ROTATION_VECTOR,
    "RigidBody2D": kinematics.PLANAR,
}
_RIGID_MARKERS = ("BodyRigid", "NodeRigid", "SuperElementRigid", "KinematicTreeRigid")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Item:
    """One entry of itemNumbers, resolved.

    Attributes
    ----------
    position, rotation : ndarray (3,), (3, 3)
        Its frame in the reference configuration, global: the body's, the node's or the marker's.
    is_marker : bool
        Whether it fixes the joint point itself.
    kind : int or None
        How its node turns, None for a marker on anything but a rigid body, a rigid node or ground.
    node : exudyn.NodeIndex or None
        The rigid node.
    marker : exudyn.MarkerIndex or None
        The marker of a generic side.
    nodes : tuple
        Nodes it depends on.
    node_position, node_rotation : ndarray (3,), (3, 3)
        Frame of its node (or of global space for ground) in the reference configuration.
    reference_coordinates, initial_coordinates, initial_velocities : ndarray (n,)
        Of its node.
    """

    position: np.ndarray
    rotation: np.ndarray
    is_marker: bool
    kind: int | None
    node: Any = None
    marker: Any = None
    nodes: tuple[Any, ...] = ()
    node_position: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))
    node_rotation: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(3))
    reference_coordinates: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    initial_coordinates: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    initial_velocities: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))

    def side(self, point: np.ndarray, joint_rotation: np.ndarray) -> Side:
        """Carrier of the frame that has global position ``point`` and ``joint_rotation`` in the reference state."""
        if self.kind is None:
            return MarkerSide(self.marker, list(self.nodes), self.rotation.T @ joint_rotation)
        reference = np.zeros(0) if self.node is None else self.reference_coordinates
        rho = self.node_rotation.T @ (point - self.node_position)
        return NodeSide(self.kind, self.node, reference, rho, self.node_rotation.T @ joint_rotation)


def resolve(mbs: Any, where: str, number: Any) -> Item:
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
        if isinstance(number, exu.MarkerIndex):
            return _marker_item(mbs, where, number)
        if isinstance(number, exu.NodeIndex):
            return _node_item(mbs, where, number)
        if isinstance(number, exu.ObjectIndex) or (isinstance(number, int) and not isinstance(number, bool)):
            return _body_item(mbs, where, number)
    except exu.ExudynError as error:
        raise InputError(f"{where} is not an item of this system: {number!r} ({error}).") from None
    raise InputError(
        f"{where} must be an ObjectIndex (rigid body or ground), a NodeIndex (rigid-body node) or a MarkerIndex (rigid "
        f"marker), got {number!r}; pass what AddObject, AddNode, AddMarker or mbs.Create... returned."
    )


def _node_item(mbs: Any, where: str, node: Any) -> Item:
    data = mbs.GetNode(node)
    kind = _NODE_KINDS.get(data["nodeType"])
    if kind is None:
        raise InputError(
            f"{where}: a node of type {data['nodeType']} has no rotation of its own; give a rigid-body node, or a "
            "rigid marker on the flexible body."
        )
    reference = np.array(data["referenceCoordinates"], dtype=float)
    nt = 2 if kind == kinematics.PLANAR else 3
    position = np.zeros(3)
    position[:nt] = reference[:nt]
    rotation, _ = kinematics.node_rotation(kind, reference[nt:])
    return Item(
        position=position,
        rotation=rotation,
        is_marker=False,
        kind=kind,
        node=node,
        nodes=(node,),
        node_position=position,
        node_rotation=rotation,
        reference_coordinates=reference,
        initial_coordinates=np.array(data["initialCoordinates"], dtype=float),
        initial_velocities=np.array(data["initialVelocities"], dtype=float),
    )


def _body_item(mbs: Any, where: str, body: Any) -> Item:
    data = mbs.GetObject(body)
    kind = data["objectType"]
    if kind == "Ground":
        return Item(
            position=np.array(data["referencePosition"], dtype=float),
            rotation=np.array(data["referenceRotation"], dtype=float),
            is_marker=False,
            kind=kinematics.GROUND,
        )
    if kind in ("RigidBody", "RigidBody2D"):
        return _node_item(mbs, where, exu.NodeIndex(int(data["nodeNumber"])))
    raise InputError(
        f"{where}: an object of type {kind} is no rigid body; give a RigidBody, a RigidBody2D, a ground object, or a "
        "rigid marker (MarkerBodyRigid, MarkerSuperElementRigid, ...) on it."
    )


def _marker_item(mbs: Any, where: str, marker: Any) -> Item:
    data = mbs.GetMarker(marker)
    kind = data["markerType"]
    if kind not in _RIGID_MARKERS:
        raise InputError(
            f"{where}: a marker of type {kind} has no orientation; give a rigid marker, e.g. MarkerBodyRigid or "
            "MarkerNodeRigid."
        )
    base = None
    if kind == "NodeRigid" and mbs.GetNode(data["nodeNumber"])["nodeType"] in _NODE_KINDS:
        base = _node_item(mbs, where, exu.NodeIndex(int(data["nodeNumber"])))
    elif kind == "BodyRigid":
        body = mbs.GetObject(data["bodyNumber"])
        if body["objectType"] in ("Ground", "RigidBody", "RigidBody2D"):
            base = _body_item(mbs, where, data["bodyNumber"])
    if base is not None:
        transform = np.array(data["localHT"], dtype=float)
        return dataclasses.replace(
            base,
            is_marker=True,
            position=base.position + base.rotation @ transform[:3, 3],
            rotation=base.rotation @ transform[:3, :3],
        )
    reference, output = exu.ConfigurationType.Reference, exu.OutputVariableType
    return Item(
        position=np.array(mbs.GetMarkerOutput(marker, output.Position, reference), dtype=float),
        rotation=np.array(mbs.GetMarkerOutput(marker, output.RotationMatrix, reference), dtype=float).reshape(3, 3),
        is_marker=True,
        kind=None,
        marker=marker,
        nodes=_nodes_of_marker(mbs, data),
    )


def _nodes_of_marker(mbs: Any, data: dict[str, Any]) -> tuple[Any, ...]:
    if "nodeNumber" in data:
        return (exu.NodeIndex(int(data["nodeNumber"])),)
    body = mbs.GetObject(data["bodyNumber"] if "bodyNumber" in data else data["objectNumber"])
    numbers = body["nodeNumbers"] if "nodeNumbers" in body else [body["nodeNumber"]]
    return tuple(exu.NodeIndex(int(number)) for number in numbers)


def body_of_node(mbs: Any, node: Any) -> Any:
    """The rigid body that moves ``node``, or None if there is none yet."""
    for i in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(i)
        if body["objectType"] in ("RigidBody", "RigidBody2D") and int(body["nodeNumber"]) == int(node):
            return exu.ObjectIndex(i)
    return None
