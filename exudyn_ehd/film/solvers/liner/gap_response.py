"""Derivatives of the flows over links whose gaps follow the pressure, for Newton's matrix and for gradients.

Symbols of `exudyn_ehd.film.solvers.liner.elements`; a, b ends of a link, h its gap, d half the difference of E, up its
upstream fill times its mean density. The flow over a link is ``up f - k (P_b - P_a)``, with a Couette flux f(h) and the
conductance ``k = g(h) (1 + (d / h)^2)`` with its metric.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.gradients import link_rows
from exudyn_ehd.film.reynolds.balance import part, terms_of
from exudyn_ehd.film.solvers.liner.elements import combine, gaps_of, slopes_of

_FAST = {"reassoc", "contract", "nsz", "arcp"}
# numpy's integers, since numba compiles kernels anew for each plain one
_0, _1 = np.int64(0), np.int64(1)


@njit(cache=True)
def of_axis(links, axis):
    """Return conductance, its slope and the carrier's slope of the links in theta (0) or z (1), flat; None for a plain
    film."""
    if links is None:
        return None, None, None
    if axis == 0:
        return links.gx.reshape(-1), links.gx_h.reshape(-1), links.cx_h.reshape(-1)
    return links.gz.reshape(-1), links.gz_h.reshape(-1), links.cz_h.reshape(-1)


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _conductance_gradients(P_a, P_b, k, mean, lean, g, g_h, by_h, by_d):
    """Set the derivatives ``by_h``, ``by_d`` of the pressure flow over links to h (``mean``) and d (``lean``)."""
    for c in range(by_d.size):
        by_d[c] = -2.0 * k[c] * (P_b[c] - P_a[c]) * lean[c] / (mean[c] * mean[c] + lean[c] * lean[c])
    if g is None:
        for c in range(by_h.size):
            by_h[c] = (-3.0 * k[c] * (P_b[c] - P_a[c]) - by_d[c] * lean[c]) / mean[c]
    else:
        for c in range(by_h.size):
            by_h[c] = -k[c] * (P_b[c] - P_a[c]) * (g_h[c] / g[c]) - by_d[c] * lean[c] / mean[c]


@njit(cache=True, fastmath=_FAST)
def _add_carriers(f, v, linked, carrier_h, fill_a, fill_b, rho_a, rho_b, by_h):
    """Add the derivative of the Couette flow to h."""
    for c in range(f.size):
        up = v * linked[c]
        if carrier_h is not None:
            up *= carrier_h[c]
        if fill_a is not None:
            up *= fill_a[c] if f[c] >= 0.0 else fill_b[c]
        if rho_a is not None:
            up *= 0.5 * (rho_a[c] + rho_b[c])
        by_h[c] += up


@njit(cache=True)
def link_gradients(P, fill, rho, terms, fixed, gap_fields, links, metric, vx, vz, by):
    """Set ``by`` (4, n m): derivatives of the flows over links to h and d, in theta, then in z.

    ``links``: `LinkFlux`, or None for a plain film; ``metric`` as in `elements.plain_links`.
    """
    n, m = P.shape
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    size = n * m
    last, e = size - m, size - 1
    p, H, HF, E = P.reshape(-1), gaps.H.reshape(-1), gaps.HF.reshape(-1), gaps.E.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    wide, deep = metric[2].reshape(-1), metric[3].reshape(-1)
    lean, mean = np.empty(size), np.empty(size)
    g, g_h, c_h = of_axis(links, 0)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        combine(E[start:stop], -0.5, E[there:end], 0.5, lean[start:stop])
        _conductance_gradients(
            p[start:stop], p[there:end], kx[start:stop], HF[start:stop], lean[start:stop], part(g, start, stop),
            part(g_h, start, stop), by[0, start:stop], by[1, start:stop],
        )  # fmt: skip
        _add_carriers(
            fx[start:stop],
            vx,
            wide[start:stop],
            part(c_h, start, stop),
            part(fill, start, stop),
            part(fill, there, end),
            part(rho, start, stop),
            part(rho, there, end),
            by[0, start:stop],
        )
    combine(E[:e], -0.5, E[1:], 0.5, lean[:e])
    combine(H[:e], 0.5, H[1:], 0.5, mean[:e])
    g, g_h, c_h = of_axis(links, 1)
    _conductance_gradients(
        p[:e], p[1:], kz[:e], mean[:e], lean[:e], part(g, _0, e), part(g_h, _0, e), by[2, :e], by[3, :e]
    )
    _add_carriers(
        fz[:e],
        vz,
        deep[:e],
        part(c_h, _0, e),
        part(fill, _0, e),
        part(fill, _1, size),
        part(rho, _0, e),
        part(rho, _1, size),
        by[2, :e],
    )
    by[2:, e] = 0.0


@njit(cache=True, fastmath=_FAST)
def speed_gradients(P, fill, rho, terms, fixed, gap_fields, links, metric, by):
    """Set ``by`` (3, n, m): derivatives of the flows over links in theta to vx, and in z to vx and to vz. Other
    parameters as for `link_gradients`."""
    n, m = P.shape
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            carrier = gaps.HF[i, j]
            slower = 0.0
            if links is not None:
                carrier = links.cx[i, j]
                slower = links.gx_v[i, j] / links.gx[i, j] * film.kx[i, j] * (P[nxt, j] - P[i, j])
            if fill is not None:
                carrier *= fill[i, j] if film.fx[i, j] >= 0.0 else fill[nxt, j]
            if rho is not None:
                carrier *= 0.5 * (rho[i, j] + rho[nxt, j])
            by[0, i, j] = metric[2, i, j] * carrier - slower
        for j in range(m - 1):
            carrier = 0.5 * (gaps.H[i, j] + gaps.H[i, j + 1])
            slower = 0.0
            if links is not None:
                carrier = links.cz[i, j]
                slower = links.gz_v[i, j] / links.gz[i, j] * film.kz[i, j] * (P[i, j + 1] - P[i, j])
            if fill is not None:
                carrier *= fill[i, j] if film.fz[i, j] >= 0.0 else fill[i, j + 1]
            if rho is not None:
                carrier *= 0.5 * (rho[i, j] + rho[i, j + 1])
            by[1, i, j] = -slower
            by[2, i, j] = metric[3, i, j] * carrier
        by[1:, i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def _add_end(by_h, by_d, side, steep, lean, full, out):
    """Add the derivative of a link's flow to the unknown at its end b (``side`` 1) or a (-1), through the gap there."""
    for c in range(out.size):
        slope = 0.5 * (by_h[c] * steep[c] + side * by_d[c] * lean[c])
        if full is not None:
            slope = slope if full[c] else 0.0
        out[c] += slope


