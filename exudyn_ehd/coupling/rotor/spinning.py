"""Nodes that turn with a rotor, and the axes about which they turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Data, Index, MarkerIndex, NodeIndex, ObjectIndex, objects_of
from exudyn_ehd.coupling.kinematics import rigid_nodes
from exudyn_ehd.coupling.kinematics.sides import NODE_KINDS, NodeSide, node_side
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.status import InputError

WHERE = "SolveEquilibrium"
Rotors: TypeAlias = "Sequence[Index | Sequence[Index]] | None"
TURNING = {name: kind for name, kind in NODE_KINDS.items() if kind != rigid_nodes.PLANAR}


@dataclass(frozen=True, eq=False)
class Rotor:
    """Nodes that turn together.

    Attributes
    ----------
    nodes : list of int
        Nodes of the rotor; the first one is driven.
    axes : list of (3,) arrays
        Axis of the spin in the frame of each node.
    frame : (3, 3) array
        Axes in space: two transverse ones, x and y of a joint, and that of the spin.
    ratio : float
        Speed over that of the first rotor.
    """

    nodes: list[int]
    axes: list[np.ndarray]
    frame: np.ndarray
    ratio: float = 1.0


def find_rotors(
    mbs: exu.MainSystem, joints: list[Joint], rotors: Rotors, ratios: Sequence[float] | None
) -> list[Rotor]:
    """Rotors of a system: the given ones, or the bodies of all journals with all bodies that turn with them."""
    links = _links(mbs)
    if rotors is None:
        journals = [joint.element.sides[1].nodes[0] for joint in joints if joint.element.sides[1].nodes]
        groups: list[list[int]] = []
        for node in map(int, journals):
            if not any(node in group for group in groups):
                groups.append(_connected(node, links))
    else:
        groups = [
            _connected(node_of(mbs, entry), links)
            if isinstance(entry, str) or not isinstance(entry, Sequence)
            else [node_of(mbs, part) for part in entry]
            for entry in rotors
        ]
    speeds = np.ones(len(groups)) if ratios is None else np.asarray(ratios, dtype=float)
    if speeds.shape != (len(groups),) or not np.all(np.isfinite(speeds) & (speeds != 0.0)):
        raise InputError(
            f"{WHERE}: ratios must be {len(groups)} finite numbers other than 0, one for each rotor (driven nodes "
            f"{[group[0] for group in groups]}), got {ratios!r}."
        )
    return [_rotor(mbs, joints, group, float(ratio)) for group, ratio in zip(groups, speeds, strict=True)]


def node_of(mbs: exu.MainSystem, item: Index) -> int:
    """Number of the node behind a node or a body of one node."""
    if isinstance(item, NodeIndex):
        return int(item)
    if isinstance(item, ObjectIndex):
        data = mbs.GetObject(item)
        if "nodeNumber" in data:
            return int(data["nodeNumber"])
    raise InputError(f"{WHERE}: give rotors and their bodies as numbers of rigid bodies or nodes, got {item!r}.")


def _rotor(mbs: exu.MainSystem, joints: list[Joint], nodes: list[int], ratio: float) -> Rotor:
    references = []
    for node in nodes:
        data = mbs.GetNode(NodeIndex(node))
        if data["nodeType"] not in TURNING:
            raise InputError(
                f"{WHERE}: a rotor must consist of rigid bodies and geometrically exact beams on their nodes, got node "
                f"{node} of type {data['nodeType']}; make the shaft of rigid bodies or ObjectBeamGeometricallyExact."
            )
        references.append(node_side(mbs, NodeIndex(node)).frame[:, :3])
    for joint in joints:
        journal = joint.element.sides[1]
        if isinstance(journal, NodeSide) and journal.nodes and int(journal.nodes[0]) in nodes:
            frame = references[nodes.index(int(journal.nodes[0]))] @ journal.rotation
            return Rotor(nodes, [turn.T @ frame[:, 2] for turn in references], frame, ratio)
    raise InputError(
        f"{WHERE}: the rotor of node {nodes[0]} carries no journal of a lubricated joint, whose axis it would turn "
        "about; name the bodies that do, and give joints the node of a shaft in place of a beam's element."
    )


def _connected(first: int, links: dict[int, set[int]]) -> list[int]:
    """The node and all that turn with it."""
    found = [first]
    for node in found:
        found += sorted(links.get(node, set()) - set(found))
    return found


def _links(mbs: exu.MainSystem) -> dict[int, set[int]]:
    """Return for every node the nodes that turn with it through beams, fixed joints and torsional springs."""
    links: dict[int, set[int]] = {}
    for _, data in objects_of(mbs):
        nodes = set()
        if data["objectType"] == "BeamGeometricallyExact3D":
            nodes = {int(node) for node in data["nodeNumbers"]}
        elif _transmits(data):
            nodes = {_node_of_marker(mbs, marker) for marker in data["markerNumbers"]} - {-1}
        for node in nodes:
            links.setdefault(node, set()).update(nodes - {node})
    return links


def _transmits(data: Data) -> bool:
    """Return whether a joint or a spring transmits every rotation."""
    if not data.get("activeConnector", True):
        return False
    if data["objectType"] == "JointGeneric":
        return all(data["constrainedAxes"][3:])
    if data["objectType"] == "ConnectorRigidBodySpringDamper":
        return bool(np.all(np.diag(np.asarray(data["stiffness"]))[3:] > 0.0))
    return False


def _node_of_marker(mbs: exu.MainSystem, marker: Index) -> int:
    """Node of the rigid body or the node that a marker sits on; -1 for anything else."""
    data = mbs.GetMarker(MarkerIndex(int(marker)))
    if "bodyNumber" in data:
        data = mbs.GetObject(ObjectIndex(int(data["bodyNumber"])))
    node = int(data.get("nodeNumber", -1))
    return node if node >= 0 and mbs.GetNode(NodeIndex(node))["nodeType"] in TURNING else -1
