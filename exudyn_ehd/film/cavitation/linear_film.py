"""Linear film on given vertices, and Gümbel's condition, which cuts it off.

Symbols: P pressure, pc cavity pressure, scaled.
"""

import numpy as np
from numba import njit
from scipy.sparse import csr_matrix

from exudyn_ehd.film.banded.ldl import assemble_band, factor_band
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import FIRST_ROW
from exudyn_ehd.film.cavitation.line_steps import lacks


@njit(cache=True, nogil=True)
def solve_linear(links, active, factor, x, P):
    """Pressures of the ``active`` vertices, from those of all others in P (n, m); returns (ok, count, width).

    Parameters
    ----------
    links : (kx, kz, b)
    active : (n, m) bool array
    factor : tuple of arrays
        `exudyn_ehd.film.banded.workspace.Workspace.factor`.
    x : (n m,) array
        Right-hand side and solution.
    """
    (kx, kz, _), (order, _, number, band, inv_diag) = links, factor
    count, width = number_cells(active, kx, order, number)
    assemble_band(kx, kz, number, order, count, width, FIRST_ROW, band)
    if not factor_band(band, count, width, FIRST_ROW, inv_diag):
        return False, count, width
    pressures, lack = P.reshape(-1), np.empty(P.shape)
    for r in range(count):
        pressures[order[r]] = 0.0
    lacks(links, P, lack)
    rest = lack.reshape(-1)
    for r in range(count):
        x[r] = rest[order[r]]
    solve_ldl_one(band, inv_diag, count, width, x)
    for r in range(count):
        pressures[order[r]] = x[r]
    return True, count, width


@njit(cache=True)
def clip_pressure(linear, fixed, pc, P_out, active_out):
    """Gümbel: P = max(linear, pc) at free vertices; active marks where nothing was cut."""
    n, m = linear.shape
    for i in range(n):
        for j in range(m):
            active_out[i, j] = linear[i, j] >= pc and not fixed[i, j]
            P_out[i, j] = linear[i, j] if fixed[i, j] or active_out[i, j] else pc


@njit(cache=True, inline="always")
def _reach(linear, fixed, pc, i, j, other):
    """Share of the cell from vertex (i, j) to column ``other`` up to where the linear pressure is the cavity's; 1 if it
    stays above, or is prescribed there."""
    if other < 0 or fixed[other, j] or linear[other, j] >= pc:
        return 1.0
    p = linear[i, j] - pc
    return p / (p + (pc - linear[other, j]))


@njit(cache=True, inline="always")
def beside(i, linked):
    """Columns on either side, -1 where a ring is open."""
    n = linked.size
    prv, nxt = (i - 1 if i > 0 else n - 1), (i + 1 if i + 1 < n else 0)
    return prv if linked[prv] else -1, nxt if linked[i] else -1


@njit(cache=True)
def clip_in_cells(linear, fixed, linked, pc, P_out, active_out):
    """Gümbel's condition inside the cells: P of a vertex is the mean of the pressure that is left of the linear one.

    Between a vertex at the pressure p above the cavity's and one below it, the film ends in theta after a share s of
    the cell, ``s = p / (p - p_other)``: its integral there is ``p s / 2`` instead of p / 2. ``linked`` (n,): whether
    columns have a link to the next one.
    """
    clip_pressure(linear, fixed, pc, P_out, active_out)
    mean_in_cells(linear, fixed, linked, pc, active_out, P_out)


@njit(cache=True)
def mean_in_cells(linear, fixed, linked, pc, active, P_out):
    """Write the mean of `clip_in_cells` at the ``active`` vertices; ``linear`` may be any film continued beyond them."""
    n, m = linear.shape
    for i in range(n):
        prv, nxt = beside(i, linked)
        for j in range(m):
            if active[i, j]:
                reach = _reach(linear, fixed, pc, i, j, prv) + _reach(linear, fixed, pc, i, j, nxt)
                P_out[i, j] = pc + 0.5 * reach * (linear[i, j] - pc)


@njit(cache=True)
def _slopes_of_clip(linear, fixed, linked, pc, active, slopes_out):
    """Derivatives (3, n, m) of P to the linear pressure at the vertex itself, before it and behind it.

    Of P as `clip_in_cells` leaves it, ``d(p s) = s (2 - s) dp + s^2 dp_other``; 0 at clipped vertices.
    """
    n, m = linear.shape
    slopes_out[:] = 0.0
    for i in range(n):
        prv, nxt = beside(i, linked)
        for j in range(m):
            if not active[i, j]:
                continue
            for side, other in ((1, prv), (2, nxt)):
                s = _reach(linear, fixed, pc, i, j, other)
                slopes_out[0, i, j] += 0.5 * s * (2.0 - s)
                slopes_out[side, i, j] = 0.5 * s * s if s < 1.0 else 0.0


@njit(cache=True)
def rows_of_linear(linear, fixed, linked, pc, active, number, rows):
    """From weights (k, count) of P as `clip_in_cells` leaves it, none at clipped ones, to those of the linear pressure.

    The transpose of `pressures_by_linear`.
    """
    n, m = linear.shape
    slopes = np.empty((3, n, m))
    _slopes_of_clip(linear, fixed, linked, pc, active, slopes)
    for i in range(n):
        prv, nxt = beside(i, linked)
        for j in range(m):
            if not active[i, j]:
                continue
            r = number[i, j]
            for side, other in ((1, prv), (2, nxt)):
                by = slopes[side, i, j]
                if by != 0.0:
                    for k in range(rows.shape[0]):
                        rows[k, number[other, j]] += by * rows[k, r]
            for k in range(rows.shape[0]):
                rows[k, r] *= slopes[0, i, j]


def pressures_by_linear(
    linear: np.ndarray, fixed: np.ndarray, linked: np.ndarray, pc: float, active: np.ndarray
) -> csr_matrix:
    """Derivatives (n m, n m) of P as `clip_in_cells` leaves it to the linear pressure."""
    slopes, at = np.empty((3, *active.shape)), np.arange(active.size).reshape(active.shape)
    _slopes_of_clip(linear, fixed, linked, pc, active, slopes)
    columns = np.stack((at, np.roll(at, 1, axis=0), np.roll(at, -1, axis=0)))
    known = slopes != 0.0
    return csr_matrix(
        (slopes[known], (np.broadcast_to(at, slopes.shape)[known], columns[known])), shape=(at.size, at.size)
    )
