"""Mass balance of a film and its derivatives, for every film whose gap or density follows the pressure.

The state of a film enters by its coefficients, `FilmTerms`. With the density ratios rho of a link's ends and the fill
of its upstream end, the terms of the balance are

    flow over the link a -> b    k (P_a - P_b) + f (prompt fill + late)_upstream (rho_a + rho_b) / 2,
    storage of a vertex          area (rho (grow fill + known) + kept).

The balance of a vertex is the sum of outflow and storage, less the inflow. ``prompt`` and ``late`` are 1 and 0, or
those of `exudyn_ehd.film.reynolds.links`. The derivatives to the unknowns (P where ``full``, else the fill) are stored
per link, as ``slopes`` for `banded.workspace`. The derivatives through the density are set here, those through the gap
in `exudyn_ehd.film.solvers.winkler_kernels`.

Derivatives of the links' flows to gaps and speeds at fixed pressure
--------------------------------------------------------------------
Symbols: a, b ends of a link, h its gap; ``up`` upstream fill times mean density; f Couette flow of a full film with the
carrier c(h), ``f = v width c``; E change of the film's gap at a vertex by an elastic liner, ``d = (E_b - E_a) / 2``.
The flow over a link is ``up f - k (P_b - P_a)`` with the conductance

    k = metric g(h) (1 + (d / h)^2),    g = h^3 and c = h of a plain film.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST, I0, I1


class FilmTerms(NamedTuple):
    """Coefficients of one film, (n, m) each.

    ``kx``, ``kz``, ``fx``, ``fz``: conductances and Couette fluxes of the links; ``grow``, ``known``, ``kept``:
    storage, see the module; ``area``: control volumes; ``prompt``, ``late``: fill of the flows out of a vertex, see the
    module; ``fixed``: vertices with prescribed pressure.
    """

    kx: np.ndarray
    kz: np.ndarray
    fx: np.ndarray
    fz: np.ndarray
    grow: np.ndarray
    known: np.ndarray
    kept: np.ndarray
    area: np.ndarray
    prompt: np.ndarray
    late: np.ndarray
    fixed: np.ndarray


@njit(cache=True, inline="always")
def terms_of(f, fixed):
    """Return `FilmTerms` of an array of fields (10, n, m)."""
    return FilmTerms(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9], fixed)


@njit(cache=True)
def store_content(f, H, H_t, inverse_step, mass_old, instant):
    """Set the storage of a film's terms (10, n, m) from its gaps and their rates (n, m).

    Parameters
    ----------
    inverse_step : float
        1 / time step since the content ``mass_old`` (n, m), 1/s; 0 for a steady film.
    instant : bool
        Whether the step is only a small number for the rates at an instant; the storage is then one of volume.
    """
    n, m = H.shape
    for i in range(n):
        for j in range(m):
            old = -inverse_step * mass_old[i, j] if inverse_step > 0.0 else 0.0
            f[4, i, j] = inverse_step * H[i, j] if inverse_step > 0.0 else H_t[i, j]
            f[5, i, j], f[6, i, j] = (old, 0.0) if instant else (0.0, old)


@njit(cache=True)
def oil_links(film, full):
    """Return links in theta (0: none), vertices with unknowns, and full or prescribed vertices, (n, m) each.

    Couette flow also links columns without pressure flow between them (short bearings).
    """
    links, free, sets = np.empty(full.shape), np.empty(full.shape, dtype=np.bool_), np.empty(full.shape, dtype=np.bool_)
    for i in range(full.shape[0]):
        for j in range(full.shape[1]):
            links[i, j] = abs(film.kx[i, j]) + abs(film.fx[i, j])
            free[i, j], sets[i, j] = not film.fixed[i, j], full[i, j] or film.fixed[i, j]
    return links, free, sets


@njit(cache=True)
def part(x, start, stop):
    """Return a part of a field, flat; None for None."""
    if x is None:
        return None
    return x.reshape(-1)[start:stop]


@njit(cache=True)
def flat(x):
    """Return a field, flat; None for None."""
    if x is None:
        return None
    return x.reshape(-1)


@njit(cache=True)
def carried_fill(fill, film):
    """Return the fill (n, m) of the Couette flows out of every vertex; None for None."""
    if fill is None:
        return None
    out = np.empty(fill.shape)
    x, now, prompt, late = out.reshape(-1), fill.reshape(-1), film.prompt.reshape(-1), film.late.reshape(-1)
    for c in range(x.size):
        x[c] = prompt[c] * now[c] + late[c]
    return out


@njit(cache=True)
def both(x, start, stop, there, end):
    """Return the parts of a field at both ends of links; None for None."""
    return part(x, start, stop), part(x, there, end)


@njit(cache=True, fastmath=FAST)
def _upstream(f, fill_a, fill_b, rho_a, rho_b, up):
    for c in range(up.size):
        if fill_a is not None:
            a, b = fill_a[c], fill_b[c]
            up[c] = a if f[c] >= 0.0 else b
        if rho_a is not None:
            up[c] *= 0.5 * (rho_a[c] + rho_b[c])


@njit(cache=True)
def upstream(fx, fz, fill, rho):
    """Return the upstream fill times the mean density (2, n m) of the Couette flows fx, fz, in theta and z.

    ``fill``: fill of the flows out of every vertex; ``rho``: density ratio; (n, m) each, or None if 1 everywhere.
    """
    m, size = fx.shape[1], fx.size
    last, e, up = size - m, size - 1, np.ones((2, size))
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        fills, densities = both(fill, start, stop, there, end), both(rho, start, stop, there, end)
        _upstream(part(fx, start, stop), *fills, *densities, up[0, start:stop])
    _upstream(part(fz, I0, e), *both(fill, I0, e, I1, size), *both(rho, I0, e, I1, size), up[1, :e])
    return up


@njit(cache=True, fastmath=FAST)
def _link_flows(k, f, P_a, P_b, up, out):
    for c in range(out.size):
        out[c] = k[c] * (P_a[c] - P_b[c]) + f[c] * up[c]


@njit(cache=True, fastmath=FAST)
def _gather_flows(area, grow, known, kept, fill, rho, across, across_in, along, along_in, out):
    """Set the balances, flat: outflow and storage less inflow."""
    for c in range(out.size):
        store = grow[c]
        if fill is not None:
            store *= fill[c]
        store += known[c]
        if rho is not None:
            store *= rho[c]
        out[c] = area[c] * (store + kept[c]) + across[c] - across_in[c] + along[c] - along_in[c]


@njit(cache=True)
def film_balance(P, fill, rho, film, out):
    """Set the balance of every vertex (n, m), outflow and storage less inflow: 0 at unknown vertices of a solution.

    ``fill``, ``rho``: None if they are 1 everywhere.
    """
    n, m = P.shape
    size = n * m
    last, e, p, q = size - m, size - 1, P.reshape(-1), out.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    up = upstream(film.fx, film.fz, carried_fill(fill, film), rho)
    along, across = np.empty(size + m), np.empty(size + 1)
    _link_flows(kx[:last], fx[:last], p[:last], p[m:], up[0, :last], along[m:size])
    _link_flows(kx[last:], fx[last:], p[last:], p[:m], up[0, last:], along[size:])
    for j in range(m):
        along[j] = along[size + j]
    # nothing flows over the last row's links in z
    _link_flows(kz[:e], fz[:e], p[:e], p[1:], up[1, :e], across[1:size])
    across[0] = across[size] = 0.0
    _gather_flows(
        film.area.reshape(-1),
        film.grow.reshape(-1),
        film.known.reshape(-1),
        film.kept.reshape(-1),
        flat(fill),
        flat(rho),
        across[1:],
        across[:size],
        along[m:],
        along[:size],
        q,
    )


@njit(cache=True, fastmath=FAST)
def violation(r, P, fixed, pc, complementary):
    """Return the norm of the residuals; if ``complementary``, positive ones at the cavity pressure pc are allowed."""
    leaves, x, known = r.reshape(-1), P.reshape(-1), fixed.reshape(-1)
    total = 0.0
    for c in range(x.size):
        v = 0.0 if known[c] else leaves[c]
        v = min(v, 0.0) if complementary & (x[c] <= pc) else v
        total += v * v
    return np.sqrt(total)


@njit(cache=True, fastmath=FAST)
def _link_slopes(k, f, step, fill, full, rho, rho_P, prompt, by_a, by_b):
    """Set the derivatives of the flows over the links a -> b, with b = a + ``step``, to the unknowns at both ends, at
    fixed gaps; ``fill``: fill of the flows out of every vertex."""
    size = k.size
    for a in range(size):
        b = a + step if a + step < size else a + step - size
        own, other, dense = k[a], -k[a], 1.0
        if rho is not None:
            dense, half = 0.5 * (rho[a] + rho[b]), 0.5 * f[a]
            if fill is not None:
                half *= fill[a] if half >= 0.0 else fill[b]
            own += half * rho_P[a]
            other += half * rho_P[b]
        if full is not None:
            own = own if full[a] else max(f[a], 0.0) * prompt[a] * dense
            other = other if full[b] else min(f[a], 0.0) * prompt[b] * dense
        by_a[a], by_b[a] = own, other


@njit(cache=True, fastmath=FAST)
def _storage_slopes(area, full, fill, rho, by, grow, known, out):
    """Set the derivatives of the storage to the unknowns at fixed gaps, flat."""
    for c in range(out.size):
        by_fill = area[c] * grow[c]
        slope = 0.0
        if rho is not None:
            content = by_fill
            if fill is not None:
                content *= fill[c]
            slope = by[c] * (content + area[c] * known[c])
            by_fill *= rho[c]
        if full is not None:
            slope = slope if full[c] else by_fill
        out[c] = slope


@njit(cache=True)
def film_slopes(fill, full, rho, rho_P, film, slopes):
    """Set the derivatives (5, n m) of flows and storage for `banded.workspace`, at fixed gaps.

    Unknowns are pressures where ``full``, else fills. ``fill`` and ``full`` are None for a film that is full
    everywhere, ``rho`` and ``rho_P`` for an incompressible one.
    """
    by = flat(carried_fill(fill, film)), flat(full), flat(rho), flat(rho_P), film.prompt.reshape(-1)
    _link_slopes(film.kx.reshape(-1), film.fx.reshape(-1), film.kx.shape[1], *by, slopes[0], slopes[1])
    # nothing flows over the last row's links
    _link_slopes(film.kz.reshape(-1), film.fz.reshape(-1), I1, *by, slopes[2], slopes[3])
    area, grow, known = film.area.reshape(-1), film.grow.reshape(-1), film.known.reshape(-1)
    _storage_slopes(area, flat(full), flat(fill), flat(rho), flat(rho_P), grow, known, slopes[4])


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
        Result of `upstream`.
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
