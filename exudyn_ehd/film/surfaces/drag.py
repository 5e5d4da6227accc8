"""Drag of a pressure gradient on the two surfaces, where they share it unevenly.

Between rough surfaces the relative speed V of the journal (1) carries ``V/2 (h_T + sigma phi_s)`` in the bore's
(2) frame. Stokes flow is reciprocal (H. A. Lorentz): with the wall force as flux of V and the volume flow as flux of
the pressure gradient, the cross terms are each other's opposite, since together they neither dissipate nor produce
anything. So a pressure gradient pulls the surfaces, shear and pressure on their slopes together, by

    f_1 = -(h_T + sigma phi_s) / 2 dp/dx,        f_2 = -(h_T - sigma phi_s) / 2 dp/dx        per area,

the rougher one more; the sum is what the pressure does on the film's cross section, whatever phi_s. With one surface
smooth the force on it is its shear alone: ``phi_fp h = h_T - sigma Phi_s`` of Patir and Cheng. What departs from equal
shares, ``-+ sigma phi_s / 2 dp/ds`` in both directions, is summed over the links as the carriers' part of the flow is,
so that work and heat match link by link: ``E_x = sum (carrier - gap) (P_i - P_i+1) width``; its torque on the journal
is 6 mu R^4 / c E_x, its axial force 6 mu R^3 / c E_z.

Closed gaps. Where surfaces touch, the film has a gap h (a limiter's, an average one) that changes less than the gap g
between them, ``dh = h' dg``. The pressure presses on the whole area, on the journal along its normal; the film pulls
either surface by ``-h/2 dp/dx``, and what the slopes leave, ``p (1 - h') dg/dx``, goes from solid to solid as contact
pressure does, without a torque on the journal about its own axis. That is the same sum with g for the gap,
``E_x = sum (carrier - g) (P_i - P_i+1) width``, the carrier being that of h. Then what sliding puts in is heat,
however closely the surfaces touch.

Symbols of `exudyn_ehd.film.loads`; cx, cz carriers and cx_h, cz_h their slopes to the film's gap on the link, H and HF
the film's gaps at vertices and links, slope and face_slope h' there.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import Directions
from exudyn_ehd.film.reynolds.gap import contract_pose

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def link_excess(carriers, H, HF, gap, link):
    """Carriers minus true gaps (2, n, m), of the links in theta and in z.

    ``carriers``: cx and cz, or None, where they are the film's gap. ``gap``, ``link``: the true gap at the vertices and
    on the links i -> i+1.
    """
    n, m = H.shape
    out = np.empty((2, n, m))
    for i in range(n):
        for j in range(m):
            out[0, i, j] = (HF[i, j] if carriers is None else carriers[0][i, j]) - link[i, j]
        for j in range(m - 1):
            carrier = 0.5 * (H[i, j] + H[i, j + 1]) if carriers is None else carriers[1][i, j]
            out[1, i, j] = carrier - 0.5 * (gap[i, j] + gap[i, j + 1])
    return out


@njit(cache=True, fastmath=_FAST)
def drag_sums(P, gaps, mesh):
    """(E_x, E_z) of the pressures P (n, m); ``gaps`` are the arguments of `link_excess`."""
    n, m = P.shape
    excess = link_excess(*gaps)
    width_x, width_z, link_x, link_z = mesh
    along = 0.0
    across = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        if link_x[i] != 0.0:
            for j in range(m):
                along += excess[0, i, j] * width_z[j] * (P[i, j] - P[nxt, j])
        wx = width_x[i]
        for j in range(m - 1):
            across += (wx if link_z[j] != 0.0 else 0.0) * excess[1, i, j] * (P[i, j] - P[i, j + 1])
    return along, across


@njit(cache=True, fastmath=_FAST)
def drag_rhs(order, count, active, gaps, mesh, rows):
    """Add the unknown pressures' weights in E_x and E_z to rows (2, count); nothing where the pressure is clipped."""
    n, m = active.shape
    excess = link_excess(*gaps)
    width_x, width_z, link_x, link_z = mesh
    along, across = np.empty((n, m)), np.empty((n, m))
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        own = 1.0 if link_x[i] != 0.0 else 0.0
        before = 1.0 if link_x[prv] != 0.0 else 0.0
        for j in range(m):
            along[i, j] = (own * excess[0, i, j] - before * excess[0, prv, j]) * width_z[j]
        last = 0.0
        for j in range(m - 1):
            link = (width_x[i] if link_z[j] != 0.0 else 0.0) * excess[1, i, j]
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
def drag_gap_slopes(P, cx_h, cz_h, slope, face_slope, mesh, face_out, cell_out):
    """Gradients (n, m) at fixed pressure to the true gap: of E_x on the links i -> i+1, of E_z at the vertices."""
    n, m = P.shape
    width_x, width_z, link_x, link_z = mesh
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            share = cx_h[i, j] * face_slope[i, j] - 1.0
            face_out[i, j] = linked * share * width_z[j] * (P[i, j] - P[nxt, j])
        half = 0.5 * width_x[i]
        carried = last = 0.0
        for j in range(m - 1):
            link = (half if link_z[j] != 0.0 else 0.0) * (P[i, j] - P[i, j + 1])
            carrier = link * cz_h[i, j]
            cell_out[i, j] = (carried + carrier) * slope[i, j] - (last + link)
            carried, last = carrier, link
        cell_out[i, m - 1] = carried * slope[i, m - 1] - last


@njit(cache=True)
def drag_pose_gradient(P, cx_h, cz_h, slope, face_slope, mesh, at, out):
    """Add the gradients of `drag_gap_slopes` to the scaled pose to out (2, >= 4): of E_x and of E_z."""
    face, cell = np.empty((1, *P.shape)), np.empty((1, *P.shape))
    drag_gap_slopes(P, cx_h, cz_h, slope, face_slope, mesh, face[0], cell[0])
    at = Directions(*at)
    contract_pose(face, at.cos_f, at.sin_f, at.z, out[:1])
    contract_pose(cell, at.cos_x, at.sin_x, at.z, out[1:])
