"""Linear film on given vertices, and mean pressures up to a rupture line inside the cells, for loads.

Gümbel's condition clips the linear film of all vertices at the cavity pressure. A film of Swift and Stieber without
pressure flow in theta (short bearing) consists of columns that are independent of each other. The pressure of a column
is proportional to its source, which changes sign between a full and a ruptured column. So the pressures p are
continued into a ruptured vertex of the next column by the negative pressure that its negative source would cause,

    u = -r / D,    D = k dz_below dz_above / (z_below z_above).

Here ``r = A p - b >= 0`` is the multiplier of the vertex, and k the sum of its two conductances in z. dz_below and
dz_above are the lengths of these links, z_below and z_above the distances to both ends. D is the stiffness of a column
with a constant source per area, whose pressure is a parabola over z. `mean_in_cells` takes the zero of the straight
line from p to u as rupture line. It does so with the linear film of Gümbel's condition as well, which gives the same
result for an aligned journal. u is zero where a vertex becomes active, so that forces are continuous in the motion of a
tilted journal too.

For derivatives these u are additional unknowns after those of the film, with the balances ``D u + r = 0``. p and u are
pressures above the cavity's.

Symbols: P pressure, pc cavity pressure, scaled.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.sparse import csr_matrix

from exudyn_ehd.film.banded.factors import assemble_band, factor_band, number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl_one
from exudyn_ehd.film.banded.workspace import Workspace, dense_band
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.balance import linear_residual
from exudyn_ehd.film.reynolds.gap import Gradients
from exudyn_ehd.film.reynolds.links import LinkFlux


@njit(cache=True, nogil=True)
def solve_linear(links, active, matrix, x, P):
    """Solve for the pressures P (n, m) of the ``active`` vertices, for given P of all others; returns (ok, number of
    unknowns, half-bandwidth).

    Parameters
    ----------
    links : (kx, kz, b)
        Conductances and right-hand side.
    active : (n, m) bool array
        Vertices with unknowns.
    matrix : tuple of arrays
        Buffers `exudyn_ehd.film.banded.workspace.Workspace.symmetric`.
    x : (n m,) array
        Right-hand side and solution.
    """
    (kx, kz, _), (order, number, _, upper, inv_diag, _, _) = links, matrix
    count, width = number_cells(active, kx, order, number)
    band = dense_band(upper, count, width)
    assemble_band(kx, kz, number, order, count, width, band)
    if not factor_band(band, count, width, inv_diag):
        return False, count, width
    pressures, residual = P.reshape(-1), np.empty(P.shape)
    for r in range(count):
        pressures[order[r]] = 0.0
    linear_residual(links, P, residual)
    rest = residual.reshape(-1)
    for r in range(count):
        x[r] = rest[order[r]]
    solve_ldl_one(band, inv_diag, count, width, x)
    for r in range(count):
        pressures[order[r]] = x[r]
    return True, count, width


@njit(cache=True)
def clip_pressure(linear, fixed, pc, P_out, active_out):
    """Apply Gümbel's condition: P = max(linear, pc) at free vertices; those that are not clipped become active."""
    n, m = linear.shape
    for i in range(n):
        for j in range(m):
            active_out[i, j] = linear[i, j] >= pc and not fixed[i, j]
            P_out[i, j] = linear[i, j] if fixed[i, j] or active_out[i, j] else pc


@njit(cache=True, inline="always")
def _neighbour_columns(i, linked):
    """Return the columns before and behind column i, -1 where there is no link to it."""
    n = linked.size
    prv, nxt = (i - 1 if i > 0 else n - 1), (i + 1 if i + 1 < n else 0)
    return prv if linked[prv] else -1, nxt if linked[i] else -1


