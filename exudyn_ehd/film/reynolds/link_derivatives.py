"""Derivatives of the links' flows to gaps and speeds at fixed pressure.

Symbols: a, b ends of a link, h its gap; ``up`` the fill that the Couette flow takes along from upstream times the mean
density; f the Couette flow of a full film with the carrier c(h), ``f = v width c``; E what a liner adds to the film's
gap at a vertex, ``d = (E_b - E_a) / 2``. The flow over a link is ``up f - k (P_b - P_a)`` with the conductance

    k = metric g(h) (1 + (d / h)^2),    g = h^3 and c = h of a plain film.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.balance import part, terms_of

_FAST = {"reassoc", "contract", "nsz", "arcp"}
# numpy's integers, since numba compiles kernels anew for each plain one
_0, _1 = np.int64(0), np.int64(1)


@njit(cache=True)
def _of_axis(flux, axis):
    """Return g, dg/dh, dg/dvx, c and dc/dh of the links in theta (0) or z (1), flat; None for a plain film."""
    if flux is None:
        return None, None, None, None, None
    if axis == 0:
        return flux.gx, flux.gx_h, flux.gx_v, flux.cx, flux.cx_h
    return flux.gz, flux.gz_h, flux.gz_v, flux.cz, flux.cz_h


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _pressure_flow(P_a, P_b, metric, h_a, h_b, E_a, E_b, g, g_h, by_h, by_d):
    """Set the derivatives of the pressure flow to h and d; loops of one result each, which the compiler vectorises."""
    for c in range(by_h.size):
        h = 0.5 * (h_a[c] + h_b[c])
        slope = 3.0 * h * h
        if g is not None:
            slope = g_h[c]
        if E_a is not None:
            lean = 0.5 * (E_b[c] - E_a[c]) / h
            square = h * h
            if g is not None:
                square = g[c] / h
            slope += (slope - 2.0 * square) * lean * lean
        by_h[c] = -metric[c] * (P_b[c] - P_a[c]) * slope
    if E_a is not None:
        for c in range(by_d.size):
            h = 0.5 * (h_a[c] + h_b[c])
            base = h
            if g is not None:
                base = g[c] / (h * h)
            by_d[c] = -metric[c] * (P_b[c] - P_a[c]) * base * (E_b[c] - E_a[c])


@njit(cache=True, fastmath=_FAST)
def _up(c, f, fill_a, fill_b, rho_a, rho_b):
    """Return ``up`` of the module for the link c."""
    up = 1.0
    if fill_a is not None:
        up = fill_a[c] if f[c] >= 0.0 else fill_b[c]
    if rho_a is not None:
        up *= 0.5 * (rho_a[c] + rho_b[c])
    return up


@njit(cache=True, fastmath=_FAST)
def _couette_flow(v, width, c_h, f, fill_a, fill_b, rho_a, rho_b, by_h):
    """Add the derivative of the Couette flow to h."""
    for c in range(by_h.size):
        slope = v * width[c] * _up(c, f, fill_a, fill_b, rho_a, rho_b)
        if c_h is not None:
            slope *= c_h[c]
        by_h[c] += slope


@njit(cache=True, fastmath=_FAST)
def _speed(P_a, P_b, metric, g_v, width, carrier, h_a, h_b, f, fill_a, fill_b, rho_a, rho_b, by_own, by_vx):
    """Set the derivatives to the link's own speed, and through the conductance to vx."""
    for c in range(by_own.size):
        carried = 0.5 * (h_a[c] + h_b[c])
        if carrier is not None:
            carried = carrier[c]
        by_own[c] = width[c] * carried * _up(c, f, fill_a, fill_b, rho_a, rho_b)
    for c in range(by_vx.size):
        by_vx[c] = 0.0
        if g_v is not None:
            by_vx[c] = -metric[c] * g_v[c] * (P_b[c] - P_a[c])


