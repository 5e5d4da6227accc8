"""Mass-conserving cavitation (Jakobsson-Floberg-Olsson condition in the form of Elrod and Adams).

Every vertex is either full (``P >= Pc``, fill = 1, unknown P) or cavitated (``P = Pc``, 0 <= fill <= 1, unknown fill).
Its balance is

    sum over links of [k (P - P_neighbour) + f carried_upstream] + area (fill H - kept) / dt = 0,

with the Poiseuille conductance k, the Couette flux f of a full film (gap on the link), the fill carried from upstream,
which in a step is averaged over it (`exudyn_ehd.film.cavitation.lagging_void`), and ``kept`` by the film's history,
`exudyn_ehd.film.solvers.linear.FilmSolver.keep`. Without a history the film is steady and the last term is
``area fill dH/dt``. For given sets the system is linear; the sets follow from its solution (a semi-smooth Newton method
in one unknown per vertex). Every matrix is a column diagonally dominant M-matrix, whatever the sets, so that the film
exists and is unique. Should the sets come back or not converge, the film is approached through growing pseudo time
steps, whose storage makes the matrices dominant enough.

Two factors solve a linear system, to rounding the same: `exudyn_ehd.film.cavitation.cavity_transport`, which follows
the oil through the cavity and is left with a symmetric film, and for the rest (oil that circulates in a cavity,
reformation fronts longer than a few columns) a band of the folded ring. The sets alone decide which.

Sources: H. G. Elrod, J. Lubrication Technology 103 (1981) 350; the one-unknown form after F. M. Alakhramsing, R. van
Ostayen, R. Eling, Lubricants 3 (2015) 256, and T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58
(2015) 18.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.many_sides import solve_in_tiles
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_ldl, solve_lu, solve_lu_one, solve_lu_transposed
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem
from exudyn_ehd.film.cavitation.cavity_adjoint import reduce_transposed, solve_transport_transposed
from exudyn_ehd.film.cavitation.cavity_transport import (
    FRONT,
    FULL_COUNT,
    WIDTH,
    factor_transport,
    solve_transport,
)
from exudyn_ehd.film.cavitation.closures import SwiftStieber, check_cavity_pressure
from exudyn_ehd.film.cavitation.lagging_void import hold_back
from exudyn_ehd.film.cavitation.oil_line.curve import OilLine
from exudyn_ehd.film.cavitation.oil_line.newton import solve_on_curve
from exudyn_ehd.film.cavitation.pseudo_time import pseudo_time
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row, is_balanced
from exudyn_ehd.film.reynolds.balance import film_balance, film_slopes, film_terms, oil_links
from exudyn_ehd.film.reynolds.links import Coefficients, flow_direction
from exudyn_ehd.status import Status, require_bool

MAX_NEWTON_STEPS = 60
SET_TOLERANCE = 1e-12
# Rounding of the fill in a dry cavity. Less oil than none only comes from rates that last in a film without history: no
# such film exists.
LARGEST_DEFICIT = 1e-6
# Storages in pseudo time over the largest flow into a vertex by the smallest vertex: of the first one, and of the last
# one from which a film without storage is tried.
FIRST_RATE, LAST_RATE = 0.01, 1e-7


@dataclass(frozen=True, kw_only=True)
class ElrodAdams:
    """Mass-conserving cavitation: rupture and reformation, with the oil content of the cavity as history.

    For starved or grooved bearings, oscillating loads, and wherever leakage and friction of the cavity matter. In a
    joint it needs an implicit solver. A steady film needs oil from somewhere: end or supply pressures above the cavity
    pressure; a moving one without it runs dry within some turns, and the joint warns.

    In time its history is the void of the gap; full films are squeezed as under `SwiftStieber`. Flows balance what they
    bring to rounding; the content keeps to that within half a step of the gap's rate, over any number of steps.

    With ``line_in_cells`` steady stiffness is within 1.5 % in any direction (default grid, eccentricity ratio 0.6 to
    0.9, L/D 0.5 and 1) instead of 9 %, and damping varies by 1.3 % with the direction instead of 10 %, in two to
    three times the time. Where the film reforms it does so on the grid's vertices: damping may be off by 6 % for it.

    Parameters
    ----------
    cavity_pressure : float
        Gauge pressure of the cavity, Pa; about -1e5 for oil vapour or released air, 0 for a vented cavity.
    line_in_cells : bool
        True: the film ruptures where it does, inside the cells of the grid; not with bushes, density and shear laws;
        see `exudyn_ehd.film.cavitation.oil_line.curve`. False: on their vertices.

    Source
    ------
    H. G. Elrod, J. Lubrication Technology 103 (1981) 350; one unknown per vertex after Alakhramsing et al., Lubricants
    3 (2015) 256, and Woloszynski et al., Tribology Letters 58 (2015) 18.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2])), round(float(film.fill.min()), 2)  # N, least share of oil
    (12179, 0.12)
    """

    cavity_pressure: float = 0.0
    line_in_cells: bool = False

    cavity_shear = 1.0
    conserves_mass = True
    clips = False

    def __post_init__(self) -> None:
        check_cavity_pressure("ElrodAdams", self.cavity_pressure)
        object.__setattr__(self, "line_in_cells", require_bool("ElrodAdams.line_in_cells", self.line_in_cells))

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Newton from ``work.active``; cold starts come from the Swift-Stieber set."""
        if system.oil_line is None:
            return self._solve_plain(system, work)
        steps, status = 0, Status.NOT_CONVERGED
        if work.known:
            work.known, steps = self._move_line(system, system.oil_line, work)
            work.warm = work.known
        if not work.known:
            # from the film with its line on the grid
            system.oil_line.late[:] = system.late
            status, count = self._solve_plain(system, work)
            steps += count
            if status is Status.CONVERGED:
                work.known, count = self._move_line(system, system.oil_line, work)
                steps += count
        work.warm = work.known
        return (Status.CONVERGED if work.known else max(status, Status.NOT_CONVERGED)), steps

    def _solve_plain(self, s: FilmSystem, work: Workspace) -> tuple[Status, int]:
        steps, was_warm = 0, work.warm
        if not was_warm:
            np.logical_not(s.fixed, out=work.active)
            steps = SwiftStieber().solve(s, work)[1]
            s.fill[:] = 1.0
        film = s.coefficients
        ok, count = self._newton(s, work, film, s.inverse_step, s.mass_old)
        steps += count
        if not ok and was_warm:
            # A film at rest leaves the fill of a cavity of the warm start open; its closing side is a full film.
            np.logical_not(s.fixed, out=work.active)
            ok, count = self._newton(s, work, film, s.inverse_step, s.mass_old)
            steps += count
        status = Status.CONVERGED
        if not ok or (s.closes and has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)):
            status, count = self._follow(s, work)
            steps += count
        work.warm = status is Status.CONVERGED
        return status, steps

    def _newton(
        self,
        s: FilmSystem,
        work: Workspace,
        film: Coefficients,
        inverse_step: float,
        mass_old: np.ndarray,
    ) -> tuple[bool, int]:
        ok, steps, work.count, work.width, work.convected = solve_elrod(
            film,
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
        if ok and s.closes and inverse_step == 0.0:
            # cavities whose gaps close may make the matrix singular
            ok = is_balanced(film, s.pressure, s.fill, s.cavity_pressure)
        return ok, steps

    def _move_line(self, s: FilmSystem, line: OilLine, work: Workspace) -> tuple[bool, int]:
        """From a film to the one with its line inside the cells."""
        factors = work.lower, work.upper, work.inv_diag, work.transport
        ok, steps, work.count, work.width, work.convected = solve_on_curve(
            s.coefficients,
            s.late,
            s.b,
            s.inverse_step,
            s.mass_old,
            s.cavity_pressure,
            work.active,
            line.fields,
            work.order,
            work.number,
            factors,
            work.unknowns,
            s.pressure,
            s.fill,
        )
        line.exact = False
        return ok, steps

    def _follow(self, s: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Follow the film in pseudo time from a full one; NO_OIL if rows run dry on the way."""
        largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
        largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - s.cavity_pressure), initial=0.0))
        rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
        mass = (s.mass_old if s.inverse_step > 0.0 else s.H).copy()
        np.logical_not(s.fixed, out=work.active)
        s.fill[:] = 1.0
        runs_dry = False

        def attempt(extra: float) -> tuple[bool, int]:
            nonlocal runs_dry
            inverse = s.inverse_step + extra
            blend = (s.inverse_step * s.mass_old + extra * mass) / inverse if inverse > 0.0 else s.mass_old
            film = s.coefficients
            if s.inverse_step == 0.0 < extra:
                # the gap's rate goes on: extra (fill H - mass) + fill dH/dt
                film = film._replace(H=s.H + s.H_t / extra)
            ok, steps = self._newton(s, work, film, inverse, blend)
            if ok:
                np.multiply(s.fill, s.H, out=mass)
                runs_dry = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
            return ok, steps

        ok, steps = pseudo_time(attempt, rate if rate > 0.0 else 1.0, FIRST_RATE, least=LAST_RATE)
        if ok:
            return Status.CONVERGED, steps
        return (Status.NO_OIL if runs_dry and not s.H_t.any() else Status.NOT_CONVERGED), steps

    def _factor(self, work: Workspace) -> tuple[np.ndarray, np.ndarray]:
        """L and U of the folded ring."""
        return dense_band(work.lower, work.count, work.width), dense_band(work.upper, work.count, work.width)

    def adjoint(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the transposed system for every row of rhs (k, count), in place."""
        if work.convected:
            t = work.transport
            if t.shape[FULL_COUNT] < work.count or t.shape[FRONT] > 0:
                reduce_transposed(t, work.count, rhs)
            solve_ldl(t.band, t.diagonal, t.shape[FULL_COUNT], t.shape[WIDTH], rhs)
            return
        solve_lu_transposed(*self._factor(work), work.inv_diag, work.count, work.width, rhs)

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the transposed system for every column of tiles rhs, in place."""
        if work.convected:
            for tile in rhs:
                solve_transport_transposed(work.transport, work.count, tile[: work.count])
            return
        lower, upper = self._factor(work)
        solve_in_tiles(upper, lower, work.inv_diag, False, work.count, work.width, rhs)

    def direct(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the system of the last solution for rhs (count,), in place."""
        if work.convected:
            solve_transport(work.transport, work.count, rhs)
            return
        solve_lu(*self._factor(work), work.inv_diag, work.count, work.width, rhs.reshape(1, -1))


@njit(cache=True)
def assemble_elrod(terms, links, pc, full, number, order, count, P, lower, upper, rhs):
    """Matrix and right-hand side for the given sets; unknowns are P at full vertices and fill at cavitated ones.

    The balance is linear in them: minus its value without them is the right-hand side. ``links``: not zero where
    vertices are linked in theta; prescribed vertices count as ``full``.
    """
    known, fill, out, slopes = np.empty(P.shape), np.empty(P.shape), np.empty(P.shape), np.empty((5, P.size))
    k, f, given, fixed, sets = (
        known.reshape(-1),
        fill.reshape(-1),
        P.reshape(-1),
        terms.fixed.reshape(-1),
        full.reshape(-1),
    )
    for c in range(k.size):
        k[c] = given[c] if fixed[c] else (0.0 if sets[c] else pc)
        f[c] = 1.0 if sets[c] else 0.0
    film_balance(known, fill, None, terms, out)
    film_slopes(fill, full, None, None, terms, slopes)
    assemble(links, terms.kz, slopes, number, order, count, lower, upper)
    left = out.reshape(-1)
    for r in range(count):
        rhs[r] = -left[order[r]]


@njit(cache=True, inline="always")
def _solve_sets(film, inverse_step, mass_old, pc, full, directions, order, number, lower, upper, inv_diag, t, x, P):
    """Unknowns x for the given sets; returns (ok, count, width, convected).

    ``directions``: `flow_direction` of fx and fz.
    """
    along, across = directions
    if along != 0 and across != 0:
        ok, count = factor_transport(film, inverse_step, mass_old, pc, full, along, across, order, P, t, x, None)
        if ok:
            solve_transport(t, count, x)
            return True, count, 1, True
    links, free, sets = oil_links(film, full)
    count, width = number_cells(free, links, order, number)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    terms = film_terms(film, inverse_step, mass_old)
    assemble_elrod(terms, links, pc, sets, number, order, count, P, L, U, x)
    if not factor_lu(L, U, count, width, inv_diag):
        return False, count, width, False
    solve_lu_one(L, U, inv_diag, count, width, x)
    return True, count, width, False


@njit(cache=True)
def _change_sets(x, order, count, pc, sets, changed, pressures, fills):
    """Write the unknowns x of the sets; vertices that belong to the other set change.

    ``changed`` marks who has done so an odd number of times. Returns how many change, and by how many the marks grow.
    """
    peak = 0.0
    for r in range(count):
        if sets[order[r]]:
            peak = max(peak, abs(x[r] - pc))
    changes, marks = 0, 0
    for r in range(count):
        c = order[r]
        if sets[c]:
            pressures[c], fills[c] = x[r], 1.0
            misplaced = x[r] < pc - SET_TOLERANCE * peak
        else:
            pressures[c], fills[c] = pc, x[r]
            misplaced = x[r] > 1.0 + SET_TOLERANCE
        if misplaced:
            sets[c], changed[c] = not sets[c], not changed[c]
            marks += 1 if changed[c] else -1
            changes += 1
    return changes, marks


@njit(cache=True, nogil=True)
def solve_elrod(film, inverse_step, mass_old, pc, full, order, number, lower, upper, inv_diag, t, x, P, fill):
    """Newton on the sets from ``full``, which also returns them; returns (ok, steps, count, width, convected).

    ``film``: `Coefficients`. ``t`` holds the factor if ``convected``, else ``lower``, ``upper`` and ``inv_diag`` do.
    Sets that come back (Brent's search for cycles) end it.
    """
    n, m = full.shape
    for i in range(n):
        for j in range(m):
            if film.fixed[i, j]:
                full[i, j] = False
                fill[i, j] = 1.0
    if inverse_step > 0.0:
        hold_back(film, inverse_step, mass_old)
    directions = flow_direction(film.fx), flow_direction(film.fz)
    sets, pressures, fills = full.reshape(-1), P.reshape(-1), fill.reshape(-1)
    changed, marked, since = np.zeros(n * m, dtype=np.bool_), 0, 1
    for step in range(MAX_NEWTON_STEPS):
        ok, count, width, convected = _solve_sets(
            film, inverse_step, mass_old, pc, full, directions, order, number, lower, upper, inv_diag, t, x, P
        )
        if not ok:
            return False, step + 1, count, width, convected
        changes, marks = _change_sets(x, order, count, pc, sets, changed, pressures, fills)
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
        marked += marks
        if marked == 0:
            return False, step + 1, count, width, convected
        if step >= 2 * since:
            since, marked = step, 0
            changed[:] = False
    return False, MAX_NEWTON_STEPS, count, width, convected
