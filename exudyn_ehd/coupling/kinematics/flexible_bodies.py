"""Sides on beams whose kinematics are known in closed form: geometrically exact beams, and cables.

Frame on a cable that knows its position and slope only, with exact variations
------------------------------------------------------------------------------
Legend: S, Sx (3, n) maps from coordinates to the centreline r = S (q_ref + q) and its slope s = Sx (q_ref + q); t = s /
|s|; d0 a fixed global unit vector, the director, normal to t in the reference configuration; d = d0 - (d0 t) t
normalised, b = t x d. The cable's frame is [t, d, b]: t is what the cable knows, its roll about t is chosen such that d
stays as close to d0 as t allows. rho joint point in this frame relative to the centreline [m]; w = A rho its lever arm;
a_loc joint frame to cable frame.

With tau = t d0 and c = t x d0, the frame turns with omega = G ds/dt, G = (skew(t) - tau / (1 - tau^2) t c^T) (I - t
t^T) / |s|.

Equations of motion of a body in a floating frame with modes
------------------------------------------------------------
A point X of the body has the position ``r + A (X + Psi z)``, with r, A and the local angular velocity ``w = G q_t`` of
a rigid node and modes z. In the frame's components, with alpha the angular acceleration at zero second derivatives of
the coordinates, the left-hand side without ``M q_tt`` is

    on r:    f   = alpha x s + w x (w x s) + 2 w x S z_t,
    on A:    m   = J alpha + w x J w + 2 sum z_t,i R_i^T w,
    on z_i:  g_i = (K z + D z_t)_i - w . R_i w - 2 w . (C z_t)_i - alpha . (T + C z)_i,

and the mass matrix has the blocks ``m 1, -A s~ G, A S, G^T J G, -G^T (T + C z), M``. The integrals are

    s = m c + S z,   R_i = X_i^T + sum P_ij z_j,   J = J_0 + sum z_i (X_i + R_i),   (C z)_i = sum z_j C_ji,
    S = int Psi dm,   X_i = int x~^T Psi_i~ dm,   P_ij = int Psi_i~^T Psi_j~ dm,
    T = int x~^T Psi dm,   C_ij = int Psi_i~^T Psi_j dm;

A. Zwoelfer, J. Gerstmayr, The nodal-based floating frame of reference formulation with modal reduction, Acta Mechanica
232 (2021) 835. Only Tait-Bryan angles have an alpha: rotation vectors of a Lie group and Euler parameters that keep
their norm have none.
"""

from __future__ import annotations

from typing import NamedTuple

import exudyn as exu
import numpy as np
import scipy
from exudyn.rigidBodyUtilities import Skew
from numba import njit

from exudyn_ehd.coupling.contract import Index, Side
from exudyn_ehd.coupling.kinematics.rigid_nodes import TAIT_BRYAN, add_lever, column, combined, cross, dot
from exudyn_ehd.coupling.kinematics.sides import NodeSide

LARGEST_TURN = 0.9
"""|tau| from which the roll is undefined: the cable has turned by some 64 degrees towards its director."""


@njit(cache=True)
def _turn(t, length, d0, ds):
    """Rotation G ds (3-tuple) of the frame for a change ds of the slope; t and ds are 3-tuples."""
    dt = combined(ds, 1.0 / length, t, -dot(t, ds) / length)
    tau = dot(t, d0)
    return combined(cross(t, dt), 1.0, t, -tau / (1.0 - tau * tau) * dot(cross(t, d0), dt))


@njit(cache=True)
def _turn_change(t, length, d0, ds, es):
    """Change of `_turn` at fixed ds for a change es of the slope."""
    along, tau, c = dot(t, es), dot(t, d0), cross(t, d0)
    r = 1.0 - tau * tau
    dt = combined(ds, 1.0 / length, t, -dot(t, ds) / length)
    et = combined(es, 1.0 / length, t, -along / length)
    changed = combined(et, dot(t, ds), t, dot(et, ds))
    changed = combined(changed, -1.0 / length, dt, -along / length)
    twist = tau / r * dot(c, dt)
    twisted = (1.0 + tau * tau) / (r * r) * dot(et, d0) * dot(c, dt)
    twisted += tau / r * (dot(cross(et, d0), dt) + dot(c, changed))
    turned = combined(cross(et, dt), 1.0, cross(t, changed), 1.0)
    return combined(turned, 1.0, combined(t, twisted, et, twist), -1.0)


@njit(cache=True)
def slope_rotation(s, d0):
    """Frame (3, 3) of a cable with slope s."""
    t = s / np.sqrt(dot(s, s))
    d = d0 - dot(d0, t) * t
    d /= np.sqrt(dot(d, d))
    a = np.empty((3, 3))
    c = cross(t, d)
    for i in range(3):
        a[i, 0], a[i, 1], a[i, 2] = t[i], d[i], c[i]
    return a


