"""Sides on beams whose kinematics are known in closed form: geometrically exact beams, and cables.

The frame on a cable that knows its position and slope only, with exact variations.

Legend: S, Sx (3, n) maps from coordinates to the centreline r = S (q_ref + q) and its slope s = Sx (q_ref + q); t = s /
|s|; d0 a fixed global unit vector, the director, normal to t in the reference configuration; d = d0 - (d0 t) t
normalised, b = t x d. The cable's frame is [t, d, b]: t is what the cable knows, its roll about t is chosen such that d
stays as close to d0 as t allows. rho joint point in this frame relative to the centreline [m]; w = A rho its lever arm;
a_loc joint frame to cable frame.

With tau = t d0, r = 1 - tau^2 and c = t x d0, the frame turns with omega = G ds/dt, where G = U P, U = skew(t) -
tau / r t c^T and P = (I - t t^T) / |s|. A change ds of the slope changes G v by (M P + U N) ds, with x = P v,

    M = -skew(x) - (1 + tau^2) / r^2 (c x) t d0^T - tau / r ((c x) I + t (d0 x x)^T),
    N = -(((t v) I + t v^T) P + x t^T) / |s|,

and the product a G v of a fixed vector a by ds H v, with b = U^T a,

    H = P (-skew(a) - (a t) (1 + tau^2) / r^2 d0 c^T - tau / r (a c^T + (a t) skew(d0))) P
        - (P b t^T + (b t) P + t (P b)^T) / |s|.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.kinematics.relative import skew
from exudyn_ehd.coupling.kinematics.sides import NodeSide

_UNIT = np.eye(3)
LARGEST_TURN = 0.9
"""|tau| from which the roll is undefined: the cable has turned by some 64 degrees towards its director."""


def slope_rotation(s: np.ndarray, d0: np.ndarray) -> np.ndarray:
    """Frame (3, 3) of a cable with slope s."""
    t = s / np.sqrt(s @ s)
    d = d0 - (d0 @ t) * t
    d = d / np.sqrt(d @ d)
    return np.column_stack((t, d, skew(t) @ d))


class BeamSide:
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
        self.ends = ends
        self.weights = (1.0 - share, share)
        self.nodes = [node for end in ends for node in end.nodes]
        self.size = sum(end.size for end in ends)
        self.frame = np.zeros((3, 6))
        self.jac = np.zeros((4, 3, self.size))
        rest = np.zeros(self.size)
        self._update_ends(rest, rest)
        section = self.section()
        self.rho = section.T @ (point - self._mean(3))
        self.rotation = section.T @ rotation
        self.arm = section @ self.rho

    def _parts(self) -> tuple[tuple[NodeSide, float, slice], ...]:
        n = self.ends[0].size
        return (
            (self.ends[0], self.weights[0], slice(0, n)),
            (self.ends[1], self.weights[1], slice(n, self.size)),
        )

    def _update_ends(self, q: np.ndarray, q_t: np.ndarray) -> None:
        for end, _, place in self._parts():
            end.update(None, q[place], q_t[place], None)

    def _mean(self, column: int) -> np.ndarray:
        return self.weights[0] * self.ends[0].frame[:, column] + self.weights[1] * self.ends[1].frame[:, column]

    def section(self) -> np.ndarray:
        """Rotation (3, 3) of the cross section in the state of the last update."""
        first, second = (end.frame[:, :3] for end in self.ends)
        turn = Rotation.from_matrix(first.T @ second).as_rotvec()
        return first @ Rotation.from_rotvec(self.weights[1] * turn).as_matrix()

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
        for end, weight, place in self._parts():
            self.jac[:2, :, place] = weight * end.jac[:2]
        self.jac[0] += np.cross(self.jac[1].T, self.arm).T

    def vary(self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray) -> None:
        """Fill Vq, Wq; `update` must have run at the same state."""
        for end, weight, place in self._parts():
            end.vary(mbs, q[place], q_t[place])
            self.jac[2:, :, place] = weight * end.jac[2:]
        moved = np.cross(self.jac[1].T, self.arm)
        self.jac[2] += (np.cross(self.jac[3].T, self.arm) + np.cross(self.frame[:, 5], moved)).T

    def geometric(
        self, mbs: exu.MainSystem | None, q: np.ndarray, force: np.ndarray, moment: np.ndarray, out: np.ndarray
    ) -> None:
        """Write d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment into ``out``."""
        total = moment + np.cross(self.arm, force)
        for end, weight, place in self._parts():
            end.geometric(mbs, q[place], weight * force, weight * total, out[place, place])
        out += self.jac[1].T @ np.cross(np.cross(self.jac[1].T, self.arm), force).T


class SlopeSide:
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
        self.nodes = nodes
        self.reference = reference
        self.size = reference.size
        self.place, self.slope, self.director = place, slope, director
        self.across = skew(director)
        own = slope_rotation(self.slope @ reference, self.director)
        self.rho = own.T @ (point - self.place @ reference)
        self.rotation = own.T @ rotation
        self.frame = np.zeros((3, 6))
        self.jac = np.zeros((4, 3, self.size))

    def update(
        self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType | None
    ) -> None:
        """Fill the frame and Jp, Jr at coordinates ``q`` and rates ``q_t`` (n,); nan where the roll is undefined."""
        total = self.reference + q
        s = self.slope @ total
        length = float(np.sqrt(s @ s))
        if not (length > 0.0 and abs(s @ self.director) < LARGEST_TURN * length):
            self.frame[:] = np.nan
            return
        self.length, self.tangent = length, s / length
        t, cross, tau = self.tangent, skew(self.tangent), float(s @ self.director) / length
        self.tau, self.normal = tau, cross @ self.director
        self.by_tangent = cross - tau / (1.0 - tau**2) * t[:, None] * self.normal
        self.by_slope = (_UNIT - t[:, None] * t) / length
        root = np.sqrt(1.0 - tau**2)
        axes = np.array((t, (self.director - tau * t) / root, self.normal / root)).T
        lever = axes @ self.rho
        self.arm = skew(lever)
        self.jac[1] = self.by_tangent @ self.by_slope @ self.slope
        self.jac[0] = self.place - self.arm @ self.jac[1]
        self.frame[:, :3], self.frame[:, 3] = axes @ self.rotation, self.place @ total + lever
        self.frame[:, 4:] = (self.jac[:2] @ q_t).T

    def vary(self, mbs: exu.MainSystem | None, q: np.ndarray, q_t: np.ndarray) -> None:
        """Fill Vq, Wq; `update` must have run at the same state."""
        t, tau, v = self.tangent, self.tau, self.slope @ q_t
        x, r = self.by_slope @ v, 1.0 - tau**2
        along = float(self.normal @ x)
        M = -skew(x) - (1.0 + tau**2) / r**2 * along * t[:, None] * self.director
        M -= tau / r * (along * _UNIT + t[:, None] * (self.across @ x))
        N = ((t @ v) * _UNIT + t[:, None] * v) @ self.by_slope + x[:, None] * t
        self.jac[3] = (M @ self.by_slope - self.by_tangent @ N / self.length) @ self.slope
        self.jac[2] = -self.arm @ self.jac[3] - skew(self.frame[:, 5]) @ self.arm @ self.jac[1]

    def geometric(
        self, mbs: exu.MainSystem | None, q: np.ndarray, force: np.ndarray, moment: np.ndarray, out: np.ndarray
    ) -> None:
        """Write d(Jp^T F + Jr^T M) / dq (n, n) at fixed global force and moment into ``out``."""
        t, tau, total = self.tangent, self.tau, moment + self.arm @ force
        r, along, pulled = 1.0 - tau**2, float(total @ t), total @ self.by_tangent
        K = -skew(total) - along * (1.0 + tau**2) / r**2 * self.director[:, None] * self.normal
        K -= tau / r * (total[:, None] * self.normal + along * self.across)
        turned = self.by_slope @ pulled
        H = turned[:, None] * t + (pulled @ t) * self.by_slope + t[:, None] * turned
        H = self.by_slope @ K @ self.by_slope - H / self.length
        out[:] = self.slope.T @ H.T @ self.slope + self.jac[1].T @ skew(force) @ self.arm @ self.jac[1]
