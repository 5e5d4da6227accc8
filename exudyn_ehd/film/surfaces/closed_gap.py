"""Drag of a pressure gradient where touching surfaces leave the film another gap than they have.

The part of E_x and E_z in which film and true gap differ; see Closed gaps in `exudyn_ehd.film.loads`. A link in z has
the mean of its vertices' gaps.

Symbols: gap and link are the film's gap at vertices and on the links i -> i+1, true_gap and true_link the surfaces',
slope and face_slope the derivatives of one to the other; fields (n, m).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import Directions

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def closed_sums(P, gap, true_gap, link, true_link, mesh):
    """(E_x, E_z) of the pressures P (n, m)."""
    n, m = P.shape
    width_x, width_z, link_x, link_z = mesh
    along = across = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        if link_x[i] != 0.0:
            for j in range(m):
                along += (link[i, j] - true_link[i, j]) * width_z[j] * (P[i, j] - P[nxt, j])
        total = 0.0
        for j in range(m - 1):
            share = (gap[i, j] - true_gap[i, j]) + (gap[i, j + 1] - true_gap[i, j + 1])
            total += (share if link_z[j] != 0.0 else 0.0) * (P[i, j] - P[i, j + 1])
        across += 0.5 * width_x[i] * total
    return along, across


@njit(cache=True, fastmath=_FAST)
def closed_rhs(order, count, active, gap, true_gap, link, true_link, mesh, rows):
    """Add the unknown pressures' weights in E_x and E_z to rows (2, count); nothing where the pressure is clipped."""
    n, m = active.shape
    width_x, width_z, link_x, link_z = mesh
    known, h, g = active.reshape(-1), gap.reshape(-1), true_gap.reshape(-1)
    face, true_face = link.reshape(-1), true_link.reshape(-1)
    one = np.uint64(1)
    i = prv = 0
    for r in range(count):
        j = order[r] - i * m
        if r == 0 or j < 0 or j >= m:  # rows of a column follow each other: one division per column
            i = order[r] // m
            j = order[r] - i * m
            prv = i - 1 if i > 0 else n - 1
        # flat unsigned indices need no check of their sign
        c, back = np.uint64(order[r]), np.uint64(prv * m + j)
        if not known[c]:
            continue
        x = (face[c] - true_face[c] if link_x[i] != 0.0 else 0.0) - (
            face[back] - true_face[back] if link_x[prv] != 0.0 else 0.0
        )
        rows[0, r] += x * width_z[j]
        own, z = h[c] - g[c], 0.0
        if j + 1 < m and link_z[j] != 0.0:
            z += own + (h[c + one] - g[c + one])
        if j > 0 and link_z[j - 1] != 0.0:
            z -= own + (h[c - one] - g[c - one])
        rows[1, r] += 0.5 * width_x[i] * z


@njit(cache=True, fastmath=_FAST)
def closed_pose_gradient(P, slope, face_slope, couette, mesh, at, shear_out, drag_out):
    """Add gradients at fixed pressure to the scaled pose, of E_x and E_z to drag_out (2, >= 4).

    And those of C, whose gradient to the film's gap is ``couette`` (n, m), to shear_out (>= 4,).
    """
    n, m = P.shape
    width_x, width_z, link_x, link_z = mesh
    at = Directions(*at)
    z = at.z
    for i in range(n):
        cos, sin = at.cos_x[i], at.sin_x[i]
        level = tilt = 0.0
        for j in range(m):
            cell = couette[i, j] * slope[i, j]
            level += cell
            tilt += cell * z[j]
        shear_out[0] -= level * cos
        shear_out[1] -= level * sin
        shear_out[2] -= tilt * cos
        shear_out[3] -= tilt * sin
        level = tilt = 0.0
        for j in range(m - 1):
            drop = (P[i, j] - P[i, j + 1]) if link_z[j] != 0.0 else 0.0
            low, high = drop * (slope[i, j] - 1.0), drop * (slope[i, j + 1] - 1.0)
            level += low + high
            tilt += low * z[j] + high * z[j + 1]
        half = 0.5 * width_x[i]
        drag_out[1, 0] -= half * level * cos
        drag_out[1, 1] -= half * level * sin
        drag_out[1, 2] -= half * tilt * cos
        drag_out[1, 3] -= half * tilt * sin
        if link_x[i] == 0.0:
            continue
        nxt = i + 1 if i + 1 < n else 0
        level = tilt = 0.0
        for j in range(m):
            cell = (face_slope[i, j] - 1.0) * width_z[j] * (P[i, j] - P[nxt, j])
            level += cell
            tilt += cell * z[j]
        drag_out[0, 0] -= level * at.cos_f[i]
        drag_out[0, 1] -= level * at.sin_f[i]
        drag_out[0, 2] -= tilt * at.cos_f[i]
        drag_out[0, 3] -= tilt * at.sin_f[i]
