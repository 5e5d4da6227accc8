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
volume is solved by Newton's method with the exact matrix on the vertices that carry pressure.

`SwiftStieber` keeps ``P >= Pc, r >= 0, (P - Pc) r = 0``: a step is cut off at the cavity pressure, vertices without pressure join where oil piles up (r <= 0). `Gumbel` keeps its linear pressure below the cavity pressure, but
the liner answers to the clipped one; no theorem says that such a film exists, and of extreme steady ones some are not found. `FullSommerfeld` has no film where surfaces part so fast that tension pulls the liner shut: followed
from a stiff liner to a soft one, its smallest gap goes to zero at a finite compliance (status NO_FILM; take a closure that breaks). So
may the cavity's tension, where it pulls a column further than the undeformed gap. A step is shortened where it would use up more than 80 % of a gap, and halved while the
residual does not fall. Should it not settle, the liner's own rate ``beta dP/dt`` carries the film through pseudo time to the
steady state. With `SwiftStieber` there always is one, as long as the cavity's pressure leaves a gap: the balance is continuous and coercive on ``P >= Pc`` (no gap is smaller than with
the cavity's pressure, and oil that is pressed together opens the liner until it can leave), so that its complementarity problem has a
solution (Ph. Hartman, G. Stampacchia, Acta Math. 115 (1966) 271).

In motion the liner's rate takes part in the squeeze, ``dH/dt = rigid rate + beta (P - P_old) / dt`` (backward Euler), with the deflection
at the start of the step from the history: a soft liner feeds and drains the film as it gives way. Without a history (a prescribed
position) the deflection is steady; the damping of an equilibrium lets it follow slow motions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.banded.substitution import solve_lu_transposed
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.loads import scatter
from exudyn_ehd.film.reynolds.link_derivatives import LinkDerivatives
from exudyn_ehd.film.reynolds.links import add_squeeze
from exudyn_ehd.film.solvers.linear import Closure, FilmSolver
from exudyn_ehd.film.solvers.liner_newton import (
    CLIPPED,
    COMPLEMENTARY,
    FULL,
    deformed_film,
    ends_open,
    factor_liner,
    flow_rounding,
    liner_link_derivatives,
    liner_residual,
    select,
    solve_liner,
)
from exudyn_ehd.status import InputError, Status, require_number

# Stands for a vanishing step where the pressure at one instant is asked for, s; short against any motion of a journal.
LINER_INSTANT = 1e-6
MAX_PSEUDO_STEPS = 150
LARGEST_PSEUDO_RATE = 1e5


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