@njit(cache=True)
def mean_in_cells(linear, fixed, linked, pc, active, P_out):
    """Replace P of an ``active`` vertex next to the rupture line by the mean of the linear pressure up to the line.

    Let p and p_other be the pressures of two vertices above and below the cavity pressure, relative to it. The film
    ends in theta at the fraction ``s = p / (p - p_other)`` of the cell. Its integral over the cell is ``p s / 2``
    instead of p / 2. ``linked`` (n,): whether columns have a link to the next one; ``linear``: linear film of Gümbel's
    condition, or continued pressures.
    """
    n, m = linear.shape
    for i in range(n):
        neighbours = _neighbour_columns(i, linked)
        for j in range(m):
            u = pc - linear[i, j]
            if u <= 0.0 or fixed[i, j]:
                continue
            for other in neighbours:
                if other >= 0 and active[other, j]:
                    p = linear[other, j] - pc
                    P_out[other, j] -= 0.5 * p * u / (p + u)


@njit(cache=True)
def _slopes_of_clip(linear, fixed, linked, pc, active, slopes_out):
    """Set derivatives (3, n, m) of P after `mean_in_cells` to the linear pressure at the vertex, before it, behind it.

    They are 0 at clipped vertices; at the line, ``d(p s) = s (2 - s) dp + s^2 dp_other``.
    """
    n, m = linear.shape
    slopes_out[0] = active
    slopes_out[1:] = 0.0
    for i in range(n):
        prv, nxt = _neighbour_columns(i, linked)
        for j in range(m):
            u = pc - linear[i, j]
            if u <= 0.0 or fixed[i, j]:
                continue
            for side, other in ((2, prv), (1, nxt)):
                if other >= 0 and active[other, j]:
                    s = (linear[other, j] - pc) / (linear[other, j] - pc + u)
                    slopes_out[0, other, j] -= 0.5 * (1.0 - s) ** 2
                    slopes_out[side, other, j] = 0.5 * s * s


@njit(cache=True)
def rows_of_linear(linear, fixed, linked, pc, active, number, rows):
    """Convert weights (k, count) of P after `mean_in_cells` to weights of the linear pressure, in place.

    This is the transpose of `pressures_by_linear`. On entry, weights at clipped vertices are 0.
    """
    n, m = linear.shape
    slopes = np.empty((3, n, m))
    _slopes_of_clip(linear, fixed, linked, pc, active, slopes)
    for i in range(n):
        prv, nxt = _neighbour_columns(i, linked)
        for j in range(m):
            whole = slopes[0, i, j] == 1.0 and slopes[1, i, j] == 0.0 and slopes[2, i, j] == 0.0
            if whole or not active[i, j]:
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
    """Derivatives (n m, n m) of P after `mean_in_cells` to the linear pressure."""
    slopes, at = np.empty((3, *active.shape)), np.arange(active.size).reshape(active.shape)
    _slopes_of_clip(linear, fixed, linked, pc, active, slopes)
    columns = np.stack((at, np.roll(at, 1, axis=0), np.roll(at, -1, axis=0)))
    known = slopes != 0.0
    return csr_matrix(
        (slopes[known], (np.broadcast_to(at, slopes.shape)[known], columns[known])), shape=(at.size, at.size)
    )


class ColumnLine(NamedTuple):
    """Rupture line between the columns of one film.

    Attributes
    ----------
    stiffness : (m,) array
        D over k in every row.
    linked : (n,) bool array
        Columns with a link to the next one.
    kz : (n, m) array
        Conductances in z.
    solved, continued : (n, m) arrays
        Pressures that solve the film; the same, with u in the ruptured vertices beside the film.
    """

    stiffness: np.ndarray
    linked: np.ndarray
    kz: np.ndarray
    solved: np.ndarray
    continued: np.ndarray

    def couple(self, work: Workspace, x: np.ndarray, transposed: bool) -> None:
        """Add ``-dr/dp / D`` times the rows of p to the rows of u, in x (count, k); or the ``transposed`` product."""
        couple_columns(self, work.active, work.symmetric, work.count, x, transposed)

    def gradients(self, work: Workspace, pc: float, H: np.ndarray, flux: LinkFlux | None) -> Gradients:
        """Derivatives of ``D u`` to the gaps at fixed u, for the last solution."""
        flow = None if flux is None else (flux.gz, flux.gz_h, flux.gz_v)
        return Gradients(*column_gradients(self, work.active, work.order, work.count, pc, H, flow))


