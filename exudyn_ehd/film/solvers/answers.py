"""What the matrix of a film at its solution answers: adjoints and small changes, with the factor at hand."""

from __future__ import annotations

import abc

import numpy as np
from scipy.sparse import csc_matrix, diags_array

from exudyn_ehd.film.banded.assemble import dense_band
from exudyn_ehd.film.banded.many_sides import solve_in_tiles
from exudyn_ehd.film.banded.substitution import solve_ldl, solve_lu, solve_lu_transposed
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import scatter


class FilmAnswers(abc.ABC):
    """Answers of a solved film with its matrix A, factored as L D L^T if ``symmetric``, else as L U."""

    grid: FilmGrid
    work: Workspace
    symmetric: bool

    @abc.abstractmethod
    def factor_solution(self) -> None:
        """Make the factor in the workspace that of the last solution."""

    def adjoint(self, rhs: np.ndarray) -> np.ndarray:
        """Solve ``A^T lam = rhs`` with the stored factor; rhs (k, count) is overwritten, fields (k, n, m) come back."""
        w = self.work
        self.solve_transposed(rhs)
        fields = np.empty((rhs.shape[0], *self.grid.shape))
        scatter(rhs, w.order, w.count, fields)
        return fields

    def solve_transposed(self, rhs: np.ndarray) -> None:
        """Solve ``A^T lam = rhs`` for every row of rhs (k, count), in place."""
        w = self.work
        self.factor_solution()
        if self.symmetric:
            solve_ldl(w.band, w.inv_diag, w.count, w.width, rhs)
        else:
            solve_lu_transposed(*self._bands(), w.inv_diag, w.count, w.width, rhs)

    def adjoint_columns(self, rhs: np.ndarray) -> None:
        """Solve ``A^T lam = rhs`` for every column of tiles rhs, as returned by `make_tiles`, in place."""
        w = self.work
        self.factor_solution()
        upper, lower = (w.band, w.band) if self.symmetric else self._bands()[::-1]
        solve_in_tiles(upper, lower, w.inv_diag, self.symmetric, w.count, w.width, rhs)

    def direct(self, rhs: np.ndarray) -> None:
        """Solve ``A du = rhs`` for rhs (count,), in place."""
        w = self.work
        self.factor_solution()
        if self.symmetric:
            solve_ldl(w.band, w.inv_diag, w.count, w.width, rhs.reshape(1, -1))
        else:
            solve_lu(*self._bands(), w.inv_diag, w.count, w.width, rhs.reshape(1, -1))

    def matrix(self) -> csc_matrix:
        """A (count, count) of a film that is not symmetric."""
        self.factor_solution()
        (lower, upper), count = self._bands(), self.work.count
        bands = range(1, upper.shape[1])
        L = diags_array([lower[: count - k, k] for k in bands], offsets=[-k for k in bands], shape=(count, count))
        U = diags_array([upper[: count - k, k] for k in (0, *bands)], offsets=[0, *bands], shape=(count, count))
        return csc_matrix(U + L @ U)

    def _bands(self) -> tuple[np.ndarray, np.ndarray]:
        w = self.work
        return dense_band(w.lower, w.count, w.width), dense_band(w.upper, w.count, w.width)
