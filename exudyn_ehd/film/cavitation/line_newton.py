"""Newton's method for a film whose rupture line lies inside its cells; see `exudyn_ehd.film.cavitation.rupture_line`.

Of vertices next to the line the unknown is s, in which the balances are nearly linear, elsewhere the pressure. Set
changes are those of Swift-Stieber's active sets. With vertices numbered towards the line, a changed diagonal or set
near it leaves the larger part of the factor as it is. Pressures here are those above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.ldl import assemble_band, factor_band
from exudyn_ehd.film.banded.numbering import first_changed_row, number_along
from exudyn_ehd.film.banded.substitution import solve_ldl
from exudyn_ehd.film.banded.workspace import FIRST_ROW, Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem, solve_on_active, update_active_set
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, line_terms

MOST_STEPS = 100
# A vertex joins with s beyond it: what lies below is the rounding of its neighbours' pressures.
LEAST = 1e-8
# s that a vertex starts from whose pressure says nothing of it.
START = 1e-3
# What a step may leave of s and of pressures over the peak. It is about the step itself times the change of s since its
# factor, or times its ratio to the step before. Of the first step with a factor s alone counts: all else is linear.
LEFT_OF_LINE, LEFT = 1e-10, 1e-15
# Steps after which vertices no longer leave the film at once: two may drive each other out and in again for ever. Of an
# s that would vanish so much is left. Steps after which pressures are the unknowns everywhere: then Newton's method
# can't miss, since balances are concave in them, but it takes longer.
PATIENT, KEPT, SAFE = 8, 0.1, 30
# Steps over the peak that leave more than its rounding: those from other films, far larger ones.
LARGE = 10.0
# Change of s beyond which a new factor is faster; steps with a factor after its first.
REUSABLE, MOST_REUSES = 0.3, 3
# Share of the balances that a step with an older factor has to leave behind.
APPROACH = 0.3
# Change of s up to which a factor counts as that of the solution.
EXACT = 1e-8
# Pressure below the cavity's, over the peak, by which a vertex without a line leaves the film: about 100 roundings.
ROUNDING = 1e-13
_NONE = np.int64(0)
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def lacks(links, p, out):
    """What the balances lack without the line: b less what the pressure flows take away, (n, m)."""
    kx, kz, b = links[0].reshape(-1), links[1].reshape(-1), links[2].reshape(-1)
    n, m = p.shape
    size, x, lack = n * m, p.reshape(-1), out.reshape(-1)
    last = size - m
    along, across = np.empty(size + m), np.empty(size + 1)
    for c in range(last):
        along[m + c] = kx[c] * (x[c] - x[c + m])
    for c in range(m):
        along[c] = along[size + c] = kx[last + c] * (x[last + c] - x[c])
    across[0] = across[size] = 0.0
    for c in range(size - 1):
        # nothing flows over the last row's links
        across[c + 1] = kz[c] * (x[c] - x[c + 1])
    for c in range(size):
        lack[c] = b[c] - along[m + c] + along[c] - across[c + 1] + across[c]


@njit(cache=True)
def join_film(lack, line, fixed, active, p):
    """Vertices at which oil piles up join the film; returns their number. ``lack`` (n, m) of `lacks`."""
    rest, known, free, pressures = lack.reshape(-1), fixed.reshape(-1), active.reshape(-1), p.reshape(-1)
    f, k, s = line[0].reshape(-1), line[1].reshape(-1), line[2].reshape(-1)
    joined = 0
    for c in range(rest.size):
        if free[c] | known[c]:
            continue
        if f[c] > 0.0:
            place = 0.5 + rest[c] / f[c]
            if place > LEAST:
                free[c] = True
                s[c] = min(place, 1.0)
                pressures[c] = 0.5 * f[c] / k[c] * s[c] * s[c]
                joined += 1
        elif rest[c] >= 0.0:
            free[c] = True
            joined += 1
    return joined


@njit(cache=True)
def line_rows(lack, line, order, count, rhs_out):
    """What the balances of the unknowns lack (count,) with the line; its share of their diagonals."""
    rest, share = lack.reshape(-1), line[4]
    f, k, s = line[0].reshape(-1), line[1].reshape(-1), line[2].reshape(-1)
    for r in range(count):
        c = order[r]
        rhs_out[r], own = rest[c], s[c]
        share[r] = 0.0
        if own < 1.0:
            rhs_out[r] += 0.5 * f[c] * (1.0 - own) * (1.0 - own)
            share[r] = k[c] * (1.0 - own) / own


@njit(cache=True)
def factor_line(links, line, factor, count, width, first):
    """Assemble and factor the rows from the first one that changes, which is ``first`` or whose diagonal does."""
    kx, kz, _ = links
    _, _, _, shift, share = line
    order, _, number, band, inv_diag = factor
    row = 0
    while row < first and share[row] == shift[row]:
        row += 1
    first = min(first, row - row % 4)
    assemble_band(kx, kz, number, order, count, width, first, band)
    for r in range(first, count):
        band[r, 0] += share[r]
        shift[r] = share[r]
    return factor_band(band, count, width, first, inv_diag)


@njit(cache=True)
def move_film(line, order, count, steps, taken, active, p):
    """Take a step, the one that is ``taken`` after so many.

    Returns
    -------
    in_line, in_film : float
        Largest change of an s, and of a pressure over the peak.
    left : int
        Number of vertices that leave the film.
    """
    f, k, s, _, _ = line
    sources, conductances, places, pressures, free = (
        f.reshape(-1),
        k.reshape(-1),
        s.reshape(-1),
        p.reshape(-1),
        active.reshape(-1),
    )
    in_line, step, peak, left = 0.0, 0.0, 0.0, 0
    kept = KEPT if taken > PATIENT else 0.0
    for r in range(count):
        c = order[r]
        new = pressures[c] + steps[r]
        if sources[c] > 0.0:
            curve, own = sources[c] / conductances[c], places[c]
            place = np.sqrt(2.0 * max(new, 0.0) / curve)
            if own < 1.0 and taken <= SAFE:
                place = own + steps[r] / (curve * own)
            if own > LEAST and place < kept * own:
                # on its way out, whatever little it moves
                place, in_line = kept * own, 1.0
            place = max(place, 0.0)
            if place < 1.0:
                new = 0.5 * curve * place * place
            elif own < 1.0:
                new = max(new, 0.5 * curve)
            place = min(place, 1.0)
            in_line = max(in_line, abs(place - own))
            if not place > 0.0:
                free[c] = False
                left += 1
                new, place = 0.0, 1.0
            places[c] = place
        step = max(step, abs(new - pressures[c]))
        pressures[c] = new
        peak = max(peak, abs(new))
    for r in range(count):
        c = order[r]
        if free[c] and pressures[c] < -ROUNDING * peak:
            free[c] = False
            pressures[c] = 0.0
            left += 1
    return in_line, step / peak if peak > 0.0 else 0.0, left


@njit(cache=True)
def place_line(line, fixed, active, p):
    """s of all vertices from the last film's, or from their pressures."""
    f, k, s, _, _ = line
    n, m = f.shape
    for i in range(n):
        for j in range(m):
            own = 1.0
            if fixed[i, j]:
                active[i, j] = False
            elif not active[i, j]:
                p[i, j] = 0.0
            elif f[i, j] > 0.0:
                curve = f[i, j] / k[i, j]
                own = s[i, j] if s[i, j] < 1.0 else np.sqrt(2.0 * max(p[i, j], 0.0) / curve)
                own = max(own, START)
                if own < 1.0:
                    p[i, j] = 0.5 * curve * own * own
                own = min(own, 1.0)
            s[i, j] = own