def column_line(grid: FilmGrid, kz: np.ndarray) -> ColumnLine:
    """Return the `ColumnLine` of a film with the conductances kz (n, m) in z."""
    z, links, stiffness = grid.z, np.diff(grid.z), np.zeros(grid.z.size)
    stiffness[1:-1] = links[:-1] * links[1:] / ((z[1:-1] - z[0]) * (z[-1] - z[1:-1]))
    return ColumnLine(stiffness, grid.link_x != 0.0, kz, np.zeros(grid.shape), np.zeros(grid.shape))


@njit(cache=True)
def extend_film(line, b, sets, pc, matrix, size, P):
    """Continue the pressures P (n, m) of a film by u; returns the number of all unknowns.

    P becomes the mean pressures of `mean_in_cells`. The rows of the factor after those of the film hold D alone.

    Parameters
    ----------
    line : `ColumnLine`
    sets : fixed and active vertices
    matrix : `Workspace.symmetric`
    size : (number of the film's unknowns, half-bandwidth)
    """
    (stiffness, linked, kz, solved, u), (fixed, active) = line, sets
    (order, number, _, upper, inv_diag, _, _), (count, width) = matrix, size
    n, m = P.shape
    band = dense_band(upper, n * m, width)
    solved[:] = u[:] = P
    for i in range(n):
        prv, nxt = _neighbour_columns(i, linked)
        for j in range(m):
            if fixed[i, j] or active[i, j] or not ((prv >= 0 and active[prv, j]) or (nxt >= 0 and active[nxt, j])):
                continue
            piled_up = b[i, j] + kz[i, j] * (P[i, j + 1] - pc) + kz[i, j - 1] * (P[i, j - 1] - pc)
            D = stiffness[j] * (kz[i, j] + kz[i, j - 1])
            u[i, j] = pc + piled_up / D
            order[count], number[i, j], inv_diag[count] = i * m + j, count, 1.0 / D
            band[count] = 0.0
            band[count, 0] = D
            count += 1
    mean_in_cells(u, fixed, linked, pc, active, P)
    return count


@njit(cache=True)
def couple_columns(line, active, matrix, count, x, transposed):
    """Add ``-dr/dp`` over D times the film's rows of x (count, k) to the rows of u; ``transposed``: from u to p."""
    (order, number, _, _, inv_diag, _, _), free = matrix, active.reshape(-1)
    numbers, flow = number.reshape(-1), line.kz.reshape(-1)
    for r in range(count):
        c = order[r]
        if free[c]:
            continue
        for near, k in ((c - 1, flow[c - 1]), (c + 1, flow[c])):
            if free[near]:
                a, by = (numbers[near], r) if transposed else (r, numbers[near])
                for q in range(x.shape[1]):
                    x[a, q] += k * inv_diag[r] * x[by, q]


@njit(cache=True)
def column_gradients(line, active, order, count, pc, H, flow):
    """`ColumnLine.gradients`; ``flow``: conductances of the links in z, their derivatives to gap and speed, or None."""
    stiffness, _, kz, _, u = line
    m, found = H.shape[1], 0
    rows, places, by = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64), np.zeros((10, count))
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        if active[i, j]:
            continue
        rows[found], places[found] = r, order[r]
        for q, low in ((3, j), (4, j - 1)):
            part = stiffness[j] * (u[i, j] - pc) * kz[i, low]
            if flow is None:
                by[q, found] = 3.0 * part / (H[i, low] + H[i, low + 1])
            else:
                by[q, found] = 0.5 * part * flow[1][i, low] / flow[0][i, low]
                by[6, found] += part * flow[2][i, low] / flow[0][i, low]
            by[2, found] += by[q, found]
        found += 1
    return rows[:found], places[:found], by[:, :found].copy()
