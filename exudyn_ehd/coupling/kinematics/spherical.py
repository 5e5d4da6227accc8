"""Relative motion of a ball in the frame of its socket, and its derivatives to the coordinates of both.

Frames and Jacobians as in `rigid_nodes`; h: the socket, j: the ball, of whose frame the place alone counts. With r =
p_j - p_h and A the socket's frame

    e = A^T r,   v = A^T (v_j - v_h - w_h x r) = A^T u,   w = A^T (w_j - w_h) = A^T s,

and where the socket turns by dphi a vector A^T g fixed in space changes by -A^T (dphi x g).
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.coupling.kinematics.relative import skew
from exudyn_ehd.coupling.kinematics.rigid_nodes import PLACE, SPIN, VELOCITY
from exudyn_ehd.joint.spherical.model import SIZE

ROWS = (0, 1, 2, 3, 4, 5, 6, 8, 9, 10)
"""Entries of the motion (11,) of `exudyn_ehd.joint.spherical.model` that kernels of ten entries take; the rest is 0."""


def motion_of(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
    """Motion (11,) of the ball for frames (3, 6)."""
    out = np.zeros(SIZE)
    d = frame_j - frame_h
    turn = skew(frame_h[:, SPIN]) @ d[:, PLACE]
    out[:3], out[4:7], out[8:] = (d[:, PLACE], d[:, VELOCITY] - turn, d[:, SPIN]) @ frame_h[:, :3]
    return out


def variation_of(
    frame_h: np.ndarray, frame_j: np.ndarray, jac_h: np.ndarray, jac_j: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (10, n) of the motion's `ROWS` to q and q_t, columns in the order socket, ball."""
    d = frame_j - frame_h
    spin = skew(frame_h[:, SPIN])
    arm, moving = skew(d[:, PLACE]), skew(d[:, VELOCITY] - spin @ d[:, PLACE])
    by_q: list[np.ndarray] = []
    by_rate: list[np.ndarray] = []
    for sign, (jp, jr, vq, wq) in ((-1.0, jac_h), (1.0, jac_j)):
        place, rate, spun = jp, vq - spin @ jp, wq
        if sign < 0.0:
            place, rate = jp - arm @ jr, rate - arm @ wq - moving @ jr
            spun = wq - skew(d[:, SPIN]) @ jr
        for columns, parts in ((by_q, (place, rate, spun)), (by_rate, (0.0 * place, place, jr))):
            e, v, w = (sign * frame_h[:, :3].T @ part for part in parts)
            columns.append(np.concatenate([e, np.zeros_like(e[:1]), v, w]))
    return np.concatenate(by_q, axis=1), np.concatenate(by_rate, axis=1)