@njit(cache=True)
def gap_derivatives(P, H, HF, E, terms, fixed, fill, rho, flux, metric, vx, vz, by):
    """Set derivatives ``by`` (4, n m) of the links' flows to h and d, in theta, then in z.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links in theta.
    E : (n, m) array or None
        None: without a liner; the derivatives to d are not set.
    terms, fixed
        Fields of a `FilmTerms`.
    fill, rho : (n, m) arrays or None
        What flows carry, and the density ratio; None: one everywhere.
    flux : LinkFlux or None
    metric : (4, n, m) array
        `exudyn_ehd.film.reynolds.links.link_metric`.
    vx, vz : float
        Scaled mean speeds.
    """
    n, m = P.shape
    film, size = terms_of(terms, fixed), n * m
    last, e = size - m, size - 1
    p, h, h_x, by_metric = P.reshape(-1), H.reshape(-1), HF.reshape(-1), metric.reshape(4, size)
    fx, fz = film.fx.reshape(-1), film.fz.reshape(-1)
    g, g_h, _, _, c_h = _of_axis(flux, 0)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        at, over = h_x[start:stop], by_metric[0, start:stop]
        _pressure_flow(
            p[start:stop], p[there:end], over, at, at, part(E, start, stop), part(E, there, end),
            part(g, start, stop), part(g_h, start, stop), by[0, start:stop], by[1, start:stop],
        )  # fmt: skip
        _couette_flow(
            vx, by_metric[2, start:stop], part(c_h, start, stop), fx[start:stop], part(fill, start, stop),
            part(fill, there, end), part(rho, start, stop), part(rho, there, end), by[0, start:stop],
        )  # fmt: skip
    g, g_h, _, _, c_h = _of_axis(flux, 1)
    _pressure_flow(
        p[:e], p[1:], by_metric[1, :e], h[:e], h[1:], part(E, _0, e), part(E, _1, size), part(g, _0, e),
        part(g_h, _0, e), by[2, :e], by[3, :e],
    )  # fmt: skip
    _couette_flow(
        vz, by_metric[3, :e], part(c_h, _0, e), fz[:e], part(fill, _0, e), part(fill, _1, size), part(rho, _0, e),
        part(rho, _1, size), by[2, :e],
    )  # fmt: skip
    # there are no links behind the last row
    by[2:, e] = 0.0


@njit(cache=True)
def speed_derivatives(P, H, HF, terms, fixed, fill, rho, flux, metric, by):
    """Set derivatives ``by`` (4, n m) of the links' flows: in theta to vx, in z to vz and vx, one row for use here; the
    rest as for `gap_derivatives`."""
    n, m = P.shape
    film, size = terms_of(terms, fixed), n * m
    last, e = size - m, size - 1
    p, h, h_x, by_metric = P.reshape(-1), H.reshape(-1), HF.reshape(-1), metric.reshape(4, size)
    fx, fz = film.fx.reshape(-1), film.fz.reshape(-1)
    _, _, g_v, carrier, _ = _of_axis(flux, 0)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        at = h_x[start:stop]
        _speed(
            p[start:stop], p[there:end], by_metric[0, start:stop], part(g_v, start, stop), by_metric[2, start:stop],
            part(carrier, start, stop), at, at, fx[start:stop], part(fill, start, stop), part(fill, there, end),
            part(rho, start, stop), part(rho, there, end), by[0, start:stop], by[3, start:stop],
        )  # fmt: skip
    for c in range(size):
        by[0, c] += by[3, c]
    _, _, g_v, carrier, _ = _of_axis(flux, 1)
    _speed(
        p[:e], p[1:], by_metric[1, :e], part(g_v, _0, e), by_metric[3, :e], part(carrier, _0, e), h[:e], h[1:], fz[:e],
        part(fill, _0, e), part(fill, _1, size), part(rho, _0, e), part(rho, _1, size), by[1, :e], by[2, :e],
    )  # fmt: skip
    by[1:3, e] = 0.0
