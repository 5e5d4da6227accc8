"""Banded systems of a film: numbering of the unknowns, L D L^T of symmetric systems and L U of the others.

Numbering on a ring of columns
------------------------------
The matrix of the finite-volume Reynolds equation couples a cell with its two neighbours in theta and its two neighbours
in z. Active cells are numbered column by column (z fastest), so that the half-bandwidth is at most the number of
unknown rows. The ring of columns is cut

* behind a column without active cells, or without a link to the next one; else
* nowhere: the ring is folded (columns 0, n-1, 1, n-2, ...), which doubles the bandwidth.

The numbering depends on active set and links alone, not on earlier solutions.

L D L^T of symmetric systems
----------------------------
Storage: ``band[r, d] = A[r, r + d]``, followed by zeros, so that four pivots and vectors may read beyond the bandwidth.
Factor: ``A = U^T D^-1 U`` with ``U = D L^T`` stored in place of ``band`` and ``inv_diag = 1 / diag(U)``.

Symbols: n columns (theta), m rows (z), w half-bandwidth, kx / kz conductances of the links (i, j)-(i+1, j) and
(i, j)-(i, j+1).

The kernels process vectors of four neighbouring numbers, in explicit LLVM instructions. The rows of a film's bands have
about ten numbers, too few for the compiler's vector loops, and numba does not combine single numbers into vectors. On
processors without vectors of this size LLVM splits them into smaller ones.

L U without pivoting of the others
----------------------------------
The matrices are column diagonally dominant with non-positive off-diagonals, or close to it, so that no pivoting is
needed. Storage: ``lower[r, d] = A[r + d, r]`` and ``upper[r, d] = A[r, r + d]``, d = 0 .. w, zeros behind;
``lower[:, 0]`` is not used. After the factorisation ``A = L U`` with unit L: ``lower`` holds L's columns, ``upper`` U's
rows, ``inv_diag = 1 / diag(U)``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from llvmlite import ir
from numba import njit, types
from numba.core.base import BaseContext
from numba.core.errors import TypingError
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

from exudyn_ehd.compilation import FUSED, U0, U1, U2, U3, U4, unsigned


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


LANES = 4
_int32 = ir.IntType(32)
_vector = ir.VectorType(ir.DoubleType(), LANES)


def _require_contiguous(*arrays: types.Array) -> None:
    """Raise `TypingError` for arrays that are not contiguous, when a kernel is compiled."""
    if any(array.layout != "C" for array in arrays):
        raise TypingError(f"vectors are read from and written to contiguous arrays, got {arrays}")


def _place(context: BaseContext, builder: ir.IRBuilder, kind: types.Array, array: ir.Value, at: ir.Value) -> ir.Value:
    """Return a pointer to the vector that begins at a flat index."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), _vector.as_pointer())


