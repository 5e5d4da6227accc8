"""One unknown u per vertex: pressure and film fraction of a film, with their derivatives.

A vertex is full where ``u >= 0`` and cavitated where ``u <= 0``; both sides meet at u = 0. P is the pressure above the
cavity's; ``whole`` and ``drop`` describe the curve of `exudyn_ehd.film.cavitation.oil_line` that a vertex may have, and
are 0 without one:

    full, without curve     P = u,                  flows carry 1,
    on the curve, u < 1     P = whole u^2,          flows carry 1 - drop (1 - u)^2,
    behind it, u >= 1       P = whole (2 u - 1),    flows carry 1,
    in the cavity           P = 0,                  flows carry 1 - drop + u.

The vertex has the fill that its flows carry, except on its curve: there it has ``1 - drop (1 - u / FILLED)^2`` up to
u = FILLED, and 1 beyond. All of them rise with u, with continuous derivatives except at u = 0. Newton's matrix is that
of `exudyn_ehd.film.reynolds.balance` in P at full vertices and in the fill at others. Dividing its steps by dP/du, a
scaling of columns, gives the steps of u.

A film of Swift and Stieber has drop = 0. At a vertex on its curve, ``N = f (1 - u)^2 / 2`` of
`exudyn_ehd.film.cavitation.rupture_line` is left in the balance; its cavitated vertices have no unknown. A film that
does not rupture has P = u everywhere.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.oil_line import FILLED, curve_of, lack
from exudyn_ehd.film.cavitation.rupture_line import LEAST
from exudyn_ehd.film.kernels import FAST
from exudyn_ehd.film.reynolds.balance import terms_of

# Pressure over the peak, and fill, by which a vertex may violate its bound: some thousand units of round-off.
ROUNDING = 1e-12


# Largest growth of an oil's viscosity in one step, as a logarithm.
LARGEST_THICKENING = 4.0
# Kinds of films: without cavitation, with pressures cut off afterwards, of Swift and Stieber, with mass conserved.
FULL, CLIPPED, RUPTURE, OIL = 0, 1, 2, 3


@njit(cache=True)
def set_states(film, full, u, P, fill):
    """Set pressures, fills and slopes of the curves from u; ``fill`` is None without mass conservation.

    ``film``: that of `exudyn_ehd.film.solvers.newton`. On curves ``late`` of its terms is smaller than its own one by
    ``prompt`` times the difference between the fill that a vertex has and the one that its flows carry.
    """
    fields, fixed, late, curve = film
    if fill is None:
        _set_pressures(fixed.reshape(-1), full.reshape(-1), u.reshape(-1), curve[4], curve[6], P.reshape(-1))
    else:
        _set_oil(terms_of(fields, fixed), late, curve_of(curve), full, u, P, fill)


@njit(cache=True, fastmath=FAST)
def _set_pressures(known, full, u, whole, s, P):
    for c in range(P.size):
        place = min(max(u[c], 0.0), 1.0)
        curved = whole[c] * (place * place + 2.0 * max(u[c] - 1.0, 0.0))
        p = curved if whole[c] > 0.0 else u[c]
        P[c] = P[c] if known[c] else p
        s[c] = max(place, LEAST) if (whole[c] > 0.0) & full[c] else 1.0


@njit(cache=True)
def _set_oil(film, late, curve, full, u, P, fill):
    known, sets, x = film.fixed.reshape(-1), full.reshape(-1), u.reshape(-1)
    pressures, fills = P.reshape(-1), fill.reshape(-1)
    rest, prompt, kept = film.late.reshape(-1), film.prompt.reshape(-1), late.reshape(-1)
    for c in range(x.size):
        whole, drop = curve.whole[c], curve.drop[c]
        curve.s[c], curve.slope[c], curve.rise[c], rest[c] = 1.0, 0.0, 0.0, kept[c]
        if known[c]:
            fills[c] = 1.0
        elif not sets[c]:
            pressures[c], fills[c] = 0.0, 1.0 - drop + x[c]
        elif whole == 0.0:
            pressures[c], fills[c] = x[c], 1.0
        elif x[c] >= 1.0:
            pressures[c], fills[c] = whole * (2.0 * x[c] - 1.0), 1.0
        else:
            s = max(x[c], LEAST)
            carried, by_s = lack(s, 1.0)
            held, rise = lack(s, FILLED)
            pressures[c], fills[c] = whole * s * s, 1.0 - drop * held
            half = -0.5 * drop / (whole * s)
            curve.s[c], curve.slope[c], curve.rise[c] = s, half * by_s, half * rise
            rest[c] = kept[c] - prompt[c] * drop * (carried - held)


@njit(cache=True)
def place_states(whole, drop, full, P, fill, u):
    """Set u from pressures above the cavity's at ``full`` vertices, from fills at others."""
    sets, x, pressures = full.reshape(-1), u.reshape(-1), P.reshape(-1)
    for c in range(x.size):
        if not sets[c]:
            x[c] = 0.0
        elif whole[c] == 0.0:
            x[c] = pressures[c]
        else:
            p = max(pressures[c], 0.0) / whole[c]
            x[c] = np.sqrt(p) if p < 1.0 else 0.5 * (p + 1.0)
    if fill is not None:
        fills = fill.reshape(-1)
        for c in range(x.size):
            if not sets[c]:
                x[c] = min(fills[c] - 1.0 + drop[c], 0.0)


