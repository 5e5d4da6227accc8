"""Banded L U without pivoting for the film's non-symmetric systems (mass-conserving cavitation, elastic liner).

The matrices are column diagonally dominant with non-positive off-diagonals, or close to it, so that no pivoting is needed.
Numbering as in `exudyn_ehd.film.direct`: the ring is cut where two neighbouring columns do not couple, else folded.

Storage: ``lower[r, d] = A[r + d, r]`` and ``upper[r, d] = A[r, r + d]``, d = 0 .. w, zeros behind; ``lower[:, 0]`` is not used.
After the factorisation ``A = L U`` with unit L: ``lower`` holds L's columns, ``upper`` U's rows, ``inv_diag = 1 / diag(U)``.
"""

from __future__ import annotations

from numba import njit

PAD = 4
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def factor_lu(lower, upper, count, width, inv_diag_out):
    """Factor in place, four pivots at a time; returns False if a pivot vanishes."""
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


@njit(cache=True, fastmath=_FAST)
def _forward_backward(column_form, row_form, unit_forward, inv_diag, count, width, x):
    """Forward with columns ``column_form`` (unit if unit_forward), backward with rows ``row_form``, in place."""
    for k in range(count):
        if not unit_forward:
            x[k] *= inv_diag[k]
        c = x[k]
        col = column_form[k]
        reach = min(width, count - 1 - k)
        for d in range(1, reach + 1):
            x[k + d] -= c * col[d]
    for k in range(count - 1, -1, -1):
        row = row_form[k]
        reach = min(width, count - 1 - k)
        s = 0.0
        for d in range(1, reach + 1):
            s += row[d] * x[k + d]
        x[k] -= s
        if unit_forward:
            x[k] *= inv_diag[k]


@njit(cache=True)
def solve_lu(lower, upper, inv_diag, count, width, x):
    """Solve ``A x = b`` for every row of x (k, count), in place."""
    for k in range(x.shape[0]):
        _forward_backward(lower, upper, True, inv_diag, count, width, x[k])


@njit(cache=True, fastmath=_FAST)
def _transposed_four(lower, upper, inv_diag, count, width, x):
    """Solve ``A^T x = b`` for four rows of x (4, count), in place."""
    x0 = x[0]
    x1 = x[1]
    x2 = x[2]
    x3 = x[3]
    for k in range(count):
        inverse = inv_diag[k]
        x0[k] *= inverse
        x1[k] *= inverse
        x2[k] *= inverse
        x3[k] *= inverse
        c0 = x0[k]
        c1 = x1[k]
        c2 = x2[k]
        c3 = x3[k]
        row = upper[k]
        for d in range(1, min(width, count - 1 - k) + 1):
            u = row[d]
            x0[k + d] -= c0 * u
            x1[k + d] -= c1 * u
            x2[k + d] -= c2 * u
            x3[k + d] -= c3 * u
    for k in range(count - 1, -1, -1):
        row = lower[k]
        s0 = 0.0
        s1 = 0.0
        s2 = 0.0
        s3 = 0.0
        for d in range(1, min(width, count - 1 - k) + 1):
            u = row[d]
            s0 += u * x0[k + d]
            s1 += u * x1[k + d]
            s2 += u * x2[k + d]
            s3 += u * x3[k + d]
        x0[k] -= s0
        x1[k] -= s1
        x2[k] -= s2
        x3[k] -= s3


@njit(cache=True)
def solve_lu_transposed(lower, upper, inv_diag, count, width, x):
    """Solve ``A^T x = b`` for every row of x (k, count), in place, four at a time."""
    full = x.shape[0] - x.shape[0] % 4
    for k in range(0, full, 4):
        _transposed_four(lower, upper, inv_diag, count, width, x[k : k + 4])
    for k in range(full, x.shape[0]):
        _forward_backward(upper, lower, False, inv_diag, count, width, x[k])
