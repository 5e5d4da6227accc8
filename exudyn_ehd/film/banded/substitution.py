"""Forward and back substitution with a stored band factor: a few right-hand sides as rows, or dozens as columns.

``A = F^T G`` with the rows of F in ``forward`` and those of G in ``backward``, stored as in `factors`. F, G or both
have the diagonal ``1 / inverse``; the other one has ones on its diagonal:

* `solve_lu`: F^T = L with ones, G = U;
* `solve_lu_transposed`: F^T = U^T, G = L^T with ones;
* `solve_ldl`: ``A = U^T D^-1 U``, F = G = U; the back substitution starts from D times the result of the forward one.

Four right-hand sides are solved at once. All indices are flat and unsigned: slices and sign checks would take longer
than the arithmetic of short rows.

Dozens of right-hand sides, as columns of a matrix
--------------------------------------------------
A tile holds TILE of them. Its rows are processed by fours: a step subtracts a 4 x 4 block of the factor times four
known rows from four others. These are 16 products for 8 rows read and 4 written, in loops of constant length. The
factor is packed into such blocks first. This is faster than right-hand sides as rows from about ten right-hand sides
on. The loads of an elastic bore need dozens; full tiles are faster still.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST, FUSED, I1, I4, NO, U0, U1, U2, YES, unsigned


@njit(cache=True, nogil=True, inline="always")
def solve_ldl(band, inverse, count, width, x):
    """Solve ``A x = b`` with the symmetric factor of `factors.factor_band` for every row of x (k, count), in place."""
    _solve_rows(band, band, YES, YES, inverse, count, width, x)


@njit(cache=True, inline="always")
def solve_ldl_one(band, inverse, count, width, x):
    """Solve ``A x = b`` as `solve_ldl`, for one right-hand side x (count,), in place."""
    _solve_one(band.reshape(-1), band.reshape(-1), band.shape[1], YES, YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu(lower, upper, inverse, count, width, x):
    """Solve ``A x = b`` with the factor of `factors.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(lower, upper, NO, YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu_one(lower, upper, inverse, count, width, x):
    """Solve ``A x = b`` as `solve_lu`, for one right-hand side x (count,), in place."""
    _solve_one(lower.reshape(-1), upper.reshape(-1), upper.shape[1], NO, YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu_transposed(lower, upper, inverse, count, width, x):
    """Solve ``A^T x = b`` with the factor of `factors.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(upper, lower, YES, NO, inverse, count, width, x)


@njit(cache=True)
def _solve_rows(forward, backward, scale_forth, scale_back, inverse, count, width, x):
    """Solve for every row of x (k, count), in place.

    ``scale_forth``, ``scale_back``: whether F and G have the diagonal ``1 / inverse``.
    """
    col, row, stride, own = forward.reshape(-1), backward.reshape(-1), forward.shape[1], np.empty(count)
    fours = x.shape[0] // 4
    for k in range(fours):
        at = 4 * k
        x0, x1, x2, x3 = x[at], x[at + 1], x[at + 2], x[at + 3]
        _solve_four(col, row, stride, scale_forth, scale_back, inverse, count, width, x0, x1, x2, x3)
    for k in range(4 * fours, x.shape[0]):
        for r in range(count):
            own[r] = x[k, r]
        _solve_one(col, row, stride, scale_forth, scale_back, inverse, count, width, own)
        for r in range(count):
            x[k, r] = own[r]


@njit(cache=True, fastmath=FUSED)
def _solve_one(col, row, stride, scale_forth, scale_back, inverse, count, width, x):
    """Solve for one right-hand side x (count,), with the rows of F and G in flat arrays, ``stride`` apart."""
    step, size, w = unsigned(stride), unsigned(count), unsigned(width)
    along = step - U1
    for r in range(size):
        reach = w if w < r else r
        at, k, s, t = r * step - reach * along, r - reach, x[r], 0.0
        while k + U1 < r:
            s -= col[at] * x[k]
            t += col[at + along] * x[k + U1]
            at += along + along
            k += U2
        s -= t
        if k < r:
            s -= col[at] * x[k]
        x[r] = s * inverse[r] if scale_forth else s
    for q in range(size):
        i = size - U1 - q
        own, d, t = i * step, w if w < q else q, 0.0
        s = x[i] * row[own] if scale_forth and scale_back else x[i]
        while d > U1:
            s -= row[own + d] * x[i + d]
            t += row[own + d - U1] * x[i + d - U1]
            d -= U2
        s -= t
        if d > U0:
            s -= row[own + U1] * x[i + U1]
        x[i] = s * inverse[i] if scale_back else s


