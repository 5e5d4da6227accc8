"""Adjoints and answers of films that Newton's method finds, with its matrix at the solution."""

from __future__ import annotations

import abc

import numpy as np

from exudyn_ehd.film.banded.many_sides import solve_in_tiles
from exudyn_ehd.film.banded.substitution import solve_lu, solve_lu_transposed
from exudyn_ehd.film.solvers.linear import FilmSolver


class NewtonFilmSolver(FilmSolver, abc.ABC):
    """`FilmSolver` whose derivatives are solved with Newton's matrix J at the solution, factored as L U."""

    @abc.abstractmethod
    def _exact_factor(self) -> tuple[np.ndarray, np.ndarray]:
        """L and U of Newton's matrix at the solution, factored if the last one was before."""

    def solve_transposed(self, rhs: np.ndarray) -> None:
        """Solve ``J^T lam = rhs`` for rhs (k, count), in place."""
        w = self.work
        lower, upper = self._exact_factor()
        solve_lu_transposed(lower, upper, w.inv_diag, w.count, w.width, rhs)

    def adjoint_columns(self, rhs: np.ndarray) -> None:
        """Solve ``J^T lam = rhs`` for every column of tiles rhs, as returned by `make_tiles`, in place."""
        w = self.work
        lower, upper = self._exact_factor()
        solve_in_tiles(upper, lower, w.inv_diag, False, w.count, w.width, rhs)

    def direct(self, rhs: np.ndarray) -> None:
        """Solve ``J du = rhs`` for rhs (count,), in place."""
        w = self.work
        lower, upper = self._exact_factor()
        solve_lu(lower, upper, w.inv_diag, w.count, w.width, rhs.reshape(1, -1))
