"""Rigid markers as items of a joint, those on finite elements in absolute coordinates too; items by their number.

Frame of a finite-element body in absolute coordinates: the best rigid fit of some of its nodes
-----------------------------------------------------------------------------------------------
Nodes i with weights w_i, which add up to one, lie at Y_i against their mean C in the reference configuration, and at
y_i against their mean c now. The rotation R minimises ``sum w_i |y_i - R Y_i|^2``: it is the orthogonal factor of the
polar decomposition of ``sum w_i y_i Y_i^T``. With r_i = R Y_i the minimum says ``sum w_i r_i x y_i = 0``, and its
variation is

    D dphi = sum w_i r_i x dx_i,   D = tr(B) I - B,   B = sum w_i r_i y_i^T,

so that omega = D^-1 sum w_i r_i x v_i, and a moment M acts on node i as the force w_i (D^-1 M) x r_i: its power is
M . omega exactly. The joint point turns with the frame about c. Exudyn's MarkerSuperElementRigid is the same at small
rotations, but linear in the displacements.
"""

from __future__ import annotations

import dataclasses

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import Skew

from exudyn_ehd.coupling.contract import Data, Index, MarkerIndex, NodeIndex, ObjectIndex, Side
from exudyn_ehd.coupling.items.beams import CABLES, EXACT_BEAMS, SLOPE_NODES, element_nodes, reference_pose
from exudyn_ehd.coupling.items.bodies import (
    MASS_POINTS,
    POINT_KINDS,
    Item,
    beam_item,
    body_item,
    cable_item,
    node_item,
)
from exudyn_ehd.coupling.kinematics.relative import skews
from exudyn_ehd.coupling.kinematics.rigid_nodes import add_lever
from exudyn_ehd.coupling.kinematics.sides import NODE_KINDS, FloatingSide, MarkerSide, TreeSide, node_side
from exudyn_ehd.status import SMALL, InputError

# Smallest extent of the nodes normal to a line, over that along it (both squared), that fixes a rotation.
SLENDER = 1e-8


class FittedSide(Side):
    """Frame fitted to nodes whose coordinates are positions.

    Parameters
    ----------
    nodes : list
        Nodes with coordinates.
    size : int
        Number n of their coordinates.
    reference : ndarray (m, 3)
        Reference positions of all points, fixed ones included [m].
    places : tuple of ndarray of int (k,)
        Which of the 3 m position components are coordinates, and which coordinate each is.
    weights : ndarray (m,)
        Weights w.
    point : ndarray (3,)
        Joint point in the reference configuration, global [m].
    rotation : ndarray (3, 3)
        Joint frame in the reference configuration, global.
    """

    def __init__(
        self,
        nodes: list[Index],
        size: int,
        reference: np.ndarray,
        places: tuple[np.ndarray, np.ndarray],
        weights: np.ndarray,
        point: np.ndarray,
        rotation: np.ndarray,
    ) -> None:
        super().__init__(nodes, size)
        self.weights, self.rotation = weights, rotation
        self.rows, self.columns = places
        self.reference = reference
        self.spokes = reference - weights @ reference
        self.offset = point - weights @ reference
        self.update(None, np.zeros(size), np.zeros(size), None)

    def _points(self, values: np.ndarray) -> np.ndarray:
        """Vectors (m, 3) at the points of coordinates or rates (n,)."""
        out = np.zeros(self.reference.size)
        out[self.rows] = values[self.columns]
        return out.reshape(-1, 3)

    def _columns(self, blocks: np.ndarray) -> np.ndarray:
        """Columns (3, n) of blocks (m, 3, 3) that multiply the points' vectors."""
        out = np.zeros((3, self.size))
        out[:, self.columns] = blocks.transpose(1, 0, 2).reshape(3, -1)[:, self.rows]
        return out

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,); nan where no rotation fits."""
        w = self.weights
        x, v = self.reference + self._points(q), self._points(q_t)
        if (R := fitted_rotation(w, self.spokes, x)) is None:
            self.frame[:] = np.nan
            return
        self.mean = w @ x
        self.turned = self.spokes @ R.T
        self.products = np.einsum("k,ki,kj->ij", w, self.turned, x - self.mean)
        self.inverse = np.linalg.inv(np.trace(self.products) * np.eye(3) - self.products)
        self.levers = w[:, None, None] * skews(self.turned.T)
        self.jac[0] = self._columns(w[:, None, None] * np.eye(3))
        self.jac[1] = self.inverse @ self._columns(self.levers)
        self.frame[:, :3], self.frame[:, 3] = R @ self.rotation, self.mean
        self.frame[:, 4], self.frame[:, 5] = w @ v, self.jac[1] @ q_t
        self.move_point(R @ self.offset)

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state.

        Row i of Jr is the nodes' forces ``w (D^-1 e_i) x r`` of a unit moment.
        """
        turn, w, out = self.jac[1], self.weights[:, None, None], np.zeros((6, self.size, self.size))
        for i, torque in enumerate(self.inverse):
            both = np.multiply.outer(self.turned, torque)
            # minus the change of D torque with the points at fixed R: sum w (r (torque . dx) - torque (r . dx))
            by_points = self._columns(w * (both - both.transpose(0, 2, 1)))
            change = self.inverse @ (by_points - Skew(self.products @ torque) @ turn)
            # d(t x r) = dt x r + t x (dphi x r); a skew matrix is minus its transpose
            out[3 + i] = self._columns(self.levers).T @ change
            out[3 + i] -= self._columns(w * (skews(self.turned.T) @ Skew(torque))).T @ turn
        add_lever(turn, self.arm, out)
        return out


