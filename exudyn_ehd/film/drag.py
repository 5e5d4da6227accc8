"""Drag of a pressure gradient on unequally rough surfaces.

Between rough surfaces the relative speed V of the journal (1) carries ``V/2 (h_T + sigma phi_s)`` in the bore's (2) frame. Stokes flow is
reciprocal (H. A. Lorentz): with the wall force as flux of V and the volume flow as flux of the pressure gradient, the cross terms are each
other's opposite, since together they neither dissipate nor produce anything. So a pressure gradient pulls the surfaces, shear and pressure on
their slopes together, by

    f_1 = -(h_T + sigma phi_s) / 2 dp/dx,        f_2 = -(h_T - sigma phi_s) / 2 dp/dx        per area,

the rougher one more; the sum is what the pressure does on the film's cross section, whatever phi_s. With one surface smooth the force on it
is its shear alone: ``phi_fp h = h_T - sigma Phi_s`` of Patir and Cheng. Here stands what departs from equal shares, ``-+ sigma phi_s / 2 dp/ds``
in both directions, summed over the links as the carriers' part of the flow is, so that work and heat match link by link.

Scaled: ``E_x = sum (carrier - gap) (P_i - P_i+1) width``, its torque on the journal is 6 mu R^4 / c E_x, its axial force 6 mu R^3 / c E_z.

Symbols: cx, cz carriers and cx_h, cz_h their slopes to the link's gap, HF, gap_z the links' gaps, as in `exudyn_ehd.film.flux`; P pressure.
"""

from __future__ import annotations

from numba import njit

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
        for j in range(m - 1):
            if link_z[j] != 0.0:
                across += (cz[i, j] - gap_z[i, j]) * width_x[i] * (P[i, j] - P[i, j + 1])
    return along, across


@njit(cache=True, fastmath=_FAST)
def drag_rhs(order, count, active, cx, HF, cz, gap_z, width_x, width_z, link_x, link_z, rows):
    """Add the unknown pressures' weights in E_x and E_z to rows (2, count); nothing where the pressure is clipped."""
    n, m = cx.shape
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        if not active[i, j]:
            continue
        prv = i - 1 if i > 0 else n - 1
        if link_x[i] != 0.0:
            rows[0, r] += (cx[i, j] - HF[i, j]) * width_z[j]
        if link_x[prv] != 0.0:
            rows[0, r] -= (cx[prv, j] - HF[prv, j]) * width_z[j]
        if j + 1 < m and link_z[j] != 0.0:
            rows[1, r] += (cz[i, j] - gap_z[i, j]) * width_x[i]
        if j > 0 and link_z[j - 1] != 0.0:
            rows[1, r] -= (cz[i, j - 1] - gap_z[i, j - 1]) * width_x[i]


@njit(cache=True, fastmath=_FAST)
def drag_gap_slopes(P, cx_h, cz_h, slope, face_slope, width_x, width_z, link_x, link_z, face_out, cell_out):
    """Gradients at fixed pressure to the true gap: face_out (n, m) of E_x on the links i -> i+1, cell_out (n, m) of E_z at the vertices."""
    n, m = P.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            face_out[i, j] = linked * (cx_h[i, j] - 1.0) * width_z[j] * (P[i, j] - P[nxt, j]) * face_slope[i, j]
            cell_out[i, j] = 0.0
        for j in range(m - 1):
            if link_z[j] != 0.0:
                half = 0.5 * (cz_h[i, j] - 1.0) * width_x[i] * (P[i, j] - P[i, j + 1])
                cell_out[i, j] += half * slope[i, j]
                cell_out[i, j + 1] += half * slope[i, j + 1]
