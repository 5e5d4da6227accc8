"""Film-averaged energy equation on the film grid: heat sources, flows, and the system of the temperatures.

Scaled: flows in units of c R^2 (1/s), heat in kelvin per second of such a flow, that is divided by rho c_p c R^2. The
content m = fill H of a control volume changes by its flows and by what enters from outside, ``S = out - in + A dm/dt``
(ends, supplies, and the oil that a cavitation model which does not conserve mass finds or loses). Energy minus T times
mass:

    A m* (T - T_old)/dt + sum over inflows F (T - T_link) + sum over outflows F (T_link - T)
        + S+ (T - T_source) + A walls (T - T_wall) = heat,

m* the old content, or the present one where the old one is not kept. In theta T_link is the temperature upstream. In
z, where oil that turns with the journal borders on oil that the ends suck in, that would leak as much heat to the sides
as the bearing gives off: there it is of second order, by a limiter that makes no extrema. What a link carries leaves
one side and reaches the other, so that the balance holds.

Symbols: P true and q transformed scaled pressure, kx / kz conductances and fx / fz Couette fluxes with their metric, A
areas.
"""

from __future__ import annotations

from numba import njit


@njit(cache=True)
def film_heat(P, q, kx, kz, heat_out):
    """Add the pressure flow's heat to ``heat_out`` (n, m), half of it at either vertex of a link."""
    n, m = P.shape
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
def film_flows(q, fill, kx, kz, fx, fz, qx_out, qz_out, source_out):
    """Flows over the links i -> i+1 and j -> j+1; ``source_out`` (n, m) takes what leaves by them in addition."""
    n, m = q.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            f = _flow(kx[i, j], fx[i, j], q[i, j], q[nxt, j], fill[i, j], fill[nxt, j])
            qx_out[i, j] = f
            source_out[i, j] += f
            source_out[nxt, j] -= f
            qz_out[i, j] = 0.0
            if j + 1 < m:
                f = _flow(kz[i, j], fz[i, j], q[i, j], q[i, j + 1], fill[i, j], fill[i, j + 1])
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
def exchange_sums(P, q, fill, carried, active, conserves, mass_old, inverse_step, squeeze, film, cavity):
    """Sums over what `outside_flows` gives, without fields in between.

    Rates as in `content_rate`. ``carried`` (n, m): the fill that Couette flows take along, ``active`` (n, m): the
    unbroken film of cavitation models that do not conserve mass, ``film``: `Coefficients`, ``cavity``: the scaled
    cavity pressure.

    Returns
    -------
    leaving, work : float
        What leaves, and ``sum (P - cavity) (inflow - area rate)``.
    """
    n, m = q.shape
    kx, kz, fx, fz, H, H_t, area, fixed, _, _ = film
    leaving = 0.0
    work = 0.0
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            rate = area[i, j] * _rate(H[i, j], H_t[i, j], fill[i, j], mass_old[i, j], inverse_step, squeeze)
            work -= (P[i, j] - cavity) * rate
            if not fixed[i, j]:
                continue
            inflow = 0.0
            if j + 1 < m:
                inflow += _flow(kz[i, j], fz[i, j], q[i, j], q[i, j + 1], carried[i, j], carried[i, j + 1])
            if j > 0:
                inflow -= _flow(kz[i, j - 1], fz[i, j - 1], q[i, j - 1], q[i, j], carried[i, j - 1], carried[i, j])
            end = 1 if j == 0 else m - 2
            if conserves or 0 < j < m - 1 or active[i, end] or fixed[i, end]:
                inflow += _flow(kx[i, j], fx[i, j], q[i, j], q[nxt, j], carried[i, j], carried[nxt, j])
                inflow -= _flow(kx[prv, j], fx[prv, j], q[prv, j], q[i, j], carried[prv, j], carried[i, j])
                inflow += rate
            leaving -= min(inflow, 0.0)
            work += (P[i, j] - cavity) * inflow
    return leaving, work


@njit(cache=True)
def transport_slopes(qx, qz, diagonal, T, link_z, held, slopes_out):
    """Derivatives (5, n m) as `exudyn_ehd.film.banded.assemble` takes them, of the energy equation's system.

    The heat over a link is its flow times the temperature upstream and, in z, a share of the difference to the one
    downstream. Of the flows out of a vertex less those into it, times its own temperature, the energy less T times the
    mass is free: they are taken off ``diagonal`` (n, m), which holds everything but the inflows from neighbours. ``qz``
    is zero at the end, where there is no link.

    The shares are a limiter's at the temperatures ``T`` (n, m), those at the start of a step. With any up to a half the
    system's fields do not grow. Of flows that renew more than what a step has ``held`` (n, m) upstream, its storage
    term, only that much counts: in longer steps shares and temperatures would throw each other to and fro.
    """
    n, m = qx.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        for j in range(m):
            k = i * m + j
            at = j + 1 if qz[i, j] < 0.0 else j
            share = downstream_weight(T[i], link_z, j, qz[i, j]) * min(abs(qz[i, j]), held[i, at])
            slopes_out[0, k], slopes_out[1, k] = max(qx[i, j], 0.0), min(qx[i, j], 0.0)
            slopes_out[2, k], slopes_out[3, k] = max(qz[i, j], 0.0) - share, min(qz[i, j], 0.0) + share
            into = qx[prv, j] + (qz[i, j - 1] if j > 0 else 0.0)
            slopes_out[4, k] = diagonal[i, j] - (qx[i, j] + qz[i, j] - into)


@njit(cache=True, inline="always")
def downstream_weight(T, link_z, j, flow):
    """Weight of the temperature downstream on the link j -> j+1.

    By the ratio r of the slopes upstream of the link and on it: a half for r >= 1, ``2 r / (1 + r)^2`` below, which
    meets it smoothly, and none at extrema and behind the ends.
    """
    up = j - 1 if flow > 0.0 else j + 1
    weight = 0.0
    if flow != 0.0 and 0 <= up < len(T) - 1:
        own, before = (T[j + 1] - T[j]) * link_z[j], (T[up + 1] - T[up]) * link_z[up]
        if own * before > 0.0:
            weight = 0.5 if abs(before) >= abs(own) else 2.0 * own * before / (own + before) ** 2
    return weight
