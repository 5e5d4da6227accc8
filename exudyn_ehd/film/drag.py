"""Drag of a pressure gradient on unequally rough surfaces.

Between rough surfaces the relative speed V of the journal (1) carries ``V/2 (h_T + sigma phi_s)`` in the bore's (2)
frame. Stokes flow is reciprocal (H. A. Lorentz): with the wall force as flux of V and the volume flow as flux of the
pressure gradient, the cross terms are each other's opposite, since together they neither dissipate nor produce
anything. So a pressure gradient pulls the surfaces, shear and pressure on their slopes together, by

    f_1 = -(h_T + sigma phi_s) / 2 dp/dx,        f_2 = -(h_T - sigma phi_s) / 2 dp/dx        per area,

the rougher one more; the sum is what the pressure does on the film's cross section, whatever phi_s. With one surface
smooth the force on it is its shear alone: ``phi_fp h = h_T - sigma Phi_s`` of Patir and Cheng. Here stands what departs
from equal shares, ``-+ sigma phi_s / 2 dp/ds`` in both directions, summed over the links as the carriers' part of the
flow is, so that work and heat match link by link.

Scaled: ``E_x = sum (carrier - gap) (P_i - P_i+1) width``, its torque on the journal is 6 mu R^4 / c E_x, its axial
force 6 mu R^3 / c E_z.

Symbols: cx, cz carriers and cx_h, cz_h their slopes to the link's gap, HF, gap_z the links' gaps, as in
`exudyn_ehd.film.reynolds.links`; P pressure.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.gap import contract_pose

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def drag_sums(P, cx, HF, cz, gap_z, width_x, width_z, link_x, link_z):
    """(E_x, E_z)."""
    n, m = P.shape
    along = 0.0
    across = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        if link_x[i] != 0.0:
            for j in range(m):
                along += (cx[i, j] - HF[i, j]) * width_z[j] * (P[i, j] - P[nxt, j])
        wx = width_x[i]
        for j in range(m - 1):
            across += (wx if link_z[j] != 0.0 else 0.0) * (cz[i, j] - gap_z[i, j]) * (P[i, j] - P[i, j + 1])
    return along, across


@njit(cache=True, fastmath=_FAST)
def drag_rhs(order, count, active, cx, HF, cz, gap_z, width_x, width_z, link_x, link_z, rows):
    """Add the unknown pressures' weights in E_x and E_z to rows (2, count); nothing where the pressure is clipped."""
    n, m = cx.shape
    along, across = np.empty((n, m)), np.empty((n, m))
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        own = 1.0 if link_x[i] != 0.0 else 0.0
        before = 1.0 if link_x[prv] != 0.0 else 0.0
        for j in range(m):
            along[i, j] = (own * (cx[i, j] - HF[i, j]) - before * (cx[prv, j] - HF[prv, j])) * width_z[j]
        last = 0.0
        for j in range(m - 1):
            link = (width_x[i] if link_z[j] != 0.0 else 0.0) * (cz[i, j] - gap_z[i, j])
            across[i, j] = link - last
            last = link
        across[i, m - 1] = -last
    x, z, actives = along.reshape(-1), across.reshape(-1), active.reshape(-1)
    for r in range(count):
        at = order[r]
        if actives[at]:
            rows[0, r] += x[at]
            rows[1, r] += z[at]


@njit(cache=True, fastmath=_FAST)
def drag_gap_slopes(P, cx_h, cz_h, slope, face_slope, width_x, width_z, link_x, link_z, face_out, cell_out):
    """Gradients (n, m) at fixed pressure to the true gap: of E_x on the links i -> i+1, of E_z at the vertices."""
    n, m = P.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            face_out[i, j] = linked * (cx_h[i, j] - 1.0) * width_z[j] * (P[i, j] - P[nxt, j]) * face_slope[i, j]
        half = 0.5 * width_x[i]
        last = 0.0
        for j in range(m - 1):
            link = (half if link_z[j] != 0.0 else 0.0) * (cz_h[i, j] - 1.0) * (P[i, j] - P[i, j + 1])
            cell_out[i, j] = (last + link) * slope[i, j]
            last = link
        cell_out[i, m - 1] = last * slope[i, m - 1]


@njit(cache=True)
def drag_pose_gradient(
    P, cx_h, cz_h, slope, face_slope, width_x, width_z, link_x, link_z, cos_x, sin_x, cos_f, sin_f, z, out
):
    """Add the gradients of `drag_gap_slopes` to the scaled pose to out (2, >= 4): of E_x and of E_z."""
    face, cell = np.empty((1, *P.shape)), np.empty((1, *P.shape))
    drag_gap_slopes(P, cx_h, cz_h, slope, face_slope, width_x, width_z, link_x, link_z, face[0], cell[0])
    along, across = np.zeros((1, 4)), np.zeros((1, 4))
    contract_pose(face, cos_f, sin_f, z, along)
    contract_pose(cell, cos_x, sin_x, z, across)
    for q in range(4):
        out[0, q] += along[0, q]
        out[1, q] += across[0, q]
