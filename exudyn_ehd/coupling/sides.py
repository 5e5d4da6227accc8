"""The two sides of a joint: who carries the marker frame, and how its state is read.

A side fills the work arrays of `kinematics`: `NodeSide` for the nodes of rigid bodies and ground through kernels,
`MarkerSide` for any other rigid marker through Exudyn's own marker Jacobians.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling import kinematics

_CURRENT = exu.ConfigurationType.Current
_EMPTY = np.zeros(0)


class NodeSide:
    """Marker frame fixed to one rigid-body node, or to ground.

    Parameters
    ----------
    kind : int
        How the node turns (`kinematics.GROUND` and others).
    node : exudyn.NodeIndex or None
        The node; None for ground.
    reference : ndarray (n,)
        Reference coordinates of the node.
    rho : ndarray (3,)
        Joint point in the node's frame [m]; global for ground.
    rotation : ndarray (3, 3)
        Joint frame to node frame; to global for ground.
    """

    def __init__(self, kind: int, node: Any, reference: np.ndarray, rho: np.ndarray, rotation: np.ndarray) -> None:
        self.kind = kind
        self.nodes = [] if node is None else [node]
        self.size = kinematics.COORDINATES[kind]
        self.reference = np.ascontiguousarray(reference, dtype=float)
        self.rho = np.ascontiguousarray(rho, dtype=float)
        self.rotation = np.ascontiguousarray(rotation, dtype=float)
        self.frame = np.zeros((3, 6))
        self.frame[:, :3] = self.rotation
        self.frame[:, 3] = self.rho
        self.jac = np.zeros((4, 3, self.size))

    def update(self, mbs: Any, q: np.ndarray, q_t: np.ndarray, configuration: Any) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        if self.size:
            kinematics.node_frame(self.kind, q, q_t, self.reference, self.rho, self.rotation, self.frame, self.jac)

    def vary(self, mbs: Any, q: np.ndarray, q_t: np.ndarray) -> None:
        """Fill Vq, Wq; `update` must have run at the same state."""
        if self.size:
            kinematics.node_variation(self.kind, q, q_t, self.reference, self.rho, self.jac)

    def geometric(self, mbs: Any, q: np.ndarray, force: np.ndarray, moment: np.ndarray, out: np.ndarray) -> None:
        """Write d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment into ``out``."""
        if self.size:
            kinematics.node_geometric(self.kind, q, self.reference, self.rho, force, moment, out)


class MarkerSide:
    """Marker frame of any rigid marker (beams, superelements, kinematic trees), through Exudyn's marker Jacobians.

    The derivative of the marker's velocity with respect to the coordinates at fixed rates is neglected in the
    Jacobian: Newton's rate suffers a little on fast turning flexible bodies, the solution does not.

    Parameters
    ----------
    marker : exudyn.MarkerIndex
        The marker.
    nodes : list
        Nodes of its body in the order of the columns of the marker's Jacobians.
    rotation : ndarray (3, 3)
        Joint frame to marker frame.
    """

    def __init__(self, marker: Any, nodes: list[Any], rotation: np.ndarray) -> None:
        self.marker = marker
        self.nodes = nodes
        self.rotation = np.ascontiguousarray(rotation, dtype=float)
        self.frame = np.zeros((3, 6))
        self.jac = np.zeros((4, 3, 0))
        self.size = -1

    def bind(self, mbs: Any) -> None:
        """Find the number of coordinates, which Exudyn knows only after Assemble."""
        self.size = np.array(mbs.ComputeItem(self.marker, exu.ComputeItemType.PositionJacobian)).shape[1]
        self.jac = np.zeros((4, 3, self.size))

    def update(self, mbs: Any, q: np.ndarray, q_t: np.ndarray, configuration: Any) -> None:
        """Fill the frame from the marker in ``configuration``, and Jp, Jr if that is the current one."""
        output = exu.OutputVariableType
        a = mbs.GetMarkerOutput(self.marker, output.RotationMatrix, configuration).reshape(3, 3)
        self.frame[:, :3] = a @ self.rotation
        self.frame[:, 3] = mbs.GetMarkerOutput(self.marker, output.Position, configuration)
        self.frame[:, 4] = mbs.GetMarkerOutput(self.marker, output.Velocity, configuration)
        self.frame[:, 5] = mbs.GetMarkerOutput(self.marker, output.AngularVelocity, configuration)
        if configuration == _CURRENT:
            self.jac[0] = mbs.ComputeItem(self.marker, exu.ComputeItemType.PositionJacobian)
            self.jac[1] = mbs.ComputeItem(self.marker, exu.ComputeItemType.RotationJacobian)

    def vary(self, mbs: Any, q: np.ndarray, q_t: np.ndarray) -> None:
        """Leave Vq, Wq zero; see the class."""

    def geometric(self, mbs: Any, q: np.ndarray, force: np.ndarray, moment: np.ndarray, out: np.ndarray) -> None:
        """Write d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment into ``out``."""
        vector = np.concatenate([force, moment])
        item = exu.ComputeItemType.JacobianTTimesVectorDerivative
        out[:] = mbs.ComputeItem(self.marker, item, vector=vector)


Side = NodeSide | MarkerSide


def read_state(mbs: Any, sides: tuple[Side, Side], configuration: Any) -> tuple[list[float], list[float]]:
    """Coordinates (without reference values) and rates of both sides, in the film element's order."""
    q: list[float] = []
    q_t: list[float] = []
    for side in sides:
        for node in side.nodes:
            q += np.atleast_1d(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates, configuration)).tolist()
            q_t += np.atleast_1d(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates_t, configuration)).tolist()
    return q, q_t
