"""Motion of a collar, a plane across its shaft, in the frame of a thrust pad, and its derivatives.

It is that of a journal and of its place z along the axis (`relative`), in the terms of
`exudyn_ehd.film.thrust.face`: the collar crosses the frame's axis at ``zeta = z + bx x + by y``. Both joint points lie
in the plane of the pads in the reference configuration.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.joint.thrust import face_motion, face_motion_map
from exudyn_ehd.joint.thrust_pad import FACE, SIZE

ROWS = (0, 1, 2, 3, 4, 5, 6, 8, 9, 10)
"""Entries of the motion (11,) of `exudyn_ehd.joint.thrust_pad` that kernels of ten entries take; the rest is 0."""
_PLACES = [ROWS.index(entry) for entry in FACE]


def _journal(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
    """Motion (11,) of the shaft as a journal, its place along the axis behind it."""
    return np.append(relative.motion_of(frame_h, frame_j), relative.centre_of(frame_h, frame_j, 0.0)[2])


def motion_of(frame_h: np.ndarray, frame_j: np.ndarray) -> np.ndarray:
    """Motion (11,) of the collar for frames (3, 6) of the pad and of the shaft."""
    out = np.zeros(SIZE)
    out[FACE] = face_motion(_journal(frame_h, frame_j), 0.0)
    return out


def variation_of(
    frame_h: np.ndarray, frame_j: np.ndarray, jac_h: np.ndarray, jac_j: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (10, n) of the motion's `ROWS` to q and q_t, columns in the order pad, shaft."""
    by_q, by_rate = relative.variation_of(frame_h, frame_j, jac_h, jac_j)
    wrench_map, centre = relative.wrench_map(frame_h, frame_j, jac_h, jac_j), relative.centre_of(frame_h, frame_j, 0.0)
    along = relative.axial_variation(wrench_map, centre)
    change, out = face_motion_map(_journal(frame_h, frame_j), 0.0), np.zeros((2, len(ROWS), along.size))
    out[:, _PLACES] = change @ np.array([np.vstack([by_q, along]), np.vstack([by_rate, 0.0 * along])])
    return out[0], out[1]
