"""Newton's method for a mass-conserving film with its rupture line inside the cells; see the module `curve`.

Unknowns are those of the plain film, pressures and fills; a vertex at the line has its pressure, whose steps are taken
in s, in which balances are nearly linear. Steps are differences to the film before, so that what is solved is known to
rounding. Vertices change sides as those of the plain film, at the ends of their curve.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu_one
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem
from exudyn_ehd.film.cavitation.cavity_transport import factor_transport, solve_transport
from exudyn_ehd.film.cavitation.lagging_void import hold_back
from exudyn_ehd.film.cavitation.oil_line.curve import FILLED, OilLine, add_curve, curve_terms, lack
from exudyn_ehd.film.reynolds.balance import film_balance, film_slopes, film_terms, oil_links
from exudyn_ehd.film.reynolds.links import flow_direction

MOST_STEPS = 60
# Least s: below, a vertex at the line is one of the cavity for all that can be told.
LEAST = 1e-8
# What steps may move s by in a film that is solved: its square is what is left. Below the other one a second step with
# the same factor pays.
SETTLED, REUSABLE = 1e-7, 0.3
# What balances may lack of the flows.
BALANCED = 1e-12
# Pressures over the peak, and fills, by which vertices may lie on the other side: as in the plain film.
SET_TOLERANCE = 1e-12
LARGEST_DEFICIT = 1e-6
# Steps after which vertices no longer leave the film at once: two may drive each other out and in again for ever. Of an
# s that would vanish so much is left.
PATIENT, KEPT = 8, 0.1


@njit(cache=True, inline="always")
def _bend(film, curve, c, pc, pressures, fills):
    """Pressure, fill, flows and slopes of a vertex at the line with its s."""
    s, drop, whole = curve.s[c], curve.drop[c], curve.whole[c]
    carried, by_s = lack(s, 1.0)
    held, rise = lack(s, FILLED)
    pressures[c] = pc + whole * s * s
    fills[c] = 1.0 - drop * held
    curve.slope[c], curve.rise[c] = -0.5 * drop * by_s / (whole * s), -0.5 * drop * rise / (whole * s)
    _carry(film, curve, c, drop * (carried - held))


@njit(cache=True, inline="always")
def _carry(film, curve, c, less):
    """Flows take along so much less than the fill of a vertex."""
    film.late.reshape(-1)[c] -= film.prompt.reshape(-1)[c] * (less - curve.less[c])
    curve.less[c] = less


@njit(cache=True, inline="always")
def _end(film, curve, c):
    """A vertex without line."""
    curve.s[c], curve.slope[c], curve.rise[c] = 1.0, 0.0, 0.0
    _carry(film, curve, c, 0.0)


@njit(cache=True)
def place_curve(film, pc, full, curve, P, fill):
    """Every vertex' state from the sets and the pressures of another film."""
    known, sets, pressures, fills = film.fixed.reshape(-1), full.reshape(-1), P.reshape(-1), fill.reshape(-1)
    for c in range(known.size):
        curve.s[c], curve.slope[c], curve.rise[c], curve.less[c] = 1.0, 0.0, 0.0, 0.0
        if known[c]:
            sets[c], fills[c] = False, 1.0
        elif not sets[c]:
            pressures[c], fills[c] = pc, min(max(fills[c], 0.0), 1.0 - curve.drop[c])
        elif curve.whole[c] > 0.0 and pressures[c] - pc < curve.whole[c]:
            curve.s[c] = max(np.sqrt(max(pressures[c] - pc, 0.0) / curve.whole[c]), LEAST)
            _bend(film, curve, c, pc, pressures, fills)
        else:
            pressures[c], fills[c] = max(pressures[c], pc), 1.0


@njit(cache=True)
def _flows(film, terms, curve, pc, P):
    """Largest flow that meets in a vertex: what its balance is measured by."""
    kx, kz, pressures = film.kx.reshape(-1), film.kz.reshape(-1), P.reshape(-1)
    area, grow, kept = terms.area.reshape(-1), terms.grow.reshape(-1), terms.kept.reshape(-1)
    largest = 0.0
    for c in range(kx.size):
        flow = curve.out[c] + (kx[c] + kz[c]) * abs(pressures[c] - pc) + area[c] * (abs(grow[c]) + abs(kept[c]))
        largest = max(largest, flow)
    return largest


