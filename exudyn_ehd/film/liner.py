"""Elastic liner: the bore gives way by a column of liner under every point, inside the film solve.

A layer of thickness t on a stiff housing, pressed by p without sliding sideways (plane strain in both directions along the surface),
gives way by

    delta = K_nu t p / E,    K_nu = (1 + nu)(1 - 2 nu) / (1 - nu),

the column (Winkler) model: right for layers thinner than the contact is wide, and without meaning for incompressible ones.
With P the scaled film pressure the gap is ``H = H_rigid + beta P``, on links with the mean of both ends. Where the pressure falls
steeply, as at the ends, the gap falls with it; the conductance of a link is therefore the mean of H^3 over the linear course of
the deflection between its ends a and b,

    g = H (H^2 + d^2),    d = beta (P_b - P_a) / 2,

which is exact for a rigid gap that is constant along the link, and that of the plain film for beta = 0. The balance of every control
volume is solved by Newton's method with the exact matrix on the vertices that carry pressure. `SwiftStieber` keeps ``P >= Pc, r >= 0, (P - Pc) r = 0``: a step is cut off at the cavity
pressure, vertices without pressure join where oil piles up (r <= 0). `Gumbel` keeps its linear pressure below the cavity pressure, but
the liner answers to the clipped one. A step is shortened where it would use up more than 80 % of a gap, and halved while the
residual does not fall. Should it not settle, the liner's own rate ``beta dP/dt`` carries the film through pseudo time to the
steady state.

In motion the liner's rate takes part in the squeeze, ``dH/dt = rigid rate + beta (P - P_old) / dt`` (backward Euler), with the deflection
at the start of the step from the history: a soft liner feeds and drains the film as it gives way. Without a history (a prescribed
position) the deflection is steady; damping coefficients of such a state are those of the film between surfaces at rest in
their deformed shape.

Symbols: H0, HF0, Ht0 gap, gap on links and rate of the undeformed surfaces; P pressure, pc cavity pressure, beta compliance
over pressure, all scaled; inverse_step 1 / dt; delta_old deflection at the start of the step; a, b ends of a link.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.band_lu import factor_lu, solve_lu, solve_lu_transposed
from exudyn_ehd.film.direct import PAD, number_cells
from exudyn_ehd.film.elrod import _lu_buffers
from exudyn_ehd.film.flux import LinkFlux, conductances_from, couette_fluxes_from, plain_flux
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds import right_hand_side
from exudyn_ehd.film.solver import Closure, FilmSolver
from exudyn_ehd.status import InputError, Status, require_number

# Stands for a vanishing step where the pressure at one instant is asked for, s; short against any motion of a journal.
LINER_INSTANT = 1e-6
MAX_NEWTON_STEPS = 80
MAX_PSEUDO_STEPS = 80
# A full step below this share of the peak pressure leaves an error of about its square: 1e-16 times the film's nonlinearity.
STEP_TOLERANCE = 1e-8
FULL, CLIPPED, COMPLEMENTARY = 0, 1, 2
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@dataclass(frozen=True, kw_only=True)
class ElasticLiner:
    """Bush with an elastic liner on a rigid housing, by columns.

    Parameters
    ----------
    thickness : float
        t, m.
    youngs_modulus : float
        E, Pa.
    poisson_ratio : float
        nu, 0 to 0.49; columns say nothing about incompressible liners.
    """

    thickness: float
    youngs_modulus: float
    poisson_ratio: float = 0.3

    def __post_init__(self) -> None:
        require_number("ElasticLiner.thickness", self.thickness, "m", above=0.0)
        require_number("ElasticLiner.youngs_modulus", self.youngs_modulus, "Pa", above=0.0)
        nu = require_number("ElasticLiner.poisson_ratio", self.poisson_ratio, at_least=0.0)
        if nu > 0.49:
            raise InputError(
                f"ElasticLiner.poisson_ratio must be within 0 and 0.49, got {nu!r}; a nearly incompressible liner does not give "
                "way in columns, take a bush with a mesh."
            )

    @property
    def compliance(self) -> float:
        """Deflection per pressure K_nu t / E, m/Pa."""
        nu = self.poisson_ratio
        return (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu) * self.thickness / self.youngs_modulus


class LinerFilmSolver(FilmSolver):
    """`FilmSolver` on an elastic liner; the caller writes the gaps of the undeformed surfaces, ``solve`` adds the deflection.

    Parameters
    ----------
    grid, closure, squeeze
        As for `FilmSolver`; the closure is `FullSommerfeld`, `Gumbel` or `SwiftStieber`.

    Attributes
    ----------
    beta : float
        Scaled compliance: deflection over clearance per scaled pressure.
    delta_old : (n, m) array or None
        Scaled deflection at the start of the step, set by the caller before ``solve``; None: steady.
    """

    def __init__(self, grid: FilmGrid, closure: Closure, *, squeeze: bool = True) -> None:
        super().__init__(grid, closure, squeeze=squeeze)
        self.coarse = None
        coarse = grid.coarser()
        self.coarse_liner = None if coarse is None else LinerFilmSolver(coarse, closure, squeeze=squeeze)
        self.flux = LinkFlux(grid.shape)
        self.beta = 0.0
        self.delta_old: np.ndarray | None = None
        shape = grid.shape
        self.rigid = np.ones((3, *shape))
        self.residual = np.zeros(shape)
        self.trial = np.zeros(shape)
        self.derivatives = np.zeros((4, *shape))
        self.inverse = 0.0
        self.exact = False
        self.links = np.outer(grid.link_x, np.ones(shape[1]))
        if closure.clips:
            self.kind = CLIPPED
        else:
            self.kind = COMPLEMENTARY if np.isfinite(closure.cavity_pressure) else FULL

    @property
    def deflection(self) -> np.ndarray:
        """Scaled deflection of the last solution (n, m)."""
        return self.beta * self.system.pressure

    @property
    def gap_by_pressure(self) -> np.ndarray:
        """dH/dP at the vertices (n, m) of the last solution."""
        return np.where(self.grid.fixed | ~self.work.active, 0.0, self.beta)

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """Solve for the undeformed gaps now stored; on return ``H``, ``HF`` and ``H_t`` are the deformed ones.

        Parameters as for `FilmSolver.solve`; ``mass_old`` is not used.
        """
        s, g, r = self.system, self.grid, self.rigid
        self.vx, self.vz = vx, vz
        s.cavity_pressure = cavity_pressure
        r[0], r[1] = self.H, self.HF
        if self.squeeze:
            r[2] = self.H_t
        else:
            r[2] = 0.0
        inverse = 0.0
        if self.delta_old is not None and self.squeeze:
            inverse = 1.0 / step if step > 0.0 else 1.0 / LINER_INSTANT
            delta_old = self.delta_old
        else:
            delta_old = np.zeros(g.shape)
        self.inverse = inverse
        s.linear_pressure[g.fixed] = s.pressure[g.fixed]
        P = s.linear_pressure
        if not self._ends_open():
            self.work.warm = False
            return Status.NO_FILM, 0
        if not self.work.warm:
            self._guess(P, inverse, delta_old, step)
        ok, steps = self._newton(P, inverse, delta_old)
        if not ok:
            self.work.warm = False
            self._dry_guess(P)
            ok, more = self._pseudo_transient(P, inverse, delta_old)
            steps += more
        self.work.warm = ok
        if not ok:
            return Status.NOT_CONVERGED, steps
        self._finish(P, inverse, delta_old)
        return Status.CONVERGED, steps

    def _ends_open(self) -> bool:
        """Whether the gap is open where the pressure is prescribed, which is beyond the liner's reach."""
        P, H0, HF0 = self.system.linear_pressure, self.rigid[0], self.rigid[1]
        ends = [0, -1]
        return bool(np.all((H0 + self.beta * P)[self.grid.fixed] > 0.0) and np.all((HF0 + self.beta * P)[:, ends] > 0.0))

    def _guess(self, P: np.ndarray, inverse: float, delta_old: np.ndarray, step: float) -> None:
        """Start from the film of every second vertex, or from a dry guess."""
        coarse = self.coarse_liner
        if coarse is None:
            self._dry_guess(P)
            return
        coarse.beta = self.beta
        coarse.H[:], coarse.HF[:], coarse.H_t[:] = self.rigid[0, ::2, ::2], self.rigid[0, 1::2, ::2], self.rigid[2, ::2, ::2]
        coarse.pressure[:] = P[::2, ::2]
        coarse.delta_old = delta_old[::2, ::2] if inverse > 0.0 else None
        coarse.forget()
        if coarse.solve(self.vx, self.vz, self.system.cavity_pressure, None, step)[0] is not Status.CONVERGED:
            self._dry_guess(P)
            return
        fine = np.repeat(coarse.system.linear_pressure, 2, axis=0)
        fine[1::2] = 0.5 * (fine[::2] + np.roll(fine[::2], -1, axis=0))
        free = ~self.grid.fixed
        between = np.empty(self.grid.shape)
        between[:, ::2] = fine
        between[:, 1::2] = 0.5 * (fine[:, :-1] + fine[:, 1:])
        P[free] = between[free]

    def _dry_guess(self, P: np.ndarray) -> None:
        """Pressure that would keep a thin film open: half the gap's mean where the undeformed surfaces come closer than that."""
        H0 = self.rigid[0]
        film = 0.1
        guess = np.maximum((film - H0) / self.beta, 0.0) if H0.min() < film else np.zeros(H0.shape)
        free = ~self.grid.fixed
        lowest = self.system.cavity_pressure if self.kind != FULL else 0.0
        P[free] = np.maximum(guess, lowest)[free]

    def _newton(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> tuple[bool, int]:
        g, w, s = self.grid, self.work, self.system
        lower, upper = _lu_buffers(w)
        ok, steps, self.exact, w.count, w.width = solve_liner(
            self.rigid, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.links, g.fixed, s.cavity_pressure,
            self.kind, self.beta, inverse, delta_old, not w.warm, w.active, w.order, w.number, self.derivatives, lower,
            upper, w.inv_diag, w.unknowns, self.residual, self.trial, P,
        )  # fmt: skip
        return ok, steps

    def _pseudo_transient(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> tuple[bool, int]:
        """Implicit steps of the liner's own rate towards the target, from short to long; the last one is the target itself."""
        rate = abs(self.vx) + abs(self.vz) + float(np.max(np.abs(self.rigid[2]))) + inverse + 1e-300
        extra, total = 100.0 * rate, 0
        start = P.copy()
        for _ in range(MAX_PSEUDO_STEPS):
            deflection = self.beta * (np.maximum(start, self.system.cavity_pressure) if self.kind != FULL else start)
            blend = (inverse * delta_old + extra * deflection) / (inverse + extra)
            ok, steps = self._newton(P, inverse + extra, blend)
            total += steps
            if ok:
                start[:] = P
                extra *= 0.3
                if extra < 1e-3 * rate:
                    ok, steps = self._newton(P, inverse, delta_old)
                    total += steps
                    if ok:
                        return True, total
                    P[:] = start
            else:
                P[:] = start
                extra *= 8.0
        return False, total

    def _finish(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> None:
        """Deformed gaps, clipped pressure and the coefficients that flows and balances are taken from."""
        g, s, w = self.grid, self.system, self.work
        if self.kind == CLIPPED:
            np.copyto(s.pressure, np.where(g.fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~g.fixed, P >= s.cavity_pressure, out=w.active)
        deform(self.rigid[0], self.rigid[1], s.pressure, self.beta, self.H, self.HF)
        if self.squeeze and inverse > 0.0:
            self.H_t += (self.beta * s.pressure - delta_old) * inverse
        f = self.flux
        assert f is not None
        plain_flux(self.H, self.HF, f.gap_z, f.gx, f.gx_h, f.gx_v, f.gz, f.gz_h, f.gz_v, f.cx, f.cx_h, f.cz, f.cz_h)
        add_bending(s.pressure, self.beta, self.HF, f.gap_z, f.gx, f.gx_h, f.gz, f.gz_h)
        conductances_from(f.gx, f.gz, g.width_x, g.width_z, g.link_x, g.link_z, self.flow_x, s.kx, s.kz)
        couette_fluxes_from(f.cx, f.cz, self.vx, self.vz, g.width_x, g.width_z, g.link_x, s.fx, s.fz)
        right_hand_side(s.fx, s.fz, s.b)
        if self.squeeze:
            s.b -= self.H_t * self.area

    def adjoint(self, rhs: np.ndarray) -> np.ndarray:
        """Solve ``J^T lam = rhs`` with Newton's matrix at the solution; rhs (k, count) is overwritten, fields (k, n, m) come back."""
        w, g, s = self.work, self.grid, self.system
        lower, upper = _lu_buffers(w)
        if not self.exact:
            active = ~g.fixed if self.kind == CLIPPED else w.active
            factor_liner(
                self.rigid, s.linear_pressure, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.links, g.fixed,
                s.cavity_pressure, self.kind, self.beta, self.inverse, active, w.order, w.number, self.derivatives, lower,
                upper, w.inv_diag,
            )  # fmt: skip
            self.exact = True
        solve_lu_transposed(lower, upper, w.inv_diag, w.count, w.width, rhs)
        fields = np.zeros((rhs.shape[0], self.H.size))
        fields[:, w.order[: w.count]] = rhs
        return fields.reshape(rhs.shape[0], *self.grid.shape)


@njit(cache=True)
def deform(H0, HF0, P, beta, H_out, HF_out):
    """Gaps on a liner that gives way by ``beta P``."""
    n, m = H0.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            H_out[i, j] = H0[i, j] + beta * P[i, j]
            HF_out[i, j] = HF0[i, j] + 0.5 * beta * (P[i, j] + P[nxt, j])


@njit(cache=True)
def add_bending(P, beta, HF, gap_z, gx, gx_h, gz, gz_h):
    """Add ``H d^2`` to the links' conductances and ``d^2`` to their derivatives, in place."""
    n, m = P.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            d = 0.5 * beta * (P[nxt, j] - P[i, j])
            gx[i, j] += HF[i, j] * d * d
            gx_h[i, j] += d * d
            if j + 1 < m:
                d = 0.5 * beta * (P[i, j + 1] - P[i, j])
                gz[i, j] += gap_z[i, j] * d * d
                gz_h[i, j] += d * d


@njit(cache=True, fastmath=_FAST)
def liner_residual(
    rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r_out
):  # fmt: skip
    """Balance of every vertex (outflow - inflow + squeeze); returns (norm of what is violated, smallest gap).

    A vertex at the cavity pressure violates only by r < 0 if the closure is complementary.
    """
    n, m = P.shape
    smallest = 1e300
    r_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            pa = P[i, j]
            pb = P[nxt, j]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[nxt, j]) else max(pb, pc)
            h = rigid[1, i, j] + 0.5 * beta * (da + db)
            smallest = min(smallest, h)
            d = 0.5 * beta * (db - da)
            q = width_z[j] * (v * h - h * (h * h + d * d) * lx * (pb - pa))
            r_out[nxt, j] -= q
            own = rigid[0, i, j] + beta * da
            smallest = min(smallest, own)
            rate = rigid[2, i, j] + (beta * da - delta_old[i, j]) * inverse_step
            r_out[i, j] += q + rate * width_x[i] * width_z[j]
        for j in range(m - 1):
            pa = P[i, j]
            pb = P[i, j + 1]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[i, j + 1]) else max(pb, pc)
            h = 0.5 * (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (da + db))
            d = 0.5 * beta * (db - da)
            q = width_x[i] * (vz * h - h * (h * h + d * d) * link_z[j] * (pb - pa))
            r_out[i, j] += q
            r_out[i, j + 1] -= q
    total = 0.0
    for i in range(n):
        for j in range(m):
            if not fixed[i, j]:
                r = r_out[i, j]
                if kind == COMPLEMENTARY and P[i, j] <= pc:
                    r = min(r, 0.0)
                total += r * r
    return np.sqrt(total), smallest


@njit(cache=True, fastmath=_FAST)
def flux_derivatives(rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, out):
    """Derivatives of the links' fluxes a -> b: out (4, n, m) = theta by P_a, theta by P_b, z by P_a, z by P_b."""
    n, m = P.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            pa = P[i, j]
            pb = P[nxt, j]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[nxt, j]) else max(pb, pc)
            h = rigid[1, i, j] + 0.5 * beta * (da + db)
            d = 0.5 * beta * (db - da)
            drop = lx * (pb - pa)
            k = width_z[j] * h * (h * h + d * d) * lx
            by_h = 0.5 * width_z[j] * beta * (v - (3.0 * h * h + d * d) * drop)
            by_d = width_z[j] * beta * h * d * drop
            out[0, i, j] = k + (by_h + by_d if da == pa else 0.0)
            out[1, i, j] = -k + (by_h - by_d if db == pb else 0.0)
        for j in range(m - 1):
            pa = P[i, j]
            pb = P[i, j + 1]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[i, j + 1]) else max(pb, pc)
            h = 0.5 * (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (da + db))
            d = 0.5 * beta * (db - da)
            drop = link_z[j] * (pb - pa)
            k = width_x[i] * h * (h * h + d * d) * link_z[j]
            by_h = 0.5 * width_x[i] * beta * (vz - (3.0 * h * h + d * d) * drop)
            by_d = width_x[i] * beta * h * d * drop
            out[2, i, j] = k + (by_h + by_d if da == pa else 0.0)
            out[3, i, j] = -k + (by_h - by_d if db == pb else 0.0)


