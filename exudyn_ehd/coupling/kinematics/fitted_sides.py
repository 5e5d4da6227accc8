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
        self.velocities, self.mean = v, w @ x
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

    def vary(self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray) -> None:
        """Fill Vq, Wq; `update` must have run at the same state.

        The variation of ``D omega = sum w r x v`` at fixed v, with dr = dphi x r.
        """
        turn, omega, arm = self.jac[1], self.frame[:, 5], skew(self.arm)
        flow = np.einsum("k,ki,kj->ij", self.weights, self.turned, self.velocities)
        by_turn = flow - np.trace(flow) * np.eye(3) - skew(self.products @ omega)
        rate = self.inverse @ (by_turn @ turn + self._fit_change(omega))
        self.jac[3] = rate
        self.jac[2] = -arm @ rate - skew(omega) @ arm @ turn

    def _fit_change(self, a: np.ndarray) -> np.ndarray:
        """Minus the change of D a with the points at fixed R, (3, n): sum w (r (a . dx) - a (r . dx))."""
        both = np.multiply.outer(self.turned, a)
        return self._columns(self.weights[:, None, None] * (both - both.transpose(0, 2, 1)))

    def geometric(
        self, mbs: exu.MainSystem | None, q: np.ndarray, force: np.ndarray, moment: np.ndarray, out: np.ndarray
    ) -> None:
        """Write d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment into ``out``.

        That of the nodes' forces ``w (D^-1 T) x r`` with the moment T = M + arm x F about the mean.
        """
        turn = self.jac[1]
        torque = self.inverse @ (moment + np.cross(self.arm, force))
        lever = np.outer(self.arm, force)
        by_turn = lever - np.trace(lever) * np.eye(3) - skew(self.products @ torque)
        change = self.inverse @ (by_turn @ turn + self._fit_change(torque))
        # d(t x r) = dt x r + t x (dphi x r); a skew matrix is minus its transpose
        out[:] = self._columns(self.levers).T @ change
        out[:] -= self._columns(self.weights[:, None, None] * (skews(self.turned.T) @ skew(torque))).T @ turn


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
