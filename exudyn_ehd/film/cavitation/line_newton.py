"""Newton's method for a film whose rupture line lies inside its cells; see `exudyn_ehd.film.cavitation.rupture_line`.

Of vertices next to the line the unknown is s, in which the balances are nearly linear, elsewhere the pressure. Set
changes are those of Swift-Stieber's active sets. Between the steps every vertex at the line meets its own balance: its
s follows the neighbours' pressures, however small it is, so that steps with an older factor still converge fast. From a
film close by, its factor leads to where a new one serves to the end; with vertices numbered towards the line, a
changed diagonal or set near it leaves the larger part of the factor as it is, and small changes elsewhere are left to
the steps. Pressures here are those above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.numbering import first_changed_row, number_along
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import FIRST_ROW, Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem, solve_on_active, update_active_set
from exudyn_ehd.film.cavitation.line_steps import (
    PATIENT,
    factor_line,
    join_film,
    lacks,
    line_rows,
    move_film,
    place_line,
    relax_line,
)
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, line_terms

# Steps of a film, or one for each column if these are more: without a coarser grid a line may have as far to go.
MOST_STEPS = 100
# What a step may leave of s and of pressures over the peak. It is about the step itself times the change of s since its
# factor, or times its ratio to the step before. Of the first step with a factor s alone counts: all else is linear.
LEFT_OF_LINE, LEFT, LEFT_AT_ONCE = 1e-12, 1e-14, 1e-13
# The same of pressures from this step on: in some films rounding is more than LEFT.
LATE, LEFT_LATE = 3, 1e-13
# Share of the largest flow that balances may lack before another step follows, in thick films a rounding of the peak.
UNBALANCED = 5e-13
# Steps over the peak that leave more than its rounding: those from other films, far larger ones.
LARGE = 10.0
# Change of s beyond which a new factor is faster; steps with a factor after its first.
REUSABLE, MOST_REUSES = 0.3, 3
# Change of s beyond which vertices at the line follow their neighbours between the steps.
FOLLOWED = 1e-3
# How much slower a step may converge than the one before.
CAREFUL = 3.0
# Share of the balances that a step with the factor of the film before has to leave behind, and that it may leave if
# another one follows. Steps that those that end there take.
USEFUL, APPROACH, MOST_APPROACHES, SETTLED, MOST_LEFT = 0.5, 0.3, 4, 0.01, 3
# Change of s up to which rows in front of all others keep their factor.
KEPT_ROWS = 0.01
# Change of pressures over the peak, by that of s since the factor, up to which it is the solution's: what tangents are
# exact to. Larger values save rows of a factor and leave that error.
EXACT = 1e-13
_NONE = np.int64(0)
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def _size(x, count):
    size = 0.0
    for r in range(count):
        size += abs(x[r])
    return size


@njit(cache=True, fastmath=_FAST)
def _largest(a, b):
    """Largest product of two arrays (k,), four running ones, as one waits for itself."""
    s0 = s1 = s2 = s3 = 0.0
    fours = a.size // 4
    for q in range(fours):
        c = 4 * q
        s0, s1 = max(s0, a[c] * b[c]), max(s1, a[c + 1] * b[c + 1])
        s2, s3 = max(s2, a[c + 2] * b[c + 2]), max(s3, a[c + 3] * b[c + 3])
    for c in range(4 * fours, a.size):
        s0 = max(s0, a[c] * b[c])
    return max(max(s0, s1), max(s2, s3))


@njit(cache=True)
def _balanced(links, p, x, count):
    """Whether what the balances lack, x (count,), is little."""
    b, lack = links[2].reshape(-1), x[:count]
    flow = np.sqrt(_largest(b, b)) + _largest(links[0].reshape(-1), p.reshape(-1))
    return np.sqrt(_largest(lack, lack)) <= UNBALANCED * flow


@njit(cache=True)
def _same_set(active, order, count):
    """Whether these are the vertices of the last factor."""
    free, now, known = active.reshape(-1), 0, 0
    for c in range(free.size):
        now += free[c]
    for r in range(count):
        known += free[order[r]]
    return now == known == count


@njit(cache=True)
def approach_film(links, line, active, factor, last, x, lack, p):
    """Steps with the factor of the film before, as long as the balances hold better behind them: from a film close by
    they lead to where a new factor serves to the end, or to the end itself, which comes back. ``last``: (count, width)
    of that factor; ``lack`` (n, m) of the film, in and out."""
    count, width = last
    order, _, number, band, inv_diag = factor
    s, places, known, free = line[2], line[5], p.reshape(-1), active.reshape(-1)
    relax_line(links, line, active, lack, p)
    join_film(links, line, active, lack, p)
    line_rows(lack, line, number, order, count, active, x)
    size = _size(x, count)
    old = np.empty(known.size), np.empty(s.size), np.empty_like(free), np.empty_like(places)
    for _ in range(MOST_APPROACHES if count > 0 else 0):
        for c in range(s.size):
            old[0][c], old[1][c], old[2][c] = known[c], s[c], free[c]
        for q in range(places[-1]):
            old[3][q] = places[q]
        old[3][-1] = places[-1]
        solve_ldl_one(band, inv_diag, count, width, x)
        in_line, in_film, _, changes = move_film(line, number, order, count, x, np.int64(1), active, p)
        lacks(links, p, lack)
        changes += relax_line(links, line, active, lack, p) + join_film(links, line, active, lack, p)
        line_rows(lack, line, number, order, count, active, x)
        before, size = size, _size(x, count)
        rate = size / before if before > 0.0 else 0.0
        # where only rounding is left steps no longer shrink
        left = min(rate, 1.0)
        if changes == 0 and in_film * left <= LEFT and in_line * left <= LEFT_OF_LINE:
            return _same_set(active, order, count) and _balanced(links, p, x, count)
        if not rate < USEFUL:
            for c in range(s.size):
                known[c], s[c], free[c] = old[0][c], old[1][c], old[2][c]
            for q in range(old[3][-1]):
                places[q] = old[3][q]
            places[-1] = old[3][-1]
            lacks(links, p, lack)
            break
        settled = changes == 0 and in_line <= SETTLED
        if rate > APPROACH or (settled and in_film * rate**MOST_LEFT > LEFT):
            break
    return False


@njit(cache=True)
def solve_line(links, line, fixed, active, factor, last, x, forth, p):
    """The film from the sets and pressures at hand; returns (ok, steps, count, width, peak).

    Without any steps the factor is still that of the film before. ``last``: as for `approach_film`; ``forth``: number
    the columns in theta (1), or against it (-1).
    """
    order, old_order, number, band, inv_diag = factor
    place_line(line, fixed, active, p)
    lack = np.empty(p.shape)
    lacks(links, p, lack)
    if approach_film(links, line, active, factor, last, x, lack, p):
        return True, 0, last[0], last[1], lift(order, last[0], p)
    count, width, changes, once_more = FIRST_ROW, np.int64(1), 1, False
    most = max(MOST_STEPS, p.shape[0])
    for step in range(1, most + 1):
        changes += join_film(links, line, active, lack, p)
        first = count
        if changes > 0:
            old_count, old_width = count, width
            for r in range(old_count):
                old_order[r] = order[r]
            count, width = number_along(active, links[0], forth, _NONE, order, number)
            # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
            first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else FIRST_ROW
        line_rows(lack, line, number, order, count, active, x)
        ok, kept = factor_line(links, line, factor, count, width, first, KEPT_ROWS, 0.0)
        if not ok:
            return False, step, count, width, 0.0
        in_line, in_film, least = 0.0, 0.0, LEFT if step < LATE else LEFT_LATE
        for reuse in range(MOST_REUSES + 1):
            stale = line_rows(lack, line, number, order, count, active, x) if reuse > 0 else kept
            solve_ldl_one(band, inv_diag, count, width, x)
            last_line, last_film = in_line, in_film
            in_line, in_film, changed, changes = move_film(line, number, order, count, x, step, active, p)
            stale = max(stale, changed)
            lacks(links, p, lack)
            if reuse == 0:
                done = in_line * stale <= LEFT_AT_ONCE and in_film * kept <= least and in_film <= LARGE
            else:
                rate = in_line / last_line if last_line > 0.0 else 0.0
                if reuse == 1:
                    rate = max(stale, rate)
                else:
                    rate = min(stale, CAREFUL * max(rate, in_film / last_film if last_film > 0.0 else 0.0))
                done = in_film * rate <= least and in_line * rate <= LEFT_OF_LINE
            if step <= PATIENT and in_line > FOLLOWED:
                changes += relax_line(links, line, active, lack, p)
            if done and changes == 0:
                changes = join_film(links, line, active, lack, p)
                line_rows(lack, line, number, order, count, active, x)
                if changes == 0 and (once_more or _balanced(links, p, x, count)):
                    return True, step, count, width, lift(order, count, p)
                once_more = True
            if changes > 0 or stale > REUSABLE:
                break
    return False, most, count, width, 0.0


@njit(cache=True)
def lift(order, count, p):
    """Pressures that rounding leaves below the cavity's to it; returns the peak."""
    pressures, peak = p.reshape(-1), 0.0
    for r in range(count):
        c = order[r]
        pressures[c] = max(pressures[c], 0.0)
        peak = max(peak, pressures[c])
    return peak


