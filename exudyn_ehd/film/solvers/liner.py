"""Film on an elastic liner, alone or with contact, mass-conserving cavitation, oil laws, density or flow factors.

The liner is a layer of Winkler elements. Each deflects in proportion to the pressure of the film and of the contact,

    G = G_rigid + D,    D = beta (p + P_c(G)).

The contact pressure P_c falls with the true gap G. So the relation has one root G(p), which rises with p:

    dG/dp = beta T,    dG/dG_rigid = T = 1 / (1 - beta P_c'(G))  in (0, 1].

The effective compliance beta T is at most that of the liner, and nearly 0 where the contact is much stiffer than the
liner. The liner deflects by any overlap of the undeformed surfaces; at the ends and in grooves, whose pressure is
prescribed, only under the contact pressure. The gap of the film is ``H = lim(G)``, with the gap limiter of a wall or of
rough surfaces. On links ``lim`` is applied to the true gap with the mean deflection of both ends. Where the pressure
falls steeply, so does the gap. The conductance of a link is therefore the mean of H^3 for a deflection that is linear
between its ends,

    g = H (H^2 + d^2),    d half the difference of E = lim(G) - lim(G_rigid) between the ends,

exact for a rigid gap that is constant along the link. Flow factors, shear thinning and temperature multiply it by their
values at the mean gap.

In motion the squeeze contains the liner's rate, ``dH/dt = lim'(G) (rigid rate + (D - D_old) / dt)``. This is backward
Euler with the deflection at the start of the step from the history: a soft liner feeds and drains the film as it
deflects. Without a history (a prescribed position) the deflection is steady.

A viscosity or a density may follow the pressure. The film's unknown is then the transformed pressure P of
`exudyn_ehd.film.lubricant.pressure_viscosity` or `exudyn_ehd.film.lubricant.density`, in which the pressure flow is
that of a constant viscosity and density. The elements have the pressure p(P) itself, which grows exponentially with P.
A Newton step that raises the pressure is reduced to the pressure that the tangent of p(P) predicts. A step that lowers
it is taken in P. Each is the shorter one of both, and they agree to second order. Thick oil deflects the liner, so that
a gap remains where a rigid bore has no film any more. A film that would need solid oil ends with NO_PRESSURE. Couette
flows and storage contain the density as in `exudyn_ehd.film.solvers.film`.

`ElrodAdams` has the balance of `exudyn_ehd.film.cavitation.closures` with the content ``rho fill H(P)``. At full
vertices the storage depends on the unknown pressure through liner and density; at cavitated ones the unknown is the
fill, and the element has the cavity pressure. `SwiftStieber` always has a film as long as the cavity pressure leaves a
gap: the balance is continuous and coercive on ``P >= Pc``, so that its complementarity problem has a solution (Ph.
Hartman, G. Stampacchia, Acta Math. 115 (1966) 271). `Gumbel` keeps its linear pressure below the cavity pressure, but
the liner deflects under the clipped one. No theorem says that such a film exists, and some extreme steady ones are not
found. `FullSommerfeld` has none where surfaces part so fast that tension pulls the liner shut (NO_FILM).

Newton's method (`exudyn_ehd.film.solvers.newton`) starts from the last film, else from a dry guess. If it fails,
pseudo-transient continuation follows (`exudyn_ehd.film.solvers.sets`): an additional storage at every vertex slows the
film down and is reduced step by step. The rupture line inside the cells is that of
`exudyn_ehd.film.cavitation.rupture_line`.

With beta = 0, the same code solves the film of a shear-thinning oil between rigid surfaces, whose conductances follow
the pressure.
"""

from __future__ import annotations

import copy

import numpy as np

