"""Beams and cables as items of a joint: position of the joint point along the element, and the side for it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline

from exudyn_ehd.coupling.contract import REFERENCE, Data, Index, NodeIndex
from exudyn_ehd.coupling.kinematics.flexible_bodies import BeamSide, SlopeSide, slope_rotation
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, NodeSide
from exudyn_ehd.status import SMALL, InputError

SLOPE_NODES = ("Point2DSlope1", "PointSlope1")
"""Node types that hold a position and a slope."""
CABLES = ("ANCFCable2D", "ANCFCable")
EXACT_BEAMS = ("BeamGeometricallyExact2D", "BeamGeometricallyExact3D", "BeamGeometricallyExact")
# Angle, degrees, between the joint axis and a cable up to which the joint is along the cable; the same tolerance about
# 90 degrees for a joint across it. Other angles raise an error.
ALIGNED = 8.0


def node_coordinates(mbs: exu.MainSystem, nodes: Sequence[Index]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Reference and initial coordinates and initial velocities (n,) of nodes."""
    data = [mbs.GetNode(node) for node in nodes]
    rate = ["initialVelocities" if "initialVelocities" in d else "initialCoordinates_t" for d in data]
    reference, initial, velocities = (
        np.concatenate([np.zeros(0), *(np.array(d[key], dtype=float) for d, key in zip(data, keys, strict=True))])
        for keys in (["referenceCoordinates"] * len(data), ["initialCoordinates"] * len(data), rate)
    )
    return reference, initial, velocities


def element_nodes(data: Data) -> tuple[Index, ...]:
    """Nodes of an object."""
    numbers = data.get("nodeNumbers", [data["nodeNumber"]] if "nodeNumber" in data else [])
    return tuple(NodeIndex(int(number)) for number in numbers)


