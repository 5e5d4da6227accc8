"""One unknown u per vertex: pressure and film fraction of a film, with their derivatives.

A vertex is full where ``u >= 0`` and cavitated where ``u <= 0``; both branches meet at u = 0. P is the pressure above
the cavity's. Where the rupture line may lie inside a cell, a vertex has a curve of
`exudyn_ehd.film.cavitation.oil_line`: ``whole`` is P at u = 1, and ``drop`` the missing fill at u = 0. Both are 0
without a curve:

    full, without curve     P = u,                  fill of the outflow 1,
    on the curve, u < 1     P = whole u^2,          fill of the outflow 1 - drop (1 - u)^2,
    beyond it, u >= 1       P = whole (2 u - 1),    fill of the outflow 1,
    in the cavity           P = 0,                  fill of the outflow 1 - drop + u.

The fill of the vertex equals the fill of its outflow (its Couette flows), except on its curve. There it is
``1 - drop (1 - u / FILLED)^2`` up to u = FILLED, and 1 beyond. P and both fills rise with u, with continuous
derivatives except at u = 0. Newton's matrix is that of `exudyn_ehd.film.reynolds.balance` in P at full vertices and in
the fill at others. Its steps, divided by dP/du (a scaling of columns), are the steps of u.

A film of Swift and Stieber has drop = 0. Its balance at a vertex on the curve has the residual ``N = f (1 - u)^2 / 2``
of `exudyn_ehd.film.cavitation.rupture_line`; its cavitated vertices have no unknown. A film that does not rupture has
P = u everywhere.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST
from exudyn_ehd.film.cavitation.oil_line import FILLED, curve_of, missing_fill
from exudyn_ehd.film.cavitation.rupture_line import SMALLEST_S
from exudyn_ehd.film.reynolds.balance import terms_of

# Largest p / p_max below 0, and fill above its bound, at which a vertex keeps its side: some thousand units of
# round-off. Smaller values let vertices change sides by round-off, larger ones let pressures violate their bound.
BOUND_TOLERANCE = 1e-12


# Largest logarithm of the growth of an oil's viscosity in one step. Larger values risk overflow, smaller ones cost
# steps.
LARGEST_THICKENING = 4.0
# Kinds of films: without cavitation, with pressures cut off afterwards, of Swift and Stieber, with mass conserved.
FULL, CLIPPED, RUPTURE, OIL = 0, 1, 2, 3


@njit(cache=True)
def set_fields(film, full, u, P, fill):
    """Set pressures, fills and slopes of the curves from u; ``fill`` is None without mass conservation.

    ``film``: as for `exudyn_ehd.film.solvers.newton`. On curves, ``late`` of the film's terms becomes its ``late``
    (third entry) less ``prompt`` times (fill of the vertex - fill of its outflow).
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
        s[c] = max(place, SMALLEST_S) if (whole[c] > 0.0) & full[c] else 1.0


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
            s = max(x[c], SMALLEST_S)
            carried, by_s = missing_fill(s, 1.0)
            held, rise = missing_fill(s, FILLED)
            pressures[c], fills[c] = whole * s * s, 1.0 - drop * held
            half = -0.5 * drop / (whole * s)
            curve.s[c], curve.slope[c], curve.rise[c] = s, half * by_s, half * rise
            rest[c] = kept[c] - prompt[c] * drop * (carried - held)