@njit(cache=True, fastmath=_FAST)
def _product(a, b, out):
    for c in range(out.size):
        out[c] = a[c] * b[c]


@njit(cache=True, fastmath=_FAST)
def _add_storage(area, fill, full, rho, H_P, rate_P, rates, out):
    """Add the derivative of the storage to the unknowns, through the gap."""
    for c in range(out.size):
        by = rate_P[c]
        if fill is not None:
            by = fill[c] * (by * rates.own + H_P[c] * (rates.mass + rates.pseudo))
        if rho is not None:
            by *= rho[c]
        if full is not None:
            by = by if full[c] else 0.0
        out[c] += area[c] * by


@njit(cache=True, fastmath=_FAST)
def _add_pseudo(area, P, drive, slope, factor, out):
    """Add the derivative of pseudo time's storage, for a film that does not conserve mass."""
    for c in range(out.size):
        out[c] += area[c] * factor * (slope[c] if P[c] == drive[c] else 1.0)


@njit(cache=True)
def add_gap_slopes(P, fill, full, rho, film, gap_slopes, load, rates, beta, by, slopes):
    """Add the derivatives of flows and storage through the gap to ``slopes`` of `balance.film_slopes`; ``by``: that of
    `link_gradients`."""
    n, m = P.shape
    size = n * m
    last, e = size - m, size - 1
    D, H, link, area = (
        gap_slopes.D_P.reshape(-1),
        gap_slopes.H_P.reshape(-1),
        gap_slopes.link.reshape(-1),
        film.area.reshape(-1),
    )
    face = np.empty(size)
    _product(by[0], link, face)
    for start, stop, there, end in ((0, last, m, size), (last, size, 0, m)):
        h, d = face[start:stop], by[1, start:stop]
        _add_end(h, d, -1.0, D[start:stop], H[start:stop], part(full, start, stop), slopes[0, start:stop])
        _add_end(h, d, 1.0, D[there:end], H[there:end], part(full, there, end), slopes[1, start:stop])
    h, d = by[2, :e], by[3, :e]
    _add_end(h, d, -1.0, H[:e], H[:e], part(full, _0, e), slopes[2, :e])
    _add_end(h, d, 1.0, H[1:], H[1:], part(full, _1, size), slopes[3, :e])
    _add_storage(
        area,
        part(fill, _0, size),
        part(full, _0, size),
        part(rho, _0, size),
        H,
        gap_slopes.rate_P.reshape(-1),
        rates,
        slopes[4],
    )
    if fill is None and rates.pseudo != 0.0:
        _add_pseudo(area, P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1), rates.pseudo * beta, slopes[4])


@njit(cache=True, fastmath=_FAST)
def _end_gain(by_h, by_d, side, yields, bends, out):
    """Set the derivative of a link's flow to the undeformed gap at its end b (``side`` 1) or a (-1)."""
    for c in range(out.size):
        out[c] = 0.5 * (by_h[c] * yields[c] + side * by_d[c] * bends[c])


@njit(cache=True, fastmath=_FAST)
def gap_rows(order, count, by, by_v, slope_fields, gain_t, gain_r, out):
    """Set the derivatives (10, count) of the balances at ``order`` to undeformed gaps, see `Gradients.by`.

    ``by`` (4, n m): that of `link_gradients`; ``by_v`` (3, n, m): of `speed_gradients`; ``gain_t``, ``gain_r`` (n, m):
    derivatives of the storage to the undeformed rate and gap.
    """
    _, n, m = by_v.shape
    size, gap_slopes = n * m, slopes_of(slope_fields.reshape(9, n * m))
    last, e = size - m, size - 1
    D, E, H = gap_slopes.D_r, gap_slopes.E_r, gap_slopes.H_r
    face, one, two, low, high = np.empty(size), np.empty(size), np.empty(size), np.empty(size), np.empty(size)
    _product(by[0], gap_slopes.link, face)
    _end_gain(face, by[1], -1.0, D, E, one)
    _end_gain(face[:last], by[1, :last], 1.0, D[m:], E[m:], two[:last])
    _end_gain(face[last:], by[1, last:], 1.0, D[:m], E[:m], two[last:])
    _end_gain(by[2], by[3], -1.0, H, E, low)
    _end_gain(by[2, :e], by[3, :e], 1.0, H[1:], E[1:], high[:e])
    v, storage = by_v.reshape(3, size), (gain_t.reshape(-1), gain_r.reshape(-1))
    link_rows(order, count, m, face, (one, two), (low, high), (v[0], v[1], v[2]), storage, out)
