"""Compressible film: the density follows the pressure, on any closure.

With the density ratio rho = rho(p) / rho_0 and the transformed pressure q of
`exudyn_ehd.film.lubricant.density`, scaled to P, the mass balance of a control volume reads

    sum over its links of (sigma V H - H^3 dP/ds) + d(rho fill H)/dt area = 0,

the compressible Reynolds equation (D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, 1966) in the scaled
form of `exudyn_ehd.film.reynolds.links`. sigma is the mean density of a link's ends (second order) times the fill of
its upstream end. The closures are unchanged in P, because q grows with p: `FullSommerfeld`, `Gumbel` (solved over
the whole film, cut off afterwards; the density follows the clipped pressure), `SwiftStieber` and `ElrodAdams`.

Storage. `ElrodAdams` with a history: the difference of the void, the gap less ``rho fill H``. Without a history
there is no rate of the pressure: ``d(rho H)/dt = rho dH/dt``. What is left out, ``H d(rho)/dt``, is to the squeeze as
the strain of the oil, dp / K with its bulk modulus K = 1 / a near 1.7 GPa, to that of the gap in the same time, dH / H:
1 % for 10 MPa during which the gap changes by half. The rates at an instant (a history without a time step) leave it
out likewise. A flooded start holds oil of ambient density, so that its film builds up the pressure over some steps.

Swift-Stieber's rupture line lies inside the cells as `exudyn_ehd.film.solvers.liner.line` has it.

Oil that no pressure of the law's range carries has no film.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.assemble import dense_band
from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.solve import factor_solution
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityField
from exudyn_ehd.film.reynolds.balance import FilmTerms, film_terms
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.exact import NewtonFilmSolver
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.status import Status

# Share of the law's range at which a film that was not found presses against its end.
AT_THE_END = 1.0 - 1e-9


class CompressibleFilmSolver(NewtonFilmSolver):
    """`FilmSolver` with a density that follows the pressure; flows are mass flows over the density at ambient pressure.

    Parameters
    ----------
    grid, closure, squeeze, flux_effects
        As for `FilmSolver`.
    law : CompressibleLaw

    Attributes
    ----------
    pressure_scale : float
        Pa per unit of the scaled pressure; set by the caller before ``solve``.
    rho : (n, m) array
        Density over that at ambient pressure, of the last solution.
    """

    law: CompressibleLaw

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        law: CompressibleLaw,
        *,
        squeeze: bool = True,
        flux_effects: tuple[FluxEffect, ...] = (),
    ) -> None:
        super().__init__(grid, closure, squeeze=squeeze, flux_effects=flux_effects)
        self.law = law
        self.edge: FilmLine | None = None
        if self.line is not None:
            self.line = self.system.line = self.edge = FilmLine(grid.shape)
            self.edge.flux = self.flux
        self.density = DensityField(law, grid.shape)
        self.rho = self.density.rho
        self.system.take_density(self.density)

    @property
    def pressure_scale(self) -> float:
        return self.density.scale

    @pressure_scale.setter
    def pressure_scale(self, value: float) -> None:
        self.density.scale = value

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the gaps now stored; parameters as for `FilmSolver.solve`,
        ``mass_old`` the old value of rho fill H."""
        if mass_old is not None and step <= 0.0:
            # What an instant keeps is the volume: a full film follows the gap
            # with the density that its pressure gives it.
            mass_old = np.minimum(mass_old / self.density.at(cavity_pressure), self.H)
        if vx == vz == 0.0 and not self.H_t.any():
            # a film at rest starts from nothing, not from what is left of the last one
            self.forget()
        end, steps, P = AT_THE_END * self.law.kernel_table.highest / self.pressure_scale, 0, self.system.linear_pressure
        was_warm = self.work.warm
        status, steps = super().solve(vx, vz, cavity_pressure, mass_old, step)
        if was_warm and (P >= end).any():
            # beyond the law's range the density stays what it is at its end, which makes other films
            self.forget()
            status, count = super().solve(vx, vz, cavity_pressure, mass_old, step)
            steps += count
        if status is Status.NOT_CONVERGED and (P >= end).any():
            status = Status.NO_PRESSURE
        return status, steps

    @property
    def film(self) -> FilmTerms:  # type: ignore[override]
        """Of the balances."""
        return film_terms(self.system.coefficients, self.since)

    def _set_links(self) -> None:
        super()._set_links()
        s = self.system
        if self.edge is not None:
            self.edge.density = self.density.at(s.cavity_pressure)
            self.edge.take((self.H, self.HF), s.kx, s.b, self.grid.fixed)

    def _exact_factor(self) -> tuple[np.ndarray, np.ndarray]:
        """L and U of Newton's matrix at the solution, factored if the last one was before."""
        w = self.work
        factor_solution(self.system, w)
        return dense_band(w.lower, w.count, w.width), dense_band(w.upper, w.count, w.width)

    def link_derivatives(self, rho: np.ndarray | None = None) -> np.ndarray:
        """Derivatives (5, n, m) of the links' mass flows with respect to their gaps and the speeds."""
        return super().link_derivatives(self.rho)

    def storage_weights(self, rho: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of every vertex's balance through the storage, with respect to H_t and to H."""
        return super().storage_weights(self.rho)