@njit(cache=True)
def slope_frame(S, Sx, q, q_t, d0, rho, a_loc, frame_out, jac_out):
    """Fill frame (3, 6) and Jp, Jr at total coordinates ``q`` (n,) and rates; nan where the roll is undefined."""
    s = Sx @ q
    length = np.sqrt(dot(s, s))
    if not (length > 0.0 and abs(dot(s, d0)) < LARGEST_TURN * length):
        frame_out[:] = np.nan
        return
    t = s[0] / length, s[1] / length, s[2] / length
    a = slope_rotation(s, d0)
    w, omega = a @ rho, (0.0, 0.0, 0.0)
    for k in range(q.size):
        turn = _turn(t, length, d0, column(Sx, k))
        arm, omega = cross(turn, w), combined(omega, 1.0, turn, q_t[k])
        for i in range(3):
            jac_out[0, i, k], jac_out[1, i, k] = S[i, k] + arm[i], turn[i]
    frame_out[:, :3], place, speed, spun = a @ a_loc, S @ q, S @ q_t, cross(omega, w)
    for i in range(3):
        frame_out[i, 3], frame_out[i, 4], frame_out[i, 5] = place[i] + w[i], speed[i] + spun[i], omega[i]


@njit(cache=True)
def slope_change(Sx, q, d0, rho, jac, change_out):
    """Fill the derivatives (6, n, n) of Jp and Jr to q at the state for which ``jac`` holds Jr."""
    s = Sx @ q
    length = np.sqrt(dot(s, s))
    t = s[0] / length, s[1] / length, s[2] / length
    for a in range(q.size):
        for b in range(q.size):
            turned = _turn_change(t, length, d0, column(Sx, a), column(Sx, b))
            for i in range(3):
                change_out[i, a, b], change_out[3 + i, a, b] = 0.0, turned[i]
    add_lever(jac[1], slope_rotation(s, d0) @ rho, change_out)


class BeamSide(Side):
    """Frame at a place along a geometrically exact beam element with two rigid-body nodes.

    Position, velocity and angular velocity are interpolated linearly between the nodes, as the element's own virtual
    work does, the rotation along the shortest turn between the two. (Exudyn places points between the nodes on an arc,
    whose rate is not the velocity it reports; a film, which takes the gap from one and its squeezing from the other,
    needs both to agree.) The rate of the shortest turn differs from the interpolated angular velocity by the relative
    rotation of the nodes squared.

    Parameters
    ----------
    ends : pair of NodeSide
        The nodes' own frames.
    share : float
        Place between them, 0 to 1.
    point : ndarray (3,)
        Joint point in the reference configuration, global [m].
    rotation : ndarray (3, 3)
        Joint frame in the reference configuration.
    """

    def __init__(self, ends: tuple[NodeSide, NodeSide], share: float, point: np.ndarray, rotation: np.ndarray) -> None:
        super().__init__([node for end in ends for node in end.nodes], sum(end.size for end in ends))
        self.ends, self.weights, n = ends, (1.0 - share, share), ends[0].size
        self.parts = (ends[0], 1.0 - share, slice(n)), (ends[1], share, slice(n, None))
        rest = np.zeros(self.size)
        self._update_ends(rest, rest)
        section = self.section()
        self.rho = section.T @ (point - self._mean()[:, 0])
        self.rotation = section.T @ rotation

    def _update_ends(self, q: np.ndarray, q_t: np.ndarray) -> None:
        for end, _, place in self.parts:
            end.update(None, q[place], q_t[place], None)

    def _mean(self) -> np.ndarray:
        """Mean position, velocity and angular velocity (3, 3) of the ends, side by side."""
        return self.weights[0] * self.ends[0].frame[:, 3:] + self.weights[1] * self.ends[1].frame[:, 3:]

    def section(self) -> np.ndarray:
        """Rotation (3, 3) of the cross section in the state of the last update."""
        first, second = (end.frame[:, :3] for end in self.ends)
        turn = scipy.spatial.transform.Rotation.from_matrix(first.T @ second).as_rotvec()
        return first @ scipy.spatial.transform.Rotation.from_rotvec(self.weights[1] * turn).as_matrix()

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        if not np.isfinite(q.sum()):
            self.frame[:] = np.nan
            return
        self._update_ends(q, q_t)
        section = self.section()
        self.frame[:, :3] = section @ self.rotation
        self.frame[:, 3:] = self._mean()
        for end, weight, place in self.parts:
            self.jac[:2, :, place] = weight * end.jac[:2]
        self.move_point(section @ self.rho)

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        out = np.zeros((6, self.size, self.size))
        for end, weight, place in self.parts:
            out[:, place, place] = weight * end.change(mbs, q[place])
        add_lever(self.jac[1], self.arm, out)
        return out


