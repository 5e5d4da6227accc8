"""Stencil of an elastic gap by vertices in place of unknowns, for the columns in theta that it touches."""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.many_sides import TILE

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def number_vertices(places, numbers_out):
    """Unknown of every vertex, -1 where there is none: numbers_out (n, m) for flat vertices ``places`` (count,)."""
    flat = numbers_out.reshape(-1)
    flat[:] = -1
    for r in range(places.size):
        flat[places[r]] = r


@njit(cache=True)
def touched_columns(numbers):
    """First column and number of consecutive columns (cyclic) that hold all unknowns and their neighbours in theta."""
    n, m = numbers.shape
    longest, behind, run = 0, 0, 0
    # twice around: the longest run of columns without unknowns may cross the seam
    for s in range(2 * n):
        i = s % n
        empty = True
        for j in range(m):
            if numbers[i, j] >= 0:
                empty = False
                break
        run = run + 1 if empty else 0
        if longest < run <= n:
            longest, behind = run, (i + 1) % n
    if longest < 3:
        return 0, n
    return (behind + n - 1) % n, n - longest + 2


@njit(cache=True)
def transpose_stencil(weight, numbers, first, columns, weight_out, row_out):
    """Columns of a stencil, by vertices.

    Parameters
    ----------
    weight : (count, 5) array
        Of the unknowns' rows, see `gap_stencil`.
    numbers : (n, m) int array
        Unknown of every vertex, -1 where there is none.
    first, columns : int
        Columns in theta (cyclic) that are wanted.
    weight_out, row_out : (columns m, 5) float and int arrays
        Weights and the unknowns they belong to; 0 and any unknown where there is none.
    """
    n, m = numbers.shape
    for c in range(columns):
        i = (first + c) % n
        prv, nxt = (i + n - 1) % n, (i + 1) % n
        for j in range(m):
            v = c * m + j
            row_out[v, 0], row_out[v, 1], row_out[v, 2] = numbers[i, j], numbers[nxt, j], numbers[prv, j]
            row_out[v, 3] = numbers[i, j + 1] if j + 1 < m else -1
            row_out[v, 4] = numbers[i, j - 1] if j > 0 else -1
            for s in range(5):
                # this vertex is the neighbour behind of the one after it, and so on
                twin = s if s == 0 else (s - 1 ^ 1) + 1
                r = row_out[v, s]
                weight_out[v, s] = weight[r, twin] if r >= 0 else 0.0
                row_out[v, s] = max(r, 0)


@njit(cache=True)
def stencil_by_vertices(weight, places, shape):
    """`transpose_stencil` where it is not empty: first column in theta, weights and unknowns (columns m, 5)."""
    m = shape[1]
    numbers = np.empty(shape, dtype=np.int64)
    number_vertices(places, numbers)
    first, columns = touched_columns(numbers)
    by_vertex, row = np.empty((columns * m, 5)), np.empty((columns * m, 5), dtype=np.int64)
    transpose_stencil(weight, numbers, first, columns, by_vertex, row)
    return first, by_vertex, row


@njit(cache=True, fastmath=_FAST)
def stencil_products(weight, row, fields, out):
    """Transposed stencil times fields.

    Parameters
    ----------
    weight, row : (vertices, 5) arrays
        From `stencil_by_vertices`.
    fields : (rows, TILE) array
        At the unknowns: one tile, see `make_tiles`.
    out : (vertices, TILE) array
    """
    X = fields
    for v in range(len(weight)):
        a0, a1, a2, a3, a4 = weight[v, 0], weight[v, 1], weight[v, 2], weight[v, 3], weight[v, 4]
        i0, i1, i2, i3, i4 = row[v, 0], row[v, 1], row[v, 2], row[v, 3], row[v, 4]
        for q in range(TILE):
            out[v, q] = a0 * X[i0, q] + a1 * X[i1, q] + a2 * X[i2, q] + a3 * X[i3, q] + a4 * X[i4, q]