@njit(cache=True)
def join_states(fixed, links, line, rest, full, P, u):
    """Add the vertices at which oil piles up to a film of Swift and Stieber; returns their number.

    At the line their own balances between given neighbours are solved: ``g u^2 / 2 + u = e``. ``links``: (kx, kz);
    ``line``: (f, k); ``rest`` (n, m): outflow minus inflow, less N of vertices in the film, which becomes that with the
    pressures of those that join; P (n, m): pressures without these.
    """
    known, sets, x, leaves, joined = fixed.reshape(-1), full.reshape(-1), u.reshape(-1), rest.reshape(-1), 0
    along, across, m = links[0].reshape(-1), links[1].reshape(-1), u.shape[1]
    for c in range(x.size):
        f = line[0][c]
        if (leaves[c] > (0.5 - LEAST) * f) | known[c] | sets[c]:
            continue
        joined += 1
        sets[c], x[c] = True, 0.0
        if f > 0.0:
            # a liner adds to k alone
            g = max((along[c - m] + along[c] + across[c - 1] + across[c]) / line[1][c], 2.0) - 1.0
            e = 0.5 - leaves[c] / f
            x[c] = min(2.0 * e / (1.0 + np.sqrt(1.0 + 2.0 * g * e)), 1.0)
            leaves[c] -= 0.5 * f * (1.0 - max(x[c], LEAST)) ** 2
    if joined > 0:
        _press_joined(along, across, m, line, sets, P.reshape(-1), x, leaves)
    return joined


@njit(cache=True, inline="always")
def _press_joined(along, across, m, line, full, P, u, rest):
    """Add the pressure flows from the vertices that join, whose pressures are 0 before, to the balances."""
    for c in range(P.size):
        if full[c] and u[c] > 0.0 and P[c] == 0.0 and line[0][c] > 0.0:
            p, nxt = 0.5 * line[0][c] / line[1][c] * u[c] * u[c], c + m if c + m < P.size else c + m - P.size
            rest[c] += (along[c - m] + along[c] + across[c - 1] + across[c]) * p
            rest[c - m] -= along[c - m] * p
            rest[nxt] -= along[c] * p
            rest[c - 1] -= across[c - 1] * p
            rest[c + 1] -= across[c] * p


@njit(cache=True)
def take_sink(f, s, sign, rest):
    """Subtract N of `exudyn_ehd.film.cavitation.rupture_line` from the balances (n, m) ``sign`` times ``rest``."""
    balance = rest.reshape(-1)
    for c in range(balance.size):
        short = 1.0 - s[c]
        balance[c] = sign * balance[c] - 0.5 * f[c] * short * short