def _subtract(count: int) -> Callable:
    """Return the generator of code that subtracts ``count`` vectors, each times its factor."""

    def generate(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        target, at, source, *rest = arguments
        goal = _place(context, builder, signature.args[0], target, at)
        total = builder.load(goal, align=8)
        for place, factor in zip(rest[:count], rest[count:], strict=True):
            known = builder.load(_place(context, builder, signature.args[2], source, place), align=8)
            lane = builder.insert_element(ir.Constant(_vector, ir.Undefined), factor, _int32(0))
            mask = ir.Constant(ir.VectorType(_int32, LANES), None)
            spread = builder.shuffle_vector(lane, ir.Constant(_vector, ir.Undefined), mask)
            product = builder.fmul(spread, known, flags=("contract", "nsz"))
            total = builder.fsub(total, product, flags=("contract", "nsz"))
        builder.store(total, goal, align=8)
        return context.get_dummy_value()

    return generate


def _signature(target: types.Array, source: types.Array, count: int) -> Signature:
    _require_contiguous(target, source)
    return types.void(target, types.uint64, source, *count * (types.uint64,), *count * (types.float64,))


@intrinsic
def subtract_lanes(typingctx, target, at, source, p, f):
    """Set target[at : at + 4] -= f source[p : p + 4], for flat arrays and unsigned indices."""
    return _signature(target, source, 1), _subtract(1)


@intrinsic
def subtract_four_lanes(typingctx, target, at, source, p0, p1, p2, p3, f0, f1, f2, f3):
    """Set target[at : at + 4] -= f0 source[p0 : p0 + 4] + f1 source[p1 : p1 + 4] + ..., as `subtract_lanes`."""
    return _signature(target, source, 4), _subtract(4)


@njit(cache=True)
def assemble_band(kx, kz, number, order, count, width, band_out):
    """Fill the upper band of the matrix of the active cells.

    The last row's links in z have no conductance. The sign of flat unsigned indices need not be checked.
    """
    n, m = number.shape
    along, across, places, flat = kx.reshape(-1), kz.reshape(-1), number.reshape(-1), band_out.reshape(-1)
    size, rows, stride = unsigned(n * m), unsigned(m), unsigned(band_out.shape[1])
    for q in range(flat.size):
        flat[q] = 0.0
    for r in range(count):
        c, row = unsigned(order[r]), unsigned(r) * stride
        before, on = c - U1 if c > U0 else size - U1, c + U1 if c + U1 < size else U0
        prv, nxt = c - rows if c >= rows else c + size - rows, c + rows if c + rows < size else c + rows - size
        flat[row] += along[prv] + along[c] + across[before] + across[c]
        b = places[on]
        if b > r:
            flat[row + unsigned(b - r)] -= across[c]
        b = places[nxt]
        if along[c] != 0.0 and b >= 0:
            flat[unsigned(min(b, r)) * stride + unsigned(abs(b - r))] -= along[c]


@njit(cache=True, fastmath=FUSED)
def factor_band(band, count, width, inv_diag_out):
    """Factor a symmetric band in place, four pivots at a time; returns False if a pivot is not positive."""
    flat, stride, w, size = band.reshape(-1), unsigned(band.shape[1]), unsigned(width), unsigned(count)
    for block in range((count + 3) // 4):
        k = U4 * unsigned(block)
        if not _factor_four(flat, stride, k, min(U4, size - k), w, inv_diag_out):
            return False
        row0 = k * stride
        row1, row2, row3 = row0 + stride, row0 + U2 * stride, row0 + U3 * stride
        for i in range(k + U4, min(size, k + U4 + w)):
            d = i - k - U3
            p0, p1, p2, p3 = row0 + d + U3, row1 + d + U2, row2 + d + U1, row3 + d
            f0, f1 = flat[p0] * inv_diag_out[k], flat[p1] * inv_diag_out[k + U1]
            f2, f3 = flat[p2] * inv_diag_out[k + U2], flat[p3] * inv_diag_out[k + U3]
            own, t = i * stride, U0
            while t <= w - d:
                subtract_four_lanes(flat, own + t, flat, p0 + t, p1 + t, p2 + t, p3 + t, f0, f1, f2, f3)
                t += U4
    return True


@njit(cache=True, fastmath=FUSED)
def _factor_four(flat, stride, k, rows, w, inv_diag_out):
    """Eliminate up to four rows from k on with each other; returns False if a pivot is not positive."""
    for q in range(rows):
        row = (k + q) * stride
        if not flat[row] > 0.0:
            return False
        inverse = 1.0 / flat[row]
        inv_diag_out[k + q] = inverse
        for s in range(q + U1, min(rows, q + w + U1)):
            d = s - q
            own, factor, t = (k + s) * stride, flat[row + d] * inverse, U0
            while t <= w - d:
                subtract_lanes(flat, own + t, flat, row + d + t, factor)
                t += U4
    return True


@njit(cache=True, fastmath=FUSED)
def factor_lu(lower, upper, count, width, inv_diag_out):
    """Factor both bands in place, four pivots at a time; returns False if a pivot vanishes."""
    low, up, stride = lower.reshape(-1), upper.reshape(-1), unsigned(upper.shape[1])
    w, size = unsigned(width), unsigned(count)
    for block in range((count + 3) // 4):
        k = U4 * unsigned(block)
        if not _factor_lu_four(low, up, stride, k, min(U4, size - k), w, inv_diag_out):
            return False
        row0 = k * stride
        row1, row2, row3 = row0 + stride, row0 + U2 * stride, row0 + U3 * stride
        for i in range(k + U4, min(size, k + U4 + w)):
            d = i - k - U3
            p0, p1, p2, p3 = row0 + d + U3, row1 + d + U2, row2 + d + U1, row3 + d
            a0, a1, a2, a3 = low[p0], low[p1], low[p2], low[p3]
            b0, b1, b2, b3 = up[p0], up[p1], up[p2], up[p3]
            own, t = i * stride, U0
            while t <= w - d:
                subtract_four_lanes(up, own + t, up, p0 + t, p1 + t, p2 + t, p3 + t, a0, a1, a2, a3)
                subtract_four_lanes(low, own + t, low, p0 + t, p1 + t, p2 + t, p3 + t, b0, b1, b2, b3)
                t += U4
    return True


@njit(cache=True, fastmath=FUSED)
def _factor_lu_four(low, up, stride, k, rows, w, inv_diag_out):
    """Eliminate up to four rows of U and columns of L from k on with each other; returns False if a pivot vanishes."""
    for q in range(rows):
        row = (k + q) * stride
        if not abs(up[row]) > 1e-300:
            return False
        inverse = 1.0 / up[row]
        inv_diag_out[k + q] = inverse
        for d in range(U1, w + U1):
            low[row + d] *= inverse
        for s in range(q + U1, min(rows, q + w + U1)):
            d = s - q
            own, a, b, t = (k + s) * stride, low[row + d], up[row + d], U0
            while t <= w - d:
                subtract_lanes(up, own + t, up, row + d + t, a)
                subtract_lanes(low, own + t, low, row + d + t, b)
                t += U4
    return True
