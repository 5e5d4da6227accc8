"""Mass-conserving cavitation (Jakobsson-Floberg-Olsson condition in the form of Elrod and Adams).

Every vertex is either full (``P >= Pc``, fill = 1, unknown P) or cavitated (``P = Pc``, 0 <= fill <= 1, unknown fill).
Its balance is

    sum over links of [k (P - P_neighbour) + f fill_upstream] + area (fill H - (fill H)_old) / dt = 0,

with the Poiseuille conductance k and the Couette flux f of a full film (gap on the link, fill from upstream), backward
Euler in the mass (fill H), whose old value is the film's history. Without a history the film is steady and the last
term is ``area fill dH/dt``. For given sets the system is linear; the sets follow from its solution (a semi-smooth
Newton method in one unknown per vertex). Every matrix is a column diagonally dominant M-matrix, whatever the sets, so
that the film exists and is unique. Should the sets not converge, the steady film is approached through growing pseudo
time steps, whose storage makes the matrices dominant enough.

Two factors solve a linear system, to rounding the same: `exudyn_ehd.film.cavitation.cavity_transport`, which follows
the oil through the cavity and is left with a symmetric film, and for the rest (oil that circulates in a cavity, fronts
longer than a few columns) a band of the folded ring. The sets alone decide which.

Sources: H. G. Elrod, J. Lubrication Technology 103 (1981) 350; the one-unknown form after F. M. Alakhramsing, R. van
Ostayen, R. Eling, Lubricants 3 (2015) 256, and T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58
(2015) 18.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.many_sides import solve_in_tiles
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl, solve_lu, solve_lu_transposed
from exudyn_ehd.film.banded.workspace import PAD, Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem
from exudyn_ehd.film.cavitation.cavity_adjoint import reduce_transposed, solve_transport_transposed
from exudyn_ehd.film.cavitation.cavity_transport import (
    FULL_COUNT,
    WIDTH,
    factor_transport,
    flow_direction,
    solve_transport,
)
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.status import Status, require_number

MAX_NEWTON_STEPS = 60
MAX_PSEUDO_STEPS = 60
SET_TOLERANCE = 1e-12
# Rounding of the fill in a dry cavity. Less oil than none only comes from rates that last in a film without history: no
# such film exists.
LARGEST_DEFICIT = 1e-6


@dataclass(frozen=True, kw_only=True)
class ElrodAdams:
    """Mass-conserving cavitation: rupture and reformation, with the oil content of the cavity as history.

    For starved or grooved bearings, oscillating loads, and wherever leakage and friction of the cavity matter. In a
    joint it needs an implicit solver. A steady film needs oil from somewhere: end or supply pressures above the cavity
    pressure.

    Parameters
    ----------
    cavity_pressure : float
        Gauge pressure of the cavity, Pa; about -1e5 for oil vapour or released air, 0 for a vented cavity.
    """

    cavity_pressure: float = 0.0

    cavity_shear = 1.0
    conserves_mass = True
    clips = False

    def __post_init__(self) -> None:
        require_number("ElrodAdams.cavity_pressure", self.cavity_pressure, "Pa")

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Newton from ``work.active``; cold starts come from the Swift-Stieber set."""
        steps = 0
        if not work.warm:
            np.logical_not(system.fixed, out=work.active)
            steps = SwiftStieber().solve(system, work)[1]
            system.fill[:] = 1.0
        was_warm = work.warm
        ok, count = self._newton(system, work, system.inverse_step, system.mass_old)
        steps += count
        if not ok and was_warm:
            # A film at rest leaves the fill of a cavity of the warm start open; its closing side is a full film.
            np.logical_not(system.fixed, out=work.active)
            ok, count = self._newton(system, work, system.inverse_step, system.mass_old)
            steps += count
        if not ok:
            ok, count = self._pseudo_transient(system, work)
            steps += count
        work.warm = ok
        return (Status.CONVERGED if ok else Status.NOT_CONVERGED), steps

    def _newton(
        self,
        s: FilmSystem,
        work: Workspace,
        inverse_step: float,
        mass_old: np.ndarray,
    ) -> tuple[bool, int]:
        ok, steps, work.count, work.width, work.convected = solve_elrod(
            s.coefficients,
            inverse_step,
            mass_old,
            s.cavity_pressure,
            work.active,
            work.order,
            work.number,
            work.lower,
            work.upper,
            work.inv_diag,
            work.transport,
            work.unknowns,
            s.pressure,
            s.fill,
        )
        return ok, steps

    def _pseudo_transient(self, s: FilmSystem, work: Workspace) -> tuple[bool, int]:
        """Implicit steps towards the target, from short to long and from a full film.

        The last one is the target itself.
        """
        largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
        largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - s.cavity_pressure), initial=0.0))
        rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
        if rate == 0.0:
            rate = 1.0
        mass = s.mass_old if s.inverse_step > 0.0 else s.H.copy()
        np.logical_not(s.fixed, out=work.active)
        s.fill[:] = 1.0
        extra, total = 4.0 * rate, 0
        for _ in range(MAX_PSEUDO_STEPS):
            inverse = s.inverse_step + extra
            blend = (s.inverse_step * s.mass_old + extra * mass) / inverse
            ok, steps = self._newton(s, work, inverse, blend)
            total += steps
            if ok:
                mass = s.fill * s.H
                extra *= 0.5
                if extra < 1e-6 * rate:
                    ok, steps = self._newton(s, work, s.inverse_step, s.mass_old)
                    return ok, total + steps
            else:
                extra *= 8.0
        return False, total

    def adjoint(self, system: FilmSystem, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the transposed system for every row of rhs (k, count), in place."""
        if work.convected:
            t = work.transport
            if t.shape[FULL_COUNT] < work.count:
                reduce_transposed(t, work.count, rhs)
            solve_ldl(t.band, t.diagonal, t.shape[FULL_COUNT], t.shape[WIDTH], rhs)
            return
        solve_lu_transposed(work.lower, work.upper, work.inv_diag, work.count, work.width, rhs)

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the transposed system for every column of tiles rhs, in place."""
        if work.convected:
            for tile in rhs:
                solve_transport_transposed(work.transport, work.count, tile[: work.count])
            return
        solve_in_tiles(work.upper, work.lower, work.inv_diag, False, work.count, work.width, rhs)

    def direct(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the system of the last solution for rhs (count,), in place."""
        if work.convected:
            solve_transport(work.transport, work.count, rhs)
            return
        solve_lu(work.lower, work.upper, work.inv_diag, work.count, work.width, rhs.reshape(1, -1))


@njit(cache=True)
def _add_entry(lower, upper, row, col, value):
    if col >= row:
        upper[row, col - row] += value
    else:
        lower[col, row - col] += value


@njit(cache=True)
def _add_link(c, d, k, f, full, fixed, number, P, pc, lower, upper, rhs):
    """One link from vertex c to d (flat): Poiseuille k (P_c - P_d) and Couette f fill_upstream.

    Prescribed vertices count as full.
    """
    # read at once, so that little of what follows branches
    a, b, full_c, full_d = number[c], number[d], full[c], full[d]
    P_c, P_d, fixed_c, fixed_d = P[c], P[d], fixed[c], fixed[d]
    # Poiseuille part: pressure is an unknown at full vertices, known (prescribed or pc) elsewhere.
    if a >= 0 and full_c:
        upper[a, 0] += k
        if b >= 0:
            _add_entry(lower, upper, b, a, -k)
    else:
        known = P_c if fixed_c else pc
        if a >= 0:
            rhs[a] -= k * known
        if b >= 0:
            rhs[b] += k * known
    if b >= 0 and full_d:
        upper[b, 0] += k
        if a >= 0:
            _add_entry(lower, upper, a, b, -k)
    else:
        known = P_d if fixed_d else pc
        if b >= 0:
            rhs[b] -= k * known
        if a >= 0:
            rhs[a] += k * known
    # Couette part: fill of the upstream vertex, an unknown if that one is cavitated.
    if f >= 0.0:
        up, up_full = a, full_c
    else:
        up, up_full = b, full_d
    if up >= 0 and not up_full:
        if a >= 0:
            _add_entry(lower, upper, a, up, f)
        if b >= 0:
            _add_entry(lower, upper, b, up, -f)
    else:
        if a >= 0:
            rhs[a] -= f
        if b >= 0:
            rhs[b] += f


@njit(cache=True)
def assemble_elrod(film, inverse_step, mass_old, pc, full, number, count, width, P, lower, upper, rhs):
    """Matrix and right-hand side for the given sets; unknowns are P at full vertices and fill at cavitated ones."""
    n, m = number.shape
    size, j = n * m, -1
    kx, kz, fx, fz = film.kx.reshape(-1), film.kz.reshape(-1), film.fx.reshape(-1), film.fz.reshape(-1)
    area, fixed, H, H_t = film.area.reshape(-1), film.fixed.reshape(-1), film.H.reshape(-1), film.H_t.reshape(-1)
    sets, rows, pressure, old = full.reshape(-1), number.reshape(-1), P.reshape(-1), mass_old.reshape(-1)
    rhs[:count] = 0.0
    lower[:count, : width + 1 + PAD] = 0.0
    upper[:count, : width + 1 + PAD] = 0.0
    for at in range(size):
        # unsigned indices need no check of their sign
        c, nxt = np.uint64(at), np.uint64(at + m if at + m < size else at + m - size)
        j = j + 1 if j + 1 < m else 0
        a = rows[c]
        if (a >= 0 or rows[nxt] >= 0) and (kx[c] != 0.0 or fx[c] != 0.0):
            _add_link(c, nxt, kx[c], fx[c], sets, fixed, rows, pressure, pc, lower, upper, rhs)
        if j + 1 < m:
            d = c + np.uint64(1)
            if a >= 0 or rows[d] >= 0:
                _add_link(c, d, kz[c], fz[c], sets, fixed, rows, pressure, pc, lower, upper, rhs)
        if a >= 0:
            w = area[c]
            if inverse_step > 0.0:
                rhs[a] += w * old[c] * inverse_step
                s = w * H[c] * inverse_step
            else:
                s = w * H_t[c]
            if sets[c]:
                rhs[a] -= s
            else:
                upper[a, 0] += s


@njit(cache=True)
def _solve_sets(film, inverse_step, mass_old, pc, full, directions, order, number, lower, upper, inv_diag, t, x, P):
    """Unknowns x for the given sets; returns (ok, count, width, convected).

    ``directions``: `flow_direction` of fx and fz.
    """
    along, across = directions
    if along != 0 and across != 0:
        ok, count = factor_transport(film, inverse_step, mass_old, pc, full, along, across, order, P, t, x)
        if ok:
            solve_transport(t, count, x)
            return True, count, 1, True
    # oil also links columns that exchange no pressure flow (short bearings)
    count, width = number_cells(np.logical_not(film.fixed), np.abs(film.kx) + np.abs(film.fx), order, number)
    assemble_elrod(film, inverse_step, mass_old, pc, full | film.fixed, number, count, width, P, lower, upper, x)
    if not factor_lu(lower, upper, count, width, inv_diag):
        return False, count, width, False
    solve_lu(lower, upper, inv_diag, count, width, x.reshape(1, x.size))
    return True, count, width, False


@njit(cache=True)
def solve_elrod(film, inverse_step, mass_old, pc, full, order, number, lower, upper, inv_diag, t, x, P, fill):
    """Newton on the sets from ``full``, which also returns them; returns (ok, steps, count, width, convected).

    ``film``: `Coefficients`. ``t`` holds the factor if ``convected``, else ``lower``, ``upper`` and ``inv_diag`` do.
    """
    n, m = full.shape
    for i in range(n):
        for j in range(m):
            if film.fixed[i, j]:
                full[i, j] = False
                fill[i, j] = 1.0
    directions = flow_direction(film.fx), flow_direction(film.fz)
    for step in range(MAX_NEWTON_STEPS):
        ok, count, width, convected = _solve_sets(
            film, inverse_step, mass_old, pc, full, directions, order, number, lower, upper, inv_diag, t, x, P
        )
        if not ok:
            return False, step + 1, count, width, convected
        peak = 0.0
        for r in range(count):
            if full[order[r] // m, order[r] % m]:
                peak = max(peak, abs(x[r] - pc))
        changes = 0
        for r in range(count):
            i = order[r] // m
            j = order[r] % m
            if full[i, j]:
                P[i, j] = x[r]
                fill[i, j] = 1.0
                if x[r] < pc - SET_TOLERANCE * peak:
                    full[i, j] = False
                    changes += 1
            else:
                P[i, j] = pc
                fill[i, j] = x[r]
                if x[r] > 1.0 + SET_TOLERANCE:
                    full[i, j] = True
                    changes += 1
        if changes == 0:
            sound = True
            for i in range(n):
                for j in range(m):
                    if full[i, j]:
                        P[i, j] = max(P[i, j], pc)
                    else:
                        sound = sound and fill[i, j] > -LARGEST_DEFICIT
                        fill[i, j] = min(max(fill[i, j], 0.0), 1.0)
            return sound, step + 1, count, width, convected
    return False, MAX_NEWTON_STEPS, count, width, convected
