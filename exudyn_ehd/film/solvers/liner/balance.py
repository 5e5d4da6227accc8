"""A film on a liner as Newton's method sees it; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

import copy
from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.cavitation.solve import LARGEST_DEFICIT
from exudyn_ehd.film.reynolds.links import FilmState
from exudyn_ehd.film.solvers.compiled import solve
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.elements import plain_links
from exudyn_ehd.film.solvers.liner.film import LinerFilm
from exudyn_ehd.film.solvers.liner.line import GapChain
from exudyn_ehd.film.solvers.liner.line_kernels import NO_LINE, is_factored, open_gaps
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.solvers.newton import RULE, Step
from exudyn_ehd.film.solvers.steps import (
    BALANCED,
    LEAST_DEFLECTION,
    LEAST_PRESSURE,
    ROUNDED,
    ROUNDING,
    SUCTION,
    factor_film,
    flow_rounding,
    newton_step,
    select,
    take_over,
    take_step,
)

# Pa: a film at rest has no pressures but rounding, and no share of those would ever be small.
SMALLEST_PEAK = 1e-6


class LinerBalance(LinerFilm):
    """A film whose gap yields to its pressure, as `newton` sees it; parameters as for `LinerFilm`."""

    def __init__(self, film: FilmSolver, set_links: Callable[[], None], parts: LinerParts) -> None:
        super().__init__(film, set_links, parts)
        shape, self.matrix = film.grid.shape, film.work.matrix
        self.trial = FilmState(np.zeros(shape), np.ones(shape), np.ones(shape, dtype=np.bool_))
        self.exact = self.reusable = False
        self.changes = self.taken = 0
        self.slight = self.noise = 0.0

    def see_cavity(self) -> None:
        """Take the line's coefficients of the film that is about to be solved; gaps and links are left as they are in
        the cavity."""
        line, f, rates = self.line, self.film, self.rates
        if line is None:
            return
        s, g = f.system, f.grid
        self.rates = rates._replace(liner=0.0)
        self.update_elements(np.where(g.fixed, self.u.P, s.cavity_pressure))
        self.rates = rates
        open_gaps(self.gap_fields, line.touching)
        if self.links is None:
            plain_links(self.gap_fields, self.metric, f.vx, f.vz, self.term_fields)
        else:
            if self.thin is not None:
                self.thin.see(f.nothing)
            self.set_links()
            line.flux = copy.deepcopy(self.links)
            if self.thin is not None:
                s.kx *= self.thin.slide(line.flux, f.vx)
        if self.rho is not None:
            line.density = float(self.rho[~g.fixed].min(initial=np.inf))
        widths = (g.width_x, g.width_z)
        line.see(self.gap_fields, self.term_fields, s.b, f.squeeze, widths, g.fixed, self.beta, f.vx)
        if self.limiter is not None or self.contact is not None:
            a, follow = self.gap_slopes, 1.0 / (1.0 - self.beta * self.contact_G) - 1.0
            line.chain = GapChain(a.rate_t.copy(), self.bend.copy(), a.link.copy(), follow)

    def settle_line(self) -> None:
        """The line of the film that is solved."""
        if self.line is None:
            return
        self.line.settle(self.film.work.active)
        self.exact = self.exact and bool(is_factored(self.line.block))

    def deflection_weights(self, lam: np.ndarray) -> np.ndarray:
        """Gradients of the adjoint functionals lam (k, n, m) to the deflection's rate, which a rupture line, where the
        liner rests, does not feel."""
        return -lam * self.storage_gradients()[1] if self.film.squeeze else np.zeros_like(lam)

    def solve_plain(self) -> tuple[bool, int]:
        """`newton` compiled as a whole."""
        f, w, start = self.film, self.film.work, self.reusable and self.film.work.warm
        self.reusable = self.exact = self.known_slopes = False
        ok, steps, self.exact, w.count, w.width = solve(
            self.u.P,
            self.trial.P,
            f.grid.fixed,
            (f.system.cavity_pressure, f.vx, f.vz, self.beta),
            (self.clips, self._chooses()),
            self.term_fields,
            self.rigid[2],
            (
                self.load_fields, self.rigid, self.true_gap, self.deflection_old, self.gap_fields, self.slope_fields,
                self.metric, self.known, tuple(self.rates), self.by,
            ),
            self.matrix,
            self.residual,
            w.active,
            (start, w.warm, w.count, w.width),
            NO_LINE if self.met is None else self.met.state,
        )  # fmt: skip
        self.reusable = ok
        return ok, steps

    def all_full(self, full: np.ndarray) -> None:
        """Full vertices (n, m) of a film without cavitated oil."""
        self.u.full[:] = full
        np.logical_and(full, ~self.film.grid.fixed, out=self.film.work.active)
        self.u.fill[:] = 1.0

    def begin(self) -> None:
        """Sets to start with; scales of what is none but rounding."""
        f, g = self.film, self.film.grid
        self.taken = 0
        if not self.fills:
            self.u.full[:] = True
        if self._chooses():
            if not f.work.warm:
                np.logical_not(g.fixed, out=f.work.active)
            elif not self.reusable:
                self._select()
        self.reusable = self.reusable and f.work.warm
        # what a journal centred to rounding makes of the speed
        self.slight = LEAST_PRESSURE * (abs(f.vx) + abs(f.vz))
        self.noise = flow_rounding(self.term_fields, self.rigid[2])

    def sides(self, u: FilmState) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
        """P, fill and full of a state, as far as the film has them."""
        return (u.P, u.fill, u.full) if self.fills else (u.P, None, None)

    def _select(self) -> int:
        s = self.film.system
        return int(select(self.u.P, self.residual, self.film.grid.fixed, s.cavity_pressure, self.film.work.active))

    def factor(self) -> bool:
        """Newton's matrix at the present state, factored."""
        w, u, g = self.film.work, self.u, self.film.grid
        if not self.known_slopes:
            self.gradients()
        ok, w.count, w.width = factor_film(
            self.sides(u),
            (self.rho, self.rho_P),
            self.term_fields,
            g.fixed,
            (self.slope_fields, self.load_fields, tuple(self.rates), self.beta, self.by),
            self.matrix,
            w.active if self._chooses() else ~g.fixed,
            None if self.thin is None else self.thin.response(),
            NO_LINE if self.met is None else self.met.state,
        )
        return bool(ok)

    def step(self, gap: float) -> Step:
        """Newton's step with the factor at hand, and the trial state after it; ``gap`` is the smallest one."""
        w, pc = self.film.work, self.film.system.cavity_pressure
        # the pressure that would open the gap of a liner; between rigid surfaces none does
        opening, least = np.inf, SMALLEST_PEAK / self.scale
        if self.beta > 0.0:
            opening = gap / self.beta
            least = LEAST_DEFLECTION * opening
        *found, self.changes = newton_step(
            self.residual,
            self.sides(self.u),
            (self.load_fields, self.gap_fields, self.slope_fields),
            self.matrix[2],
            w.count,
            w.width,
            (self.clips, self._chooses()),
            (pc, self.cavity_load, max(least, self.slight), opening, ROUNDED * self.slight),
            self.sides(self.trial),
            NO_LINE if self.met is None else self.met.state,
            self.taken,
        )
        self.taken += 1
        return Step(*found)

    def move(self, share: float, peak: float) -> int:
        """The trial state after another ``share`` of the step; returns how many vertices rupture or fill up."""
        self.press(self.u.P)
        self.changes = int(
            take_step(
                self.sides(self.u),
                (self.load_fields, self.gap_fields, self.slope_fields),
                self.matrix[2],
                self.film.work.count,
                share,
                self.film.system.cavity_pressure,
                self._chooses(),
                max(SUCTION * peak, ROUNDED * self.slight),
                self.sides(self.trial),
            )
        )
        return self.changes

    def accept(self) -> int:
        """The trial state becomes the present one; returns how many vertices change sides."""
        if self._chooses():
            f = self.film
            return int(
                take_over(self.trial.P, self.residual, f.grid.fixed, f.system.cavity_pressure, f.work.active, self.u.P)
            )
        self.u.P[:] = self.trial.P
        if self.fills:
            self.u.fill[:], self.u.full[:] = self.trial.fill, self.trial.full
            return self.changes
        return 0

    def undo(self) -> None:
        """Sets at the present state once more, after a trial that is not taken."""
        if self._chooses():
            self._select()

    def nothing_left(self, norm: float) -> bool:
        """Whether the balances hold to the rounding of the flows."""
        return norm <= self.noise and not self.fills

    def settled(self, norm: float) -> bool:
        """Whether small steps mean a solution: suction without bounds makes any step a small one."""
        return not self.clips or norm <= BALANCED / ROUNDING * self.noise

    def correct(self, gap: float) -> None:
        """One more step for the balances where the gap is wide: what is left changes the gaps by next to nothing."""
        if self.rates.pseudo != 0.0:
            return
        step = self.step(gap)
        if not step.size <= RULE.final or self.changes > 0:
            return
        if not self.press(self.trial.P):
            self.press(self.u.P)
            return
        self.u.P[:] = self.trial.P
        if self.fills:
            self.u.fill[:] = self.trial.fill
        if self.thin is not None or self.met is not None:
            # conductances and the line follow the last correction, too
            self.balance(self.u)

    def sound(self) -> bool:
        """Whether no vertex holds less than nothing, to rounding, which is cut off."""
        if not self.fills:
            return True
        np.logical_and(self.u.full, ~self.film.grid.fixed, out=self.film.work.active)
        if not self.u.fill.min() > -LARGEST_DEFICIT:
            return False
        np.maximum(self.u.fill, 0.0, out=self.u.fill)
        return True
