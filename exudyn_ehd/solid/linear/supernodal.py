"""Substitutions with a sparse symmetric factor, in dense panels.

SuperLU's substitutions gather entry by entry; a mesh's factor has hundreds of columns in a row with the same pattern,
its supernodes (`exudyn_ehd.solid.linear.elimination`). Stored as dense panels (a triangle and the rows below it, column
by column) they take half the memory, since there is no U, and

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
from scipy.sparse import csc_matrix, spmatrix
from scipy.sparse.linalg import SuperLU, splu

from exudyn_ehd.solid.linear.elimination import Elimination

# Largest difference of mirrored entries over the row's diagonal with which a matrix counts as symmetric.
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


def mesh_factor(A: spmatrix, known: Elimination | None = None) -> SupernodalFactor | SuperLU:
    """Factor of a mesh's matrix: in panels, or SuperLU's own where it is not symmetric.

    ``known`` is the analysis of a matrix before, which is used again if the pattern is the same.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    A = A.tocsc()
    A.sort_indices()
    return SupernodalFactor.of(A, known) or sparse_factor(A)


@dataclass(frozen=True, kw_only=True, eq=False)
class SupernodalFactor:
    """L D L^T of a symmetric matrix in panels.

    Parameters
    ----------
    analysis : Elimination
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

    analysis: Elimination
    order: np.ndarray
    starts: np.ndarray
    firsts: np.ndarray
    offsets: np.ndarray
    rows: np.ndarray
    panels: np.ndarray
    pivots: np.ndarray

    @classmethod
    def of(cls, A: csc_matrix, known: Elimination | None = None) -> SupernodalFactor | None:
        """Factor of a matrix with sorted rows, with the known analysis if it fits; None if it is not symmetric.

        Raises
        ------
        RuntimeError
            If a pivot is zero.
        """
        analysis = known if known is not None and known.fits(A) else Elimination.of(A)
        if analysis is None:
            return None
        difference = A.data - A.data[analysis.mirror]
        # most mirrored entries are the same bit for bit; nan is not
        odd = np.flatnonzero(difference)
        if not (np.abs(difference[odd]) <= ASYMMETRY * np.abs(A.diagonal())[A.indices[odd]]).all():
            return None
        panels, pivots = analysis.factorise(A.data)
        if not np.isfinite(pivots).all() or not pivots.all():
            raise RuntimeError("singular")
        return cls(
            analysis=analysis,
            order=analysis.order,
            starts=analysis.starts,
            firsts=analysis.firsts,
            offsets=analysis.offsets,
            rows=analysis.rows,
            panels=panels,
            pivots=pivots,
        )

    @property
    def nbytes(self) -> int:
        """Memory, bytes."""
        return sum(x.nbytes for x in (self.order, self.rows, self.panels, self.pivots))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution of one right-hand side (n,), or of several (n, k)."""
        # in the panels' precision, whose range is small
        scale = float(np.abs(right).max(initial=0.0)) or 1.0
        x = np.empty(right.shape, dtype=self.panels.dtype)
        x[self.order] = right / scale
        if right.ndim > 1:
            self._substitute_columns(x)
        else:
            below = np.empty(int(np.diff(self.firsts).max()), dtype=x.dtype)
            substitute(self.starts, self.firsts, self.offsets, self.rows, self.panels, self.pivots, below, x)
        return scale * x[self.order].astype(float)

    def rounded(self, error: float) -> SupernodalFactor:
        """The same in single precision if solutions are within that relative error; a factor is read from memory."""
        single = replace(self, panels=self.panels.astype(np.float32), pivots=self.pivots.astype(np.float32))
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
            # loads at few places reach few supernodes
            if not x[a:b].any():
                continue
            triangle, below = blocks(a, b, j - i, offset)
            x[a:b] = solve_triangular(triangle, x[a:b], lower=True, unit_diagonal=True, check_finite=False)
            x[self.rows[i:j]] -= below @ x[a:b]
        x /= self.pivots[:, None]
        for a, b, i, j, offset in reversed(parts):
            triangle, below = blocks(a, b, j - i, offset)
            rest = x[a:b] - below.T @ x[self.rows[i:j]]
            x[a:b] = solve_triangular(triangle, rest, trans=1, lower=True, unit_diagonal=True, check_finite=False)


@njit(cache=True, fastmath={"contract", "reassoc"})
def substitute(starts, firsts, offsets, rows, panels, pivots, below, x_out):
    """Solve L D L^T x = x_out in place.

    Four columns of a panel at a time, so that sums along its rows stay in registers.

    Parameters
    ----------
    starts, firsts, offsets, rows, panels, pivots : as in `SupernodalFactor`
    below : (r,) array, as x_out
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
