"""Film-averaged energy equation on the film grid: heat sources, flows, and the upwind system.

Scaled: flows in units of c R^2 (1/s), heat in kelvin per second of such a flow, that is divided by rho c_p c R^2. The
content m = fill H of a control volume changes by its flows and by what enters from outside, ``S = out - in + A dm/dt``
(ends, supplies, and the oil that a cavitation model which does not conserve mass finds or loses). Energy minus T times
mass:

    A m* (T - T_old)/dt + sum over inflows F (T - T_upstream) + S+ (T - T_source) + A walls (T - T_wall) = heat,

an M-matrix, so that the temperature has no wiggles and stays above its sources'. m* is the old content, or the present
one where the old one is not kept.

Symbols: P true and q transformed scaled pressure, kx / kz conductances and fx / fz Couette fluxes with their metric, A
areas.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def film_heat(P, q, kx, kz, couette, heat_out):
    """Heat of the film: ``couette`` (n, m) plus the pressure flow's, half of it at either vertex of a link."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            heat_out[i, j] = couette[i, j]
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            w = 0.5 * kx[i, j] * (q[i, j] - q[nxt, j]) * (P[i, j] - P[nxt, j])
            heat_out[i, j] += w
            heat_out[nxt, j] += w
            if j + 1 < m:
                w = 0.5 * kz[i, j] * (q[i, j] - q[i, j + 1]) * (P[i, j] - P[i, j + 1])
                heat_out[i, j] += w
                heat_out[i, j + 1] += w


@njit(cache=True)
def film_flows(q, fill, kx, kz, fx, fz, area, rate, qx_out, qz_out, source_out):
    """Flows over the links i -> i+1 and j -> j+1, and the source S of every vertex; ``rate`` = dm/dt (n, m)."""
    n, m = q.shape
    for i in range(n):
        for j in range(m):
            source_out[i, j] = area[i, j] * rate[i, j]
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            up = fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]
            f = kx[i, j] * (q[i, j] - q[nxt, j]) + fx[i, j] * up
            qx_out[i, j] = f
            source_out[i, j] += f
            source_out[nxt, j] -= f
            qz_out[i, j] = 0.0
            if j + 1 < m:
                up = fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]
                f = kz[i, j] * (q[i, j] - q[i, j + 1]) + fz[i, j] * up
                qz_out[i, j] = f
                source_out[i, j] += f
                source_out[i, j + 1] -= f


@njit(cache=True)
def content_rate(H, H_t, fill, mass_old, inverse_step, squeeze, rate_out):
    """Rate of the content fill H: by the old content if ``inverse_step`` > 0, else by the gap's rate if ``squeeze``."""
    n, m = H.shape
    for i in range(n):
        for j in range(m):
            rate_out[i, j] = _rate(H[i, j], H_t[i, j], fill[i, j], mass_old[i, j], inverse_step, squeeze)


@njit(cache=True, inline="always")
def _rate(h, h_t, fill, old, inverse_step, squeeze):
    rate = 0.0
    if inverse_step > 0.0:
        rate = (fill * h - old) * inverse_step
    elif squeeze:
        rate = fill * h_t
    return rate


@njit(cache=True, inline="always")
def _flow(k, f, q0, q1, fill0, fill1):
    """Flow over a link from vertex 0 to vertex 1."""
    return k * (q0 - q1) + f * (fill0 if f >= 0.0 else fill1)


@njit(cache=True)
def outside_flows(q, fill, kx, kz, fx, fz, area, rate, fixed, unbroken, outside_out):
    """What enters at fixed vertices: their balance; next to a ruptured film only the flow over the end's link.

    ``unbroken`` (n, m) is all True for cavitation models that conserve mass.
    """
    n, m = q.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            outside_out[i, j] = 0.0
            if not fixed[i, j]:
                continue
            up = 0.0
            down = 0.0
            if j + 1 < m:
                up = _flow(kz[i, j], fz[i, j], q[i, j], q[i, j + 1], fill[i, j], fill[i, j + 1])
            if j > 0:
                down = _flow(kz[i, j - 1], fz[i, j - 1], q[i, j - 1], q[i, j], fill[i, j - 1], fill[i, j])
            outside_out[i, j] = up - down
            if (j == 0 and not unbroken[i, 1]) or (j == m - 1 and not unbroken[i, m - 2]):
                continue
            out = _flow(kx[i, j], fx[i, j], q[i, j], q[nxt, j], fill[i, j], fill[nxt, j])
            into = _flow(kx[prv, j], fx[prv, j], q[prv, j], q[i, j], fill[prv, j], fill[i, j])
            outside_out[i, j] += out - into + area[i, j] * rate[i, j]