class SlopeSide(Side):
    """Frame on a cable, whose nodes hold positions and slopes; see the module's text.

    The roll about the cable is no coordinate: a moment about the cable's axis has no effect.

    Parameters
    ----------
    nodes : list
        One node, or the two of an element.
    reference : ndarray (n,)
        Their reference coordinates.
    place, slope : ndarray (3, n)
        Maps from the coordinates to position and slope.
    director : ndarray (3,)
        Unit vector normal to the cable in the reference configuration, global.
    point, rotation : ndarray (3,), (3, 3)
        Joint point [m] and joint frame in the reference configuration, global.
    """

    def __init__(
        self,
        nodes: list[Index],
        reference: np.ndarray,
        place: np.ndarray,
        slope: np.ndarray,
        director: np.ndarray,
        point: np.ndarray,
        rotation: np.ndarray,
    ) -> None:
        super().__init__(nodes, reference.size)
        self.reference = reference
        self.place, self.slope = np.ascontiguousarray(place), np.ascontiguousarray(slope)
        self.director = np.ascontiguousarray(director)
        own = slope_rotation(self.slope @ reference, self.director)
        self.rho = own.T @ (point - self.place @ reference)
        self.rotation = own.T @ rotation

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,)."""
        slope_frame(
            self.place,
            self.slope,
            self.reference + q,
            q_t,
            self.director,
            self.rho,
            self.rotation,
            self.frame,
            self.jac,
        )

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        out = np.empty((6, self.size, self.size))
        slope_change(self.slope, self.reference + q, self.director, self.rho, self.jac, out)
        return out


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
        self.w, self.W, self.alpha = w, Skew(w), np.zeros(3)
        if self.bryan:
            (h1, h2, h3), (a, b, c) = self.G[:, 3:6].T, q_t[3:6]
            self.pairs = h12, h13, h23 = Skew(h1) @ h2, Skew(h1) @ h3, Skew(h2) @ h3
            # sum over i < j of theta_t,i theta_t,j h_i x h_j
            self.alpha = a * b * h12 + a * c * h13 + b * c * h23
        self.flow, self.growth = self.of.S @ z_t, (z_t @ self.R.reshape(-1, 9)).reshape(3, 3).T
        self.bent = (z_t @ self._C).reshape(-1, 3)
        self.turning = self.W @ self.s + 2.0 * self.flow
        self.f = self.W @ self.turning - Skew(self.s) @ self.alpha
        self.m = self.J @ self.alpha + self.W @ (self.J @ w) + 2.0 * self.growth @ w

    def mass(self, q: np.ndarray) -> np.ndarray:
        """Mass matrix (n + k, n + k) at q."""
        self.frame.update(None, q[: self.rigid], q[: self.rigid], None)
        self._move(q)
        out, n, G = np.zeros((self.size, self.size)), self.rigid, self.G
        out[:n, :n], out[:n, n:], out[n:, n:] = G.T @ self.J @ G, -G.T @ self.turned, self.of.modal_mass
        out[:3, :3] = self.of.mass * np.eye(3)
        out[:3, 3:n], out[:3, n:] = -self.A @ Skew(self.s) @ G[:, 3:], self.A @ self.of.S
        out[3:n, :3], out[n:, :n] = out[:3, 3:n].T, out[:n, n:].T
        return out

    def left_hand_side(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Left-hand side (n + k,) without ``M q_tt``."""
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
        # derivatives by the rotation of the frame, in whose components f and m are given
        df = f_q * Skew(-self.f) @ G - Skew(self.s) @ da - (Skew(self.turning) + W @ Skew(self.s)) @ dw
        dm = f_q * Skew(-self.m) @ G + self.J @ da + (2.0 * self.growth - Skew(self.J @ w) + W @ self.J) @ dw
        out[:n, :n] = G.T @ dm + f_q * (self.A @ self.m @ change.reshape(3, -1)).reshape(n, n)
        out[:3, :n] = self.A @ df
        out[n:, :n] = -(growing @ w + 2.0 * self.bent) @ dw - self.turned.T @ da
        axis = f_q * self.alpha + 2.0 * f_qt * w
        Pw = (of.P.reshape(-1, 3) @ w).reshape(self.count, -1, 3)
        grown = 2.0 * f_q * (q_t[n:] @ Pw) + 2.0 * f_qt * (w @ self.R)
        dm = f_q * (growing @ self.alpha + growing @ w @ W.T) + grown
        out[:n, n:] = G.T @ dm.T
        out[:3, n:] = self.A @ (Skew(axis) + f_q * W @ W) @ of.S
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
            carried, third = a * (b * h2 + c * h3), a * b * Skew(h1) @ h23 + b * c * Skew(h23) @ h3
            out[:, 3] = f_qt * (b * h12 + c * h13)
            out[:, 4] = f_qt * (a * h12 + c * h23) + f_q * Skew(h12) @ carried
            out[:, 5] = f_qt * (a * h13 + b * h23) + f_q * (Skew(h13) @ carried + third)
        return out