@njit(cache=True)
def place_unknowns(whole, drop, full, P, fill, u):
    """Set u from the pressures P above the cavity's at ``full`` vertices, and from the fills at others."""
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
def activate_vertices(fixed, links, line, rest, full, P, u):
    """Add the vertices at which oil piles up (more inflow than outflow) to the active set ``full`` of a film of Swift
    and Stieber; returns their number.

    At an added vertex with a curve, u solves the vertex's own balance for given pressures of its neighbours:
    ``g u^2 / 2 + u = e``.

    Parameters
    ----------
    links, line : (kx, kz), (f, k)
    rest : (n, m) array
        Residual: outflow minus inflow, less N of active vertices. Updated by the pressures of the added vertices.
    P : (n, m) array
        Pressures before; those of the added vertices stay 0.
    """
    known, sets, x, residuals, added = fixed.reshape(-1), full.reshape(-1), u.reshape(-1), rest.reshape(-1), 0
    along, across, m = links[0].reshape(-1), links[1].reshape(-1), u.shape[1]
    for c in range(x.size):
        f = line[0][c]
        if (residuals[c] > (0.5 - SMALLEST_S) * f) | known[c] | sets[c]:
            continue
        added += 1
        sets[c], x[c] = True, 0.0
        if f > 0.0:
            # a liner adds to k but not to the conductances of the links
            g = max((along[c - m] + along[c] + across[c - 1] + across[c]) / line[1][c], 2.0) - 1.0
            e = 0.5 - residuals[c] / f
            x[c] = min(2.0 * e / (1.0 + np.sqrt(1.0 + 2.0 * g * e)), 1.0)
            residuals[c] -= 0.5 * f * (1.0 - max(x[c], SMALLEST_S)) ** 2
    if added > 0:
        _add_pressure_flows(along, across, m, line, sets, P.reshape(-1), x, residuals)
    return added


@njit(cache=True, inline="always")
def _add_pressure_flows(along, across, m, line, full, P, u, rest):
    """Add the pressure flows out of the added vertices, with u > 0 but P still 0, to the balances ``rest``.

    Negative places count from the end: the first column follows the last one.
    """
    for c in range(P.size):
        if full[c] and u[c] > 0.0 and P[c] == 0.0 and line[0][c] > 0.0:
            p = 0.5 * line[0][c] / line[1][c] * u[c] * u[c]
            rest[c] += (along[c - m] + along[c] + across[c - 1] + across[c]) * p
            rest[c - m] -= along[c - m] * p
            rest[c + m - P.size] -= along[c] * p
            rest[c - 1] -= across[c - 1] * p
            rest[c + 1 - P.size] -= across[c] * p


@njit(cache=True)
def subtract_sink(f, s, sign, rest):
    """Replace ``rest`` (n, m) by ``sign rest - N``, with N of `exudyn_ehd.film.cavitation.rupture_line`."""
    balance = rest.reshape(-1)
    for c in range(balance.size):
        remainder = 1.0 - s[c]
        balance[c] = sign * balance[c] - 0.5 * f[c] * remainder * remainder


@njit(cache=True)
def add_sink_slopes(curve, slopes):
    """Add -dN/dp to the diagonal: the last of the derivatives ``slopes`` (5, n m) of flows and storage."""
    for c in range(curve.s.size):
        slopes[4, c] += curve.k[c] * (1.0 - curve.s[c]) / curve.s[c]