@njit(cache=True)
def exchange_sums(P, q, kx, kz, fz, b, H_t, area, fixed, active, squeeze, cavity):
    """Sums over what `outside_flows` gives for cavitation models that do not conserve mass, without fields in between.

    ``b`` (n, m) is the right-hand side of the film's equation, Couette inflow less squeeze, ``active`` (n, m) the
    unbroken film, ``cavity`` the scaled cavity pressure.

    Returns
    -------
    leaving, work : float
        What leaves, and ``sum (P - cavity) inflow`` plus, with ``squeeze``, ``cavity sum area dH/dt``.
    """
    n, m = q.shape
    leaving = 0.0
    work = 0.0
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if not fixed[i, j]:
                continue
            inflow = 0.0
            if j + 1 < m:
                inflow += kz[i, j] * (q[i, j] - q[i, j + 1])
            if j > 0:
                inflow += kz[i, j - 1] * (q[i, j] - q[i, j - 1])
            end = 1 if j == 0 else m - 2
            if 0 < j < m - 1 or active[i, end] or fixed[i, end]:
                inflow += kx[i, j] * (q[i, j] - q[nxt, j]) + kx[prv, j] * (q[i, j] - q[prv, j]) - b[i, j]
            elif j == 0:
                inflow += fz[i, j]
            else:
                inflow -= fz[i, j - 1]
            leaving -= min(inflow, 0.0)
            work += (P[i, j] - cavity) * inflow
    if squeeze and cavity != 0.0:
        work += _cavity_work(H_t, area, cavity)
    return leaving, work


@njit(cache=True)
def exchange_sums_fill(P, q, fill, mass_old, inverse_step, squeeze, film, cavity):
    """As `exchange_sums` where the closure conserves mass; rates as in `content_rate`, ``film``: `Coefficients`."""
    n, m = q.shape
    kx, kz, fx, fz, H, H_t, area, fixed = film
    leaving = 0.0
    work = 0.0
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if not fixed[i, j]:
                continue
            inflow = 0.0
            if j + 1 < m:
                inflow += _flow(kz[i, j], fz[i, j], q[i, j], q[i, j + 1], fill[i, j], fill[i, j + 1])
            if j > 0:
                inflow -= _flow(kz[i, j - 1], fz[i, j - 1], q[i, j - 1], q[i, j], fill[i, j - 1], fill[i, j])
            inflow += _flow(kx[i, j], fx[i, j], q[i, j], q[nxt, j], fill[i, j], fill[nxt, j])
            inflow -= _flow(kx[prv, j], fx[prv, j], q[prv, j], q[i, j], fill[prv, j], fill[i, j])
            inflow += area[i, j] * _rate(H[i, j], H_t[i, j], fill[i, j], mass_old[i, j], inverse_step, squeeze)
            leaving -= min(inflow, 0.0)
            work += (P[i, j] - cavity) * inflow
    if squeeze and cavity != 0.0:
        work += _cavity_work(H_t, area, cavity)
    return leaving, work


@njit(cache=True)
def _cavity_work(H_t, area, cavity):
    """``cavity sum area dH/dt``."""
    n, m = H_t.shape
    closing = 0.0
    for i in range(n):
        for j in range(m):
            closing += area[i, j] * H_t[i, j]
    return cavity * closing


def upwind_slopes(qx: np.ndarray, qz: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Derivatives (5, n m) as `exudyn_ehd.film.banded.assemble` takes them, of the upwind system.

    The heat over a link is its flow times the temperature upstream. Of the flows out of a vertex less those into it,
    times its own temperature, the energy less T times the mass is free: they are taken off ``diagonal`` (n, m), which
    holds everything but the inflows from neighbours. ``qz`` is zero at the end, where there is no link.
    """
    out = np.empty((5, *qx.shape))
    for k, flow in ((0, qx), (2, qz)):
        np.maximum(flow, 0.0, out=out[k])
        np.minimum(flow, 0.0, out=out[k + 1])
    leaving = qx + qz - np.roll(qx, 1, axis=0)
    leaving[:, 1:] -= qz[:, :-1]
    np.subtract(diagonal, leaving, out=out[4])
    return out.reshape(5, -1)
