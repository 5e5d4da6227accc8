"""Two sides on the nodes of rigid bodies, or ground: their kernels and those of `relative` in one call.

On small films the calls from Python take longer than what they call. A side is (kind, reference, rho, rotation, frame,
jac) of `rigid_nodes`, the housing's first; q and q_t (n,) hold both sides' coordinates.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.coupling.kinematics.relative import global_loads, motion_variation, relative_motion, tangent_matrices
from exudyn_ehd.coupling.kinematics.rigid_nodes import node_change, node_frame, vary


@njit(cache=True)
def move_nodes(housing, journal, q, q_t, motion_out):
    """Fill the frames and Jp, Jr of both sides, and the motion (10,)."""
    n = housing[1].size
    if n > 0:
        node_frame(housing[0], q[:n], q_t[:n], housing[1], housing[2], housing[3], housing[4], housing[5])
    if q.size > n:
        node_frame(journal[0], q[n:], q_t[n:], journal[1], journal[2], journal[3], journal[4], journal[5])
    relative_motion(housing[4], journal[4], motion_out)


@njit(cache=True)
def derive_nodes(housing, journal, q, q_t, wrench, tangent):
    """Return the derivatives of `sides.derivatives_between`; the sides' frames and Jp, Jr belong to q and q_t."""
    n, size = housing[1].size, q.size
    frame_h, frame_j, jac_h, jac_j = housing[4], journal[4], housing[5], journal[5]
    loads, stiffness, damping = np.empty((4, 3)), np.zeros((size, size)), np.empty((size, size))
    motion_q, motion_qt = np.empty((10, size)), np.empty((10, size))
    global_loads(frame_h, frame_j, wrench, loads)
    for first, end, side, load in ((0, n, housing, loads[:2]), (n, size, journal, loads[2:])):
        if end > first:
            change = np.empty((6, end - first, end - first))
            node_change(side[0], q[first:end], side[1], side[2], change)
            vary(change, q_t[first:end], load.reshape(6), side[5], stiffness[first:end, first:end])
    motion_variation(frame_h, frame_j, jac_h, jac_j, motion_q, motion_qt)
    tangent_matrices(frame_h, frame_j, jac_h, jac_j, loads, tangent, motion_q, motion_qt, stiffness, damping)
    return stiffness, damping, motion_q, motion_qt
