"""Many right-hand sides at once with a stored band factor, as columns of tiles.

A tile holds TILE right-hand sides; its rows are taken by fours, so that a step of a solve subtracts a 4 x 4 block of the factor times
four known rows from four others, 16 products for 8 rows read and 4 written, in loops of constant length. Coefficients are packed by such
blocks first. Five times faster than side by side (`direct.solve_many`) with full tiles; the loads of an elastic bore need dozens.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}
TILE = 48


@njit(cache=True)
def make_tiles(rows, sides):
    """Tiles (tiles, >= count, TILE) for ``sides`` right-hand sides (count,), the s-th in column s % TILE of tile s // TILE.

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
def _subtract(c, known, x):
    """Subtract the transpose of a block c (16,) times four rows ``known`` from four rows x, both (4 TILE,)."""
    c00, c01, c02, c03 = c[0], c[1], c[2], c[3]
    c10, c11, c12, c13 = c[4], c[5], c[6], c[7]
    c20, c21, c22, c23 = c[8], c[9], c[10], c[11]
    c30, c31, c32, c33 = c[12], c[13], c[14], c[15]
    for q in range(TILE):
        y0, y1, y2, y3 = known[q], known[TILE + q], known[2 * TILE + q], known[3 * TILE + q]
        x[q] -= c00 * y0 + c10 * y1 + c20 * y2 + c30 * y3
        x[TILE + q] -= c01 * y0 + c11 * y1 + c21 * y2 + c31 * y3
        x[2 * TILE + q] -= c02 * y0 + c12 * y1 + c22 * y2 + c32 * y3
        x[3 * TILE + q] -= c03 * y0 + c13 * y1 + c23 * y2 + c33 * y3


@njit(cache=True, fastmath=_FAST)
def _subtract_plain(c, known, x):
    """Subtract a block c (16,) times four rows ``known`` from four rows x, both (4 TILE,)."""
    c00, c01, c02, c03 = c[0], c[1], c[2], c[3]
    c10, c11, c12, c13 = c[4], c[5], c[6], c[7]
    c20, c21, c22, c23 = c[8], c[9], c[10], c[11]
    c30, c31, c32, c33 = c[12], c[13], c[14], c[15]
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
                _subtract(forward[k - b, b], rows[k - b], own)
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
                _subtract_plain(backward[k, b], rows[k + b], own)
            c01, c02, c03, c12, c13, c23 = c[1], c[2], c[3], c[6], c[7], c[11]
            for q in range(TILE):
                y3 = own[3 * TILE + q]
                y2 = own[2 * TILE + q] - c23 * y3
                y1 = own[TILE + q] - c12 * y2 - c13 * y3
                own[q] -= c01 * y1 + c02 * y2 + c03 * y3
                own[TILE + q] = y1
                own[2 * TILE + q] = y2


@njit(cache=True)
def solve_in_tiles(forward, backward, inverse, symmetric, count, width, x):
    """Solve ``A x = b`` with ``A = F^T G`` for every column of tiles x, as of `make_tiles`, in place.

    The other parameters as in `columns.solve_columns`.
    """
    tiles, rows, _ = x.shape
    ahead = pack_blocks(forward, inverse, True, count, width)
    back = ahead if symmetric else pack_blocks(backward, inverse, False, count, width)
    diagonal = np.zeros(rows)
    diagonal[:count] = inverse[:count]
    solve_tiles(ahead, back, diagonal, x.reshape(tiles, rows // 4, 4 * TILE))