from exudyn_ehd.film.cavitation.closures import has_unfed_row
from exudyn_ehd.film.cavitation.linear_film import clip_pressure, mean_in_cells
from exudyn_ehd.film.cavitation.rupture_line import AtLine, GapChain, RuptureLine
from exudyn_ehd.film.cavitation.states import OIL, RUPTURE
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.solvers.film import FilmArrays
from exudyn_ehd.film.solvers.matrix import factor_film
from exudyn_ehd.film.solvers.newton import GOES_ON, begin, course_from, end_of, offset_pressures, proceed, solve_film
from exudyn_ehd.film.solvers.sets import pseudo_time
from exudyn_ehd.film.solvers.winkler import Liner, WinklerElements, find_slopes, liner_residual
from exudyn_ehd.status import SMALL, Status


class LinerFilm(WinklerElements):
    """Film on Winkler elements: gaps, links, mass balances and derivatives for given unknowns, and Newton's method.

    Parameters
    ----------
    film : FilmArrays
        Arrays of the film; its gaps become those of the deformed surfaces.
    liner : Liner

    Attributes
    ----------
    beta, scale : float
        Scaled compliance (deflection over clearance per scaled pressure), and the scale of pressures, Pa.
    delta_old : (n, m) array or None
        Scaled deflection at the start of the step, set by the caller before a film is solved; None: steady.
    true_gap, contact_pressure, contact_slope : (n, m) arrays
        Gap of the deformed surfaces, contact pressure, Pa, and its derivative to the undeformed gap.
    gap_slopes : GapSlopes
        Derivatives of the film's gaps, for the last solution.
    at_line : AtLine
        Film at the cavity pressure.
    """

    def __init__(self, film: FilmArrays, liner: Liner) -> None:
        super().__init__(film, liner)
        s, w, shape = film.system, film.work, film.grid.shape
        # flux effect whose conductances follow the pressure
        self.thin = next((e for e in film.flux_effects if isinstance(e, ShearThinning)), None)
        if self.thin is not None:
            self.thin.place(film.grid, film.flow_x)
        # whether the liner's deflection is all that follows the pressure
        self.plain = self.contact is None and self.limiter is None and self.oil is None and not film.flux_effects
        self.film_fields = s.film
        self.by, self.by_speed = np.zeros((4, w.order.size)), np.zeros((3, w.order.size))
        self.fill = s.fill if s.kind == OIL else np.ones(shape)
        # the film at the pressure of the rupture line inside the cells
        self.at_line = AtLine((film.H, film.HF), None, None)
        # arguments of the kernels of `exudyn_ehd.film.solvers.newton`
        self.residual, self.places = w.residual, (self.P, w.residual, w.unknowns, w.before)
        self.take_kind(s.kind)

    def take_kind(self, kind: int) -> None:
        """Set the kind of the films to be solved, see `exudyn_ehd.film.cavitation.states`."""
        self.kind, self.film.work.ready = kind, False
        fill, w = self.fill if kind == OIL else None, self.film.work
        self.state, self.oil_fields = (w.u, w.above, fill), (fill, *self.densities)

    def forget_gradients(self) -> None:
        """Set the viscosity of a shear-thinning oil to that of pure sliding, without pressure gradients."""
        if self.thin is not None:
            self.thin.see(self.film.nothing)

    def _set_links(self, P: np.ndarray) -> None:
        """Set conductances and Couette fluxes for the present gaps, and for the gradients of P (n, m)."""
        f = self.film
        if self.thin is not None:
            self.thin.see(P)
        f.set_links()

    def hold_back(self) -> None:
        """Apply `FilmArrays.hold_back` with the deflection at the start of the step, so that the result does not depend
        on the initial guess of Newton's method."""
        f, D = self.film, self.film.nothing if self.delta_old is None else self.delta_old
        np.maximum(self.rigid[0] + D, SMALL, out=f.H)
        np.maximum(self.rigid[1] + 0.5 * (D + np.roll(D, -1, 0)), SMALL, out=f.HF)
        self._set_links(f.nothing)
        f.hold_back()

    def balance(self) -> tuple[float, float]:
        """Update gaps, links and residual; returns (norm of the residual, smallest film gap), (inf, -1) if the oil's
        law has no such pressure."""
        f, (fill, rho, _) = self.film, self.oil_fields
        if not self.update_elements(self.P):
            return np.inf, -1.0
        if not self.smallest > 0.0:
            return np.inf, self.smallest
        self._set_links(self.P)
        fields = self.load_fields, self.gap_fields, f.system.fields, f.grid.fixed, self.known
        rates, pc = tuple(self.rates), f.system.cavity_pressure
        chooses = self.kind == RUPTURE
        norm = liner_residual(self.P, fill, rho, *fields, rates, self.beta, pc, chooses, f.system.curve, self.residual)
        return norm, self.smallest

    def set_line_terms(self) -> None:
        """Set the rupture line's coefficients for the film to be solved. Afterwards gaps and links have their values at
        the cavity pressure."""
        f, rates = self.film, self.rates
        if f.oil_line is None and f.line is None:
            return
        s, g = f.system, f.grid
        self.rates = rates._replace(liner=0.0)
        self.update_elements(np.where(g.fixed, self.P, s.cavity_pressure))
        self.rates = rates
        # no line lies where surfaces at the cavity pressure touch, up to this fraction of the clearance
        shut, gaps = f.HF < SMALL, self.gap_fields[:2]
        np.maximum(gaps, SMALL, out=gaps)
        self._set_links(f.nothing)
        flux, chain = copy.deepcopy(f.flux), None
        if self.thin is not None and flux is not None:
            s.kx *= self.thin.slide(flux, f.vx)
        density = 1.0 if f.law is None else float(f.rho[~g.fixed].min(initial=np.inf))
        gaps = gaps.copy()
        if self.takes_up_squeeze:
            f.H_t[:] = 0.0
        f.set_right_hand_side()
        s.kx[shut] = 0.0
        line = f.line or f.oil_line
        assert line is not None
        line.lift_by_speed = 0.5 * self.beta * np.sign(f.vx) * g.width_z
        if isinstance(line, RuptureLine):
            line.liner = self.beta, gaps[1]
        line.take(s.terms, s.b, density, f.vx)
        if self.limiter is not None or self.contact is not None:
            a, follow = self.gap_slopes, 1.0 / (1.0 - self.beta * self.contact_G) - 1.0
            chain = GapChain(a.rate_t.copy(), self.bend.copy(), a.link.copy(), follow)
        self.at_line = AtLine((gaps[0], gaps[1]), flux, chain)

    def fill_up(self, most: np.ndarray) -> None:
        """Remove the cavity: every vertex becomes full, those with a curve with a pressure of at least its value at
        u = 1 or ``most``, whichever is less."""
        curve = self.film.system.rupture.whole.reshape(self.P.shape)
        np.logical_not(self.film.grid.fixed, out=self.film.work.active)
        self.fill[:] = 1.0
        np.maximum(self.P, np.minimum(self.film.system.base + curve, most), out=self.P, where=curve > 0.0)

    def solve(self) -> tuple[bool, int]:
        """Solve by Newton's method from the present pressures and active set, in place; returns (found, steps)."""
        f, w, s = self.film, self.film.work, self.film.system
        # the film without pressure gradients (`forget_gradients`) has set other terms
        s.terms.late[:], s.terms.known[:] = s.late, 0.0
        size = w.size
        w.ready = w.exact = False
        rest = w.active, self.state, self.oil_fields, None, self.film_fields, self._seen
        if self.plain and self.kind != OIL:
            numbers = s.cavity_pressure, f.vx, f.vz, self.beta
            plain = numbers, f.closure.clips, self.rigid, self.true_gap, self.deflection_old, self.known
            return w.take_end(*solve_film(self.kind, s.base, True, size, *rest, w.matrix, self.places, plain))
        begin(self.film_fields, self.kind, s.base, True, w.active, self.state, self.P)
        outcome, course = GOES_ON, course_from(size)
        while outcome == GOES_ON:
            norm, gap = self.balance()
            response = self._response, w.matrix, self.places
            outcome, course = proceed(norm, gap, course, self.kind, s.base, *rest, *response)
        offset_pressures(f.grid.fixed, w.above, s.base, self.P)
        return w.take_end(*end_of(outcome, course))

    @property
    def _seen(self) -> tuple[tuple[object, ...], tuple[object, ...]]:
        """Arguments ``elements`` and ``links`` of `find_slopes`, which are ``feedback`` of Newton's method."""
        f = self.film
        elements = (
            self.slope_fields, self.gap_fields, self.load_fields, tuple(self.rates), self.beta, self.by,
            self.rigid_slope, self.contact_G, self.bend,
        )  # fmt: skip
        return elements, (None if f.flux is None else f.flux.laws, f.metric, f.vx, f.vz, self.by_speed)

    @property
    def _response(self) -> tuple[np.ndarray, ...] | None:
        """`ShearThinning.response` for Newton's matrix; None if no conductance follows the pressure."""
        return None if self.thin is None else self.thin.response()

    def gradients(self) -> None:
        """Update ``gap_slopes``, ``by`` and ``by_speed``: derivatives of gaps and links' flows at the present state."""
        fill, rho, _ = self.oil_fields
        find_slopes(self.P, fill, rho, self.film_fields, *self._seen)

    def follows(self) -> np.ndarray:
        """Derivatives (4, n m) of deflection, E, gap and gap on links, see `exudyn_ehd.film.reynolds.gap.link_rows`."""
        follows: np.ndarray = self.slope_fields[2:6].reshape(4, -1)
        return follows

    def factor_solution(self) -> None:
        """Refactor Newton's matrix at the last solution."""
        w, fields = self.film.work, (self.kind, self.P, self.oil_fields, self.film_fields, self._seen)
        _, w.count, w.width = factor_film(*fields, self._response, w.matrix, w.active, (False, w.count, w.width))

    def finish(self) -> None:
        """Set the fields of a solution: rupture line, clipped pressure, gap derivatives, rates, right-hand side."""
        f, s, w = self.film, self.film.system, self.film.work
        g, pc = f.grid, s.cavity_pressure
        if f.closure.clips:
            clip_pressure(self.P, g.fixed, pc, s.pressure, w.active)
            if s.continued is not None:
                mean_in_cells(self.P, g.fixed, s.linked, pc, w.active, s.pressure)
        elif not f.ruptures:
            np.logical_not(g.fixed, out=w.active)
        self.gradients()
        if s.kind == OIL and self.deflection_inverse > 0.0:
            f.H_t += self.gap_slopes.rate_t * self.deflection_rate
        if self.contact is not None:
            pressed = self.touching * self.contact_G * self.scale
            np.multiply(pressed, 1.0 + self.gap_slopes.D_r, out=self.contact_slope)
        f.set_right_hand_side()