@njit(cache=True)
def add_sink(curve, slopes):
    """Add -dN/dp to the derivatives (5, n m) of flows and storage."""
    for c in range(curve.s.size):
        slopes[4, c] += curve.k[c] * (1.0 - curve.s[c]) / curve.s[c]


@njit(cache=True)
def move_states(kind, bends, curves, order, count, dx, full, u, P):
    """Take Newton's step dx (count,), of pressures where ``full``, else of fills; ``curves``: their ``whole``.

    A vertex that crosses u = 0, or the end of its oil's law, stops there and changes its side. p grows exponentially
    with P. A step x that raises P goes where the tangent of p(P) leads p: to ``(1 - exp(-k x)) / k`` with k = p'' / p'.
    ``bends``: (weight of a relative change of density or gap against a change of u on a curve; these relative changes
    (n, m) per unit of P; P at which the oil's law ends; fields whose third and fourth are p' and p'' of the law; Pa per
    unit of P).

    Returns the number of vertices that stop, and three largest changes: of a pressure over the peak, of u on a curve or
    of a fill; of u on a curve or, weighted, of density or gap; of u on a curve over u, or of density or gap.
    """
    sets, x, pressures, peak, last_peak = full.reshape(-1), u.reshape(-1), P.reshape(-1), 0.0, 0.0
    (weight, _, end, law, scale), steep = bends, bends[1].reshape(-1)
    for r in range(count):
        if sets[order[r]]:
            before = pressures[order[r]]
            after = before + dx[r]
            # clipped pressures may lie far below the others
            peak = max(peak, after if kind == CLIPPED else abs(after))
            last_peak = max(last_peak, abs(before))
    changes, moved, bent, worn, per_peak = 0, 0.0, 0.0, 0.0, 1.0 / max(peak, ROUNDING * last_peak, 1e-300)
    for r in range(count):
        c = order[r]
        whole, old, change = curves[c], x[c], dx[r]
        if weight > 0.0 and sets[c]:
            bent, at = max(bent, weight * abs(steep[c] * change)), pressures[c]
            worn = max(worn, abs(steep[c] * change))
            thickens = scale * law[3, c] / law[2, c] * change
            if law[3, c] > 0.0 and thickens > 0.0 and at < end < np.inf:
                change *= -np.expm1(-min(thickens, LARGEST_THICKENING)) / thickens
            if (at < end) != (at + change < end):
                change = (end if at < end else end * (1.0 - ROUNDING)) - at
                changes += 1
            # below the cavity's pressure, which is cut off, the density stays
            changes += kind == CLIPPED and (at < 0.0) != (at + change < 0.0)
        if not sets[c]:
            new, size = old + change, abs(change)
            crosses = new > ROUNDING
        elif whole == 0.0:
            new, size = old + change, abs(change) * per_peak
            crosses = kind >= RUPTURE and new < -ROUNDING * peak
        else:
            new = old + 0.5 * change / (whole * min(max(old, LEAST), 1.0))
            size = abs(min(new, 1.0) - min(old, 1.0))
            bent, worn = max(bent, size), max(worn, size / max(min(old, new), LEAST))
            if size == 0.0:
                size = abs(change) * per_peak
            crosses = new < 0.0
        moved = max(moved, size) if size == size else np.inf
        if crosses:
            changes += 1
            sets[c], x[c] = not sets[c], 0.0
        else:
            x[c] = new
    return changes, moved, bent, worn


@njit(cache=True)
def settle_states(fixed, kind, full, P, fill):
    """Clip round-off of pressures and fills beyond their bounds; returns the smallest fill before."""
    known, sets, pressures, least = fixed.reshape(-1), full.reshape(-1), P.reshape(-1), 1.0
    for c in range(sets.size):
        if not known[c] and kind >= RUPTURE:
            pressures[c] = max(pressures[c], 0.0) if sets[c] else 0.0
    if fill is not None:
        fills = fill.reshape(-1)
        for c in range(sets.size):
            if not known[c]:
                least = min(least, fills[c])
                fills[c] = min(max(fills[c], 0.0), 1.0)
    return least
