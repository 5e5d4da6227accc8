"""Place of a journal along its bearing's axis, the eleventh entry of its motion, which films on end faces need.

With the centre of the journal, the point of its axis at the housing's joint point in the reference configuration,

    z = e_z . (p_J - z_0 a - p_H),

the bearing's axis e_z, the journal's axis a, and the distance z_0 of both joint points in the reference configuration.
The place does not depend on where along the axis the journal's joint point lies; its rate is w, to second order in the
tilt. Frames and Jacobians as in `kinematics`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.coupling.kinematics.rigid_nodes import AXIS, PLACE


def axial_motion(frame_h: np.ndarray, frame_j: np.ndarray, offset: float, motion: np.ndarray) -> np.ndarray:
    """Motion (11,): the first ten entries of ``motion``, and the place for the distance ``offset``, m."""
    centre = frame_j[:, PLACE] - offset * frame_j[:, AXIS]
    return np.append(motion[:10], frame_h[:, AXIS] @ (centre - frame_h[:, PLACE]))


def axial_variation(
    frame_h: np.ndarray, frame_j: np.ndarray, jac_h: np.ndarray, jac_j: np.ndarray, offset: float
) -> np.ndarray:
    """Derivative (n,) of the place to q, columns in the order housing, journal."""
    axis, own = frame_h[:, AXIS], frame_j[:, AXIS]
    arm = frame_j[:, PLACE] - offset * own - frame_h[:, PLACE]
    of_housing = np.cross(axis, arm) @ jac_h[1] - axis @ jac_h[0]
    of_journal = axis @ jac_j[0] - offset * (np.cross(own, axis) @ jac_j[1])
    return np.concatenate((of_housing, of_journal))
