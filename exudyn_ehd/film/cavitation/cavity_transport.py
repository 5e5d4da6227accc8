"""The mass-conserving film with its cavity as what it is: oil convected one way, by the film's own motion.

With the pressures P of the full vertices and the fills of the cavitated ones the balance of
`exudyn_ehd.film.cavitation.elrod_adams` reads

    A P - E w = b,    D fill = U fill + K (P - Pc) + c,    w = R fill.

A is the symmetric matrix of the Poiseuille conductances between full vertices; they end at the cavity, where the ring
is cut. D (diagonal) is what leaves a cavitated vertex, U what its neighbours upstream hand on, K the pressure-driven
inflow from full neighbours, and w, one number per vertex of the reformation front, what the front receives from the
cavity. As the carriers in theta and in z have one sign each, the fills follow from each other along the flow,
``fill = T (K (P - Pc) + c)`` with ``T = (D - U)^-1``, and

    (I - G) w = R T (K (y - Pc) + c),    G = R T K V,    A y = b,    A V = E,    P = y + V w,

is left: as many unknowns as the front has vertices, column diagonally dominant and non-negative in G (no pivoting),
because no more oil comes back than the front has received. `exudyn_ehd.film.cavitation.cavity_adjoint` goes the same
way backwards.

Where the film is full all around in a few rows, at its ends say, the ring is cut there too: A loses the conductances k
of the links that are cut, not its diagonal, and what comes through them, ``k P`` of the other side, joins the w:
``w = R fill + C P`` and ``G = R T K V + C V``. Nothing else changes, as C takes no more from a vertex than leaves it.

Unknowns are numbered full vertices first, column by column against the flow, so that the front comes last and V costs
half a solution; then the cavitated ones along the flow, row by row. All of it depends on the sets alone.

Not every film is of that kind: where a row is cavitated all around, or the front is long, the caller takes a band
factor of the whole.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.ldl import assemble_band, factor_band
from exudyn_ehd.film.banded.many_sides import solve_columns
from exudyn_ehd.film.banded.numbering import number_along
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import FIRST_ROW

_FAST = {"reassoc", "contract", "nsz", "arcp"}
# The ring is cut at links in up to one of so many rows
CUT_ROWS = 3
FULL_COUNT, FRONT, STRIDE, WIDTH, DRIVEN, RECEIVED = range(6)


@njit(cache=True)
def _order_cavity(full, fixed, fx, along, across, count, order, place_out):
    """Append the cavitated vertices to ``order`` along the flow.

    Returns their number, -1 if oil circulates in one of the rows.
    """
    n, m = full.shape
    placed = 0
    for row in range(m):
        j = row if across > 0 else m - 1 - row
        first = -1
        ruptured = False
        for i in range(n):
            place_out[i, j] = -1
            if full[i, j] or fixed[i, j]:
                first = i
            else:
                ruptured = True
        if not ruptured:
            continue
        if first < 0:
            for i in range(n):
                if fx[(i - 1 + n) % n if along > 0 else i, j] == 0.0:
                    first = i
                    break
            if first < 0:
                return -1
        for s in range(n):
            i = (first + along * s + n) % n
            if not (full[i, j] or fixed[i, j]):
                place_out[i, j] = placed
                order[count + placed] = i * m + j
                placed += 1
    return placed


@njit(cache=True)
def _gather(film, inverse_step, mass_old, pc, full, order, count, placed, P, t, x_out, curve):
    """Right-hand sides b and c into ``x_out`` and the lists of U, D, K and R with C.

    Returns the number of front vertices, those of cut links among them; -1 for a singular D. With a ``curve`` as for
    `factor_transport` without right-hand sides.
    """
    m, size = full.shape[1], full.size
    kx, kz, fx, fz = film.kx.reshape(-1), film.kz.reshape(-1), film.fx.reshape(-1), film.fz.reshape(-1)
    area, H, H_t, old = film.area.reshape(-1), film.H.reshape(-1), film.H_t.reshape(-1), mass_old.reshape(-1)
    prompt, late = film.prompt.reshape(-1), film.late.reshape(-1)
    fixed, sets, given = film.fixed.reshape(-1), full.reshape(-1), P.reshape(-1)
    number, place = t.number.reshape(-1), t.place.reshape(-1)
    width = t.shape[WIDTH]
    driven = received = fronts = 0
    for r in range(count + placed):
        own = order[r]
        is_full, now, before = sets[own], prompt[own], late[own]
        c = r - count
        if inverse_step > 0.0:
            rhs = area[own] * old[own] * inverse_step
            store = area[own] * H[own] * inverse_step
        else:
            rhs = 0.0
            store = area[own] * H_t[own]
        kept = store
        along = across = -1
        by_along = by_across = 0.0
        fresh = True
        for side in range(4):
            if side == 0:
                at = own - m if own >= m else own - m + size
                k, inflow = kx[at], fx[at]
            elif side == 1:
                at = own + m if own + m < size else own + m - size
                k, inflow = kx[own], -fx[own]
            elif side == 2:
                at = own - 1 if own > 0 else size - 1
                k, inflow = kz[at], fz[at]
            else:
                at = own + 1
                k, inflow = kz[own], -fz[own]
            if k == 0.0 and inflow == 0.0:  # so are the links behind the ends
                continue
            known, source, by = fixed[at], -1, 0.0
            if is_full:
                if known:
                    rhs += k * given[at]
                elif not sets[at]:
                    rhs += k * pc
                elif k != 0.0 and abs(number[at] - r) > width:
                    source, by = number[at], k
            elif known:
                rhs += k * (given[at] - pc)
            elif sets[at] and k != 0.0:
                rhs -= k * pc
                t.driven_from[driven] = number[at]
                t.driven_to[driven] = c
                t.driven_by[driven] = k
                driven += 1
            if inflow <= 0.0:
                store -= inflow * now
                rhs += inflow * before
            elif known or sets[at]:
                rhs += inflow * (prompt[at] + late[at])
                if curve is not None and curve[0][at] > 0.0:
                    by_line = inflow * prompt[at] * curve[0][at]
                    if is_full:
                        source, by = number[at], by + by_line
                    elif k != 0.0:
                        t.driven_by[driven - 1] += by_line
                    else:
                        t.driven_from[driven] = number[at]
                        t.driven_to[driven] = c
                        t.driven_by[driven] = by_line
                        driven += 1
            else:
                rhs += inflow * late[at]
                inflow *= prompt[at]
                if is_full:
                    source, by = count + place[at], inflow
                elif side < 2:
                    along = place[at]
                    by_along = inflow
                else:
                    across = place[at]
                    by_across = inflow
            if source >= 0:
                if fresh:
                    t.front[fronts] = r
                    fronts += 1
                    fresh = False
                t.received_from[received] = source
                t.received_to[received] = fronts - 1
                t.received_by[received] = by
                received += 1
        if is_full:
            x_out[r] = rhs - store
            if curve is not None:
                curve[2][r] = (store - kept) * curve[0][own] + kept * curve[1][own]
                if fronts > t.loop.shape[0]:
                    return fronts
            continue
        if not abs(store) > 1e-300:
            return -1
        x_out[r] = rhs
        t.along[c] = along
        t.across[c] = across
        t.by_along[c] = by_along
        t.by_across[c] = by_across
        t.inverse[c] = 1.0 / store
    t.shape[DRIVEN] = driven
    t.shape[RECEIVED] = received
    return fronts


@njit(cache=True)
def _convect(t, placed, P, fill):
    """fill = T (K P + fill), in place, for one film."""
    e = 0
    driven = t.shape[DRIVEN]
    for c in range(placed):
        s = fill[c]
        while e < driven and t.driven_to[e] == c:
            s += t.driven_by[e] * P[t.driven_from[e]]
            e += 1
        if t.along[c] >= 0:
            s += t.by_along[c] * fill[t.along[c]]
        if t.across[c] >= 0:
            s += t.by_across[c] * fill[t.across[c]]
        fill[c] = s * t.inverse[c]


@njit(cache=True, fastmath=_FAST)
def _convect_columns(t, placed, P, fill_out):
    """fill_out = T K P, for every column of P (full vertices, sides)."""
    e = 0
    driven = t.shape[DRIVEN]
    sides = P.shape[1]
    for c in range(placed):
        target = fill_out[c]
        inverse = t.inverse[c]
        if t.along[c] >= 0:
            f = t.by_along[c] * inverse
            known = fill_out[t.along[c]]
            for q in range(sides):
                target[q] = f * known[q]
        else:
            for q in range(sides):
                target[q] = 0.0
        if t.across[c] >= 0:
            f = t.by_across[c] * inverse
            known = fill_out[t.across[c]]
            for q in range(sides):
                target[q] += f * known[q]
        while e < driven and t.driven_to[e] == c:
            k = t.driven_by[e] * inverse
            known = P[t.driven_from[e]]
            for q in range(sides):
                target[q] += k * known[q]
            e += 1


@njit(cache=True, fastmath=_FAST)
def _factor_loop(t, placed):
    """I - G, factored; False if a pivot vanishes."""
    count, fronts, stride = t.shape[FULL_COUNT], t.shape[FRONT], t.shape[STRIDE]
    loop = t.loop
    fill = np.empty((placed, stride))
    V = t.spread[: count * stride].reshape(count, stride)
    _convect_columns(t, placed, V, fill)
    for a in range(fronts):
        for b in range(fronts):
            loop[a, b] = 1.0 if a == b else 0.0
    for e in range(t.shape[RECEIVED]):
        row = loop[t.received_to[e]]
        source = t.received_from[e]
        known = V[source] if source < count else fill[source - count]
        f = t.received_by[e]
        for b in range(fronts):
            row[b] -= f * known[b]
    for k in range(fronts):
        if not abs(loop[k, k]) > 1e-300:
            return False
        inverse = 1.0 / loop[k, k]
        for a in range(k + 1, fronts):
            f = loop[a, k] * inverse
            loop[a, k] = f
            for b in range(k + 1, fronts):
                loop[a, b] -= f * loop[k, b]
    return True


@njit(cache=True)
def factor_transport(film, inverse_step, mass_old, pc, full, along, across, order, P, t, x_out, curve):
    """Factor for the given sets; returns (ok, number of unknowns).

    Parameters
    ----------
    film, inverse_step, mass_old, pc, P
        As in `exudyn_ehd.film.cavitation.elrod_adams.solve_elrod`.
    full : (n, m) bool array
        Full vertices that are not prescribed.
    along, across : int
        `flow_direction` of fx and fz, not 0.
    order : (n m,) int array
        Out: flat vertex of every unknown.
    t : Transport
        Out.
    x_out : (n m,) array
        Right-hand sides b and c.
    curve : three (n m,) arrays or None
        Of a film whose full vertices may lack oil: what flows and what fills change by with their pressures, and, out,
        what this adds to the diagonals of A; what flows on by it joins K, or C. Right-hand sides are the caller's then.
    """
    count = placed = fronts = width = 0
    for spare in (full.shape[1] // CUT_ROWS, 0):
        count, width = number_along(full, film.kx, -along, spare, order, t.number)  # against the flow
        placed = _order_cavity(full, film.fixed, film.fx, along, across, count, order, t.place)
        if placed < 0:
            return False, 0
        t.shape[WIDTH] = width
        fronts = _gather(film, inverse_step, mass_old, pc, full, order, count, placed, P, t, x_out, curve)
        if 0 <= fronts <= t.loop.shape[0]:
            break
    if not 0 <= fronts <= t.loop.shape[0]:
        return False, 0
    stride = fronts + -fronts % 4
    t.shape[FULL_COUNT], t.shape[FRONT], t.shape[STRIDE] = count, fronts, stride
    assemble_band(film.kx, film.kz, t.number, order, count, width, FIRST_ROW, t.band)
    if curve is not None:
        for r in range(count):
            t.band[r, 0] += curve[2][r]
    if not factor_band(t.band, count, width, FIRST_ROW, t.diagonal):
        return False, 0
    if fronts > 0:
        V = t.spread[: count * stride].reshape(count, stride)
        V[:] = 0.0
        for b in range(fronts):
            V[t.front[b], b] = 1.0
        solve_columns(t.front[:fronts], t.band, t.band, t.diagonal, True, count, width, V)
        if not _factor_loop(t, placed):
            return False, 0
    return True, count + placed


@njit(cache=True, fastmath=_FAST)
def _spread(V, w, P):
    """P += V w."""
    for r in range(V.shape[0]):
        s = 0.0
        for b in range(V.shape[1]):
            s += V[r, b] * w[b]
        P[r] += s


@njit(cache=True)
def solve_transport(t, unknowns, x):
    """Solve for one right-hand side x (unknowns,), in place."""
    count, fronts, stride = t.shape[FULL_COUNT], t.shape[FRONT], t.shape[STRIDE]
    placed = unknowns - count
    P, fill = x[:count], x[count:unknowns]
    solve_ldl_one(t.band, t.diagonal, count, t.shape[WIDTH], P)
    if fronts > 0:
        trial = fill.copy()
        _convect(t, placed, P, trial)
        w = np.zeros(stride)
        for e in range(t.shape[RECEIVED]):
            source = t.received_from[e]
            w[t.received_to[e]] += t.received_by[e] * (P[source] if source < count else trial[source - count])
        for a in range(fronts):
            for b in range(a):
                w[a] -= t.loop[a, b] * w[b]
        for a in range(fronts - 1, -1, -1):
            for b in range(a + 1, fronts):
                w[a] -= t.loop[a, b] * w[b]
            w[a] /= t.loop[a, a]
        _spread(t.spread[: count * stride].reshape(count, stride), w, P)
    _convect(t, placed, P, fill)
