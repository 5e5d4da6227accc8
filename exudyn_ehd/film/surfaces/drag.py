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


def on_rows(gap: np.ndarray) -> np.ndarray:
    """Gap (n, m) of the links in z, the mean of both vertices."""
    return 0.5 * (gap + np.roll(gap, -1, axis=-1))


def onto_rows(values: np.ndarray) -> np.ndarray:
    """Transpose of `on_rows`: half of what stands on the links in z at either of their ends."""
    return 0.5 * (values + np.roll(values, 1, axis=-1))


def drops(P: np.ndarray) -> np.ndarray:
    """P less that of the next vertex in theta and z, (2, n, m)."""
    return np.array((P - np.roll(P, -1, axis=0), P - np.roll(P, -1, axis=1)))


def drop_weights(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Weights (..., n, m) of P in the sum of x and z times its `drops`; z is zero behind the last links."""
    return x - np.roll(x, 1, axis=-2) + z - np.roll(z, 1, axis=-1)


def link_widths(mesh: tuple[np.ndarray, ...]) -> np.ndarray:
    """Widths (2, n, m) of the links in theta and z; 0 where there is none."""
    width_x, width_z, link_x, link_z = mesh
    return np.array((np.outer(link_x != 0.0, width_z), np.outer(width_x, np.append(link_z != 0.0, False))))


def drag_sums(P: np.ndarray, excess: np.ndarray, mesh: tuple[np.ndarray, ...]) -> np.ndarray:
    """(E_x, E_z) of the pressures P (n, m); ``excess`` (2, n, m): carriers less true gaps on the links."""
    return np.sum(excess * drops(P) * link_widths(mesh), axis=(1, 2))


def drag_weights(excess: np.ndarray, mesh: tuple[np.ndarray, ...]) -> np.ndarray:
    """Weights (2, n, m) of the pressures in `drag_sums`."""
    (x, z), none = excess * link_widths(mesh), np.zeros(excess[0].shape)
    return np.array((drop_weights(x, none), drop_weights(none, z)))


def drag_by_gap(
    P: np.ndarray,
    carrier_slopes: tuple[np.ndarray, np.ndarray],
    slope: np.ndarray,
    face_slope: np.ndarray,
    mesh: tuple[np.ndarray, ...],
) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (n, m) at fixed pressure to the true gap: of E_x on the links i -> i+1, of E_z at the vertices.

    ``carrier_slopes``: of the carriers in theta and z to the film's gap there; ``slope``, ``face_slope``: h' at
    vertices and links.
    """
    x, z = drops(P) * link_widths(mesh)
    return x * (carrier_slopes[0] * face_slope - 1.0), onto_rows(z * carrier_slopes[1]) * slope - onto_rows(z)
