"""Forward and back substitution with a stored band factor, for a handful of right-hand sides as rows.

For dozens see `many_sides`.

``A = F^T G`` with F's rows in ``forward`` and G's in ``backward``, stored as in `ldl` and `lu`. One of the two
triangles, or both, come with the diagonal ``1 / inverse``, else with ones:

* `solve_lu`: F^T = L with ones, G = U;
* `solve_lu_transposed`: F^T = U^T, G = L^T with ones;
* `solve_ldl`: ``A = U^T D^-1 U``, both U, so that the back substitution starts from D times what came forward.

Four right-hand sides are carried along at once. All indices are flat and unsigned, which spares the slices and sign
checks that would outweigh the arithmetic of short rows.
"""

import numpy as np
from numba import njit

_FUSE = {"contract", "nsz", "arcp"}
_unsigned = np.uint64
_0, _1, _2 = (_unsigned(k) for k in range(3))
# numba would compile everything below anew for each plain True and False
_YES, _NO = np.True_, np.False_


@njit(cache=True, nogil=True)
def solve_ldl(band, inverse, count, width, x):
    """Solve ``A x = b`` with the symmetric factor of `ldl.factor_band` for every row of x (k, count), in place."""
    _solve_rows(band, band, _YES, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_ldl_one(band, inverse, count, width, x):
    """Solve ``A x = b`` as `solve_ldl`, for one right-hand side x (count,), in place."""
    _solve_one(band.reshape(-1), band.reshape(-1), band.shape[1], _YES, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu(lower, upper, inverse, count, width, x):
    """Solve ``A x = b`` with the factor of `lu.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(lower, upper, _NO, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu_one(lower, upper, inverse, count, width, x):
    """Solve ``A x = b`` as `solve_lu`, for one right-hand side x (count,), in place."""
    _solve_one(lower.reshape(-1), upper.reshape(-1), upper.shape[1], _NO, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu_transposed(lower, upper, inverse, count, width, x):
    """Solve ``A^T x = b`` with the factor of `lu.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(upper, lower, _YES, _NO, inverse, count, width, x)


@njit(cache=True)
def _solve_rows(forward, backward, scale_forth, scale_back, inverse, count, width, x):
    """``scale_forth``, ``scale_back``: whether F and G have the diagonal ``1 / inverse``."""
    col, row, stride, own = forward.reshape(-1), backward.reshape(-1), forward.shape[1], np.empty(count)
    fours = x.shape[0] // 4
    for k in range(fours):
        at = 4 * k
        x0, x1, x2, x3 = x[at], x[at + 1], x[at + 2], x[at + 3]
        _solve_four(col, row, stride, scale_forth, scale_back, inverse, count, width, x0, x1, x2, x3)
    for k in range(4 * fours, x.shape[0]):
        for r in range(count):
            own[r] = x[k, r]
        _solve_one(col, row, stride, scale_forth, scale_back, inverse, count, width, own)
        for r in range(count):
            x[k, r] = own[r]


@njit(cache=True, fastmath=_FUSE)
def _solve_one(col, row, stride, scale_forth, scale_back, inverse, count, width, x):
    """One right-hand side x (count,) with the rows of F and G in flat arrays, ``stride`` apart."""
    step, size, w = _unsigned(stride), _unsigned(count), _unsigned(width)
    along = step - _1
    for r in range(size):
        reach = w if w < r else r
        at, k, s, t = r * step - reach * along, r - reach, x[r], 0.0
        while k + _1 < r:
            s -= col[at] * x[k]
            t += col[at + along] * x[k + _1]
            at += along + along
            k += _2
        s -= t
        if k < r:
            s -= col[at] * x[k]
        x[r] = s * inverse[r] if scale_forth else s
    for q in range(size):
        i = size - _1 - q
        own, d, t = i * step, w if w < q else q, 0.0
        s = x[i] * row[own] if scale_forth and scale_back else x[i]
        while d > _1:
            s -= row[own + d] * x[i + d]
            t += row[own + d - _1] * x[i + d - _1]
            d -= _2
        s -= t
        if d > _0:
            s -= row[own + _1] * x[i + _1]
        x[i] = s * inverse[i] if scale_back else s


@njit(cache=True, fastmath=_FUSE)
def _solve_four(col, row, stride, scale_forth, scale_back, inverse, count, width, x0, x1, x2, x3):
    """Solve as `_solve_one`, for four right-hand sides at once."""
    step, size, w = _unsigned(stride), _unsigned(count), _unsigned(width)
    along = step - _1
    for r in range(size):
        reach = w if w < r else r
        at, k, s0, s1, s2, s3 = r * step - reach * along, r - reach, x0[r], x1[r], x2[r], x3[r]
        for _ in range(reach):
            f = col[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at += along
            k += _1
        f = inverse[r] if scale_forth else 1.0
        x0[r], x1[r], x2[r], x3[r] = f * s0, f * s1, f * s2, f * s3
    for q in range(size):
        i = size - _1 - q
        own, reach = i * step, w if w < q else q
        f = row[own] if scale_forth and scale_back else 1.0
        s0, s1, s2, s3 = f * x0[i], f * x1[i], f * x2[i], f * x3[i]
        at, k = own + reach, i + reach
        for _ in range(reach):
            f = row[at]
            s0 -= f * x0[k]
            s1 -= f * x1[k]
            s2 -= f * x2[k]
            s3 -= f * x3[k]
            at -= _1
            k -= _1
        f = inverse[i] if scale_back else 1.0
        x0[i], x1[i], x2[i], x3[i] = f * s0, f * s1, f * s2, f * s3
