"""Newton's method for films of Swift and Stieber, ``P >= pc, A P - b - N >= 0`` with a zero in one of them everywhere.

A step solves the linear film of a set of vertices. Without a line inside the cells
(`exudyn_ehd.film.cavitation.rupture_line`) the steps are those of the primal-dual active set method, which for an
M-matrix is Howard's policy iteration (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso,
Zidani, SIAM J. Numer. Anal. 47 (2009) 3001). Of vertices next to a line the unknown is s, in which the balances are
nearly linear, elsewhere it is the pressure. Between the steps vertices at which oil piles up join. With vertices
numbered towards the line, a changed diagonal or set near it leaves the larger part of the factor as it is. Pressures
here are those above the cavity's.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.numbering import first_changed_row, number_along
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import FIRST_ROW, Workspace
from exudyn_ehd.film.cavitation.line_steps import (
    factor_line,
    join_film,
    line_rows,
    move_film,
    place_line,
)
from exudyn_ehd.film.cavitation.rupture_line import RuptureLine, line_terms
from exudyn_ehd.film.cavitation.solve import FAR, LEFT, REUSABLE
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.reynolds.links import lacks

# Steps of a film, or one for each column if these are more: a line may have as far to go.
MOST_STEPS = 100
_NONE = np.int64(0)


@njit(cache=True)
def _newton(links, line, active, factor, x, forth, p):
    """Film from the sets and pressures at hand; returns (ok, steps, count, width)."""
    order, old_order, number, band, inv_diag = factor
    lack = np.empty(p.shape)
    lacks(links, p, lack)
    count, width, changes, done = FIRST_ROW, np.int64(1), 1, False
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
            count, width = number_along(active, links[0], forth, _NONE, order, number)
            # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
            first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else FIRST_ROW
        line_rows(lack, line, order, count, x)
        ok, kept = factor_line(links, line, factor, count, width, first, REUSABLE)
        if not ok:
            return False, step + 1, count, width
        solve_ldl_one(band, inv_diag, count, width, x)
        in_line, in_film, stale, changes = move_film(line, order, count, x, active, p)
        lacks(links, p, lack)
        done = in_line * max(kept, stale) <= LEFT and in_film * kept <= LEFT and in_film <= FAR
    return False, most, count, width


@njit(cache=True, nogil=True)
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
    line : (7, n m) array
        `LineFields`.
    active : (n, m) bool array
        In and out.
    factor : `Workspace.factor`
    x : (n m,) array
        Newton's step.
    """
    f, s, known, free, pressures = line[0], line[2], fixed.reshape(-1), active.reshape(-1), P.reshape(-1)
    line_terms(links[0], links[2], fixed, in_cells, line)
    above, ruptures = np.empty(P.shape), False
    p = above.reshape(-1)
    for c in range(f.size):
        p[c] = pressures[c] - pc
        ruptures |= f[c] > 0.0
    # pressures that are left over in a film at rest lead nowhere
    if is_known and ruptures:
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


@njit(cache=True, nogil=True)
def refine_line(links, line, factor, count, width):
    """Factor of a solution; rows whose diagonals are its own to rounding stay."""
    (order, _, _, _, _), k, s, share = factor, line[1], line[2], line[6]
    for r in range(count):
        c = order[r]
        share[r] = k[c] * (1.0 - s[c]) / s[c]
    factor_line(links, line, factor, count, width, count, LEFT)
