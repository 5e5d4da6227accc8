"""Fields of a bore that is symmetric about its mid-plane, folded into even and odd halves.

With z -> -z the rows of a grid with m vertices along z mirror each other: row j and row m - 1 - j for j < mirrored = m
// 2; a middle row (m odd) is its own mirror. Shapes that are even or odd in z are known by their rows j < m - mirrored
(even) and j < mirrored (odd), and

    S^T f = S_even^T (f_j + f_mirror) + S_odd^T (f_j - f_mirror),

half the work and half the memory of the whole. ``mirrored = 0`` folds nothing: every shape counts as even and has all m
rows.

Along z a bush moves as its mesh does, by a few polynomials (nine with four quadratic elements, five of them even). With
a basis N of these courses every shape is N C at each column in theta, and fields that meet N first meet C in place of S
in the large products.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.many_sides import TILE
from exudyn_ehd.film.sensitivity.bore_stencil import put_rows

_FAST = {"reassoc", "contract", "nsz", "arcp"}
# Singular values of the shapes' courses along z, over the largest one, that count as rounding.
ROUNDING = 1e-13
# Rows of a column that are combined at once.
BLOCK = 8


def courses(half: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Basis along z and coordinates of half shapes (n rows, k) on n columns in theta.

    Returns
    -------
    basis : (u, >= rows) array
        N^T with zeros behind the rows up to BLOCK; the identity if the shapes have as many courses as rows.
    coordinates : (n u, k) array
        C: shape = N C at every column.
    """
    rows, k = len(half) // n, half.shape[1]
    if not half.size:
        return np.zeros((0, BLOCK)), np.zeros((0, k))
    shapes = half.reshape(n, rows, k)
    directions, sizes, _ = np.linalg.svd(shapes.transpose(1, 0, 2).reshape(rows, n * k), full_matrices=False)
    rank = int(np.count_nonzero(sizes > ROUNDING * sizes[0]))
    along = directions[:, :rank].T if rank < rows else np.eye(rows)
    basis = np.zeros((len(along), max(rows, BLOCK)))
    basis[:, :rows] = along
    return basis, np.ascontiguousarray(along @ shapes).reshape(n * len(along), k)


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
def place_columns(even, odd, order, out):
    """Columns of two matrices (r, a) and (r, b) to the places ``order`` (a + b,) in out (r, a + b)."""
    a = even.shape[1]
    for r in range(out.shape[0]):
        target = out[r]
        for q in range(a):
            target[order[q]] = even[r, q]
        for q in range(odd.shape[1]):
            target[order[a + q]] = odd[r, q]


@njit(cache=True, fastmath=_FAST)
def folded_loads(fields, even, odd, order, out):
    """Every field's S^T f, out (r, k) for fields (r, n, m); vertices without a field cost nothing.

    Parameters
    ----------
    even, odd : (n (m - mirrored), a) and (n mirrored, b) arrays
        Shapes.
    order : (a + b,) int array
        Places of even and odd shapes in the columns of ``out``.
    """
    count, n, m = fields.shape
    a, b = even.shape[1], odd.shape[1]
    mirrored = odd.shape[0] // n
    upper = m - mirrored
    first, second = np.zeros((count, a)), np.zeros((count, b))
    for i in range(n):
        for j in range(upper):
            for k in range(count):
                f = fields[k, i, j]
                g = fields[k, i, m - 1 - j] if j < mirrored else 0.0
                if f == 0.0 and g == 0.0:
                    continue
                row, target, w = even[i * upper + j], first[k], f + g
                for q in range(a):
                    target[q] += w * row[q]
                if j < mirrored:
                    row, target, w = odd[i * mirrored + j], second[k], f - g
                    for q in range(b):
                        target[q] += w * row[q]
    place_columns(first, second, order, out)


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


@njit(cache=True, fastmath=_FAST)
def _fold_column(weight, row, column, m, mirrored, fields, sums_out, differences_out):
    """Transposed stencil times fields (rows, TILE) in a column in theta, folded.

    Parameters
    ----------
    weight, row : (columns m, 5) arrays
        From `transpose_stencil`.
    sums_out, differences_out : (>= m - mirrored, TILE) and (>= mirrored, TILE) arrays
        ``differences_out`` without rows if the odd half is not wanted.
    """
    X = fields
    for j in range(m - mirrored):
        v = column * m + j
        a0, a1, a2, a3, a4 = weight[v, 0], weight[v, 1], weight[v, 2], weight[v, 3], weight[v, 4]
        i0, i1, i2, i3, i4 = row[v, 0], row[v, 1], row[v, 2], row[v, 3], row[v, 4]
        if j >= mirrored:
            for q in range(TILE):
                a = a0 * X[i0, q] + a1 * X[i1, q] + a2 * X[i2, q] + a3 * X[i3, q] + a4 * X[i4, q]
                sums_out[j, q] = a
            continue
        v = column * m + m - 1 - j
        b0, b1, b2, b3, b4 = weight[v, 0], weight[v, 1], weight[v, 2], weight[v, 3], weight[v, 4]
        k0, k1, k2, k3, k4 = row[v, 0], row[v, 1], row[v, 2], row[v, 3], row[v, 4]
        if differences_out.shape[0] == 0:
            for q in range(TILE):
                a = a0 * X[i0, q] + a1 * X[i1, q] + a2 * X[i2, q] + a3 * X[i3, q] + a4 * X[i4, q]
                b = b0 * X[k0, q] + b1 * X[k1, q] + b2 * X[k2, q] + b3 * X[k3, q] + b4 * X[k4, q]
                sums_out[j, q] = a + b
            continue
        for q in range(TILE):
            a = a0 * X[i0, q] + a1 * X[i1, q] + a2 * X[i2, q] + a3 * X[i3, q] + a4 * X[i4, q]
            b = b0 * X[k0, q] + b1 * X[k1, q] + b2 * X[k2, q] + b3 * X[k3, q] + b4 * X[k4, q]
            sums_out[j, q] = a + b
            differences_out[j, q] = a - b


