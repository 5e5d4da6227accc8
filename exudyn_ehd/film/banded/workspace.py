"""Buffers of a film, and Newton's matrix, which is assembled in them from the flows between vertices.

Buffers are allocated once and do not depend on the solver. The matrix is that of any film whose balance is a sum over
links. Its storage and numbering are those of `exudyn_ehd.film.banded.factors`, in dense bands as returned by
`dense_band`.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numba.extending import register_jitable

from exudyn_ehd.compilation import U0, U1, unsigned

# Number of zeros after the half-bandwidth in every row of a band, for kernels that process four pivots and vectors of
# four numbers. Smaller numbers let them read the next row, larger ones cost time.
PAD = 6


class Workspace:
    """Buffers of one film on n columns and m rows, for one solution at a time.

    Attributes
    ----------
    active : (n, m) bool array
        Active set of the last solution.
    warm : bool
        Whether the next solution is a warm start from the last one.
    ready, exact : bool
        Whether the factor may be used for a chord step as first step of the next solution, and whether it is that of
        the last solution.
    u : (n, m) array
        Unknowns of the last solution, see `exudyn_ehd.film.cavitation.states`.
    slopes : (5, n m) array
        Derivatives to the unknowns: of the flows over the links (4), and of the storage.
    """

    def __init__(self, n: int, m: int) -> None:
        size = n * m
        self.order, self.number = np.zeros(size, dtype=np.int64), np.full((n, m), -1, dtype=np.int64)
        self.lower, self.upper = np.zeros((2, size, 2 * m + 2 + PAD))
        self.inv_diag, self.unknowns = np.zeros((2, size))
        self.active = np.zeros((n, m), dtype=np.bool_)
        self.u, self.above, self.residual, steep, *before = np.zeros((6, n, m))
        self.slopes = np.zeros((5, size))
        self.matrix = self.order, self.number, self.lower, self.upper, self.inv_diag, self.slopes, steep
        self.symmetric = self.order, self.number, None, self.upper, self.inv_diag, None, None
        self.before = before[0], np.zeros((n, m), dtype=np.bool_), before[1]
        self.warm = self.ready = self.exact = False
        self.count = 0
        self.width = 1

    @property
    def size(self) -> tuple[bool, int, int]:
        """Argument ``size`` of `exudyn_ehd.film.solvers.newton.solve_film`."""
        return self.warm and self.ready, self.count, self.width

    def take_end(self, found: bool, exact: bool, steps: int, count: int, width: int) -> tuple[bool, int]:
        """Store the state of the factor after a solution; returns (found, steps)."""
        self.ready, self.exact, self.count, self.width = found, exact, count, width
        return found, steps


# not compiled for calls from Python: the call of a compiled kernel would take longer than these slices
@register_jitable
def dense_band(buffer, count, width):
    """Return the band (count, width + 1 + PAD) at the start of a contiguous buffer, as a view."""
    stride = width + 1 + PAD
    return buffer.reshape(-1)[: count * stride].reshape(count, stride)


@njit(cache=True)
def assemble(kx, kz, slopes, number, order, count, lower, upper):
    """Assemble the bands of the numbered vertices from the derivatives of the links' flows and of the storage.

    Loops use flat unsigned indices, whose sign need not be checked.

    Parameters
    ----------
    kx, kz : (n, m) arrays
        Not zero where vertices are linked in theta and in z.
    slopes : (5, n m) array
        Derivatives of the flow over the link a -> b to the unknowns at a and at b, in theta, then in z; derivative of
        the storage to the unknown of the same vertex.
    lower, upper : arrays
        Bands, overwritten.
    """
    n, m = number.shape
    size, rows = unsigned(n * m), unsigned(m)
    last = size - rows
    places, along, across = number.reshape(-1), kx.reshape(-1), kz.reshape(-1)
    ax, bx, az, bz, store = slopes[0], slopes[1], slopes[2], slopes[3], slopes[4]
    low, up = lower.reshape(-1), upper.reshape(-1)
    stride = unsigned(lower.shape[1])
    for q in range(low.size):
        low[q] = 0.0
    for q in range(up.size):
        up[q] = 0.0
    for r in range(count):
        row = unsigned(r)
        c = unsigned(order[r])
        nxt = c + rows if c < last else c - last
        prv = c - rows if c >= rows else c + last
        # the derivatives of links in z beyond the film's ends are 0
        diagonal = store[c] + ax[c] - bx[prv] + az[c]
        b = places[nxt]
        if along[c] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + unsigned(b - r)] += bx[c]
            else:
                low[unsigned(b) * stride + unsigned(r - b)] += bx[c]
        b = places[prv]
        if along[prv] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + unsigned(b - r)] -= ax[prv]
            else:
                low[unsigned(b) * stride + unsigned(r - b)] -= ax[prv]
        if across[c] != 0.0 and places[c + U1] >= 0:
            up[row * stride + U1] += bz[c]
        if c > U0:
            diagonal -= bz[c - U1]
            if across[c - U1] != 0.0 and places[c - U1] >= 0:
                low[(row - U1) * stride + U1] -= az[c - U1]
        up[row * stride] = diagonal


@njit(cache=True)
def add_tangents(along, kx, kz, full, slopes):
    """Multiply the derivatives of the pressure flows in ``slopes`` by the factors ``along`` (2, n, m) of the links.

    These are the ratios of tangent and secant conductance. ``full``: vertices whose unknown is the pressure, None: all.
    """
    n, m = kx.shape
    last = n * m - m
    for axis in range(2):
        k, ratio = (kx if axis == 0 else kz).reshape(-1), along[axis].reshape(-1)
        for c in range(k.size):
            b = c + 1 if axis == 1 else (c + m if c < last else c - last)
            if k[c] != 0.0:
                more = (ratio[c] - 1.0) * k[c]
                if full is None or full.reshape(-1)[c]:
                    slopes[2 * axis, c] += more
                if full is None or full.reshape(-1)[b]:
                    slopes[2 * axis + 1, c] -= more


@njit(cache=True)
def _add_flow(value, place, ends, places, full, stride, low, up):
    """Add the derivative ``value`` of a flow to the unknown at vertex ``place`` to the balances of its ``ends``.

    Numbers of ``ends`` and of the unknown below 0: none.
    """
    column = places[place]
    if column < 0 or not (full is None or full.reshape(-1)[place]):
        return
    c = unsigned(column)
    for row, share in ((ends[0], value), (ends[1], -value)):
        if row >= 0:
            r = unsigned(row)
            if c >= r:
                up[r * stride + (c - r)] += share
            else:
                low[c * stride + (r - c)] += share


@njit(cache=True)
def add_corners(across, weights, kx, kz, full, number, lower, upper):
    """Add the derivatives of the links' flows through the pressure gradients across the links.

    They couple diagonal neighbours. The flow over a link has the derivative ``-k across`` to the mean of the gradients
    across the link at both ends. A gradient is ``back (P - P_before) + on (P_behind - P)``.

    Parameters
    ----------
    across : (2, n, m) array
        Factors of the links in theta and in z.
    weights : four arrays
        ``back`` and ``on`` in theta (n,), and in z (m,).
    kx, kz : (n, m) arrays
        Conductances of the links; numbering by `exudyn_ehd.film.banded.factors.number_with_corners`.
    full : (n, m) array or None
        Vertices whose unknown is the pressure, None: all.
    """
    n, m = kx.shape
    back_x, on_x, back_z, on_z = weights
    low, up, places = lower.reshape(-1), upper.reshape(-1), number.reshape(-1)
    stride, rows = unsigned(lower.shape[1]), unsigned(m)
    for i in range(n):
        on, back = unsigned(i + 1 if i + 1 < n else 0) * rows, unsigned(i - 1 if i > 0 else n - 1) * rows
        for j in range(m):
            c = unsigned(i) * rows + unsigned(j)
            far = on + unsigned(j)
            a, b = places[c], places[far]
            k = -0.5 * kx[i, j] * across[0, i, j]
            if k != 0.0 and (a >= 0 or b >= 0):
                before, behind = k * back_z[j] if j > 0 else 0.0, k * on_z[j] if j + 1 < m else 0.0
                for end in (c, far):
                    if before != 0.0:
                        _add_flow(-before, end - U1, (a, b), places, full, stride, low, up)
                    if behind != 0.0:
                        _add_flow(behind, end + U1, (a, b), places, full, stride, low, up)
                    if before != behind:
                        _add_flow(before - behind, end, (a, b), places, full, stride, low, up)
            if j + 1 == m:
                continue
            b = places[c + U1]
            k = -0.5 * kz[i, j] * across[1, i, j]
            if k != 0.0 and (a >= 0 or b >= 0):
                before, behind = k * back_x[i], k * on_x[i]
                for row in (unsigned(j), unsigned(j) + U1):
                    _add_flow(-before, back + row, (a, b), places, full, stride, low, up)
                    _add_flow(behind, on + row, (a, b), places, full, stride, low, up)
                    if before != behind:
                        _add_flow(before - behind, unsigned(i) * rows + row, (a, b), places, full, stride, low, up)
