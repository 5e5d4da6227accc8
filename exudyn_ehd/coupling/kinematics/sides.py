"""Sides of a joint: the item that moves a marker frame, and how the frame's state is computed.

A side fills the work arrays of `kinematics`: `NodeSide` for the nodes of rigid bodies and ground through kernels,
`flexible_bodies` for geometrically exact beams and cables, `MarkerSide` for any other rigid marker through Exudyn's own
marker Jacobians. The side of finite elements in absolute coordinates is in `exudyn_ehd.coupling.items.markers`.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np
from numba import njit

from exudyn_ehd.coupling.contract import CURRENT, Index, Side
from exudyn_ehd.coupling.kinematics import relative, rigid_nodes
from exudyn_ehd.coupling.kinematics.relative import JOURNAL, Kinematics, global_loads
from exudyn_ehd.coupling.kinematics.rigid_nodes import vary

NODE_KINDS = {
    "RigidBodyEP": rigid_nodes.EULER_PARAMETERS,
    "RigidBodyRxyz": rigid_nodes.TAIT_BRYAN,
    "RigidBodyRotVecLG": rigid_nodes.ROTATION_VECTOR,
    "RigidBody2D": rigid_nodes.PLANAR,
}
"""Kinds of rotation coordinates of rigid-body nodes, by Exudyn's names of the nodes."""


class NodeSide(Side):
    """Marker frame fixed to one rigid-body node, or to ground.

    Parameters
    ----------
    kind : int
        How the node turns (`rigid_nodes.POINT` and others).
    node : exudyn.NodeIndex or None
        The node; None for ground.
    reference : ndarray (n,)
        Reference coordinates of the node.
    rho : ndarray (3,)
        Joint point in the node's frame [m]; global for ground.
    rotation : ndarray (3, 3)
        Joint frame to node frame; to global for ground.
    """

    def __init__(
        self, kind: int, node: Index | None, reference: np.ndarray, rho: np.ndarray, rotation: np.ndarray
    ) -> None:
        super().__init__([] if node is None else [node], len(reference))
        self.kind = kind
        self.reference = np.ascontiguousarray(reference, dtype=float)
        self.rho = np.ascontiguousarray(rho, dtype=float)
        self.rotation = np.ascontiguousarray(rotation, dtype=float)
        self.frame[:, :3], self.frame[:, 3] = self.rotation, self.rho

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        if self.size:
            rigid_nodes.node_frame(self.kind, q, q_t, self.reference, self.rho, self.rotation, self.frame, self.jac)

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        out = np.empty((6, self.size, self.size))
        if self.size:
            rigid_nodes.node_change(self.kind, q, self.reference, self.rho, out)
        return out


def node_side(mbs: exu.MainSystem, node: Index) -> NodeSide:
    """Frame of a node of a rigid body itself, in the reference configuration."""
    data = mbs.GetNode(node)
    side = NodeSide(NODE_KINDS[data["nodeType"]], node, data["referenceCoordinates"], np.zeros(3), np.eye(3))
    side.update(mbs, np.zeros(side.size), np.zeros(side.size), None)
    return side


