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

Kernels as in `rigid_nodes`: vectors of three are tuples, arrays are written in loops.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.coupling.kinematics.rigid_nodes import TAIT_BRYAN, column, combined, cross, dot, in_frame, times
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


class _BodyTerms(NamedTuple):
    """Terms of a body that depend on coordinates: G (3, n), s (3,), J (3, 3), R (k, 3, 3), ``T + C z`` (3, k).

    The last two depend on rates too: ``sum z_t,i R_i^T`` (3, 3), changes of alpha (3, n).
    """

    G: np.ndarray
    s: np.ndarray
    J: np.ndarray
    R: np.ndarray
    turned: np.ndarray
    growth: np.ndarray
    alphas: np.ndarray


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
        self.of = BodyIntegrals(integrals.mass, *(np.ascontiguousarray(a, dtype=float) for a in integrals[1:]))
        n, k = frame.size, integrals.S.shape[1]
        self.rigid, self.size = n, n + k
        shapes = (3, n), (3,), (3, 3), (k, 3, 3), (3, k), (3, 3), (3, n)
        self._at = _BodyTerms(*(np.zeros(shape) for shape in shapes))

    def mass(self, q: np.ndarray) -> np.ndarray:
        """Mass matrix (n + k, n + k) at q."""
        self._move(q, q)
        out = np.empty((self.size, self.size))
        _mass_matrix(self.of, self.frame.frame, self._at, out)
        return out

    def left_hand_side(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Forces (n + k,) beside ``M q_tt``, on the left-hand side."""
        self._move(q, q_t)
        out = np.empty(self.size)
        _left_hand_side(self.of, self.frame.frame, self._at, self.bryan, q, q_t, out)
        return out

    def derivative(self, q: np.ndarray, q_t: np.ndarray, f_q: float, f_qt: float) -> np.ndarray:
        """Derivative (n + k, n + k) of `left_hand_side`: f_q times that to q plus f_qt times that to q_t."""
        self._move(q, q_t)
        change, out = self.frame.change(None, q[: self.rigid]), np.empty((self.size, self.size))
        _derivative(self.of, self.frame.frame, change, self._at, self.bryan, q, q_t, f_q, f_qt, out)
        return out

    def _move(self, q: np.ndarray, q_t: np.ndarray) -> None:
        self.frame.update(None, q[: self.rigid], q_t[: self.rigid], None)
        _settle(self.of, self.frame.frame, self.frame.jac, q, self._at)


@njit(cache=True)
def _settle(of, frame, jac, q, at_out):
    """Fill what coordinates ``q`` make of a body."""
    n, k = at_out.G.shape[1], at_out.R.shape[0]
    for c in range(n):
        g = in_frame(frame, (jac[1, 0, c], jac[1, 1, c], jac[1, 2, c]))
        at_out.G[0, c], at_out.G[1, c], at_out.G[2, c] = g
    for i in range(3):
        at_out.s[i] = of.moment[i]
        for j in range(3):
            at_out.J[i, j] = of.inertia[i, j]
        for a in range(k):
            at_out.s[i] += of.S[i, a] * q[n + a]
            at_out.turned[i, a] = of.T[i, a]
    for a in range(k):
        z = q[n + a]
        for i in range(3):
            for j in range(3):
                at_out.R[a, i, j] = of.X[a, j, i]
        for b in range(k):
            for i in range(3):
                at_out.turned[i, b] += z * of.C[a, b, i]
                for j in range(3):
                    at_out.R[a, i, j] += of.P[a, b, i, j] * q[n + b]
        for i in range(3):
            for j in range(3):
                at_out.J[i, j] += z * (of.X[a, i, j] + at_out.R[a, i, j])


@njit(cache=True)
def _mass_matrix(of, frame, at, out):
    """Fill the mass matrix."""
    n, k = at.G.shape[1], at.R.shape[0]
    s = at.s[0], at.s[1], at.s[2]
    for i in range(3):
        for j in range(3):
            out[i, j] = of.mass if i == j else 0.0
    for c in range(3, n):
        g = column(at.G, c)
        # -A s~ G
        arm, spin = times(frame, cross(g, s)), times(at.J, g)
        for i in range(3):
            out[i, c] = out[c, i] = arm[i]
        for d in range(3, n):
            out[d, c] = dot(column(at.G, d), spin)
    for a in range(k):
        flow, turned = times(frame, column(of.S, a)), column(at.turned, a)
        for i in range(3):
            out[i, n + a] = out[n + a, i] = flow[i]
        for c in range(3, n):
            out[c, n + a] = out[n + a, c] = -dot(column(at.G, c), turned)
        for b in range(k):
            out[n + a, n + b] = of.modal_mass[a, b]


@njit(cache=True)
def _motion(S, at, bryan, q_t):
    """Tuples w, alpha and S z_t; fills ``sum z_t,i R_i^T``."""
    n, k = at.G.shape[1], at.R.shape[0]
    for i in range(3):
        for j in range(3):
            at.growth[i, j] = 0.0
    w = alpha = flow = (0.0, 0.0, 0.0)
    for c in range(3, n):
        w = combined(w, 1.0, column(at.G, c), q_t[c])
    if bryan:
        first, second, third = column(at.G, 3), column(at.G, 4), column(at.G, 5)
        # sum over i < j of theta_t,i theta_t,j h_i x h_j
        alpha = combined(
            cross(first, combined(second, q_t[4], third, q_t[5])), q_t[3], cross(second, third), q_t[4] * q_t[5]
        )
    for a in range(k):
        rate = q_t[n + a]
        flow = combined(flow, 1.0, column(S, a), rate)
        for i in range(3):
            for j in range(3):
                at.growth[i, j] += rate * at.R[a, j, i]
    return w, alpha, flow


@njit(cache=True)
def _force_and_moment(at, w, alpha, flow):
    """Tuples f and m."""
    s = at.s[0], at.s[1], at.s[2]
    f = combined(cross(alpha, s), 1.0, cross(w, combined(cross(w, s), 1.0, flow, 2.0)), 1.0)
    m = combined(combined(times(at.J, alpha), 1.0, cross(w, times(at.J, w)), 1.0), 1.0, times(at.growth, w), 2.0)
    return f, m


@njit(cache=True)
def _left_hand_side(of, frame, at, bryan, q, q_t, out):
    """Fill the left-hand side."""
    n, k = at.G.shape[1], at.R.shape[0]
    w, alpha, flow = _motion(of.S, at, bryan, q_t)
    f, m = _force_and_moment(at, w, alpha, flow)
    out[0], out[1], out[2] = times(frame, f)
    for c in range(3, n):
        out[c] = dot(column(at.G, c), m)
    for a in range(k):
        g = -dot(w, times(at.R[a], w)) - dot(alpha, column(at.turned, a))
        for b in range(k):
            g += of.stiffness[a, b] * q[n + b] + of.damping[a, b] * q_t[n + b]
            g -= 2.0 * q_t[n + b] * (w[0] * of.C[b, a, 0] + w[1] * of.C[b, a, 1] + w[2] * of.C[b, a, 2])
        out[n + a] = g


@njit(cache=True)
def _alpha_changes(at, bryan, q_t, f_q, f_qt):
    """Fill the derivatives (3, n) of alpha: local axes turn, d h_i / d theta_j = h_i x h_j for j > i."""
    if not bryan:
        return
    out = at.alphas
    h1, h2, h3 = column(at.G, 3), column(at.G, 4), column(at.G, 5)
    a, b, c = q_t[3], q_t[4], q_t[5]
    h12, h13, h23 = cross(h1, h2), cross(h1, h3), cross(h2, h3)
    by_second = cross(h12, combined(h2, a * b, h3, a * c))
    by_third = combined(
        combined(cross(h13, combined(h2, a * b, h3, a * c)), 1.0, cross(h1, h23), a * b), 1.0, cross(h23, h3), b * c
    )
    for i in range(3):
        out[i, 3] = f_qt * (b * h12[i] + c * h13[i])
        out[i, 4] = f_qt * (a * h12[i] + c * h23[i]) + f_q * by_second[i]
        out[i, 5] = f_qt * (a * h13[i] + b * h23[i]) + f_q * by_third[i]


@njit(cache=True)
def _derivative(of, frame, change, at, bryan, q, q_t, f_q, f_qt, out):
    """Fill the derivative; ``change`` (6, n, n) is that of the node's Jacobians."""
    n = at.G.shape[1]
    w, alpha, flow = _motion(of.S, at, bryan, q_t)
    f, m = _force_and_moment(at, w, alpha, flow)
    moment = times(frame, m)
    _by_modes(of, frame, at, w, alpha, q_t, f_q, f_qt, out)
    _alpha_changes(at, bryan, q_t, f_q, f_qt)
    s = at.s[0], at.s[1], at.s[2]
    ws, Jw = cross(w, s), times(at.J, w)
    for c in range(n):
        g = column(at.G, c)
        dw = (0.0, 0.0, 0.0)
        for d in range(3, n):
            dw = combined(dw, 1.0, (change[3, d, c], change[4, d, c], change[5, d, c]), q_t[d])
        spin = combined(in_frame(frame, dw), 1.0, cross(w, g), 1.0)
        dw, da = combined(spin, f_q, g, f_qt), column(at.alphas, c)
        # f and m turn with the frame
        df = combined(cross(g, f), f_q, cross(da, s), 1.0)
        df = combined(df, 1.0, cross(dw, combined(ws, 1.0, flow, 2.0)), 1.0)
        df = times(frame, combined(df, 1.0, cross(w, cross(dw, s)), 1.0))
        dm = combined(combined(cross(g, m), f_q, times(at.J, da), 1.0), 1.0, times(at.growth, dw), 2.0)
        dm = combined(combined(dm, 1.0, cross(dw, Jw), 1.0), 1.0, cross(w, times(at.J, dw)), 1.0)
        for i in range(3):
            out[i, c] = df[i]
        for d in range(3, n):
            turned = dot((change[3, d, c], change[4, d, c], change[5, d, c]), moment)
            out[d, c] = dot(column(at.G, d), dm) + f_q * turned
        _modes_by_motion(of.C, at, w, q_t, dw, da, c, out)


@njit(cache=True)
def _modes_by_motion(C, at, w, q_t, dw, da, c, out):
    """Fill column c of g's rows: its change with w and alpha."""
    n, k = at.G.shape[1], at.R.shape[0]
    for a in range(k):
        R = at.R[a]
        g = -dot(dw, times(R, w)) - dot(w, times(R, dw)) - dot(da, column(at.turned, a))
        for b in range(k):
            g -= 2.0 * q_t[n + b] * (dw[0] * C[b, a, 0] + dw[1] * C[b, a, 1] + dw[2] * C[b, a, 2])
        out[n + a, c] = g


@njit(cache=True)
def _by_modes(of, frame, at, w, alpha, q_t, f_q, f_qt, out):
    """Fill the columns of the modes."""
    n, k = at.G.shape[1], at.R.shape[0]
    axis = combined(alpha, f_q, w, 2.0 * f_qt)
    for a in range(k):
        S, R = column(of.S, a), at.R[a]
        df = cross(axis, S)
        df = times(frame, combined(df, 1.0, cross(w, cross(w, S)), f_q))
        grown = (0.0, 0.0, 0.0)
        for b in range(k):
            Pw = times(of.P[a, b], w)
            grown = combined(grown, 1.0, Pw, q_t[n + b])
            turned = axis[0] * of.C[b, a, 0] + axis[1] * of.C[b, a, 1] + axis[2] * of.C[b, a, 2]
            out[n + a, n + b] = f_q * (of.stiffness[a, b] - dot(w, Pw)) + f_qt * of.damping[a, b] - turned
        back = in_frame(R, w)
        both = combined(times(R, w), 1.0, back, 1.0)
        dm = combined(combined(times(R, alpha), 1.0, in_frame(R, alpha), 1.0), 1.0, cross(w, both), 1.0)
        dm = combined(combined(dm, 1.0, grown, 2.0), f_q, back, 2.0 * f_qt)
        for i in range(3):
            out[i, n + a] = df[i]
        for c in range(3, n):
            out[c, n + a] = dot(column(at.G, c), dm)
