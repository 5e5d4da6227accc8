"""Relative motion of the two frames of a joint, and the loads of its film on their coordinates, as array kernels.

Frames, Jacobians and legend as in `kinematics`; index h: housing, j: journal. The journal's axis is z of its frame, the
joint frame that of the housing.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.coupling.kinematics.rigid_nodes import cross, times, transposed_times

MOTION = ("x", "y", "bx", "by", "x_t", "y_t", "bx_t", "by_t", "omega", "w")
"""Names of the ten motion components, joint frame."""


def skew(v: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) of the cross product with v (3,)."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


@njit(cache=True)
def relative_motion(frame_h, frame_j, motion_out):
    """Motion (10,) of the journal axis in the joint frame of the housing; see `MOTION`.

    The journal axis is the line (x + bx z, y + by z). All ten components are independent of where along the axis the
    journal's marker sits; w is the velocity along z of the journal's axis point in the mid-plane.

    Returns
    -------
    float
        Cosine of the angle between the axes; the motion is nan if it is below 0.1 (no bearing any more).
    """
    a_h = frame_h[:, :3]
    r = frame_j[:, 3] - frame_h[:, 3]
    d = transposed_times(a_h, r)
    d_t = transposed_times(a_h, frame_j[:, 4] - frame_h[:, 4] - cross(frame_h[:, 5], r))
    spin = transposed_times(a_h, frame_j[:, 5] - frame_h[:, 5])
    a = transposed_times(a_h, frame_j[:, 2])
    if not a[2] > 0.1:
        motion_out[:] = np.nan
        return a[2]
    a_t = cross(spin, a)
    for i in range(2):
        b = a[i] / a[2]
        b_t = (a_t[i] - b * a_t[2]) / a[2]
        motion_out[i] = d[i] - b * d[2]
        motion_out[2 + i] = b
        motion_out[4 + i] = d_t[i] - b_t * d[2] - b * d_t[2]
        motion_out[6 + i] = b_t
    motion_out[8] = spin[0] * a[0] + spin[1] * a[1] + spin[2] * a[2]
    motion_out[9] = d_t[2] - a_t[2] * d[2] / a[2]
    return a[2]


@njit(cache=True)
def _motion_variation(d, d_t, spin, a, a_t, dd, dd_t, dspin, da, out):
    """Variation of the ten motion components from the variation of d, d_t, Omega and a, all in the joint frame."""
    da_t = cross(dspin, a) + cross(spin, da)
    for i in range(2):
        b = a[i] / a[2]
        b_t = (a_t[i] - b * a_t[2]) / a[2]
        db = (da[i] - b * da[2]) / a[2]
        db_t = (da_t[i] - db * a_t[2] - b * da_t[2] - b_t * da[2]) / a[2]
        out[i] = dd[i] - db * d[2] - b * dd[2]
        out[2 + i] = db
        out[4 + i] = dd_t[i] - db_t * d[2] - b_t * dd[2] - db * d_t[2] - b * dd_t[2]
        out[6 + i] = db_t
    out[8] = dspin[0] * a[0] + dspin[1] * a[1] + dspin[2] * a[2] + spin[0] * da[0] + spin[1] * da[1] + spin[2] * da[2]
    out[9] = dd_t[2] - (da_t[2] * d[2] + a_t[2] * dd[2]) / a[2] + a_t[2] * d[2] * da[2] / (a[2] * a[2])


@njit(cache=True)
def motion_variation(frame_h, frame_j, jac_h, jac_j, motion_q_out, motion_qt_out):
    """Derivatives (10, n) of the motion with respect to q and q_t, columns in the order housing, journal."""
    a_h = frame_h[:, :3]
    axis = frame_j[:, 2].copy()
    r = frame_j[:, 3] - frame_h[:, 3]
    omega_h = frame_h[:, 5].copy()
    u = frame_j[:, 4] - frame_h[:, 4] - cross(omega_h, r)
    spin_g = frame_j[:, 5] - omega_h
    d, d_t = transposed_times(a_h, r), transposed_times(a_h, u)
    spin, a = transposed_times(a_h, spin_g), transposed_times(a_h, axis)
    a_t = cross(spin, a)
    zero = np.zeros(3)
    n_h = jac_h.shape[2]
    for side in range(2):
        jac = jac_h if side == 0 else jac_j
        start = 0 if side == 0 else n_h
        for k in range(jac.shape[2]):
            jp, jr, vq, wq = jac[0, :, k], jac[1, :, k], jac[2, :, k], jac[3, :, k]
            if side == 0:
                # the frame turns with the housing: a fixed global vector g changes by -A^T (dphi x g)
                dd = transposed_times(a_h, -jp - cross(jr, r))
                dd_t = transposed_times(a_h, -vq - cross(wq, r) + cross(omega_h, jp) - cross(jr, u))
                dspin = transposed_times(a_h, -wq - cross(jr, spin_g))
                da = transposed_times(a_h, -cross(jr, axis))
                dspin_rate = transposed_times(a_h, -jr)
            else:
                dd = transposed_times(a_h, jp)
                dd_t = transposed_times(a_h, vq - cross(omega_h, jp))
                dspin = transposed_times(a_h, wq)
                da = transposed_times(a_h, cross(jr, axis))
                dspin_rate = transposed_times(a_h, jr)
            _motion_variation(d, d_t, spin, a, a_t, dd, dd_t, dspin, da, motion_q_out[:, start + k])
            # the velocity changes with the rates as the place does with the coordinates
            _motion_variation(d, d_t, spin, a, a_t, zero, dd, dspin_rate, zero, motion_qt_out[:, start + k])


@njit(cache=True)
def global_loads(frame_h, frame_j, wrench, loads_out):
    """Global force and moment at the two markers, rows F_H, M_H, F_J, M_J of ``loads_out`` (4, 3).

    ``wrench`` (6,) acts on the journal, joint frame, moment about O = p_H; the housing gets exactly minus it about O.
    """
    force = times(frame_h[:, :3], wrench[:3])
    moment = times(frame_h[:, :3], wrench[3:])
    r = frame_j[:, 3] - frame_h[:, 3]
    loads_out[0] = -force
    loads_out[1] = -moment
    loads_out[2] = force
    loads_out[3] = moment - cross(r, force)


@njit(cache=True)
def generalized_force(jac_h, jac_j, loads, force_out):
    """Generalized force Q = Jp^T F + Jr^T M (n,) of both sides, order housing, journal."""
    n_h = jac_h.shape[2]
    for side in range(2):
        jac = jac_h if side == 0 else jac_j
        start = 0 if side == 0 else n_h
        for k in range(jac.shape[2]):
            total = 0.0
            for i in range(3):
                total += jac[0, i, k] * loads[2 * side, i] + jac[1, i, k] * loads[2 * side + 1, i]
            force_out[start + k] = total


@njit(cache=True)
def wrench_map(frame_h, frame_j, jac_h, jac_j, map_out):
    """Map (n, 6) from the wrench on the journal, joint frame, to the generalized forces of `generalized_force`."""
    n_h = jac_h.shape[2]
    x, y, z = frame_j[0, 3] - frame_h[0, 3], frame_j[1, 3] - frame_h[1, 3], frame_j[2, 3] - frame_h[2, 3]
    for c in range(3):
        a0, a1, a2 = frame_h[0, c], frame_h[1, c], frame_h[2, c]
        # moment about the journal's point of a force along axis c at O
        m0, m1, m2 = z * a1 - y * a2, x * a2 - z * a0, y * a0 - x * a1
        for k in range(n_h):
            map_out[k, c] = -(jac_h[0, 0, k] * a0 + jac_h[0, 1, k] * a1 + jac_h[0, 2, k] * a2)
            map_out[k, 3 + c] = -(jac_h[1, 0, k] * a0 + jac_h[1, 1, k] * a1 + jac_h[1, 2, k] * a2)
        for k in range(jac_j.shape[2]):
            r0, r1, r2 = jac_j[1, 0, k], jac_j[1, 1, k], jac_j[1, 2, k]
            map_out[n_h + k, c] = (
                jac_j[0, 0, k] * a0 + jac_j[0, 1, k] * a1 + jac_j[0, 2, k] * a2 + r0 * m0 + r1 * m1 + r2 * m2
            )
            map_out[n_h + k, 3 + c] = r0 * a0 + r1 * a1 + r2 * a2


@njit(cache=True)
def modal_jacobian(tangent, k_rigid, d_rigid, motion_q, motion_qt, wrench_map, f_q, f_qt, stiffness, out):
    """Derivative ``-(f_q dQ/dq + f_qt dQ/dq_t)`` (n + k, n + k) of the forces on two sides and on k modes.

    Parameters
    ----------
    tangent : (6 + k, 10 + k) array
        Wrench and loads on the modes to the motion and, combined by f_q and f_qt, to the modes; without their stiffness
        (k,).
    k_rigid, d_rigid, motion_q, motion_qt : (n, n), (n, n), (10, n), (10, n) arrays
        Of the sides, see `tangent_matrices`.
    wrench_map : (n, 6) array
    """
    n, k = wrench_map.shape[0], stiffness.size
    for i in range(n):
        for j in range(n):
            out[i, j] = -(f_q * k_rigid[i, j] + f_qt * d_rigid[i, j])
        row = out[i, n:]
        row[:] = 0.0
        for c in range(6):
            w, known = wrench_map[i, c], tangent[c, 10:]
            if w != 0.0:
                for b in range(k):
                    row[b] -= w * known[b]
    motion = f_q * motion_q + f_qt * motion_qt
    for a in range(k):
        known = tangent[6 + a]
        for i in range(n):
            total = 0.0
            for c in range(10):
                total += known[c] * motion[c, i]
            out[n + a, i] = -total
        for b in range(k):
            out[n + a, n + b] = -known[10 + b]
        out[n + a, n + a] += f_q * stiffness[a]


@njit(cache=True)
def tangent_matrices(frame_h, frame_j, jac_h, jac_j, loads, tangent, motion_q, motion_qt, k_out, d_out):
    """Add dQ/dq to ``k_out`` and write dQ/dq_t to ``d_out`` (n, n); ``k_out`` brings the geometric blocks of the sides.

    ``tangent`` (6, 10) is d wrench / d motion in the joint frame.
    """
    a_h = frame_h[:, :3]
    r = frame_j[:, 3] - frame_h[:, 3]
    force, moment = loads[2], -loads[1]
    n_h, n_j = jac_h.shape[2], jac_j.shape[2]
    load = np.empty((4, 3))
    for c in range(n_h + n_j):
        jac = jac_h if c < n_h else jac_j
        k = c if c < n_h else c - n_h
        for kind in range(2):
            motion = motion_q if kind == 0 else motion_qt
            dw = np.zeros(6)
            for i in range(6):
                for m in range(10):
                    dw[i] += tangent[i, m] * motion[m, c]
            df = times(a_h, dw[:3])
            dm = times(a_h, dw[3:])
            dmj = dm - cross(r, df)
            if kind == 0:
                if c < n_h:
                    # the joint frame turns, and with it the wrench
                    turn_f = cross(jac[1, :, k], force)
                    turn_m = cross(jac[1, :, k], moment)
                    df += turn_f
                    dm += turn_m
                    dmj += turn_m - cross(r, turn_f) + cross(jac[0, :, k], force)
                else:
                    dmj -= cross(jac[0, :, k], force)
            for i in range(3):
                load[0, i], load[1, i], load[2, i], load[3, i] = -df[i], -dm[i], df[i], dmj[i]
            column = np.empty(n_h + n_j)
            generalized_force(jac_h, jac_j, load, column)
            for i in range(n_h + n_j):
                if kind == 0:
                    k_out[i, c] += column[i]
                else:
                    d_out[i, c] = column[i]
