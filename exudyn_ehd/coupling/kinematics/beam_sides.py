"""Sides on beams whose kinematics are known in closed form: geometrically exact beams, and cables.

The frame on a cable that knows its position and slope only, with exact variations: array kernels.

Legend: S, Sx (3, n) maps from coordinates to the centreline r = S (q_ref + q) and its slope s = Sx (q_ref + q); t = s /
|s|; d0 a fixed global unit vector, the director, normal to t in the reference configuration; d = d0 - (d0 t) t
normalised, b = t x d. The cable's frame is [t, d, b]: t is what the cable knows, its roll about t is chosen such that d
stays as close to d0 as t allows. rho joint point in this frame relative to the centreline [m]; w = A rho its lever arm;
a_loc joint frame to cable frame.

With tau = t d0 and c = t x d0, the frame turns with omega = G ds/dt, G = (skew(t) - tau / (1 - tau^2) t c^T) (I - t
t^T) / |s|.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np
import scipy
from numba import njit

from exudyn_ehd.coupling.contract import Index, Side
from exudyn_ehd.coupling.kinematics.rigid_nodes import add_lever, column, combined, cross, dot
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
    axes, place, speed, spun = a @ a_loc, S @ q, S @ q_t, cross(omega, w)
    for i in range(3):
        for j in range(3):
            frame_out[i, j] = axes[i, j]
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
        self.rho = section.T @ (point - self._mean(3))
        self.rotation = section.T @ rotation
        self.arm = section @ self.rho

    def _update_ends(self, q: np.ndarray, q_t: np.ndarray) -> None:
        for end, _, place in self.parts:
            end.update(None, q[place], q_t[place], None)

    def _mean(self, column: int) -> np.ndarray:
        return self.weights[0] * self.ends[0].frame[:, column] + self.weights[1] * self.ends[1].frame[:, column]

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
        self.arm = section @ self.rho
        self.frame[:, :3] = section @ self.rotation
        self.frame[:, 5] = self._mean(5)
        self.frame[:, 3] = self._mean(3) + self.arm
        self.frame[:, 4] = self._mean(4) + np.cross(self.frame[:, 5], self.arm)
        for end, weight, place in self.parts:
            self.jac[:2, :, place] = weight * end.jac[:2]
        self.jac[0] += np.cross(self.jac[1].T, self.arm).T

    def change(self, mbs: exu.MainSystem | None, q: np.ndarray) -> np.ndarray:
        """Derivatives (6, n, n) of Jp and Jr to the coordinates; `update` must have run at the same state."""
        out = np.zeros((6, self.size, self.size))
        for end, weight, place in self.parts:
            out[:, place, place] = weight * end.change(mbs, q[place])
        add_lever(self.jac[1], self.arm, out)
        return out


class SlopeSide(Side):
    """Frame on a cable, whose nodes hold positions and slopes; see the module's text.

    The roll about the cable is no coordinate: a moment about the cable's axis finds no resistance and no motion there.

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