@njit(cache=True)
def assemble_liner(
    derivatives, P, pc, kind, storage, width_x, width_z, number, order, count, width, lower, upper
):  # fmt: skip
    """d(balance)/dP of the numbered vertices into the two bands; ``storage`` = beta / dt."""
    n, m = P.shape
    for r in range(count):
        for d in range(width + 1 + PAD):
            lower[r, d] = 0.0
            upper[r, d] = 0.0
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        diagonal = derivatives[0, i, j] - derivatives[1, prv, j]
        if storage != 0.0 and (kind != CLIPPED or P[i, j] > pc):
            diagonal += storage * width_x[i] * width_z[j]
        if j > 0:
            diagonal -= derivatives[3, i, j - 1]
        if j + 1 < m:
            diagonal += derivatives[2, i, j]
            b = number[i, j + 1]
            if b >= 0:
                upper[r, b - r] += derivatives[3, i, j]
                lower[r, b - r] -= derivatives[2, i, j]
        upper[r, 0] += diagonal
        b = number[nxt, j]
        if b > r:
            upper[r, b - r] += derivatives[1, i, j]
            lower[r, b - r] -= derivatives[0, i, j]
        elif b >= 0:
            lower[b, r - b] += derivatives[1, i, j]
            upper[b, r - b] -= derivatives[0, i, j]


