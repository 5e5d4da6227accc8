"""Solver of one film on one grid: pressure and fill from the gaps.

A film whose gaps or conductances follow its pressure has `LinerFilm` as a part, which solves by Newton's method. All
other films are linear in their sets, which `exudyn_ehd.film.cavitation` finds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.system import status_of
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.answers import FilmAnswers
from exudyn_ehd.film.solvers.liner.film import LinerFilm, cold_start, failure, pseudo_transient
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.liner.winkler import Liner
from exudyn_ehd.film.solvers.sets import solve_sets
from exudyn_ehd.film.supply.restrictors import Reservoirs
from exudyn_ehd.status import Status

# Trials of Newton's method for the pressures of reservoirs.
MOST_BALANCES = 40
# Largest balance of a reservoir over its terms: round-off, and what counts as round-off where it does not fall further.
# The first also of a step of Newton's method, over the peak pressure.
EVEN, ROUNDED = 1e-13, 1e-9


class FilmSolver(FilmAnswers):
    """Solves the film for gaps that the caller writes into ``H``, ``HF`` and ``H_t``.

    On a liner the caller writes gaps and rate of the undeformed surfaces; ``solve`` replaces them by those that the
    film sees.

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
        What changes conductances and carriers; empty: the plain film. An oil that thins by shear has conductances that
        follow the pressure.
    density : CompressibleLaw or None
        Law of a compressible film, whose flows are mass flows over the density at ambient pressure.
    liner : Liner or None
        None: rigid surfaces.

    Attributes
    ----------
    H, HF, H_t : (n, m) arrays
        Scaled gap at vertices, gap on the links i -> i+1, rate of the gap at vertices (1/s).
    pressure, fill : (n, m) arrays
        Scaled pressure (prescribed where ``grid.fixed``) and, for closures that conserve mass, the film fraction.
    pressure_scale : float
        Pa per unit of the scaled pressure; set by the caller before ``solve``.
    rho : (n, m) array
        Density over that at ambient pressure, of the last solution.
    elements : LinerFilm or None
        What lets gaps or conductances follow the pressure; None if they don't.
    """

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        *,
        circumferential_pressure_flow: bool = True,
        squeeze: bool = True,
        flux_effects: tuple[FluxEffect, ...] = (),
        density: CompressibleLaw | None = None,
        liner: Liner | None = None,
    ) -> None:
        yields = liner is not None or any(isinstance(effect, ShearThinning) for effect in flux_effects)
        super().__init__(grid, closure, float(circumferential_pressure_flow), squeeze, flux_effects, density, yields)
        self.is_rigid = liner is None
        self.elements = LinerFilm(self, liner or Liner(oil=density)) if yields else None

    def refresh_fixed(self) -> None:
        """Hand a change of ``grid.fixed`` and of its cuts on to the film's parts."""
        self.cut_links()
        if self.reservoirs is not None:
            self.reservoirs.place()
        self.work.ready = False

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
            Old value of fill H, or of rho fill H, for closures that conserve mass; None: a steady film.
        step : float
            Time since ``mass_old``, s; 0 asks for the rates at that instant.

        Returns
        -------
        status, steps : Status, int
            Outcome and number of linear solves.
        """
        if self.reservoirs is None:
            return self._solve_film(vx, vz, cavity_pressure, mass_old, step)
        self.vx, self.vz = vx, vz
        self.reservoirs.inverse_step = 1.0 / step if step > 0.0 else self.inverse_instant()
        solve = partial(self._solve_film, vx, vz, cavity_pressure, mass_old, step)
        return self._balance(self.reservoirs, solve, cavity_pressure * self.pressure_scale)

    def advance(
        self,
        vx: float,
        vz: float,
        cavity_pressure: float,
        void: np.ndarray | None,
        outflow: np.ndarray | None,
        step: float,
    ) -> tuple[Status, int]:
        """`solve` over a step at whose start the film had a ``void`` and an `outflow`; None: a steady film."""
        kept = None if void is None else self.keep(void, step)
        self.lag(outflow, step)
        status, count = self.solve(vx, vz, cavity_pressure, kept, step)
        if status is Status.NOT_CONVERGED and self.lagging:
            # flows that grow manifold within a step may take more than there was
            self.lag(None, step)
            status, count = self.solve(vx, vz, cavity_pressure, kept, step)
        return status, count

    def _balance(self, r: Reservoirs, solve: Callable[[], tuple[Status, int]], floor: float) -> tuple[Status, int]:
        """Solve the film with its reservoirs by Newton's method in their pressures, none below ``floor``, Pa.

        Steps are halved where the largest balance grows. An unbroken film of constant properties is linear in the
        pressures: it is solved once, and superposed.
        """
        base, change, least, steps = r.pressures, np.zeros(len(r.masks)), np.inf, 0
        weights, known, stride = base, base, np.inf
        gaps = None if self.is_rigid else np.array((self.H, self.HF, self.H_t))
        for _ in range(MOST_BALANCES):
            r.pressures, error = np.maximum(base + change, floor), np.inf
            known, before = r.transformed()[0] / self.pressure_scale, known
            if least == np.inf or not self._superpose(r, known - before):
                self.pressure.reshape(-1)[r.at] = known[r.of_vertices]
                if gaps is not None:  # a film on a liner leaves deformed ones
                    self.H[:], self.HF[:], self.H_t[:] = gaps
                status, count = solve()
                steps += count
            if status is Status.CONVERGED:
                g = r.balance(self.inflow(linear=True), floor)
                weights = 1.0 / r.size if least == np.inf else weights
                error, left = (float(np.max(np.abs(g) * w[r.live], initial=0.0)) for w in (weights, 1.0 / r.size))
                rounded = stride <= EVEN * self.pressure_scale * float(np.abs(self.pressure).max())
                if left <= EVEN or ((left <= ROUNDED or rounded) and error > 0.5 * least):
                    return status, steps
            if error < least:
                base, change, least = r.pressures, r.change(self.reduced()[2], floor), error
                stride = float(np.abs(change).max())
            elif least < np.inf:
                change = 0.5 * change
            else:
                return status, steps
        return Status.NOT_CONVERGED, steps

    def _superpose(self, r: Reservoirs, change: np.ndarray) -> bool:
        """Change an unbroken film of constant properties with the areas' scaled pressures (k,), if it stays unbroken;
        False for other films."""
        s, w, fixed, reduced = self.system, self.work, self.grid.fixed, self._reduced
        follows = self.elements is not None or self.density is not None or s.column_line is not None
        if reduced is None or follows or not np.all(w.active | fixed) or np.any(change[~reduced[0]]):
            return False
        P, at = s.linear_pressure.reshape(-1), w.order[: w.count]
        new = P[at] - change[reduced[0]] @ reduced[2]
        # below this pressure above the cavity's a vertex has a rupture line beside it
        whole = self.nothing.reshape(-1) if self.oil_line is None else self.oil_line.fields.whole
        whole = whole if self.line is None else self.line.whole
        if self.ruptures and (np.minimum(P[at], new) - whole[at]).min() < s.cavity_pressure:
            return False
        P[at], P[r.at] = new, P[r.at] + change[r.of_vertices]
        s.pressure[:] = s.linear_pressure
        return True

    def _solve_film(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None, step: float
    ) -> tuple[Status, int]:
        """`solve` at given pressures of all areas."""
        s = self.system
        self.vx, self.vz, s.cavity_pressure, self._fills = vx, vz if self.axial else 0.0, cavity_pressure, None
        self._reduced = None
        follows = self.elements is not None or self.density is not None
        if (follows or (self.closure.conserves_mass and mass_old is None)) and not (
            self.H_t.any()
            or (vx != 0.0 and np.ptp(self.H, axis=0).any())
            or (self.vz != 0.0 and np.ptp(self.H, axis=1).any())
        ):
            # a film without a wedge and without squeeze makes a cold start, not one from the remains of the last film
            self.forget()
        if self.elements is not None:
            return self._solve_yielding(self.elements, mass_old, step)
        return self._solve_sets(mass_old, step)

    def _solve_sets(self, mass_old: np.ndarray | None, step: float) -> tuple[Status, int]:
        """Solve a film whose gaps and conductances do not follow its pressure."""
        s = self.system
        if self.density is not None:
            self.density.scale = self.pressure_scale
            if mass_old is not None and step <= 0.0:
                # What an instant keeps is the volume: a full film follows the gap
                # with the density that its pressure gives it.
                mass_old = np.minimum(mass_old / self.density.at(s.cavity_pressure), self.H)
        self.set_links()
        self.set_right_hand_side()
        line = s.line if isinstance(s.line, FilmLine) else s.oil_line
        if line is not None:
            line.take(s.terms, s.b, 1.0 if self.density is None else self.density.at(s.cavity_pressure), self.vx)
        if self.closure.clips:
            np.copyto(s.linear_pressure, s.pressure)
        self.set_times(mass_old, step)
        self.hold_back()
        if s.instant:
            s.mass_old *= 1.0 - self.H_t / (s.inverse_step * self.H)
        # where gaps close, cavities of another film may stay dry that fill up from a full one
        warm = self.work.warm = self.work.warm and not s.closes
        status, steps = solve_sets(s, self.work)
        # beyond the law's range the density stays what it is at its end, which makes other films
        beyond = self.density is not None and self.density.is_exhausted(s.linear_pressure)
        if warm and (beyond or status is Status.NOT_CONVERGED):
            # a start from another state can mislead where the film itself is benign
            self.forget()
            status, more = solve_sets(s, self.work)
            steps += more
        return status_of(s, status), steps

    def _solve_yielding(self, e: LinerFilm, mass_old: np.ndarray | None, step: float) -> tuple[Status, int]:
        """Solve a film whose gaps or conductances follow its pressure."""
        work, s = self.work, self.system
        e.take_rigid()
        self.set_times(mass_old, step)
        e.set_rates(step)
        if self.lagging:
            e.hold_back()
        work.warm = work.warm and not s.closes
        if not e.set_known_loads():
            return Status.NO_PRESSURE, 0
        e.see_cavity()
        if not e.ends_open():
            work.warm = False
            return Status.NO_FILM, 0
        ok, steps = e.solve() if work.warm else (False, 0)
        if not ok and self.is_rigid:
            ok, more = self._solve_from_sliding(e, mass_old, step)
            steps += more
        for start in (cold_start, pseudo_transient):
            if not ok:
                ok, more = start(e)
                steps += more
        work.warm = ok
        if not ok:
            return failure(e), steps
        e.finish()
        if e.limiter is not None and e.contact is None and not e.true_gap.min() > 0.0:
            # the limiter keeps the film open although nothing holds the surfaces apart
            return Status.NO_FILM, steps
        return status_of(s, Status.CONVERGED), steps

    def _solve_from_sliding(self, e: LinerFilm, mass_old: np.ndarray | None, step: float) -> tuple[bool, int]:
        """Solve by Newton's method from the film between rigid surfaces in which the sliding alone thins the oil."""
        e.forget_gradients()
        self.work.warm = False
        status, steps = self._solve_sets(mass_old, step)
        self.set_times(mass_old, step)
        if status is not Status.CONVERGED:
            return False, steps
        self.work.warm, self.work.ready = True, False
        e.see_cavity()
        ok, more = e.solve()
        return ok, steps + more

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
        before, slope = self.H - step * self.H_t, self.ones
        if self.elements is not None:
            slope = self.elements.deform(before)
        kept = before - void
        # a gap that opens faster leaves nothing
        self.follows = slope * (kept > 0.0)
        return np.maximum(kept, 0.0, out=kept)
