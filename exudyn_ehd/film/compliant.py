"""Film on an elastic liner that touches the journal, or that keeps its oil: contact and mass-conserving cavitation on columns.

As in `exudyn_ehd.film.liner` a column gives way in proportion to the pressure on it, here that of the film and of the contact:

    G = G_rigid + D,    D = beta (P + P_c(G)),

with the true gap G, whose contact pressure P_c falls with it. The relation has one root G(P), which rises with P:

    dG/dP = beta T,    dG/dG_rigid = T = 1 / (1 - beta P_c'(G))  in (0, 1],

so that the effective compliance beta T is bounded by the liner's, and nearly none where the contact is stiff against it. However deep the
undeformed surfaces overlap, the liner takes it up; at the ends and in grooves, whose pressure is prescribed, by the contact alone.
The film sees ``H = lim(G)``, the gap limiter of wall or asperities, on links ``lim`` of the true gap with the mean deflection of both ends.
Conductances are ``g = H (H^2 + d^2)`` as without contact, d half the difference of ``E = lim(G) - lim(G_rigid)`` between the ends:
what the liner adds to the film's gap. The film's rate is ``lim'(G) (rate of the undeformed gap + dD/dt)``.

`ElrodAdams` has the balance of `exudyn_ehd.film.elrod` with the content ``fill H(P)``: at full vertices the unknown pressure takes part in
the storage through the liner, at cavitated ones the unknown is the fill and the column rests under the cavity's pressure.

Newton's method is the one of the plain liner: vertices without pressure (or full ones) are told from the iterate, a step is shortened where it
would use up more than 80 % of a gap, and pseudo time leads to the steady state of a film that does not settle.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from exudyn_ehd.film.band_lu import solve_lu_transposed
from exudyn_ehd.film.compliant_newton import (
    Columns,
    Storage,
    answer_columns,
    compliant_coefficients,
    compliant_residual,
    compliant_sensitivities,
    longest_step,
    move_columns,
    newton_step,
    press_columns,
    set_storage,
    step_size,
    take_step,
    violation,
)
from exudyn_ehd.film.compliant_start import cold_start, pseudo_transient
from exudyn_ehd.film.elrod import LARGEST_DEFICIT, _lu_buffers
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.liner import LINER_INSTANT, failed_film
from exudyn_ehd.film.liner_newton import (
    CLIPPED,
    COMPLEMENTARY,
    EXACT_STEP,
    FULL,
    LEAST_DEFLECTION,
    ends_open,
    flow_rounding,
    select,
)
from exudyn_ehd.film.loads import scatter
from exudyn_ehd.film.reynolds import add_squeeze
from exudyn_ehd.film.solver import Closure, FilmSolver, Sensitivities
from exudyn_ehd.status import Status

MAX_NEWTON_STEPS = 60
ERROR_TOLERANCE = 1e-13
STEP_TOLERANCE = 1e-8


class ColumnContact(Protocol):
    """What presses on a column beside the film; as `exudyn_ehd.joint.effects.Contact`."""

    @property
    def presses_below(self) -> float: ...

    def settle(self, X: np.ndarray, compliance: float, G: np.ndarray) -> None: ...

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None: ...


class ColumnLimiter(Protocol):
    """The gap that the film sees between touching surfaces; as `exudyn_ehd.joint.effects.GapLimiter`."""

    @property
    def limits_below(self) -> float: ...

    def limit(
        self, H: np.ndarray, HF: np.ndarray, H_t: np.ndarray,
        slope_out: np.ndarray, bend_out: np.ndarray, face_slope_out: np.ndarray,
    ) -> None: ...  # fmt: skip


class CompliantFilmSolver(FilmSolver):
    """`FilmSolver` on an elastic liner with contact, mass-conserving cavitation, or both.

    The caller writes gaps and rate of the undeformed surfaces, ``solve`` leaves those that the film sees in ``H``, ``HF`` and ``H_t``.

    Parameters
    ----------
    grid, closure, squeeze
        As for `FilmSolver`.
    contact : ColumnContact, optional
        What presses on the liner beside the film.
    limiter : ColumnLimiter, optional
        Of the gap that the film sees; goes with the contact.

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
    ) -> None:  # fmt: skip
        super().__init__(grid, closure, squeeze=squeeze)
        self.coarse = None
        self.contact, self.limiter = contact, limiter
        self.beta, self.pressure_scale = 0.0, 1.0
        self.delta_old: np.ndarray | None = None
        shape = grid.shape
        self.rigid = np.ones((3, *shape))
        self.rigid_film, self.rigid_slope = np.ones(shape), np.ones(shape)
        self.true_gap, self.true_link = np.ones(shape), np.ones(shape)
        self.contact_pressure, self.contact_slope = np.zeros(shape), np.zeros(shape)
        self.contact_G, self.bend = np.zeros(shape), np.zeros(shape)
        self.scratch = [np.zeros(shape) for _ in range(4)]
        # whether contact_pressure, contact_G, bend and the slopes in columns are those of surfaces apart
        self.apart = True
        self.columns = Columns(*(np.ones(shape) for _ in Columns._fields))
        self.storage = Storage(*(np.zeros(shape) for _ in Storage._fields))
        self.residual = np.zeros(shape)
        self.full, self.trial_full = np.ones(shape, dtype=np.bool_), np.ones(shape, dtype=np.bool_)
        self.trial, self.trial_fill = np.zeros(shape), np.ones(shape)
        self.film_fill = self.system.fill if closure.conserves_mass else np.ones(shape)
        self.mass_old, self.deflection_old = np.zeros(shape), np.zeros(shape)
        self.inverse = self.mass_inverse = self.deflection_inverse = 0.0
        self.with_rate = False
        self.exact = False
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
        return float(min(self.true_gap.min(), self.true_link.min()))

    def stored_power(self) -> float:
        """Scaled power ``sum (p + p_c) dD/dt`` that goes into the liner, not the film; 0 for a steady deflection."""
        if self.deflection_inverse == 0.0:
            return 0.0
        pressure = self.system.pressure + self.contact_pressure / self.pressure_scale
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
        if self.contact is None and not ends_open(self.rigid, P, self.beta, g.fixed):
            self.work.warm = False
            return Status.NO_FILM, 0
        steps, ok = 0, False
        if self.work.warm:
            ok, steps = self.target(P)
        if not ok:
            ok, more = cold_start(self, P)
            steps += more
        if not ok:
            ok, more = pseudo_transient(self, P)
            steps += more
        self.work.warm = ok
        if not ok:
            if self.contact is not None:
                return Status.NOT_CONVERGED, steps
            return failed_film(self.kind, self.rigid[0], self.beta, cavity_pressure), steps
        self._finish(P)
        return Status.CONVERGED, steps

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
        return self.newton(P, self.film_fill, self.closure.conserves_mass, 0.0, self.nothing)

    def settle(self, P: np.ndarray) -> None:
        """Every column under the pressure P."""
        g, c, clips = self.grid, self.columns, self.kind == CLIPPED
        pc, contact, limiter = self.system.cavity_pressure, self.contact, self.limiter
        x = self.true_gap if contact is None else self.scratch[0]
        press_columns(self.rigid, P, g.fixed, pc, clips, self.beta, x)
        if contact is not None:
            if x.min() < contact.presses_below:
                contact.settle(x, self.beta / self.pressure_scale, self.true_gap)
                contact.pressure(self.true_gap, self.contact_pressure, self.contact_G)
                self.contact_G /= self.pressure_scale
                self.apart = False
            else:
                self.true_gap[:] = x
                self._part()
        move_columns(self.rigid, self.true_gap, self.deflection_old, self.inverse, c)
        self.true_link[:] = c.HF
        if limiter is not None and (not self.apart or min(x.min(), c.HF.min()) < limiter.limits_below):
            limiter.limit(c.H, c.HF, c.rate, c.rate_t, self.bend, c.link)
            self.apart = False
        answer_columns(
            self.rigid_film,
            self.rigid_slope,
            P,
            self.contact_G,
            self.bend,
            g.fixed,
            pc,
            clips,
            self.beta,
            self.inverse,
            c,
        )

    def _part(self) -> None:
        """Surfaces out of each other's reach: no contact, and the film sees the gap itself."""
        if not self.apart:
            for field in (self.contact_pressure, self.contact_G, self.bend):
                field[:] = 0.0
            self.columns.rate_t[:] = self.columns.link[:] = 1.0
            self.apart = True

    def _balance(
        self, P: np.ndarray, fill: np.ndarray, conserves: bool, extra: float, extra_old: np.ndarray
    ) -> tuple[float, float]:
        """Residual at P and fill; returns (norm of what does not hold, smallest film gap)."""
        g, c = self.grid, self.columns
        self.settle(P)
        set_storage(
            c, P, fill, self.area, self.mass_old, self.mass_inverse, self.with_rate, extra, extra_old, conserves, self.beta,
            self.storage,
        )  # fmt: skip
        compliant_residual(
            c, P, fill, self.storage.gain, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.residual
        )
        complementary = self.kind == COMPLEMENTARY and not conserves
        return violation(c, self.residual, P, g.fixed, self.system.cavity_pressure, complementary)

    def newton(
        self, P: np.ndarray, fill: np.ndarray, conserves: bool, extra: float, extra_old: np.ndarray
    ) -> tuple[bool, int]:
        """Newton from P and fill, in place; ``extra`` is the rate of pseudo time, towards ``extra_old``."""
        g, w, pc = self.grid, self.work, self.system.cavity_pressure
        kind = FULL if conserves else self.kind
        complementary = kind == COMPLEMENTARY
        if complementary:
            np.copyto(P, np.maximum(P, pc), where=~g.fixed)
        norm, smallest = self._balance(P, fill, conserves, extra, extra_old)
        if not smallest > 0.0:
            return False, 0
        if conserves:
            active = ~g.fixed
        else:
            active = w.active
            self.full[:] = True
            if w.warm:
                select(P, self.residual, g.fixed, pc, kind, active)
            else:
                np.logical_not(g.fixed, out=active)
        x, reference = w.unknowns, (pc if np.isfinite(pc) else 0.0)
        noise = flow_rounding(
            self.columns.H, self.columns.HF, self.rigid[2], self.vx, self.vz, g.width_x, g.width_z, g.link_x
        )
        for step in range(1, MAX_NEWTON_STEPS + 1):
            if not self._step(P, fill, active, x):
                return False, step
            if w.count == 0 or norm == 0.0:
                self.exact = True
                return True, step
            opening = smallest / self.beta
            error, square, peak = step_size(
                P, self.full, w.order, w.count, x, reference, kind == CLIPPED, LEAST_DEFLECTION * opening, opening
            )
            if not error < 1e300:
                return False, step
            share = 1.0 if kind == CLIPPED else longest_step(self.columns, self.full, w.order, w.count, x)
            before = norm
            for _ in range(12):
                changes = take_step(
                    P, fill, self.full, w.order, w.count, x, share, reference, complementary, conserves,
                    1e-12 * peak, self.trial, self.trial_fill, self.trial_full,
                )  # fmt: skip
                norm, smallest = self._balance(self.trial, self.trial_fill, conserves, extra, extra_old)
                if smallest > 0.0 and (norm < before or error <= STEP_TOLERANCE or (conserves and changes > 0)):
                    break
                share *= 0.5
            if not (smallest > 0.0 and norm < 1e300):
                return False, step
            P[:], self.full[:] = self.trial, self.trial_full
            if conserves:
                fill[:] = self.trial_fill
            else:
                changes = select(P, self.residual, g.fixed, pc, kind, active)
            if norm <= noise and not conserves:
                self.exact = self._step(P, fill, active, x)
                return self.exact, step
            if changes == 0 and share == 1.0 and (error <= ERROR_TOLERANCE or 10.0 * square <= ERROR_TOLERANCE):
                self.exact = error <= EXACT_STEP and extra == 0.0
                return not conserves or self._sound(fill), step
        return False, MAX_NEWTON_STEPS

    def _step(self, P: np.ndarray, fill: np.ndarray, active: np.ndarray, x: np.ndarray) -> bool:
        """Factor at P and fill, and solve for Newton's step x."""
        g, w = self.grid, self.work
        lower, upper = _lu_buffers(w)
        ok, w.count, w.width = newton_step(
            self.columns, P, fill, self.full, self.storage, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z,
            self.links, active, w.order, w.number, lower, upper, w.inv_diag, self.residual, x,
        )  # fmt: skip
        return ok

    def _sound(self, fill: np.ndarray) -> bool:
        """Whether no vertex holds less than nothing, but for rounding, which is cut off; sets the full vertices."""
        np.logical_and(self.full, ~self.grid.fixed, out=self.work.active)
        if not fill.min() > -LARGEST_DEFICIT:
            return False
        np.maximum(fill, 0.0, out=fill)
        return True

    def _finish(self, P: np.ndarray) -> None:
        """Deformed gaps, clipped pressure, and the coefficients that flows and balances are taken from."""
        g, s, c = self.grid, self.system, self.columns
        if self.kind == CLIPPED:
            np.copyto(s.pressure, np.where(g.fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~g.fixed, s.cavity_pressure <= P, out=self.work.active)
        self.H[:], self.HF[:], self.H_t[:] = c.H, c.HF, c.rate
        if self.closure.conserves_mass and self.deflection_inverse > 0.0:
            self.H_t += c.rate_t * (c.D - self.deflection_old) * self.deflection_inverse
        np.multiply(self.contact_G * self.pressure_scale, 1.0 + c.D_r, out=self.contact_slope)
        compliant_coefficients(
            c, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, s.kx, s.kz, s.fx, s.fz, s.b
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
            self._step(self.system.linear_pressure, self.film_fill, active, w.unknowns)
            self.exact = True
        lower, upper = _lu_buffers(w)
        solve_lu_transposed(lower, upper, w.inv_diag, w.count, w.width, rhs)
        fields = np.empty((rhs.shape[0], *g.shape))
        scatter(rhs, w.order, w.count, fields)
        return fields

    def sensitivities(self, lam: np.ndarray) -> Sensitivities:
        """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gaps and rate, and to the speeds."""
        g, c = self.grid, self.columns
        by_gap, by_rate = self.area * c.rate_r, self.area * c.rate_t
        if self.closure.conserves_mass:
            content = self.area * self.film_fill
            by_gap = content * c.rate_r if self.with_rate else self.nothing
            by_rate = content * c.rate_t if self.with_rate else self.nothing
            if self.mass_inverse > 0.0 and not self.instant:
                by_gap = by_gap + content * c.H_r * self.mass_inverse
        cell, face, rate = np.empty_like(lam), np.empty_like(lam), np.empty_like(lam)
        speed = np.empty((lam.shape[0], 2))
        compliant_sensitivities(
            lam, c, self.system.linear_pressure, self.film_fill, by_gap, by_rate, self.vx, self.vz, g.width_x, g.width_z,
            g.link_x, g.link_z, cell, face, rate, speed,
        )  # fmt: skip
        return Sensitivities(cell, face, rate if self.squeeze else None, speed)
