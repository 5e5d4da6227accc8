"""Banded L U without pivoting for the film's non-symmetric systems (mass-conserving cavitation, elastic liner).

The matrices are column diagonally dominant with non-positive off-diagonals, or close to it, so that no pivoting is
needed. Storage: ``lower[r, d] = A[r + d, r]`` and ``upper[r, d] = A[r, r + d]``, d = 0 .. w, zeros behind;
``lower[:, 0]`` is not used. After the factorisation ``A = L U`` with unit L: ``lower`` holds L's columns, ``upper`` U's
rows, ``inv_diag = 1 / diag(U)``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

# Rows longer than this are worth vector instructions.
WIDEST_BY_PANELS = 64
_FAST = {"reassoc", "contract", "nsz", "arcp"}
# Without leave to reassociate short dot products are not turned into gathers, which are slower.
_KEEP_ORDER = {"contract", "nsz", "arcp"}
_unsigned: Any = np.uint64
_0, _1, _2, _3 = (_unsigned(k) for k in range(4))


@njit(cache=True)
def factor_lu(lower, upper, count, width, inv_diag_out):
    """Factor in place; returns False if a pivot vanishes."""
    if width > WIDEST_BY_PANELS:
        return _factor_blocked(lower, upper, count, width, inv_diag_out)
    return _factor_by_panels(lower, upper, count, width, inv_diag_out)


@njit(cache=True, inline="always")
def _subtract_dots(a, b, at, far, along, reach, x00, x01, x02, x10, x11, x12, x20, x21, x22):
    """A tile x of 3 x 3 less the products of ``reach`` threes of ``a`` from ``at`` on and of ``b`` from ``far`` on."""
    for _ in range(reach):
        f0, f1, f2 = a[at], a[at + _1], a[at + _2]
        g = b[far]
        x00 -= f0 * g
        x10 -= f1 * g
        x20 -= f2 * g
        g = b[far + _1]
        x01 -= f0 * g
        x11 -= f1 * g
        x21 -= f2 * g
        g = b[far + _2]
        x02 -= f0 * g
        x12 -= f1 * g
        x22 -= f2 * g
        at += along
        far += along
    return x00, x01, x02, x10, x11, x12, x20, x21, x22


@njit(cache=True, fastmath=_KEEP_ORDER)
def _factor_by_panels(lower, upper, count, width, inv_diag_out):
    """Three rows of U and columns of L at a time, in tiles of 3 x 3 whose nine dot products stay in registers.

    Flat unsigned indices spare the slices and sign checks that would outweigh the arithmetic of short rows. The next
    panel needs what the last one has just stored, so that larger panels wait less; beyond nine sums registers run out.
    """
    up = upper.reshape(-1)
    low = lower.reshape(-1)
    stride = _unsigned(upper.shape[1])
    along = stride - _1
    w = _unsigned(width)
    size = _unsigned(count)
    whole = size - size % _3
    for panel in range(whole // _3):
        r = _3 * panel
        row0 = r * stride
        row1 = row0 + stride
        row2 = row1 + stride
        reach = min(w, r)
        at = row0 - reach * along
        a00, a01, a02, a10, a11, a12, a20, a21, a22 = _subtract_dots(
            low,
            up,
            at,
            at,
            along,
            reach,
            up[row0],
            up[row0 + _1],
            up[row0 + _2],
            low[row0 + _1],
            up[row1],
            up[row1 + _1],
            low[row0 + _2],
            low[row1 + _1],
            up[row2],
        )
        if not abs(a00) > 1e-300:
            return False
        i0 = 1.0 / a00
        a10 *= i0
        a20 *= i0
        a11 -= a10 * a01
        a12 -= a10 * a02
        if not abs(a11) > 1e-300:
            return False
        i1 = 1.0 / a11
        a21 = (a21 - a20 * a01) * i1
        a22 = a22 - a20 * a02 - a21 * a12
        if not abs(a22) > 1e-300:
            return False
        i2 = 1.0 / a22
        inv_diag_out[r], inv_diag_out[r + _1], inv_diag_out[r + _2] = i0, i1, i2
        up[row0], up[row0 + _1], up[row0 + _2], up[row1], up[row1 + _1], up[row2] = a00, a01, a02, a11, a12, a22
        low[row0 + _1], low[row0 + _2], low[row1 + _1] = a10, a20, a21
        c = _3
        while c < w + _3:
            reach = min(w - min(c, w), r)
            at = row0 - reach * along
            c0, c1, c2 = row0 + c, row1 + c - _1, row2 + c - _2
            u00, u01, u02, u10, u11, u12, u20, u21, u22 = _subtract_dots(
                low,
                up,
                at,
                at + c,
                along,
                reach,
                up[c0],
                up[c0 + _1],
                up[c0 + _2],
                up[c1],
                up[c1 + _1],
                up[c1 + _2],
                up[c2],
                up[c2 + _1],
                up[c2 + _2],
            )
            up[c0], up[c0 + _1], up[c0 + _2] = u00, u01, u02
            u10 -= a10 * u00
            u11 -= a10 * u01
            u12 -= a10 * u02
            up[c1], up[c1 + _1], up[c1 + _2] = u10, u11, u12
            up[c2], up[c2 + _1] = u20 - a20 * u00 - a21 * u10, u21 - a20 * u01 - a21 * u11
            up[c2 + _2] = u22 - a20 * u02 - a21 * u12
            l00, l01, l02, l10, l11, l12, l20, l21, l22 = _subtract_dots(
                up,
                low,
                at,
                at + c,
                along,
                reach,
                low[c0],
                low[c0 + _1],
                low[c0 + _2],
                low[c1],
                low[c1 + _1],
                low[c1 + _2],
                low[c2],
                low[c2 + _1],
                low[c2 + _2],
            )
            l00 *= i0
            l01 *= i0
            l02 *= i0
            low[c0], low[c0 + _1], low[c0 + _2] = l00, l01, l02
            l10 = (l10 - a01 * l00) * i1
            l11 = (l11 - a01 * l01) * i1
            l12 = (l12 - a01 * l02) * i1
            low[c1], low[c1 + _1], low[c1 + _2] = l10, l11, l12
            low[c2] = (l20 - a02 * l00 - a12 * l10) * i2
            low[c2 + _1] = (l21 - a02 * l01 - a12 * l11) * i2
            low[c2 + _2] = (l22 - a02 * l02 - a12 * l12) * i2
            c += _3
    for r in range(whole, size):
        row = r * stride
        for d in range(size - r):
            reach = min(w - min(d, w), r)
            at = row - reach * along
            u, v = up[row + d], low[row + d]
            for _ in range(reach):
                u -= low[at] * up[at + d]
                v -= up[at] * low[at + d]
                at += along
            if d == _0:
                if not abs(u) > 1e-300:
                    return False
                inv_diag_out[r] = 1.0 / u
            up[row + d] = u
            low[row + d] = v * inv_diag_out[r]
    return True


@njit(cache=True, fastmath=_FAST)
def _factor_blocked(lower, upper, count, width, inv_diag_out):
    """Four pivots at a time, each row behind them once: long rows that the compiler vectorises."""
    k = 0
    while k < count:
        block = min(4, count - k)
        for q in range(block):
            u = upper[k + q]
            low = lower[k + q]
            pivot = u[0]
            if not abs(pivot) > 1e-300:
                return False
            inverse = 1.0 / pivot
            inv_diag_out[k + q] = inverse
            for d in range(1, width + 1):
                low[d] *= inverse
            for s in range(q + 1, block):
                d = s - q
                if d <= width:
                    fl = low[d]
                    fu = u[d]
                    tu = upper[k + s]
                    tl = lower[k + s]
                    for t in range(width - d + 1):
                        tu[t] -= fl * u[d + t]
                    for t in range(1, width - d + 1):
                        tl[t] -= fu * low[d + t]
        last = min(count - 1, k + block - 1 + width)
        if block == 4:
            u0, u1, u2, u3 = upper[k], upper[k + 1], upper[k + 2], upper[k + 3]
            l0, l1, l2, l3 = lower[k], lower[k + 1], lower[k + 2], lower[k + 3]
            for i in range(k + 4, last + 1):
                d = i - k - 3
                a0, a1, a2, a3 = l0[d + 3], l1[d + 2], l2[d + 1], l3[d]
                b0, b1, b2, b3 = u0[d + 3], u1[d + 2], u2[d + 1], u3[d]
                length = width - d + 1
                tu = upper[i]
                v0 = u0[d + 3 : d + 3 + length]
                v1 = u1[d + 2 : d + 2 + length]
                v2 = u2[d + 1 : d + 1 + length]
                v3 = u3[d : d + length]
                for t in range(length):
                    tu[t] -= a0 * v0[t] + a1 * v1[t] + a2 * v2[t] + a3 * v3[t]
                tl = lower[i]
                w0 = l0[d + 3 : d + 3 + length]
                w1 = l1[d + 2 : d + 2 + length]
                w2 = l2[d + 1 : d + 1 + length]
                w3 = l3[d : d + length]
                for t in range(1, length):
                    tl[t] -= b0 * w0[t] + b1 * w1[t] + b2 * w2[t] + b3 * w3[t]
        else:
            for q in range(block):
                u = upper[k + q]
                low = lower[k + q]
                for i in range(k + block, last + 1):
                    d = i - k - q
                    if d <= width:
                        fl = low[d]
                        fu = u[d]
                        tu = upper[i]
                        tl = lower[i]
                        for t in range(width - d + 1):
                            tu[t] -= fl * u[d + t]
                        for t in range(1, width - d + 1):
                            tl[t] -= fu * low[d + t]
        k += block
    return True
