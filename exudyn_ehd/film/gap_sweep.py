"""From adjoint solutions to fields of gradients with respect to the gap, with the links' share folded into the vertices.

A gap whose links are the mean of their columns (an elastic bore) needs no gradients on links. Symbols as in `sweep`.
"""

from __future__ import annotations

from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def gap_gradient(lam, DX, DZ, slope, AR, AC, cell_out, rate_out):
    """Gradients of k adjoint functionals to the true gap at the vertices and to its rate.

    Parameters
    ----------
    lam, DX, DZ, slope, AR, AC
        As in `sweep.pose_gradient`.
    cell_out, rate_out : (k, n, m) arrays
        Overwritten.
    """
    count, n, m = lam.shape
    for k in range(count):
        for i in range(n):
            prv = i - 1 if i > 0 else n - 1
            nxt = i + 1 if i + 1 < n else 0
            a, before, after = lam[k, i], lam[k, prv], lam[k, nxt]
            for j in range(m):
                g = 0.5 * ((a[j] - after[j]) * DX[i, j] + (before[j] - a[j]) * DX[prv, j])
                cell_out[k, i, j] = -g - a[j] * AC[i, j]
                rate_out[k, i, j] = -a[j] * AR[i, j]
            for j in range(m - 1):
                g = 0.5 * (a[j] - a[j + 1]) * DZ[i, j]
                cell_out[k, i, j] -= g * slope[i, j]
                cell_out[k, i, j + 1] -= g * slope[i, j + 1]