@njit(cache=True)
def _factor(film, terms, inverse_step, mass_old, pc, full, curve, directions, order, number, factors, x, P, fill):
    """Newton's matrix for the given film, factored; returns as `elrod_adams._solve_sets`."""
    (along, across), (lower, upper, inv_diag, t) = directions, factors
    if along != 0 and across != 0:
        ok, count = factor_transport(
            film,
            inverse_step,
            mass_old,
            pc,
            full,
            along,
            across,
            order,
            P,
            t,
            x,
            (curve.slope, curve.rise, curve.shift),
        )
        if ok:
            return True, count, 1, True
    links, free, sets = oil_links(film, full)
    count, width = number_cells(free, links, order, number)
    slopes = np.empty((5, P.size))
    film_slopes(fill, sets, None, None, terms, slopes)
    add_curve(curve, terms, slopes)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(links, film.kz, slopes, number, order, count, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width, False


@njit(cache=True)
def _own(film, terms, curve, c, m):
    """Own balance of a vertex along its curve, ``a s^2 + b s + d``: (a, b) up to s = FILLED, (a, b, d) behind."""
    kx, kz, size, drop = film.kx.reshape(-1), film.kz.reshape(-1), film.H.size, curve.drop[c]
    links = kx[c] + kx[c - m if c >= m else c - m + size] + kz[c] + (kz[c - 1] if c > 0 else 0.0)
    flow = curve.out[c] * terms.prompt.reshape(-1)[c] * drop
    store = max(terms.area.reshape(-1)[c] * terms.grow.reshape(-1)[c], 0.0) * drop
    press = links * curve.whole[c]
    behind = (press - flow, 2.0 * flow, store)
    return (press - flow - store / (FILLED * FILLED), 2.0 * (flow + store / FILLED)), behind


@njit(cache=True, inline="always")
def _value(own, s):
    """Own balance at s, and its derivative to s."""
    (a, b), (a_on, b_on, d) = own
    if s < FILLED:
        return (a * s + b) * s, 2.0 * a * s + b
    return (a_on * s + b_on) * s + d, 2.0 * a_on * s + b_on


@njit(cache=True, inline="always")
def _place(own, value):
    """s at which the own balance has a value; on from s = 1 with the slope there, negative below 0."""
    (a, b), (a_on, b_on, d) = own
    if value <= 0.0:
        return -1.0
    if value < (a * FILLED + b) * FILLED:
        return 2.0 * value / (b + np.sqrt(max(b * b + 4.0 * a * value, 0.0)))
    end = a_on + b_on + d
    if value >= end:
        return 1.0 + (value - end) / (2.0 * a_on + b_on)
    value -= d
    return 2.0 * value / (b_on + np.sqrt(max(b_on * b_on + 4.0 * a_on * value, 0.0)))


@njit(cache=True)
def _move(film, terms, pc, full, curve, order, count, x, taken, P, fill):
    """Take a step; returns how many vertices change sides, and the largest change of an s."""
    sets, pressures, fills, m = full.reshape(-1), P.reshape(-1), fill.reshape(-1), full.shape[1]
    kept, peak = KEPT if taken > PATIENT else 0.0, 0.0
    for r in range(count):
        if sets[order[r]]:
            peak = max(peak, abs(pressures[order[r]] + x[r] - pc))
    changes, moved = 0, 0.0
    for r in range(count):
        c = order[r]
        whole = curve.whole[c]
        if not sets[c]:
            new = fills[c] + x[r]
            excess = new - (1.0 - curve.drop[c])
            if not excess > SET_TOLERANCE:
                fills[c] = new
                continue
            changes += 1
            sets[c], fills[c] = True, 1.0
            if whole > 0.0:
                leaves = curve.out[c] * terms.prompt.reshape(-1)[c]
                leaves += terms.area.reshape(-1)[c] * terms.grow.reshape(-1)[c]
                curve.s[c] = max(_place(_own(film, terms, curve, c, m), leaves * excess), LEAST)
                if curve.s[c] < 1.0:
                    _bend(film, curve, c, pc, pressures, fills)
                else:
                    curve.s[c], pressures[c] = 1.0, pc + whole
            continue
        own, p = curve.s[c], pressures[c] - pc + x[r]
        if not whole > 0.0:
            pressures[c] = pc + p
            if p < -SET_TOLERANCE * peak:
                changes += 1
                sets[c], pressures[c] = False, pc
            continue
        # along the curve, and on from its end with its slope; so far that the vertex meets its own balance
        place = own + 0.5 * x[r] / (whole * own) if own < 1.0 else 0.5 * (1.0 + p / whole)
        if min(own, place) < 1.0:
            balance = _own(film, terms, curve, c, m)
            value, slope = _value(balance, own)
            place = _place(balance, value + slope * (place - own))
        if place < kept * own and kept * own > LEAST:
            place = kept * own
        if own < 1.0 or place < 1.0:
            # over the bend of the fill as far as along the whole curve: no factor serves on both sides
            moved = max(moved, 1.0 if (own < FILLED) != (place < FILLED) else abs(min(place, 1.0) - own))
        if not place > 0.0:
            changes += 1
            sets[c] = False
            _end(film, curve, c)
            pressures[c], fills[c] = pc, 1.0 - curve.drop[c]
        elif place < 1.0:
            curve.s[c] = max(place, LEAST)
            _bend(film, curve, c, pc, pressures, fills)
        else:
            pressures[c] = pc + (p if own == 1.0 and p >= whole else whole * (2.0 * place - 1.0))
            fills[c] = 1.0
            _end(film, curve, c)
    return changes, moved


@njit(cache=True, inline="always")
def _solve(lacks, order, count, width, convected, factors, x):
    """Newton's step x (count,) from what the balances lack."""
    lower, upper, inv_diag, t = factors
    for r in range(count):
        x[r] = -lacks[order[r]]
    if convected:
        solve_transport(t, count, x)
    else:
        L, U = dense_band(lower, count, width), dense_band(upper, count, width)
        solve_lu_one(L, U, inv_diag, count, width, x)


@njit(cache=True, nogil=True)
def solve_on_curve(film, late, b, inverse_step, mass_old, pc, full, curve, order, number, factors, x, P, fill):
    """Newton from a film with the sets ``full``; returns (ok, steps, count, width, convected).

    Parameters
    ----------
    late, b : (n, m) arrays
        ``late`` without the line, which ``film`` gets with it; right-hand side of `exudyn_ehd.film.reynolds.links`.
    full : (n, m) bool array
        Sets of the start, those at the line among them; out: of the film.
    curve : Curve
        Out.
    factors : tuple
        ``lower``, ``upper``, ``inv_diag`` and ``t``.
    film, inverse_step, mass_old, pc, order, number, x, P, fill
        As for `exudyn_ehd.film.cavitation.elrod_adams.solve_elrod`; P and fill are also the start.
    """
    film.late[:] = late
    if inverse_step > 0.0:
        hold_back(film, inverse_step, mass_old)
    curve_terms(film, b, curve)
    place_curve(film, pc, full, curve, P, fill)
    terms, lacks = film_terms(film, inverse_step, mass_old), np.empty(full.shape)
    directions, rest = (flow_direction(film.fx), flow_direction(film.fz)), lacks.reshape(-1)
    count, width, convected, settled = 0, 0, False, False
    for step in range(MOST_STEPS):
        film_balance(P, fill, None, terms, lacks)
        if settled:
            left, sound = 0.0, True
            for r in range(count):
                c = order[r]
                left = max(left, abs(rest[c]))
                sound = sound and fill.reshape(-1)[c] > -LARGEST_DEFICIT
            if left <= BALANCED * _flows(film, terms, curve, pc, P):
                _clip(full, pc, P, fill)
                return sound, step, count, width, convected
        ok, count, width, convected = _factor(
            film, terms, inverse_step, mass_old, pc, full, curve, directions, order, number, factors, x, P, fill
        )
        if not ok:
            return False, step + 1, count, width, convected
        for turn in range(2):
            _solve(rest, order, count, width, convected, factors, x)
            changes, moved = _move(film, terms, pc, full, curve, order, count, x, step, P, fill)
            settled = turn == 0 and changes == 0 and moved <= SETTLED
            if settled or changes > 0 or moved > REUSABLE or turn == 1 or step > PATIENT:
                break
            film_balance(P, fill, None, terms, lacks)
    return False, MOST_STEPS, count, width, convected


def factor_on_curve(s: FilmSystem, line: OilLine, work: Workspace) -> None:
    """Make the factor that of the last solution, of which Newton's method leaves that of the film one step before."""
    if line.exact:
        return
    factors = work.lower, work.upper, work.inv_diag, work.transport
    _, work.count, work.width, work.convected = _factor_solution(
        s.coefficients,
        s.inverse_step,
        s.mass_old,
        s.cavity_pressure,
        work.active,
        line.fields,
        work.order,
        work.number,
        factors,
        work.unknowns,
        s.pressure,
        s.fill,
    )
    line.exact = True


@njit(cache=True, nogil=True)
def _factor_solution(film, inverse_step, mass_old, pc, full, curve, order, number, factors, x, P, fill):
    """`_factor` with the film's own terms."""
    terms, directions = film_terms(film, inverse_step, mass_old), (flow_direction(film.fx), flow_direction(film.fz))
    return _factor(film, terms, inverse_step, mass_old, pc, full, curve, directions, order, number, factors, x, P, fill)


@njit(cache=True)
def _clip(full, pc, P, fill):
    """Take what lies on the other side by rounding back."""
    sets, pressures, fills = full.reshape(-1), P.reshape(-1), fill.reshape(-1)
    for c in range(sets.size):
        if sets[c]:
            pressures[c] = max(pressures[c], pc)
        fills[c] = min(max(fills[c], 0.0), 1.0)
