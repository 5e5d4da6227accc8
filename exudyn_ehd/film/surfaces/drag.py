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

Symbols of `exudyn_ehd.film.loads`. Values on links are (n, m); the last column of those in z, behind which there is
no link, counts for nothing.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def drag_weights(carriers, gap, link, widths):
    """Weights (2, n, m) of the pressures in E_x and E_z.

    ``carriers``: of the links in theta and in z; ``gap``, ``link``: true gaps at the vertices and on the links i ->
    i+1; ``widths`` (2, n, m): `FilmGrid.link_widths`.
    """
    n, m = gap.shape
    out = np.empty((2, n, m))
    along, across = carriers
    for i in range(n):
        last = 0.0
        for j in range(m):
            far = gap[i, j + 1] if j + 1 < m else gap[i, j]
            excess = (across[i, j] - 0.5 * (gap[i, j] + far)) * widths[1, i, j]
            before = (along[i - 1, j] - link[i - 1, j]) * widths[0, i - 1, j]
            out[0, i, j] = (along[i, j] - link[i, j]) * widths[0, i, j] - before
            out[1, i, j] = excess - last
            last = excess
    return out


@njit(cache=True, fastmath=_FAST)
def drag_by_gap(P, carrier_slopes, slope, face_slope, widths):
    """Gradients (n, m) at fixed pressure to the true gap: of E_x on the links i -> i+1, of E_z at the vertices.

    ``carrier_slopes``: of the carriers in theta and z to the film's gap there; ``slope``, ``face_slope``: h' at
    vertices and links; ``widths`` as in `drag_weights`.
    """
    n, m = P.shape
    face, cell = np.empty((n, m)), np.empty((n, m))
    along, across = carrier_slopes
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        carried = last = 0.0
        for j in range(m):
            face[i, j] = (along[i, j] * face_slope[i, j] - 1.0) * widths[0, i, j] * (P[i, j] - P[nxt, j])
            far = P[i, j + 1] if j + 1 < m else P[i, j]
            half = 0.5 * widths[1, i, j] * (P[i, j] - far)
            carrier = half * across[i, j]
            cell[i, j] = (carried + carrier) * slope[i, j] - (last + half)
            carried, last = carrier, half
    return face, cell
