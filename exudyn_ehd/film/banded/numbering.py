"""Numbering of a film's unknowns on a ring of columns.

The matrix of the finite-volume Reynolds equation couples a cell with its two neighbours in theta and its two neighbours
in z. Active cells are numbered column by column (z fastest), so that the half-bandwidth is at most the number of
unknown rows. The ring of columns is cut

* at a column without active cells, or else
* where the fewest active cells are linked in theta, if these are not more than may be left out of the band, or
* nowhere: the ring is folded (columns 0, n-1, 1, n-2, ...), which doubles the bandwidth.

The numbering depends on the active set alone and not on how it was found.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.kernels import I0

# as spare links: the ring is cut at columns without active cells alone
_NOWHERE = np.int64(-1)


@njit(cache=True, inline="always")
def number_cells(active, kx, order_out, number_out):
    """Number the active cells, all their links in the band; returns (count, half-bandwidth).

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
    return number_along(active, kx, np.int64(1), I0, order_out, number_out)


@njit(cache=True)
def number_along(active, kx, forth, spare, order_out, number_out):
    """Number the active cells as `number_cells`, with the columns in theta (``forth`` = 1) or against it (-1).

    Up to ``spare`` links may be left out of the band: their cells' numbers are further apart than the half-bandwidth.
    """
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
    cut = -1
    if first < 0:
        fewest = spare + 1
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            linked = 0
            for j in range(m):
                if active[i, j] and active[nxt, j] and kx[i, j] != 0.0:
                    linked += 1
                    if linked == fewest:
                        break
            if linked < fewest:
                fewest = linked
                cut = i
        if cut >= 0:
            first = (cut + 1) % n if forth > 0 else cut
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
        if i == cut:
            continue
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            a = number_out[i, j]
            if a >= 0 and kx[i, j] != 0.0:
                b = number_out[nxt, j]
                if b >= 0:
                    width = max(width, abs(b - a))
    return count, width


@njit(cache=True)
def number_with_corners(active, kx, order_out, number_out):
    """Number the active cells as `number_cells`, for a matrix that also couples neighbours across the corners."""
    n, m = active.shape
    count, width = number_along(active, kx, np.int64(1), _NOWHERE, order_out, number_out)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m - 1):
            if kx[i, j] != 0.0 or kx[i, j + 1] != 0.0:
                for a, b in ((number_out[i, j], number_out[nxt, j + 1]), (number_out[i, j + 1], number_out[nxt, j])):
                    if a >= 0 and b >= 0:
                        width = max(width, abs(b - a))
    return count, width


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
