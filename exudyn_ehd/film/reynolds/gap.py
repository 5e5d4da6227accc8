"""Gap of a tilted rigid journal in a bore, and the chain rule from gaps to the journal's pose.

``H = 1 - (x + bx z) cos theta - (y + by z) sin theta (+ extra)`` in scaled lengths: x, y divided by c; z by R; bx, by
multiplied by R/c. Paper, Eqs. (3), (5), (7). The gap's rate at fixed theta is the same expression in the rates, without
the 1.

Symbols: pose = (x, y, bx, by) scaled, cos_x / sin_x at vertices, cos_f / sin_f at the links i -> i+1, z (m,) vertices.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def rigid_gap(pose, cos_x, sin_x, z, base, H_out):
    """Gap ``base - e(z) . n`` of a rigid journal at the angles given by cos_x, sin_x: H_out (n, m)."""
    for i in range(cos_x.size):
        level = base - pose[0] * cos_x[i] - pose[1] * sin_x[i]
        slope = pose[2] * cos_x[i] + pose[3] * sin_x[i]
        for j in range(z.size):
            H_out[i, j] = level - slope * z[j]


@njit(cache=True)
def largest_eccentricity(pose, half_length):
    """Largest distance of the journal axis from the bearing axis, scaled by c; it is reached at one of the ends."""
    worst = 0.0
    for s in (-half_length, half_length):
        ex = pose[0] + pose[2] * s
        ey = pose[1] + pose[3] * s
        worst = max(worst, np.sqrt(ex * ex + ey * ey))
    return worst


@njit(cache=True)
def rigid_gaps(pose, rate, squeeze, at, half_length, closed, H, HF, H_t):
    """Gaps of a rigid journal at vertices and links, with ``squeeze`` also their rate; returns the smallest gap.

    ``at``: `exudyn_ehd.film.grid.Directions`, as a tuple; ``closed``: whether the grid is a ring. On an arc the
    smallest gap is one of vertices and links.
    """
    cos_x, sin_x, cos_f, sin_f, z = at
    rigid_gap(pose, cos_x, sin_x, z, 1.0, H)
    rigid_gap(pose, cos_f, sin_f, z, 1.0, HF)
    if squeeze:
        rigid_gap(rate, cos_x, sin_x, z, 0.0, H_t)
    if closed:
        return 1.0 - largest_eccentricity(pose, half_length)
    return min(H.min(), HF[:-1].min())


@njit(cache=True, fastmath=_FAST)
def contract_pose(field, cos_x, sin_x, z, out):
    """Add ``sum_ij field_ij dH_ij/dpose`` to out (k, 4) for every field (k, n, m)."""
    count, n, m = field.shape
    for k in range(count):
        ox = 0.0
        oy = 0.0
        obx = 0.0
        oby = 0.0
        for i in range(n):
            s0 = 0.0
            s1 = 0.0
            for j in range(m):
                s0 += field[k, i, j]
                s1 += field[k, i, j] * z[j]
            ox -= s0 * cos_x[i]
            oy -= s0 * sin_x[i]
            obx -= s1 * cos_x[i]
            oby -= s1 * sin_x[i]
        out[k, 0] += ox
        out[k, 1] += oy
        out[k, 2] += obx
        out[k, 3] += oby
