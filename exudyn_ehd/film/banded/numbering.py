"""Numbering of a film's unknowns on a ring of columns.

The matrix of the finite-volume Reynolds equation couples a cell with its two neighbours in theta and its two neighbours
in z. Active cells are numbered column by column (z fastest), so that the half-bandwidth is at most the number of
unknown rows. The ring of columns is cut

* behind a column without active cells, or without a link to the next one; else
* nowhere: the ring is folded (columns 0, n-1, 1, n-2, ...), which doubles the bandwidth.

The numbering depends on active set and links alone, not on earlier solutions.
"""

from numba import njit


@njit(cache=True)
def number_cells(active, kx, order_out, number_out):
    """Number the active cells; returns (count, half-bandwidth of all their links).

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
    n, m = active.shape
    first = -1
    for i in range(n):
        empty = apart = True
        for j in range(m):
            empty &= not active[i, j]
            apart &= kx[i, j] == 0.0
        if empty or apart:
            first = i + 1
            break
    count = 0
    for s in range(n):
        if first >= 0:
            i = (first + s) % n
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
def number_with_corners(active, kx, order_out, number_out):
    """Number the active cells as `number_cells`, for a matrix that also couples neighbours across the corners."""
    n, m = active.shape
    count, width = number_cells(active, kx, order_out, number_out)
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m - 1):
            if kx[i, j] != 0.0 or kx[i, j + 1] != 0.0:
                for a, b in ((number_out[i, j], number_out[nxt, j + 1]), (number_out[i, j + 1], number_out[nxt, j])):
                    if a >= 0 and b >= 0:
                        width = max(width, abs(b - a))
    return count, width