@njit(cache=True, nogil=True)
def find_line(links, fixed, pc, forth, is_known, line, active, factor, last, x, P):
    """The film from ``active``, if it ``is_known`` also from its pressures P; returns as `solve_line`.

    ``pc``: the cavity's pressure, of which P is no difference.
    """
    (kx, kz, b), (order, old_order, number, band, inv_diag) = links, factor
    f, s, known, free, pressures = line[0], line[2], fixed.reshape(-1), active.reshape(-1), P.reshape(-1)
    line_terms(kx, b, fixed, line)
    if not f.any():
        # in a film at rest pressures that are left over lead nowhere
        is_known = False
        for c in range(f.size):
            free[c] = not known[c]
    taken = 0
    while True:
        if not is_known:
            # the film without its line, and who would leave it
            for c in range(f.size):
                s[c] = 1.0
                if not (free[c] | known[c]):
                    pressures[c] = pc
            solve_on_active(kx, kz, b, active, order, old_order, 0, 0, number, band, inv_diag, x, P)
            update_active_set(kx, kz, b, fixed, pc, active, P)
            taken, last = taken + 1, (_NONE, _NONE + 1)
        above = P - pc
        ok, steps, count, width, peak = solve_line(links, line, fixed, active, factor, last, x, forth, above)
        taken += steps
        if ok or not is_known:
            break
        # a start from another state can mislead where the film itself is benign
        is_known = False
        for c in range(f.size):
            free[c] = not known[c]
    found = above.reshape(-1)
    for c in range(f.size):
        if not known[c]:
            pressures[c] = found[c] + pc
    return ok, taken, count, width, peak, steps > 0