@njit(cache=True)
def apply_step(kind, nonlinearity, curves, halves, order, count, dx, full, u, P):
    """Take Newton's step dx (count,), of pressures where ``full``, else of fills; ``curves``: ``whole`` of the module.

    The step of a vertex that crosses u = 0 ends there, and the vertex becomes full or cavitated. A step that crosses
    the end of the oil's law ends there as well. The pressure p(P) of such an oil grows exponentially with P. A step x
    that raises P is therefore shortened to ``(1 - exp(-k x)) / k`` with k = p'' / p', which gives p the change that the
    tangent of p(P) predicts.

    Parameters
    ----------
    halves : bool
        Whether a step on a curve to u < 0 halves u instead: else two vertices may leave and join a film by turns.
    nonlinearity : tuple
        Weight of a relative change of density or gap, where a change of u on a curve has the weight 1; these relative
        changes (n, m) per unit of P; P at which the oil's law ends; p' and p'' of the law (2, n m); Pa per unit of P.

    Returns
    -------
    changes : int
        Number of vertices whose step ends at u = 0 or at the end of the oil's law, or whose pressure is clipped anew or
        no longer.
    largest_change : float
        Largest change of p / p_max, of u on a curve, or of a fill; inf if not a number.
    nonlinear_change : float
        Largest change of u on a curve or weighted relative change of density or gap.
    matrix_change : float
        Largest relative change of u on a curve, of density or of gap: about the contraction rate of a chord step.
    """
    sets, x, pressures, peak, previous_peak = full.reshape(-1), u.reshape(-1), P.reshape(-1), 0.0, 0.0
    (weight, _, end, law, scale), relative_slopes = nonlinearity, nonlinearity[1].reshape(-1)
    for r in range(count):
        if sets[order[r]]:
            before = pressures[order[r]]
            after = before + dx[r]
            # clipped pressures may lie far below the others
            peak = max(peak, after if kind == CLIPPED else abs(after))
            previous_peak = max(previous_peak, abs(before))
    changes, largest_change, nonlinear_change, matrix_change, per_peak = (
        0,
        0.0,
        0.0,
        0.0,
        1.0 / max(peak, BOUND_TOLERANCE * previous_peak, 1e-300),
    )
    for r in range(count):
        c = order[r]
        whole, old, change = curves[c], x[c], dx[r]
        if weight > 0.0 and sets[c]:
            nonlinear_change, at = max(nonlinear_change, weight * abs(relative_slopes[c] * change)), pressures[c]
            matrix_change = max(matrix_change, abs(relative_slopes[c] * change))
            growth = scale * law[1, c] / law[0, c] * change
            if law[1, c] > 0.0 and growth > 0.0 and at < end < np.inf:
                change *= -np.expm1(-min(growth, LARGEST_THICKENING)) / growth
            if (at < end) != (at + change < end):
                change = (end if at < end else end * (1.0 - BOUND_TOLERANCE)) - at
                changes += 1
            # below the cavity pressure, where P is clipped, the density is constant
            changes += kind == CLIPPED and (at < 0.0) != (at + change < 0.0)
        if not sets[c]:
            new, size = old + change, abs(change)
            crosses = new > BOUND_TOLERANCE
        elif whole == 0.0:
            new, size = old + change, abs(change) * per_peak
            crosses = kind >= RUPTURE and new < -BOUND_TOLERANCE * peak
        else:
            new = old + 0.5 * change / (whole * min(max(old, SMALLEST_S), 1.0))
            if new < 0.0 and halves and old > SMALLEST_S:
                new, changes = 0.5 * old, changes + 1
            size = abs(min(new, 1.0) - min(old, 1.0))
            nonlinear_change, matrix_change = (
                max(nonlinear_change, size),
                max(matrix_change, size / max(min(old, new), SMALLEST_S)),
            )
            if size == 0.0:
                size = abs(change) * per_peak
            crosses = new < 0.0
        largest_change = max(largest_change, size) if size == size else np.inf
        if crosses:
            changes += 1
            sets[c], x[c] = not sets[c], 0.0
        else:
            x[c] = new
    return changes, largest_change, nonlinear_change, matrix_change


@njit(cache=True)
def snap_to_bounds(fixed, kind, full, P, fill):
    """Clip pressures and fills to their bounds, which they exceed by round-off; returns the smallest fill before."""
    known, sets, pressures, smallest_fill = fixed.reshape(-1), full.reshape(-1), P.reshape(-1), 1.0
    for c in range(sets.size):
        if not known[c] and kind >= RUPTURE:
            pressures[c] = max(pressures[c], 0.0) if sets[c] else 0.0
    if fill is not None:
        fills = fill.reshape(-1)
        for c in range(sets.size):
            if not known[c]:
                smallest_fill = min(smallest_fill, fills[c])
                fills[c] = min(max(fills[c], 0.0), 1.0)
    return smallest_fill
