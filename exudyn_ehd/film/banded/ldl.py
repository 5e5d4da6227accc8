"""Structured direct solver for the film: banded L D L^T of the active cells on a ring of columns.

The matrix of the finite-volume Reynolds equation couples a cell with its two neighbours in theta and its two neighbours
in z. Active cells are numbered column by column (z fastest), so that the half-bandwidth is at most the number of
unknown rows. The ring of columns is cut

* at a column without active cells or at a missing link (then one column couples only with the next one), or, if there is
  none,
* nowhere: the ring is folded (columns 0, n-1, 1, n-2, ...), which doubles the bandwidth.

The numbering, and with it every bit of the solution, depends on the active set alone and not on how it was found.

Storage: ``band[r, d] = A[r, r + d]`` with zeros behind the bandwidth, so that blocks of four pivots may read past it.
Factor: ``A = U^T D^-1 U`` with ``U = D L^T`` stored in place of ``band`` and ``inv_diag = 1 / diag(U)``.

Symbols: n columns (theta), m rows (z), w half-bandwidth, kx / kz conductances of the links (i, j)-(i+1, j) and
(i, j)-(i, j+1).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from exudyn_ehd.film.cavitation.cavity_transport import Transport

PAD = 4
_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned: Any = np.uint64


@njit(cache=True)
def number_cells(active, kx, order_out, number_out):
    """Number the active cells; returns (count, half-bandwidth).

    Parameters
    ----------
    active : (n, m) bool array
    kx : (n, m) float array
        Conductance between columns i and i+1 (cyclic); a column of zeros is a missing link.
    order_out : (n m,) int array
        Flat cell index ``i m + j`` of every unknown.
    number_out : (n, m) int array
        Unknown of every cell, -1 if not active.
    """
    return number_along(active, kx, 1, order_out, number_out)


@njit(cache=True)
def number_along(active, kx, forth, order_out, number_out):
    """As `number_cells`, with the columns in theta (``forth`` = 1) or against it (-1)."""
    n, m = active.shape
    first = -1
    for i in range(n):
        empty = True
        for j in range(m):
            if active[i, j]:
                empty = False
                break
        if empty:
            first = (i + forth + n) % n
            break
    if first < 0:
        for i in range(n):
            linked = False
            for j in range(m):
                if kx[i, j] != 0.0:
                    linked = True
                    break
            if not linked:
                first = (i + 1) % n if forth > 0 else i
                break
    count = 0
    for s in range(n):
        if first >= 0:
            i = (first + forth * s + n) % n
        elif s % 2 == 0:
            i = s // 2
        else:
            i = n - 1 - s // 2
        for j in range(m):
            if active[i, j]:
                number_out[i, j] = count
                order_out[count] = i * m + j
                count += 1
            else:
                number_out[i, j] = -1
    width = 1
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            a = number_out[i, j]
            if a >= 0 and kx[i, j] != 0.0:
                b = number_out[nxt, j]
                if b >= 0:
                    width = max(width, abs(b - a))
    return count, width


@njit(cache=True)
def assemble_band(kx, kz, number, order, count, width, first, band_out):
    """Fill the upper band of the active cells' matrix, rows from ``first`` on."""
    n, m = number.shape
    reach = max(width, m) + 1 + PAD
    for r in range(first, count):
        for d in range(reach):
            band_out[r, d] = 0.0
    i = 0
    for r in range(first, count):
        j = order[r] - i * m
        if j < 0 or j >= m:  # rows of a column follow each other: one division per column
            i = order[r] // m
            j = order[r] - i * m
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        diagonal = kx[prv, j] + kx[i, j]
        if j > 0:
            diagonal += kz[i, j - 1]
        if j + 1 < m:
            diagonal += kz[i, j]
            b = number[i, j + 1]
            if b > r:
                band_out[r, b - r] -= kz[i, j]
        band_out[r, 0] += diagonal
        b = number[nxt, j]
        if b >= 0 and kx[i, j] != 0.0:
            if b > r:
                band_out[r, b - r] -= kx[i, j]
            elif b >= first:
                band_out[b, r - b] -= kx[i, j]


