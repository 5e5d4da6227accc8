"""Forward and back substitution with a stored band factor, for a handful of right-hand sides as rows.

For dozens see `many_sides`.

``A = F^T G`` with F's rows in ``forward`` and G's in ``backward``, stored as in `ldl` and `lu`. One of the two
triangles, or both, come with the diagonal ``1 / inverse``, else with ones:

* `solve_lu`: F^T = L with ones, G = U;
* `solve_lu_transposed`: F^T = U^T, G = L^T with ones;
* `solve_ldl`: ``A = U^T D^-1 U``, both U, so that the back substitution starts from D times what came forward.

One right-hand side meets four rows of the factor at a time, as vectors. Four right-hand sides meet three: twelve dot
products that stay in registers, with flat unsigned indices, which spare the slices and sign checks that would outweigh
the arithmetic of short rows.
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lanes import dot_four_lanes, put_four_lanes, subtract_four_lanes

# Without leave to reassociate short dot products are not turned into gathers, which are slower.
_KEEP_ORDER = {"contract", "nsz", "arcp"}
_unsigned = np.uint64
_0, _1, _2, _3, _4 = (_unsigned(k) for k in range(5))
_8 = _unsigned(8)
# A step back, as unsigned indices wrap.
_back = _unsigned(2**64 - 1)
# numba would compile everything below anew for each plain True and False
_YES, _NO = np.True_, np.False_


@njit(cache=True, nogil=True)
def solve_ldl(band, inverse, count, width, x):
    """Solve ``A x = b`` with the symmetric factor of `ldl.factor_band` for every row of x (k, count), in place."""
    _solve_rows(band, band, _YES, _YES, inverse, count, width, x)


@njit(cache=True, inline="always")
def solve_ldl_one(band, inverse, count, width, x):
    """As `solve_ldl` for one right-hand side x (count,), in kernels that need no more."""
    _solve_one(band, band, _YES, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu(lower, upper, inverse, count, width, x):
    """Solve ``A x = b`` with the factor of `lu.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(lower, upper, _NO, _YES, inverse, count, width, x)


@njit(cache=True, inline="always")
def solve_lu_one(lower, upper, inverse, count, width, x):
    """As `solve_lu` for one right-hand side x (count,), in kernels that need no more."""
    _solve_one(lower, upper, _NO, _YES, inverse, count, width, x)


@njit(cache=True)
def solve_lu_transposed(lower, upper, inverse, count, width, x):
    """Solve ``A^T x = b`` with the factor of `lu.factor_lu` for every row of x (k, count), in place."""
    _solve_rows(upper, lower, _YES, _NO, inverse, count, width, x)


@njit(cache=True)
def _solve_rows(forward, backward, scale_forth, scale_back, inverse, count, width, x):
    """``scale_forth``, ``scale_back``: whether F and G have the diagonal ``1 / inverse``."""
    fours = x.shape[0] - x.shape[0] % 4
    for k in range(0, fours, 4):
        _solve_four(forward, backward, scale_forth, scale_back, inverse, count, width, x[k : k + 4])
    for k in range(fours, x.shape[0]):
        # vectors want neighbours side by side, whatever the order of the rows' array
        row = np.ascontiguousarray(x[k])
        _solve_one(forward, backward, scale_forth, scale_back, inverse, count, width, row)
        x[k] = row


@njit(cache=True, fastmath=_KEEP_ORDER)
def _solve_one(forward, backward, scale_forth, scale_back, inverse, count, width, x):
    """One right-hand side x (count,), four rows at a time as long as vectors end within it."""
    col, row = forward.reshape(-1), backward.reshape(-1)
    stride, w, size = _unsigned(forward.shape[1]), _unsigned(width), _unsigned(count)
    reach = (w + _3) // _4 * _4
    blocks = (size - reach) // _4 if size > reach else _0
    i0 = i1 = i2 = i3 = d0 = d1 = d2 = d3 = 1.0
    # the next four rows are carried in single numbers: they would wait for a vector to be stored and read
    t0, t1, t2, t3 = (x[0], x[1], x[2], x[3]) if blocks > _0 else (0.0, 0.0, 0.0, 0.0)
    for block in range(blocks):
        r = _4 * block
        row0 = r * stride
        row1 = row0 + stride
        row2 = row1 + stride
        row3 = row2 + stride
        if scale_forth:
            i0, i1, i2, i3 = inverse[r], inverse[r + _1], inverse[r + _2], inverse[r + _3]
        s0 = t0 * i0
        s1 = (t1 - col[row0 + _1] * s0) * i1
        s2 = (t2 - col[row0 + _2] * s0 - col[row1 + _1] * s1) * i2
        s3 = (t3 - col[row0 + _3] * s0 - col[row1 + _2] * s1 - col[row2 + _1] * s2) * i3
        x[r], x[r + _1], x[r + _2], x[r + _3] = s0, s1, s2, s3
        c0, c1, c2, c3 = row0 + _4, row1 + _3, row2 + _2, row3 + _1
        n = r + _4
        t0 = x[n] - col[c0] * s0 - col[c1] * s1 - col[c2] * s2 - col[c3] * s3
        t1 = x[n + _1] - col[c0 + _1] * s0 - col[c1 + _1] * s1 - col[c2 + _1] * s2 - col[c3 + _1] * s3
        t2 = x[n + _2] - col[c0 + _2] * s0 - col[c1 + _2] * s1 - col[c2 + _2] * s2 - col[c3 + _2] * s3
        t3 = x[n + _3] - col[c0 + _3] * s0 - col[c1 + _3] * s1 - col[c2 + _3] * s2 - col[c3 + _3] * s3
        q = _4
        while q < reach:
            subtract_four_lanes(x, n + q, col, c0 + q, c1 + q, c2 + q, c3 + q, s0, s1, s2, s3)
            q += _4
    whole = _4 * blocks
    if blocks > _0:
        x[whole], x[whole + _1], x[whole + _2], x[whole + _3] = t0, t1, t2, t3
    _solve_rest(col, row, stride, scale_forth, scale_back, inverse, whole, size, w, whole, x)
    i0 = i1 = i2 = i3 = 1.0
    s0, s1, s2, s3 = (x[whole], x[whole + _1], x[whole + _2], x[whole + _3]) if blocks > _0 else (0.0, 0.0, 0.0, 0.0)
    for block in range(blocks):
        r = _4 * (blocks - block - _1)
        row0 = r * stride
        row1 = row0 + stride
        row2 = row1 + stride
        row3 = row2 + stride
        c0, c1, c2, c3 = row0 + _4, row1 + _3, row2 + _2, row3 + _1
        t0, t1, t2, t3 = dot_four_lanes(row, c0 + _4, c1 + _4, c2 + _4, c3 + _4, x, r + _8, reach - _4)
        if scale_back:
            i0, i1, i2, i3 = inverse[r], inverse[r + _1], inverse[r + _2], inverse[r + _3]
            if scale_forth:
                d0, d1, d2, d3 = row[row0], row[row1], row[row2], row[row3]
        t3 = d3 * x[r + _3] - t3 - row[c3 + _3] * s3 - row[c3 + _2] * s2 - row[c3 + _1] * s1 - row[c3] * s0
        t2 = d2 * x[r + _2] - t2 - row[c2 + _3] * s3 - row[c2 + _2] * s2 - row[c2 + _1] * s1 - row[c2] * s0
        t1 = d1 * x[r + _1] - t1 - row[c1 + _3] * s3 - row[c1 + _2] * s2 - row[c1 + _1] * s1 - row[c1] * s0
        t0 = d0 * x[r] - t0 - row[c0 + _3] * s3 - row[c0 + _2] * s2 - row[c0 + _1] * s1 - row[c0] * s0
        s3 = t3 * i3
        s2 = (t2 - row[row2 + _1] * s3) * i2
        s1 = (t1 - row[row1 + _2] * s3 - row[row1 + _1] * s2) * i1
        s0 = (t0 - row[row0 + _3] * s3 - row[row0 + _2] * s2 - row[row0 + _1] * s1) * i0
        put_four_lanes(x, r, s0, s1, s2, s3)


@njit(cache=True, fastmath=_KEEP_ORDER)
def _solve_rest(col, row, stride, scale_forth, scale_back, inverse, whole, size, w, known, x):
    """Forth and back through the last rows, from ``whole`` on, of which those below ``known`` are subtracted."""
    for r in range(whole, size):
        s = x[r]
        for k in range(max(r - min(w, r), known), r):
            s -= col[k * stride + r - k] * x[k]
        x[r] = s * inverse[r] if scale_forth else s
    for q in range(size - whole):
        r = size - _1 - q
        s = x[r] * row[r * stride] if scale_forth and scale_back else x[r]
        for d in range(_1, min(w, q) + _1):
            s -= row[r * stride + d] * x[r + d]
        x[r] = s * inverse[r] if scale_back else s


@njit(cache=True, inline="always")
def _subtract(a, at, between, step, x, k, forth, reach, s0, s1, s2):
    """Three rows s (4,) less ``reach`` threes of ``a``, ``between`` apart, ``step`` on, times x at k, k + forth ..."""
    x0, x1, x2, x3 = x
    s00, s01, s02, s03 = s0
    s10, s11, s12, s13 = s1
    s20, s21, s22, s23 = s2
    for _ in range(reach):
        f0, f1, f2 = a[at], a[at + between], a[at + between + between]
        g = x0[k]
        s00 -= f0 * g
        s10 -= f1 * g
        s20 -= f2 * g
        g = x1[k]
        s01 -= f0 * g
        s11 -= f1 * g
        s21 -= f2 * g
        g = x2[k]
        s02 -= f0 * g
        s12 -= f1 * g
        s22 -= f2 * g
        g = x3[k]
        s03 -= f0 * g
        s13 -= f1 * g
        s23 -= f2 * g
        at += step
        k += forth
    return (s00, s01, s02, s03), (s10, s11, s12, s13), (s20, s21, s22, s23)


@njit(cache=True, inline="always")
def _at(x, r, d):
    """Row r of four right-hand sides, times d."""
    return d * x[0][r], d * x[1][r], d * x[2][r], d * x[3][r]


@njit(cache=True, inline="always")
def _times(s, i):
    return s[0] * i, s[1] * i, s[2] * i, s[3] * i


@njit(cache=True, inline="always")
def _put(x, r, s):
    x[0][r], x[1][r], x[2][r], x[3][r] = s


@njit(cache=True, inline="always")
def _less(s, f, known, i):
    """(s - f known) i, four right-hand sides."""
    return (s[0] - f * known[0]) * i, (s[1] - f * known[1]) * i, (s[2] - f * known[2]) * i, (s[3] - f * known[3]) * i


@njit(cache=True, fastmath=_KEEP_ORDER)
def _solve_four(forward, backward, scale_forth, scale_back, inverse, count, width, rows):
    """As `_solve_one` for four right-hand sides (4, count) at once."""
    col, row = forward.reshape(-1), backward.reshape(-1)
    stride = _unsigned(forward.shape[1])
    along = stride - _1
    w, size = _unsigned(width), _unsigned(count)
    whole = size - size % _3
    x = rows[0], rows[1], rows[2], rows[3]
    i0 = i1 = i2 = d0 = d1 = d2 = 1.0
    for panel in range(whole // _3):
        r = _3 * panel
        reach = min(w, r)
        own = r * stride
        s0, s1, s2 = _subtract(
            col,
            own - reach * along,
            _1,
            along,
            x,
            r - reach,
            _1,
            reach,
            _at(x, r, 1.0),
            _at(x, r + _1, 1.0),
            _at(x, r + _2, 1.0),
        )
        if scale_forth:
            i0, i1, i2 = inverse[r], inverse[r + _1], inverse[r + _2]
        s0 = _times(s0, i0)
        s1 = _less(s1, col[own + _1], s0, i1)
        s2 = _less(_less(s2, col[own + _2], s0, 1.0), col[own + stride + _1], s1, i2)
        _put(x, r, s0)
        _put(x, r + _1, s1)
        _put(x, r + _2, s2)
    for k in range(4):
        _solve_rest(col, row, stride, scale_forth, scale_back, inverse, whole, size, w, _0, rows[k])
    i0 = i1 = i2 = 1.0
    for panel in range(whole // _3):
        r = whole - _3 * panel - _3
        own = r * stride
        reach = min(w, size - r - _3)
        d = _2 + reach
        if scale_back:
            i0, i1, i2 = inverse[r], inverse[r + _1], inverse[r + _2]
            if scale_forth:
                d0, d1, d2 = row[own], row[own + stride], row[own + stride + stride]
        s0, s1, s2 = _subtract(
            row, own + d, along, _back, x, r + d, _back, reach, _at(x, r, d0), _at(x, r + _1, d1), _at(x, r + _2, d2)
        )
        s2 = _times(s2, i2)
        s1 = _less(s1, row[own + stride + _1], s2, i1)
        s0 = _less(_less(s0, row[own + _2], s2, 1.0), row[own + _1], s1, i0)
        _put(x, r, s0)
        _put(x, r + _1, s1)
        _put(x, r + _2, s2)