# Limits of the dry guess with a pressure law, of which the larger one holds: pressure that opens the gap to `OPEN`
# clearances, and the fraction `MODERATE` of the oil's largest pressure. Larger values risk solid oil, smaller ones a
# shut gap.
OPEN, MODERATE = 0.01, 0.1
# Gap over the clearance to which a dry guess opens the liner. Larger values start from a thicker film, smaller ones
# from a nearly shut gap.
THIN = 0.1
# Fraction of an oil's largest pressure above which a film that is not solved has the status NO_PRESSURE, instead of
# NOT_CONVERGED.
NEARLY_SOLID = 0.9


def cold_start(film: LinerFilm) -> tuple[bool, int]:
    """Solve by Newton's method from a dry guess; returns (found, steps). A mass-conserving film is first solved without
    mass conservation."""
    film.film.work.warm, first = False, 0
    _dry_guess(film)
    if film.kind == OIL:
        film.take_kind(RUPTURE)
        ok, first = film.solve()
        film.take_kind(OIL)
        if not ok:
            return False, first
    ok, steps = film.solve()
    return ok, first + steps


def _dry_guess(film: LinerFilm) -> None:
    """Set a full film as the initial guess.

    Without a contact, its pressure opens gaps below `THIN` to `THIN`, within the limits of `_transformed`. In a film at
    rest it is at most the largest prescribed pressure. The pressures of curves open the liner by at most `THIN`.
    """
    H0 = film.rigid[0]
    # in a nearly shut gap, pressures of curves would open it by many clearances
    guess, most = np.zeros(H0.shape), np.full(H0.shape, THIN / max(film.beta, 1e-300))
    if film.contact is None and H0.min() < THIN and film.beta > 0.0:
        guess = np.maximum((THIN - H0) / film.beta, 0.0)
    if film.oil is not None and film.beta > 0.0:
        guess, most = _transformed(film, film.oil, guess), _transformed(film, film.oil, most)
    fixed = film.film.grid.fixed
    still = film.film.vx == film.film.vz == film.rates.liner == film.rates.mass == 0.0
    if still and not film.rigid[2].any():
        # the pressure lies between the prescribed ones
        guess = np.minimum(guess, film.P[fixed].max(initial=0.0))
    lowest = film.film.system.cavity_pressure if film.film.ruptures else 0.0
    film.P[~fixed] = np.maximum(guess, lowest)[~fixed]
    film.fill_up(most)


