"""Banded L D L^T of the film's symmetric systems.

Storage: ``band[r, d] = A[r, r + d]`` with zeros behind the bandwidth, so that four pivots and vectors may read past it.
Factor: ``A = U^T D^-1 U`` with ``U = D L^T`` stored in place of ``band`` and ``inv_diag = 1 / diag(U)``.

Symbols: n columns (theta), m rows (z), w half-bandwidth, kx / kz conductances of the links (i, j)-(i+1, j) and
(i, j)-(i, j+1).
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lanes import subtract_four_lanes, subtract_lanes
from exudyn_ehd.film.banded.workspace import PAD

_FAST = {"contract", "nsz", "arcp"}
_unsigned = np.uint64
_0, _1, _2, _3, _4 = (_unsigned(k) for k in range(5))


@njit(cache=True)
def assemble_band(kx, kz, number, order, count, width, first, band_out):
    """Fill the upper band of the active cells' matrix, rows from ``first`` on, without links longer than ``width``.

    Nothing flows over the last row's links in z. Flat unsigned indices need no check of their sign.
    """
    n, m = number.shape
    along, across, places, flat = kx.reshape(-1), kz.reshape(-1), number.reshape(-1), band_out.reshape(-1)
    size, rows, stride = _unsigned(n * m), _unsigned(m), _unsigned(band_out.shape[1])
    wide = _unsigned(min(width + 1 + PAD, band_out.shape[1]))
    for r in range(first, count):
        c, row = _unsigned(order[r]), _unsigned(r) * stride
        # links to rows above come from below
        for q in range(row, row + wide):
            flat[q] = 0.0
        before, on = c - _1 if c > _0 else size - _1, c + _1 if c + _1 < size else _0
        prv, nxt = c - rows if c >= rows else c + size - rows, c + rows if c + rows < size else c + rows - size
        flat[row] += along[prv] + along[c] + across[before] + across[c]
        b = places[on]
        if b > r:
            flat[row + _unsigned(b - r)] -= across[c]
        b = places[nxt]
        if b > r and b - r <= width:
            flat[row + _unsigned(b - r)] -= along[c]
        elif first <= b < r and r - b <= width:
            flat[_unsigned(b) * stride + _unsigned(r - b)] -= along[c]


@njit(cache=True, fastmath=_FAST)
def factor_band(band, count, width, first, inv_diag_out):
    """Factor in place, four pivots at a time; returns False if a pivot is not positive.

    Rows below ``first`` (a multiple of 4) are factored already and stay; those from it on hold the matrix. The
    operations on every row, and so its bits, are the same as for ``first = 0``.
    """
    flat, stride, w, size = band.reshape(-1), _unsigned(band.shape[1]), _unsigned(width), _unsigned(count)
    begin, changed = _unsigned(max(0, first - width - 4) // 4 * 4), _unsigned(first)
    for block in range((count + 3) // 4 - int(begin) // 4):
        k = begin + _4 * _unsigned(block)
        if k >= changed and not _factor_four(flat, stride, k, min(_4, size - k), w, inv_diag_out):
            return False
        row0 = k * stride
        row1, row2, row3 = row0 + stride, row0 + _2 * stride, row0 + _3 * stride
        for i in range(max(k + _4, changed), min(size, k + _4 + w)):
            d = i - k - _3
            p0, p1, p2, p3 = row0 + d + _3, row1 + d + _2, row2 + d + _1, row3 + d
            f0, f1 = flat[p0] * inv_diag_out[k], flat[p1] * inv_diag_out[k + _1]
            f2, f3 = flat[p2] * inv_diag_out[k + _2], flat[p3] * inv_diag_out[k + _3]
            own, t = i * stride, _0
            while t <= w - d:
                subtract_four_lanes(flat, own + t, flat, p0 + t, p1 + t, p2 + t, p3 + t, f0, f1, f2, f3)
                t += _4
    return True


@njit(cache=True, fastmath=_FAST)
def _factor_four(flat, stride, k, rows, w, inv_diag_out):
    """Up to four rows from k on among themselves."""
    for q in range(rows):
        row = (k + q) * stride
        if not flat[row] > 0.0:
            return False
        inverse = 1.0 / flat[row]
        inv_diag_out[k + q] = inverse
        for s in range(q + _1, min(rows, q + w + _1)):
            d = s - q
            own, factor, t = (k + s) * stride, flat[row + d] * inverse, _0
            while t <= w - d:
                subtract_lanes(flat, own + t, flat, row + d + t, factor)
                t += _4
    return True
