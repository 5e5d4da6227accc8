"""Banded L U without pivoting for the film's non-symmetric systems (mass-conserving cavitation, elastic liner).

The matrices are column diagonally dominant with non-positive off-diagonals, or close to it, so that no pivoting is needed.
Numbering as in `exudyn_ehd.film.direct`: the ring is cut where two neighbouring columns do not couple, else folded.

Storage: ``lower[r, d] = A[r + d, r]`` and ``upper[r, d] = A[r, r + d]``, d = 0 .. w, zeros behind; ``lower[:, 0]`` is not used.
After the factorisation ``A = L U`` with unit L: ``lower`` holds L's columns, ``upper`` U's rows, ``inv_diag = 1 / diag(U)``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

PAD = 4
# Rows longer than this are worth vector instructions.
WIDEST_BY_DOTS = 32
_FAST = {"reassoc", "contract", "nsz", "arcp"}
# Without leave to reassociate short dot products are not turned into gathers, which are slower.
_KEEP_ORDER = {"contract", "nsz", "arcp"}
_unsigned: Any = np.uint64
_0, _1, _2, _3, _4 = (_unsigned(k) for k in range(5))


@njit(cache=True)
def add_flux(a, b, out_a, out_b, lower, upper):
    """Add a flux a -> b to the balances of its ends: ``out_a``, ``out_b`` are its derivatives; a, b are unknowns or -1."""
    if a >= 0:
        upper[a, 0] += out_a
        if b > a:
            upper[a, b - a] += out_b
            lower[a, b - a] -= out_a
        elif b >= 0:
            lower[b, a - b] += out_b
            upper[b, a - b] -= out_a
    if b >= 0:
        upper[b, 0] -= out_b


@njit(cache=True)
def factor_lu(lower, upper, count, width, inv_diag_out):
    """Factor in place; returns False if a pivot vanishes."""
    if width > WIDEST_BY_DOTS:
        return _factor_blocked(lower, upper, count, width, inv_diag_out)
    return _factor_by_dots(lower, upper, count, width, inv_diag_out)


@njit(cache=True, fastmath=_KEEP_ORDER)
def _factor_by_dots(lower, upper, count, width, inv_diag_out):
    """Crout's order: a row of U and a column of L at a time, four entries of each as dot products that stay in registers.

    Flat unsigned indices spare the slices and sign checks that would outweigh the arithmetic of short rows.
    """
    up = upper.reshape(-1)
    low = lower.reshape(-1)
    stride = _unsigned(upper.shape[1])
    along = stride - _1
    w = _unsigned(width)
    inverse = 1.0
    for r in range(_unsigned(count)):
        row = r * stride
        first = _0
        while first <= w:
            reach = min(w - first, r)
            column = (r - reach) * stride + reach
            target = column + first
            place = row + first
            u0, u1, u2, u3 = up[place], up[place + _1], up[place + _2], up[place + _3]
            l0, l1, l2, l3 = low[place], low[place + _1], low[place + _2], low[place + _3]
            for _ in range(reach):
                a = low[column]
                b = up[column]
                u0 -= a * up[target]
                u1 -= a * up[target + _1]
                u2 -= a * up[target + _2]
                u3 -= a * up[target + _3]
                l0 -= b * low[target]
                l1 -= b * low[target + _1]
                l2 -= b * low[target + _2]
                l3 -= b * low[target + _3]
                column += along
                target += along
            if first == _0:
                if not abs(u0) > 1e-300:
                    return False
                inverse = 1.0 / u0
                inv_diag_out[r] = inverse
            up[place], up[place + _1], up[place + _2], up[place + _3] = u0, u1, u2, u3
            low[place], low[place + _1] = l0 * inverse, l1 * inverse
            low[place + _2], low[place + _3] = l2 * inverse, l3 * inverse
            first += _4
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


@njit(cache=True, fastmath=_KEEP_ORDER)
def _forward_backward(column_form, row_form, unit_forward, inv_diag, count, width, x):
    """Forward with columns ``column_form`` (unit if unit_forward), backward with rows ``row_form``, in place."""
    col = column_form.reshape(-1)
    row = row_form.reshape(-1)
    stride = _unsigned(column_form.shape[1])
    along = stride - _1
    w = _unsigned(width)
    size = _unsigned(count)
    for r in range(size):
        reach = min(w, r)
        k = r - reach
        at = k * stride + reach
        s0 = x[r]
        s1 = 0.0
        for _ in range(reach >> _1):
            s1 -= col[at] * x[k]
            s0 -= col[at + along] * x[k + _1]
            at += along + along
            k += _2
        if reach & _1:
            s0 -= col[at] * x[k]
        s0 += s1
        x[r] = s0 if unit_forward else s0 * inv_diag[r]
    for q in range(size):
        r = size - _1 - q
        reach = min(w, q)
        k = r + reach
        at = r * stride + reach
        s0 = x[r]
        s1 = 0.0
        for _ in range(reach >> _1):
            s1 -= row[at] * x[k]
            s0 -= row[at - _1] * x[k - _1]
            at -= _2
            k -= _2
        if reach & _1:
            s0 -= row[at] * x[k]
        s0 += s1
        x[r] = s0 * inv_diag[r] if unit_forward else s0


@njit(cache=True, fastmath=_KEEP_ORDER)
def _forward_backward_four(column_form, row_form, unit_forward, inv_diag, count, width, x):
    """As `_forward_backward` for four right-hand sides x (4, count) at once."""
    col = column_form.reshape(-1)
    row = row_form.reshape(-1)
    stride = _unsigned(column_form.shape[1])
    along = stride - _1
    w = _unsigned(width)
    size = _unsigned(count)
    x0, x1, x2, x3 = x[0], x[1], x[2], x[3]
    for r in range(size):
        reach = min(w, r)
        k = r - reach
        at = k * stride + reach
        s0, s1, s2, s3 = x0[r], x1[r], x2[r], x3[r]
        for _ in range(reach):
            f = col[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at += along
            k += _1
        inverse = 1.0 if unit_forward else inv_diag[r]
        x0[r], x1[r], x2[r], x3[r] = s0 * inverse, s1 * inverse, s2 * inverse, s3 * inverse
    for q in range(size):
        r = size - _1 - q
        reach = min(w, q)
        k = r + reach
        at = r * stride + reach
        s0, s1, s2, s3 = x0[r], x1[r], x2[r], x3[r]
        for _ in range(reach):
            f = row[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at -= _1
            k -= _1
        inverse = inv_diag[r] if unit_forward else 1.0
        x0[r], x1[r], x2[r], x3[r] = s0 * inverse, s1 * inverse, s2 * inverse, s3 * inverse


@njit(cache=True)
def _solve_all(column_form, row_form, unit_forward, inv_diag, count, width, x):
    full = x.shape[0] - x.shape[0] % 4
    for k in range(0, full, 4):
        _forward_backward_four(column_form, row_form, unit_forward, inv_diag, count, width, x[k : k + 4])
    for k in range(full, x.shape[0]):
        _forward_backward(column_form, row_form, unit_forward, inv_diag, count, width, x[k])


@njit(cache=True)
def solve_lu(lower, upper, inv_diag, count, width, x):
    """Solve ``A x = b`` for every row of x (k, count), in place, four at a time."""
    _solve_all(lower, upper, True, inv_diag, count, width, x)


@njit(cache=True)
def solve_lu_transposed(lower, upper, inv_diag, count, width, x):
    """Solve ``A^T x = b`` for every row of x (k, count), in place, four at a time."""
    _solve_all(upper, lower, False, inv_diag, count, width, x)
