"""Derivatives of the links' flows to gaps and speeds at fixed pressure.

Symbols: a, b ends of a link, h its gap; ``up`` upstream fill times mean density; f Couette flow of a full film with the
carrier c(h), ``f = v width c``; E change of the film's gap at a vertex by an elastic liner, ``d = (E_b - E_a) / 2``.
The flow over a link is ``up f - k (P_b - P_a)`` with the conductance

    k = metric g(h) (1 + (d / h)^2),    g = h^3 and c = h of a plain film.
"""

from __future__ import annotations

from numba import njit

from exudyn_ehd.film.kernels import FAST, I0, I1
from exudyn_ehd.film.reynolds.balance import flat, part


@njit(cache=True, fastmath=FAST, error_model="numpy")
def _pressure_flow(P_a, P_b, metric, h_a, h_b, E_a, E_b, g, g_h, by_h, by_d):
    """Set the derivatives of the pressure flow to h and d. Each loop has one result, so that it is vectorised."""
    for c in range(by_h.size):
        h = 0.5 * (h_a[c] + h_b[c])
        slope = 3.0 * h * h
        if g is not None:
            slope = g_h[c]
        if E_a is not None:
            half_ratio = 0.5 * (E_b[c] - E_a[c]) / h
            square = h * h
            if g is not None:
                square = g[c] / h
            slope += (slope - 2.0 * square) * half_ratio * half_ratio
        by_h[c] = -metric[c] * (P_b[c] - P_a[c]) * slope
    if E_a is not None:
        for c in range(by_d.size):
            h = 0.5 * (h_a[c] + h_b[c])
            base = h
            if g is not None:
                base = g[c] / (h * h)
            by_d[c] = -metric[c] * (P_b[c] - P_a[c]) * base * (E_b[c] - E_a[c])


@njit(cache=True, fastmath=FAST)
def _couette_flow(v, width, carrier, c_h, h_a, h_b, up, by_h, by_own):
    """Add the derivative of the Couette flow to h, and set its derivative to the speed along the link."""
    for c in range(by_h.size):
        slope = v * width[c] * up[c]
        if c_h is not None:
            slope *= c_h[c]
        by_h[c] += slope
    for c in range(by_own.size):
        flow = 0.5 * (h_a[c] + h_b[c])
        if carrier is not None:
            flow = carrier[c]
        by_own[c] = width[c] * flow * up[c]


@njit(cache=True, fastmath=FAST, error_model="numpy")
def _pressure_flow_by_speed(P_a, P_b, metric, h_a, h_b, E_a, E_b, g_v, by_vx):
    """Add the derivative of the pressure flow to vx."""
    for c in range(by_vx.size):
        half_ratio = 0.0
        if E_a is not None:
            half_ratio = (E_b[c] - E_a[c]) / (h_a[c] + h_b[c])
        by_vx[c] -= metric[c] * g_v[c] * (1.0 + half_ratio * half_ratio) * (P_b[c] - P_a[c])


@njit(cache=True)
def link_derivatives(P, H, HF, E, up, laws, metric, vx, vz, by, by_speed):
    """Set the derivatives of the links' flows.

    Parameters
    ----------
    P, H, HF : (n, m) arrays
        Pressure, gaps at vertices and on the links in theta.
    E : (n, m) array or None
        Change of the gap by a liner; None: no liner, the derivatives to d are not set.
    up : (2, n m) array
        Result of `exudyn_ehd.film.reynolds.balance.upstream`.
    laws : twice five (n, m) arrays, or None
        `LinkFlux.laws`; None: a plain film.
    metric : (4, n, m) array
        `exudyn_ehd.film.reynolds.links.link_metric`.
    vx, vz : float
        Scaled mean speeds.
    by : (4, n m) array
        Derivatives to h and d, of the links in theta, then of those in z.
    by_speed : (3, n m) array
        Derivatives of the links in theta to vx, and of those in z to vz and to vx.
    """
    m, size, p, h, h_x = P.shape[1], P.size, P.reshape(-1), H.reshape(-1), HF.reshape(-1)
    last, e, width = size - m, size - 1, metric.reshape(4, size)
    if laws is None:
        g_x = g_x_h = c_x = c_x_h = g_z = g_z_h = c_z = c_z_h = None
    else:
        (g_x, g_x_h, g_x_v, c_x, c_x_h), (g_z, g_z_h, g_z_v, c_z, c_z_h) = laws
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        at, law = h_x[start:stop], (part(g_x, start, stop), part(g_x_h, start, stop))
        deflections, out = (part(E, start, stop), part(E, there, end)), (by[0, start:stop], by[1, start:stop])
        _pressure_flow(p[start:stop], p[there:end], width[0, start:stop], at, at, *deflections, *law, *out)
    _couette_flow(vx, width[2], flat(c_x), flat(c_x_h), h_x, h_x, up[0], by[0], by_speed[0])
    law, deflections = (part(g_z, I0, e), part(g_z_h, I0, e)), (part(E, I0, e), part(E, I1, size))
    _pressure_flow(p[:e], p[1:], width[1, :e], h[:e], h[1:], *deflections, *law, by[2, :e], by[3, :e])
    law, out = (part(c_z, I0, e), part(c_z_h, I0, e)), (by[2, :e], by_speed[1, :e])
    _couette_flow(vz, width[3, :e], *law, h[:e], h[1:], up[1, :e], *out)
    for c in range(size):
        by_speed[2, c] = 0.0
    if laws is not None:
        for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
            at, deflections = h_x[start:stop], (part(E, start, stop), part(E, there, end))
            by_v, out = part(g_x_v, start, stop), by_speed[0, start:stop]
            _pressure_flow_by_speed(p[start:stop], p[there:end], width[0, start:stop], at, at, *deflections, by_v, out)
        deflections = part(E, I0, e), part(E, I1, size)
        _pressure_flow_by_speed(
            p[:e], p[1:], width[1, :e], h[:e], h[1:], *deflections, part(g_z_v, I0, e), by_speed[2, :e]
        )
    # there are no links behind the last row
    by[2, e] = by[3, e] = by_speed[1, e] = 0.0