def failed_film(kind: int, rigid: np.ndarray, beta: float, cavity_pressure: float) -> Status:
    """Status of a film on a liner that was not found, for its closure's ``kind`` and undeformed gaps (n, m).

    NO_FILM where tension may pull the liner shut: without cavitation, or by the cavity's own pressure.
    """
    if kind == FULL or float(rigid.min()) + beta * cavity_pressure <= 0.0:
        return Status.NO_FILM
    return Status.NOT_CONVERGED


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
        self.beta = 0.0
        self.delta_old: np.ndarray | None = None
        shape = grid.shape
        self.rigid = np.ones((3, *shape))
        self.none = np.zeros(shape)
        self.residual = np.zeros(shape)
        self.trial = np.zeros(shape)
        self.inverse = 0.0
        self.exact = False
        self.held = False
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
    def deflection_by_pressure(self) -> np.ndarray:
        """dD/dP, for these columns also d(gap)/dP, at the vertices (n, m) of the last solution."""
        return np.where(self.grid.fixed | ~self.work.active, 0.0, self.beta)

    def smallest_gap(self) -> float:
        """Smallest scaled gap of the deformed surfaces, at vertices and links."""
        return min(float(self.H.min()), float(self.HF.min()))

    def stored_power(self) -> float:
        """Scaled power ``sum p d(beta p)/dt`` that goes into the liner, not the film; 0 for a steady deflection."""
        if self.inverse == 0.0:
            return 0.0
        old = self.none if self.delta_old is None else self.delta_old
        return float(np.sum(self.system.pressure * (self.deflection - old) * self.grid.weight)) * self.inverse

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
        delta_old = self.none
        if self.delta_old is not None and self.squeeze:
            inverse = 1.0 / step if step > 0.0 else 1.0 / LINER_INSTANT
            delta_old = self.delta_old
        self.inverse = inverse
        P = s.linear_pressure
        if self.kind == CLIPPED:
            P[g.fixed] = s.pressure[g.fixed]
        if not ends_open(r, P, self.beta, g.fixed):
            self.work.warm = False
            return Status.NO_FILM, 0
        was_warm = self.work.warm
        if not was_warm:
            self._guess(P, inverse, delta_old, step)
        ok, steps = self._newton(P, inverse, delta_old)
        if not ok and was_warm:
            # a start from another state can mislead where the film itself is benign
            self.work.warm = False
            self._guess(P, inverse, delta_old, step)
            ok, more = self._newton(P, inverse, delta_old)
            steps += more
        ok = ok or self._carries_nothing(P, inverse, delta_old)
        if not ok:
            self.work.warm = False
            self._dry_guess(P)
            ok, more = self._pseudo_transient(P, inverse, delta_old)
            steps += more
        self.work.warm = ok
        if not ok:
            return failed_film(self.kind, self.rigid[0], self.beta, cavity_pressure), steps
        self._finish(P, inverse, delta_old)
        return Status.CONVERGED, steps

    def _guess(self, P: np.ndarray, inverse: float, delta_old: np.ndarray, step: float) -> None:
        """Start from the film of every second vertex, or from a dry guess."""
        coarse = self.coarse_liner
        if coarse is None:
            self._dry_guess(P)
            return
        coarse.beta = self.beta
        coarse.H[:], coarse.HF[:], coarse.H_t[:] = (
            self.rigid[0, ::2, ::2],
            self.rigid[0, 1::2, ::2],
            self.rigid[2, ::2, ::2],
        )
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
        lower, upper = w.lower, w.upper
        ok, steps, self.exact, w.count, w.width = solve_liner(
            self.rigid, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.links, g.fixed, s.cavity_pressure,
            self.kind, self.beta, inverse, delta_old, not w.warm, self.held and w.warm, w.count, w.width, w.active, w.order,
            w.number, lower, upper, w.inv_diag, w.unknowns, self.residual, self.trial, P,
        )  # fmt: skip
        self.held = ok
        return ok, steps

    def _carries_nothing(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> bool:
        """Whether a film without pressure, into P, meets its balances to the rounding of the flows, where Newton's steps never stand still."""
        g, s, w = self.grid, self.system, self.work
        found = P.copy()
        P[~g.fixed] = 0.0
        norm, smallest = liner_residual(
            self.rigid, P, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, g.fixed, s.cavity_pressure, self.kind,
            self.beta, inverse, delta_old, self.residual,
        )  # fmt: skip
        noise = flow_rounding(
            self.rigid[0], self.rigid[1], self.rigid[2], self.vx, self.vz, g.width_x, g.width_z, g.link_x
        )
        if not (smallest > 0.0 and norm <= noise):
            P[:] = found
            return False
        select(P, self.residual, g.fixed, s.cavity_pressure, self.kind, w.active)
        lower, upper = w.lower, w.upper
        self.exact, w.count, w.width = factor_liner(
            self.rigid, P, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.links, g.fixed, s.cavity_pressure,
            self.kind, self.beta, inverse, w.active, w.order, w.number, lower, upper, w.inv_diag,
        )  # fmt: skip
        return self.exact

    def _pseudo_transient(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> tuple[bool, int]:
        """Implicit steps of the liner's own rate towards the target, from short to long; the last one is the target itself."""
        rate = abs(self.vx) + abs(self.vz) + float(np.max(np.abs(self.rigid[2]))) + inverse + 1e-300
        extra, total, unsettled = 100.0 * rate, 0, 0.1
        start = P.copy()
        for _ in range(MAX_PSEUDO_STEPS):
            deflection = self.beta * (np.maximum(start, self.system.cavity_pressure) if self.kind != FULL else start)
            blend = (inverse * delta_old + extra * deflection) / (inverse + extra)
            ok, steps = self._newton(P, inverse + extra, blend)
            total += steps
            if not ok:
                P[:] = start
                extra *= 8.0
                if extra > LARGEST_PSEUDO_RATE * rate:
                    return False, total
                continue
            # from here on the set of the last film, too
            self.work.warm = True
            moved = float(np.max(np.abs(P - start)) / (np.max(np.abs(P)) + 1e-300))
            start[:] = P
            extra *= 0.3
            if extra < 1e-3 * rate or moved < 0.1 * unsettled:
                unsettled = min(moved, unsettled)
                ok, steps = self._newton(P, inverse, delta_old)
                total += steps
                if ok:
                    return True, total
                P[:] = start
        return False, total

    def _finish(self, P: np.ndarray, inverse: float, delta_old: np.ndarray) -> None:
        """Deformed gaps, clipped pressure and the coefficients that flows and balances are taken from."""
        g, s, w = self.grid, self.system, self.work
        if self.kind == CLIPPED:
            np.copyto(s.pressure, np.where(g.fixed, P, np.maximum(P, s.cavity_pressure)))
            np.logical_and(~g.fixed, s.cavity_pressure <= P, out=w.active)
        deformed_film(
            self.rigid, s.pressure, self.beta, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.H, self.HF,
            s.kx, s.kz, s.fx, s.fz, s.b,
        )  # fmt: skip
        if self.squeeze:
            if inverse > 0.0:
                self.H_t += (self.beta * s.pressure - delta_old) * inverse
            add_squeeze(self.H_t, g.width_x, g.width_z, s.b)

    def refresh_fixed(self) -> None:
        """Hand a change of ``grid.fixed`` on to the coarser grids."""
        self.held = False
        if self.coarse_liner is not None:
            self.coarse_liner.grid.fixed[:] = self.grid.fixed[::2, ::2]
            self.coarse_liner.refresh_fixed()

    def adjoint(self, rhs: np.ndarray) -> np.ndarray:
        """Solve ``J^T lam = rhs`` with Newton's matrix at the solution; rhs (k, count) is overwritten, fields (k, n, m) come back."""
        w, g, s = self.work, self.grid, self.system
        lower, upper = w.lower, w.upper
        if not self.exact:
            active = ~g.fixed if self.kind == CLIPPED else w.active
            factor_liner(
                self.rigid, s.linear_pressure, self.vx, self.vz, g.width_x, g.width_z, g.link_x, g.link_z, self.links, g.fixed,
                s.cavity_pressure, self.kind, self.beta, self.inverse, active, w.order, w.number, lower, upper, w.inv_diag,
            )  # fmt: skip
            self.exact = True
        solve_lu_transposed(lower, upper, w.inv_diag, w.count, w.width, rhs)
        fields = np.empty((rhs.shape[0], *g.shape))
        scatter(rhs, w.order, w.count, fields)
        return fields

    def link_derivatives(self) -> LinkDerivatives:
        """Derivatives of the links' flows with respect to their gaps and the speeds, at fixed pressure."""
        g, s, d = self.grid, self.system, self.link_fields
        liner_link_derivatives(
            s.linear_pressure, s.pressure, self.H, self.HF, self.beta, self.vx, self.vz, g.width_x, g.width_z, g.link_x,
            g.link_z, d.DX, d.DZ, d.SX, d.SZ,
        )  # fmt: skip
        return d
