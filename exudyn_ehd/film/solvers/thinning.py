"""Films between rigid surfaces of an oil that thins by the shear of its own flow: conductances follow the pressure.

`exudyn_ehd.film.solvers.nonlinear` without a liner; the rest of the package sees a plain film's links, whose
derivatives at fixed pressure are those of `LinkFlux`, and Newton's matrix.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.nonlinear import NonlinearFilmSolver
from exudyn_ehd.status import Status


class ThinningFilmSolver(NonlinearFilmSolver):
    """`FilmSolver` with a `ShearThinning` among its effects.

    Parameters
    ----------
    grid, closure, circumferential_pressure_flow, squeeze, flux_effects
        As for `FilmSolver`.
    density : CompressibleLaw or None
        Of a compressible film.
    """

    plain_links = True

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        *,
        circumferential_pressure_flow: bool = True,
        squeeze: bool = True,
        flux_effects: tuple[FluxEffect, ...] = (),
        density: CompressibleLaw | None = None,
    ) -> None:
        super().__init__(grid, closure, squeeze=squeeze, flux_effects=flux_effects, oil=density, density=density)
        self.thins = next(e for e in flux_effects if isinstance(e, ShearThinning))
        self.flow_x = 1.0 if circumferential_pressure_flow else 0.0
        self.thins.place(grid, self.flow_x)
        coarse = grid.coarser() if self.complementary and not closure.conserves_mass else None
        if coarse is not None:
            # for the sets of a start alone
            self.coarse = FilmSolver(
                coarse, closure, circumferential_pressure_flow=circumferential_pressure_flow, squeeze=squeeze
            )
            self.coarse.line = self.coarse.system.line = None

    def _start(self, mass_old: np.ndarray | None, step: float) -> tuple[bool, int]:
        """Newton's method from the film in which the sliding alone thins the oil; without it from a dry guess."""
        e, s = self.elements, self.system
        self.thins.see(self.nothing)
        self.work.warm = e.reusable = False
        status, steps = FilmSolver.solve(self, self.vx, self.vz, s.cavity_pressure, mass_old, step)
        self._set_times(mass_old, step)
        ok, more = False, 0
        if status is Status.CONVERGED:
            self.work.warm = True
            e.see_cavity()
            ok, more = e.solve()
        if not ok:
            steps += more
            ok, more = super()._start(mass_old, step)
        return ok, steps + more

    def refresh_fixed(self) -> None:
        """Take over changed prescribed vertices and cuts, on the coarser grid too."""
        super().refresh_fixed()
        FilmSolver.refresh_fixed(self)

    def response(self) -> tuple[np.ndarray, ...]:
        """`ShearThinning.response` of the last solution."""
        return self.thins.response()

    def sensitivities(self, lam: np.ndarray) -> Sensitivities:
        """Gradients as of `FilmSolver.sensitivities`."""
        return FilmSolver.sensitivities(self, lam)