@njit(cache=True)
def first_changed_row(order, old_order, old_count, count, width):
    """Row up to which a matrix with this numbering equals the one with the old numbering; a multiple of 4."""
    same = 0
    while same < count and same < old_count and order[same] == old_order[same]:
        same += 1
    if same == count and same == old_count:
        return count
    row = max(0, same - width)
    return row - row % 4


@njit(cache=True, fastmath=_FAST)
def factor_band(band, count, width, first, inv_diag_out):
    """Factor in place, four pivots at a time; returns False if a pivot is not positive.

    Rows below ``first`` (a multiple of 4) are factored already and stay; those from it on hold the matrix. The operations on
    every row, and so its bits, are the same as for ``first = 0``.
    """
    k = max(0, first - width - 4)
    k -= k % 4
    while k < count:
        block = min(4, count - k)
        for q in range(block if k >= first else 0):
            row = band[k + q]
            if not row[0] > 0.0:
                return False
            inverse = 1.0 / row[0]
            inv_diag_out[k + q] = inverse
            for s in range(q + 1, block):
                d = s - q
                if d <= width:
                    factor = row[d] * inverse
                    target = band[k + s]
                    for t in range(width - d + 1):
                        target[t] -= factor * row[d + t]
        last = min(count - 1, k + block - 1 + width)
        if block == 4:
            u0 = band[k]
            u1 = band[k + 1]
            u2 = band[k + 2]
            u3 = band[k + 3]
            i0 = inv_diag_out[k]
            i1 = inv_diag_out[k + 1]
            i2 = inv_diag_out[k + 2]
            i3 = inv_diag_out[k + 3]
            for i in range(max(k + 4, first), last + 1):
                d3 = i - k - 3
                f3 = u3[d3] * i3
                f2 = u2[d3 + 1] * i2
                f1 = u1[d3 + 2] * i1
                f0 = u0[d3 + 3] * i0
                target = band[i]
                length = width - d3 + 1
                v0 = u0[d3 + 3 : d3 + 3 + length]
                v1 = u1[d3 + 2 : d3 + 2 + length]
                v2 = u2[d3 + 1 : d3 + 1 + length]
                v3 = u3[d3 : d3 + length]
                for t in range(length):
                    target[t] -= f0 * v0[t] + f1 * v1[t] + f2 * v2[t] + f3 * v3[t]
        else:
            for q in range(block):
                row = band[k + q]
                for i in range(k + block, last + 1):
                    d = i - k - q
                    if d <= width:
                        factor = row[d] * inv_diag_out[k + q]
                        target = band[i]
                        for t in range(width - d + 1):
                            target[t] -= factor * row[d + t]
        k += block
    return True


