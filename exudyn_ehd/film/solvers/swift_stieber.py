"""Newton's method for films of Swift and Stieber, ``P >= pc, A P - b - N >= 0`` with a zero in one of them everywhere.

A step solves the linear film of a set of vertices. Without a line inside the cells
(`exudyn_ehd.film.cavitation.rupture_line`) the steps are those of the primal-dual active set method, which for an
M-matrix is Howard's policy iteration (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso,
Zidani, SIAM J. Numer. Anal. 47 (2009) 3001). Of vertices next to a line the unknown is s, in which the balances are
nearly linear, elsewhere it is the pressure. Between the steps vertices at which oil piles up join. With vertices
numbered towards the line, a changed diagonal or set near it leaves the larger part of the factor as it is. Pressures
here are those above the cavity's.

The parts of a step are joining vertices, factor and new state. Symbols as above and in
`exudyn_ehd.film.cavitation.rupture_line`; pressures are those above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.factors import assemble_band, factor_band
from exudyn_ehd.film.banded.numbering import first_changed_row, number_along
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, line_terms
from exudyn_ehd.film.cavitation.states import ROUNDING
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.kernels import I0
from exudyn_ehd.film.reynolds.links import lacks
from exudyn_ehd.film.solvers.newton import EVEN, FAR, LEFT, REUSABLE

# s that a vertex starts from whose pressure says nothing of it; a smaller one costs steps.
START = 1e-3


@njit(cache=True)
def join_film(links, line, active, lack, p):
    """Vertices at which oil piles up join the film; returns their number. ``lack`` (n, m) of `lacks`, in and out.

    At the line they meet their own balances between given neighbours: ``g s^2 / 2 + s = e``.
    """
    kx, kz, rest, free, m = links[0].reshape(-1), links[1].reshape(-1), lack.reshape(-1), active.reshape(-1), p.shape[1]
    f, k, whole, s, limit = line[0], line[1], line[4], line[6], line[9]
    pressures, joined = p.reshape(-1), 0
    for c in range(rest.size):
        if (rest[c] < limit[c]) | free[c]:
            continue
        joined += 1
        free[c] = True
        if f[c] > 0.0:
            excess, g = 0.5 + rest[c] / f[c], (kx[c - m] + kx[c] + kz[c - 1] + kz[c]) / k[c] - 1.0
            s[c] = min(2.0 * excess / (1.0 + np.sqrt(1.0 + 2.0 * g * excess)), 1.0)
            pressures[c] = whole[c] * s[c] * s[c]
    if joined > 0:
        lacks(links, p, lack)
    return joined


@njit(cache=True, inline="always")
def lack_at_line(lack, line, order, count, rhs_out):
    """Write the lack of the unknowns' balances (count,) with the line, and its share of their diagonals."""
    rest, f, k, s, share = lack.reshape(-1), line[0], line[1], line[6], line[11]
    for r in range(count):
        c = order[r]
        short = 1.0 - s[c]
        rhs_out[r] = rest[c] + 0.5 * f[c] * short * short
        share[r] = k[c] * short / s[c]


@njit(cache=True, inline="always")
def factor_line(links, line, factor, count, width, first, kept):
    """Assemble and factor from the first row that changes, which is ``first`` or whose s does, by more than ``kept``
    of itself.

    Returns whether there is a factor, and the largest change over s that it does not know of.
    """
    kx, kz, _ = links
    order, _, number, band, inv_diag = factor
    k, s, shift, share = line[1], line[6], line[10], line[11]
    row, stale = 0, 0.0
    while row < first:
        if share[row] != shift[row]:
            c = order[row]
            over_s = abs(1.0 - k[c] / ((k[c] + shift[row]) * s[c]))
            if over_s > kept:
                break
            stale = max(stale, over_s)
        row += 1
    first = min(first, row - row % 4)
    assemble_band(kx, kz, number, order, count, width, first, band)
    for r in range(first, count):
        band[r, 0] += share[r]
        shift[r] = share[r]
    return factor_band(band, count, width, first, inv_diag), stale


@njit(cache=True)
def move_film(line, order, count, steps, active, p):
    """Take a step.

    Returns
    -------
    in_line, in_film : float
        Largest change of an s, and of a pressure over the peak.
    stale : float
        Largest change of an s since the factor, over s.
    left : int
        Number of vertices that leave the film.
    """
    k, whole, s, shift, pressures, free = line[1], line[4], line[6], line[10], p.reshape(-1), active.reshape(-1)
    in_line = stale = largest = peak = lowest = 0.0
    left = 0
    for r in range(count):
        c = order[r]
        own, new = s[c], pressures[c] + steps[r]
        if own < 1.0:
            place = own + 0.5 * steps[r] / (whole[c] * own)
        else:
            # the line comes into reach
            place = np.sqrt(max(new, 0.0) / whole[c]) if 0.0 < whole[c] > new else 1.0
        if not place > 0.0:
            free[c], s[c], pressures[c] = False, 1.0, 0.0
            left += 1
            continue
        if place < 1.0:
            new = whole[c] * place * place
        elif own < 1.0:
            place, new = 1.0, max(new, whole[c])
        if min(own, place) < 1.0:
            stale = max(stale, abs(1.0 - k[c] / ((k[c] + shift[r]) * place)))
            in_line = max(in_line, abs(place - own))
            s[c] = place
        largest, peak, lowest = max(largest, abs(new - pressures[c])), max(peak, new), min(lowest, new)
        pressures[c] = new
    if lowest < -ROUNDING * peak:
        for r in range(count):
            c = order[r]
            if pressures[c] < -ROUNDING * peak and free[c]:
                free[c] = False
                pressures[c] = 0.0
                left += 1
    return in_line, largest / peak if peak > 0.0 else 0.0, stale, left


