"""A rigid body's node as carrier of slaved mesh nodes: positions, velocities and their derivatives.

Legend: r position of the node, A its rotation matrix (local to global), theta its rotation coordinates, G the matrix of
the local angular velocity omega = G dtheta/dt, xbar local positions of the slaved points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from exudyn import rigidBodyUtilities as rigid

from exudyn_ehd.status import InputError

# the index types exist at run time, but not in the type stubs
exu: Any = exudyn

_KINDS = {
    "RigidBodyEP": (rigid.EulerParameters2RotationMatrix, rigid.EulerParameters2GLocal, 4),
    "RigidBodyRxyz": (rigid.RotXYZ2RotationMatrix, rigid.RotXYZ2GLocal, 3),
    "RigidBodyRotVecLG": (rigid.RotationVector2RotationMatrix, None, 3),
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Carrier:
    """The carrier's node and the slaved points in its frame.

    Parameters
    ----------
    node : exudyn.NodeIndex
    kind : str
        Exudyn's node type: ``RigidBodyEP``, ``RigidBodyRxyz`` or ``RigidBodyRotVecLG``.
    reference : ndarray, shape (3 + rotation coordinates,)
        The node's reference coordinates.
    local : ndarray, shape (s, 3)
        xbar [m].
    """

    node: Any
    kind: str
    reference: np.ndarray
    local: np.ndarray

    @classmethod
    def of(cls, mbs: Any, item: Any, positions: np.ndarray) -> Carrier:
        """Return the carrier for slaved points at global reference positions, shape (s, 3) [m]."""
        node = item
        if isinstance(item, exu.ObjectIndex):
            data = mbs.GetObject(item)
            if "nodeNumber" not in data:
                raise InputError(
                    "CarriedOuter.itemNumber must be a rigid body or its node, got an object of type "
                    f"{data['objectType']}; "
                    "use FixedOuter() for ground, or carry the bush by a rigid body joined to your flexible part."
                )
            node = exu.NodeIndex(int(data["nodeNumber"]))
        if not isinstance(node, exu.NodeIndex):
            raise InputError(
                f"CarriedOuter.itemNumber must be an ObjectIndex or NodeIndex, got {item!r}; pass what "
                "mbs.CreateRigidBody returned."
            )
        data = mbs.GetNode(node)
        kind = data["nodeType"]
        if kind not in _KINDS:
            raise InputError(
                f"CarriedOuter.itemNumber must have a rigid node of type {', '.join(_KINDS)}, got {kind}; create the "
                "body with one of these nodeTypes."
            )
        reference = np.array(data["referenceCoordinates"], dtype=float)
        rotation = _KINDS[kind][0](reference[3:])
        return cls(node=node, kind=kind, reference=reference, local=(positions - reference[:3]) @ rotation)

    @property
    def size(self) -> int:
        """Number of coordinates of the node."""
        return 3 + _KINDS[self.kind][2]

    def rotation(self, q: np.ndarray) -> np.ndarray:
        """Return A, shape (3, 3), at coordinates q (without reference values)."""
        return np.asarray(_KINDS[self.kind][0](self.reference[3:] + q[3:]))

    def rotation_rate(self, q: np.ndarray) -> np.ndarray:
        """Return G, shape (3, rotation coordinates); identity for a Lie group node, whose rates are omega itself."""
        function = _KINDS[self.kind][1]
        return np.eye(3) if function is None else np.asarray(function(self.reference[3:] + q[3:]))

    def positions(self, q: np.ndarray) -> np.ndarray:
        """Return r + A xbar, shape (s, 3) [m]."""
        return self.reference[:3] + q[:3] + self.local @ self.rotation(q).T

    def velocities(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Return dr/dt + A (omega × xbar), shape (s, 3) [m/s]."""
        omega = self.rotation_rate(q) @ q_t[3:]
        return q_t[:3] + np.cross(omega, self.local) @ self.rotation(q).T

    def velocity_accelerations(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Return the accelerations at zero second derivatives of the coordinates, shape (s, 3) [m/s^2].

        A (omega × (omega × xbar) + alpha × xbar) with alpha = dG/dt dtheta/dt; that vanishes for Euler parameters.
        """
        omega = self.rotation_rate(q) @ q_t[3:]
        local = np.cross(omega, np.cross(omega, self.local))
        if self.kind == "RigidBodyRxyz":
            alpha = np.asarray(rigid.RotXYZ2GLocal_t(self.reference[3:] + q[3:], q_t[3:])) @ q_t[3:]
            local = local + np.cross(alpha, self.local)
        return local @ self.rotation(q).T

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """Return B = d(positions)/dq = [I, -A [xbar]× G], shape (3 s, size)."""
        A, G = self.rotation(q), self.rotation_rate(q)
        B = np.zeros((len(self.local), 3, self.size))
        B[:, :, :3] = np.eye(3)
        B[:, :, 3:] = np.einsum("ij,njk,kl->nil", A, -_cross(self.local), G)
        return B.reshape(-1, self.size)

    def force_derivative(self, q: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """Return d(B^T f)/dq at constant global forces f, shape (s, 3) [N]; result (size, size).

        With the local torque tau = sum xbar × A^T f this is G^T (dtau/dphi) G + d(G^T tau)/dtheta at constant tau,
        dtau/dphi = sum [xbar]× [A^T f]×; the second part by central differences, exact for Euler parameters, where G is
        linear.
        """
        A, G = self.rotation(q), self.rotation_rate(q)
        local = forces @ A
        result = np.zeros((self.size, self.size))
        turn = np.einsum("nij,njk->ik", _cross(self.local), _cross(local))
        result[3:, 3:] = G.T @ turn @ G
        if self.kind != "RigidBodyRotVecLG":
            torque = np.cross(self.local, local).sum(axis=0)
            step = 1e-6
            for k in range(3, self.size):
                change = np.zeros(self.size)
                change[k] = step
                result[3:, k] += (
                    (self.rotation_rate(q + change) - self.rotation_rate(q - change)).T @ torque / (2 * step)
                )
        return result


def _cross(vectors: np.ndarray) -> np.ndarray:
    """Cross product matrices [v]×, shape (n, 3, 3)."""
    matrices = np.zeros((len(vectors), 3, 3))
    x, y, z = vectors.T
    matrices[:, 0, 1], matrices[:, 0, 2] = -z, y
    matrices[:, 1, 0], matrices[:, 1, 2] = z, -x
    matrices[:, 2, 0], matrices[:, 2, 1] = -y, x
    return matrices