@njit(cache=True)
def _same_set(active, order, count):
    """Whether these are the vertices of the last factor."""
    free, now, known = active.reshape(-1), 0, 0
    for c in range(free.size):
        now += free[c]
    for r in range(count):
        known += free[order[r]]
    return now == known == count and count > 0


@njit(cache=True)
def approach_film(links, line, active, factor, last, x, p):
    """A step with the factor of the film before, if the balances hold better behind it: from a film close by it leads
    to where a new factor serves to the end. ``last``: (count, width) of that factor."""
    count, width = last
    order, _, _, band, inv_diag = factor
    if not _same_set(active, order, count):
        return
    lack, s = np.empty(p.shape), line[2]
    known, places, free = p.reshape(-1), s.reshape(-1), active.reshape(-1)
    old = known.copy(), places.copy(), free.copy()
    lacks(links, p, lack)
    line_rows(lack, line, order, count, x)
    before = np.abs(x[:count]).sum()
    solve_ldl(band, inv_diag, count, width, x.reshape(1, x.size))
    _, _, left = move_film(line, order, count, x, 1, active, p)
    lacks(links, p, lack)
    line_rows(lack, line, order, count, x)
    if left > 0 or not np.abs(x[:count]).sum() < APPROACH * before:
        for c in range(known.size):
            known[c], places[c], free[c] = old[0][c], old[1][c], old[2][c]


