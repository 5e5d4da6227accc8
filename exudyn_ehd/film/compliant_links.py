"""Kernels of the flows between columns of an elastic liner, and their gradients; see `exudyn_ehd.film.compliant`.

A link with the gap h carries ``v f c(h) - g (P_b - P_a) / length``. Between columns that give way by different amounts, by 2 d more at b than
at a, the conductance is its mean over the linear course of the gap, ``H^3 + H d^2 = H^3 (1 + (d / H)^2)`` of a plain film; flow factors, shear
thinning and temperature multiply it as they are at the mean gap: ``g = G(h) (1 + (d / h)^2)``, G and the carrier c(h) from
`exudyn_ehd.film.flux`.

Symbols as in `exudyn_ehd.film.compliant_columns`; a, b ends of a link.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.flux import LinkFlux

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Links(NamedTuple):
    """Conductances and carriers of the links at their mean gap, (n, m) arrays as in `exudyn_ehd.film.flux.LinkFlux`.

    ``plain`` films have ``G = h^3`` and ``c = h``; their arrays are not read.
    """

    plain: bool
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


def links_of(flux: LinkFlux | None) -> Links:
    """The arrays of ``flux``; None: a plain film."""
    if flux is None:
        return Links(True, *(np.zeros((1, 1)) for _ in range(10)))
    return Links(
        False, flux.gx, flux.gx_h, flux.gx_v, flux.gz, flux.gz_h, flux.gz_v, flux.cx, flux.cx_h, flux.cz, flux.cz_h
    )


@njit(cache=True, inline="always")
def along(links, i, j, h, d):
    """(conductance, its derivatives to h and d, carrier, its derivative) of the link i -> i+1."""
    if links.plain:
        return h * (h * h + d * d), 3.0 * h * h + d * d, 2.0 * h * d, h, 1.0
    g, lean = links.gx[i, j], d / h
    bent = 1.0 + lean * lean
    return (
        g * bent,
        links.gx_h[i, j] * bent - 2.0 * g * lean * lean / h,
        2.0 * g * lean / h,
        links.cx[i, j],
        links.cx_h[i, j],
    )


@njit(cache=True, inline="always")
def across(links, i, j, h, d):
    """The same of the link j -> j+1."""
    if links.plain:
        return h * (h * h + d * d), 3.0 * h * h + d * d, 2.0 * h * d, h, 1.0
    g, lean = links.gz[i, j], d / h
    bent = 1.0 + lean * lean
    return (
        g * bent,
        links.gz_h[i, j] * bent - 2.0 * g * lean * lean / h,
        2.0 * g * lean / h,
        links.cz[i, j],
        links.cz_h[i, j],
    )


@njit(cache=True, fastmath=_FAST)
def compliant_residual(c, links, P, fill, gain, vx, vz, width_x, width_z, link_x, link_z, r_out):
    """Balance of every vertex: outflow - inflow + storage."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            r_out[i, j] = gain[i, j]
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            d = 0.5 * (c.E[nxt, j] - c.E[i, j])
            f = fill[i, j] if v >= 0.0 else fill[nxt, j]
            k, _, _, carrier, _ = along(links, i, j, c.HF[i, j], d)
            q = width_z[j] * (v * f * carrier - k * lx * (P[nxt, j] - P[i, j]))
            r_out[i, j] += q
            r_out[nxt, j] -= q
        for j in range(m - 1):
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
            k, _, _, carrier, _ = across(links, i, j, 0.5 * (c.H[i, j] + c.H[i, j + 1]), d)
            q = width_x[i] * (vz * f * carrier - k * link_z[j] * (P[i, j + 1] - P[i, j]))
            r_out[i, j] += q
            r_out[i, j + 1] -= q


@njit(cache=True)
def compliant_sensitivities(
    lam, c, links, P, fill, gain_r, gain_t, vx, vz, width_x, width_z, link_x, link_z, cell, face, rate, speed
):  # fmt: skip
    """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gap at vertices and links, its rate and the speeds.

    ``gain_r``, ``gain_t`` (n, m): derivatives of the storage to the undeformed gap and rate.
    """
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
            _, k_h, k_d, carrier, carrier_h = along(links, i, j, h, d)
            by_h = width_z[j] * c.link[i, j] * (v * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_z[j] * k_d * drop
            by_v = width_z[j] * linked * f * carrier
            if not links.plain:
                by_v -= width_z[j] * links.gx_v[i, j] * (1.0 + (d / h) ** 2) * drop
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
            _, k_h, k_d, carrier, carrier_h = across(links, i, j, h, d)
            by_h = 0.5 * width_x[i] * (vz * f * carrier_h - k_h * drop)
            by_d = 0.5 * width_x[i] * k_d * drop
            by_v = 0.0
            if not links.plain:
                by_v = -width_x[i] * links.gz_v[i, j] * (1.0 + (d / h) ** 2) * drop
            own = by_h * c.H_r[i, j] + by_d * c.E_r[i, j]
            other = by_h * c.H_r[i, j + 1] - by_d * c.E_r[i, j + 1]
            for k in range(count):
                out = lam[k, i, j + 1] - lam[k, i, j]
                cell[k, i, j] += out * own
                cell[k, i, j + 1] += out * other
                speed[k, 0] += out * by_v
                speed[k, 1] += out * width_x[i] * f * carrier


@njit(cache=True, fastmath=_FAST)
def compliant_coefficients(c, links, vx, vz, width_x, width_z, link_x, link_z, kx_out, kz_out, fx_out, fz_out, b_out):
    """Conductances and Couette fluxes of a full film in the deformed gap; ``b_out`` without storage."""
    n, m = c.H.shape
    b_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            k, _, _, carrier, _ = along(links, i, j, c.HF[i, j], 0.5 * (c.E[nxt, j] - c.E[i, j]))
            kx_out[i, j] = k * link_x[i] * width_z[j]
            fx_out[i, j] = v * carrier * width_z[j]
            b_out[i, j] -= fx_out[i, j]
            b_out[nxt, j] += fx_out[i, j]
        for j in range(m - 1):
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            k, _, _, carrier, _ = across(links, i, j, 0.5 * (c.H[i, j] + c.H[i, j + 1]), d)
            kz_out[i, j] = k * link_z[j] * width_x[i]
            fz_out[i, j] = vz * carrier * width_x[i]
            b_out[i, j] -= fz_out[i, j]
            b_out[i, j + 1] += fz_out[i, j]
        kz_out[i, m - 1] = 0.0
        fz_out[i, m - 1] = 0.0