def solve_with_line(system: FilmSystem, line: RuptureLine, work: Workspace) -> tuple[bool, int]:
    """Solve from ``work.active``, and from the last film's pressures if ``work.known``; returns (ok, steps)."""
    y, is_known = system, work.warm and work.known
    # the line lies where the flow leads
    forth = 1 if y.fx[-1, y.fx.shape[1] // 2] >= 0.0 else -1
    last = (work.count, work.width) if is_known else (0, 1)
    work.known, steps, work.count, work.width, line.peak, line.own_links = find_line(
        (y.kx, y.kz, y.b),
        y.fixed,
        y.cavity_pressure,
        forth,
        is_known,
        line.fields,
        work.active,
        work.factor,
        last,
        work.unknowns,
        y.pressure,
    )
    line.exact = False
    return work.known, steps


def refine_factor(system: FilmSystem, line: RuptureLine, work: Workspace) -> None:
    """Make the factor that of the last solution, where it is that of a film close by."""
    if line.exact:
        return
    first = work.count if line.own_links else FIRST_ROW
    links = system.kx, system.kz, system.b
    refine_line(links, line.fields, work.factor, work.count, work.width, first, line.peak)
    line.own_links = line.exact = True


@njit(cache=True, nogil=True)
def refine_line(links, line, factor, count, width, first, peak):
    """Factor of a solution; rows before ``first`` whose diagonals are its own to rounding stay."""
    _, k, s, _, _, places, _, share = line
    rows = factor[2].reshape(-1)
    for r in range(count):
        share[r] = 0.0
    for q in range(places[-1]):
        c = places[q]
        share[rows[c]] = k[c] * (1.0 - s[c]) / s[c]
    factor_line(links, line, factor, count, width, first, EXACT, peak)
