"""Substitutions with a sparse symmetric factor, in dense panels.

SuperLU factorises a symmetric matrix without pivoting as P^T A P = L U, U = D L^T. Its substitutions gather entry by
entry; a mesh's factor has hundreds of columns in a row with the same pattern, its supernodes. Stored as dense panels
(a triangle and the rows below it, column by column) they take half the memory, since U is not stored, and

    forward    x_s = L_ss^-1 x_s,    x_b -= L_bs x_s       supernodes s in order, b the rows below
    middle     x = D^-1 x
    backward   x_s = L_ss^-T (x_s - L_bs^T x_b)            supernodes in reverse order

run along contiguous columns. Many right-hand sides go through the same loop in matrix products.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from scipy.linalg import solve_triangular
from scipy.sparse import diags, spmatrix
from scipy.sparse.linalg import SuperLU, splu

# Columns of a panel at most: beyond, its triangle is mostly zeros.
WIDEST = 64
# Largest departure of U from D L^T over the row's pivot with which a factor counts as symmetric.
ASYMMETRY = 1e-9


def sparse_factor(A: spmatrix, *, pivoting: float = 0.0) -> SuperLU:
    """SuperLU of a matrix with a symmetric pattern, which keeps its diagonal as pivots from that share of a column on.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    options = {"SymmetricMode": True}
    return splu(A.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=pivoting, options=options)


