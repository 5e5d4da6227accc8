"""Winkler elements of a liner: pressure on them, deflection, contact, gap of the film, and mass balances.

The equations are in `exudyn_ehd.film.solvers.liner`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.states import OIL, subtract_sink
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.reynolds.balance import carried_fill, film_balance, link_derivatives, terms_of, upstream, violation
from exudyn_ehd.film.reynolds.links import set_links
from exudyn_ehd.film.solvers.film import FilmArrays
from exudyn_ehd.film.solvers.winkler_kernels import (
    Gaps,
    GapSlopes,
    Load,
    Rates,
    correct_links,
    drive_elements,
    element_slopes,
    gaps_of,
    load_of,
    move_elements,
    press_elements,
    set_storage,
)
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter


@njit(cache=True, nogil=True)
def find_slopes(P, fill, rho, film, elements, links):
    """Set the derivatives of the gaps (gap slopes) and of the links' flows (``by``, ``by_speed``) at the present state.

    ``elements``: (gap slopes, gaps, load, rates, beta, by of `link_derivatives`, slope of the undeformed film gap,
    slope of the contact pressure, ``bend`` of `element_slopes`); ``links``: (`LinkFlux.laws` or None, metric, vx, vz,
    by_speed).
    """
    gap_slopes, gaps, load, rates, beta, by, rigid_slope, contact_G, bend = elements
    laws, metric, vx, vz, by_speed = links
    element_slopes(P, load, rigid_slope, contact_G, bend, beta, rates[1], gap_slopes)
    terms, at = terms_of(film[0], film[1]), gaps_of(gaps)
    up = upstream(terms.fx, terms.fz, carried_fill(fill, terms), rho)
    link_derivatives(P, at.H, at.HF, at.E, up, laws, metric, vx, vz, by, by_speed)


@njit(cache=True)
def liner_residual(
    P, fill, rho, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, complementary, curve, out
):  # fmt: skip
    """Apply `correct_links` and set the residual of every vertex, for the present elements and links; returns its norm,
    see `violation`."""
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    set_storage(gaps, load_of(load_fields), P, fill is not None, known, Rates(*rates), beta, film)
    correct_links(gaps, film)
    film_balance(P, fill, rho, film, out)
    if complementary:
        subtract_sink(curve[0], curve[6], 1.0, out)
    return violation(out, P, fixed, pc, complementary)


@njit(cache=True, nogil=True)
def plain_residual(
    P, film, numbers, kinds, load_fields, rigid, G, delta_old, gap_fields, metric, known, rates, out
):  # fmt: skip
    """Set gaps, links and residual of a film on a liner without further effects; returns (norm of the residual,
    smallest gap).

    ``film``: that of `exudyn_ehd.film.solvers.newton`; ``numbers``: (pc, vx, vz, beta); ``kinds``: (clips, whether
    vertices in the cavity have no unknown).
    """
    (pc, vx, vz, beta), (clips, chooses), (terms, fixed, _, curve) = numbers, kinds, film
    drive_elements(P, fixed, pc, clips, load_fields)
    at_vertices = press_elements(rigid, load_fields, beta, G)
    smallest = min(at_vertices, move_elements(rigid, G, delta_old, rates[1], gap_fields))
    if not smallest > 0.0:
        return np.inf, smallest
    set_links(gap_fields[0], gap_fields[1], None, metric, vx, vz, terms)
    norm = liner_residual(
        P, None, None, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, chooses, curve, out
    )
    return norm, smallest


class Liner(NamedTuple):
    """Parts of a liner besides its compliance, None if absent.

    Attributes
    ----------
    contact : Contact or None
        Contact whose pressure deflects the liner, in addition to that of the film.
    limiter : GapLimiter or None
        Limiter of the film's gap, with a contact or with flow factors.
    oil : PressureTransform or None
        Law of a viscosity that follows the pressure; for a compressible film its density law.
    """

    contact: Contact | None = None
    limiter: GapLimiter | None = None
    oil: PressureTransform | None = None


class WinklerElements:
    """Elements under a film and the film's gaps, for given unknowns; parameters and attributes as for `LinerFilm`."""

    def __init__(self, film: FilmArrays, liner: Liner) -> None:
        self.film, s, shape = film, film.system, film.grid.shape
        # the unknown pressure
        self.P = s.linear_pressure
        self.contact, self.limiter, self.oil = liner
        # density ratio and its derivative to the unknown; None where the oil is incompressible
        self.densities: tuple[np.ndarray | None, np.ndarray | None] = (None, None)
        if film.law is not None:
            film.rho, film.rho_P = self.densities = np.ones(shape), np.zeros(shape)
        self.beta, self.scale, self.smallest = 0.0, 1.0, 1.0
        self.rates = Rates(0.0, 0.0, 0.0, 1.0)
        self.delta_old: np.ndarray | None = None
        self.deflection_old, self.deflection_inverse = np.zeros(shape), 0.0
        self.rigid, self.rigid_slope, self.known = np.ones((3, *shape)), np.ones(shape), np.zeros((3, *shape))
        self.rigid_film, s.mass_old, self.pseudo_old = self.known
        self.true_gap, self.pressed = np.ones(shape), np.ones(shape)
        self.contact_pressure, self.contact_slope, self.contact_G, self.bend = np.zeros((4, *shape))
        # part of the area of a vertex under contact pressure
        self.touching = 1.0 if self.contact is None else self.contact.land
        self.gap_fields, self.slope_fields, self.load_fields = (np.zeros((k, *shape)) for k in (5, 9, 4))
        self.gaps, self.gap_slopes = Gaps(*self.gap_fields), GapSlopes(*self.slope_fields)
        self.load = Load(*self.load_fields)
        for field in (self.gaps.H, self.gaps.HF, self.gap_slopes.link, self.gap_slopes.rate_t, self.load.slope):
            field[:] = 1.0
        film.take_gaps(self.gaps.H, self.gaps.HF, self.gaps.rate)
        # pressure on the elements in the cavity
        self.cavity_load = 0.0

    @property
    def deflection(self) -> np.ndarray:
        """Scaled deflection of the last solution (n, m)."""
        return self.gaps.D.copy()

    @property
    def true_link(self) -> np.ndarray:
        """Gap of the deformed surfaces on the links i -> i+1 (n, m)."""
        return self.rigid[1] + 0.5 * (self.gaps.D + np.roll(self.gaps.D, -1, axis=0))

    @property
    def deflection_by_pressure(self) -> np.ndarray:
        """dD/dP at the unknown and the prescribed pressures (n, m) of the last solution; zero elsewhere."""
        return np.where(self.film.work.active | self.film.grid.fixed, self.gap_slopes.D_P, 0.0)

    def smallest_gap(self) -> float:
        """Smallest scaled gap of the deformed surfaces."""
        return float(min(self.true_gap.min(), self.true_link.min()))

    def stored_power(self) -> float:
        """Scaled power ``sum (p + p_c) dD/dt`` that is stored in the liner; 0 for a steady deflection."""
        pressure = self.load.p + self.contact_pressure / self.scale
        return float(np.sum(pressure * self.deflection_rate * self.film.grid.weight))

    @property
    def deflection_rate(self) -> np.ndarray:
        """dD/dt (n, m)."""
        return (self.gaps.D - self.deflection_old) * self.deflection_inverse

    @property
    def takes_up_squeeze(self) -> bool:
        """Return whether the rates at an instant are asked for. Pressures and fills are then those of the state before,
        as the deflection takes up the squeeze: no line inside the cells may follow it."""
        return self.beta > 0.0 and self.film.system.instant

    @property
    def true_rate(self) -> np.ndarray:
        """Rate of `true_gap` (n, m)."""
        return self.rigid[2] + self.deflection_rate

    def deform(self, gap: np.ndarray) -> np.ndarray:
        """Convert the undeformed gap (n, m) at the start of a step to the film's gap, in place; returns its
        derivative."""
        if self.delta_old is not None:
            gap += self.delta_old
        slope, link, rate, bend, face_slope = np.ones((5, *gap.shape))
        if self.limiter is not None:
            self.limiter.limit(gap, link, rate, slope, bend, face_slope)
        return slope

    def take_rigid(self) -> None:
        """Store gaps and rate of the undeformed surfaces, and the film gap of a limiter for them."""
        f, r = self.film, self.rigid
        self.scale = f.pressure_scale
        r[0], r[1] = f.H, f.HF
        r[2] = f.H_t if f.squeeze else 0.0
        self.rigid_film[:] = r[0]
        if self.limiter is not None:
            scratch = np.empty_like(r)
            self.limiter.limit(self.rigid_film, f.HF, scratch[0], self.rigid_slope, scratch[1], scratch[2])

    def set_rates(self, step: float) -> None:
        """Set the rates of the storage; that of the mass is taken from the film's system."""
        f, s = self.film, self.film.system
        self.deflection_inverse = 0.0
        if self.delta_old is not None:
            self.deflection_old[:] = self.delta_old
            if f.squeeze:
                self.deflection_inverse = 1.0 / step if step > 0.0 else f.inverse_instant()
        # with mass conservation, the change of the deflection is part of that of the mass rho fill H
        by_liner = 0.0 if s.kind == OIL else self.deflection_inverse
        self.rates = Rates(s.inverse_step, by_liner, 0.0, float(s.inverse_step == 0.0 or s.instant))

    def set_known_loads(self) -> bool:
        """Set the elements' pressures at prescribed vertices and in the cavity; returns False if one of them is beyond
        the oil's law."""
        s, fixed, P = self.film.system, self.film.grid.fixed, self.P
        if self.film.closure.clips:
            P[fixed] = s.pressure[fixed]
        self.cavity_load = s.cavity_pressure if self.film.ruptures else 0.0
        if self.oil is None:
            return True
        inside, (p, *_) = self.oil.fields(np.append(P[fixed], self.cavity_load) * self.scale)
        self.load.p[fixed] = p[:-1] / self.scale
        self.cavity_load = float(p[-1]) / self.scale
        return inside

    def ends_open(self) -> bool:
        """Return whether gaps at vertices with prescribed pressure are open; True for every film with a contact."""
        if self.contact is not None:
            return True
        D, fixed = self.beta * (self.P if self.oil is None else self.load.p), self.film.grid.fixed
        on_links = self.rigid[1] + 0.5 * (D + np.roll(D, -1, axis=0))
        is_open = self.rigid[0] + D > 0.0, on_links > 0.0
        return not np.any(fixed & ~is_open[0]) and not np.any(fixed & np.roll(fixed, -1, axis=0) & ~is_open[1])

    def press(self, P: np.ndarray) -> bool:
        """Set the pressure on every element for the film's unknown P; returns False if the oil would be solid."""
        load, f = self.load, self.film
        drive_elements(P, f.grid.fixed, f.system.cavity_pressure, f.closure.clips, self.load_fields)
        if self.oil is None:
            return True
        inside, (p, load.slope[:], bend, rho, rho_q) = self.oil.fields(load.drive * self.scale)
        load.p[:], load.bend[:] = p / self.scale, bend * self.scale
        if f.rho_P is not None:
            # the density is constant where the pressure is clipped
            f.rho[:], f.rho_P[:] = rho, rho_q * (load.drive == P) * self.scale
        return inside and float(p.max()) <= self.oil.largest_pressure

    def update_elements(self, P: np.ndarray) -> bool:
        """Update the elements and the film's gaps for the unknown P; returns False if it is beyond the oil's law."""
        f, contact = self.film, self.contact
        if not self.press(P):
            return False
        smallest = press_elements(
            self.rigid, self.load_fields, self.beta, self.true_gap if contact is None else self.pressed
        )
        if contact is not None:
            contact.solve_gap(self.pressed, self.beta, self.scale, self.true_gap, self.contact_pressure, self.contact_G)
        on_links = move_elements(self.rigid, self.true_gap, self.deflection_old, self.rates.liner, self.gap_fields)
        self.smallest = min(smallest, on_links)
        if self.limiter is not None:
            self.limiter.limit(f.H, f.HF, f.H_t, self.gap_slopes.rate_t, self.bend, self.gap_slopes.link)
            self.smallest = float(self.gap_fields[:2].min())
        return True