@njit(cache=True, fastmath=_FAST)
def solve_one(band, inv_diag, count, width, x):
    """Solve for one right-hand side (count,) in place, four pivots at a time."""
    whole = count - count % 4
    for k in range(0, whole, 4):
        u0, u1, u2, u3 = band[k], band[k + 1], band[k + 2], band[k + 3]
        c0 = x[k] * inv_diag[k]
        x1 = x[k + 1] - c0 * u0[1]
        c1 = x1 * inv_diag[k + 1]
        x2 = x[k + 2] - c0 * u0[2] - c1 * u1[1]
        c2 = x2 * inv_diag[k + 2]
        x3 = x[k + 3] - c0 * u0[3] - c1 * u1[2] - c2 * u2[1]
        c3 = x3 * inv_diag[k + 3]
        x[k + 1] = x1
        x[k + 2] = x2
        x[k + 3] = x3
        reach = min(width, count - 4 - k)
        target = x[k + 4 : k + 4 + reach]
        v0, v1, v2, v3 = u0[4 : 4 + reach], u1[3 : 3 + reach], u2[2 : 2 + reach], u3[1 : 1 + reach]
        for t in range(reach):
            target[t] -= c0 * v0[t] + c1 * v1[t] + c2 * v2[t] + c3 * v3[t]
    for k in range(whole, count):
        c = x[k] * inv_diag[k]
        for d in range(1, min(width, count - 1 - k) + 1):
            x[k + d] -= c * band[k, d]
    for k in range(count - 1, whole - 1, -1):
        s = 0.0
        for d in range(1, min(width, count - 1 - k) + 1):
            s += band[k, d] * x[k + d]
        x[k] = (x[k] - s) * inv_diag[k]
    for k in range(whole - 4, -1, -4):
        u0, u1, u2, u3 = band[k], band[k + 1], band[k + 2], band[k + 3]
        reach = min(width, count - 4 - k)
        known = x[k + 4 : k + 4 + reach]
        v0, v1, v2, v3 = u0[4 : 4 + reach], u1[3 : 3 + reach], u2[2 : 2 + reach], u3[1 : 1 + reach]
        s0 = 0.0
        s1 = 0.0
        s2 = 0.0
        s3 = 0.0
        for t in range(reach):
            a = known[t]
            s0 += v0[t] * a
            s1 += v1[t] * a
            s2 += v2[t] * a
            s3 += v3[t] * a
        x3 = (x[k + 3] - s3) * inv_diag[k + 3]
        x2 = (x[k + 2] - s2 - u2[1] * x3) * inv_diag[k + 2]
        x1 = (x[k + 1] - s1 - u1[1] * x2 - u1[2] * x3) * inv_diag[k + 1]
        x[k] = (x[k] - s0 - u0[1] * x1 - u0[2] * x2 - u0[3] * x3) * inv_diag[k]
        x[k + 1] = x1
        x[k + 2] = x2
        x[k + 3] = x3


@njit(cache=True, fastmath=_FAST)
def solve_four(band, inv_diag, count, width, x):
    """Solve for four right-hand sides x (4, count) in place."""
    x0 = x[0]
    x1 = x[1]
    x2 = x[2]
    x3 = x[3]
    for k in range(count):
        row = band[k]
        inverse = inv_diag[k]
        c0 = x0[k] * inverse
        c1 = x1[k] * inverse
        c2 = x2[k] * inverse
        c3 = x3[k] * inverse
        reach = min(width, count - 1 - k)
        for d in range(1, reach + 1):
            u = row[d]
            x0[k + d] -= c0 * u
            x1[k + d] -= c1 * u
            x2[k + d] -= c2 * u
            x3[k + d] -= c3 * u
    for k in range(count - 1, -1, -1):
        row = band[k]
        reach = min(width, count - 1 - k)
        s0 = 0.0
        s1 = 0.0
        s2 = 0.0
        s3 = 0.0
        for d in range(1, reach + 1):
            u = row[d]
            s0 += u * x0[k + d]
            s1 += u * x1[k + d]
            s2 += u * x2[k + d]
            s3 += u * x3[k + d]
        inverse = inv_diag[k]
        x0[k] = (x0[k] - s0) * inverse
        x1[k] = (x1[k] - s1) * inverse
        x2[k] = (x2[k] - s2) * inverse
        x3[k] = (x3[k] - s3) * inverse


def solve_many(band, inv_diag, count, width, x):
    """Solve for any number of right-hand sides x (k, count), C-contiguous, in place: by sixes, and what is left by four or one by one."""
    k, s = x.shape[0], 0
    while k - s > 4:
        solve_six(band, inv_diag, count, width, x[s : s + 6])
        s += 6
    if k - s == 4:
        solve_four(band, inv_diag, count, width, x[s:])
        return
    for r in range(s, k):
        solve_one(band, inv_diag, count, width, x[r])


