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

Newton's method with the exact non-symmetric matrix starts from the last film, else
from the incompressible one. Oil that no pressure of the law's range carries has no film.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.assemble import dense_band
from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.solve import LARGEST_DEFICIT
from exudyn_ehd.film.cavitation.steady_oil import status_of
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw, DensityTable
from exudyn_ehd.film.lubricant.density_field import know_at
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.compiled import factor, solve
from exudyn_ehd.film.solvers.exact import NewtonFilmSolver
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.liner.line_kernels import NO_LINE
from exudyn_ehd.film.solvers.steps import admit
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
        shape = grid.shape
        self.law, self.pressure_scale = law, 1.0
        self.edge: FilmLine | None = None
        if self.line is not None:
            self.line = self.system.line = self.edge = FilmLine(shape)
            self.edge.flux = self.flux
        # the line inside the cells as kernels take it
        self.met = NO_LINE if self.edge is None else self.edge.state
        s, fills = self.system, closure.conserves_mass
        self.fields = np.zeros((10, *shape))
        s.kx, s.kz, s.fx, s.fz, grow, known, kept, area, s.prompt, s.late = self.fields
        s.prompt[:] = 1.0
        self.film = FilmTerms(s.kx, s.kz, s.fx, s.fz, grow, known, kept, area, s.prompt, s.late, grid.fixed)
        self.film.area[:] = self.area
        if squeeze and not fills:
            # what full films store grows with the gap
            self.H_t = s.H_t = self.film.grow
        # density over that at ambient pressure (n, m), of the last solution, and its derivative when last factored
        self.rho, self.rho_P = np.ones((2, *shape))
        self.known, self.residual = np.full((6, self.area.size), np.nan), np.zeros(shape)
        self.full, self.free = np.ones((2, *shape), dtype=np.bool_)
        self.u = s.linear_pressure, s.fill if fills else None, self.full if fills else None
        self.trial = tuple(None if f is None else np.empty_like(f) for f in self.u)
        self.exact = False
        self.reusable = False

    @property
    def _floor(self) -> float:
        """Scaled pressure below which the density stays."""
        return self.system.cavity_pressure if self.ruptures else -np.inf

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the gaps now stored; parameters as for `FilmSolver.solve`,
        ``mass_old`` the old value of rho fill H."""
        w = self.work
        if mass_old is not None and step <= 0.0:
            # What an instant keeps is the volume: a full film follows the gap
            # with the density that its pressure gives it.
            at_cavity = self.law.density.ratio(self._cavity_in_pascal(cavity_pressure))
            mass_old = np.minimum(mass_old / at_cavity, self.H)
        steps = 0
        if w.warm:
            self._prepare(vx, vz, cavity_pressure, mass_old, step)
            # a film at rest starts from nothing, not from what is left of the last one
            at_rest = vx == vz == 0.0 and not self.H_t.any()
            ok, steps = (False, 0) if self.system.closes or at_rest else self._newton()
            if ok:
                return self._finish(steps)
        self.forget()
        self.reusable = False
        status, count = super().solve(vx, vz, cavity_pressure, mass_old, step)
        steps += count
        w.warm = False
        if status is not Status.CONVERGED:
            return status, steps
        if self.closure.conserves_mass:
            self._set_store()
        self._take_line()
        out = self._reaches(self.law.kernel_table.highest)
        ok, count = self._newton()
        steps += count
        if not ok:
            # beyond the law's range the density stays what it is at its end
            out = out or self._reaches(AT_THE_END * self.law.kernel_table.highest)
            return (Status.NO_PRESSURE if out else Status.NOT_CONVERGED), steps
        return self._finish(steps)

    def _reaches(self, transformed: float) -> bool:
        """Whether the film's transformed pressure, Pa, reaches a value."""
        return bool(np.any(self.system.linear_pressure * self.pressure_scale >= transformed))

    def _cavity_in_pascal(self, cavity_pressure: float) -> np.ndarray:
        q = np.array([[cavity_pressure * self.pressure_scale]])
        p, ratio, slope = np.zeros((1, 1)), np.zeros((1, 1)), np.zeros((1, 1))
        self.law.inverse(q, p, ratio, slope)
        return p[0, 0]

    def _prepare(self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None, step: float) -> None:
        """Coefficients of this film, as `FilmSolver.solve` sets them."""
        s = self.system
        self.vx, self.vz = vx, vz
        self._set_links()
        s.cavity_pressure = cavity_pressure
        if self.closure.clips:
            s.linear_pressure[self.grid.fixed] = s.pressure[self.grid.fixed]
        if self.closure.conserves_mass:
            self._set_storage(mass_old, step)
            self._set_store()
        self._take_line()

    def _take_line(self) -> None:
        """The line's coefficients of this film; see `exudyn_ehd.film.solvers.liner.line`."""
        s = self.system
        if self.edge is not None:
            self.edge.density = float(self.law.density.ratio(self._cavity_in_pascal(s.cavity_pressure)))
            self.edge.take((self.H, self.HF), s.kx, s.b, self.grid.fixed)

    def _set_store(self) -> None:
        """Coefficients of a mass-conserving film's storage term; see `FilmTerms`."""
        s, f = self.system, self.film
        f.known[:] = 0.0
        f.kept[:] = 0.0
        if s.inverse_step > 0.0:
            np.multiply(self.H, s.inverse_step, out=f.grow)
            np.multiply(s.mass_old, -s.inverse_step, out=f.known if self.instant else f.kept)
        else:
            np.copyto(f.grow, self.H_t if self.squeeze else self.nothing)

    def refresh_fixed(self) -> None:
        """Hand a change of ``grid.fixed`` on to the coarser grids."""
        self.reusable = False
        super().refresh_fixed()

    def _oil(self) -> tuple[float, float, DensityTable, np.ndarray, np.ndarray, np.ndarray]:
        """The law as kernels take it."""
        return self.pressure_scale, self._floor, self.law.kernel_table, self.known, self.rho, self.rho_P

    def _speeds(self) -> tuple[float, float, float, float]:
        """Cavity pressure, speeds and compliance, as kernels take them."""
        return self._floor, self.vx, self.vz, 0.0

    def _unknown(self) -> np.ndarray:
        """Vertices that Newton's matrix has a row for."""
        if self.complementary and not self.closure.conserves_mass:
            return self.work.active
        return np.logical_not(self.grid.fixed, out=self.free)

    def _newton(self) -> tuple[bool, int]:
        w, fixed, fills = self.work, self.grid.fixed, self.closure.conserves_mass
        if fills:
            np.logical_or(w.active, fixed, out=self.full)
        if self.complementary:
            admit(*self.u, fixed, self.system.cavity_pressure)
        ok, steps, _, w.count, w.width = solve(
            self.u,
            self.trial,
            fixed,
            self._speeds(),
            (self.closure.clips, self.complementary and not fills),
            self.fields,
            self.H_t,
            None,
            self._oil(),
            w.matrix,
            self.residual,
            self._unknown(),
            (self.reusable, True, w.count, w.width),
            self.met,
        )
        if fills:
            np.logical_and(self.full, self.free, out=w.active)
            # a nearly singular matrix may end at fills below zero, which no film has
            ok = ok and bool(self.system.fill.min() > -LARGEST_DEFICIT)
        self.reusable = ok
        return ok, steps

    def _finish(self, steps: int) -> tuple[Status, int]:
        """Clip what the closure clips; factors of the Couette flows on the links."""
        s, w = self.system, self.work
        w.warm, self.exact = True, False
        know_at(s.linear_pressure, self.pressure_scale, self._floor, self.law.kernel_table, self.known)
        self._clip()
        if self.closure.conserves_mass:
            np.maximum(s.fill, 0.0, out=s.fill)
        elif self.edge is not None:
            self.edge.settle(w.active)
        return status_of(self.system, Status.CONVERGED), steps

    def _exact_factor(self) -> tuple[np.ndarray, np.ndarray]:
        """L and U of Newton's matrix at the solution, factored if the last one was before."""
        w = self.work
        if not self.exact:
            _, w.count, w.width = factor(
                self.u,
                self.grid.fixed,
                self._speeds(),
                self.fields,
                None,
                self._oil(),
                w.matrix,
                self._unknown(),
                self.met,
            )
            self.exact = True
        return dense_band(w.lower, w.count, w.width), dense_band(w.upper, w.count, w.width)

    def link_derivatives(self, rho: np.ndarray | None = None) -> np.ndarray:
        """Derivatives (5, n, m) of the links' mass flows with respect to their gaps and the speeds."""
        return super().link_derivatives(self.rho)

    def storage_weights(self, rho: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of every vertex's balance through the storage, with respect to H_t and to H."""
        return super().storage_weights(self.rho)
