"""Film on an elastic liner, alone or with contact, mass-conserving cavitation, oil laws, density or flow factors.

The liner is a layer of Winkler elements. Each deflects in proportion to the pressure of the film and of the contact,

    G = G_rigid + D,    D = beta (p + P_c(G)).

The contact pressure P_c falls with the true gap G. So the relation has one root G(p), which rises with p:

    dG/dp = beta T,    dG/dG_rigid = T = 1 / (1 - beta P_c'(G))  in (0, 1].

The effective compliance beta T is at most that of the liner, and nearly 0 where the contact is stiff against it. The
liner takes up any overlap of the undeformed surfaces; at the ends and in grooves, whose pressure is prescribed, it does
so by the contact alone. The film sees ``H = lim(G)``, with the gap limiter of a wall or of rough surfaces; on links
``lim`` is taken of the true gap with the mean deflection of both ends. Where the pressure falls steeply, so does the
gap. The conductance of a link is therefore the mean of H^3 over the linear course of the deflection between its ends,

    g = H (H^2 + d^2),    d half the difference of E = lim(G) - lim(G_rigid) between the ends,

exact for a rigid gap that is constant along the link. Flow factors, shear thinning and temperature multiply it by their
values at the mean gap.

In motion the squeeze contains the liner's rate, ``dH/dt = lim'(G) (rigid rate + (D - D_old) / dt)``. This is backward
Euler with the deflection at the start of the step from the history: a soft liner feeds and drains the film as it
deflects. Without a history (a prescribed position) the deflection is steady.

A viscosity or a density may follow the pressure. The film's unknown is then the transformed pressure P of
`exudyn_ehd.film.lubricant.pressure_viscosity` or `exudyn_ehd.film.lubricant.density`, in which the pressure flow is
that of a constant viscosity and density. The elements have the pressure p(P) itself, which grows exponentially with P.
A Newton step that raises the pressure goes to the pressure that the tangent of p(P) predicts, which is less than its P
would give; one that lowers it goes to its P. Either is the shorter way, and both agree to second order. Thick oil lifts
the liner: the gap opens where a rigid bore has no film any more. A film that would need solid oil ends with
NO_PRESSURE. Couette flows and storage contain the density as in `exudyn_ehd.film.solvers.compressible`.

`ElrodAdams` has the balance of `exudyn_ehd.film.cavitation.elrod_adams` with the content ``rho fill H(P)``. At full
vertices the storage depends on the unknown pressure through liner and density; at cavitated ones the unknown is the
fill, and the element has the cavity pressure. `SwiftStieber` always has a film as long as the cavity pressure leaves a
gap: the balance is continuous and coercive on ``P >= Pc``, so that its complementarity problem has a solution (Ph.
Hartman, G. Stampacchia, Acta Math. 115 (1966) 271). `Gumbel` keeps its linear pressure below the cavity pressure, but
the liner deflects under the clipped one. No theorem says that such a film exists, and some extreme steady ones are not
found. `FullSommerfeld` has none where surfaces part so fast that tension pulls the liner shut (NO_FILM).

Newton's method (`exudyn_ehd.film.solvers.liner.steps`) starts from the last film, else from a dry guess. If it fails,
pseudo-transient continuation follows (`exudyn_ehd.film.solvers.liner.continuation`). The rupture line inside the cells
is that of `exudyn_ehd.film.solvers.liner.line`.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.linear_film import mean_in_cells
from exudyn_ehd.film.cavitation.rupture_line import add_line_columns
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row, status_of
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.reynolds.links import Coefficients, FluxEffect, add_squeeze, link_flux, right_hand_side
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.balance import LinerBalance
from exudyn_ehd.film.solvers.liner.continuation import cold_start, pseudo_transient
from exudyn_ehd.film.solvers.liner.elements import GapSlopes, Rates, ends_open
from exudyn_ehd.film.solvers.liner.gap_response import gap_columns
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter, LandContact
from exudyn_ehd.status import Status

# Share of an oil's largest pressure above which a film that is not found gets NO_PRESSURE.
NEARLY_SOLID = 0.9


class NonlinearFilmSolver(FilmSolver):
    """`FilmSolver` on an elastic liner, alone or with contact, oil laws and flow factors; or between rigid surfaces
    (beta 0) with an oil that thins by shear.

    The caller writes gaps and rate of the undeformed surfaces; ``solve`` replaces ``H``, ``HF`` and ``H_t`` by those
    that the film sees.

    Parameters
    ----------
    grid, closure, squeeze, flux_effects
        As for `FilmSolver`.
    contact, limiter, oil, density
        As for `LinerParts`.

    Attributes
    ----------
    beta, pressure_scale : float
        Scaled compliance (deflection over clearance per scaled pressure), and the scale of pressures, Pa.
    delta_old : (n, m) array or None
        Scaled deflection at the start of the step, set by the caller before ``solve``; None: steady.
    law : CompressibleLaw or None
        Law of a compressible film, whose flows are mass flows over the density at ambient pressure.
    """

    plain_links = False

    def __init__(
        self,
        grid: FilmGrid,
        closure: Closure,
        *,
        squeeze: bool = True,
        contact: Contact | None = None,
        limiter: GapLimiter | None = None,
        flux_effects: tuple[FluxEffect, ...] = (),
        oil: PressureLaw | None = None,
        density: CompressibleLaw | None = None,
    ) -> None:
        super().__init__(grid, closure, squeeze=squeeze, flux_effects=flux_effects)
        self.coarse = None
        self.law, self.symmetric = density, False
        self.elements = e = LinerBalance(self, self._set_links, LinerParts(contact, limiter, oil, density))
        # the balance's own arrays, which its kernels take as one
        self.H, self.HF, self.H_t = e.gaps.H, e.gaps.HF, e.gaps.rate
        self.system.H, self.system.H_t = self.H, self.H_t
        self.rho, self.rho_P = self.ones if e.rho is None else e.rho, e.rho_P
        s = self.system
        s.kx, s.kz, s.fx, s.fz = e.terms[:4]
        self.line, s.line = (e.line if isinstance(e.line, FilmLine) else None), None
        if flux_effects:
            self.flux = link_flux(self.HF, flux_effects)
            e.links = self.flux
        self.delta_old: np.ndarray | None = None
        self.contact_slope, self.deflection_inverse = np.zeros(grid.shape), 0.0
        # the part of a vertex that the contact presses on
        self.touching = contact.land if isinstance(contact, LandContact) else 1.0

    @property
    def beta(self) -> float:
        return self.elements.beta

    @beta.setter
    def beta(self, value: float) -> None:
        self.elements.beta = value

    @property
    def deflection(self) -> np.ndarray:
        """Scaled deflection of the last solution (n, m)."""
        return self.elements.gaps.D.copy()

    @property
    def gap_slopes(self) -> GapSlopes:
        """Derivatives of the gaps that the film sees, for the last solution."""
        return self.elements.gap_slopes

    @property
    def contact_pressure(self) -> np.ndarray:
        """Contact pressure, Pa (n, m); the solver's own array."""
        return self.elements.contact_pressure

    @property
    def limited(self) -> bool:
        """Return whether the film's gap differs from that of the surfaces."""
        return self.elements.limiter is not None and not self.elements.apart

    @property
    def true_gap(self) -> np.ndarray:
        """Gap of the deformed surfaces (n, m); the solver's own array."""
        return self.elements.true_gap

    @property
    def true_link(self) -> np.ndarray:
        """Gap of the deformed surfaces on the links i -> i+1 (n, m)."""
        e = self.elements
        return e.rigid[1] + 0.5 * (e.gaps.D + np.roll(e.gaps.D, -1, axis=0))

    @property
    def deflection_by_pressure(self) -> np.ndarray:
        """dD/dP at the unknown pressures (n, m) of the last solution; zero elsewhere."""
        return np.where(self.work.active, self.elements.gap_slopes.D_P, 0.0)

    @property
    def contact_by_pressure(self) -> np.ndarray:
        """d(contact pressure)/dP, Pa, at the unknown pressures (n, m) of the last solution; zero elsewhere."""
        e = self.elements
        return np.where(self.work.active, self.touching * e.contact_G * e.scale * e.gap_slopes.D_P, 0.0)

    def smallest_gap(self) -> float:
        """Smallest scaled gap of the deformed surfaces."""
        return float(min(self.true_gap.min(), self.true_link.min()))

    def stored_power(self) -> float:
        """Scaled power ``sum (p + p_c) dD/dt`` that goes into the liner, not the film; 0 for a steady deflection."""
        if self.deflection_inverse == 0.0:
            return 0.0
        e = self.elements
        return float(np.sum((e.load.p + e.contact_pressure / e.scale) * self.deflection_rate * self.grid.weight))

    @property
    def deflection_rate(self) -> np.ndarray:
        """dD/dt (n, m)."""
        return (self.elements.gaps.D - self.elements.deflection_old) * self.deflection_inverse

    @property
    def true_rate(self) -> np.ndarray:
        """Rate of `true_gap` (n, m)."""
        return self.elements.rigid[2] + self.deflection_rate

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the undeformed gaps now stored; parameters as for `FilmSolver.solve`, ``mass_old`` is the old rho
        fill H."""
        s, g, e = self.system, self.grid, self.elements
        e.scale = self.pressure_scale
        self.vx, self.vz, s.cavity_pressure, self._fills = vx, vz, cavity_pressure, None
        e.take_rigid(self.squeeze)
        if vx == vz == 0.0 and not e.rigid[2].any():
            # a film at rest makes a cold start, not one from the remains of the last film
            self.work.warm = False
        self._set_times(mass_old, step)
        P = s.linear_pressure
        if self.closure.clips:
            P[g.fixed] = s.pressure[g.fixed]
        if not e.set_known_loads():
            return Status.NO_PRESSURE, 0
        e.see_cavity()
        if e.contact is None and not ends_open(e.rigid, P if e.oil is None else e.load.p, e.beta, g.fixed):
            self.work.warm = False
            return Status.NO_FILM, 0
        ok, steps = e.solve() if self.work.warm else (False, 0)
        if not ok:
            ok, more = self._start(mass_old, step)
            steps += more
        if not ok:
            ok, more = pseudo_transient(e)
            steps += more
        self.work.warm = ok
        if not ok:
            return self._failure(), steps
        self._finish()
        if e.limiter is not None and e.contact is None and not e.true_gap.min() > 0.0:
            # the limiter keeps the film open although nothing holds the surfaces apart
            return Status.NO_FILM, steps
        return status_of(self.system, Status.CONVERGED), steps

    def _start(self, mass_old: np.ndarray | None, step: float) -> tuple[bool, int]:
        """Cold start of Newton's method; returns (found, steps)."""
        return cold_start(self.elements)

    def _failure(self) -> Status:
        """Status of a film that was not found."""
        e, s = self.elements, self.system
        # in pseudo time it ended with the last film that it found
        unfed = s.turns > 0.0 and has_unfed_row(s.linear_pressure, self.H, s.fixed, s.turns, s.cavity_pressure)
        if unfed and not e.rigid[2].any():
            return Status.NO_OIL
        if e.oil is not None and float(e.load.p.max()) * e.scale > NEARLY_SOLID * e.oil.largest_pressure:
            return Status.NO_PRESSURE
        if e.contact is not None or e.beta == 0.0:
            return Status.NOT_CONVERGED
        # tension may pull the liner shut: without cavitation, or by the cavity's own pressure
        shut = not self.ruptures or float(e.rigid[0].min()) + e.beta * e.cavity_load <= 0.0
        return Status.NO_FILM if shut else Status.NOT_CONVERGED

    def _gap_before(self, step: float) -> tuple[np.ndarray, np.ndarray]:
        before, slope = super()._gap_before(step)
        if self.delta_old is not None:
            before += self.delta_old
        limiter = self.elements.limiter
        if limiter is not None:
            slope, *others = np.ones((5, *self.grid.shape))
            limiter.limit(before, others[0], others[1], slope, others[2], others[3])
        return before, slope

    def _set_times(self, mass_old: np.ndarray | None, step: float) -> None:
        """Set the rates of the storage, and the state at the start of the step."""
        e = self.elements
        inverse = 1.0 / step if step > 0.0 else self._inverse_instant()
        moving = self.delta_old is not None and self.squeeze
        self.deflection_inverse = inverse if moving else 0.0
        if self.delta_old is not None:
            e.deflection_old[:] = self.delta_old
        self.instant = False
        if not self.closure.conserves_mass:
            e.rates = Rates(0.0, self.deflection_inverse, 0.0, 1.0)
            return
        # the liner's own rate is part of the mass rho fill H
        mass = 0.0 if mass_old is None else inverse
        self.instant = mass_old is not None and step <= 0.0
        if mass_old is not None:
            e.mass_old[:] = mass_old
        e.rates = Rates(mass, 0.0, 0.0, float(mass_old is None or self.instant))
        self.system.inverse_step = mass
        self.system.see_motion(mass_old is None, e.rigid[2], self.vx, self.vz)
        self.work.warm = self.work.warm and not self.system.closes

    def refresh_fixed(self) -> None:
        """Take over changed prescribed vertices and cuts, which invalidates the last factor."""
        self.elements.cut_links()

    def _finish(self) -> None:
        """Set the fields of a solution: rupture line, clipped pressure, gap derivatives, rates, right-hand side."""
        g, s, e = self.grid, self.system, self.elements
        e.settle_line()
        self._clip()
        e.gradients()
        if self.closure.conserves_mass and e.rates.mass > 0.0:
            s.mass_old[:] = e.mass_old
            if self.instant:
                s.mass_old -= self.rho * s.fill * self.H_t / e.rates.mass
        if self.closure.conserves_mass and self.deflection_inverse > 0.0:
            self.H_t += e.gap_slopes.rate_t * (e.gaps.D - e.deflection_old) * self.deflection_inverse
        if e.contact is not None:
            np.multiply(self.touching * e.contact_G * e.scale, 1.0 + e.gap_slopes.D_r, out=self.contact_slope)
        right_hand_side(s.fx, s.fz, s.b)
        if self.squeeze:
            add_squeeze(self.H_t, g.width_x, g.width_z, s.b)

    @property
    def terms(self) -> FilmTerms:
        """Coefficients of the mass balances."""
        return super().terms if self.law is None else self.elements.terms

    def factor_solution(self) -> None:
        """Make the factor in the workspace that of the last solution."""
        e = self.elements
        if not e.exact:
            e.factor()
            e.exact = True

    def _clip(self) -> None:
        """Set pressures and active set of a closure that clips, or the active set of one that never ruptures."""
        s, fixed, P = self.system, self.grid.fixed, self.system.linear_pressure
        if self.closure.clips:
            np.copyto(s.pressure, np.where(fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~fixed, s.cavity_pressure <= P, out=self.work.active)
            if self.closure.line_in_cells:
                mean_in_cells(P, fixed, s.linked, s.cavity_pressure, self.work.active, s.pressure)
        elif not self.ruptures:
            np.logical_not(fixed, out=self.work.active)

    def motion_columns(self, at: tuple[np.ndarray, ...], out: np.ndarray) -> None:
        """Derivatives (10, count) of the balances at the unknowns to the motion of a rigid journal, as for
        `exudyn_ehd.film.sensitivity.rigid.motion_columns`."""
        w, e = self.work, self.elements
        by_gap, by_rate = e.storage_gradients()
        by_rate = by_rate if self.squeeze else self.nothing
        gap_columns(w.order, w.count, e.by, e.flows_by_speed(), e.slope_fields, by_rate, by_gap, at, out)
        line = self.line_gradients()
        if line is not None:
            add_line_columns(tuple(line), at, out)

    def sensitivities(self, lam: np.ndarray) -> Sensitivities:
        """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gaps and rate, and to the speeds."""
        e = self.elements
        a, by, by_v = e.gap_slopes, e.by.reshape(4, *self.grid.shape), e.flows_by_speed()
        by_gap, _ = e.storage_gradients()
        along, across = np.roll(lam, -1, axis=1) - lam, np.zeros_like(lam)
        across[:, :, :-1] = lam[:, :, 1:] - lam[:, :, :-1]
        face, bend = along * (by[0] * a.link), along * by[1]
        own, other = 0.5 * (face * a.D_r - bend * a.E_r), 0.5 * np.roll(face, 1, axis=1) * a.D_r
        other += 0.5 * np.roll(bend, 1, axis=1) * a.E_r
        up, slant = across * by[2], across * by[3]
        own += 0.5 * (up * a.H_r - slant * a.E_r)
        other[:, :, 1:] += 0.5 * (up[:, :, :-1] * a.H_r[:, 1:] + slant[:, :, :-1] * a.E_r[:, 1:])
        turning = np.sum(along * by_v[0] + across * by_v[1], axis=(1, 2))
        speed = np.stack((turning, np.sum(across * by_v[2], axis=(1, 2))), axis=1)
        cell, rate = own + other - lam * by_gap, e.deflection_weights(lam)
        return self.with_line(lam, cell, face, rate, speed)

    def fill_weights(self) -> tuple[Coefficients, np.ndarray]:
        """Return `FilmSolver.fill_weights`, with the density."""
        film, e = self.system.coefficients, self.elements
        store = e.terms.area * e.terms.grow
        if e.rho is None:
            return film, store
        fx, fz = (f * 0.5 * (e.rho + np.roll(e.rho, -1, axis)) for axis, f in enumerate((film.fx, film.fz)))
        return film._replace(fx=fx, fz=fz), store * e.rho
