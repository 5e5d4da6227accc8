"""Banded L U without pivoting for the film's non-symmetric systems (mass-conserving cavitation, elastic liner).

The matrices are column diagonally dominant with non-positive off-diagonals, or close to it, so that no pivoting is
needed. Storage: ``lower[r, d] = A[r + d, r]`` and ``upper[r, d] = A[r, r + d]``, d = 0 .. w, zeros behind;
``lower[:, 0]`` is not used. After the factorisation ``A = L U`` with unit L: ``lower`` holds L's columns, ``upper`` U's
rows, ``inv_diag = 1 / diag(U)``.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lanes import subtract_four_lanes, subtract_lanes

_FAST = {"contract", "nsz", "arcp"}
_unsigned = np.uint64
_0, _1, _2, _3, _4 = (_unsigned(k) for k in range(5))


@njit(cache=True, fastmath=_FAST)
def factor_lu(lower, upper, count, width, inv_diag_out):
    """Factor in place, four pivots at a time; returns False if a pivot vanishes."""
    low, up, stride = lower.reshape(-1), upper.reshape(-1), _unsigned(upper.shape[1])
    w, size = _unsigned(width), _unsigned(count)
    for block in range((count + 3) // 4):
        k = _4 * _unsigned(block)
        if not _factor_four(low, up, stride, k, min(_4, size - k), w, inv_diag_out):
            return False
        row0 = k * stride
        row1, row2, row3 = row0 + stride, row0 + _2 * stride, row0 + _3 * stride
        for i in range(k + _4, min(size, k + _4 + w)):
            d = i - k - _3
            p0, p1, p2, p3 = row0 + d + _3, row1 + d + _2, row2 + d + _1, row3 + d
            a0, a1, a2, a3 = low[p0], low[p1], low[p2], low[p3]
            b0, b1, b2, b3 = up[p0], up[p1], up[p2], up[p3]
            own, t = i * stride, _0
            while t <= w - d:
                subtract_four_lanes(up, own + t, up, p0 + t, p1 + t, p2 + t, p3 + t, a0, a1, a2, a3)
                subtract_four_lanes(low, own + t, low, p0 + t, p1 + t, p2 + t, p3 + t, b0, b1, b2, b3)
                t += _4
    return True


@njit(cache=True, fastmath=_FAST)
def _factor_four(low, up, stride, k, rows, w, inv_diag_out):
    """Up to four rows of U and columns of L from k on among themselves."""
    for q in range(rows):
        row = (k + q) * stride
        if not abs(up[row]) > 1e-300:
            return False
        inverse = 1.0 / up[row]
        inv_diag_out[k + q] = inverse
        for d in range(_1, w + _1):
            low[row + d] *= inverse
        for s in range(q + _1, min(rows, q + w + _1)):
            d = s - q
            own, a, b, t = (k + s) * stride, low[row + d], up[row + d], _0
            while t <= w - d:
                subtract_lanes(up, own + t, up, row + d + t, a)
                subtract_lanes(low, own + t, low, row + d + t, b)
                t += _4
    return True
