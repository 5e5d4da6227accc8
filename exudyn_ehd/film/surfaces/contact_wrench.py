"""Wrench of contact pressures with its gradient; chain rule through a gap limiter.

Symbols: weight integration weights (n, m), cos_x / sin_x at the vertices, z
(m,); basis e = (cos, sin, z cos, z sin, 1).
"""

import math

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def _slip(motion, transition, R):
    """Direction of the slip in theta and in z, shares of its regularised size, and that size, m/s."""
    v = R * motion[8]
    w = motion[9]
    size = math.sqrt(v * v + w * w + transition * transition)
    return v / size, w / size, size


@njit(cache=True)
def _dragged(a, b, sc, ss, szc, szs, sn, R):
    """Force and moment about O of a traction of -a in theta and -b in z per pressure."""
    return a * ss, -a * sc, -b * sn, R * (a * szc - b * ss), R * (a * szs + b * sc), -a * R * sn


@njit(cache=True, fastmath=_FAST)
def contact_wrench(P, weight, cos_x, sin_x, z, motion, friction, transition, R, integrals_out, drag_out, wrench):
    """Integrals ``sum P weight e`` of one contact's pressures, their wrench and that of their Coulomb friction.

    The pressures do no work on the journal's spin, so that their torque about O is e x F; friction
    acts at the bore's points against the slip, regularised as ``v / sqrt(|v|^2 + v0^2)``.

    Parameters
    ----------
    P, weight : (n, m) arrays
        Contact pressure, Pa, and integration weights.
    motion : (10,) array
        Of the journal, SI units; pose and speeds are read.
    friction, transition, R : float
        Friction coefficient, v0 (m/s) and journal radius (m).
    integrals_out : (5,) array
        Overwritten.
    drag_out, wrench : (6,) arrays
        Friction is added to both, the pressures to ``wrench``; N and Nm about O.
    """
    n, m = P.shape
    sc = ss = szc = szs = sn = 0.0
    for i in range(n):
        s0 = 0.0
        s1 = 0.0
        for j in range(m):
            pw = P[i, j] * weight[i, j]
            s0 += pw
            s1 += pw * z[j]
        sc += s0 * cos_x[i]
        ss += s0 * sin_x[i]
        szc += s1 * cos_x[i]
        szs += s1 * sin_x[i]
        sn += s0
    integrals_out[0], integrals_out[1], integrals_out[2], integrals_out[3], integrals_out[4] = sc, ss, szc, szs, sn
    if sn == 0.0:
        return
    area = R * R
    wrench[0] -= area * sc
    wrench[1] -= area * ss
    wrench[3] += area * R * szs
    wrench[4] -= area * R * szc
    wrench[5] += area * (motion[1] * sc - motion[0] * ss + R * (motion[3] * szc - motion[2] * szs))
    if friction == 0.0:
        return
    a, b, _ = _slip(motion, transition, R)
    drag = _dragged(friction * area * a, friction * area * b, sc, ss, szc, szs, sn, R)
    for r in range(6):
        drag_out[r] += drag[r]
        wrench[r] += drag[r]


@njit(cache=True, fastmath=_FAST)
def contact_tangent(
    slope, weight, cos_x, sin_x, z, motion, pose_scale, friction, transition, R, integrals, grads_out, tangent
):
    """Add d(wrench of `contact_wrench`) / d(motion) to ``tangent`` (6, 10),
    from the ``slope`` (n, m) of the pressure with the scaled gap.

    ``grads_out`` (5, 4): gradients ``-sum slope weight e (cos, sin, z cos, z sin)``
    of the ``integrals`` (5,) to the scaled pose.
    """
    n, m = slope.shape
    G = grads_out
    G[:] = 0.0
    for i in range(n):
        s0 = 0.0
        s1 = 0.0
        s2 = 0.0
        for j in range(m):
            pw = slope[i, j] * weight[i, j]
            s0 += pw
            s1 += pw * z[j]
            s2 += pw * z[j] * z[j]
        if s0 == 0.0:
            continue
        along, turn = (s0, s1, s2), (cos_x[i], sin_x[i])
        for q in range(4):
            G[4, q] -= along[q // 2] * turn[q % 2]
            for k in range(4):
                G[k, q] -= along[q // 2 + k // 2] * turn[q % 2] * turn[k % 2]
    weights = np.empty((6, 5))
    contact_weights(motion, friction, transition, R, weights)
    for r in range(6):
        for q in range(4):
            change = 0.0
            for k in range(5):
                change += weights[r, k] * G[k, q]
            tangent[r, q] += change * pose_scale[q]
    sc, ss, szc, szs, sn = integrals[0], integrals[1], integrals[2], integrals[3], integrals[4]
    area = R * R
    tangent[5, 0] -= area * ss
    tangent[5, 1] += area * sc
    tangent[5, 2] -= area * R * szs
    tangent[5, 3] += area * R * szc
    # the slip (a, b) with omega and with the axial speed
    a, b, size = _slip(motion, transition, R)
    scale = friction * area / size
    for q, at, bt in ((8, (1.0 - a * a) * R, -a * b * R), (9, -a * b, 1.0 - b * b)):
        drag = _dragged(scale * at, scale * bt, sc, ss, szc, szs, sn, R)
        for r in range(6):
            tangent[r, q] += drag[r]


@njit(cache=True)
def contact_weights(motion, friction, transition, R, out):
    """Weights (6, 5) of the integrals of `contact_wrench` in the wrench."""
    a, b, _ = _slip(motion, transition, R)
    a *= friction
    b *= friction
    area = R * R
    out[:] = 0.0
    out[0, 0], out[0, 1] = -area, area * a
    out[1, 0], out[1, 1] = -area * a, -area
    out[2, 4] = -area * b
    out[3, 1], out[3, 2], out[3, 3] = -area * R * b, area * R * a, area * R
    out[4, 0], out[4, 2], out[4, 3] = area * R * b, -area * R, area * R * a
    out[5, 0], out[5, 1] = area * motion[1], -area * motion[0]
    out[5, 2], out[5, 3], out[5, 4] = area * R * motion[3], -area * R * motion[2], -area * R * a


@njit(cache=True, fastmath=_FAST)
def chain_links(slope, bend, face_slope, by_rate, by_gap, DX, rate_out, gap_out):
    """Link and storage derivatives from the film's gap to the true gap, all (n, m); DX in place.

    ``slope``, ``bend`` and ``face_slope`` are what a gap limiter returns (`joint.seams`).
    """
    dx, faces = DX.reshape(-1), face_slope.reshape(-1)
    for k in range(dx.size):
        dx[k] *= faces[k]
    a, b, rate, gap = slope.reshape(-1), bend.reshape(-1), by_rate.reshape(-1), by_gap.reshape(-1)
    by_gap_out, by_rate_out = gap_out.reshape(-1), rate_out.reshape(-1)
    for k in range(a.size):
        by_gap_out[k] = gap[k] * a[k] + rate[k] * b[k]
    for k in range(a.size):
        by_rate_out[k] = rate[k] * a[k]
