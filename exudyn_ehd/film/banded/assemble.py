"""Newton's matrix from the derivatives of the flows between vertices, for every film whose balance is a sum over links.

Storage and numbering as in `exudyn_ehd.film.banded.lu`, in dense bands as returned by `dense_band`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numba.extending import register_jitable

from exudyn_ehd.film.banded.workspace import PAD

_unsigned: Any = np.uint64
_0, _1 = _unsigned(0), _unsigned(1)


# slices alone, which Python does faster than the way into a compiled kernel takes
@register_jitable
def dense_band(buffer, count, width):
    """The part of a contiguous buffer that holds a band, row after row."""
    stride = width + 1 + PAD
    return buffer.reshape(-1)[: count * stride].reshape(count, stride)


@njit(cache=True)
def assemble(kx, kz, slopes, number, order, count, lower, upper):
    """Bands of the numbered vertices from the derivatives of the links' flows and of the storage.

    Row by row with flat unsigned indices, which need no check of their sign.

    Parameters
    ----------
    kx, kz : (n, m) arrays
        Not zero where vertices are linked in theta and in z.
    slopes : (5, n m) array
        Of the flow a -> b to the unknowns at a and at b, in theta, then in z;
        of the storage to the vertex's own unknown.
    """
    n, m = number.shape
    size, rows = _unsigned(n * m), _unsigned(m)
    last = size - rows
    places, along, across = number.reshape(-1), kx.reshape(-1), kz.reshape(-1)
    ax, bx, az, bz, store = slopes[0], slopes[1], slopes[2], slopes[3], slopes[4]
    low, up = lower.reshape(-1), upper.reshape(-1)
    stride = _unsigned(lower.shape[1])
    for q in range(low.size):
        low[q] = 0.0
    for q in range(up.size):
        up[q] = 0.0
    for r in range(count):
        row = _unsigned(r)
        c = _unsigned(order[r])
        nxt = c + rows if c < last else c - last
        prv = c - rows if c >= rows else c + last
        # links in theta, then in z, where those at the film's ends conduct nothing
        diagonal = store[c] + ax[c] - bx[prv] + az[c]
        b = places[nxt]
        if along[c] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] += bx[c]
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] += bx[c]
        b = places[prv]
        if along[prv] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] -= ax[prv]
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] -= ax[prv]
        if across[c] != 0.0 and places[c + _1] >= 0:
            up[row * stride + _1] += bz[c]
        if c > _0:
            diagonal -= bz[c - _1]
            if across[c - _1] != 0.0 and places[c - _1] >= 0:
                low[(row - _1) * stride + _1] -= az[c - _1]
        up[row * stride] = diagonal
