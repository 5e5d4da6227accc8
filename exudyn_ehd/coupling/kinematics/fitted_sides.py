"""The frame of a finite-element body in absolute coordinates: the best rigid fit of some of its nodes, at any rotation.

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

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.kinematics.relative import skew, skews
from exudyn_ehd.coupling.kinematics.rigid_nodes import add_lever

# Smallest extent of the nodes normal to a line, over that along it (both squared), that fixes a rotation.
SLENDER = 1e-8


class FittedSide:
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
        self.nodes, self.size, self.weights, self.rotation = nodes, size, weights, rotation
        self.rows, self.columns = places
        self.reference = reference
        self.spokes = reference - weights @ reference
        self.offset = point - weights @ reference
        self.frame = np.zeros((3, 6))
        self.jac = np.zeros((4, 3, size))
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
        R = fitted_rotation(w, self.spokes, x)
        if R is None:
            self.frame[:] = np.nan
            return
        self.mean = w @ x
        self.turned = self.spokes @ R.T
        self.products = np.einsum("k,ki,kj->ij", w, self.turned, x - self.mean)
        self.inverse = np.linalg.inv(np.trace(self.products) * np.eye(3) - self.products)
        self.arm = R @ self.offset
        self.levers = w[:, None, None] * skews(self.turned.T)
        turn = self.inverse @ self._columns(self.levers)
        self.jac[0] = self._columns(w[:, None, None] * np.eye(3)) - skew(self.arm) @ turn
        self.jac[1] = turn
        omega = turn @ q_t
        self.frame[:, :3], self.frame[:, 3] = R @ self.rotation, self.mean + self.arm
        self.frame[:, 4], self.frame[:, 5] = w @ v + np.cross(omega, self.arm), omega

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state.

        Row i of Jr is the nodes' forces ``w (D^-1 e_i) x r`` of a unit moment.
        """
        turn, w, out = self.jac[1], self.weights[:, None, None], np.zeros((6, self.size, self.size))
        for i, torque in enumerate(self.inverse):
            both = np.multiply.outer(self.turned, torque)
            # minus the change of D torque with the points at fixed R: sum w (r (torque . dx) - torque (r . dx))
            by_points = self._columns(w * (both - both.transpose(0, 2, 1)))
            change = self.inverse @ (by_points - skew(self.products @ torque) @ turn)
            # d(t x r) = dt x r + t x (dphi x r); a skew matrix is minus its transpose
            out[3 + i] = self._columns(self.levers).T @ change
            out[3 + i] -= self._columns(w * (skews(self.turned.T) @ skew(torque))).T @ turn
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
