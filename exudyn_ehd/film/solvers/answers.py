"""Answers of a solved film: adjoints and small changes by its matrix, pressure and viscosity by its oil's law."""

from __future__ import annotations

import abc

import numpy as np
from scipy.sparse import csc_matrix, diags_array

from exudyn_ehd.film.banded.assemble import dense_band
from exudyn_ehd.film.banded.many_sides import solve_columns
from exudyn_ehd.film.banded.substitution import solve_ldl, solve_lu, solve_lu_transposed
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.oil_line import contract_fills
from exudyn_ehd.film.cavitation.rupture_line import LineGradients, contract_line
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import scatter
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.reynolds.links import Coefficients


class FilmAnswers(abc.ABC):
    """Answers of a solved film with its matrix A, factored as L D L^T if ``symmetric``, else as L U."""

    grid: FilmGrid
    work: Workspace
    system: FilmSystem
    closure: Closure
    symmetric: bool
    law: CompressibleLaw | None
    rho: np.ndarray
    H_t: np.ndarray
    pressure_scale: float

    @property
    @abc.abstractmethod
    def carried(self) -> np.ndarray:
        """Fill that the Couette flows of the last solution take along from every vertex (n, m)."""

    @abc.abstractmethod
    def factor_solution(self) -> None:
        """Make the factor in the workspace that of the last solution."""

    @abc.abstractmethod
    def line_gradients(self) -> LineGradients | None:
        """Derivatives of the balances through the rupture line inside its cells; None where it has no share."""

    @abc.abstractmethod
    def fill_gradients(self) -> tuple[LineGradients, LineGradients] | None:
        """Derivatives of what flows carry from vertices at a mass-conserving film's line inside its cells, and of their
        fills; None without."""

    def with_line(self, lam: np.ndarray, *fields: np.ndarray) -> Sensitivities:
        """Gradients ``fields`` of the functionals lam (k, n, m) with what the rupture line inside its cells adds."""
        fills = self.fill_gradients()
        if fills is None:
            contract_line(lam, self.line_gradients(), *fields)
        else:
            contract_fills(lam, fills, *self.fill_weights(), fields)
        return Sensitivities(*fields)

    def fill_weights(self) -> tuple[Coefficients, np.ndarray]:
        """Coefficients with the Couette flows of a full film, and its storage (n, m), of masses if compressible."""
        s, rho = self.system, self.rho
        film, store = s.coefficients, s.area * (s.inverse_step * s.H if s.inverse_step > 0.0 else s.H_t)
        if self.law is None:
            return film, store
        fx, fz = (0.5 * f * (rho + np.roll(rho, -1, axis)) for axis, f in enumerate((film.fx, film.fz)))
        return film._replace(fx=fx, fz=fz), store * rho

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
        self._couple(rhs.T, True)
        if self.symmetric:
            solve_ldl(w.band, w.inv_diag, w.count, w.width, rhs)
        else:
            solve_lu_transposed(*self._bands(), w.inv_diag, w.count, w.width, rhs)

    def adjoint_columns(self, rhs: np.ndarray) -> None:
        """Solve ``A^T lam = rhs`` for every column of rhs (count, k), in place: the faster way for dozens of them."""
        w = self.work
        self.factor_solution()
        self._couple(rhs, True)
        upper, lower = (w.band, w.band) if self.symmetric else self._bands()[::-1]
        solve_columns(upper, lower, w.inv_diag, self.symmetric, w.count, w.width, rhs)

    def direct(self, rhs: np.ndarray) -> None:
        """Solve ``A du = rhs`` for rhs (count,), in place."""
        w = self.work
        self.factor_solution()
        if self.symmetric:
            solve_ldl(w.band, w.inv_diag, w.count, w.width, rhs.reshape(1, -1))
        else:
            solve_lu(*self._bands(), w.inv_diag, w.count, w.width, rhs.reshape(1, -1))
        self._couple(rhs[:, None], False)

    def _couple(self, x: np.ndarray, transposed: bool) -> None:
        """Couple rows (count, k) of the film's pressures and of those continued behind its line between columns."""
        if self.system.column_line is not None:
            self.system.column_line.couple(self.work, x, transposed)

    def matrix(self) -> csc_matrix:
        """A (count, count) of a film that is not symmetric."""
        self.factor_solution()
        (lower, upper), count = self._bands(), self.work.count
        bands = range(1, upper.shape[1])
        L = diags_array([lower[: count - k, k] for k in bands], offsets=[-k for k in bands], shape=(count, count))
        U = diags_array([upper[: count - k, k] for k in (0, *bands)], offsets=[0, *bands], shape=(count, count))
        return csc_matrix(U + L @ U)

    def couette_flows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Couette flows of the links in theta and z, and the rate of a full film's content per area, all (n, m); of
        masses if compressible."""
        if self.law is None:
            return self.system.fx, self.system.fz, self.H_t
        fill, rho = self.carried, self.rho
        flow_x, flow_z = (
            f * np.where(f >= 0.0, fill, np.roll(fill, -1, axis)) * 0.5 * (rho + np.roll(rho, -1, axis))
            for axis, f in enumerate((self.system.fx, self.system.fz))
        )
        return flow_x, flow_z, rho * self.H_t

    def viscosity(self, p_out: np.ndarray, ratio_out: np.ndarray, ratio_P_out: np.ndarray, p_P_out: np.ndarray) -> bool:
        """Scaled pressure and viscosity ratio of a compressible film (n, m) with their derivatives to the transformed
        pressure.

        False where that has no pressure; there the law goes on in a line.
        """
        assert self.law is not None
        scale = self.pressure_scale
        inside = self.law.inverse(self.system.pressure * scale, p_out, ratio_out, ratio_P_out)
        ratio_P_out *= scale
        # pressures that were cut off inside the cells are others than those that the film was solved for
        rho = self.law.density.ratio(np.minimum(p_out, self.law.largest_pressure)) if self.closure.clips else self.rho
        np.divide(ratio_out, rho, out=p_P_out)
        p_out /= scale
        return inside

    def pressure_of_solution(self, p_out: np.ndarray, p_P_out: np.ndarray) -> bool:
        """Scaled pressure of a compressible film (n, m) and its derivative to the transformed one; False where that has
        no pressure."""
        rest = np.empty((2, *p_out.shape))
        return self.viscosity(p_out, rest[0], rest[1], p_P_out)

    def flow_work(self, P: np.ndarray) -> np.ndarray:
        """Scaled integral of dp over the density ratio up to scaled pressures P; see `DensityLaw.flow_work`."""
        assert self.law is not None
        return self.law.density.flow_work(P * self.pressure_scale) / self.pressure_scale

    def _bands(self) -> tuple[np.ndarray, np.ndarray]:
        w = self.work
        return dense_band(w.lower, w.count, w.width), dense_band(w.upper, w.count, w.width)
