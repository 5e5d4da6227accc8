"""One film on one grid: coefficients, closure, adjoint.

The straight line gap -> coefficients -> pressure -> sensitivities.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.closures import SOLVERS, Closure
from exudyn_ehd.film.cavitation.line_steps import prolong_set
from exudyn_ehd.film.cavitation.oil_line import OilLine
from exudyn_ehd.film.cavitation.rupture_line import LineGradients, RuptureLine
from exudyn_ehd.film.cavitation.solve import factor_solution
from exudyn_ehd.film.cavitation.states import CLIPPED, FULL, OIL, RUPTURE
from exudyn_ehd.film.cavitation.steady_oil import status_of
from exudyn_ehd.film.cavitation.swift_stieber import refine_factor
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.balance import FilmTerms, film_balance, film_terms
from exudyn_ehd.film.reynolds.lagging_void import lag_void, outflow_of
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities, add_cuts, contract_links, link_derivatives
from exudyn_ehd.film.reynolds.links import FluxEffect, link_flux, set_links, vertex_balance
from exudyn_ehd.film.solvers.answers import FilmAnswers
from exudyn_ehd.film.solvers.edge_flows import end_films_of_areas, flow_pressures
from exudyn_ehd.status import Status

# Stands for a vanishing time step where only the rates at one instant are asked for, share of the time in which the
# film changes.
INSTANT = 1e-7


class FilmSolver(FilmAnswers):
    """Solves the film for gaps that the caller writes into ``H``, ``HF`` and ``H_t``.

    Parameters
    ----------
    grid : FilmGrid
    closure : Closure
        `FullSommerfeld`, `Gumbel`, `SwiftStieber` or `ElrodAdams`.
    circumferential_pressure_flow : bool
        False drops the pressure flow in theta (short bearing).
    squeeze : bool
        False leaves the storage term out; ``H_t`` is then never read.
    flux_effects : tuple of FluxEffect
        What changes conductances and carriers; empty: the plain film.

    Attributes
    ----------
    H, HF, H_t : (n, m) arrays
        Scaled gap at vertices, gap on the links i -> i+1, rate of the gap at vertices (1/s).
    pressure, fill : (n, m) arrays
        Scaled pressure (prescribed where ``grid.fixed``) and, for closures that conserve mass, the film fraction.
    """

    # False where a film model has equations of its own, so that its gradients are those of `sensitivities`.
    plain_links = True

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        *,
        circumferential_pressure_flow: bool = True,
        squeeze: bool = True,
        flux_effects: tuple[FluxEffect, ...] = (),
    ) -> None:
        shape = grid.shape
        self.grid, self.closure, self.squeeze = grid, closure, squeeze
        self.flow_x, self.area = float(circumferential_pressure_flow), grid.area
        ruptures = RUPTURE if np.isfinite(closure.cavity_pressure) else FULL
        self.system = FilmSystem(grid, OIL if closure.conserves_mass else CLIPPED if closure.clips else ruptures)
        self.H, self.HF, self.H_t = self.system.H, self.system.HF, self.system.H_t
        self.line: RuptureLine | None = None
        self.oil_line: OilLine | None = None
        # of `fill_gradients`, once they are asked for
        self._fills: tuple[LineGradients, LineGradients] | None = None
        if closure.line_in_cells and closure.conserves_mass:
            self.oil_line = self.system.oil_line = OilLine(shape)
        elif closure.line_in_cells and (closure.clips or not circumferential_pressure_flow):
            self.system.count_in_cells(grid, closure.clips)
        elif closure.line_in_cells:
            self.line = self.system.line = self.system.rupture
        self.work, self.flux_effects = Workspace(*shape), flux_effects
        self.flux = link_flux(self.HF, flux_effects) if flux_effects else None
        self.ones, self.nothing, self.link_fields = np.ones(shape), np.zeros(shape), np.zeros((5, *shape))
        self.vx = self.vz = 0.0
        self.instant = self.lagging = False
        # whether there is a cavity, and whether no unknown pressure is below the cavity's
        self.ruptures = bool(np.isfinite(closure.cavity_pressure))
        self.complementary = self.ruptures and not closure.clips
        # density over that at ambient pressure (n, m), of the last solution; None: it does not follow the pressure
        self.law: CompressibleLaw | None = None
        self.rho = self.ones
        # derivative of the density to the unknown pressures (n, m), at the last factor
        self.rho_P: np.ndarray | None = None
        # Pa per unit of the scaled pressure
        self.pressure_scale = 1.0
        self.symmetric = not closure.conserves_mass
        # derivative of what `keep` returned to the gap
        self.follows = self.nothing
        self.coarse: FilmSolver | None = None
        coarse = grid.coarser() if self.complementary and not closure.conserves_mass else None
        if coarse is not None:
            # of which the sets alone are asked for
            self.coarse = FilmSolver(
                coarse, closure, circumferential_pressure_flow=circumferential_pressure_flow, squeeze=squeeze
            )

    @property
    def pressure(self) -> np.ndarray:
        """Scaled pressure of the last solution (n, m)."""
        return self.system.pressure

    @property
    def fill(self) -> np.ndarray:
        """Film fraction of the last solution (n, m); empty if the closure does not conserve mass."""
        return self.system.fill

    @property
    def carried(self) -> np.ndarray:
        """Fill that the Couette flows of the last solution take along from every vertex (n, m)."""
        s = self.system
        if not self.closure.conserves_mass:
            return self.ones
        return s.prompt * s.fill + s.coefficients.late if self.lagging or self.oil_line is not None else s.fill

    @property
    def content(self) -> np.ndarray:
        """Scaled oil content fill H, or mass rho fill H, of the last solution (n, m)."""
        content = self.system.fill * self.H
        return content if self.law is None else self.rho * content

    def forget(self) -> None:
        """Drop the warm start; the next solution starts from a coarser grid where there is one."""
        self.work.warm = self.work.known = False

    def refresh_fixed(self) -> None:
        """Hand a change of ``grid.fixed`` on to the coarser grids."""
        if not self.symmetric:
            self.work.oil.factored = False
        if self.coarse is not None:
            self.coarse.grid.fixed[:] = self.grid.fixed[::2, ::2]
            self.coarse.refresh_fixed()

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the gaps now stored.

        Parameters
        ----------
        vx, vz : float
            Scaled mean surface speeds U / (2 R), 1/s.
        cavity_pressure : float
            Scaled cavity pressure, 1/s.
        mass_old : (n, m) array, optional
            Old value of fill H, for closures that conserve mass; None: a steady film.
        step : float
            Time since ``mass_old``, s; 0 asks for the rates at that instant.

        Returns
        -------
        status, steps : Status, int
            Outcome and number of linear solves.
        """
        s = self.system
        self.vx, self.vz, self._fills = vx, vz, None
        self._set_links()
        s.cavity_pressure = cavity_pressure
        if self.closure.clips:
            np.copyto(s.linear_pressure, s.pressure)
        if self.closure.conserves_mass:
            self._set_storage(mass_old, step)
        # where gaps close, cavities of another film may stay dry that fill up from a full one
        steps, was_warm = 0, self.work.warm and not s.closes
        if not was_warm:
            self.forget()
            steps = self._guess_from_coarse()
        status, fine_steps = SOLVERS[s.kind](s, self.work)
        if was_warm and status is Status.NOT_CONVERGED and (self.complementary or self.law is not None):
            # a start from another state can mislead where the film itself is benign
            self.forget()
            steps += fine_steps + self._guess_from_coarse()
            status, fine_steps = SOLVERS[s.kind](s, self.work)
        return status_of(s, status), steps + fine_steps

    def _set_links(self) -> None:
        """Conductances and Couette fluxes of the links, and the right-hand side."""
        s, f = self.system, self.flux
        if f is not None:
            first, *others = self.flux_effects
            first.start(f, self.H, self.vx, self.vz)
            for effect in others:
                effect.apply(f, self.HF, f.gap_z, self.vx, self.vz)
        speeds, out = (self.vx, self.vz, self.flow_x), (s.kx, s.kz, s.fx, s.fz, s.b)
        set_links(self.H, self.HF, self.H_t, self.squeeze, None if f is None else f.flow, *speeds, self.grid.mesh, *out)
        self.grid.cut(s.kx, s.kz)

    def _set_storage(self, mass_old: np.ndarray | None, step: float) -> None:
        s = self.system
        s.see_motion(mass_old is None, self.H_t, self.vx, self.vz)
        self.instant = s.instant = mass_old is not None and step <= 0.0
        if mass_old is None:
            s.inverse_step = 0.0
        elif self.instant:
            s.inverse_step = self._inverse_instant()
            s.mass_old[:] = mass_old * (1.0 - self.H_t / (s.inverse_step * self.H))
        else:
            s.inverse_step = 1.0 / step
            s.mass_old[:] = mass_old

    def _inverse_instant(self) -> float:
        """1 / a step that stands for none, 1/s, for the speeds and rates now stored."""
        return (abs(self.vx) + abs(self.vz) + float(np.abs(self.H_t).max()) or 1.0) / INSTANT

    def keep(self, void: np.ndarray, step: float) -> np.ndarray:
        """Content (n, m) at the start of a step, for the gaps and rates now stored: ``mass_old`` of `solve`.

        ``void`` (n, m): gap minus oil at that time. The gap at that time is not the old one: it is extrapolated back
        with the present rate. The storage of a vertex is then

            (fill H - kept) / h = dH/dt - (void - void_old) / h,

        a difference of the void (its flows: `lag`), while a full film is squeezed by its rate as under closures without
        a memory. The difference quotient of the gap would be the mean of the rates at both ends of a step under
        Newmark's formulas: rates that alternate from step to step would not act on it and would not be damped. The
        difference of ``kept`` from the old content, ``H - h dH/dt - H_old``, is the same for full and for cavitated
        vertices. Summed over the steps it is the difference between integrated rates and gap: with rates that follow
        the gap it telescopes to ``-h (dH/dt at the end - at the start) / 2``, bounded over any number of steps and
        vanishing with h.
        """
        before, slope = self._gap_before(step)
        kept = before - void
        # a gap that opens faster leaves nothing
        self.follows = slope * (kept > 0.0)
        return np.maximum(kept, 0.0, out=kept)

    def stored(self, mass: np.ndarray | None, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Void at the end of the last solution's step, and the oil that flows have brought, ``mass`` at its start."""
        content = self.content
        known = mass is not None and step > 0.0
        return self.H - content, mass + content - self.system.mass_old if known else content

    def lag(self, outflow: np.ndarray | None, step: float) -> None:
        """Let the next solution's flows out of cavities lag, by what `outflow` (3, n, m) was at the start of its
        step; None, or a step of 0: they do not."""
        s = self.system
        if outflow is not None and step > 0.0:
            lag_void(outflow, step, s.fixed, s.prompt, s.late)
            self.lagging = True
        elif self.lagging:
            s.prompt[:], s.late[:] = 1.0, 0.0
            self.lagging = False

    def outflow(self) -> np.ndarray:
        """Fields (3, n, m) of the last solution that `exudyn_ehd.film.reynolds.lagging_void` needs in the next step.

        Flows from the line inside its cells follow the pressure, whatever a vertex holds: it counts as full.
        """
        s, line = self.system, self.oil_line
        fill = s.fill if line is None else np.where(line.s < 1.0, 1.0, s.fill)
        return outflow_of(s.fx, s.fz, s.H, s.H_t, s.area, fill)

    def _gap_before(self, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Gap (n, m) at the start of a step as the rates at its end have it, and its derivative to the gap now."""
        return self.H - step * self.H_t, self.ones

    def _guess_from_coarse(self) -> int:
        """Sets of a coarser grid's film, on which the way from the full film is short; returns its steps."""
        coarse = self.coarse
        if coarse is None or (self.grid.fixed[:, 1:-1].any() and not coarse.grid.fixed[:, 1:-1].any()):
            return 0  # the coarser grid has lost the supply and would starve
        coarse.H[:] = self.H[::2, ::2]
        coarse.HF[:] = self.H[1::2, ::2]
        coarse.H_t[:] = self.H_t[::2, ::2]
        coarse.pressure[:] = self.pressure[::2, ::2]
        coarse.forget()
        status, steps = coarse.solve(self.vx, self.vz, self.system.cavity_pressure)
        if status is Status.CONVERGED:
            prolong_set(coarse.work.active, self.grid.fixed, self.work.active)
            self.work.warm = True
        return steps

    def factor_solution(self) -> None:
        """Make the factor in the workspace that of the last solution."""
        if not self.symmetric:
            factor_solution(self.system, self.work)
        elif self.line is not None:
            refine_factor(self.system, self.line, self.work)

    def sensitivities(self, lam: np.ndarray) -> Sensitivities:
        """Gradients of the adjoint functionals lam (k, n, m)."""
        by_rate, by_gap = self.storage_weights()
        cell, face, speed = contract_links(lam, self.link_derivatives())
        cell -= lam * by_gap
        rate = -lam * by_rate
        return self.with_line(lam, cell, face, rate, speed)

    def line_gradients(self) -> LineGradients | None:
        """Contribution of the rupture line inside the cells to the derivatives of the balances; None without one.

        For the last solution, at fixed pressure.
        """
        fills = self.fill_gradients()
        if fills is not None and self.oil_line is not None:
            return self.oil_line.balance_gradients(fills, *self.fill_weights(), self.work.order[: self.work.count])
        s = self.system
        if s.column_line is not None:
            return s.column_line.gradients(self.work, s.cavity_pressure, self.H, self.flux)
        if self.line is None:
            return None
        return self.line.gradients(
            self.work, (self.H, self.HF), self.flux, (self.vx, self.vz), self.flow_x, self.squeeze, self.grid.mesh
        )

    def fill_gradients(self) -> tuple[LineGradients, LineGradients] | None:
        """Derivatives of what flows carry from vertices at a mass-conserving film's line inside its cells, and of their
        fills; None without.

        For the last solution, at fixed pressure; ``rows`` are flat vertices.
        """
        if self.oil_line is None:
            return None
        if self._fills is None:
            g, v = (self.H, self.HF), (self.vx, self.vz)
            self._fills = self.oil_line.gradients(g, self.flux, v, self.flow_x, self.squeeze, self.grid.mesh)
        return self._fills

    def link_derivatives(self) -> np.ndarray:
        """Derivatives (5, n, m) of the links' flows, or mass flows, with respect to their gaps and the speeds, for the
        last solution at fixed pressure."""
        s, f, fill, couette = self.system, self.flux, None, None
        if self.closure.conserves_mass:
            fill, couette = self.carried, (s.fx, s.fz)
        slopes, by_speed = (None, None) if f is None else (f.slopes, f.by_speed)
        rho, speeds = None if self.law is None else self.rho, (self.vx, self.vz, self.flow_x, self.grid.mesh)
        P = s.linear_pressure
        link_derivatives(P, self.H, self.HF, slopes, by_speed, fill, rho, couette, *speeds, self.link_fields)
        if self.grid.cuts is not None:
            flow = None if f is None else f.flow
            add_cuts(P, self.H, self.HF, flow, slopes, by_speed, self.grid.cuts, s.kx, s.kz, self.link_fields)
        return self.link_fields

    def storage_weights(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of every vertex's balance through the storage, with respect to H_t and to H."""
        s, content = self.system, self.area if self.law is None else self.area * self.rho
        if self.closure.conserves_mass:
            content = content * s.fill
        if s.inverse_step == 0.0 or self.instant:
            return (content if self.squeeze else self.nothing), self.nothing
        by_rate = self.area * self.follows
        return by_rate, (content - by_rate) * s.inverse_step

    @property
    def since(self) -> tuple[float, np.ndarray, bool]:
        """1 / time step since the content that the storage starts from, that content, and whether it is an instant."""
        s = self.system
        return s.inverse_step, s.mass_old, s.instant

    @property
    def terms(self) -> FilmTerms:
        """Coefficients of the balances."""
        return film_terms(self.system.coefficients, self.since)

    def flow_pressures(self) -> tuple[np.ndarray, np.ndarray]:
        """Pressures (n, m) that drive flows at prescribed vertices, and where the film is full, see `edge_flows`."""
        return flow_pressures(self.system, self.work.active, self.closure.clips)

    def inflow(self, ended: bool = False) -> np.ndarray:
        """Scaled volume (or mass) flow that every prescribed vertex feeds into the film (n, m); zero elsewhere.

        ``ended``: films next to a cavity end within a link.
        """
        s, conserves_mass = self.system, self.closure.conserves_mass
        balance = np.empty(self.grid.shape)
        if self.law is not None:
            fill = s.fill if conserves_mass else None
            film_balance(self.flow_pressures()[0], fill, self.rho, self.terms, balance)
        elif conserves_mass:
            film_balance(s.pressure, s.fill, None, self.terms, balance)
        else:
            vertex_balance(self.flow_pressures()[0], s.kx, s.kz, s.b, balance)
        if ended and self.complementary and not conserves_mass and self.law is None:
            end_films_of_areas(s, self.work.active, self.grid, balance)
        return np.where(self.grid.fixed, balance, 0.0)