def frame_along(tangent: np.ndarray, planar: bool) -> np.ndarray:
    """Reference frame (3, 3) of a cable, which has no orientation: x along it, z as close as possible to global z."""
    t = tangent / np.linalg.norm(tangent)
    across = np.array([0.0, 0.0, 1.0]) if planar or abs(t[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    return slope_rotation(t, across)[:, [0, 2, 1]] * [1.0, -1.0, 1.0]


def dimension_of(nodes: Sequence[Index], reference: np.ndarray) -> int:
    """Dimension of the cable, 2 or 3, whose nodes have these reference coordinates: a position and a slope each."""
    return reference.size // (2 * len(nodes))


def cable_maps(dimension: int, length: float | None, x: float) -> tuple[np.ndarray, np.ndarray]:
    """Maps (3, n) from a cable's coordinates to position and slope.

    Parameters
    ----------
    dimension : int
        2 or 3.
    length : float or None
        Length of the element; None for a node.
    x : float
        Position along the element [m], from its first node.
    """
    rows = np.eye(2)
    if length is not None:
        curve = CubicHermiteSpline([0.0, length], np.eye(4)[::2], np.eye(4)[1::2])
        rows = np.array([curve(x), curve(x, 1)])
    part = np.eye(3)[:, :dimension]
    return np.kron(rows[0], part), np.kron(rows[1], part)


def cable_side(
    where: str,
    nodes: tuple[Index, ...],
    reference: np.ndarray,
    length: float | None,
    x: float | None,
    point: np.ndarray,
    rotation: np.ndarray,
) -> SlopeSide:
    """Side on a cable's node (``length`` None), or on an element at ``x``, by default where the joint point is.

    Raises
    ------
    InputError
        Joint point beyond the element; axis neither along nor across a spatial cable.
    """
    dimension = dimension_of(nodes, reference)
    if x is None:
        x = 0.0 if length is None else _place_on_cable(where, dimension, reference, length, point)
    place, slope = cable_maps(dimension, length, x)
    t = slope @ reference
    t /= np.linalg.norm(t)
    if dimension == 2:
        director = np.array([0.0, 0.0, 1.0])
    else:
        angle = math.degrees(math.acos(min(abs(float(t @ rotation[:, 2])), 1.0)))
        if ALIGNED < angle < 90.0 - ALIGNED:
            raise InputError(
                f"CreateLubricatedJoint.axis must be along or across the cable of {where}, got an angle of "
                f"{angle:.3g} degrees: a cable has no orientation about its axis; use a beam element or a rigid body "
                "at its end."
            )
        director = rotation[:, 0] if angle <= ALIGNED else rotation[:, 2]
        director = director - t * (t @ director)
        director /= np.linalg.norm(director)
    return SlopeSide(list(nodes), reference, place, slope, director, point, rotation)


def _place_on_cable(where: str, dimension: int, reference: np.ndarray, length: float, point: np.ndarray) -> float:
    """Place x [m] on the reference curve nearest to a point, by Newton with the slope's square as derivative."""
    x = 0.5 * length
    for _ in range(50):
        place, slope = cable_maps(dimension, length, x)
        t = slope @ reference
        step = float((point - place @ reference) @ t / (t @ t))
        x += step
        if abs(step) < 1e-14 * length:
            break
    return _within(where, x, length)


def _within(where: str, x: float, length: float) -> float:
    if not -SMALL * length <= x <= (1.0 + SMALL) * length:
        raise InputError(
            f"CreateLubricatedJoint.position must lie on the element of {where}, which spans 0 to {length:g} m "
            f"along its axis, got {x:.6g} m; give the element of the beam that carries the joint, or move the joint."
        )
    return min(max(x, 0.0), length)


def beam_side(
    where: str, ends: tuple[NodeSide, NodeSide], share: float | None, point: np.ndarray, rotation: np.ndarray
) -> BeamSide:
    """Side on a geometrically exact beam at a share of its length, by default where the joint point is."""
    if share is None:
        start, end = (side.frame[:, 3] for side in ends)
        along = end - start
        length = float(np.linalg.norm(along))
        share = _within(where, float((point - start) @ along) / length, length) / length
    return BeamSide(ends, share, point, rotation)


def reference_pose(read: Callable[..., ArrayLike], item: Index, *local: object) -> tuple[np.ndarray, np.ndarray]:
    """Position (3,) and rotation (3, 3) of an item in the reference state, by Exudyn's function for its outputs.

    ``local``: local coordinates, if the function takes them.
    """
    place = np.array(read(item, exu.OutputVariableType.Position, *local, REFERENCE), dtype=float)
    turn = np.array(read(item, exu.OutputVariableType.RotationMatrix, *local, REFERENCE), dtype=float)
    return place, turn.reshape(3, 3)


def marker_on_body(
    mbs: exu.MainSystem, where: str, body: Index, nodes: tuple[Index, ...], point: np.ndarray, rotation: np.ndarray
) -> MarkerSide:
    """Side through a new marker on an ANCF beam element or a RotationalMass1D, at a point of the reference state."""
    local = np.zeros(3)
    for _ in range(50):
        place, matrix = reference_pose(mbs.GetObjectOutputBody, body, local.tolist())
        step = matrix.T @ (point - place)
        local += step
        if np.abs(step).max() < 1e-15:
            break
    data = mbs.GetObject(body)
    if "length" in data:
        half = 0.5 * float(data["length"])
        local[0] = _within(where, local[0] + half, 2.0 * half) - half
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=local.tolist()))
    _, matrix = reference_pose(mbs.GetObjectOutputBody, body, local.tolist())
    return MarkerSide(marker, list(nodes), matrix.T @ rotation)


def marker_on_node(
    mbs: exu.MainSystem,
    where: str,
    node: Index,
    place: np.ndarray,
    frame: np.ndarray,
    point: np.ndarray,
    rotation: np.ndarray,
) -> MarkerSide:
    """Side through a new marker on a node that has an orientation, at the node."""
    if np.linalg.norm(point - place) > 1e-9 * max(1.0, float(np.linalg.norm(place))):
        raise InputError(
            f"CreateLubricatedJoint.position must be that of the node of {where}, {place.tolist()}, got "
            f"{point.tolist()}; for a point along the beam give the beam element."
        )
    marker = mbs.AddMarker(eii.MarkerNodeRigid(nodeNumber=node))
    return MarkerSide(marker, [node], frame.T @ rotation)
