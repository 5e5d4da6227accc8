"""Dozens of right-hand sides at once with a stored band factor, as columns of a matrix or of tiles.

Columns make every inner loop long and contiguous: faster than rows (`substitution`) from some ten right-hand sides on.
A tile holds TILE of them; its rows are taken by fours, so that a step of a solve subtracts a 4 x 4 block of the factor
times four known rows from four others, 16 products for 8 rows read and 4 written, in loops of constant length.
Coefficients are packed by such blocks first. The loads of an elastic bore need dozens of right-hand sides: full tiles
are faster still.
"""

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}
TILE = 48
# numpy's integers, since numba compiles kernels anew for each plain one
_ONE, _FOUR = np.int64(1), np.int64(4)


@njit(cache=True, fastmath=_FAST)
def solve_columns(starts, forward, backward, inverse, symmetric, count, width, x):
    """Solve ``A x = b`` with ``A = F^T G`` for every column of x (count, k), C-contiguous, in place.

    Parameters
    ----------
    starts : (<= k,) int array
        First row of every column that is not zero, ascending; columns behind them are zero.
    forward, backward : (size, >= width + 4) arrays
        Bands of F and G, see `ldl` and `lu`; zeros behind the bandwidth.
    inverse : (size,) array
        1 / diagonal of F.
    symmetric : bool
        G is F with every row times its ``inverse`` (``A = U^T D^-1 U``, F = U); else G has a unit diagonal.
    """
    sides = x.shape[1]
    whole = count - count % 4
    known = 0
    for k in range(0, whole, 4):
        while known < len(starts) and starts[known] < k + 4:
            known += 1
        if known == 0:
            continue
        # whole vectors
        begun = min(known + -known % 4, sides)
        u0, u1, u2, u3 = forward[k], forward[k + 1], forward[k + 2], forward[k + 3]
        x0, x1, x2, x3 = x[k], x[k + 1], x[k + 2], x[k + 3]
        for q in range(begun):
            y0 = x0[q] * inverse[k]
            y1 = (x1[q] - y0 * u0[1]) * inverse[k + 1]
            y2 = (x2[q] - y0 * u0[2] - y1 * u1[1]) * inverse[k + 2]
            x3[q] = (x3[q] - y0 * u0[3] - y1 * u1[2] - y2 * u2[1]) * inverse[k + 3]
            x0[q] = y0
            x1[q] = y1
            x2[q] = y2
        for t in range(min(width, count - 4 - k)):
            a, b, c, d = u0[4 + t], u1[3 + t], u2[2 + t], u3[1 + t]
            target = x[k + 4 + t]
            for q in range(begun):
                target[q] -= a * x0[q] + b * x1[q] + c * x2[q] + d * x3[q]
    for k in range(whole, count):
        own = x[k]
        for q in range(sides):
            own[q] *= inverse[k]
        for d in range(1, min(width, count - 1 - k) + 1):
            u = forward[k, d]
            target = x[k + d]
            for q in range(sides):
                target[q] -= u * own[q]
    _substitute_back(backward, inverse, symmetric, count, width, x)


@njit(cache=True, fastmath=_FAST)
def _substitute_back(backward, inverse, symmetric, count, width, x):
    """The second half of `solve_columns`, four rows at a time."""
    sides = x.shape[1]
    whole = count - count % 4
    i0 = i1 = i2 = i3 = 1.0
    for k in range(count - 1, whole - 1, -1):
        target = x[k]
        for d in range(1, min(width, count - 1 - k) + 1):
            a = backward[k, d] * (inverse[k] if symmetric else 1.0)
            known = x[k + d]
            for q in range(sides):
                target[q] -= a * known[q]
    for k in range(whole - 4, -1, -4):
        if symmetric:
            i0, i1, i2, i3 = inverse[k], inverse[k + 1], inverse[k + 2], inverse[k + 3]
        r0, r1, r2, r3 = backward[k], backward[k + 1], backward[k + 2], backward[k + 3]
        x0, x1, x2, x3 = x[k], x[k + 1], x[k + 2], x[k + 3]
        reach = min(width, count - 4 - k)
        for t in range(0, reach - 1, 2):
            a, b, c, d = i0 * r0[4 + t], i1 * r1[3 + t], i2 * r2[2 + t], i3 * r3[1 + t]
            e, f, g, h = i0 * r0[5 + t], i1 * r1[4 + t], i2 * r2[3 + t], i3 * r3[2 + t]
            y0, y1 = x[k + 4 + t], x[k + 5 + t]
            for q in range(sides):
                z0, z1 = y0[q], y1[q]
                x0[q] -= a * z0 + e * z1
                x1[q] -= b * z0 + f * z1
                x2[q] -= c * z0 + g * z1
                x3[q] -= d * z0 + h * z1
        if reach % 2 == 1:
            a, b, c, d = i0 * r0[3 + reach], i1 * r1[2 + reach], i2 * r2[1 + reach], i3 * r3[reach]
            y0 = x[k + 3 + reach]
            for q in range(sides):
                z0 = y0[q]
                x0[q] -= a * z0
                x1[q] -= b * z0
                x2[q] -= c * z0
                x3[q] -= d * z0
        a, b, c = i0 * r0[1], i0 * r0[2], i0 * r0[3]
        d, e, f = i1 * r1[1], i1 * r1[2], i2 * r2[1]
        for q in range(sides):
            z3 = x3[q]
            z2 = x2[q] - f * z3
            z1 = x1[q] - d * z2 - e * z3
            x0[q] -= a * z1 + b * z2 + c * z3
            x1[q] = z1
            x2[q] = z2