class MarkerSide(Side):
    """Marker frame of any rigid marker, through Exudyn's marker Jacobians.

    Derivatives of the Jacobians to the coordinates are needed for velocities and the geometric stiffness. They come
    from Exudyn if the marker offers them (ANCF beams and cables, rigid bodies). Subclasses compute them for some other
    bodies. Otherwise they are zero: Newton's method then converges a little slower, to the same solution.

    Parameters
    ----------
    marker : exudyn.MarkerIndex
        The marker.
    nodes : list
        Nodes of its body in the order of the columns of the marker's Jacobians.
    rotation : ndarray (3, 3)
        Joint frame to marker frame.
    """

    def __init__(self, marker: Index, nodes: list[Index], rotation: np.ndarray) -> None:
        super().__init__(nodes, 0)
        self.marker = marker
        self.rotation = np.ascontiguousarray(rotation, dtype=float)
        self._offers_change = True

    def bind(self, mbs: exu.MainSystem) -> None:
        """Find the number of coordinates, which Exudyn knows only after Assemble."""
        self.size = np.asarray(mbs.ComputeItem(self.marker, exu.ComputeItemType.PositionJacobian)).shape[1]
        self.jac = np.zeros((4, 3, self.size))
        try:
            mbs.ComputeItem(self.marker, exu.ComputeItemType.JacobianTTimesVectorDerivative, vector=np.ones(6))
        except exu.ExudynError:
            self._offers_change = False

    def update(self, mbs: exu.MainSystem, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType) -> None:
        """Fill the frame from the marker in ``configuration``, and Jp, Jr if that is the current one."""
        output = exu.OutputVariableType
        a = np.asarray(mbs.GetMarkerOutput(self.marker, output.RotationMatrix, configuration)).reshape(3, 3)
        self.frame[:, :3] = a @ self.rotation
        self.frame[:, 3] = mbs.GetMarkerOutput(self.marker, output.Position, configuration)
        self.frame[:, 4] = mbs.GetMarkerOutput(self.marker, output.Velocity, configuration)
        self.frame[:, 5] = mbs.GetMarkerOutput(self.marker, output.AngularVelocity, configuration)
        if configuration == CURRENT:
            self.jac[0] = mbs.ComputeItem(self.marker, exu.ComputeItemType.PositionJacobian)
            self.jac[1] = mbs.ComputeItem(self.marker, exu.ComputeItemType.RotationJacobian)

    def change(self, mbs: exu.MainSystem, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state.

        (6, 0, 0) if Exudyn offers none.
        """
        item, n = exu.ComputeItemType.JacobianTTimesVectorDerivative, self.size
        change = np.zeros((6, n, n) if self._offers_change else (6, 0, 0))
        for i, unit in enumerate(np.eye(6)[: 6 * self._offers_change]):
            part = np.asarray(mbs.ComputeItem(self.marker, item, vector=unit))
            # Exudyn gives an empty matrix for one that vanishes
            if part.size:
                change[i] = part
        return change


class TreeSide(MarkerSide):
    """Frame on a link of a kinematic tree of revolute and prismatic joints.

    Columns k of joints behind j turn with joint j, dJ_k/dq_j = omega_j x J_k (j <= k); a joint before j sees the
    marker's point move, dJp_k/dq_j = omega_k x Jp_j (j > k). Parents come before their children; joints off the path to
    the link have zero columns.
    """

    def change(self, mbs: exu.MainSystem, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        Jp, Jr, behind = self.jac[0].T, self.jac[1].T, ~np.tri(self.size, dtype=bool)  # [k, j]: j > k
        turned = np.cross(Jr[None, :, :], np.stack([Jp, Jr])[:, :, None, :])
        turned[0][behind] = np.cross(Jr[:, None, :], Jp[None, :, :])[behind]
        turned[1][behind] = 0.0
        # joints off the path move nothing, and nothing that they carry counts
        return turned.transpose(0, 3, 1, 2).reshape(6, self.size, self.size)


class FloatingSide(MarkerSide):
    """Superelement marker on a body with a floating frame: a rigid node, then local flexible coordinates.

    The columns of the flexible coordinates turn with the frame, ``d/dtheta = Jr_theta x``, and the frame's lever arm to
    the marker changes with them. Their change with the deformation, of the size of the deformation, is omitted.

    Parameters
    ----------
    marker, nodes, rotation
        As in `MarkerSide`.
    frame : NodeSide
        The rigid node's own frame.
    """

    def __init__(self, marker: Index, nodes: list[Index], rotation: np.ndarray, frame: NodeSide) -> None:
        super().__init__(marker, nodes, rotation)
        self.floating = frame

    def change(self, mbs: exu.MainSystem, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        n = self.floating.size
        self.floating.update(mbs, q[:n], np.zeros(n), CURRENT)
        return floating_change(self.floating, q[:n], self.frame[:, 3] - self.floating.frame[:, 3], self.jac)


def floating_change(floating: NodeSide, q: np.ndarray, arm: np.ndarray, jac: np.ndarray) -> np.ndarray:
    """Derivatives d J[i, a] / dq_b (6, m, m) of the Jacobians of a point in a floating frame.

    Parameters
    ----------
    floating : NodeSide
        The rigid node's own frame.
    q : ndarray (n,)
        Its coordinates.
    arm : ndarray (3,)
        From the node to the point, global [m].
    jac : ndarray (4, 3, m)
        Jp and Jr of the point: the node's columns, then those of local coordinates.
    """
    n, size = floating.size, jac.shape[2]
    change, own = np.zeros((6, size, size)), floating.change(None, q)
    rigid_nodes.add_lever(np.ascontiguousarray(jac[1, :, :n]), arm, own)
    change[:, :n, :n] = own
    # (n, 3, 3): cross products with the columns of Jr, vectors standing behind them
    turns = relative.skews(jac[1, :, :n])
    for first in (0, 3):
        change[first : first + 3, n:, :n] = (turns @ jac[first // 3, :, n:]).transpose(1, 2, 0)
    change[:3, :n, n:] = (turns @ jac[0, :, n:]).transpose(1, 0, 2)
    return change


def motion_between(
    mbs: exu.MainSystem,
    sides: tuple[Side, Side],
    q: np.ndarray,
    q_t: np.ndarray,
    configuration: exu.ConfigurationType,
    kinematics: Kinematics = JOURNAL,
) -> np.ndarray:
    """Update two sides to q and q_t (n,), housing's first; return the motion."""
    housing, journal = sides
    n = housing.size
    housing.update(mbs, q[:n], q_t[:n], configuration)
    journal.update(mbs, q[n:], q_t[n:], configuration)
    return np.asarray(kinematics.motion_of(housing.frame, journal.frame))


def derivatives_between(
    mbs: exu.MainSystem,
    sides: tuple[Side, Side],
    state: tuple[np.ndarray, np.ndarray],
    wrench: np.ndarray,
    tangent: np.ndarray,
    kinematics: Kinematics = JOURNAL,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives of the generalized forces Q of a wrench between two sides, at the state to which they are updated.

    Parameters
    ----------
    wrench : (6,) array
        Wrench on the journal, joint frame.
    tangent : (6, m) array
        Derivatives of the wrench to the motion.
    kinematics : Kinematics

    Returns
    -------
    stiffness, damping : (n, n) arrays
        dQ/dq and dQ/dq_t.
    motion_q, motion_qt : (m, n) arrays
        Derivatives of the motion.
    """
    (housing, journal), (q, q_t), n = sides, state, sides[0].size
    arrays = housing.frame, journal.frame, housing.jac, journal.jac
    changes = housing.change(mbs, q[:n]), journal.change(mbs, q[n:])
    loads, stiffness = turned_loads(*arrays, *changes, q_t, wrench)
    motion_q, motion_qt = kinematics.variation_of(*arrays)
    damping = np.empty_like(stiffness)
    relative.tangent_matrices(*arrays, loads, tangent, motion_q, motion_qt, stiffness, damping)
    return stiffness, damping, motion_q, motion_qt


@njit(cache=True)
def turned_loads(frame_h, frame_j, jac_h, jac_j, change_h, change_j, q_t, wrench):
    """Return the loads (4, 3) of `relative.global_loads` and the geometric terms (n, n) of both; fill their Vq, Wq."""
    n, size = jac_h.shape[2], q_t.size
    loads, geometric = np.empty((4, 3)), np.zeros((size, size))
    global_loads(frame_h, frame_j, wrench, loads)
    vary(change_h, q_t[:n], loads[:2].reshape(6), jac_h, geometric[:n, :n])
    vary(change_j, q_t[n:], loads[2:].reshape(6), jac_j, geometric[n:, n:])
    return loads, geometric
