"""Carrier of a bush's slaved nodes: points that move with the rigid frame of any side of a joint.

With the frame's position p, rotation A, velocity v, angular velocity omega and Jacobians Jp, Jr (see `kinematics`), a
point X of the bush's frame has the arm s = A X and

    x = p + s,   dx/dt = v + omega x s,   B = dx/dq = Jp - [s]x Jr,
    d2x/dt2 = B q_tt + Vq q_t + (Wq q_t) x s + omega x (omega x s),

where Vq, Wq are the derivatives of v and omega to q. Sides that know no derivatives of their Jacobians (`MarkerSide`)
count them as zero.
"""

from __future__ import annotations

import copy
import weakref

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import CURRENT, INITIAL, REFERENCE, Index, Side
from exudyn_ehd.coupling.items.beams import node_coordinates
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.kinematics.sides import MarkerSide, bind

# Displacement, m or rad, over which initial velocities are found as differences of positions.
SMALL = 1e-6


class Carrier:
    """Points in the frame of a side.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    side : Side
        Carries the bush's frame; the carrier keeps a copy with arrays of its own.
    initial : ndarray (3, 6)
        Its frame (A, p, v, omega) in the initial configuration.
    local : ndarray (s, 3)
        X [m].
    """

    def __init__(self, mbs: exu.MainSystem, side: Side, initial: np.ndarray, local: np.ndarray) -> None:
        # held by the system's own functions: what they refer to must not keep it alive
        self.mbs: exu.MainSystem = weakref.proxy(mbs)
        self.side: Side = copy.deepcopy(side)
        self.initial = initial
        self.local = local
        self._bound = False

    def move(self, q: np.ndarray, q_t: np.ndarray, configuration: exu.ConfigurationType = CURRENT) -> None:
        """Bring frame and Jacobians to the coordinates ``q`` and rates ``q_t`` (n,) of a ``configuration``."""
        if not self._bound:
            bind(self.mbs, self.side)
            self._bound = True
        self.side.update(self.mbs, q, q_t, configuration)

    def positions(self) -> np.ndarray:
        """Return x, shape (s, 3) [m]."""
        return positions(self.side.frame, self.local)

    def velocities(self) -> np.ndarray:
        """Return dx/dt, shape (s, 3) [m/s]."""
        return velocities(self.side.frame, self.local)

    def frame_accelerations(self, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Acceleration and angular acceleration (6,) of the frame at q_tt = 0; `move` has run at the same state."""
        return np.asarray(self.side.change(self.mbs, q) @ q_t @ q_t)

    def point_accelerations(self, frame: np.ndarray) -> np.ndarray:
        """Accelerations (s, 3) [m/s^2] of the points for those of the frame (6,)."""
        arms, omega = self._arms(), self.side.frame[:, 5]
        return frame[:3] + np.cross(frame[3:], arms) + np.cross(omega, np.cross(omega, arms))

    def jacobian(self) -> np.ndarray:
        """Return B, shape (3 s, n)."""
        B = self.side.jac[0].T + np.cross(self.side.jac[1].T, self._arms()[:, None, :])
        return B.transpose(0, 2, 1).reshape(3 * len(self.local), -1)

    def force_derivative(self, q: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """Return d(B^T f)/dq (n, n) at constant global forces f, shape (s, 3) [N].

        That of resultants F = sum f and M = sum s x f at the frame, and dM = sum (dphi x s) x f.
        """
        arms, turn = self._arms(), self.side.jac[1]
        load = np.concatenate((forces, np.cross(arms, forces)), axis=1).sum(axis=0)
        result = np.tensordot(load, self.side.change(self.mbs, q), 1)
        # (dphi x s) x f = s (dphi . f) - dphi (s . f)
        both = np.einsum("si,sj->ij", arms, forces)
        return np.asarray(result + turn.T @ (both - np.trace(both) * np.eye(3)) @ turn)

    def _arms(self) -> np.ndarray:
        return self.local @ self.side.frame[:, :3].T


def positions(frame: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Positions (s, 3) of points ``local`` (s, 3) of a frame (3, 6) [m]."""
    return frame[:, 3] + local @ frame[:, :3].T


def velocities(frame: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Velocities (s, 3) of points ``local`` (s, 3) of a frame (3, 6) [m/s]."""
    return frame[:, 4] + np.cross(frame[:, 5], local @ frame[:, :3].T)


def initial_frame(mbs: exu.MainSystem, item: Item, side: Side) -> np.ndarray:
    """Frame (3, 6) of a side in the initial configuration, before Assemble."""
    if not isinstance(side, MarkerSide):
        own: Side = copy.deepcopy(side)
        own.update(mbs, item.initial_coordinates, item.initial_velocities, INITIAL)
        return own.frame
    reference, initial, rates = node_coordinates(mbs, tuple(side.nodes))
    place, matrix = _marker_frame(mbs, side, reference + initial, reference)
    frame = np.zeros((3, 6))
    frame[:, :3], frame[:, 3] = matrix @ side.rotation, place
    fastest = np.abs(rates).max(initial=0.0)
    if fastest > 0.0:
        step = SMALL / fastest
        ends = [_marker_frame(mbs, side, reference + initial + s * step * rates, reference) for s in (1.0, -1.0)]
        frame[:, 4] = (ends[0][0] - ends[1][0]) / (2.0 * step)
        spin = (ends[0][1] - ends[1][1]) @ matrix.T / (2.0 * step)
        frame[:, 5] = 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
    return frame


def _marker_frame(
    mbs: exu.MainSystem, side: MarkerSide, coordinates: np.ndarray, reference: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of a marker at coordinates of its nodes.

    Before Assemble Exudyn knows the reference configuration only: the nodes' reference coordinates are moved and put
    back.
    """
    output = exu.OutputVariableType
    try:
        _set_reference(mbs, side.nodes, coordinates)
        place = np.array(mbs.GetMarkerOutput(side.marker, output.Position, REFERENCE))
        return place, np.array(mbs.GetMarkerOutput(side.marker, output.RotationMatrix, REFERENCE)).reshape(3, 3)
    finally:
        _set_reference(mbs, side.nodes, reference)


def _set_reference(mbs: exu.MainSystem, nodes: list[Index], coordinates: np.ndarray) -> None:
    start = 0
    for node in nodes:
        size = len(mbs.GetNodeParameter(node, "referenceCoordinates"))
        mbs.SetNodeParameter(node, "referenceCoordinates", coordinates[start : start + size].tolist())
        start += size