@njit(cache=True, fastmath=_FAST)
def _combine(basis, rows, known, first, out):
    """``basis rows`` for a basis (u, >= BLOCK) of ``known`` rows among (>= BLOCK, TILE), to row ``first`` on of out."""
    if len(basis) == known:  # the identity
        for s in range(known):
            for q in range(TILE):
                out[first + s, q] = rows[s, q]
        return
    for s in range(len(basis)):
        c, t = basis[s], first + s
        a0, a1, a2, a3, a4, a5, a6, a7 = c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]
        for q in range(TILE):
            a = a0 * rows[0, q] + a1 * rows[1, q] + a2 * rows[2, q] + a3 * rows[3, q]
            out[t, q] = a + a4 * rows[4, q] + a5 * rows[5, q] + a6 * rows[6, q] + a7 * rows[7, q]
        for j in range(BLOCK, c.size):
            a0 = c[j]
            for q in range(TILE):
                out[t, q] += a0 * rows[j, q]


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


@njit(cache=True)
def fold_adjoints(weight, row, shape, mirrored, along_even, along_odd, fields):
    """Transposed stencil of `stencil_by_vertices` times fields, folded, in the bases along z.

    Parameters
    ----------
    weight, row : (columns m, 5) arrays
    shape : (n, m)
        Of the grid.
    mirrored : int
    along_even, along_odd : (u, .) and (v, .) arrays
        See `courses`.
    fields : (rows, TILE) array
        At the unknowns: one tile, see `make_tiles`.

    Returns
    -------
    even, odd : (columns u, TILE) and (columns v, TILE) arrays
    """
    m, u, v = shape[1], len(along_even), len(along_odd)
    columns = len(weight) // m
    even, odd = np.empty((columns * u, TILE)), np.empty((columns * v, TILE))
    # a basis reaches as far as its rows; what lies behind these is zero
    sums, differences = np.zeros((along_even.shape[1], TILE)), np.zeros((along_odd.shape[1] if v else 0, TILE))
    for c in range(columns):
        _fold_column(weight, row, c, m, mirrored, fields, sums, differences)
        _combine(along_even, sums, m - mirrored, c * u, even)
        _combine(along_odd, differences, mirrored, c * v, odd)
    return even, odd


@njit(cache=True, fastmath=_FAST)
def folded_displacements(even, odd, order, q, q_t, place_out, rate_out):
    """S q and S q_t (n, m); shapes as in `folded_loads`, whose places in q and q_t (a + b,) are ``order``."""
    n, m = place_out.shape
    a, mirrored = even.shape[1], odd.shape[0] // n
    upper = m - mirrored
    turned, turned_t = q[order], q_t[order]
    q0, r0, q1, r1 = turned[:a], turned_t[:a], turned[a:], turned_t[a:]
    for i in range(n):
        for j in range(upper):
            row, place, rate = even[i * upper + j], 0.0, 0.0
            for c in range(row.size):
                place += row[c] * q0[c]
                rate += row[c] * r0[c]
            if j < mirrored:
                row, place_odd, rate_odd = odd[i * mirrored + j], 0.0, 0.0
                for c in range(row.size):
                    place_odd += row[c] * q1[c]
                    rate_odd += row[c] * r1[c]
                place_out[i, m - 1 - j], rate_out[i, m - 1 - j] = place - place_odd, rate - rate_odd
                place += place_odd
                rate += rate_odd
            place_out[i, j], rate_out[i, j] = place, rate


@njit(cache=True, fastmath=_FAST)
def folded_rows(even, odd, n, m, places, weight, first, out):
    """Rows of S at flat vertices ``places``, times ``weight``, (count,) each, to the tiles' columns from ``first`` on.

    Even shapes first; shapes as in `folded_loads` on an (n, m) grid.
    """
    mirrored = odd.shape[0] // n
    upper = m - mirrored
    rows, factors = np.empty((2, places.size), dtype=np.int64), np.empty((2, places.size))
    for r in range(places.size):
        i = places[r] // m
        j = places[r] - i * m
        own = j if j < upper else m - 1 - j
        rows[0, r], factors[0, r] = i * upper + own, weight[r]
        # the middle of an odd shape is zero
        known = own < mirrored
        rows[1, r] = i * mirrored + own if known else 0
        factors[1, r] = (weight[r] if j < upper else -weight[r]) if known else 0.0
    put_rows(even, rows[0], factors[0], first, out)
    put_rows(odd, rows[1], factors[1], first + even.shape[1], out)
