"""Film on an elastic liner, alone or with contact, mass-conserving cavitation,
laws of the oil, density or flow factors.

The liner is a layer of Winkler elements: each deflects in proportion to the
pressure on it, that of the film and of the contact,

    G = G_rigid + D,    D = beta (p + P_c(G)),

with the true gap G, whose contact pressure P_c falls with it. The relation has one root G(p), which rises with p:

    dG/dp = beta T,    dG/dG_rigid = T = 1 / (1 - beta P_c'(G))  in (0, 1],

so that the effective compliance beta T is bounded by the liner's, and nearly none where the contact is stiff against
it. However deep the undeformed surfaces overlap, the liner takes it up; at the ends and in grooves, whose pressure is
prescribed, by the contact alone. The film sees ``H = lim(G)``, the gap limiter of wall or rough surfaces, on links
``lim`` of the true gap with the mean deflection of both ends. Where the pressure falls steeply, the gap falls with it:
the conductance of a link is the mean of H^3 over the linear course of the deflection between its ends,

    g = H (H^2 + d^2),    d half the difference of E = lim(G) - lim(G_rigid) between the ends,

exact for a rigid gap that is constant along the link; flow factors, shear thinning and temperature multiply it as they
are at the mean gap.

In motion the liner's rate takes part in the squeeze, ``dH/dt = lim'(G) (rigid rate + (D - D_old) / dt)``, backward
Euler with the deflection at the start of the step from the history: a soft liner feeds and drains the film as it
deflects. Without a history (a prescribed position) the deflection is steady.

A viscosity or a density that follows the pressure. The film's unknown is the transformed pressure P of
`exudyn_ehd.film.lubricant.pressure_viscosity` or `exudyn_ehd.film.lubricant.density`, in which its pressure flow is
that of a constant viscosity and density; the elements feel the pressure p(P) itself. Since p grows exponentially with
P, a Newton step that raises the pressure goes where the tangent of p(P) leads the pressure, which is less far than its
P would take it; one that lowers it goes where P leads: in either case the shorter way, and to second order the same.
Thick oil lifts the liner: where a rigid bore has no film any more the gap opens. What would need an oil that is solid
ends with NO_PRESSURE. Couette flows and storage carry the density as in `exudyn_ehd.film.solvers.compressible`.

`ElrodAdams` has the balance of `exudyn_ehd.film.cavitation.elrod_adams` with the content ``rho fill H(P)``: at full
vertices the unknown pressure takes part in the storage through liner and density, at cavitated ones the unknown is the
fill and the element rests under the cavity's pressure. `SwiftStieber` always has a film as long as the cavity's
pressure leaves a gap: the balance is continuous and coercive on ``P >= Pc``, so that its complementarity problem has a
solution (Ph. Hartman, G. Stampacchia, Acta Math. 115 (1966) 271). `Gumbel` keeps its linear pressure below the
cavity's, but the liner deflects under the clipped one; no theorem says that such a film exists, and of extreme steady
ones some are not found. `FullSommerfeld` has none where surfaces part so fast that tension pulls the liner shut
(NO_FILM).

Newton's method (`exudyn_ehd.film.solvers.newton`) starts from the last film, else from a dry guess; should it fail,
pseudo time leads to the film (`exudyn_ehd.film.solvers.liner.continuation`). A line inside the cells is sought from the
film on the vertices, in the same two ways.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.rupture_line import add_line_columns, contract_line
from exudyn_ehd.film.cavitation.steady_oil import status_of
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.reynolds.links import FluxEffect, add_squeeze, link_flux, right_hand_side
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.film.solvers.liner.balance import LinerBalance
from exudyn_ehd.film.solvers.liner.continuation import cold_start, pseudo_transient
from exudyn_ehd.film.solvers.liner.elements import GapSlopes, Rates, ends_open
from exudyn_ehd.film.solvers.liner.gap_response import gap_columns
from exudyn_ehd.film.solvers.liner.newton import solve
from exudyn_ehd.film.solvers.liner.parts import LinerParts
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter, LandContact
from exudyn_ehd.status import Status

# Share of an oil's largest pressure at which a film that was not found is on its way beyond.
NEARLY_SOLID = 0.9


class NonlinearFilmSolver(FilmSolver):
    """`FilmSolver` on an elastic liner, alone or with contact, laws of the oil, flow factors; or between rigid surfaces
    (beta 0) where the oil thins.

    The caller writes gaps and rate of the undeformed surfaces, ``solve`` leaves
    those that the film sees in ``H``, ``HF`` and ``H_t``.

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
        Of a compressible film, whose flows are mass flows over the density at ambient pressure.
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
        self.line, s.line = e.line, None
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
        """Whether the film sees another gap than the surfaces have."""
        return self.elements.limiter is not None and not self.elements.apart

    @property
    def true_gap(self) -> np.ndarray:
        """Gap of the deformed surfaces (n, m); the solver's own array."""
        return self.elements.true_gap

    @property
    def true_link(self) -> np.ndarray:
        """The same on the links i -> i+1 (n, m)."""
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
        """Solve for the undeformed gaps now stored; parameters as for
        `FilmSolver.solve`, ``mass_old`` the old value of rho fill H."""
        s, g, e = self.system, self.grid, self.elements
        e.scale = self.pressure_scale
        self.vx, self.vz, s.cavity_pressure = vx, vz, cavity_pressure
        e.take_rigid(self.squeeze)
        if vx == vz == 0.0 and not e.rigid[2].any():
            # a film at rest starts from nothing, not from what is left of the last one
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
        ok, steps = solve(e) if self.work.warm else (False, 0)
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
            # the film between rough surfaces stays open where nothing holds them apart
            return Status.NO_FILM, steps
        return status_of(self.system, Status.CONVERGED), steps

    def _start(self, mass_old: np.ndarray | None, step: float) -> tuple[bool, int]:
        """Newton's method from no other film: (found, steps)."""
        return cold_start(self.elements)

    def _failure(self) -> Status:
        """Status of a film that was not found."""
        e = self.elements
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
        """Which rates take part, and over which time."""
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
        """Other prescribed vertices and cuts: the last factor is of no use."""
        self.elements.cut_links()

    def _finish(self) -> None:
        """Deformed gaps, clipped pressure, and the coefficients that flows and balances are taken from."""
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
        """Coefficients of the balances."""
        return super().terms if self.law is None else self.elements.terms

    def factor_solution(self) -> None:
        """Make the factor in the workspace that of the last solution."""
        e = self.elements
        if not e.exact:
            e.factor()
            e.exact = True

    def _clip(self) -> None:
        """Pressures and vertices in the film, of a closure that clips them or that never ruptures."""
        s, fixed, P = self.system, self.grid.fixed, self.system.linear_pressure
        if self.closure.clips:
            np.copyto(s.pressure, np.where(fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~fixed, s.cavity_pressure <= P, out=self.work.active)
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
        contract_line(lam, self.line_gradients(), cell, face, rate, speed)
        return Sensitivities(cell, face, rate, speed)
