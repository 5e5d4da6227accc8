"""Film on the Winkler elements of a liner, with contact, laws of the oil,
flow factors and density; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.balance import FilmTerms, violation
from exudyn_ehd.film.reynolds.links import FilmState, LinkFlux
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.elements import (
    Gaps,
    GapSlopes,
    Load,
    Rates,
    deflect,
    drive_elements,
    element_slopes,
    move_elements,
    plain_links,
    press_elements,
    scale_load,
    smallest_of,
)
from exudyn_ehd.film.solvers.liner.gap_response import link_gradients, speed_gradients
from exudyn_ehd.film.solvers.liner.kernels import density_of_load, liner_residual, plain_residual
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.liner.line_kernels import meet_line
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.surfaces.contact import Contact


class LinerFilm:
    """Film on Winkler elements: gaps and links for its unknowns, its balance and derivatives.

    Parameters
    ----------
    film : FilmSolver
        Its gaps, links and factor are this film's own.
    set_links : callable
        Conductances and Couette fluxes of the film in its present gaps.
    parts : LinerParts
    """

    def __init__(self, film: FilmSolver, set_links: Callable[[], None], parts: LinerParts) -> None:
        self.film, self.set_links = film, set_links
        self.contact, self.limiter, self.oil, self.density = contact, limiter, oil, density = parts
        # coefficients of links that effects change
        self.links: LinkFlux | None = None
        # the one among them that follows the pressure
        self.thin = next((e for e in film.flux_effects if isinstance(e, ShearThinning)), None)
        if self.thin is not None:
            self.thin.place(film.grid, film.flow_x)
        self.to_pressure: Callable[..., bool] | None = None if oil is None else oil.inverse
        if density is not None:
            self.to_pressure = density.pressure
        s, g, closure = film.system, film.grid, film.closure
        shape = g.shape
        self.clips = closure.clips
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
        # whether contact_pressure, contact_G, bend and gap_slopes are those of surfaces apart
        self.apart = True
        self.gap_fields, self.slope_fields, self.load_fields = (np.zeros((k, *shape)) for k in (5, 9, 4))
        self.gaps, self.gap_slopes = Gaps(*self.gap_fields), GapSlopes(*self.slope_fields)
        self.load = Load(*self.load_fields)
        for field in (self.gaps.H, self.gaps.HF, self.gap_slopes.link, self.gap_slopes.rate_t, self.load.slope):
            field[:] = 1.0
        # the cavity's pressure on the elements
        self.cavity_load = 0.0
        self.rho = None if density is None else np.ones(shape)
        self.rho_P = None if density is None else np.zeros(shape)
        self.term_fields = np.zeros((10, *shape))
        kx, kz, fx, fz, grow, known, kept, area, s.prompt, s.late = self.term_fields
        s.prompt[:] = 1.0
        self.terms = FilmTerms(kx, kz, fx, fz, grow, known, kept, area, s.prompt, s.late, g.fixed)
        self.terms.area[:] = film.area
        # Couette flows pass through the widths where links conduct
        across = np.append(g.link_z, 0.0)
        x, z = (g.link_x, g.width_x, g.link_x != 0.0, g.width_x), (g.width_z, across, g.width_z, across != 0.0)
        self.metric = np.stack([np.outer(a, b) for a, b in zip(x, z, strict=True)])
        self.uncut = self.metric[:2].copy()
        self.cut_links()
        self.residual = np.zeros(shape)
        self.by = np.zeros((4, film.work.order.size))
        fill = s.fill if closure.conserves_mass else np.ones(shape)
        self.u = FilmState(s.linear_pressure, fill, np.ones(shape, dtype=np.bool_))
        self.known_slopes = False
        # whether only the liner depends on the film; with effects on the links it does not stay so
        # the film's edge inside its cells, and the same while it takes part
        self.line = FilmLine(shape) if closure.line_in_cells else None
        self.met: FilmLine | None = None
        self.plain = contact is None and limiter is None and oil is None and not film.flux_effects
        self.smallest = 1.0

    def cut_links(self) -> None:
        """Take the grid's cuts; the last factor is of no use."""
        self.reusable = False
        self.metric[:2] = self.uncut
        self.film.grid.cut(*self.metric[:2])

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
        self.cavity_load = pc if self.film.ruptures else 0.0
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

    def press(self, P: np.ndarray) -> bool:
        """Pressure on every element for the film's unknown P; False where the oil would be solid."""
        load, f = self.load, self.film
        drive_elements(P, f.grid.fixed, f.system.cavity_pressure, self.clips, self.load_fields)
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

    def update_elements(self, P: np.ndarray) -> bool:
        """Every element under the film of the unknown P, with the gaps that the
        film sees; False where the oil has no pressure."""
        f, contact = self.film, self.contact
        self.known_slopes = False
        if contact is None and self.oil is None:
            smallest, on_links = deflect(
                P,
                f.grid.fixed,
                f.system.cavity_pressure,
                self.clips,
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
            gap = self.true_gap if contact is None else self.pressed
            smallest = press_elements(self.rigid, self.load_fields, self.beta, gap)
            if contact is not None:
                self._touch(contact, smallest)
            on_links = move_elements(self.rigid, self.true_gap, self.deflection_old, self.rates.liner, self.gap_fields)
        if self.limiter is not None and (not self.apart or min(smallest, on_links) < self.limiter.limits_below):
            self.limiter.limit(f.H, f.HF, f.H_t, self.gap_slopes.rate_t, self.bend, self.gap_slopes.link)
            self.apart = False
            self.smallest = float(smallest_of(self.gap_fields))
        else:
            self.smallest = min(smallest, on_links)
        return True

    def _touch(self, contact: Contact, smallest: float) -> None:
        """Gaps of elements that the contact presses as well."""
        if smallest < contact.presses_below:
            contact.solve_gap(self.pressed, self.beta, self.scale, self.true_gap, self.contact_pressure, self.contact_G)
            self.apart = False
            return
        self.true_gap[:] = self.pressed
        if not self.apart:
            for field in (self.contact_pressure, self.contact_G, self.bend):
                field[:] = 0.0
            self.gap_slopes.rate_t[:] = self.gap_slopes.link[:] = 1.0
            self.apart = True

    def balance(self, state: FilmState) -> tuple[float, float]:
        """Norm of what does not hold, and the smallest film gap; (inf, -1) where the oil has no pressure."""
        if self.plain and not self.fills:
            norm, gap = self._plain_balance(state.P)
            return (norm, gap) if self.met is None or not gap > 0.0 else (self._meet(state.P, self.met), gap)
        if not self.update_elements(state.P):
            return np.inf, -1.0
        if not self.smallest > 0.0:
            return np.inf, self.smallest
        f = self.film
        if self.links is None:
            plain_links(self.gap_fields, self.metric, f.vx, f.vz, self.term_fields)
        else:
            if self.thin is not None:
                self.thin.see(state.P)
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
        return norm if self.met is None else self._meet(state.P, self.met), self.smallest

    def _meet(self, P: np.ndarray, line: FilmLine) -> float:
        """Norm of what does not hold with the line inside the cells."""
        pc, terms = self.film.system.cavity_pressure, self.terms
        meet_line(P, pc, terms.kx, terms.kz, line.state, self.residual)
        return float(violation(self.residual, P, terms.fixed, pc, True))

    def _plain_balance(self, P: np.ndarray) -> tuple[float, float]:
        """As `balance` without effects, in one call: for films so fast that calls cost as much as they do."""
        f = self.film
        self.known_slopes = False
        norm, self.smallest = plain_residual(
            P,
            f.grid.fixed,
            (f.system.cavity_pressure, f.vx, f.vz, self.beta),
            (self.clips, self._chooses()),
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

    def _chooses(self) -> bool:
        """Whether vertices without pressure are no unknowns."""
        return self.film.complementary and not self.fills

    def gradients(self) -> None:
        """Derivatives of gaps and of the links' flows at the present state, into ``gap_slopes`` and ``by``."""
        f, u = self.film, self.u
        element_slopes(
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
            self.film.carried if self.fills else None,
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

    def storage_gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of the storage to the undeformed gap and rate."""
        a, content = self.gap_slopes, self.film.area
        if self.rho is not None:
            content = content * self.rho
        if self.fills:
            content = content * self.u.fill
        if self.rates.own == 0.0:
            kept = self.film.area * self.film.follows
            return (content * a.H_r - kept) * self.rates.mass, kept
        return content * a.rate_r, content * a.rate_t

    def flows_by_speed(self) -> np.ndarray:
        """Derivatives (3, n, m) of the links' flows, as returned by `speed_gradients`."""
        by = np.empty((3, *self.u.P.shape))
        fill = self.film.carried if self.fills else None
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
