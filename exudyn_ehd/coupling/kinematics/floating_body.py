"""Equations of motion of a body in a floating frame with modes: mass matrix, forces and exact derivatives.

A point X of the body stands at ``r + A (X + Psi z)``, with r, A and the local angular velocity ``w = G q_t`` of a rigid
node and modes z. In the frame's components, with alpha the angular acceleration at zero second derivatives of the
coordinates, the left-hand side beside ``M q_tt`` is

    on r:    f   = alpha x s + w x (w x s) + 2 w x S z_t,
    on A:    m   = J alpha + w x J w + 2 sum z_t,i R_i^T w,
    on z_i:  g_i = (K z + D z_t)_i - w . R_i w - 2 w . (C z_t)_i - alpha . (T + C z)_i,

and the mass matrix has the blocks ``m 1, -A s~ G, A S, G^T J G, -G^T (T + C z), M``. It takes the integrals

    s = m c + S z,   R_i = X_i^T + sum P_ij z_j,   J = J_0 + sum z_i (X_i + R_i),   (C z)_i = sum z_j C_ji,
    S = int Psi dm,   X_i = int x~^T Psi_i~ dm,   P_ij = int Psi_i~^T Psi_j~ dm,
    T = int x~^T Psi dm,   C_ij = int Psi_i~^T Psi_j dm;

A. Zwoelfer, J. Gerstmayr, The nodal-based floating frame of reference formulation with modal reduction, Acta Mechanica
232 (2021) 835. Only Tait-Bryan angles have an alpha: rotation vectors of a Lie group and Euler parameters that keep
their norm have none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_ehd.coupling.kinematics.relative import skew
from exudyn_ehd.coupling.kinematics.rigid_nodes import TAIT_BRYAN
from exudyn_ehd.coupling.kinematics.sides import NodeSide


class BodyIntegrals(NamedTuple):
    """Integrals of a body with k modes, in its frame; see the module's docstring.

    Attributes
    ----------
    mass, moment, inertia : float, ndarray (3,), (3, 3)
        m [kg], ``m c`` and J_0.
    S, T : ndarray (3, k)
    X : ndarray (k, 3, 3)
    P : ndarray (k, k, 3, 3)
    C : ndarray (k, k, 3)
        C[i, j] is C_ij.
    modal_mass, stiffness, damping : ndarray (k, k)
        M, K and D.
    """

    mass: float
    moment: np.ndarray
    inertia: np.ndarray
    S: np.ndarray
    T: np.ndarray
    X: np.ndarray
    P: np.ndarray
    C: np.ndarray
    modal_mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


class FloatingBody:
    """Mass matrix, left-hand side and its derivatives at coordinates q of node and modes (n + k).

    Parameters
    ----------
    frame : NodeSide
        Frame of the rigid node, without a lever arm.
    integrals : BodyIntegrals
    """

    def __init__(self, frame: NodeSide, integrals: BodyIntegrals) -> None:
        self.frame, self.bryan = frame, frame.kind == TAIT_BRYAN
        self.of = BodyIntegrals(integrals.mass, *map(np.ascontiguousarray, integrals[1:]))
        self.rigid, self.count = frame.size, integrals.S.shape[1]
        self.size = self.rigid + self.count
        # sums over one mode's index are products of matrices
        self._C = np.ascontiguousarray(integrals.C.reshape(self.count, -1))
        self._P = np.ascontiguousarray(integrals.P.transpose(0, 2, 3, 1).reshape(-1, self.count))

    def _move(self, q: np.ndarray) -> None:
        """Find G (3, n), s (3,), R (k, 3, 3), J (3, 3) and ``T + C z`` (3, k) at coordinates to which the frame is."""
        of, z = self.of, q[self.rigid :]
        self.A = self.frame.frame[:, :3]
        self.G = self.A.T @ self.frame.jac[1]
        self.s = of.moment + of.S @ z
        self.R = of.X.transpose(0, 2, 1) + (self._P @ z).reshape(-1, 3, 3)
        self.J = of.inertia + (z @ (of.X + self.R).reshape(-1, 9)).reshape(3, 3)
        self.turned = of.T + (z @ self._C).reshape(-1, 3).T

    def _spin(self, q: np.ndarray, q_t: np.ndarray) -> None:
        """Find the state at q and q_t: w and alpha (3,), S z_t, ``sum z_t,i R_i^T`` (3, 3), C z_t (k, 3), f and m."""
        self.frame.update(None, q[: self.rigid], q_t[: self.rigid], None)
        self._move(q)
        z_t, w = q_t[self.rigid :], self.G @ q_t[: self.rigid]
        self.w, self.W, self.alpha = w, skew(w), np.zeros(3)
        if self.bryan:
            (h1, h2, h3), (a, b, c) = self.G[:, 3:6].T, q_t[3:6]
            self.pairs = h12, h13, h23 = skew(h1) @ h2, skew(h1) @ h3, skew(h2) @ h3
            # sum over i < j of theta_t,i theta_t,j h_i x h_j
            self.alpha = a * b * h12 + a * c * h13 + b * c * h23
        self.flow, self.growth = self.of.S @ z_t, (z_t @ self.R.reshape(-1, 9)).reshape(3, 3).T
        self.bent = (z_t @ self._C).reshape(-1, 3)
        self.turning = self.W @ self.s + 2.0 * self.flow
        self.f = self.W @ self.turning - skew(self.s) @ self.alpha
        self.m = self.J @ self.alpha + self.W @ (self.J @ w) + 2.0 * self.growth @ w

    def mass(self, q: np.ndarray) -> np.ndarray:
        """Mass matrix (n + k, n + k) at q."""
        self.frame.update(None, q[: self.rigid], q[: self.rigid], None)
        self._move(q)
        out, n, G = np.zeros((self.size, self.size)), self.rigid, self.G
        out[:n, :n], out[:n, n:], out[n:, n:] = G.T @ self.J @ G, -G.T @ self.turned, self.of.modal_mass
        out[:3, :3] = self.of.mass * np.eye(3)
        out[:3, 3:n], out[:3, n:] = -self.A @ skew(self.s) @ G[:, 3:], self.A @ self.of.S
        out[3:n, :3], out[n:, :n] = out[:3, 3:n].T, out[:n, n:].T
        return out

    def left_hand_side(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Forces (n + k,) beside ``M q_tt``, on the left-hand side."""
        self._spin(q, q_t)
        rigid, w = self.G.T @ self.m, self.w
        rigid[:3] = self.A @ self.f
        modes = self.of.stiffness @ q[self.rigid :] + self.of.damping @ q_t[self.rigid :]
        return np.concatenate((rigid, modes - self.R @ w @ w - 2.0 * self.bent @ w - self.alpha @ self.turned))

    def derivative(self, q: np.ndarray, q_t: np.ndarray, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (n + k, n + k) of `left_hand_side`: f_q times that to q plus f_qt times that to q_t."""
        self._spin(q, q_t)
        n, of, w, W, G = self.rigid, self.of, self.w, self.W, self.G
        change, out = self.frame.change(None, q[:n])[3:], np.empty((self.size, self.size))
        dw = f_q * (self.A.T @ (q_t[:n] @ change) + W @ G) + f_qt * G
        da, growing = self._alpha_changes(q_t, f_q, f_qt), self.R + self.R.transpose(0, 2, 1)
        # f and m turn with the frame
        df = f_q * skew(-self.f) @ G - skew(self.s) @ da - (skew(self.turning) + W @ skew(self.s)) @ dw
        dm = f_q * skew(-self.m) @ G + self.J @ da + (2.0 * self.growth - skew(self.J @ w) + W @ self.J) @ dw
        out[:n, :n] = G.T @ dm + f_q * (self.A @ self.m @ change.reshape(3, -1)).reshape(n, n)
        out[:3, :n] = self.A @ df
        out[n:, :n] = -(growing @ w + 2.0 * self.bent) @ dw - self.turned.T @ da
        axis = f_q * self.alpha + 2.0 * f_qt * w
        Pw = (of.P.reshape(-1, 3) @ w).reshape(self.count, -1, 3)
        grown = 2.0 * f_q * (q_t[n:] @ Pw) + 2.0 * f_qt * (w @ self.R)
        dm = f_q * (growing @ self.alpha + growing @ w @ W.T) + grown
        out[:n, n:] = G.T @ dm.T
        out[:3, n:] = self.A @ (skew(axis) + f_q * W @ W) @ of.S
        out[n:, n:] = (
            f_q * (of.stiffness - (Pw.reshape(-1, 3) @ w).reshape(self.count, -1))
            + f_qt * of.damping
            - (of.C.reshape(-1, 3) @ axis).reshape(self.count, -1).T
        )
        return out

    def _alpha_changes(self, q_t: np.ndarray, f_q: float, f_qt: float) -> np.ndarray:
        """Derivatives (3, n) of alpha: local axes turn, d h_i / d theta_j = h_i x h_j for j > i."""
        out = np.zeros((3, self.rigid))
        if self.bryan:
            (h1, h2, h3), (h12, h13, h23), (a, b, c) = self.G[:, 3:6].T, self.pairs, q_t[3:6]
            carried, third = a * (b * h2 + c * h3), a * b * skew(h1) @ h23 + b * c * skew(h23) @ h3
            out[:, 3] = f_qt * (b * h12 + c * h13)
            out[:, 4] = f_qt * (a * h12 + c * h23) + f_q * skew(h12) @ carried
            out[:, 5] = f_qt * (a * h13 + b * h23) + f_q * (skew(h13) @ carried + third)
        return out