def _transformed(film: LinerFilm, oil: PressureTransform, guess: np.ndarray) -> np.ndarray:
    """Return the unknowns of guessed pressures (n, m).

    Pressures are limited to that which opens the gap to `OPEN`, or to `MODERATE` times the oil's largest pressure if
    this is higher.
    """
    touching = np.maximum((OPEN - film.rigid[0]) / film.beta, 0.0)
    p = np.minimum(guess, np.maximum(touching, MODERATE * oil.largest_pressure / film.scale))
    return oil.transform(np.minimum(p * film.scale, oil.largest_pressure)) / film.scale


def pseudo_transient(film: LinerFilm) -> tuple[bool, int]:
    """Solve by pseudo-transient continuation from a dry guess; returns (found, Newton steps).

    The implicit steps in pseudo time grow; the last solution has no additional storage.
    """
    f, work, rates = film.film, film.film.work, film.rates
    work.warm = False
    _dry_guess(film)
    rate = abs(f.vx) + abs(f.vz) + float(np.max(np.abs(film.rigid[2]))) + rates.liner + rates.mass + 1e-300
    start = film.P.copy(), film.fill.copy(), work.active.copy()
    film.balance()

    def attempt(extra: float) -> tuple[bool, int]:
        film.rates = rates._replace(pseudo=extra)
        # pseudo time stores mass, or the deflection under the unclipped pressure of the film
        film.pseudo_old[:] = f.content if film.kind == OIL else film.beta * (film.load.p + (film.P - film.load.drive))
        ok, steps = film.solve()
        film.rates, work.ready = rates, work.ready and extra == 0.0
        work.warm = work.warm or ok
        for field, other in zip((film.P, film.fill, work.active), start, strict=True):
            (other if ok else field)[:] = field if ok else other
        if not ok:
            film.balance()
        return ok, steps

    return pseudo_time(attempt, rate)


def failure(film: LinerFilm) -> Status:
    """Return the status of a film for which all methods have failed."""
    f, s, rigid = film.film, film.film.system, film.rigid
    # fields are those of the last film that pseudo-transient continuation has solved
    unfed = s.turns > 0.0 and has_unfed_row(s.linear_pressure, f.H, s.fixed, s.turns, s.cavity_pressure)
    if unfed and not rigid[2].any():
        return Status.NO_OIL
    if film.oil is not None and float(film.load.p.max()) * film.scale > NEARLY_SOLID * film.oil.largest_pressure:
        return Status.NO_PRESSURE
    if film.contact is not None or film.beta == 0.0:
        return Status.NOT_CONVERGED
    # tension may pull the liner shut: without cavitation, or by a negative cavity pressure
    shut = not f.ruptures or float(rigid[0].min()) + film.beta * film.cavity_load <= 0.0
    return Status.NO_FILM if shut else Status.NOT_CONVERGED
