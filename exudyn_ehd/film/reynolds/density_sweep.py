"""Derivatives of a compressible film's link flows; see `exudyn_ehd.film.reynolds.link_derivatives` for the plain film's.

Symbols: ``sigma = fill_upstream (rho_a + rho_b) / 2`` on the link a -> b, with the density ratio rho at the vertices.
"""

from __future__ import annotations

from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def link_factors(fill, rho, fx, fz, sigma_x_out, sigma_z_out):
    """sigma on the links in theta and z (0 behind the last row)."""
    n, m = rho.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            up = fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]
            sigma_x_out[i, j] = 0.5 * up * (rho[i, j] + rho[nxt, j])
        for j in range(m - 1):
            up = fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]
            sigma_z_out[i, j] = 0.5 * up * (rho[i, j] + rho[i, j + 1])
        sigma_z_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def carry_density(sigma_x, sigma_z, cx_h, cx, cz_h, cz, vx, vz, width_x, width_z, link_x, DX, DZ, SX, SZ):
    """Correct the Couette parts of a full film's link derivatives (see `exudyn_ehd.film.reynolds.link_derivatives`) for sigma on the links."""
    n, m = sigma_x.shape
    for i in range(n):
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            more = linked * width_z[j] * (sigma_x[i, j] - 1.0)
            DX[i, j] += more * vx * cx_h[i, j]
            SX[i, j] += more * cx[i, j]
        for j in range(m - 1):
            more = width_x[i] * (sigma_z[i, j] - 1.0)
            DZ[i, j] += more * vz * cz_h[i, j]
            SZ[i, j] += more * cz[i, j]


@njit(cache=True, fastmath=_FAST)
def dense_link_derivatives(P, rho, H, HF, vx, vz, flow_x, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ):
    """`sweep.plain_link_derivatives` of a film that is full everywhere, with the density's mean on the links."""
    n, m = H.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 0.5 if link_x[i] != 0.0 else 0.0
        lx = 3.0 * link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            h = HF[i, j]
            sigma = linked * (rho[i, j] + rho[nxt, j])
            DX[i, j] = (sigma * vx - lx * h * h * (P[nxt, j] - P[i, j])) * width_z[j]
            SX[i, j] = sigma * h * width_z[j]
        for j in range(m - 1):
            h = 0.5 * (H[i, j] + H[i, j + 1])
            sigma = 0.5 * (rho[i, j] + rho[i, j + 1])
            DZ[i, j] = (sigma * vz - 3.0 * h * h * link_z[j] * (P[i, j + 1] - P[i, j])) * wx
            SZ[i, j] = sigma * h * wx


@njit(cache=True, fastmath=_FAST)
def carry_density_plain(sigma_x, sigma_z, H, HF, vx, vz, width_x, width_z, link_x, DX, DZ, SX, SZ):
    """As `carry_density` for the plain film's carriers."""
    n, m = H.shape
    for i in range(n):
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            more = linked * width_z[j] * (sigma_x[i, j] - 1.0)
            DX[i, j] += more * vx
            SX[i, j] += more * HF[i, j]
        for j in range(m - 1):
            more = width_x[i] * (sigma_z[i, j] - 1.0)
            DZ[i, j] += more * vz
            SZ[i, j] += more * 0.5 * (H[i, j] + H[i, j + 1])
