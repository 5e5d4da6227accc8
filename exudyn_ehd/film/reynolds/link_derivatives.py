"""Derivatives of the links' flows to gap and speeds at fixed pressure.

Symbols: DX derivative of the flow of a link in theta to the gap that the link sees, DZ of the flow of one in z to the
gap at either of its ends; SX, SZ to its own mean speed, SZX of the flow in z to vx; all with metric. What a link a -> b
carries of a full film's Couette flow is ``sigma = fill_upstream (rho_a + rho_b) / 2`` with the density ratio rho.
"""

from __future__ import annotations

from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, inline="always")
def derivatives_of(d):
    """DX, DZ, SX, SZ, SZX of their array (5, n, m), see the module's docstring."""
    return d[0], d[1], d[2], d[3], d[4]


@njit(cache=True, fastmath=_FAST)
def _convected(fill, rho, couette, axis, i, j, p, q):
    """sigma of the link (i, j) -> (p, q) along ``axis``; arguments as for `link_derivatives`."""
    sigma = 1.0
    if rho is not None:
        sigma = 0.5 * (rho[i, j] + rho[p, q])
    if fill is not None:
        sigma *= fill[i, j] if couette[axis][i, j] >= 0.0 else fill[p, q]
    return sigma


@njit(cache=True, fastmath=_FAST)
def link_derivatives(P, H, HF, slopes, by_speed, fill, rho, couette, vx, vz, flow_x, mesh, out):
    """Derivatives of all links' flows, in loops of one result.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links i -> i+1.
    slopes, by_speed : tuples of (n, m) arrays or None
        `LinkFlux.slopes` and `LinkFlux.by_speed`; None: plain film, conductances that do not depend on the speed.
    fill, rho : (n, m) arrays or None
        None: a full film, density ratio 1.
    couette : (fx, fz) or None
        Couette fluxes in theta and z; only read where there is a fill.
    vx, vz, flow_x : float
        Scaled mean speeds; 0 drops the circumferential pressure flow.
    mesh : tuple of arrays
        `Mesh`.
    out : (5, n, m) array
        As for `derivatives_of`.
    """
    n, m = H.shape
    width_x, width_z, link_x, link_z = mesh
    DX, DZ, SX, SZ, SZX = derivatives_of(out)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        lx = link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            v = linked * vx * _convected(fill, rho, couette, 0, i, j, nxt, j)
            if slopes is None:
                h = HF[i, j]
                g_h = 3.0 * h * h
            else:
                v *= slopes[4][i, j]
                g_h = slopes[0][i, j]
            DX[i, j] = (v - g_h * (lx * (P[nxt, j] - P[i, j]))) * width_z[j]
        for j in range(m):
            carrier = HF[i, j] if slopes is None else slopes[2][i, j]
            SX[i, j] = linked * carrier * _convected(fill, rho, couette, 0, i, j, nxt, j) * width_z[j]
        for j in range(m - 1):
            v = vz * _convected(fill, rho, couette, 1, i, j, i, j + 1)
            if slopes is None:
                h = 0.5 * (H[i, j] + H[i, j + 1])
                g_h = 3.0 * h * h
            else:
                v *= slopes[5][i, j]
                g_h = slopes[1][i, j]
            DZ[i, j] = 0.5 * (v - g_h * (link_z[j] * (P[i, j + 1] - P[i, j]))) * wx
        for j in range(m - 1):
            carrier = 0.5 * (H[i, j] + H[i, j + 1]) if slopes is None else slopes[3][i, j]
            SZ[i, j] = carrier * _convected(fill, rho, couette, 1, i, j, i, j + 1) * wx
        if by_speed is not None:
            for j in range(m):
                SX[i, j] -= by_speed[0][i, j] * (lx * (P[nxt, j] - P[i, j])) * width_z[j]
            for j in range(m - 1):
                SZX[i, j] = -by_speed[1][i, j] * (link_z[j] * (P[i, j + 1] - P[i, j])) * wx


@njit(cache=True)
def add_cuts(P, H, HF, flow, slopes, by_speed, cuts, kx, kz, out):
    """Add to `link_derivatives` what links conduct more because they end at an edge.

    ``cuts`` (2, n, m): `FilmGrid.cuts`, which kx and kz (n, m) contain; ``flow``: `LinkFlux.flow`; the rest as there.
    """
    n, m = H.shape
    DX, DZ, SX, _, SZX = derivatives_of(out)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if cuts[0, i, j] != 1.0:
                more = kx[i, j] * (1.0 - 1.0 / cuts[0, i, j]) * (P[nxt, j] - P[i, j])
                DX[i, j] -= more * (3.0 / HF[i, j] if slopes is None else slopes[0][i, j] / flow[0][i, j])
                if by_speed is not None:
                    SX[i, j] -= more * by_speed[0][i, j] / flow[0][i, j]
        for j in range(m - 1):
            if cuts[1, i, j] != 1.0:
                more = kz[i, j] * (1.0 - 1.0 / cuts[1, i, j]) * (P[i, j + 1] - P[i, j])
                DZ[i, j] -= more * (
                    3.0 / (H[i, j] + H[i, j + 1]) if slopes is None else 0.5 * slopes[1][i, j] / flow[1][i, j]
                )
                if by_speed is not None:
                    SZX[i, j] -= more * by_speed[1][i, j] / flow[1][i, j]
