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

Rupture lines lie inside the cells where the closure says so, with f and the pressure at s = 1 (symbols of
`exudyn_ehd.film.cavitation.rupture_line` and `exudyn_ehd.film.cavitation.oil_line`) times the density of oil at the
cavity's pressure. All films are found by `exudyn_ehd.film.cavitation.solve`. Oil that no pressure of the law's range
carries has no film.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityField
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.status import Status


class CompressibleFilmSolver(FilmSolver):
    """`FilmSolver` with a density that follows the pressure; flows are mass flows over the density at ambient pressure.

    Parameters
    ----------
    grid, closure, circumferential_pressure_flow, squeeze, flux_effects
        As for `FilmSolver`.
    density : CompressibleLaw

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
        *,
        density: CompressibleLaw,
        circumferential_pressure_flow: bool = True,
        squeeze: bool = True,
        flux_effects: tuple[FluxEffect, ...] = (),
    ) -> None:
        super().__init__(
            grid,
            closure,
            circumferential_pressure_flow=circumferential_pressure_flow,
            squeeze=squeeze,
            flux_effects=flux_effects,
        )
        self.law, self.symmetric = density, False
        self.edge: FilmLine | None = None
        if self.line is not None:
            self.line = self.system.line = self.edge = FilmLine(grid.shape)
            self.edge.flux = self.flux
        self.density = DensityField(density, grid.shape)
        self.rho, self.rho_P = self.density.rho, self.density.rho_P
        self.system.take_density(self.density)

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the gaps now stored; parameters as for `FilmSolver.solve`,
        ``mass_old`` the old value of rho fill H."""
        self.density.scale = self.pressure_scale
        if mass_old is not None and step <= 0.0:
            # What an instant keeps is the volume: a full film follows the gap
            # with the density that its pressure gives it.
            mass_old = np.minimum(mass_old / self.density.at(cavity_pressure), self.H)
        if vx == vz == 0.0 and not self.H_t.any():
            # a film at rest starts from nothing, not from what is left of the last one
            self.forget()
        was_warm = self.work.warm
        status, steps = super().solve(vx, vz, cavity_pressure, mass_old, step)
        if was_warm and self.density.is_exhausted(self.system.linear_pressure):
            # beyond the law's range the density stays what it is at its end, which makes other films
            self.forget()
            status, count = super().solve(vx, vz, cavity_pressure, mass_old, step)
            steps += count
        return status, steps

    def _set_links(self) -> None:
        super()._set_links()
        s = self.system
        if self.edge is not None:
            self.edge.density = self.density.at(s.cavity_pressure)
            self.edge.take((self.H, self.HF), s.kx, s.b, self.grid.fixed)