def fitted_rotation(weights: np.ndarray, spokes: np.ndarray, x: np.ndarray) -> np.ndarray | None:
    """Rotation (3, 3) that brings ``spokes`` (m, 3) closest to points ``x`` (m, 3) about their mean; None if none does.

    W. Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Crystallographica A32 (1976).
    """
    if not np.isfinite(x.sum()):
        return None
    U, s, Vt = np.linalg.svd(np.einsum("k,ki,kj->ij", weights, x - weights @ x, spokes))
    sign = np.sign(np.linalg.det(U) * np.linalg.det(Vt))
    if not s[1] + sign * s[2] > SLENDER * s[0]:
        return None
    return (U * [1.0, 1.0, sign]) @ Vt


_RIGID_MARKERS = ("BodyRigid", "NodeRigid", "SuperElementRigid", "KinematicTreeRigid")


def marker_item(mbs: exu.MainSystem, where: str, marker: Index) -> Item:
    """Rigid marker, or marker of a position on a cable or a mass point."""
    data = mbs.GetMarker(marker)
    if (item := _known_marker_item(mbs, where, data)) is not None:
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
    position, rotation = reference_pose(mbs.GetMarkerOutput, marker)
    kind, nodes = data["markerType"], _nodes_of_marker(mbs, data)

    def side(point: np.ndarray, joint: np.ndarray) -> Side:
        if kind == "SuperElementRigid":
            return FloatingSide(marker, list(nodes), rotation.T @ joint, node_side(mbs, nodes[0]))
        return (TreeSide if kind == "KinematicTreeRigid" else MarkerSide)(marker, list(nodes), rotation.T @ joint)

    return Item(
        position=position,
        rotation=rotation,
        is_marker=True,
        kind=None,
        inner=kind in ("KinematicTreeRigid", "SuperElementRigid"),
        marker=marker,
        nodes=nodes,
        side=side,
    )


