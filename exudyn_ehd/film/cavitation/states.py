"""One unknown u per vertex: pressure and film fraction of a film, with their derivatives.

Where ``u >= 0`` the vertex is full, where ``u <= 0`` it is in the cavity; both sides meet at u = 0. With the pressure P
above the cavity's and the curve of `exudyn_ehd.film.cavitation.oil_line` that a vertex may have (``whole``, ``drop``;
both 0 without),

    full, without curve     P = u,                  flows carry 1,
    on the curve, u < 1     P = whole u^2,          flows carry 1 - drop (1 - u)^2,
    behind it, u >= 1       P = whole (2 u - 1),    flows carry 1,
    in the cavity           P = 0,                  flows carry 1 - drop + u.

The vertex holds as much, but on its curve ``1 - drop (1 - u / FILLED)^2`` up to u = FILLED, and 1 behind. All of them
rise with u and have continuous derivatives but at u = 0. Newton's matrix is that of
`exudyn_ehd.film.reynolds.balance` in P at full vertices and in the fill at others, and its steps become those of u by
dP/du: a scaling of columns.

A film of Swift and Stieber has drop = 0, and leaves ``N = f (1 - u)^2 / 2`` of
`exudyn_ehd.film.cavitation.rupture_line` in the balance of a vertex on its curve; in its cavity nothing is unknown. A
film that does not rupture has P = u everywhere.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.oil_line import FILLED, lack

# Least u on a curve, where dP/du vanishes: below, a vertex is one of the cavity for all that can be told.
LEAST = 1e-8
# Pressures over the peak, and fills, by which a vertex may lie on the other side: some thousand roundings.
ROUNDING = 1e-12


# Largest growth of an oil's viscosity in one step, as a logarithm.
LARGEST_THICKENING = 4.0
# Kinds of films: without cavitation, with pressures cut off afterwards, of Swift and Stieber, with mass conserved.
FULL, CLIPPED, RUPTURE, OIL = 0, 1, 2, 3


@njit(cache=True)
def start_states(film, pc, curve, full, u):
    """From the sets alone: fully developed curves, no gauge pressure elsewhere, cavities at the kink."""
    known, sets, x = film.fixed.reshape(-1), full.reshape(-1), u.reshape(-1)
    for c in range(x.size):
        x[c] = 0.0
        if sets[c] and not known[c]:
            x[c] = 1.0 if curve.whole[c] > 0.0 else max(-pc, 0.0)


@njit(cache=True)
def empty_cavity(full, u):
    """Unknowns in the cavity of a film of Swift and Stieber are 0, also of vertices that were prescribed before."""
    sets, x = full.reshape(-1), u.reshape(-1)
    for c in range(x.size):
        x[c] = x[c] if sets[c] else 0.0


@njit(cache=True)
def set_states(film, late, curve, full, u, P, fill):
    """Pressures, fills and slopes of the curves from the unknowns.

    ``late`` is that of `exudyn_ehd.film.reynolds.lagging_void`; ``film.late`` gets what curves carry less than the
    fill.
    """
    known, sets, x = film.fixed.reshape(-1), full.reshape(-1), u.reshape(-1)
    pressures, fills = P.reshape(-1), fill.reshape(-1)
    rest, prompt, kept = film.late.reshape(-1), film.prompt.reshape(-1), late.reshape(-1)
    for c in range(x.size):
        whole, drop = curve.whole[c], curve.drop[c]
        if curve.s[c] < 1.0:
            curve.s[c], curve.slope[c], curve.rise[c] = 1.0, 0.0, 0.0
            rest[c] = kept[c]
        if known[c]:
            sets[c], fills[c] = False, 1.0
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
def join_states(film, curve, rest, full, u):
    """Vertices of a film of Swift and Stieber at which oil piles up join it; returns how many do.

    At the line they meet their own balances between given neighbours: ``g u^2 / 2 + u = e``. ``rest`` (n, m): what
    leaves them less what comes in, without N.
    """
    known, sets, x, leaves, joined = film.fixed.reshape(-1), full.reshape(-1), u.reshape(-1), rest.reshape(-1), 0
    along, across, m = film.kx.reshape(-1), film.kz.reshape(-1), u.shape[1]
    for c in range(x.size):
        f = curve.f[c]
        if known[c] | sets[c] or leaves[c] > (0.5 - LEAST) * f:
            continue
        joined += 1
        sets[c], x[c] = True, 0.0
        if f > 0.0:
            e, g = 0.5 - leaves[c] / f, (along[c - m] + along[c] + across[c - 1] + across[c]) / curve.k[c] - 1.0
            x[c] = min(2.0 * e / (1.0 + np.sqrt(1.0 + 2.0 * g * e)), 1.0)
    return joined


@njit(cache=True)
def take_sink(curve, rest):
    """Take N of `exudyn_ehd.film.cavitation.rupture_line` off the balances (n, m)."""
    balance = rest.reshape(-1)
    for c in range(balance.size):
        balance[c] -= 0.5 * curve.f[c] * (1.0 - curve.s[c]) ** 2


@njit(cache=True)
def add_sink(curve, slopes):
    """Add what N changes by with the pressures to the derivatives (5, n m) of flows and storage."""
    for c in range(curve.s.size):
        slopes[4, c] += curve.k[c] * (1.0 - curve.s[c]) / curve.s[c]


@njit(cache=True)
def move_states(kind, density, curve, order, count, dx, full, u, P):
    """Take Newton's step dx (count,), of pressures where ``full``, else of fills.

    A vertex that crosses u = 0, or the end of its oil's law, stops there and changes its side. As p grows exponentially
    with P, a step x that raises P goes where the tangent of p(P) leads p, ``(1 - exp(-k x)) / k`` with k = p'' / p'.
    ``density``: (weight of its changes as those of a place, its slopes (n, m), pressure where its law ends, what
    `exudyn_ehd.film.lubricant.density_field` knows of the law, Pa per unit of P).

    Returns how many vertices stop, the largest change of a pressure over the peak, of a place on a curve, of a fill,
    that of a place on a curve alone, and the same over the place.
    """
    sets, x, pressures, peak, last_peak = full.reshape(-1), u.reshape(-1), P.reshape(-1), 0.0, 0.0
    (weight, _, end, law, scale), rho_P = density, density[1].reshape(-1)
    for r in range(count):
        if sets[order[r]]:
            before = pressures[order[r]]
            after = before + dx[r]
            # what is cut off may lie far below what stays
            peak = max(peak, after if kind == CLIPPED else abs(after))
            last_peak = max(last_peak, abs(before))
    changes, moved, bent, worn, per_peak = 0, 0.0, 0.0, 0.0, 1.0 / max(peak, ROUNDING * last_peak, 1e-300)
    for r in range(count):
        c = order[r]
        whole, old, change = curve.whole[c], x[c], dx[r]
        if weight > 0.0 and sets[c]:
            bent, at = max(bent, weight * abs(rho_P[c] * change)), pressures[c]
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
def settle_states(film, kind, full, P, fill):
    """Take back what lies on the other side by rounding; returns the least fill before."""
    known, sets, pressures, fills = film.fixed.reshape(-1), full.reshape(-1), P.reshape(-1), fill.reshape(-1)
    least = 1.0
    for c in range(sets.size):
        if not known[c] and kind >= RUPTURE:
            least = min(least, fills[c])
            pressures[c] = max(pressures[c], 0.0) if sets[c] else 0.0
            fills[c] = min(max(fills[c], 0.0), 1.0)
    return least
