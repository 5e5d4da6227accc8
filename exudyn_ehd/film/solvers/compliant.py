"""Film on an elastic liner with contact, mass-conserving cavitation, laws of the oil or flow factors.

As in `exudyn_ehd.film.solvers.liner` a column gives way in proportion to the pressure on it, here that of the film and of the contact:

    G = G_rigid + D,    D = beta (p + P_c(G)),

with the true gap G, whose contact pressure P_c falls with it. The relation has one root G(p), which rises with p:

    dG/dp = beta T,    dG/dG_rigid = T = 1 / (1 - beta P_c'(G))  in (0, 1],

so that the effective compliance beta T is bounded by the liner's, and nearly none where the contact is stiff against it. However deep the
undeformed surfaces overlap, the liner takes it up; at the ends and in grooves, whose pressure is prescribed, by the contact alone.
The film sees ``H = lim(G)``, the gap limiter of wall or rough surfaces, on links ``lim`` of the true gap with the mean deflection of both
ends. Conductances are ``g = H (H^2 + d^2)`` as without contact, d half the difference of ``E = lim(G) - lim(G_rigid)`` between the ends:
what the liner adds to the film's gap; flow factors multiply them (`exudyn_ehd.film.solvers.compliant_links`). The film's rate is
``lim'(G) (rate of the undeformed gap + dD/dt)``.

A viscosity that follows the pressure. The film's unknown is the transformed pressure P of `exudyn_ehd.film.lubricant.pressure_viscosity`, in which its flow is
that of a constant viscosity; the columns feel the pressure itself, p(P) with ``dp/dP = mu(p) / mu_0``. Since p grows exponentially with P,
a Newton step that raises the pressure goes where the tangent of p(P) leads the pressure, which is less far than its P would take it; one that
lowers it goes where P leads: in either case the shorter way, and to second order the same. Thick oil lifts the liner: where a rigid bore
has no film any more the gap opens. What would need an oil that is solid ends with NO_PRESSURE.

`ElrodAdams` has the balance of `exudyn_ehd.film.cavitation.elrod_adams` with the content ``fill H(P)``: at full vertices the unknown pressure takes part in
the storage through the liner, at cavitated ones the unknown is the fill and the column rests under the cavity's pressure.

Newton's method is the one of the plain liner (`exudyn_ehd.film.solvers.compliant_iteration`): vertices without pressure (or full ones) are told from
the iterate, a step is shortened where it would use up more than 80 % of a gap, and pseudo time leads to the steady state of a film that
does not settle (`exudyn_ehd.film.solvers.compliant_start`).
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.banded.substitution import solve_lu_transposed
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import scatter
from exudyn_ehd.film.reynolds.links import FluxEffect, add_squeeze, link_flux
from exudyn_ehd.film.solvers.compliant_columns import (
    BEND,
    DRIVE,
    LOAD_P,
    SLOPE,
    Columns,
    answer_columns,
    drive_columns,
    move_columns,
    press_columns,
    scale_load,
    smallest_gap,
    smallest_true_gap,
)
from exudyn_ehd.film.solvers.compliant_iteration import factor, newton
from exudyn_ehd.film.solvers.compliant_links import (
    compliant_coefficients,
    compliant_gradient,
    compliant_residual,
    compliant_sensitivities,
    links_of,
)
from exudyn_ehd.film.solvers.compliant_parts import ColumnContact, ColumnLimiter, ColumnOil
from exudyn_ehd.film.solvers.compliant_start import cold_start, pseudo_transient
from exudyn_ehd.film.solvers.linear import Closure, FilmSolver, Sensitivities
from exudyn_ehd.film.solvers.liner import LINER_INSTANT, failed_film
from exudyn_ehd.film.solvers.liner_newton import CLIPPED, COMPLEMENTARY, FULL, ends_open
from exudyn_ehd.status import Status

# Share of an oil's largest pressure at which a film that was not found is on its way beyond.
NEARLY_SOLID = 0.9


class CompliantFilmSolver(FilmSolver):
    """`FilmSolver` on an elastic liner with contact, mass-conserving cavitation, laws of the oil, flow factors, or any of them.

    The caller writes gaps and rate of the undeformed surfaces, ``solve`` leaves those that the film sees in ``H``, ``HF`` and ``H_t``.

    Parameters
    ----------
    grid, closure, squeeze
        As for `FilmSolver`.
    contact : ColumnContact, optional
        What presses on the liner beside the film.
    limiter : ColumnLimiter, optional
        Of the gap that the film sees; goes with the contact or with flow factors.
    flux_effects : tuple of FluxEffect
        As for `FilmSolver`.
    oil : ColumnOil, optional
        Of a viscosity that follows the pressure.

    Attributes
    ----------
    beta, pressure_scale : float
        Scaled compliance (deflection over clearance per scaled pressure), and the scale of pressures, Pa.
    delta_old : (n, m) array or None
        Scaled deflection at the start of the step, set by the caller before ``solve``; None: steady.
    true_gap : (n, m) array
        Scaled gap of the deformed surfaces.
    contact_pressure, contact_slope : (n, m) arrays
        Contact pressure, Pa, and its derivative to the scaled undeformed gap at fixed film pressure.
    """

    plain_links = False

    def __init__(
        self, grid: FilmGrid, closure: Closure, *, squeeze: bool = True,
        contact: ColumnContact | None = None, limiter: ColumnLimiter | None = None,
        flux_effects: tuple[FluxEffect, ...] = (), oil: ColumnOil | None = None,
    ) -> None:  # fmt: skip
        super().__init__(grid, closure, squeeze=squeeze)
        self.coarse = None
        self.contact, self.limiter, self.oil = contact, limiter, oil
        self.beta, self.pressure_scale = 0.0, 1.0
        self.delta_old: np.ndarray | None = None
        shape = grid.shape
        self.rigid = np.ones((3, *shape))
        self.rigid_film, self.rigid_slope = np.ones(shape), np.ones(shape)
        self.true_gap = np.ones(shape)
        self.contact_pressure, self.contact_slope = np.zeros(shape), np.zeros(shape)
        self.contact_G, self.bend = np.zeros(shape), np.zeros(shape)
        self.scratch = [np.zeros(shape) for _ in range(4)]
        # whether contact_pressure, contact_G, bend and the slopes in columns are those of surfaces apart
        self.apart = True
        self.fields = np.ones((len(Columns._fields), *shape))
        self.columns = Columns(*self.fields)
        self.load = np.zeros((4, *shape))
        self.load[SLOPE] = 1.0
        # the cavity's pressure on the columns
        self.cavity_load = 0.0
        self.flux_effects = flux_effects
        self.flux = link_flux(self.columns.HF, flux_effects) if flux_effects else None
        self.link_flux = links_of(self.flux)
        self.gain_P, self.gain_fill = np.zeros(shape), np.zeros(shape)
        self.residual = np.zeros(shape)
        self.full, self.trial_full = np.ones(shape, dtype=np.bool_), np.ones(shape, dtype=np.bool_)
        self.trial, self.trial_fill = np.zeros(shape), np.ones(shape)
        self.film_fill = self.system.fill if closure.conserves_mass else np.ones(shape)
        self.mass_old, self.deflection_old = np.zeros(shape), np.zeros(shape)
        self.inverse = self.mass_inverse = self.deflection_inverse = 0.0
        self.with_rate = False
        self.exact = self.held = False
        # whether the columns' derivatives are those of their present state
        self.answered = False
        self.links = np.outer(grid.link_x, np.ones(shape[1]))
        if closure.clips:
            self.kind = CLIPPED
        else:
            self.kind = COMPLEMENTARY if np.isfinite(closure.cavity_pressure) else FULL

    @property
    def deflection(self) -> np.ndarray:
        """Scaled deflection of the last solution (n, m)."""
        return self.columns.D.copy()

    @property
    def deflection_by_pressure(self) -> np.ndarray:
        """dD/dP at the unknown pressures (n, m) of the last solution; zero elsewhere."""
        return np.where(self.work.active, self.columns.D_P, 0.0)

    @property
    def gap_by_pressure(self) -> np.ndarray:
        """d(film gap)/dP at the unknown pressures (n, m) of the last solution; zero elsewhere."""
        return np.where(self.work.active, self.columns.H_P, 0.0)

    @property
    def contact_by_pressure(self) -> np.ndarray:
        """d(contact pressure)/dP, Pa, at the unknown pressures (n, m) of the last solution; zero elsewhere."""
        return np.where(self.work.active, self.contact_G * self.pressure_scale * self.columns.D_P, 0.0)

    def smallest_gap(self) -> float:
        """Smallest scaled gap of the deformed surfaces."""
        return smallest_true_gap(self.rigid, self.fields)

    def stored_power(self) -> float:
        """Scaled power ``sum (p + p_c) dD/dt`` that goes into the liner, not the film; 0 for a steady deflection."""
        if self.deflection_inverse == 0.0:
            return 0.0
        pressure = self.load[LOAD_P] + self.contact_pressure / self.pressure_scale
        rate = (self.columns.D - self.deflection_old) * self.deflection_inverse
        return float(np.sum(pressure * rate * self.grid.weight))

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the undeformed gaps now stored; parameters as for `FilmSolver.solve`."""
        s, g = self.system, self.grid
        self.vx, self.vz = vx, vz
        s.cavity_pressure = cavity_pressure
        self._take_rigid()
        self._set_times(mass_old, step)
        P = s.linear_pressure
        if self.kind == CLIPPED:
            P[g.fixed] = s.pressure[g.fixed]
        if not self._set_loads(P):
            return Status.NO_PRESSURE, 0
        if self.contact is None and not ends_open(self.rigid, self.load[LOAD_P], self.beta, g.fixed):
            self.work.warm = False
            return Status.NO_FILM, 0
        steps, ok = 0, False
        if self.work.warm and self.press(P):
            ok, steps = self.target(P)
        if not ok:
            ok, more = cold_start(self, P)
            steps += more
        if not ok:
            ok, more = pseudo_transient(self, P)
            steps += more
        self.work.warm = ok
        if not ok:
            return self._failure(), steps
        self._finish(P)
        if self.limiter is not None and self.contact is None and not self.true_gap.min() > 0.0:
            # the film between rough surfaces stays open where nothing holds them apart
            return Status.NO_FILM, steps
        return Status.CONVERGED, steps

    def _failure(self) -> Status:
        """Status of a film that was not found."""
        if self.oil is not None:
            highest = float(self.load[LOAD_P].max()) * self.pressure_scale
            if highest > NEARLY_SOLID * self.oil.largest_pressure:
                return Status.NO_PRESSURE
        if self.contact is not None:
            return Status.NOT_CONVERGED
        return failed_film(self.kind, self.rigid[0], self.beta, self.cavity_load)

    def _set_loads(self, P: np.ndarray) -> bool:
        """Pressures on the columns at prescribed vertices and in the cavity; False where the oil has none."""
        fixed, pc = self.grid.fixed, self.system.cavity_pressure
        self.cavity_load = pc if np.isfinite(pc) else 0.0
        if self.oil is None:
            self.load[LOAD_P][fixed] = P[fixed]
            return True
        known = np.append(P[fixed], self.cavity_load)[None] * self.pressure_scale
        p, slope, bend = np.empty_like(known), np.empty_like(known), np.empty_like(known)
        if not self.oil.inverse(known, p, slope, bend):
            return False
        p /= self.pressure_scale
        self.load[LOAD_P][fixed] = p[0, :-1]
        self.cavity_load = float(p[0, -1])
        return True

    def press(self, P: np.ndarray) -> bool:
        """Pressure on every column for the film's unknown P; False where the oil would be solid."""
        load, scale = self.load, self.pressure_scale
        drive_columns(P, self.grid.fixed, self.system.cavity_pressure, self.kind == CLIPPED, load)
        if self.oil is None:
            return True
        if not self.oil.inverse(load[DRIVE] * scale, load[LOAD_P], load[SLOPE], load[BEND]):
            return False
        return scale_load(load, scale) <= self.oil.largest_pressure

    def push(self, P: np.ndarray) -> np.ndarray:
        """Deflection (n, m) that pseudo time counts, of settled columns: what is cut off counts as it stands."""
        return self.beta * (self.load[LOAD_P] + (P - self.load[DRIVE]))

    def _take_rigid(self) -> None:
        """Keep the undeformed gaps, and what the film would see of them."""
        self.rigid[0], self.rigid[1] = self.H, self.HF
        self.rigid[2] = self.H_t if self.squeeze else 0.0
        self.rigid_film[:] = self.H
        if self.limiter is not None:
            face, rate, bend, face_slope = self.scratch
            face[:] = self.HF
            self.limiter.limit(self.rigid_film, face, rate, self.rigid_slope, bend, face_slope)

    def _set_times(self, mass_old: np.ndarray | None, step: float) -> None:
        """Which rates take part, and over which time."""
        inverse = 1.0 / step if step > 0.0 else 1.0 / LINER_INSTANT
        moving = self.delta_old is not None and self.squeeze
        self.deflection_inverse = inverse if moving else 0.0
        if self.delta_old is not None:
            self.deflection_old[:] = self.delta_old
        self.instant = False
        if not self.closure.conserves_mass:
            self.inverse = self.deflection_inverse
            return
        # the liner's own rate is part of the mass fill H
        self.inverse = 0.0
        self.mass_inverse = 0.0 if mass_old is None else inverse
        self.instant = mass_old is not None and step <= 0.0
        self.with_rate = mass_old is None or self.instant
        if mass_old is not None:
            self.mass_old[:] = mass_old
        self.system.inverse_step = self.mass_inverse

    def target(self, P: np.ndarray) -> tuple[bool, int]:
        """Newton for the film that is asked for, from P and the present sets."""
        if self.closure.conserves_mass:
            # prescribed vertices move with rotating supplies, the cavity's scaled pressure with the viscosity
            self.full |= self.grid.fixed
            self.film_fill[self.full] = 1.0
            P[~self.full] = self.system.cavity_pressure
        return newton(self, P, self.film_fill, self.closure.conserves_mass, 0.0, self.nothing)

    def settle(self, P: np.ndarray) -> bool:
        """Every column under the film of the unknown P, with the gaps that the film sees; False where the oil has no pressure."""
        c, contact, limiter = self.columns, self.contact, self.limiter
        self.answered = False
        if not self.press(P):
            return False
        x = self.true_gap if contact is None else self.scratch[0]
        smallest = press_columns(self.rigid, self.load, self.beta, x)
        if contact is not None:
            if smallest < contact.presses_below:
                contact.settle(x, self.beta, self.pressure_scale, self.true_gap, self.contact_pressure, self.contact_G)
                self.apart = False
            else:
                self.true_gap[:] = x
                self._part()
        on_links = move_columns(self.rigid, self.true_gap, self.deflection_old, self.inverse, self.fields)
        if limiter is not None and (not self.apart or min(smallest, on_links) < limiter.limits_below):
            limiter.limit(c.H, c.HF, c.rate, c.rate_t, self.bend, c.link)
            self.apart = False
        return True

    def _part(self) -> None:
        """Surfaces out of each other's reach: no contact, and the film sees the gap itself."""
        if not self.apart:
            for field in (self.contact_pressure, self.contact_G, self.bend):
                field[:] = 0.0
            self.columns.rate_t[:] = self.columns.link[:] = 1.0
            self.apart = True

    def balance(
        self, P: np.ndarray, fill: np.ndarray, conserves: bool, extra: float, extra_old: np.ndarray
    ) -> tuple[float, float]:
        """Residual at P and fill; returns (norm of what does not hold, smallest film gap), (inf, -1) where there is no film."""
        g, pc = self.grid, self.system.cavity_pressure
        if not self.settle(P):
            return np.inf, -1.0
        smallest = smallest_gap(self.fields)
        if not smallest > 0.0:
            return np.inf, smallest
        self._set_flux()
        complementary = self.kind == COMPLEMENTARY and not conserves
        norm = compliant_residual(
            self.fields, self.link_flux, P, self.load, fill, self.rigid_film, self.area, self._times(extra), self.mass_old,
            extra_old, conserves, self.beta, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, g.fixed, pc,
            complementary, self.residual,
        )  # fmt: skip
        return norm, smallest

    def _times(self, extra: float) -> tuple[float, float, float]:
        """Rates of the storage as `gain_of_columns` takes them."""
        return self.mass_inverse, float(self.with_rate), float(extra)

    def answer(self, P: np.ndarray, fill: np.ndarray, conserves: bool, extra: float) -> None:
        """What settled columns and their storage answer to unknown and undeformed gap."""
        answer_columns(
            self.fields, P, self.load, fill, self.rigid_slope, self.contact_G, self.bend, self.area, self._times(extra),
            conserves, self.beta, self.inverse, self.gain_P, self.gain_fill,
        )  # fmt: skip
        self.answered = True

    def _set_flux(self) -> None:
        """Conductances and carriers in the present gaps, which are open."""
        c, f = self.columns, self.flux
        if f is None:
            return
        first, *others = self.flux_effects
        first.start(f, c.H, self.vx, self.vz)
        for effect in others:
            effect.apply(f, c.HF, f.gap_z, self.vx, self.vz)

    def refresh_fixed(self) -> None:
        """Another set of prescribed vertices: the last factor serves no more."""
        self.held = False

    def _finish(self, P: np.ndarray) -> None:
        """Deformed gaps, clipped pressure, and the coefficients that flows and balances are taken from."""
        g, s, c = self.grid, self.system, self.columns
        if self.kind == CLIPPED:
            np.copyto(s.pressure, np.where(g.fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~g.fixed, s.cavity_pressure <= P, out=self.work.active)
        elif self.kind == FULL:
            np.logical_not(g.fixed, out=self.work.active)
        if not self.answered:
            self.answer(P, self.film_fill, self.closure.conserves_mass, 0.0)
        self.H[:], self.HF[:], self.H_t[:] = c.H, c.HF, c.rate
        if self.closure.conserves_mass and self.deflection_inverse > 0.0:
            self.H_t += c.rate_t * (c.D - self.deflection_old) * self.deflection_inverse
        if self.contact is not None:
            np.multiply(self.contact_G * self.pressure_scale, 1.0 + c.D_r, out=self.contact_slope)
        compliant_coefficients(
            self.fields,
            self.link_flux,
            self.vx,
            self.vz,
            g.width_x,
            g.width_z,
            g.link_x,
            g.link_z,
            s.kx,
            s.kz,
            s.fx,
            s.fz,
            s.b,
        )
        if self.squeeze:
            add_squeeze(self.H_t, g.width_x, g.width_z, s.b)
        if self.closure.conserves_mass and self.mass_inverse > 0.0:
            s.mass_old[:] = self.mass_old
            if self.instant:
                s.mass_old -= self.film_fill * c.rate / self.mass_inverse

    def adjoint(self, rhs: np.ndarray) -> np.ndarray:
        """Solve ``J^T lam = rhs`` with Newton's matrix at the solution; rhs (k, count) is overwritten, fields (k, n, m) come back."""
        w, g = self.work, self.grid
        if not self.exact:
            conserves = self.closure.conserves_mass
            active = ~g.fixed if conserves or self.kind == CLIPPED else w.active
            factor(self, self.system.linear_pressure, self.film_fill, active, conserves, 0.0)
            self.exact = True
        lower, upper = w.lower, w.upper
        solve_lu_transposed(lower, upper, w.inv_diag, w.count, w.width, rhs)
        fields = np.empty((rhs.shape[0], *g.shape))
        scatter(rhs, w.order, w.count, fields)
        return fields

    def _gains(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of the storage to the undeformed gap and rate."""
        c = self.columns
        by_gap, by_rate = self.area * c.rate_r, self.area * c.rate_t
        if self.closure.conserves_mass:
            content = self.area * self.film_fill
            by_gap = content * c.rate_r if self.with_rate else self.nothing
            by_rate = content * c.rate_t if self.with_rate else self.nothing
            if self.mass_inverse > 0.0 and not self.instant:
                by_gap = by_gap + content * c.H_r * self.mass_inverse
        return by_gap, by_rate

    def pose_gradient(
        self,
        lam: np.ndarray,
        cos_x: np.ndarray,
        sin_x: np.ndarray,
        cos_f: np.ndarray,
        sin_f: np.ndarray,
        gradient: np.ndarray,
    ) -> None:
        """`sensitivities` of the adjoint functionals lam (k, n, m), contracted with the pose: gradient (k, 10)."""
        g = self.grid
        by_gap, by_rate = self._gains()
        compliant_gradient(
            lam, self.fields, self.link_flux, self.system.linear_pressure, self.film_fill, by_gap,
            by_rate if self.squeeze else self.nothing, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, cos_x,
            sin_x, cos_f, sin_f, g.z, gradient,
        )  # fmt: skip

    def sensitivities(self, lam: np.ndarray) -> Sensitivities:
        """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gaps and rate, and to the speeds."""
        g = self.grid
        by_gap, by_rate = self._gains()
        cell, face, rate = np.empty_like(lam), np.empty_like(lam), np.empty_like(lam)
        speed = np.empty((lam.shape[0], 2))
        compliant_sensitivities(
            lam, self.fields, self.link_flux, self.system.linear_pressure, self.film_fill, by_gap, by_rate, self.vx, self.vz, g.width_x, g.width_z,
            g.link_x, g.link_z, cell, face, rate, speed,
        )  # fmt: skip
        return Sensitivities(cell, face, rate if self.squeeze else np.zeros_like(rate), speed)
