"""Where a film on columns starts that can't go on from the last one; see `exudyn_ehd.film.solvers.compliant`.

First Newton's method from a dry guess; if that fails, pseudo time: a storage of its own, added to every vertex, holds the film back and is
taken away step by step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.solvers.compliant_iteration import newton
from exudyn_ehd.film.solvers.liner_newton import FULL

if TYPE_CHECKING:
    from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver
    from exudyn_ehd.film.solvers.compliant_parts import ColumnOil

MAX_PSEUDO_STEPS = 200
# Smallest gap of a dry guess, and the share of an oil's largest pressure that it may take at leisure.
OPEN, MODERATE = 0.01, 0.1


def cold_start(solver: CompliantFilmSolver, P: np.ndarray) -> tuple[bool, int]:
    """Newton's method from a dry guess, into P: (found, steps); a film that keeps its mass from one that ruptures without."""
    solver.work.warm = False
    _dry_guess(solver, P)
    if not solver.closure.conserves_mass:
        return solver.target(P)
    ok, steps = newton(solver, P, solver.ones, False, 0.0, solver.nothing)
    if not ok:
        return False, steps
    _all_full(solver, np.logical_or(solver.work.active, solver.grid.fixed))
    ok, more = solver.target(P)
    return ok, steps + more


def _all_full(solver: CompliantFilmSolver, full: np.ndarray) -> None:
    """Full vertices (n, m) of a film without cavitated oil."""
    solver.full[:] = full
    np.logical_and(full, ~solver.grid.fixed, out=solver.work.active)
    solver.film_fill[:] = 1.0


def _dry_guess(solver: CompliantFilmSolver, P: np.ndarray) -> None:
    """Pressure that would keep a thin film open: half the gap's mean where the undeformed surfaces come closer than that."""
    H0 = solver.rigid[0]
    film = 0.1
    guess = np.zeros(H0.shape)
    if solver.contact is None and H0.min() < film:
        guess = np.maximum((film - H0) / solver.beta, 0.0)
    if solver.oil is not None:
        guess = _transformed(solver, solver.oil, guess)
    free = ~solver.grid.fixed
    lowest = solver.system.cavity_pressure if solver.kind != FULL else 0.0
    P[free] = np.maximum(guess, lowest)[free]


def _transformed(solver: CompliantFilmSolver, oil: ColumnOil, guess: np.ndarray) -> np.ndarray:
    """Unknowns of guessed pressures (n, m), which thicken the oil no more than they need to open the gap."""
    scale = solver.pressure_scale
    touching = np.maximum((OPEN - solver.rigid[0]) / solver.beta, 0.0)
    p = np.minimum(guess, np.maximum(touching, MODERATE * oil.largest_pressure / scale))
    return oil.transform(np.minimum(p * scale, oil.largest_pressure)) / scale


def pseudo_transient(solver: CompliantFilmSolver, P: np.ndarray) -> tuple[bool, int]:
    """Implicit steps of a storage of its own towards the target, from short to long; the last one is the target itself.

    The film stands in P; returns (found, Newton steps).
    """
    conserves, fill = solver.closure.conserves_mass, solver.film_fill
    solver.work.warm = False
    _dry_guess(solver, P)
    if conserves:
        _all_full(solver, np.ones(solver.grid.shape, dtype=np.bool_))
    rate = (
        abs(solver.vx)
        + abs(solver.vz)
        + float(np.max(np.abs(solver.rigid[2])))
        + solver.inverse
        + solver.mass_inverse
        + 1e-300
    )
    extra, total = 100.0 * rate, 0
    start, start_fill, start_full = P.copy(), fill.copy(), solver.full.copy()
    solver.settle(P)
    for _ in range(MAX_PSEUDO_STEPS):
        old = start_fill * solver.columns.H if conserves else solver.push(start)
        ok, steps = newton(solver, P, fill, conserves, extra, old)
        total += steps
        if not ok:
            P[:], fill[:], solver.full[:] = start, start_fill, start_full
            solver.settle(P)
            extra *= 8.0
            if extra > 1e6 * rate:
                return False, total
            continue
        solver.work.warm = True
        start[:], start_fill[:], start_full[:] = P, fill, solver.full
        extra *= 0.3
        if extra < 1e-3 * rate:
            ok, steps = solver.target(P)
            total += steps
            if ok:
                return True, total
            P[:], fill[:], solver.full[:] = start, start_fill, start_full
            solver.settle(P)
    return False, total
