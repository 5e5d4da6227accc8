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

from exudyn_ehd.compilation import FAST, I0, I1, U0, U1, unsigned


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
def next_values(x, step):
    """Return the values of a flat field at the vertices ``step`` on, those behind the last one at the first ones."""
    return np.concatenate((x[step:], x[:step]))


@njit(cache=True)
def _next_or_none(x, step):
    """Return `next_values`; None for None."""
    if x is None:
        return None
    return next_values(x, step)


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
    up = np.ones((2, fx.size))
    a, b = flat(fill), flat(rho)
    for f, step, out in ((fx, fx.shape[1], up[0]), (fz, I1, up[1])):
        _upstream(f.reshape(-1), a, _next_or_none(a, step), b, _next_or_none(b, step), out)
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
    m, size, p = P.shape[1], P.size, P.reshape(-1)
    up, along, across = upstream(film.fx, film.fz, carried_fill(fill, film), rho), np.empty(size), np.empty(size)
    _link_flows(film.kx.reshape(-1), film.fx.reshape(-1), p, next_values(p, m), up[0], along)
    # nothing flows over the last row's links in z
    _link_flows(film.kz.reshape(-1), film.fz.reshape(-1), p, next_values(p, I1), up[1], across)
    area, grow, known, kept = (
        film.area.reshape(-1),
        film.grow.reshape(-1),
        film.known.reshape(-1),
        film.kept.reshape(-1),
    )
    flows = across, next_values(across, size - 1), along, next_values(along, size - m)
    _gather_flows(area, grow, known, kept, flat(fill), flat(rho), *flows, out.reshape(-1))


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
def _derive_links(axis, p, p_on, h_a, h_b, E, E_on, laws, up, metric, v, by, by_speed):
    """Set the results of `link_derivatives` for the links along one axis, flat; the flow's derivative to vx through the
    conductance is added."""
    by_h, by_d, by_own, by_vx = by[2 * axis], by[2 * axis + 1], by_speed[axis], by_speed[2 * axis]
    if laws is not None:
        g, g_h, g_v = laws[axis][0].reshape(-1), laws[axis][1].reshape(-1), laws[axis][2].reshape(-1)
        carriers, carriers_h = laws[axis][3].reshape(-1), laws[axis][4].reshape(-1)
    for c in range(p.size):
        h, drop, moved = 0.5 * (h_a[c] + h_b[c]), metric[axis, c] * (p[c] - p_on[c]), metric[axis + 2, c] * up[axis, c]
        slope, square, carrier, carrier_h, half_ratio = 3.0 * h * h, h * h, h, 1.0, 0.0
        if laws is not None:
            slope, square, carrier, carrier_h = g_h[c], g[c] / h, carriers[c], carriers_h[c]
        if E is not None:
            half_ratio = 0.5 * (E_on[c] - E[c]) / h
            slope += (slope - 2.0 * square) * half_ratio * half_ratio
            by_d[c] = 2.0 * drop * square * half_ratio
        by_h[c] = drop * slope + v * moved * carrier_h
        by_own[c] = moved * carrier
        if laws is not None:
            by_vx[c] += drop * g_v[c] * (1.0 + half_ratio * half_ratio)


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
    m, p, h, h_x, width = P.shape[1], P.reshape(-1), H.reshape(-1), HF.reshape(-1), metric.reshape(4, P.size)
    by_speed[2] = 0.0
    out = by, by_speed
    E, h_on = flat(E), next_values(h, I1)
    _derive_links(I0, p, next_values(p, m), h_x, h_x, E, _next_or_none(E, m), laws, up, width, vx, *out)
    _derive_links(I1, p, next_values(p, I1), h, h_on, E, _next_or_none(E, I1), laws, up, width, vz, *out)


@njit(cache=True, fastmath=FAST)
def right_hand_side(fx, fz, squeeze, H_t, area, b_out):
    """Set b: net Couette inflow of every control volume, less the storage ``dH/dt area`` if ``squeeze``."""
    n, m = fx.shape
    for i in range(n):
        for j in range(m):
            # nothing flows over the last row's links in z
            b_out[i, j] = fx[i - 1, j] - fx[i, j] + fz[i, j - 1] - fz[i, j]
            if squeeze:
                b_out[i, j] -= H_t[i, j] * area[i, j]


@njit(cache=True, fastmath=FAST)
def linear_residual(links, p, out):
    """Set the residual ``b - A P`` (n, m) in ``out``, for links (kx, kz, b) and pressures p.

    At fixed vertices it is minus the flow that they feed into the film.
    """
    kx, kz, b = links[0].reshape(-1), links[1].reshape(-1), links[2].reshape(-1)
    x, residual, m, size = p.reshape(-1), out.reshape(-1), unsigned(p.shape[1]), unsigned(p.size)
    last = size - m
    for c in range(m):
        # nothing flows over the last row's links
        before, far = (c if c > U0 else size) - U1, last + c
        residual[c] = b[c] - kx[c] * (x[c] - x[c + m]) + kx[far] * (x[far] - x[c])
        residual[c] += kz[before] * (x[before] - x[c]) - kz[c] * (x[c] - x[c + U1])
    for c in range(m, last):
        taken = kx[c] * (x[c] - x[c + m]) - kx[c - m] * (x[c - m] - x[c])
        residual[c] = b[c] - taken - kz[c] * (x[c] - x[c + U1]) + kz[c - U1] * (x[c - U1] - x[c])
    for c in range(last, size):
        on, far = c + U1 if c + U1 < size else U0, c - last
        residual[c] = b[c] - kx[c] * (x[c] - x[far]) + kx[c - m] * (x[c - m] - x[c])
        residual[c] += kz[c - U1] * (x[c - U1] - x[c]) - kz[c] * (x[c] - x[on])