@njit(cache=True)
def factor_liner(
    rigid, P, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step,
    active, order, number, derivatives, lower, upper, inv_diag,
):  # fmt: skip
    """Newton's matrix at P, factored; returns (ok, count, width)."""
    count, width = number_cells(active, links, order, number)
    flux_derivatives(rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, derivatives)
    assemble_liner(
        derivatives, P, pc, kind, beta * inverse_step, width_x, width_z, number, order, count, width, lower, upper
    )
    return factor_lu(lower, upper, count, width, inv_diag), count, width


@njit(cache=True)
def _select(P, r, fixed, pc, kind, active):
    """Vertices that carry pressure or are about to; returns the number of changes."""
    n, m = P.shape
    changes = 0
    for i in range(n):
        for j in range(m):
            new = not fixed[i, j] and (kind != COMPLEMENTARY or P[i, j] > pc or r[i, j] <= 0.0)
            if new != active[i, j]:
                active[i, j] = new
                changes += 1
    return changes


@njit(cache=True)
def _longest_step(H0, P, order, count, x, beta):
    """Share of the step x that uses up at most 80 % of any vertex's gap."""
    m = P.shape[1]
    share = 1.0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        change = beta * x[k]
        gap = H0[i, j] + beta * P[i, j]
        if change < -0.8 * gap and gap > 0.0:
            share = min(share, -0.8 * gap / change)
    return share