@njit(cache=True)
def make_tiles(rows, sides):
    """Tiles (tiles, >= count, TILE) for ``sides`` right-hand sides: the s-th in column s % TILE of tile s // TILE.

    The first ones are the given rows (r, count); those behind them are undefined, and zero where there is none.
    """
    given, count = rows.shape
    tiles = (sides + TILE - 1) // TILE
    out = np.empty((tiles, (count + 3) // 4 * 4, TILE))
    out[:, count:] = 0.0
    last = sides - TILE * (tiles - 1)
    for r in range(count):
        for q in range(last, TILE):
            out[-1, r, q] = 0.0
    for s in range(given):
        tile, q = s // TILE, s % TILE
        for r in range(count):
            out[tile, r, q] = rows[s, r]
    return out


@njit(cache=True)
def pack_blocks(band, scale, scaled, count, width):
    """Off-diagonal entries of a band, row r times ``scale[r]`` if ``scaled``, by 4 x 4 blocks.

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


@njit(cache=True, fastmath=_FAST)
def _subtract(c, row, column, known, x):
    """x -= C y for four rows of a tile each; entry (i, j) of C is ``c[i * row + j * column]``."""
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


@njit(cache=True, fastmath=_FAST)
def solve_tiles(forward, backward, diagonal, x):
    """Solve ``forward^T diagonal backward`` times unknowns = x for all tiles x (tiles, blocks, 4 TILE) in place.

    ``diagonal`` (4 blocks,) is inverted already; the factors of unit diagonal are packed by `pack_blocks`.
    """
    tiles, blocks, _ = x.shape
    reach = forward.shape[1] - 1
    for tile in range(tiles):
        rows = x[tile]
        for k in range(blocks):
            own, c = rows[k], forward[k, 0]
            for b in range(min(k, reach), 0, -1):
                _subtract(forward[k - b, b], _ONE, _FOUR, rows[k - b], own)
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
                _subtract(backward[k, b], _FOUR, _ONE, rows[k + b], own)
            c01, c02, c03, c12, c13, c23 = c[1], c[2], c[3], c[6], c[7], c[11]
            for q in range(TILE):
                y3 = own[3 * TILE + q]
                y2 = own[2 * TILE + q] - c23 * y3
                y1 = own[TILE + q] - c12 * y2 - c13 * y3
                own[q] -= c01 * y1 + c02 * y2 + c03 * y3
                own[TILE + q] = y1
                own[2 * TILE + q] = y2


@njit(cache=True, nogil=True)
def solve_in_tiles(forward, backward, inverse, symmetric, count, width, x):
    """Solve ``A x = b`` with ``A = F^T G`` for every column of tiles x, as returned by `make_tiles`, in place.

    The other parameters as in `solve_columns`.
    """
    tiles, rows, _ = x.shape
    ahead = pack_blocks(forward, inverse, True, count, width)
    back = ahead if symmetric else pack_blocks(backward, inverse, False, count, width)
    diagonal = np.zeros(rows)
    for r in range(count):
        diagonal[r] = inverse[r]
    solve_tiles(ahead, back, diagonal, x.reshape(tiles, rows // 4, 4 * TILE))