@njit(cache=True, fastmath=FUSED)
def _solve_four(col, row, stride, scale_forth, scale_back, inverse, count, width, x0, x1, x2, x3):
    """Solve as `_solve_one`, for four right-hand sides at once."""
    step, size, w = unsigned(stride), unsigned(count), unsigned(width)
    along = step - U1
    for r in range(size):
        reach = w if w < r else r
        at, k, s0, s1, s2, s3 = r * step - reach * along, r - reach, x0[r], x1[r], x2[r], x3[r]
        for _ in range(reach):
            f = col[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at += along
            k += U1
        f = inverse[r] if scale_forth else 1.0
        x0[r], x1[r], x2[r], x3[r] = f * s0, f * s1, f * s2, f * s3
    for q in range(size):
        i = size - U1 - q
        own, reach = i * step, w if w < q else q
        f = row[own] if scale_forth and scale_back else 1.0
        s0, s1, s2, s3 = f * x0[i], f * x1[i], f * x2[i], f * x3[i]
        at, k = own + reach, i + reach
        for _ in range(reach):
            f = row[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at -= U1
            k -= U1
        f = inverse[i] if scale_back else 1.0
        x0[i], x1[i], x2[i], x3[i] = f * s0, f * s1, f * s2, f * s3


TILE = 48


@njit(cache=True)
def pack_blocks(band, scale, scaled, count, width):
    """Pack the off-diagonal entries of a band into 4 x 4 blocks, row r times ``scale[r]`` if ``scaled``.

    Returns
    -------
    (blocks, reach + 1, 16) array
        At [K, b, 4 s + t]: entry in row s of block K and column t of block K + b.
    """
    out = np.zeros(((count + 3) // 4, (width + 3) // 4 + 1, 16))
    for r in range(count):
        s, own = r & 3, out[r >> 2]
        factor = scale[r] if scaled else 1.0
        for d in range(1, min(width, count - 1 - r) + 1):
            own[(s + d) >> 2, 4 * s + ((s + d) & 3)] = factor * band[r, d]
    return out


@njit(cache=True, fastmath=FAST)
def _subtract(c, row, column, known, x):
    """Set x -= C y for four rows x and four rows y (``known``) of a tile; entry (i, j) of C is
    ``c[i * row + j * column]``."""
    c00, c01, c02, c03 = c[0], c[column], c[2 * column], c[3 * column]
    c10, c11, c12, c13 = c[row], c[row + column], c[row + 2 * column], c[row + 3 * column]
    c20, c21, c22, c23 = c[2 * row], c[2 * row + column], c[2 * row + 2 * column], c[2 * row + 3 * column]
    c30, c31, c32, c33 = c[3 * row], c[3 * row + column], c[3 * row + 2 * column], c[3 * row + 3 * column]
    for q in range(TILE):
        y0, y1, y2, y3 = known[q], known[TILE + q], known[2 * TILE + q], known[3 * TILE + q]
        x[q] -= c00 * y0 + c01 * y1 + c02 * y2 + c03 * y3
        x[TILE + q] -= c10 * y0 + c11 * y1 + c12 * y2 + c13 * y3
        x[2 * TILE + q] -= c20 * y0 + c21 * y1 + c22 * y2 + c23 * y3
        x[3 * TILE + q] -= c30 * y0 + c31 * y1 + c32 * y2 + c33 * y3


@njit(cache=True, fastmath=FAST)
def _solve_tile(forward, backward, diagonal, rows):
    """Solve ``forward^T D backward x = rows`` for one tile (blocks, 4 TILE), in place.

    ``diagonal`` (4 blocks,): 1 / D; ``forward``, ``backward``: factors of unit diagonal, packed by `pack_blocks`.
    """
    blocks, reach = len(rows), forward.shape[1] - 1
    for k in range(blocks):
        own, c = rows[k], forward[k, 0]
        for b in range(min(k, reach), 0, -1):
            _subtract(forward[k - b, b], I1, I4, rows[k - b], own)
        c01, c02, c03, c12, c13, c23 = c[1], c[2], c[3], c[6], c[7], c[11]
        for q in range(TILE):
            y0 = own[q]
            y1 = own[TILE + q] - c01 * y0
            y2 = own[2 * TILE + q] - c02 * y0 - c12 * y1
            own[3 * TILE + q] -= c03 * y0 + c13 * y1 + c23 * y2
            own[TILE + q] = y1
            own[2 * TILE + q] = y2
    for k in range(blocks - 1, -1, -1):
        own, c, r = rows[k], backward[k, 0], 4 * k
        i0, i1, i2, i3 = diagonal[r], diagonal[r + 1], diagonal[r + 2], diagonal[r + 3]
        for q in range(TILE):
            own[q] *= i0
            own[TILE + q] *= i1
            own[2 * TILE + q] *= i2
            own[3 * TILE + q] *= i3
        for b in range(min(blocks - 1 - k, reach), 0, -1):
            _subtract(backward[k, b], I4, I1, rows[k + b], own)
        c01, c02, c03, c12, c13, c23 = c[1], c[2], c[3], c[6], c[7], c[11]
        for q in range(TILE):
            y3 = own[3 * TILE + q]
            y2 = own[2 * TILE + q] - c23 * y3
            y1 = own[TILE + q] - c12 * y2 - c13 * y3
            own[q] -= c01 * y1 + c02 * y2 + c03 * y3
            own[TILE + q] = y1
            own[2 * TILE + q] = y2


@njit(cache=True, nogil=True)
def solve_columns(lower, upper, inverse, symmetric, count, width, x):
    """Solve ``A x = b`` for every column of x (count, k), in place.

    Parameters
    ----------
    lower, upper : (size, > width) arrays
        Bands of A's factors, see `factors`.
    inverse : (size,) array
        1 / diagonal of ``upper``.
    symmetric : bool
        ``A = U^T D^-1 U`` with ``upper`` alone; else ``A = L U`` with a unit diagonal of L.
    """
    back = pack_blocks(upper, inverse, YES, count, width)
    ahead = back if symmetric else pack_blocks(lower, inverse, NO, count, width)
    blocks = len(ahead)
    diagonal, tile = np.zeros(4 * blocks), np.zeros((blocks, 4 * TILE))
    rows = tile.reshape(4 * blocks, TILE)
    for r in range(count):
        diagonal[r] = inverse[r]
    for start in range(0, x.shape[1], TILE):
        wide = min(TILE, x.shape[1] - start)
        for r in range(count):
            own, given = rows[r], x[r, start : start + wide]
            for q in range(wide):
                own[q] = given[q]
            for q in range(wide, TILE):
                own[q] = 0.0
        _solve_tile(ahead, back, diagonal, tile)
        for r in range(count):
            own, given = rows[r], x[r, start : start + wide]
            for q in range(wide):
                given[q] = own[q]
