"""The transposed system of `cavity_transport`, solved with the same factor and backwards, against the flow.

The unknowns lam of the full vertices and nu of the cavitated ones follow from the right-hand sides g and mu by way of
``z = E^T lam``:

    z = (I - G)^-T V^T (g + K^T T^T mu),    nu = T^T (mu + R^T z),    A lam = g + K^T nu + C^T z.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.many_sides import solve_columns
from exudyn_ehd.film.cavitation.cavity_transport import DRIVEN, FRONT, FULL_COUNT, RECEIVED, STRIDE, WIDTH

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def _convect_back(t, placed, mu):
    """mu = T^T mu for every column of mu (cavitated vertices, sides), in place."""
    sides = mu.shape[1]
    for c in range(placed - 1, -1, -1):
        target = mu[c]
        inverse = t.inverse[c]
        for q in range(sides):
            target[q] *= inverse
        if t.along[c] >= 0:
            f = t.by_along[c]
            up = mu[t.along[c]]
            for q in range(sides):
                up[q] += f * target[q]
        if t.across[c] >= 0:
            f = t.by_across[c]
            up = mu[t.across[c]]
            for q in range(sides):
                up[q] += f * target[q]


@njit(cache=True, fastmath=_FAST)
def solve_transport_transposed(t, unknowns, x):
    """Solve the transposed system for every column of x (unknowns, sides), C-contiguous, in place."""
    count, fronts, stride = t.shape[FULL_COUNT], t.shape[FRONT], t.shape[STRIDE]
    placed = unknowns - count
    sides = x.shape[1]
    g, mu = x[:count], x[count:unknowns]
    if fronts > 0:
        back = mu.copy()
        _convect_back(t, placed, back)
        z = np.zeros((fronts, sides))
        V = t.spread[: count * stride].reshape(count, stride)
        trial = g.copy()
        for e in range(t.shape[DRIVEN]):
            target = trial[t.driven_from[e]]
            k = t.driven_by[e]
            known = back[t.driven_to[e]]
            for q in range(sides):
                target[q] += k * known[q]
        for r in range(count):
            for b in range(fronts):
                v = V[r, b]
                for q in range(sides):
                    z[b, q] += v * trial[r, q]
        for a in range(fronts):
            for b in range(a):
                f = t.loop[b, a]
                for q in range(sides):
                    z[a, q] -= f * z[b, q]
            inverse = 1.0 / t.loop[a, a]
            for q in range(sides):
                z[a, q] *= inverse
        for a in range(fronts - 1, -1, -1):
            for b in range(a + 1, fronts):
                f = t.loop[b, a]
                for q in range(sides):
                    z[a, q] -= f * z[b, q]
        for e in range(t.shape[RECEIVED]):
            target = x[t.received_from[e]]
            f = t.received_by[e]
            known = z[t.received_to[e]]
            for q in range(sides):
                target[q] += f * known[q]
    _convect_back(t, placed, mu)
    for e in range(t.shape[DRIVEN]):
        target = g[t.driven_from[e]]
        k = t.driven_by[e]
        known = mu[t.driven_to[e]]
        for q in range(sides):
            target[q] += k * known[q]
    solve_columns(np.zeros(sides, dtype=np.int64), t.band, t.band, t.diagonal, True, count, t.shape[WIDTH], g)


@njit(cache=True, fastmath=_FAST)
def _convect_back_one(t, placed, mu):
    """mu = T^T mu in place, for one film."""
    for c in range(placed - 1, -1, -1):
        m = mu[c] * t.inverse[c]
        mu[c] = m
        if t.along[c] >= 0:
            mu[t.along[c]] += t.by_along[c] * m
        if t.across[c] >= 0:
            mu[t.across[c]] += t.by_across[c] * m


@njit(cache=True, fastmath=_FAST)
def reduce_transposed(t, unknowns, x):
    """As `solve_transport_transposed` for every row of x (k, unknowns), without its last step, by A."""
    count, fronts, stride = t.shape[FULL_COUNT], t.shape[FRONT], t.shape[STRIDE]
    placed = unknowns - count
    V = t.spread[: count * stride].reshape(count, stride)
    trial = np.empty(count)
    z = np.empty(stride)
    for k in range(x.shape[0]):
        g, mu = x[k, :count], x[k, count:unknowns]
        if fronts > 0:
            convects = False
            for r in range(count):
                trial[r] = g[r]
            for c in range(placed):
                convects |= mu[c] != 0.0
            if convects:
                back = mu.copy()
                _convect_back_one(t, placed, back)
                for e in range(t.shape[DRIVEN]):
                    trial[t.driven_from[e]] += t.driven_by[e] * back[t.driven_to[e]]
            z[:] = 0.0
            for r in range(count):
                a = trial[r]
                row = V[r]
                for b in range(stride):
                    z[b] += a * row[b]
            for a in range(fronts):
                s = z[a]
                for b in range(a):
                    s -= t.loop[b, a] * z[b]
                z[a] = s / t.loop[a, a]
            for a in range(fronts - 1, -1, -1):
                s = z[a]
                for b in range(a + 1, fronts):
                    s -= t.loop[b, a] * z[b]
                z[a] = s
            for e in range(t.shape[RECEIVED]):
                x[k, t.received_from[e]] += t.received_by[e] * z[t.received_to[e]]
        _convect_back_one(t, placed, mu)
        for e in range(t.shape[DRIVEN]):
            g[t.driven_from[e]] += t.driven_by[e] * mu[t.driven_to[e]]