@njit(cache=True)
def _take(P, x, share, order, count, pc, kind, trial_out):
    """Trial pressures P + share x, cut off at the cavity pressure."""
    m = P.shape[1]
    trial_out[:] = P
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        p = P[i, j] + share * x[k]
        trial_out[i, j] = pc if (kind == COMPLEMENTARY and p < pc) else p


@njit(cache=True)
def solve_liner(
    rigid, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step, delta_old,
    cold, active, order, number, derivatives, lower, upper, inv_diag, x, r, trial, P,
):  # fmt: skip
    """Newton from P, ``cold`` from all free vertices; returns (ok, steps, exact, count, width).

    A factor serves further steps as long as the set stays and each step is five times smaller than the last; ``exact`` says that
    the last factor belongs to the solution.
    """
    n, m = P.shape
    if kind == COMPLEMENTARY:
        for i in range(n):
            for j in range(m):
                if not fixed[i, j] and P[i, j] < pc:
                    P[i, j] = pc
    norm, smallest = liner_residual(
        rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r
    )
    if not smallest > 0.0:
        return False, 0, False, 0, 1
    if cold:
        # Vertices leave all at once but join one row per step: start from all of them.
        active[:] = np.logical_not(fixed)
    else:
        _select(P, r, fixed, pc, kind, active)
    reference = pc if kind != FULL else 0.0
    count, width = 0, 1
    last = 0.0
    factored = False
    for step in range(MAX_NEWTON_STEPS):
        fresh = not factored
        if fresh:
            ok, count, width = factor_liner(
                rigid, P, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step,
                active, order, number, derivatives, lower, upper, inv_diag,
            )  # fmt: skip
            if not ok:
                return False, step + 1, False, count, width
            if count == 0:
                return True, step + 1, True, count, width
        peak = 0.0
        for k in range(count):
            i = order[k] // m
            j = order[k] - i * m
            x[k] = -r[i, j]
            peak = max(peak, abs(P[i, j] - reference))
        solve_lu(lower, upper, inv_diag, count, width, x.reshape(1, x.size))
        largest = 0.0
        for k in range(count):
            largest = max(largest, abs(x[k]))
        if not largest < 1e300:
            return False, step + 1, False, count, width
        if not fresh and largest > 0.2 * last:
            factored = False
            continue
        share = _longest_step(rigid[0], P, order, count, x, beta) if kind != CLIPPED else 1.0
        before = norm
        for _ in range(12):
            _take(P, x, share, order, count, pc, kind, trial)
            norm, smallest = liner_residual(
                rigid, trial, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r
            )
            if smallest > 0.0 and (norm < before or largest <= STEP_TOLERANCE * peak):
                break
            share *= 0.5
        if not smallest > 0.0:
            return False, step + 1, False, count, width
        P[:] = trial
        changes = _select(P, r, fixed, pc, kind, active)
        factored = changes == 0 and share == 1.0
        if factored:
            rest = largest * largest if fresh else largest * largest / last * peak
            if rest <= (STEP_TOLERANCE * peak) ** 2:
                return True, step + 1, fresh, count, width
        last = largest
    return False, MAX_NEWTON_STEPS, False, count, width
