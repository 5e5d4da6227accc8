"""One entry of itemNumbers, resolved: where it is, how it moves, and which side it makes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from exudyn_ehd.coupling.contract import Index, Side
from exudyn_ehd.coupling.kinematics.sides import NodeSide


@dataclasses.dataclass(frozen=True, kw_only=True)
class Item:
    """One entry of itemNumbers, resolved.

    Attributes
    ----------
    position, rotation : ndarray (3,), (3, 3)
        Its frame in the reference configuration, global: the body's, the node's or the marker's; of a beam element that
        of its local coordinates, x along it.
    is_marker : bool
        Whether it fixes the joint point itself.
    kind : int or None
        How its node turns, None for anything but a rigid body, a rigid node or ground.
    planar : bool
        Whether it moves in the global x-y plane only.
    inner : bool
        Whether it moves against other points of its own body by coordinates of the body's one node (link of a tree,
        point of a mesh).
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
