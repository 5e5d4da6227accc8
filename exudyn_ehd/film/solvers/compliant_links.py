"""Kernels of the flows between columns of an elastic liner, and their gradients; see `exudyn_ehd.film.solvers.compliant`.

A link with the gap h carries ``v f c(h) - g (P_b - P_a) / length``. Between columns that give way by different amounts, by 2 d more at b than
at a, the conductance is its mean over the linear course of the gap, ``H^3 + H d^2 = H^3 (1 + (d / H)^2)`` of a plain film; flow factors, shear
thinning and temperature multiply it as they are at the mean gap: ``g = G(h) (1 + (d / h)^2)``, G and the carrier c(h) from
`exudyn_ehd.film.reynolds.links`.

Symbols as in `exudyn_ehd.film.solvers.compliant_columns`; a, b ends of a link.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.film.solvers.compliant_columns import columns_of, gain_of_columns

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Links(NamedTuple):
    """Conductances and carriers of the links at their mean gap, (n, m) arrays as in `exudyn_ehd.film.reynolds.links.LinkFlux`."""

    gx: np.ndarray
    gx_h: np.ndarray
    gx_v: np.ndarray
    gz: np.ndarray
    gz_h: np.ndarray
    gz_v: np.ndarray
    cx: np.ndarray
    cx_h: np.ndarray
    cz: np.ndarray
    cz_h: np.ndarray


def links_of(flux: LinkFlux | None) -> Links | None:
    """The arrays of ``flux``; None for a plain film, ``G = h^3`` and ``c = h``."""
    if flux is None:
        return None
    return Links(flux.gx, flux.gx_h, flux.gx_v, flux.gz, flux.gz_h, flux.gz_v, flux.cx, flux.cx_h, flux.cz, flux.cz_h)


@njit(cache=True, fastmath=_FAST)
def along(links, i, j, h, d):
    """(conductance, carrier) of the link i -> i+1."""
    if links is None:
        return h * (h * h + d * d), h
    lean = d / h
    return links.gx[i, j] * (1.0 + lean * lean), links.cx[i, j]


@njit(cache=True, fastmath=_FAST)
def across(links, i, j, h, d):
    """(conductance, carrier) of the link j -> j+1."""
    if links is None:
        return h * (h * h + d * d), h
    lean = d / h
    return links.gz[i, j] * (1.0 + lean * lean), links.cz[i, j]


@njit(cache=True, fastmath=_FAST)
def along_slopes(links, i, j, h, d):
    """(derivatives of the conductance to h, d and the speed, of the carrier to h) of the link i -> i+1."""
    if links is None:
        return 3.0 * h * h + d * d, 2.0 * h * d, 0.0, 1.0
    g, lean = links.gx[i, j], d / h
    bent = 1.0 + lean * lean
    by_h = links.gx_h[i, j] * bent - 2.0 * g * lean * lean / h
    return by_h, 2.0 * g * lean / h, links.gx_v[i, j] * bent, links.cx_h[i, j]


@njit(cache=True, fastmath=_FAST)
def across_slopes(links, i, j, h, d):
    """(derivatives of the conductance to h, d and the speed, of the carrier to h) of the link j -> j+1."""
    if links is None:
        return 3.0 * h * h + d * d, 2.0 * h * d, 0.0, 1.0
    g, lean = links.gz[i, j], d / h
    bent = 1.0 + lean * lean
    by_h = links.gz_h[i, j] * bent - 2.0 * g * lean * lean / h
    return by_h, 2.0 * g * lean / h, links.gz_v[i, j] * bent, links.cz_h[i, j]


@njit(cache=True, fastmath=_FAST)
def compliant_residual(
    columns, links, P, load, fill, rigid_film, area, times, mass_old, extra_old, conserves, beta,
    vx, vz, width_x, width_z, link_x, link_z, fixed, pc, complementary, r_out,
):  # fmt: skip
    """Balance of every vertex, outflow - inflow + storage; returns the norm of those that do not hold.

    At pc oil may be drawn away if ``complementary``. Storage as in `compliant_columns.gain_of_columns`.
    """
    c = columns_of(columns)
    n, m = P.shape
    gain_of_columns(columns, P, load, fill, rigid_film, area, times, mass_old, extra_old, conserves, beta, r_out)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            k, carrier = along(links, i, j, c.HF[i, j], 0.5 * (c.E[nxt, j] - c.E[i, j]))
            f = fill[i, j] if v >= 0.0 else fill[nxt, j]
            q = width_z[j] * (v * f * carrier - k * lx * (P[nxt, j] - P[i, j]))
            r_out[i, j] += q
            r_out[nxt, j] -= q
        for j in range(m - 1):
            k, carrier = across(links, i, j, 0.5 * (c.H[i, j] + c.H[i, j + 1]), 0.5 * (c.E[i, j + 1] - c.E[i, j]))
            f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
            q = width_x[i] * (vz * f * carrier - k * link_z[j] * (P[i, j + 1] - P[i, j]))
            r_out[i, j] += q
            r_out[i, j + 1] -= q
    total = 0.0
    for i in range(n):
        for j in range(m):
            r = 0.0 if fixed[i, j] else r_out[i, j]
            if complementary and P[i, j] <= pc:
                r = min(r, 0.0)
            total += r * r
    return np.sqrt(total)


@njit(cache=True)
def compliant_sensitivities(
    lam, columns, links, P, fill, gain_r, gain_t, vx, vz, width_x, width_z, link_x, link_z, cell, face, rate, speed
):  # fmt: skip
    """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gap at vertices and links, its rate and the speeds.

    ``gain_r``, ``gain_t`` (n, m): derivatives of the storage to the undeformed gap and rate.
    """
    c = columns_of(columns)
    count, n, m = lam.shape
    for k in range(count):
        for i in range(n):
            for j in range(m):
                cell[k, i, j] = -lam[k, i, j] * gain_r[i, j]
                rate[k, i, j] = -lam[k, i, j] * gain_t[i, j]
        speed[k, 0] = speed[k, 1] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        linked = 1.0 if lx != 0.0 else 0.0
        v = vx * linked
        for j in range(m):
            h = c.HF[i, j]
            d = 0.5 * (c.E[nxt, j] - c.E[i, j])
            f = fill[i, j] if v >= 0.0 else fill[nxt, j]
            drop = lx * (P[nxt, j] - P[i, j])
            k_h, k_d, k_v, carrier_h = along_slopes(links, i, j, h, d)
            carrier = along(links, i, j, h, d)[1]
            by_h = width_z[j] * c.link[i, j] * (v * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_z[j] * k_d * drop
            by_v = width_z[j] * (linked * f * carrier - k_v * drop)
            own = 0.5 * by_h * c.D_r[i, j] + by_d * c.E_r[i, j]
            other = 0.5 * by_h * c.D_r[nxt, j] - by_d * c.E_r[nxt, j]
            for k in range(count):
                out = lam[k, nxt, j] - lam[k, i, j]
                face[k, i, j] = out * by_h
                cell[k, i, j] += out * own
                cell[k, nxt, j] += out * other
                speed[k, 0] += out * by_v
        for j in range(m - 1):
            h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
            drop = link_z[j] * (P[i, j + 1] - P[i, j])
            k_h, k_d, k_v, carrier_h = across_slopes(links, i, j, h, d)
            carrier = across(links, i, j, h, d)[1]
            by_h = 0.5 * width_x[i] * (vz * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_x[i] * k_d * drop
            by_v = -width_x[i] * k_v * drop
            own = by_h * c.H_r[i, j] + by_d * c.E_r[i, j]
            other = by_h * c.H_r[i, j + 1] - by_d * c.E_r[i, j + 1]
            for k in range(count):
                out = lam[k, i, j + 1] - lam[k, i, j]
                cell[k, i, j] += out * own
                cell[k, i, j + 1] += out * other
                speed[k, 0] += out * by_v
                speed[k, 1] += out * width_x[i] * f * carrier


@njit(cache=True, fastmath=_FAST)
def compliant_coefficients(
    columns, links, vx, vz, width_x, width_z, link_x, link_z, kx_out, kz_out, fx_out, fz_out, b_out
):
    """Conductances and Couette fluxes of a full film in the deformed gap; ``b_out`` without storage."""
    c = columns_of(columns)
    n, m = c.H.shape
    b_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            k, carrier = along(links, i, j, c.HF[i, j], 0.5 * (c.E[nxt, j] - c.E[i, j]))
            kx_out[i, j] = k * link_x[i] * width_z[j]
            fx_out[i, j] = v * carrier * width_z[j]
            b_out[i, j] -= fx_out[i, j]
            b_out[nxt, j] += fx_out[i, j]
        for j in range(m - 1):
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            k, carrier = across(links, i, j, 0.5 * (c.H[i, j] + c.H[i, j + 1]), d)
            kz_out[i, j] = k * link_z[j] * width_x[i]
            fz_out[i, j] = vz * carrier * width_x[i]
            b_out[i, j] -= fz_out[i, j]
            b_out[i, j + 1] += fz_out[i, j]
        kz_out[i, m - 1] = 0.0
        fz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def compliant_gradient(
    lam, columns, links, P, fill, gain_r, gain_t, vx, vz, width_x, width_z, link_x, link_z, cos_x, sin_x, cos_f, sin_f, z,
    gradient,
):  # fmt: skip
    """`compliant_sensitivities` contracted with the pose in one sweep: gradient (k, 10) to (scaled pose, scaled rates, vx, vz)."""
    c = columns_of(columns)
    count, n, m = lam.shape
    by = np.zeros((8, n, m))
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        linked = 1.0 if lx != 0.0 else 0.0
        v = vx * linked
        for j in range(m):
            h = c.HF[i, j]
            d = 0.5 * (c.E[nxt, j] - c.E[i, j])
            f = fill[i, j] if v >= 0.0 else fill[nxt, j]
            drop = lx * (P[nxt, j] - P[i, j])
            k_h, k_d, k_v, carrier_h = along_slopes(links, i, j, h, d)
            by_h = width_z[j] * c.link[i, j] * (v * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_z[j] * k_d * drop
            by[0, i, j] = by_h
            by[1, i, j] = 0.5 * by_h * c.D_r[i, j] + by_d * c.E_r[i, j]
            by[2, i, j] = 0.5 * by_h * c.D_r[nxt, j] - by_d * c.E_r[nxt, j]
            by[3, i, j] = width_z[j] * (linked * f * along(links, i, j, h, d)[1] - k_v * drop)
        for j in range(m - 1):
            h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
            drop = link_z[j] * (P[i, j + 1] - P[i, j])
            k_h, k_d, k_v, carrier_h = across_slopes(links, i, j, h, d)
            by_h = 0.5 * width_x[i] * (vz * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_x[i] * k_d * drop
            by[4, i, j] = by_h * c.H_r[i, j] + by_d * c.E_r[i, j]
            by[5, i, j] = by_h * c.H_r[i, j + 1] - by_d * c.E_r[i, j + 1]
            by[6, i, j] = -width_x[i] * k_v * drop
            by[7, i, j] = width_x[i] * f * across(links, i, j, h, d)[1]
    for k in range(count):
        g = gradient[k]
        g[:] = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            cell0 = cell1 = next0 = next1 = face0 = face1 = rate0 = rate1 = sx = sz = 0.0
            for j in range(m):
                own = lam[k, i, j]
                out = lam[k, nxt, j] - own
                cell = out * by[1, i, j] - own * gain_r[i, j]
                other = out * by[2, i, j]
                face = out * by[0, i, j]
                rate = own * gain_t[i, j]
                sx += out * by[3, i, j]
                cell0 += cell
                cell1 += cell * z[j]
                next0 += other
                next1 += other * z[j]
                face0 += face
                face1 += face * z[j]
                rate0 -= rate
                rate1 -= rate * z[j]
            for j in range(m - 1):
                out = lam[k, i, j + 1] - lam[k, i, j]
                a = out * by[4, i, j]
                b = out * by[5, i, j]
                cell0 += a + b
                cell1 += a * z[j] + b * z[j + 1]
                sx += out * by[6, i, j]
                sz += out * by[7, i, j]
            g[0] -= cell0 * cos_x[i] + next0 * cos_x[nxt] + face0 * cos_f[i]
            g[1] -= cell0 * sin_x[i] + next0 * sin_x[nxt] + face0 * sin_f[i]
            g[2] -= cell1 * cos_x[i] + next1 * cos_x[nxt] + face1 * cos_f[i]
            g[3] -= cell1 * sin_x[i] + next1 * sin_x[nxt] + face1 * sin_f[i]
            g[4] -= rate0 * cos_x[i]
            g[5] -= rate0 * sin_x[i]
            g[6] -= rate1 * cos_x[i]
            g[7] -= rate1 * sin_x[i]
            g[8] += sx
            g[9] += sz


@njit(cache=True, fastmath=_FAST)
def compliant_shear_row(columns, order, count, weight, active, full, ratio, ratio_P, ratio_h, row_out):
    """Weights of the Couette integral at the unknowns: by gap and viscosity at unknown pressures, by the fill elsewhere if ``full`` fills.

    ``ratio``, ``ratio_P``, ``ratio_h`` (n, m): viscosity over its reference, with its derivatives to unknown and gap.
    """
    c = columns_of(columns)
    m = weight.shape[1]
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        h = c.H[i, j]
        if active[i, j]:
            row_out[k] = weight[i, j] / h * ((ratio_h[i, j] - ratio[i, j] / h) * c.H_P[i, j] + ratio_P[i, j])
        else:
            row_out[k] = weight[i, j] / h * ratio[i, j] if full else 0.0
