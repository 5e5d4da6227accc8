"""Solver of one film on one grid: pressure and fill from the gaps.

A film whose gaps or conductances follow its pressure has a `LinerFilm`, which solves it by Newton's method. All other
films are solved by `exudyn_ehd.film.solvers.sets`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from exudyn_ehd.compilation import TOLERANCE
from exudyn_ehd.film.cavitation.closures import Closure, status_of
from exudyn_ehd.film.cavitation.linear_film import rows_of_linear
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.links import FluxEffect
from exudyn_ehd.film.solvers.answers import FilmAnswers
from exudyn_ehd.film.solvers.liner import LinerFilm, cold_start, failure, pseudo_transient
from exudyn_ehd.film.solvers.sets import solve_sets
from exudyn_ehd.film.solvers.winkler import Liner
from exudyn_ehd.film.supply.restrictors import Reservoirs
from exudyn_ehd.status import ROUNDING, Status

# Largest number of trials of Newton's method for the pressures of reservoirs.
MOST_TRIALS = 40


class FilmSolver(FilmAnswers):
    """Solver of a film for gaps that the caller writes into ``H``, ``HF`` and ``H_t``.

    With an elastic liner the caller writes gaps and rate of the undeformed surfaces; ``solve`` replaces them by those
    of the film.

    Parameters
    ----------
    grid : FilmGrid
    closure : Closure
        `FullSommerfeld`, `Gumbel`, `SwiftStieber` or `ElrodAdams`.
    circumferential_pressure_flow : bool
        False drops the pressure flow in theta (short bearing).
    squeeze : bool
        False omits the storage term; ``H_t`` is then never read.
    flux_effects : tuple of FluxEffect
        Effects on conductances and carriers; empty: plain film. The conductances of a shear-thinning oil follow the
        pressure.
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
        Film whose gaps or conductances follow the pressure; None if neither does.
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
        has_feedback = liner is not None or any(isinstance(effect, ShearThinning) for effect in flux_effects)
        super().__init__(
            grid, closure, float(circumferential_pressure_flow), squeeze, flux_effects, density, has_feedback
        )
        self.is_rigid = liner is None
        self.elements = LinerFilm(self, liner or Liner(oil=density)) if has_feedback else None

    def refresh_fixed(self) -> None:
        """Update the film after a change of ``grid.fixed`` and ``grid.cuts``."""
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
            Start-of-step value of fill H, or of rho fill H, for closures that conserve mass; None: a steady film.
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
        """Solve as `solve` over a step, for ``void`` and ``outflow`` at its start, see
        `FilmArrays.memory`; None: a steady film."""
        self.system.cavity_pressure = cavity_pressure
        kept = None if void is None else self.keep(void, step)
        self.lag(outflow, step)
        status, count = self.solve(vx, vz, cavity_pressure, kept, step)
        if status is Status.NOT_CONVERGED and self.lagging:
            # flows that have grown much within a step may carry away more oil than there was at its start
            self.lag(None, step)
            status, count = self.solve(vx, vz, cavity_pressure, kept, step)
        return status, count

    def adjoint(self, weights: np.ndarray, by_gradient: np.ndarray | None = None) -> np.ndarray:
        """Return the adjoints (k, count) of sums over the unknowns with ``weights`` (k, n, m).

        ``by_gradient`` (k, n, m): weights of the unknown itself at vertices whose pressure is not continued beyond a
        rupture line.
        """
        s, w, k = self.system, self.work, len(weights)
        at = w.order[: w.count]
        rows = np.ascontiguousarray(weights.reshape(k, -1)[:, at])
        if s.continued is not None:
            rows_of_linear(s.continued, s.fixed, s.linked, s.cavity_pressure, w.active, w.number, rows)
        if by_gradient is not None:
            rows += by_gradient.reshape(k, -1)[:, at]
        self.solve_transposed(rows)
        return rows

    def _balance(self, r: Reservoirs, solve: Callable[[], tuple[Status, int]], floor: float) -> tuple[Status, int]:
        """Solve the film and the pressures of its reservoirs by Newton's method; no pressure is below ``floor``, Pa.

        A step is halved if the largest balance over the size of its terms grows. A balance below `ROUNDING` that no
        longer halves is accepted as round-off. An unbroken film of constant properties is linear in the pressures of
        the reservoirs: it is solved once, then updated by superposition.
        """
        base, change, smallest_error, steps = r.pressures, np.zeros(len(r.masks)), np.inf, 0
        weights, known, largest_change = base, base, np.inf
        gaps = None if self.is_rigid else np.array((self.H, self.HF, self.H_t))
        for _ in range(MOST_TRIALS):
            r.pressures, error = np.maximum(base + change, floor), np.inf
            known, before = r.transformed()[0] / self.pressure_scale, known
            if smallest_error == np.inf or not self._superpose(r, known - before):
                self.pressure.reshape(-1)[r.at] = known[r.of_vertices]
                if gaps is not None:  # a solution with a liner has replaced them by gaps of deformed surfaces
                    self.H[:], self.HF[:], self.H_t[:] = gaps
                status, count = solve()
                steps += count
            if status is Status.CONVERGED:
                g = r.balance(self.inflow(linear=True), floor)
                weights = 1.0 / r.size if smallest_error == np.inf else weights
                error, relative_balance = (
                    float(np.max(np.abs(g) * w[r.live], initial=0.0)) for w in (weights, 1.0 / r.size)
                )
                at_round_off = largest_change <= TOLERANCE * self.pressure_scale * float(np.abs(self.pressure).max())
                if relative_balance <= TOLERANCE or (
                    (relative_balance <= ROUNDING or at_round_off) and error > 0.5 * smallest_error
                ):
                    return status, steps
            if error < smallest_error:
                base, change, smallest_error = r.pressures, r.change(self.reduced()[2], floor), error
                largest_change = float(np.abs(change).max())
            elif smallest_error < np.inf:
                change = 0.5 * change
            else:
                return status, steps
        return Status.NOT_CONVERGED, steps

    def _superpose(self, r: Reservoirs, change: np.ndarray) -> bool:
        """Update an unbroken film of constant properties for a change (k,) of the areas' scaled pressures.

        Returns False, without an update, for other films and for a film that would not stay unbroken.
        """
        s, w, fixed, reduced = self.system, self.work, self.grid.fixed, self._reduced
        follows = self.elements is not None or self.density is not None or s.column_line is not None
        if reduced is None or follows or not np.all(w.active | fixed) or np.any(change[~reduced[0]]):
            return False
        P, at = s.linear_pressure.reshape(-1), w.order[: w.count]
        new = P[at] - change[reduced[0]] @ reduced[2]
        # pressure above the cavity's below which the rupture line lies beside a vertex
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
        """Solve as `solve`, at given pressures of all areas."""
        s = self.system
        self.vx, self.vz, s.cavity_pressure, self._fills = vx, vz if self.axial else 0.0, cavity_pressure, None
        self._reduced = None
        follows = self.elements is not None or self.density is not None
        if (follows or (self.closure.conserves_mass and mass_old is None)) and not (
            self.H_t.any()
            or (vx != 0.0 and np.ptp(self.H, axis=0).any())
            or (self.vz != 0.0 and np.ptp(self.H, axis=1).any())
        ):
            # without wedge and squeeze the last film is no good initial guess: cold start
            self.forget()
        if self.elements is not None:
            return self._solve_with_feedback(self.elements, mass_old, step)
        return self._solve_sets(mass_old, step)

    def _solve_sets(self, mass_old: np.ndarray | None, step: float) -> tuple[Status, int]:
        """Solve a film whose gaps and conductances do not follow its pressure."""
        s = self.system
        if self.density is not None:
            self.density.scale = self.pressure_scale
        self.set_links()
        self.set_right_hand_side()
        line = None if self.symmetric else s.line or s.oil_line
        if line is not None:
            line.take(s.terms, s.b, self.cavity_density, self.vx)
        if self.closure.clips:
            np.copyto(s.linear_pressure, s.pressure)
        self.set_times(mass_old, step)
        self.hold_back()
        if s.instant:
            s.mass_old *= 1.0 - self.H_t / (s.inverse_step * self.H)
        # where gaps close, a warm start may leave cavities dry that a cold start from a full film fills
        warm = self.work.warm = self.work.warm and not s.closes
        status, steps = solve_sets(s, self.work)
        # beyond its range the law has a constant density, which gives other films
        beyond = self.density is not None and self.density.is_exhausted(s.linear_pressure)
        if warm and (beyond or status is Status.NOT_CONVERGED):
            # a warm start can fail where a cold start converges
            self.forget()
            status, more = solve_sets(s, self.work)
            steps += more
        return status_of(s, status), steps

    def _solve_with_feedback(self, e: LinerFilm, mass_old: np.ndarray | None, step: float) -> tuple[Status, int]:
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
        e.set_line_terms()
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
            # the limiter keeps the film's gap open although the surfaces overlap and no contact separates them
            return Status.NO_FILM, steps
        return status_of(s, Status.CONVERGED), steps

    def _solve_from_sliding(self, e: LinerFilm, mass_old: np.ndarray | None, step: float) -> tuple[bool, int]:
        """Solve by Newton's method; initial guess: film with the viscosity of pure sliding, without pressure
        gradients."""
        e.forget_gradients()
        self.work.warm = False
        status, steps = self._solve_sets(mass_old, step)
        self.set_times(mass_old, step)
        if status is not Status.CONVERGED:
            return False, steps
        self.work.warm, self.work.ready = True, False
        e.set_line_terms()
        ok, more = e.solve()
        return ok, steps + more

    def keep(self, void: np.ndarray, step: float) -> np.ndarray:
        """Return the oil content ``kept`` (n, m) at the start of a step, for the present gaps and rates: ``mass_old``
        of `solve`.

        ``void`` (n, m): gap minus oil at the start of the step. The gap there is not taken from the last step, but
        extrapolated back with the present rate: ``kept = H - h dH/dt - void_old``. The storage of a vertex is then

            (fill H - kept) / h = dH/dt - (void - void_old) / h.

        Only the void enters by a difference over the step (for its flows see `lag`). A full film is squeezed by the
        rate dH/dt, as for closures without a history. With Newmark's formulas the difference quotient of the gap would
        be the mean of the rates at both ends of the step. Rates that alternate from step to step would then cause no
        squeeze, and would not be damped.

        ``kept`` differs from the old content by ``H - h dH/dt - H_old``, for full and for cavitated vertices. Summed
        over the steps this is the difference between integrated rates and gap. With rates that are consistent with the
        gap the sum is ``-h (dH/dt at the end - at the start) / 2``: bounded over any number of steps, and vanishing
        with h.
        """
        before, slope = self.H - step * self.H_t, self.ones
        if self.elements is not None:
            slope = self.elements.deform(before)
        kept = before - void
        if self.law is not None and step <= 0.0:
            # rates at an instant keep the volume: a full film follows the gap at the density of its pressure
            kept = np.minimum(kept / self.cavity_density, before)
        # where the gap opens so fast that the extrapolated content is negative, it is 0 and does not follow the gap
        self.follows = slope * (kept > 0.0)
        return np.maximum(kept, 0.0, out=kept)
