"""Banded L D L^T of the film's symmetric systems.

Storage: ``band[r, d] = A[r, r + d]`` with zeros behind the bandwidth, so that blocks of four pivots may read past it.
Factor: ``A = U^T D^-1 U`` with ``U = D L^T`` stored in place of ``band`` and ``inv_diag = 1 / diag(U)``.

Symbols: n columns (theta), m rows (z), w half-bandwidth, kx / kz conductances of the links (i, j)-(i+1, j) and
(i, j)-(i, j+1).
"""

from __future__ import annotations

from numba import njit

from exudyn_ehd.film.banded.workspace import PAD

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def assemble_band(kx, kz, number, order, count, width, first, band_out):
    """Fill the upper band of the active cells' matrix, rows from ``first`` on, without links longer than ``width``."""
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
        if b >= 0 and kx[i, j] != 0.0 and abs(b - r) <= width:
            if b > r:
                band_out[r, b - r] -= kx[i, j]
            elif b >= first:
                band_out[b, r - b] -= kx[i, j]


@njit(cache=True, fastmath=_FAST)
def factor_band(band, count, width, first, inv_diag_out):
    """Factor in place, four pivots at a time; returns False if a pivot is not positive.

    Rows below ``first`` (a multiple of 4) are factored already and stay; those from it on hold the matrix. The
    operations on every row, and so its bits, are the same as for ``first = 0``.
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