def _known_marker_item(mbs: exu.MainSystem, where: str, data: Data) -> Item | None:
    """Item of a marker on a body or node whose kinematics are known here; None for any other."""
    kind, place = data["markerType"], np.array(data.get("localHT", np.eye(4)), dtype=float)
    if "localPosition" in data:
        place[:3, 3] = data["localPosition"]
    if kind in ("NodeRigid", "NodePosition"):
        node = NodeIndex(int(data["nodeNumber"]))
        node_type = mbs.GetNode(node)["nodeType"]
        if node_type in SLOPE_NODES:
            return cable_item(mbs, where, (node,), None, 0.0)
        if node_type in POINT_KINDS or (kind == "NodeRigid" and node_type in NODE_KINDS):
            return _transformed(node_item(mbs, where, node), place)
    if kind in ("BodyRigid", "BodyPosition"):
        body, is_rigid = mbs.GetObject(data["bodyNumber"]), kind == "BodyRigid"
        body_type, nodes = body["objectType"], element_nodes(body)
        if body_type in CABLES:
            along, place[0, 3] = float(place[0, 3]), 0.0
            return _transformed(cable_item(mbs, where, nodes, float(body["length"]), along), place)
        if is_rigid and body_type in EXACT_BEAMS:
            return beam_item(mbs, where, nodes, float(body["length"]), place)
        if body_type in MASS_POINTS or (is_rigid and body_type in ("Ground", "RigidBody", "RigidBody2D")):
            return _transformed(body_item(mbs, where, data["bodyNumber"]), place)
    return None


def _transformed(base: Item, place: np.ndarray) -> Item:
    """Item at a place (4, 4) in the frame of another."""
    return dataclasses.replace(
        base, position=base.position + base.rotation @ place[:3, 3], rotation=base.rotation @ place[:3, :3]
    )


def _nodes_of_marker(mbs: exu.MainSystem, data: Data) -> tuple[Index, ...]:
    """Nodes of the node, body or object of a marker."""
    owner = data if "nodeNumber" in data else mbs.GetObject(data.get("bodyNumber", data.get("objectNumber")))
    return element_nodes(owner)


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
    if not abs(weights.sum() - 1.0) <= SMALL:
        raise InputError(
            f"{where}: weightingFactors of the marker must add up to 1, got {weights.sum():.9g}; divide them by it."
        )
    weights = weights / weights.sum()
    points = np.array([node["referenceCoordinates"] for node in own], dtype=float)
    if fitted_rotation(weights, points - weights @ points, points) is None:
        raise InputError(f"{where}: the nodes of the marker lie on one line and fix no rotation; give more of them.")
    size = 3 * len(nodes)
    places = np.flatnonzero(np.repeat(moving, 3)), np.arange(size)
    position, rotation = reference_pose(mbs.GetMarkerOutput, marker)
    return Item(
        position=position,
        rotation=rotation,
        is_marker=True,
        kind=None,
        inner=True,
        marker=marker,
        nodes=nodes,
        side=lambda point, joint: FittedSide(list(nodes), size, points, places, weights, point, joint),
    )


def resolve(mbs: exu.MainSystem, where: str, number: object) -> Item:
    """Return the item of an item number.

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
        If it is no such item, or if the item cannot turn.
    """
    try:
        if isinstance(number, MarkerIndex):
            return marker_item(mbs, where, number)
        if isinstance(number, NodeIndex):
            return node_item(mbs, where, number)
        # Exudyn's numbers have 32 bits
        if isinstance(number, ObjectIndex) or (
            isinstance(number, int) and not isinstance(number, bool) and number.bit_length() < 32
        ):
            return body_item(mbs, where, ObjectIndex(int(number)))
    except exu.ExudynError as error:
        raise InputError(
            f"{where} is not an item of this system: {number!r} ({error}); pass what mbs.Create..., AddObject, AddNode "
            "or AddMarker returned."
        ) from None
    raise InputError(
        f"{where} must be an ObjectIndex (body or ground), a NodeIndex (rigid-body, beam, cable or point node) or a "
        f"MarkerIndex (rigid marker), got {number!r}; pass what AddObject, AddNode, AddMarker or mbs.Create... "
        "returned."
    )
