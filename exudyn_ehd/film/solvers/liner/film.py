"""Film on the Winkler elements of a liner, with contact, oil laws, flow factors and density; the equations are in
`exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.cavitation.oil_line import straight
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.elements import (
    Gaps,
    GapSlopes,
    Load,
    Rates,
    deflect,
    drive_elements,
    move_elements,
    plain_links,
    press_elements,
    scale_load,
    smallest_of,
)
from exudyn_ehd.film.solvers.liner.gap_response import speed_gradients
from exudyn_ehd.film.solvers.liner.kernels import density_of_load, liner_residual
from exudyn_ehd.film.solvers.liner.line import FilmLine, OilFilmLine
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.surfaces.contact import Contact


class LinerFilm:
    """Film on Winkler elements: gaps, links, mass balances and derivatives for given unknowns.

    Parameters
    ----------
    film : FilmSolver
        Its gaps, links and factor are this film's own.
    set_links : callable
        Sets conductances and Couette fluxes for the present gaps.
    parts : LinerParts
    """

    def __init__(self, film: FilmSolver, set_links: Callable[[], None], parts: LinerParts) -> None:
        self.film, self.set_links = film, set_links
        self.contact, self.limiter, self.oil, self.density = contact, limiter, oil, density = parts
        # coefficients of links that effects change
        self.links: LinkFlux | None = None
        # the flux effect that follows the pressure
        self.thin = next((e for e in film.flux_effects if isinstance(e, ShearThinning)), None)
        if self.thin is not None:
            self.thin.place(film.grid, film.flow_x)
        self.to_pressure: Callable[..., bool] | None = None if oil is None else oil.inverse
        if density is not None:
            self.to_pressure = density.pressure
        s, g, closure = film.system, film.grid, film.closure
        shape = g.shape
        self.clips = closure.clips
        # whether vertices may be cavitated
        self.fills = self.conserves_mass = closure.conserves_mass
        self.beta, self.scale = 0.0, 1.0
        self.rates = Rates(0.0, 0.0, 0.0, 1.0)
        self.deflection_old = np.zeros(shape)
        self.rigid = np.ones((3, *shape))
        self.rigid_slope = np.ones(shape)
        self.known = np.zeros((3, *shape))
        self.rigid_film, self.mass_old, self.pseudo_old = self.known
        self.true_gap, self.pressed = np.ones(shape), np.ones(shape)
        self.contact_pressure, self.contact_G, self.bend = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        # whether contact_pressure, contact_G, bend and gap_slopes have their values for surfaces apart
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
        # the unknown pressure, and the film fraction
        self.P, self.fill = s.linear_pressure, s.fill if self.fills else np.ones(shape)
        # whether vertices in the cavity have no unknown
        self.chooses = film.complementary and not self.fills
        # rupture line inside the cells, curves of the vertices, and ``late`` of the flows without curves
        self.line, self.curve, self.late = edge_of(film, s.late)
        # whether the pressure changes the deflection of the liner alone
        self.plain = contact is None and limiter is None and oil is None and not film.flux_effects
        self.smallest = 1.0

    def cut_links(self) -> None:
        """Apply the grid's cuts to the links, which invalidates the last factor."""
        self.reusable = False
        self.metric[:2] = self.uncut
        self.film.grid.cut(*self.metric[:2])

    def take_rigid(self, squeeze: bool) -> None:
        """Store gaps and rate of the undeformed surfaces, and the film gap that a limiter makes of them."""
        f, r = self.film, self.rigid
        r[0], r[1] = f.H, f.HF
        r[2] = f.H_t if squeeze else 0.0
        self.rigid_film[:] = r[0]
        if self.limiter is not None:
            scratch = np.empty_like(r)
            self.limiter.limit(self.rigid_film, f.HF, scratch[0], self.rigid_slope, scratch[1], scratch[2])

    def set_known_loads(self) -> bool:
        """Set the elements' pressures at prescribed vertices and in the cavity; returns False if the oil's law has
        none."""
        fixed, pc = self.film.grid.fixed, self.film.system.cavity_pressure
        self.cavity_load = pc if self.film.ruptures else 0.0
        P = self.P
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
        """Set the pressure on every element for the film's unknown P; returns False if the oil would be solid."""
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
        """Update the elements and the gaps that the film sees for its unknown P; returns False if the oil's law has no
        such pressure."""
        f, contact = self.film, self.contact
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
        """Set the gaps of elements on which a contact presses as well."""
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

    def balance(self) -> tuple[float, float]:
        """Update gaps, links and residual; returns (norm of the residual, smallest film gap), (inf, -1) if the oil's
        law has no such pressure."""
        f, fill = self.film, self.fill if self.fills else None
        if not self.update_elements(self.P):
            return np.inf, -1.0
        if not self.smallest > 0.0:
            return np.inf, self.smallest
        if self.links is None:
            plain_links(self.gap_fields, self.metric, f.vx, f.vz, self.term_fields)
        else:
            if self.thin is not None:
                self.thin.see(self.P)
            self.set_links()
        norm = liner_residual(
            self.P,
            fill,
            self.rho,
            self.load_fields,
            self.gap_fields,
            self.term_fields,
            f.grid.fixed,
            self.known,
            tuple(self.rates),
            self.beta,
            f.system.cavity_pressure,
            self.chooses,
            self.curve,
            self.residual,
        )
        return norm, self.smallest

    def storage_gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of the storage to the undeformed gap and to its rate."""
        a, content = self.gap_slopes, self.film.area
        if self.rho is not None:
            content = content * self.rho
        if self.fills:
            content = content * self.fill
        if self.rates.own == 0.0:
            kept = self.film.area * self.film.follows
            return (content * a.H_r - kept) * self.rates.mass, kept
        return content * a.rate_r, content * a.rate_t

    def flows_by_speed(self) -> np.ndarray:
        """Derivatives (3, n, m) of the links' flows to the speeds, as `speed_gradients` sets them."""
        by = np.empty((3, *self.P.shape))
        fill = self.film.carried if self.fills else None
        speed_gradients(
            self.P,
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


def edge_of(film: FilmSolver, late: np.ndarray) -> tuple[FilmLine | OilFilmLine | None, np.ndarray, np.ndarray]:
    """Return the rupture line inside the cells (None without), the curves of its vertices, and ``late`` without curves.

    ``late`` (n, m): that of the film's coefficients, see `exudyn_ehd.film.reynolds.lagging_void`.
    """
    s, shape = film.system, late.shape
    if film.closure.clips or not film.closure.line_in_cells:
        return None, straight(shape), late
    if not film.closure.conserves_mass:
        line = FilmLine(shape)
        return line, line.curve, late
    film.oil_line = s.oil_line = edge = OilFilmLine(shape)
    edge.late, s.late = late, np.zeros(shape)
    return edge, edge.block, edge.kept