@njit(cache=True)
def place_line(line, fixed, active, p):
    """s of all vertices from the last film's, or from their pressures."""
    whole, s, known, free, pressures = line[4], line[6], fixed.reshape(-1), active.reshape(-1), p.reshape(-1)
    for c in range(s.size):
        own = s[c]
        s[c] = 1.0
        if known[c]:
            free[c] = False
        elif not free[c]:
            pressures[c] = 0.0
        elif whole[c] > 0.0 and (own < 1.0 or pressures[c] < whole[c]):
            if not own < 1.0:
                own = np.sqrt(max(pressures[c], 0.0) / whole[c])
            s[c] = max(own, START)
            pressures[c] = whole[c] * s[c] * s[c]


# Steps of a film, or one for each column if these are more: a line may have as far to go.
MOST_STEPS = 100


@njit(cache=True, inline="always")
def _newton(links, line, active, factor, x, forth, p):
    """Film from the sets and pressures at hand; returns (ok, steps, count, width)."""
    order, old_order, number, band, inv_diag = factor
    lack = np.empty(p.shape)
    lacks(links, p, lack)
    count, width, changes, done = I0, np.int64(1), 1, False
    most = max(MOST_STEPS, p.shape[0])
    for step in range(most + 1):
        changes += join_film(links, line, active, lack, p)
        if done and changes == 0:
            return True, step, count, width
        first = count
        if changes > 0:
            old_count, old_width = count, width
            for r in range(old_count):
                old_order[r] = order[r]
            count, width = number_along(active, links[0], forth, I0, order, number)
            # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
            first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else I0
        lack_at_line(lack, line, order, count, x)
        ok, kept = factor_line(links, line, factor, count, width, first, REUSABLE)
        if not ok:
            return False, step + 1, count, width
        solve_ldl_one(band, inv_diag, count, width, x)
        in_line, in_film, stale, changes = move_film(line, order, count, x, active, p)
        lacks(links, p, lack)
        done = in_line * max(kept, stale) <= LEFT and in_film * kept <= LEFT and in_film <= FAR
    return False, most, count, width


@njit(cache=True, nogil=True, inline="always")
def find_film(links, fixed, pc, in_cells, forth, is_known, line, active, factor, x, P):
    """Film from the set ``active``, if it ``is_known`` also from the pressures P; returns (ok, steps, count, width).

    Parameters
    ----------
    links : (kx, kz, b)
    pc : float
        The cavity's pressure, of which P is no difference.
    in_cells : bool
        Whether the line lies inside the cells, else on the vertices.
    forth : int
        1: the columns are numbered in theta, -1: against it.
    is_known : bool
        Whether P are pressures of a film close by.
    line : (12, n m) array
        `RuptureLine.block`.
    active : (n, m) bool array
        In and out.
    factor : `Workspace.factor`
    x : (n m,) array
        Newton's step.
    """
    f, s, known, free, pressures = line[0], line[6], fixed.reshape(-1), active.reshape(-1), P.reshape(-1)
    line_terms(links[0], links[2], fixed, in_cells, line)
    above, even = np.empty(P.shape), EVEN * np.abs(links[2]).max()
    p = above.reshape(-1)
    for c in range(f.size):
        p[c] = pressures[c] - pc
    # pressures that are left over lead nowhere in a film at rest, or where nothing but round-off drives it
    if is_known and f.max() > even:
        place_line(line, fixed, active, above)
    else:
        for c in range(f.size):
            s[c] = 1.0
            free[c] &= not known[c]
            if not known[c]:
                p[c] = 0.0
    ok, steps, count, width = _newton(links, line, active, factor, x, forth, above)
    for c in range(f.size):
        if not known[c]:
            # rounding may leave pressures below the cavity's
            pressures[c] = max(p[c], 0.0) + pc
    return ok, steps, count, width


def solve_rupturing(system: FilmSystem, line: RuptureLine, work: Workspace, in_cells: bool) -> tuple[bool, int]:
    """`find_film` of a system, from its last film if ``work.warm``, else from a full one: (ok, steps)."""
    y = system
    # the line lies where the flow leads
    forth = 1 if y.fx[-1, y.fx.shape[1] // 2] >= 0.0 else -1
    if not work.warm:
        np.logical_not(y.fixed, out=work.active)
    work.warm, steps, work.count, work.width = find_film(
        (y.kx, y.kz, y.b), y.fixed, y.cavity_pressure, in_cells, forth, work.warm, line.block,
        work.active, work.factor, work.unknowns, y.pressure,
    )  # fmt: skip
    work.exact = False
    return work.warm, steps


def refine_factor(system: FilmSystem, line: RuptureLine, work: Workspace) -> None:
    """Make the factor that of the last solution, where it is that of a film close by."""
    refine_line((system.kx, system.kz, system.b), line.block, work.factor, work.count, work.width)


@njit(cache=True, nogil=True, inline="always")
def refine_line(links, line, factor, count, width):
    """Factor of a solution; rows whose diagonals are its own to rounding stay."""
    (order, _, _, _, _), k, s, share = factor, line[1], line[6], line[11]
    for r in range(count):
        c = order[r]
        share[r] = k[c] * (1.0 - s[c]) / s[c]
    factor_line(links, line, factor, count, width, count, LEFT)