@njit(cache=True, fastmath={"contract", "nsz", "arcp"})
def solve_six(band, inv_diag, count, width, x):
    """As `solve_four_by_dots`, for five or six right-hand sides x (5 or 6, count) in place."""
    u = band.reshape(-1)
    stride = _unsigned(band.shape[1])
    along = stride - _unsigned(1)
    w = _unsigned(width)
    size = _unsigned(count)
    x0, x1, x2, x3, x4 = x[0], x[1], x[2], x[3], x[4]
    x5 = x[5] if x.shape[0] > 5 else np.zeros(count)
    for r in range(size):
        reach = min(w, r)
        k = r - reach
        at = k * stride + reach
        s0, s1, s2, s3, s4, s5 = x0[r], x1[r], x2[r], x3[r], x4[r], x5[r]
        for _ in range(reach):
            f = u[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            s4 -= f * x4[k]
            s5 -= f * x5[k]
            at += along
            k += _unsigned(1)
        d = inv_diag[r]
        x0[r], x1[r], x2[r], x3[r], x4[r], x5[r] = s0 * d, s1 * d, s2 * d, s3 * d, s4 * d, s5 * d
    for q in range(size):
        r = size - _unsigned(1) - q
        reach = min(w, q)
        at = r * stride + reach
        k = r + reach
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for _ in range(reach):
            f = u[at]
            s0 += f * x0[k]
            s1 += f * x1[k]
            s2 += f * x2[k]
            s3 += f * x3[k]
            s4 += f * x4[k]
            s5 += f * x5[k]
            at -= _unsigned(1)
            k -= _unsigned(1)
        d = inv_diag[r]
        x0[r] -= s0 * d
        x1[r] -= s1 * d
        x2[r] -= s2 * d
        x3[r] -= s3 * d
        x4[r] -= s4 * d
        x5[r] -= s5 * d


@njit(cache=True, fastmath={"contract", "nsz", "arcp"})
def solve_four_by_dots(band, inv_diag, count, width, x):
    """As `solve_four`, in dot products that stay in registers: twice as fast, rounded otherwise; flat indices as in `band_lu`."""
    u = band.reshape(-1)
    stride = _unsigned(band.shape[1])
    along = stride - _unsigned(1)
    w = _unsigned(width)
    size = _unsigned(count)
    x0, x1, x2, x3 = x[0], x[1], x[2], x[3]
    for r in range(size):
        reach = min(w, r)
        k = r - reach
        at = k * stride + reach
        s0, s1, s2, s3 = x0[r], x1[r], x2[r], x3[r]
        for _ in range(reach):
            f = u[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at += along
            k += _unsigned(1)
        inverse = inv_diag[r]
        x0[r], x1[r], x2[r], x3[r] = s0 * inverse, s1 * inverse, s2 * inverse, s3 * inverse
    for q in range(size):
        r = size - _unsigned(1) - q
        reach = min(w, q)
        at = r * stride + reach
        k = r + reach
        s0 = 0.0
        s1 = 0.0
        s2 = 0.0
        s3 = 0.0
        for _ in range(reach):
            f = u[at]
            s0 += f * x0[k]
            s1 += f * x1[k]
            s2 += f * x2[k]
            s3 += f * x3[k]
            at -= _unsigned(1)
            k -= _unsigned(1)
        inverse = inv_diag[r]
        x0[r] -= s0 * inverse
        x1[r] -= s1 * inverse
        x2[r] -= s2 * inverse
        x3[r] -= s3 * inverse


class Workspace:
    """Buffers of one film, allocated once; a workspace serves one film at a time.

    Attributes
    ----------
    active : (n, m) bool array
        The active set of the last solution: the warm start of the next one.
    lower, upper, transport
        Buffers of mass-conserving and elastic films; None: not needed yet.
    carried : bool
        Whether the last mass-conserving film was factored along the flow of its cavity, see `exudyn_ehd.film.cavitation.cavity_transport`.
    """

    def __init__(self, n: int, m: int) -> None:
        size = n * m
        self.shape = (n, m)
        self.order = np.zeros(size, dtype=np.int64)
        self.old_order = np.zeros(size, dtype=np.int64)
        self.number = np.full((n, m), -1, dtype=np.int64)
        self.band = np.zeros((size, 2 * m + 2 + PAD))
        self.inv_diag = np.zeros(size)
        self.unknowns = np.zeros(size)
        self.active = np.zeros((n, m), dtype=np.bool_)
        self.warm = False
        self.lower: np.ndarray | None = None
        self.upper: np.ndarray | None = None
        self.transport: Transport | None = None
        self.carried = False
        self.count = 0
        self.width = 1
