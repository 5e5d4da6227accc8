"""Integrals of contact pressures and of shear between rough surfaces, with gradients; chain rule through a gap limiter.

Symbols: weight integration weights (n, m), cos_x / sin_x at the vertices, z (m,); basis e = (cos, sin, z cos, z sin, 1).
"""

from __future__ import annotations

from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def contact_integrals(P, weight, cos_x, sin_x, z, out):
    """sum P weight e -> out (5,)."""
    n, m = P.shape
    out[:] = 0.0
    for i in range(n):
        s0 = 0.0
        s1 = 0.0
        for j in range(m):
            pw = P[i, j] * weight[i, j]
            s0 += pw
            s1 += pw * z[j]
        out[0] += s0 * cos_x[i]
        out[1] += s0 * sin_x[i]
        out[2] += s1 * cos_x[i]
        out[3] += s1 * sin_x[i]
        out[4] += s0


@njit(cache=True, fastmath=_FAST)
def contact_gradients(slope, weight, cos_x, sin_x, z, out):
    """Gradients of the integrals to the scaled pose, ``-sum slope weight e (cos, sin, z cos, z sin)`` -> out (5, 4)."""
    n, m = slope.shape
    out[:] = 0.0
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
        c = cos_x[i]
        s = sin_x[i]
        out[0, 0] -= s0 * c * c
        out[0, 1] -= s0 * c * s
        out[1, 1] -= s0 * s * s
        out[2, 0] -= s1 * c * c
        out[2, 1] -= s1 * c * s
        out[3, 1] -= s1 * s * s
        out[2, 2] -= s2 * c * c
        out[2, 3] -= s2 * c * s
        out[3, 3] -= s2 * s * s
        out[4, 0] -= s0 * c
        out[4, 1] -= s0 * s
        out[4, 2] -= s1 * c
        out[4, 3] -= s1 * s
    out[1, 0] = out[0, 1]
    out[3, 0] = out[2, 1]
    out[0, 2] = out[2, 0]
    out[0, 3] = out[1, 2] = out[2, 1]
    out[1, 3] = out[3, 1]
    out[3, 2] = out[2, 3]


@njit(cache=True)
def chain_limiter(slope, curvature, face_slope, has_rate, cell, face, rate):
    """Sensitivities (k, n, m) to the film's gap -> to the true gap, in place; ``curvature`` holds curvature times rigid rate."""
    count, n, m = cell.shape
    for i in range(n):
        for j in range(m):
            if slope[i, j] == 1.0 and face_slope[i, j] == 1.0 and curvature[i, j] == 0.0:
                continue
            for k in range(count):
                face[k, i, j] *= face_slope[i, j]
                cell[k, i, j] *= slope[i, j]
                if has_rate:
                    cell[k, i, j] += rate[k, i, j] * curvature[i, j]
                    rate[k, i, j] *= slope[i, j]


@njit(cache=True, fastmath=_FAST)
def couette_integral_law(H, weight, ratio, active, fixed, cavity_share):
    """(C with the viscosity ratio in ``sum weight share ratio / H``, C over the unbroken film)."""
    n, m = H.shape
    whole = 0.0
    unbroken = 0.0
    for i in range(n):
        for j in range(m):
            s = weight[i, j] * ratio[i, j] / H[i, j]
            if active[i, j] or fixed[i, j]:
                unbroken += s
            else:
                whole += s
    return unbroken + cavity_share * whole, unbroken


@njit(cache=True, fastmath=_FAST)
def couette_gradient_ratio(H, weight, ratio, ratio_h, ratio_v, active, fixed, cavity_share, out):
    """dC/dH of `couette_integral_law` -> out (n, m); returns dC/dv."""
    n, m = H.shape
    speed = 0.0
    for i in range(n):
        for j in range(m):
            share = 1.0 if (active[i, j] or fixed[i, j]) else cavity_share
            density = share * weight[i, j] / H[i, j]
            out[i, j] = density * (ratio_h[i, j] - ratio[i, j] / H[i, j])
            speed += density * ratio_v[i, j]
    return speed
