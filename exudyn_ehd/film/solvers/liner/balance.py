"""Newton's method for a film on a liner; see `exudyn_ehd.film.solvers.nonlinear`.

The unknowns are those of `exudyn_ehd.film.cavitation.solve`. Between two steps of
`exudyn_ehd.film.solvers.liner.steps`, the gaps and all other fields that follow the pressure are updated.
"""

from __future__ import annotations

import copy
from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.cavitation.oil_line import Curve
from exudyn_ehd.film.cavitation.solve import FOUND, GOES_ON, LEFT, base_of, is_exact
from exudyn_ehd.film.cavitation.states import RUPTURE
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.elements import plain_links
from exudyn_ehd.film.solvers.liner.film import LinerFilm
from exudyn_ehd.film.solvers.liner.line import FilmLine, GapChain, OilFilmLine
from exudyn_ehd.film.solvers.liner.line_kernels import open_gaps
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.solvers.liner.steps import begin, factor_film, find_slopes, proceed, solve_plain


class LinerBalance(LinerFilm):
    """Newton's method for a film whose gap follows its pressure; parameters as for `LinerFilm`."""

    def __init__(self, film: FilmSolver, set_links: Callable[[], None], parts: LinerParts) -> None:
        super().__init__(film, set_links, parts)
        w, shape = film.work, film.grid.shape
        self.above, steep, u, above = np.zeros((4, *shape))
        # what the kernels of `exudyn_ehd.film.solvers.liner.steps` take
        self.state = w.oil.u, self.above, self.fill
        self.film_fields = self.term_fields, film.grid.fixed, self.late, self.curve
        self.count_oil(self.fills)
        self.matrix = w.order, w.number, w.lower, w.upper, w.inv_diag, w.oil.slopes, steep
        self.places = self.P, self.residual, w.unknowns, u, np.zeros(shape, dtype=np.bool_), above
        self.exact = self.reusable = False

    def count_oil(self, fills: bool) -> None:
        """Conserve mass from now on if ``fills``; else a mass-conserving film ruptures as one of Swift and Stieber."""
        self.fills, self.oil_fields = fills, (self.fill if fills else None, self.rho, self.rho_P)
        self.kind = RUPTURE if self.conserves_mass and not fills else self.film.system.kind
        self.chooses, self.reusable = self.film.complementary and not fills, False

    def fill_up(self) -> None:
        """Remove the cavity: every vertex is full and has at least the pressure of a fully developed curve."""
        w, curve = self.film.work, Curve(*self.curve).whole.reshape(self.P.shape)
        np.logical_not(self.film.grid.fixed, out=w.active)
        self.fill[:] = 1.0
        np.maximum(self.P, base_of(self.film.system) + curve, out=self.P, where=curve > 0.0)

    def see_cavity(self) -> None:
        """Set the rupture line's coefficients for the film to be solved. Gaps and links are left at their values at the
        cavity pressure."""
        line, f, rates = self.line, self.film, self.rates
        if line is None:
            return
        s, g = f.system, f.grid
        self.rates = rates._replace(liner=0.0)
        self.update_elements(np.where(g.fixed, self.P, s.cavity_pressure))
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
        """Update the rupture line to the solved film."""
        if isinstance(self.line, FilmLine):
            self.line.settle(self.film.work.active)

    def deflection_weights(self, lam: np.ndarray) -> np.ndarray:
        """Gradients (k, n, m) of the adjoint functionals lam (k, n, m) to the deflection's rate. The rupture line adds
        none, since its liner rests."""
        return -lam * self.storage_gradients()[1] if self.film.squeeze else np.zeros_like(lam)

    def solve(self) -> tuple[bool, int]:
        """Solve by Newton's method from the present pressures and sets, in place; returns (found, steps)."""
        w, s = self.film.work, self.film.system
        if isinstance(self.line, OilFilmLine):
            self.line.straighten(s)
        ready = self.reusable and w.warm
        self.reusable = self.exact = False
        course, outcome = (0, False, -1, 1.0, 0.0, w.count, w.width, (ready, False, False, 0.0, LEFT)), GOES_ON
        rest = (
            self.kind,
            base_of(s),
            w.active,
            self.state,
            self.oil_fields,
            self.film_fields,
            self.elements,
            self.links_seen,
        )
        if self.plain and not self.fills:
            numbers = s.cavity_pressure, self.film.vx, self.film.vz, self.beta
            plain = numbers, self.clips, self.rigid, self.true_gap, self.deflection_old, self.known
            outcome, course = solve_plain(course, *rest, self.matrix, self.places, plain)
        else:
            begin(self.film_fields, self.kind, base_of(s), w.active, self.state, self.P)
        while outcome == GOES_ON:
            norm, gap = self.balance()
            outcome, course = proceed(norm, gap, course, *rest, self.response, self.matrix, self.places)
        steps, *_, w.count, w.width, progress = course
        self.reusable, self.exact = outcome == FOUND, is_exact(progress)
        return self.reusable, steps

    @property
    def elements(self) -> tuple[object, ...]:
        """Argument ``elements`` of `find_slopes`."""
        return (
            self.slope_fields,
            self.gap_fields,
            self.load_fields,
            tuple(self.rates),
            self.beta,
            self.by,
            self.rigid_slope,
            self.contact_G,
            self.bend,
        )

    @property
    def links_seen(self) -> tuple[object, ...]:
        """Argument ``links`` of `find_slopes`."""
        return self.links, self.metric, self.film.vx, self.film.vz

    @property
    def response(self) -> tuple[np.ndarray, ...] | None:
        """`ShearThinning.response` for Newton's matrix; None if no conductance follows the pressure."""
        return None if self.thin is None else self.thin.response()

    def gradients(self) -> None:
        """Update ``gap_slopes`` and ``by``: derivatives of the gaps and of the links' flows at the present state."""
        find_slopes(self.P, self.oil_fields[0], self.rho, self.film_fields, self.elements, self.links_seen)

    def factor(self) -> None:
        """Factor Newton's matrix at the present state."""
        w = self.film.work
        _, w.count, w.width = factor_film(
            self.kind, self.P, self.oil_fields, self.film_fields, self.elements, self.links_seen,
            self.response, self.matrix, w.active,
        )  # fmt: skip
