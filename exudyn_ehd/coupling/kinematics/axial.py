"""Place of a journal along its bearing's axis, the eleventh entry of its motion, which films on end faces need.

It is that of the journal's centre, the point of its axis at the housing's joint point in the reference configuration,

    z = e_z . (p_J - z_0 a - p_H),

with the bearing's axis e_z, the journal's axis a, and the distance z_0 of both joint points in the reference
configuration. It does not depend on where along the axis the journal's joint point lies; its rate is w, to second order
in the tilt.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.coupling.kinematics.rigid_nodes import AXIS, PLACE


def centre_of(frame_h: np.ndarray, frame_j: np.ndarray, offset: float) -> np.ndarray:
    """Centre (3,) of the journal in the joint frame for the distance ``offset`` of the joint points, m."""
    arm = frame_j[:, PLACE] - offset * frame_j[:, AXIS] - frame_h[:, PLACE]
    return np.asarray(arm @ frame_h[:, :3])


def axial_variation(wrench_map: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Derivative (n,) of the place to the coordinates: the work of a unit force along the axis at the centre.

    ``wrench_map`` (n, 6) as in `relative`.
    """
    return np.asarray(wrench_map @ [0.0, 0.0, 1.0, centre[1], -centre[0], 0.0])
