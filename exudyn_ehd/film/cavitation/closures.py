"""Cavitation closures: what the film does where the linear Reynolds equation would go below the cavity pressure.

Each closure is a small frozen object, which a scene names, with one method, ``solve``. All pressures here are scaled
(see `exudyn_ehd.film.reynolds.links`); ``cavity_pressure`` of the specs is a gauge pressure in Pa.

* `FullSommerfeld`: nothing; negative pressures stay.
* `Gumbel` (half Sommerfeld): the linear problem is solved, then pressures below the cavity pressure are cut off.
* `SwiftStieber` (Reynolds condition): the complementarity problem ``P >= Pc, A P - b >= 0, (P - Pc)(A P - b) = 0``, solved by
  the primal-dual active set method, which for an M-matrix is Howard's policy iteration and ends after finitely many
  steps (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Bokanowski, Maroso, Zidani, SIAM J. Numer. Anal. 47
  (2009) 3001). Vertices with neither pressure nor source (a film at rest) count as active, so that a film at rest has
  the tangent of the whole film: the sum of what a motion and its opposite meet (a concentric journal meets half of it).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.ldl import (
    Workspace,
    assemble_band,
    factor_band,
    first_changed_row,
    number_cells,
    solve_many,
    solve_one,
)
from exudyn_ehd.film.banded.tiles import solve_in_tiles
from exudyn_ehd.status import InputError, Status, require_number

MAX_ACTIVE_SET_STEPS = 200
# A vertex leaves the film if its pressure is below the cavity's by more than this share of the peak: about 100 roundings.
ACTIVE_SET_TOLERANCE = 1e-13


@dataclass(frozen=True, kw_only=True)
class FullSommerfeld:
    """No cavitation: the film carries tension. For comparison with closed forms and for fully flooded, pressurised films."""

    cavity_pressure = -np.inf
    cavity_shear = 1.0
    conserves_mass = False
    clips = False

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Solve on all free vertices."""
        np.logical_not(system.fixed, out=work.active)
        return _solve_linear(system, work)

    def adjoint(self, system: FilmSystem, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every row of rhs (k, count), in place."""
        solve_symmetric(work, rhs)

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every column of tiles rhs, in place."""
        solve_in_tiles(work.band, work.band, work.inv_diag, True, work.count, work.width, rhs)

    def direct(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the system of the last solution for rhs (count,), in place."""
        solve_one(work.band, work.inv_diag, work.count, work.width, rhs)


@dataclass(frozen=True, kw_only=True)
class Gumbel:
    """Half-Sommerfeld (Guembel) condition: solve the linear film, then cut off what lies below the cavity pressure.

    Violates mass conservation at the rupture line; load 15 % low against `SwiftStieber` at eccentricity ratio 0.8. It is the
    paper's condition.

    Parameters
    ----------
    cavity_pressure : float
        Gauge pressure of the cavity, Pa.
    cavity_shear : float
        Share of the full film's Couette shear that the ruptured part transmits, 0 to 1.
    """

    cavity_pressure: float = 0.0
    cavity_shear: float = 1.0

    conserves_mass = False
    clips = True

    def __post_init__(self) -> None:
        _check_closure(self)

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Solve on all free vertices, then clip into ``system.pressure``; ``work.active`` marks the unbroken film."""
        np.logical_not(system.fixed, out=work.active)
        outcome = _solve_linear(system, work)
        clip_pressure(system.linear_pressure, system.fixed, system.cavity_pressure, system.pressure, work.active)
        return outcome

    def adjoint(self, system: FilmSystem, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every row of rhs (k, count), in place."""
        solve_symmetric(work, rhs)

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every column of tiles rhs, in place."""
        solve_in_tiles(work.band, work.band, work.inv_diag, True, work.count, work.width, rhs)

    def direct(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the system of the last solution for rhs (count,), in place."""
        solve_one(work.band, work.inv_diag, work.count, work.width, rhs)


@dataclass(frozen=True, kw_only=True)
class SwiftStieber:
    """Swift-Stieber (Reynolds) condition: pressure and its gradient vanish at the rupture line.

    The standard closure for steadily loaded bearings, and cheaper than `Gumbel` here because only the unbroken film is
    factored.

    Parameters
    ----------
    cavity_pressure : float
        Gauge pressure of the cavity, Pa.
    cavity_shear : float
        Share of the full film's Couette shear that the ruptured part transmits, 0 to 1.
    """

    cavity_pressure: float = 0.0
    cavity_shear: float = 1.0

    conserves_mass = False
    clips = False

    def __post_init__(self) -> None:
        _check_closure(self)

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]:
        """Primal-dual active set from ``work.active``, or from all free vertices if ``work.warm`` is False."""
        if not work.warm:
            np.logical_not(system.fixed, out=work.active)
        ok, steps, count, width = solve_active_set(
            system.kx, system.kz, system.b, system.fixed, system.cavity_pressure, work.active, work.order,
            work.old_order, work.number, work.band, work.inv_diag, work.unknowns, system.pressure,
        )  # fmt: skip
        work.count, work.width, work.warm = count, width, ok
        return (Status.CONVERGED if ok else Status.NOT_CONVERGED), steps

    def adjoint(self, system: FilmSystem, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every row of rhs (k, count), in place."""
        solve_symmetric(work, rhs)

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the (symmetric) transposed system for every column of tiles rhs, in place."""
        solve_in_tiles(work.band, work.band, work.inv_diag, True, work.count, work.width, rhs)

    def direct(self, work: Workspace, rhs: np.ndarray) -> None:
        """Solve the system of the last solution for rhs (count,), in place."""
        solve_one(work.band, work.inv_diag, work.count, work.width, rhs)


def solve_symmetric(work: Workspace, rhs: np.ndarray) -> None:
    """Solve with the stored symmetric factor for every row of rhs (k, count), in place."""
    solve_many(work.band, work.inv_diag, work.count, work.width, rhs)


def _check_closure(closure: Gumbel | SwiftStieber) -> None:
    name = type(closure).__name__
    require_number(f"{name}.cavity_pressure", closure.cavity_pressure, "Pa")
    if require_number(f"{name}.cavity_shear", closure.cavity_shear, at_least=0.0) > 1.0:
        raise InputError(f"{name}.cavity_shear must be within 0 and 1, got {closure.cavity_shear!r}; it is a share.")


class FilmSystem:
    """One film problem and its solution, as arrays that closures read and write.

    Attributes
    ----------
    kx, kz, b : (n, m) arrays
        Link conductances and right-hand side.
    fixed : (n, m) bool array
        Vertices whose entry of ``pressure`` is prescribed.
    cavity_pressure : float
        Scaled.
    pressure : (n, m) array
        In: prescribed values at fixed vertices. Out: the film's pressure.
    linear_pressure : (n, m) array
        Pressure before clipping, on which the adjoint is taken; the same array as ``pressure`` unless the closure clips.
    fx, fz, H, H_t, area : (n, m) arrays
        Couette fluxes of a full film, gap, its rate, control volumes; ``b`` already holds the fluxes and the squeeze.
    fill, mass_old : (n, m) arrays
        Film fraction, and the old value of fill H; only used by closures that conserve mass.
    inverse_step : float
        1 / time step since ``mass_old``, 1/s; 0: steady.
    """

    def __init__(self, shape: tuple[int, int], fixed: np.ndarray, area: np.ndarray, clips: bool, fills: bool) -> None:
        self.kx = np.zeros(shape)
        self.kz = np.zeros(shape)
        self.b = np.zeros(shape)
        self.fixed = fixed
        self.cavity_pressure = 0.0
        self.pressure = np.zeros(shape)
        self.linear_pressure = np.zeros(shape) if clips else self.pressure
        self.fx, self.fz = np.zeros(shape), np.zeros(shape)
        self.H, self.H_t = np.ones(shape), np.zeros(shape)
        self.area = area
        self.inverse_step = 0.0
        empty = np.ones(shape) if fills else np.ones((0, 0))
        self.fill, self.mass_old = empty, empty.copy()


def _solve_linear(system: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve on ``work.active`` into ``system.linear_pressure``."""
    ok, count, width = solve_on_active(
        system.kx, system.kz, system.b, work.active, work.order, work.old_order, 0, 0, work.number, work.band,
        work.inv_diag, work.unknowns, system.linear_pressure,
    )  # fmt: skip
    work.count, work.width = count, width
    return (Status.CONVERGED if ok else Status.NOT_CONVERGED), 1


@njit(cache=True)
def gather_rhs(kx, kz, b, active, order, count, P, rhs_out):
    """Right-hand side of the active vertices, with the known pressures of inactive neighbours moved over."""
    n, m = b.shape
    i = 0
    for r in range(count):
        j = order[r] - i * m
        if j < 0 or j >= m:  # rows of a column follow each other: one division per column
            i = order[r] // m
            j = order[r] - i * m
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        s = b[i, j]
        if not active[prv, j]:
            s += kx[prv, j] * P[prv, j]
        if not active[nxt, j]:
            s += kx[i, j] * P[nxt, j]
        if j > 0 and not active[i, j - 1]:
            s += kz[i, j - 1] * P[i, j - 1]
        if j + 1 < m and not active[i, j + 1]:
            s += kz[i, j] * P[i, j + 1]
        rhs_out[r] = s


@njit(cache=True)
def solve_on_active(kx, kz, b, active, order, old_order, old_count, old_width, number, band, inv_diag, unknowns, P):
    """Factor and solve on the active vertices; P holds the known pressures elsewhere. Returns (ok, count, width).

    ``old_order``, ``old_count`` and ``old_width`` describe the factor in ``band`` if it belongs to the same coefficients; only the
    rows behind the first change are then factored again. ``old_count`` = 0: there is none.
    """
    count, width = number_cells(active, kx, order, number)
    # another bandwidth splits the loops over a row elsewhere, and so rounds differently: start over
    first = first_changed_row(order, old_order, old_count, count, width) if width == old_width else 0
    assemble_band(kx, kz, number, order, count, width, first, band)
    if not factor_band(band, count, width, first, inv_diag):
        return False, count, width
    gather_rhs(kx, kz, b, active, order, count, P, unknowns)
    solve_one(band, inv_diag, count, width, unknowns)
    flat = P.reshape(-1)
    for r in range(count):
        flat[order[r]] = unknowns[r]
    return True, count, width


@njit(cache=True)
def update_active_set(kx, kz, b, fixed, pc, active, P):
    """One policy step from the pressures of the last one: who leaves, who joins; returns the number of changes.

    An active vertex leaves if its pressure is below pc; another one joins if its residual at pc is not positive. Inactive
    pressures are then set to pc.
    """
    n, m = b.shape
    peak = 0.0
    for i in range(n):
        for j in range(m):
            peak = max(peak, abs(P[i, j] - pc))
    floor = pc - ACTIVE_SET_TOLERANCE * peak
    changes = 0
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if active[i, j]:
                if P[i, j] < floor:
                    active[i, j] = False
                    changes += 1
            elif not fixed[i, j]:
                r = kx[i, j] * (pc - P[nxt, j]) + kx[prv, j] * (pc - P[prv, j]) - b[i, j]
                if j > 0:
                    r += kz[i, j - 1] * (pc - P[i, j - 1])
                if j + 1 < m:
                    r += kz[i, j] * (pc - P[i, j + 1])
                if r <= 0.0:
                    active[i, j] = True
                    changes += 1
    for i in range(n):
        for j in range(m):
            if not active[i, j] and not fixed[i, j]:
                P[i, j] = pc
    return changes


@njit(cache=True)
def solve_active_set(kx, kz, b, fixed, pc, active, order, old_order, number, band, inv_diag, unknowns, P):
    """Swift-Stieber film; returns (ok, steps, count, width). ``active`` is the start and, on return, the result."""
    n, m = b.shape
    for i in range(n):
        for j in range(m):
            if fixed[i, j]:
                active[i, j] = False
            elif not active[i, j]:
                P[i, j] = pc
    count = 0
    width = 1
    for step in range(MAX_ACTIVE_SET_STEPS):
        old_count, old_width = count, width
        for r in range(old_count):
            old_order[r] = order[r]
        ok, count, width = solve_on_active(
            kx, kz, b, active, order, old_order, old_count, old_width, number, band, inv_diag, unknowns, P
        )
        if not ok:
            return False, step + 1, count, width
        if update_active_set(kx, kz, b, fixed, pc, active, P) == 0:
            for i in range(n):
                for j in range(m):
                    if active[i, j] and P[i, j] < pc:
                        P[i, j] = pc
            return True, step + 1, count, width
    return False, MAX_ACTIVE_SET_STEPS, count, width


@njit(cache=True)
def clip_pressure(linear, fixed, pc, P_out, active_out):
    """Gumbel: P = max(linear, pc) at free vertices; active marks where nothing was cut."""
    n, m = linear.shape
    for i in range(n):
        for j in range(m):
            if fixed[i, j]:
                P_out[i, j] = linear[i, j]
                active_out[i, j] = False
            elif linear[i, j] >= pc:
                P_out[i, j] = linear[i, j]
                active_out[i, j] = True
            else:
                P_out[i, j] = pc
                active_out[i, j] = False
