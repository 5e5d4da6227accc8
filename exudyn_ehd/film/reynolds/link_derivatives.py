"""Derivatives of the links' flows to gaps and speeds at fixed pressure.

Symbols: a, b ends of a link, h its gap; ``up`` the fill that the Couette flow takes along from upstream times the mean
density; f the Couette flow of a full film with the carrier c(h), ``f = v width c``; E what a liner adds to the film's
gap at a vertex, ``d = (E_b - E_a) / 2``. The flow over a link is ``up f - k (P_b - P_a)`` with the conductance

    k = metric g(h) (1 + (d / h)^2),    g = h^3 and c = h of a plain film.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.balance import both, part

_FAST = {"reassoc", "contract", "nsz", "arcp"}
# numpy's integers, since numba compiles kernels anew for each plain one
_0, _1 = np.int64(0), np.int64(1)


@njit(cache=True)
def _along(flux):
    """Return g, dg/dh, dg/dvx, c and dc/dh of the links in theta; None for a plain film."""
    if flux is None:
        return None, None, None, None, None
    return flux.gx, flux.gx_h, flux.gx_v, flux.cx, flux.cx_h


@njit(cache=True)
def _across(flux):
    """Return those of the links in z."""
    if flux is None:
        return None, None, None, None, None
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
def _add_couette_flow(v, width, c_h, up, by_h):
    """Add the derivative of the Couette flow to h."""
    for c in range(by_h.size):
        slope = v * width[c] * up[c]
        if c_h is not None:
            slope *= c_h[c]
        by_h[c] += slope


@njit(cache=True, fastmath=_FAST)
def _own_speed(width, carrier, h_a, h_b, up, by_own):
    """Set the derivative of the Couette flow to the link's own speed."""
    for c in range(by_own.size):
        flow = 0.5 * (h_a[c] + h_b[c])
        if carrier is not None:
            flow = carrier[c]
        by_own[c] = width[c] * flow * up[c]


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _other_speed(P_a, P_b, metric, h_a, h_b, E_a, E_b, g_v, by_vx):
    """Add the derivative of the pressure flow to vx."""
    if g_v is not None:
        for c in range(by_vx.size):
            lean = 0.0
            if E_a is not None:
                lean = (E_b[c] - E_a[c]) / (h_a[c] + h_b[c])
            by_vx[c] -= metric[c] * g_v[c] * (1.0 + lean * lean) * (P_b[c] - P_a[c])


@njit(cache=True)
def gap_derivatives(P, H, HF, E, up, flux, metric, vx, vz, by):
    """Set derivatives ``by`` (4, n m) of the links' flows to h and d, in theta, then in z.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links in theta.
    E : (n, m) array or None
        None: without a liner; the derivatives to d are not set.
    up : (2, n m) array
        Of `exudyn_ehd.film.reynolds.balance.upstream`.
    flux : LinkFlux or None
    metric : (4, n, m) array
        `exudyn_ehd.film.reynolds.links.link_metric`.
    vx, vz : float
        Scaled mean speeds.
    """
    m, size, p, h, h_x = P.shape[1], P.size, P.reshape(-1), H.reshape(-1), HF.reshape(-1)
    last, e, by_metric = size - m, size - 1, metric.reshape(4, size)
    g, g_h, _, _, c_h = _along(flux)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        at, law = h_x[start:stop], (part(g, start, stop), part(g_h, start, stop))
        leans, out = both(E, start, stop, there, end), (by[0, start:stop], by[1, start:stop])
        _pressure_flow(p[start:stop], p[there:end], by_metric[0, start:stop], at, at, *leans, *law, *out)
    _add_couette_flow(vx, by_metric[2], part(c_h, _0, size), up[0], by[0])
    g, g_h, _, _, c_h = _across(flux)
    law, leans = (part(g, _0, e), part(g_h, _0, e)), both(E, _0, e, _1, size)
    _pressure_flow(p[:e], p[1:], by_metric[1, :e], h[:e], h[1:], *leans, *law, by[2, :e], by[3, :e])
    _add_couette_flow(vz, by_metric[3], part(c_h, _0, size), up[1], by[2])
    # there are no links behind the last row
    by[2:, e] = 0.0


@njit(cache=True)
def speed_derivatives(P, H, HF, E, up, flux, metric, by):
    """Set derivatives ``by`` (3, n m) of the links' flows: in theta to vx, in z to vz and to vx; the rest as for
    `gap_derivatives`."""
    m, size, p, h, h_x = P.shape[1], P.size, P.reshape(-1), H.reshape(-1), HF.reshape(-1)
    last, e, by_metric = size - m, size - 1, metric.reshape(4, size)
    _, _, g_v, carrier, _ = _along(flux)
    _own_speed(by_metric[2], part(carrier, _0, size), h_x, h_x, up[0], by[0])
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        at, leans, slower = h_x[start:stop], both(E, start, stop, there, end), part(g_v, start, stop)
        _other_speed(p[start:stop], p[there:end], by_metric[0, start:stop], at, at, *leans, slower, by[0, start:stop])
    _, _, g_v, carrier, _ = _across(flux)
    _own_speed(by_metric[3, :e], part(carrier, _0, e), h[:e], h[1:], up[1, :e], by[1, :e])
    for c in range(size):
        by[2, c] = 0.0
    leans = both(E, _0, e, _1, size)
    _other_speed(p[:e], p[1:], by_metric[1, :e], h[:e], h[1:], *leans, part(g_v, _0, e), by[2, :e])
    by[1, e] = 0.0
