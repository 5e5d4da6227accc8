"""Films that Newton's method finds: adjoints and answers with its matrix at the solution, and what compressible ones
carry."""

from __future__ import annotations

import abc

import numpy as np
from scipy.sparse import csc_matrix, diags_array

from exudyn_ehd.film.banded.many_sides import solve_in_tiles
from exudyn_ehd.film.banded.substitution import solve_lu, solve_lu_transposed
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.balance import FilmTerms, film_balance
from exudyn_ehd.film.solvers.linear import FilmSolver


class NewtonFilmSolver(FilmSolver, abc.ABC):
    """`FilmSolver` whose derivatives are solved with Newton's matrix J at the solution, factored as L U.

    Attributes
    ----------
    law : CompressibleLaw or None
    rho : (n, m) array
        Density of the last solution over that at ambient pressure.
    film : FilmTerms
        Of the balances.
    """

    law: CompressibleLaw | None
    rho: np.ndarray
    film: FilmTerms
    pressure_scale: float

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

    def newton_matrix(self) -> csc_matrix:
        """J (count, count)."""
        (lower, upper), count = self._exact_factor(), self.work.count
        bands = range(1, upper.shape[1])
        L = diags_array([lower[: count - k, k] for k in bands], offsets=[-k for k in bands], shape=(count, count))
        U = diags_array([upper[: count - k, k] for k in (0, *bands)], offsets=[0, *bands], shape=(count, count))
        return csc_matrix(U + L @ U)

    @property
    def content(self) -> np.ndarray:
        """Scaled mass rho fill H of the last solution (n, m)."""
        return self.rho * self.system.fill * self.H

    def _clip(self) -> None:
        """Pressures and vertices in the film, of a closure that clips them or that never ruptures."""
        s, fixed, P = self.system, self.grid.fixed, self.system.linear_pressure
        if self.closure.clips:
            np.copyto(s.pressure, np.where(fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~fixed, s.cavity_pressure <= P, out=self.work.active)
        elif not self.ruptures:
            np.logical_not(fixed, out=self.work.active)

    def couette_flows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Couette flows of the links in theta and z, and the rate of a full film's content per area, all (n, m); of
        masses if compressible."""
        if self.law is None:
            return super().couette_flows()
        fill, rho = self.carried, self.rho
        flow_x, flow_z = (
            f * np.where(f >= 0.0, fill, np.roll(fill, -1, axis)) * 0.5 * (rho + np.roll(rho, -1, axis))
            for axis, f in enumerate((self.system.fx, self.system.fz))
        )
        return flow_x, flow_z, rho * self.H_t

    def inflow(self, ended: bool = False) -> np.ndarray:
        """Scaled volume (or mass) flow that every prescribed vertex feeds into the film (n, m); zero elsewhere."""
        if self.law is None:
            return super().inflow(ended)
        balance, fill = np.empty(self.grid.shape), self.system.fill if self.closure.conserves_mass else None
        film_balance(self.flow_pressures()[0], fill, self.rho, self.film, balance)
        return np.where(self.grid.fixed, balance, 0.0)

    def viscosity(self, p_out: np.ndarray, ratio_out: np.ndarray, ratio_P_out: np.ndarray, p_P_out: np.ndarray) -> bool:
        """Scaled pressure and viscosity ratio of a compressible film (n, m) with their derivatives to the transformed
        pressure.

        False where that has no pressure; there the law goes on in a line.
        """
        assert self.law is not None
        inside = self.law.inverse(self.system.pressure * self.pressure_scale, p_out, ratio_out, ratio_P_out)
        ratio_P_out *= self.pressure_scale
        # pressures that were cut off inside the cells are others than those that the film was solved for
        np.divide(ratio_out, self.law.density.ratio(p_out) if self.closure.clips else self.rho, out=p_P_out)
        p_out /= self.pressure_scale
        return inside

    def pressure_of_solution(self, p_out: np.ndarray, p_P_out: np.ndarray) -> bool:
        """Scaled pressure of a compressible film (n, m) and its derivative to the transformed one; False where that has
        no pressure."""
        rest = np.empty((2, *p_out.shape))
        return self.viscosity(p_out, rest[0], rest[1], p_P_out)

    def flow_work(self, P: np.ndarray) -> np.ndarray:
        """Scaled integral of dp over the density ratio up to scaled pressures P; see `DowsonHigginson.flow_work`."""
        assert self.law is not None
        return self.law.density.flow_work(P * self.pressure_scale) / self.pressure_scale
