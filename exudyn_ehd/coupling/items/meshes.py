"""Markers on the nodes of finite elements in absolute coordinates as items of a joint."""

from __future__ import annotations

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import REFERENCE, Data, Index
from exudyn_ehd.coupling.items.beams import element_nodes, node_coordinates
from exudyn_ehd.coupling.items.item import Item
from exudyn_ehd.coupling.kinematics.fitted_sides import FittedSide, fitted_rotation
from exudyn_ehd.status import InputError

# How far weights may be from adding up to one; they are typed, or sums of many.
WEIGHTS = 1e-6


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