def mesh_factor(A: spmatrix) -> SupernodalFactor | SuperLU:
    """Factor of a mesh's matrix: in panels, or SuperLU's own where it is not symmetric.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    factor = sparse_factor(A)
    return SupernodalFactor.of(factor) or factor


@dataclass(frozen=True, kw_only=True, eq=False)
class SupernodalFactor:
    """L D L^T of a symmetric matrix in panels.

    Parameters
    ----------
    order : (n,) array of int
        Place of a coordinate in the order of elimination.
    starts : (s + 1,) array of int
        First columns of the supernodes.
    firsts, offsets : (s + 1,) arrays of int
        Where rows and panels of the supernodes begin.
    rows : array of int
        Rows below the supernodes.
    panels : array
        Triangle of every supernode as a full square, then its rows below, column by column.
    pivots : (n,) array
        D.
    """

    order: np.ndarray
    starts: np.ndarray
    firsts: np.ndarray
    offsets: np.ndarray
    rows: np.ndarray
    panels: np.ndarray
    pivots: np.ndarray

    @classmethod
    def of(cls, factor: SuperLU) -> SupernodalFactor | None:
        """SuperLU's factor in panels; None if it is not symmetric or its pivots did not stay on the diagonal."""
        L, U = factor.L.tocsc(), factor.U.tocsr()
        pivots = U.diagonal()
        if not np.array_equal(factor.perm_r, factor.perm_c) or not (np.abs(pivots) > 0.0).all():
            return None
        departure = abs(U - diags(pivots) @ L.T.tocsr()).max(axis=1).toarray().ravel()
        if (departure > ASYMMETRY * np.abs(pivots)).any():
            return None
        L.sort_indices()
        starts = np.array(find_supernodes(L.indptr, L.indices))
        width = np.diff(starts)
        below = np.diff(L.indptr)[starts[:-1]] - width
        firsts, offsets = (np.concatenate([[0], np.cumsum(x)]) for x in (below, width * (width + below)))
        rows, panels = np.empty(firsts[-1], dtype=np.int32), np.zeros(offsets[-1])
        fill_panels(starts, firsts, offsets, L.indptr, L.indices, L.data, rows, panels)
        return cls(
            order=factor.perm_r.astype(np.intp),
            starts=starts,
            firsts=firsts,
            offsets=offsets,
            rows=rows,
            panels=panels,
            pivots=pivots,
        )

    @property
    def nbytes(self) -> int:
        """Memory, bytes."""
        return sum(x.nbytes for x in (self.order, self.rows, self.panels, self.pivots))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution of one right-hand side (n,), or of several (n, k)."""
        x = np.empty(right.shape)
        x[self.order] = right
        if right.ndim > 1:
            self._substitute_columns(x)
        else:
            below = np.empty(int(np.diff(self.firsts).max()))
            substitute(self.starts, self.firsts, self.offsets, self.rows, self.panels, self.pivots, below, x)
        return x[self.order]

    def rounded(self, error: float) -> SupernodalFactor:
        """The same in single precision if solutions are within that relative error; a factor is read from memory."""
        single = replace(self, panels=self.panels.astype(np.float32))
        probe = np.sin(np.arange(1.0, len(self.pivots) + 1))
        exact = self.solve(probe)
        return single if np.linalg.norm(single.solve(probe) - exact) <= error * np.linalg.norm(exact) else self

    def _substitute_columns(self, x: np.ndarray) -> None:
        parts = list(zip(self.starts[:-1], self.starts[1:], self.firsts, self.firsts[1:], self.offsets, strict=False))

        def blocks(a: int, b: int, size: int, offset: int) -> tuple[np.ndarray, np.ndarray]:
            width = b - a
            panel = self.panels[offset : offset + width * (width + size)]
            return panel[: width * width].reshape(width, width).T, panel[width * width :].reshape(width, size).T

        for a, b, i, j, offset in parts:
            triangle, below = blocks(a, b, j - i, offset)
            x[a:b] = solve_triangular(triangle, x[a:b], lower=True, unit_diagonal=True, check_finite=False)
            x[self.rows[i:j]] -= below @ x[a:b]
        x /= self.pivots[:, None]
        for a, b, i, j, offset in reversed(parts):
            triangle, below = blocks(a, b, j - i, offset)
            rest = x[a:b] - below.T @ x[self.rows[i:j]]
            x[a:b] = solve_triangular(triangle, rest, trans=1, lower=True, unit_diagonal=True, check_finite=False)


@njit(cache=True)
def find_supernodes(indptr, indices):
    """First columns of runs in which each pattern is the one before without its first row, and n.

    Exact zeros are not stored, so that patterns are compared row by row.
    """
    starts = [0]
    for j in range(1, len(indptr) - 1):
        first, size = indptr[j - 1] + 1, indptr[j + 1] - indptr[j]
        same = j - starts[-1] < WIDEST and indptr[j] - first == size
        k = 0
        while same and k < size:
            same = indices[first + k] == indices[indptr[j] + k]
            k += 1
        if not same:
            starts.append(j)
    starts.append(len(indptr) - 1)
    return starts


@njit(cache=True)
def fill_panels(starts, firsts, offsets, indptr, indices, values, rows_out, panels_out):
    """Dense panels of a lower triangle in sorted columns.

    Parameters
    ----------
    starts, firsts, offsets : as in `SupernodalFactor`
    indptr, indices, values : compressed columns, the diagonal first
    rows_out, panels_out : as in `SupernodalFactor`; panels zero
    """
    for s in range(len(starts) - 1):
        a, width = starts[s], starts[s + 1] - starts[s]
        below = firsts[s + 1] - firsts[s]
        for k in range(below):
            rows_out[firsts[s] + k] = indices[indptr[a] + width + k]
        for j in range(width):
            first = indptr[a + j]
            for k in range(width - j):
                panels_out[offsets[s] + j * width + j + k] = values[first + k]
            for k in range(below):
                panels_out[offsets[s] + width * width + j * below + k] = values[first + width - j + k]


@njit(cache=True, fastmath={"contract", "reassoc"})
def substitute(starts, firsts, offsets, rows, panels, pivots, below, x_out):
    """Solve L D L^T x = x_out in place.

    Four columns of a panel at a time, so that sums along its rows stay in registers.

    Parameters
    ----------
    starts, firsts, offsets, rows, panels, pivots : as in `SupernodalFactor`
    below : (r,) array
        Of use within; r is the most rows below a supernode.
    x_out : (n,) array
        In the order of elimination.
    """
    supernodes = len(starts) - 1
    for s in range(supernodes):
        a, width, size = starts[s], starts[s + 1] - starts[s], firsts[s + 1] - firsts[s]
        own, places = x_out[a : a + width], rows[firsts[s] : firsts[s + 1]]
        for j in range(width):
            column = panels[offsets[s] + j * width : offsets[s] + (j + 1) * width]
            moved = own[j]
            for i in range(j + 1, width):
                own[i] -= column[i] * moved
        sums, p = below[:size], offsets[s] + width * width
        sums[:] = 0.0
        for j in range(0, width - width % 4, 4):
            c0, c1, c2, c3 = _four(panels, p + j * size, size)
            x0, x1, x2, x3 = own[j], own[j + 1], own[j + 2], own[j + 3]
            for k in range(size):
                sums[k] += c0[k] * x0 + c1[k] * x1 + c2[k] * x2 + c3[k] * x3
        for j in range(width - width % 4, width):
            column, x0 = panels[p + j * size : p + (j + 1) * size], own[j]
            for k in range(size):
                sums[k] += column[k] * x0
        for k in range(size):
            x_out[places[k]] -= sums[k]
    for j in range(len(pivots)):
        x_out[j] /= pivots[j]
    for s in range(supernodes - 1, -1, -1):
        a, width, size = starts[s], starts[s + 1] - starts[s], firsts[s + 1] - firsts[s]
        own, places = x_out[a : a + width], rows[firsts[s] : firsts[s + 1]]
        values, p = below[:size], offsets[s] + width * width
        for k in range(size):
            values[k] = x_out[places[k]]
        for j in range(0, width - width % 4, 4):
            c0, c1, c2, c3 = _four(panels, p + j * size, size)
            x0, x1, x2, x3 = 0.0, 0.0, 0.0, 0.0
            for k in range(size):
                x0 += c0[k] * values[k]
                x1 += c1[k] * values[k]
                x2 += c2[k] * values[k]
                x3 += c3[k] * values[k]
            own[j] -= x0
            own[j + 1] -= x1
            own[j + 2] -= x2
            own[j + 3] -= x3
        for j in range(width - width % 4, width):
            column, x0 = panels[p + j * size : p + (j + 1) * size], 0.0
            for k in range(size):
                x0 += column[k] * values[k]
            own[j] -= x0
        for j in range(width - 1, -1, -1):
            column = panels[offsets[s] + j * width : offsets[s] + (j + 1) * width]
            total = 0.0
            for i in range(j + 1, width):
                total += column[i] * own[i]
            own[j] -= total


@njit(cache=True, inline="always")
def _four(panels, p, size):
    return (
        panels[p : p + size],
        panels[p + size : p + 2 * size],
        panels[p + 2 * size : p + 3 * size],
        panels[p + 3 * size : p + 4 * size],
    )
