"""Balance of a film on the Winkler elements of a liner, with contact, laws of
the oil, flow factors and density; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.cavitation.elrod_adams import LARGEST_DEFICIT
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.links import FilmState, LinkFlux
from exudyn_ehd.film.solvers.balance import FilmTerms
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.compiled import solve_plain
from exudyn_ehd.film.solvers.liner.elements import (
    Gaps,
    GapSlopes,
    Load,
    Rates,
    answer_columns,
    deflect,
    drive_columns,
    move_columns,
    plain_links,
    press_columns,
    scale_load,
    smallest_of,
)
from exudyn_ehd.film.solvers.liner.gap_response import link_gradients, speed_gradients
from exudyn_ehd.film.solvers.liner.kernels import (
    BALANCED,
    LEAST_DEFLECTION,
    LEAST_PRESSURE,
    ROUNDED,
    ROUNDING,
    SUCTION,
    density_of_load,
    factor_liner,
    flow_rounding,
    liner_residual,
    liner_step,
    plain_residual,
    select,
    take_over,
    take_step,
)
from exudyn_ehd.film.solvers.liner.parts import ColumnContact, ColumnLimiter, ColumnOil
from exudyn_ehd.film.solvers.newton import RULE, Step, newton

FULL, CLIPPED, COMPLEMENTARY = 0, 1, 2


class LinerBalance:
    """`newton.Balance` of a film whose gap yields to its pressure.

    Parameters
    ----------
    film : FilmSolver
        Its gaps, links and factor are the balance's own.
    set_links : callable
        Conductances and Couette fluxes of the film in its present gaps.
    contact : ColumnContact, optional
        What presses on the liner besides the film.
    limiter : ColumnLimiter, optional
        Of the gap that the film sees; goes with the contact or with flow factors.
    oil : ColumnOil, optional
        Of a viscosity that follows the pressure.
    density : CompressibleLaw, optional
        Of a density that does; then it is the ``oil`` as well.
    """

    def __init__(
        self,
        film: FilmSolver,
        set_links: Callable[[], None],
        contact: ColumnContact | None,
        limiter: ColumnLimiter | None,
        oil: ColumnOil | None,
        density: CompressibleLaw | None,
    ) -> None:
        self.film, self.contact, self.limiter, self.oil, self.density = film, contact, limiter, oil, density
        self.set_links = set_links
        # coefficients of links that effects change
        self.links: LinkFlux | None = None
        self.to_pressure: Callable[..., bool] | None = None if oil is None else oil.inverse
        if density is not None:
            self.to_pressure = density.pressure
        s, g, w = film.system, film.grid, film.work
        shape = g.shape
        closure = film.closure
        if closure.clips:
            self.kind = CLIPPED
        else:
            self.kind = COMPLEMENTARY if np.isfinite(closure.cavity_pressure) else FULL
        # whether vertices may be cavitated; a film that keeps its mass starts cold from one that ruptures without
        self.fills = closure.conserves_mass
        self.beta, self.scale = 0.0, 1.0
        self.rates = Rates(0.0, 0.0, 0.0, 1.0)
        self.deflection_old = np.zeros(shape)
        self.rigid = np.ones((3, *shape))
        self.rigid_slope = np.ones(shape)
        self.known = np.zeros((3, *shape))
        self.rigid_film, self.mass_old, self.pseudo_old = self.known
        self.true_gap, self.pressed = np.ones(shape), np.ones(shape)
        self.contact_pressure, self.contact_G, self.bend = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        # whether contact_pressure, contact_G, bend and the slopes in answer are those of surfaces apart
        self.apart = True
        self.gap_fields, self.slope_fields, self.load_fields = (
            np.zeros((5, *shape)),
            np.zeros((9, *shape)),
            np.zeros((4, *shape)),
        )
        self.gaps, self.answer, self.load = (
            Gaps(*self.gap_fields),
            GapSlopes(*self.slope_fields),
            Load(*self.load_fields),
        )
        for field in (self.gaps.H, self.gaps.HF, self.answer.link, self.answer.rate_t, self.load.slope):
            field[:] = 1.0
        # the cavity's pressure on the elements
        self.cavity_load = 0.0
        self.rho = None if density is None else np.ones(shape)
        self.rho_P = None if density is None else np.zeros(shape)
        self.term_fields = np.zeros((8, *shape))
        kx, kz, fx, fz, grow, known, kept, area = self.term_fields
        self.terms = FilmTerms(kx, kz, fx, fz, grow, known, kept, area, g.fixed)
        self.terms.area[:] = film.area
        # Couette flows pass through the widths where links conduct
        across = np.append(g.link_z, 0.0)
        self.metric = np.stack(
            (
                np.outer(g.link_x, g.width_z), np.outer(g.width_x, across), np.outer(g.link_x != 0.0, g.width_z),
                np.outer(g.width_x, across != 0.0),
            )
        )  # fmt: skip
        self.residual = np.zeros(shape)
        self.by = np.zeros((4, w.order.size))
        self.slopes = np.zeros((5, w.order.size))
        fill = s.fill if closure.conserves_mass else np.ones(shape)
        self.u = FilmState(s.linear_pressure, fill, np.ones(shape, dtype=np.bool_))
        self.trial = FilmState(np.zeros(shape), np.ones(shape), np.ones(shape, dtype=np.bool_))
        self.factored = (w.order, w.unknowns, w.lower, w.upper, w.inv_diag)
        self.exact = self.reusable = False
        self.known_slopes = False
        # whether only the liner answers to the film; with effects on the links it does not stay so
        self.plain = contact is None and limiter is None and oil is None and not film.flux_effects
        self.changes = 0
        self.smallest = 1.0
        self.slight = self.noise = 0.0

    # --- the film that is asked for

    def take_rigid(self, squeeze: bool) -> None:
        """Keep the undeformed gaps and their rate, and what the film would see of them."""
        f, r = self.film, self.rigid
        r[0], r[1] = f.H, f.HF
        r[2] = f.H_t if squeeze else 0.0
        self.rigid_film[:] = r[0]
        if self.limiter is not None:
            scratch = np.empty_like(r)
            self.limiter.limit(self.rigid_film, f.HF, scratch[0], self.rigid_slope, scratch[1], scratch[2])

    def set_known_loads(self) -> bool:
        """Pressures on the elements at prescribed vertices and in the cavity; False where the oil has none."""
        fixed, pc = self.film.grid.fixed, self.film.system.cavity_pressure
        self.cavity_load = 0.0 if self.kind == FULL else pc
        P = self.u.P
        if self.to_pressure is None:
            return True
        known = np.append(P[fixed], self.cavity_load)[None] * self.scale
        p, slope, bend = np.empty_like(known), np.empty_like(known), np.empty_like(known)
        if not self.to_pressure(known, p, slope, bend):
            return False
        p /= self.scale
        self.load.p[fixed] = p[0, :-1]
        self.cavity_load = float(p[0, -1])
        return True

    def solve(self) -> tuple[bool, int]:
        """Newton for the film that is asked for, from the present state and sets: (found, steps)."""
        s, free = self.film.system, ~self.film.grid.fixed
        if self.fills:
            # prescribed vertices move with rotating supplies, the cavity's scaled pressure with the viscosity
            self.u.full[~free] = True
            self.u.fill[self.u.full] = 1.0
            self.u.P[~self.u.full] = s.cavity_pressure
        elif self.kind == COMPLEMENTARY:
            np.copyto(self.u.P, np.maximum(self.u.P, s.cavity_pressure), where=free)
        return self._solve_plain() if self.plain and not self.fills else newton(self)

    def _solve_plain(self) -> tuple[bool, int]:
        """`newton` compiled as a whole."""
        f, w, start = self.film, self.film.work, self.reusable and self.film.work.warm
        self.reusable = self.exact = self.known_slopes = False
        ok, steps, self.exact, w.count, w.width = solve_plain(
            tuple(self.u),
            tuple(self.trial),
            f.grid.fixed,
            (f.system.cavity_pressure, f.vx, f.vz, self.beta),
            (self.kind == CLIPPED, self._chooses()),
            (self.load_fields, self.rigid, self.true_gap, self.deflection_old, self.gap_fields, self.slope_fields),
            (self.metric, self.term_fields, self.known),
            tuple(self.rates),
            (self.by, self.slopes, w.number, self.factored),
            self.residual,
            w.active,
            (start, w.warm, w.count, w.width),
        )
        self.reusable = ok
        return ok, steps

    def all_full(self, full: np.ndarray) -> None:
        """Full vertices (n, m) of a film without cavitated oil."""
        self.u.full[:] = full
        np.logical_and(full, ~self.film.grid.fixed, out=self.film.work.active)
        self.u.fill[:] = 1.0

    def storage_gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of the storage to the undeformed gap and rate."""
        a, area = self.answer, self.film.area
        if self.rho is not None:
            area = area * self.rho
        if not self.fills:
            return area * a.rate_r, area * a.rate_t
        content = area * self.u.fill
        by_gap = content * (a.rate_r * self.rates.own)
        if self.rates.mass > 0.0 and not self.film.instant:
            by_gap = by_gap + content * a.H_r * self.rates.mass
        return by_gap, content * (a.rate_t * self.rates.own)

    def flows_by_speed(self) -> np.ndarray:
        """Derivatives (3, n, m) of the links' flows, as of `speed_gradients`."""
        by = np.empty((3, *self.u.P.shape))
        fill = self.u.fill if self.fills else None
        speed_gradients(
            self.u.P,
            fill,
            self.rho,
            self.term_fields,
            self.film.grid.fixed,
            self.gap_fields,
            self.links,
            self.metric,
            by,
        )
        return by

    # --- gaps, links, balance

    def press(self, P: np.ndarray) -> bool:
        """Pressure on every element for the film's unknown P; False where the oil would be solid."""
        load, f = self.load, self.film
        drive_columns(P, f.grid.fixed, f.system.cavity_pressure, self.kind == CLIPPED, self.load_fields)
        if self.oil is None or self.to_pressure is None:
            return True
        if not self.to_pressure(load.drive * self.scale, load.p, load.slope, load.bend):
            return False
        if scale_load(self.load_fields, self.scale) > self.oil.largest_pressure:
            return False
        if self.density is not None and self.rho is not None:
            table = self.density.kernel_table
            density_of_load(self.load_fields, P, self.scale, table.a, table.b, self.rho, self.rho_P)
        return True

    def settle(self, P: np.ndarray) -> bool:
        """Every element under the film of the unknown P, with the gaps that the
        film sees; False where the oil has no pressure."""
        f, contact = self.film, self.contact
        self.known_slopes = False
        if contact is None and self.oil is None:
            smallest, on_links = deflect(
                P,
                f.grid.fixed,
                f.system.cavity_pressure,
                self.kind == CLIPPED,
                self.load_fields,
                self.rigid,
                self.beta,
                self.true_gap,
                self.deflection_old,
                self.rates.liner,
                self.gap_fields,
            )
        else:
            if not self.press(P):
                return False
            smallest = press_columns(self.rigid, self.load_fields, self.beta, self.true_gap)
            if contact is not None:
                self._touch(contact, smallest)
            on_links = move_columns(self.rigid, self.true_gap, self.deflection_old, self.rates.liner, self.gap_fields)
        if self.limiter is not None and (not self.apart or min(smallest, on_links) < self.limiter.limits_below):
            self.limiter.limit(f.H, f.HF, f.H_t, self.answer.rate_t, self.bend, self.answer.link)
            self.apart = False
            self.smallest = float(smallest_of(self.gap_fields))
        else:
            self.smallest = min(smallest, on_links)
        return True

    def _touch(self, contact: ColumnContact, smallest: float) -> None:
        """Gaps of elements that the contact presses as well."""
        if smallest < contact.presses_below:
            self.pressed[:] = self.true_gap
            contact.settle(self.pressed, self.beta, self.scale, self.true_gap, self.contact_pressure, self.contact_G)
            self.apart = False
        elif not self.apart:
            for field in (self.contact_pressure, self.contact_G, self.bend):
                field[:] = 0.0
            self.answer.rate_t[:] = self.answer.link[:] = 1.0
            self.apart = True

    def balance(self, state: FilmState) -> tuple[float, float]:
        """Norm of what does not hold, and the smallest film gap; (inf, -1) where the oil has no pressure."""
        if self.plain and not self.fills:
            return self._plain_balance(state.P)
        if not self.settle(state.P):
            return np.inf, -1.0
        if not self.smallest > 0.0:
            return np.inf, self.smallest
        f = self.film
        if self.links is None:
            plain_links(self.gap_fields, self.metric, f.vx, f.vz, self.term_fields)
        else:
            self.set_links()
        norm = liner_residual(
            state.P,
            state.fill if self.fills else None,
            self.rho,
            self.load_fields,
            self.gap_fields,
            self.term_fields,
            f.grid.fixed,
            self.known,
            tuple(self.rates),
            self.beta,
            f.system.cavity_pressure,
            self._chooses(),
            self.residual,
        )
        return norm, self.smallest

    def _plain_balance(self, P: np.ndarray) -> tuple[float, float]:
        """As `balance` without effects, in one call: for films so fast that calls cost as much as they do."""
        f = self.film
        self.known_slopes = False
        norm, self.smallest = plain_residual(
            P,
            f.grid.fixed,
            (f.system.cavity_pressure, f.vx, f.vz, self.beta),
            (self.kind == CLIPPED, self._chooses()),
            self.load_fields,
            self.rigid,
            self.true_gap,
            self.deflection_old,
            self.gap_fields,
            self.metric,
            self.term_fields,
            self.known,
            tuple(self.rates),
            self.residual,
        )
        return norm, self.smallest

    def gradients(self) -> None:
        """Derivatives of gaps and of the links' flows at the present state, into ``answer`` and ``by``."""
        f, u = self.film, self.u
        answer_columns(
            u.P,
            self.load_fields,
            self.rigid_slope,
            self.contact_G,
            self.bend,
            self.beta,
            self.rates.liner,
            self.slope_fields,
        )
        link_gradients(
            u.P,
            u.fill if self.fills else None,
            self.rho,
            self.term_fields,
            f.grid.fixed,
            self.gap_fields,
            self.links,
            self.metric,
            f.vx,
            f.vz,
            self.by,
        )
        self.known_slopes = True

    # --- what Newton's method asks for

    def begin(self) -> None:
        """Sets to start with; scales of what is none but rounding."""
        f, g = self.film, self.film.grid
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

    def _sides(self, u: FilmState) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
        """P, fill and full of a state, as far as the film has them."""
        return (u.P, u.fill, u.full) if self.fills else (u.P, None, None)

    def _chooses(self) -> bool:
        """Whether vertices without pressure are no unknowns."""
        return self.kind == COMPLEMENTARY and not self.fills

    def _select(self) -> int:
        s = self.film.system
        return int(select(self.u.P, self.residual, self.film.grid.fixed, s.cavity_pressure, self.film.work.active))

    def factor(self) -> bool:
        """Newton's matrix at the present state, factored."""
        w, u, g = self.film.work, self.u, self.film.grid
        if not self.known_slopes:
            self.gradients()
        active = w.active if self._chooses() else ~g.fixed
        ok, w.count, w.width = factor_liner(
            self._sides(u),
            (self.rho, self.rho_P),
            self.term_fields,
            g.fixed,
            self.slope_fields,
            self.load_fields,
            tuple(self.rates),
            self.beta,
            self.by,
            self.slopes,
            self.metric,
            active,
            w.number,
            self.factored,
        )
        return bool(ok)

    def unknowns(self) -> int:
        """Number of unknowns of the factor."""
        return self.film.work.count

    def step(self, gap: float) -> Step:
        """Newton's step with the factor at hand, and the trial state after it; ``gap`` is the smallest one."""
        w, opening, pc = self.film.work, gap / self.beta, self.film.system.cavity_pressure
        *found, self.changes = liner_step(
            self.residual,
            tuple(self.u),
            self.load_fields,
            self.gaps.H,
            self.answer.H_P,
            self.factored,
            w.count,
            w.width,
            (self.kind == CLIPPED and not self.fills, self._chooses(), self.fills),
            (pc, self.cavity_load, max(LEAST_DEFLECTION * opening, self.slight), opening, ROUNDED * self.slight),
            tuple(self.trial),
        )
        return Step(*found)

    def move(self, share: float, peak: float) -> int:
        """The trial state after another ``share`` of the step; returns how many vertices rupture or fill up."""
        self.press(self.u.P)
        self.changes = int(
            take_step(
                tuple(self.u),
                self.load_fields,
                self.factored,
                self.film.work.count,
                share,
                self.film.system.cavity_pressure,
                (self._chooses(), self.fills),
                max(SUCTION * peak, ROUNDED * self.slight),
                tuple(self.trial),
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
        """Sets at the present state once more, after a trial in vain."""
        if self._chooses():
            self._select()

    def nothing_left(self, norm: float) -> bool:
        """Whether the balances hold to the rounding of the flows."""
        return norm <= self.noise and not self.fills

    def settled(self, norm: float) -> bool:
        """Whether small steps mean a solution: suction without bounds makes any step a small one."""
        return self.kind != CLIPPED or self.fills or norm <= BALANCED / ROUNDING * self.noise

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

    def sound(self) -> bool:
        """Whether no vertex holds less than nothing, to rounding, which is cut off."""
        if not self.fills:
            return True
        np.logical_and(self.u.full, ~self.film.grid.fixed, out=self.film.work.active)
        if not self.u.fill.min() > -LARGEST_DEFICIT:
            return False
        np.maximum(self.u.fill, 0.0, out=self.u.fill)
        return True