@njit(cache=True)
def solve_line(links, line, fixed, active, factor, last, x, forth, p):
    """The film from the sets and pressures at hand; returns (ok, steps, count, width, whether the factor is exact).

    ``last``: as for `approach_film`; ``forth``: number the columns in theta (1), or against it (-1).
    """
    order, old_order, number, _, _ = factor
    place_line(line, fixed, active, p)
    approach_film(links, line, active, factor, last, x, p)
    count, width, changes = FIRST_ROW, np.int64(1), 1
    lack = np.empty(p.shape)
    for step in range(1, MOST_STEPS + 1):
        lacks(links, p, lack)
        joined = join_film(lack, line, fixed, active, p)
        if joined > 0:
            lacks(links, p, lack)
        changes += joined
        first = count
        if changes > 0:
            old_count, old_width = count, width
            for r in range(old_count):
                old_order[r] = order[r]
            count, width = number_along(active, links[0], forth, _NONE, order, number)
            # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
            first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else FIRST_ROW
        line_rows(lack, line, order, count, x)
        if not factor_line(links, line, factor, count, width, first):
            return False, step, count, width, False
        solve_ldl(factor[3], factor[4], count, width, x.reshape(1, x.size))
        moved, in_film, changes = move_film(line, order, count, x, step, active, p)
        done, last_line = moved * moved <= 10.0 * LEFT and in_film <= LARGE, moved
        for _ in range(MOST_REUSES):
            if done or changes > 0 or moved > REUSABLE:
                break
            lacks(links, p, lack)
            line_rows(lack, line, order, count, x)
            solve_ldl(factor[3], factor[4], count, width, x.reshape(1, x.size))
            in_line, in_film, changes = move_film(line, order, count, x, step, active, p)
            moved += in_line
            rate = max(moved, in_line / last_line if last_line > 0.0 else 0.0)
            done, last_line = in_film * rate <= LEFT and in_line * rate <= LEFT_OF_LINE, in_line
        if changes == 0 and done:
            lacks(links, p, lack)
            changes = join_film(lack, line, fixed, active, p)
            if changes == 0:
                for r in range(count):
                    c = order[r]
                    if p.reshape(-1)[c] < 0.0:
                        p.reshape(-1)[c] = 0.0
                return True, step, count, width, moved <= EXACT
    return False, MOST_STEPS, count, width, False


def solve_with_line(system: FilmSystem, line: RuptureLine, work: Workspace) -> tuple[bool, int]:
    """Solve from ``work.active``, and from the last film's pressures if ``work.warm``; returns (ok, steps)."""
    y, pc, steps = system, system.cavity_pressure, 0
    # the line lies where the flow leads
    forth = 1 if y.fx[-1, y.fx.shape[1] // 2] >= 0.0 else -1
    factor = work.order, work.old_order, work.number, work.band, work.inv_diag
    line_terms(y.kx, y.b, y.fixed, line.f, line.k)
    if not work.warm:
        # the film without its line, and who would leave it
        line.s[:] = 1.0
        solve_on_active(
            y.kx, y.kz, y.b, work.active, work.order, work.old_order, 0, 0, work.number, work.band, work.inv_diag,
            work.unknowns, y.pressure,
        )  # fmt: skip
        update_active_set(y.kx, y.kz, y.b, y.fixed, pc, work.active, y.pressure)
        steps = 1
    p = y.pressure - pc
    last = (work.count, work.width) if steps == 0 else (0, 1)
    ok, count, work.count, work.width, line.exact = solve_line(
        (y.kx, y.kz, y.b), line.fields, y.fixed, work.active, factor, last, work.unknowns, forth, p
    )
    if not ok and work.warm:
        # a start from another state can mislead where the film itself is benign
        work.warm = False
        np.logical_not(y.fixed, out=work.active)
        ok, more = solve_with_line(system, line, work)
        return ok, count + more
    np.copyto(y.pressure, p + pc, where=~y.fixed)
    return ok, steps + count


def refine_factor(system: FilmSystem, line: RuptureLine, work: Workspace) -> None:
    """The factor of the last solution itself, where it is that of a film close by."""
    if line.exact:
        return
    factor = work.order, work.old_order, work.number, work.band, work.inv_diag
    links = system.kx, system.kz, system.b
    # their right-hand sides are not asked for
    line_rows(links[2], line.fields, work.order, work.count, work.unknowns)
    factor_line(links, line.fields, factor, work.count, work.width, work.count)
    line.exact = True
