"""Where a film starts that can't go on from the last one; see `exudyn_ehd.film.solvers.nonlinear`.

First Newton's method from a dry guess; if that fails, pseudo time: a storage of
its own, added to every vertex, holds the film back and is taken away step by step.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from exudyn_ehd.film.cavitation.pseudo_time import pseudo_time
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.solvers.liner.balance import LinerBalance
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.liner.newton import newton, solve, solve_with

# Smallest gap of a dry guess, and the share of an oil's largest pressure that it may take at leisure.
OPEN, MODERATE = 0.01, 0.1
# Gap below which a dry guess opens the liner: a tenth of the clearance.
THIN = 0.1


def cold_start(film: LinerBalance) -> tuple[bool, int]:
    """Newton's method from a dry guess: (found, steps); a film that keeps its mass from one that ruptures without."""
    work = film.film.work
    work.warm = False
    _dry_guess(film)
    if not film.fills:
        return solve(film)
    film.fills = False
    ok, steps = newton(film)
    film.fills, film.reusable = True, False
    if not ok:
        return False, steps
    film.all_full(np.logical_or(work.active, film.film.grid.fixed))
    ok, more = solve(film)
    return ok, steps + more


def _dry_guess(film: LinerBalance) -> None:
    """Pressure that would keep a thin film open: half the gap's mean where the
    undeformed surfaces come closer than that; of a film at rest no more than the largest prescribed one."""
    H0 = film.rigid[0]
    guess = np.zeros(H0.shape)
    if film.contact is None and H0.min() < THIN and film.beta > 0.0:
        guess = np.maximum((THIN - H0) / film.beta, 0.0)
    if film.oil is not None and film.beta > 0.0:
        guess = _transformed(film, film.oil, guess)
    fixed = film.film.grid.fixed
    if _at_rest(film):
        guess = np.minimum(guess, film.u.P[fixed].max(initial=0.0))
    lowest = film.film.system.cavity_pressure if film.film.ruptures else 0.0
    film.u.P[~fixed] = np.maximum(guess, lowest)[~fixed]


def _at_rest(film: LinerBalance) -> bool:
    """Whether nothing moves: the pressure then lies between the prescribed ones."""
    still = film.film.vx == film.film.vz == film.rates.liner == film.rates.mass == 0.0
    return still and not film.rigid[2].any()


def _transformed(film: LinerBalance, oil: PressureLaw, guess: np.ndarray) -> np.ndarray:
    """Unknowns of guessed pressures (n, m), which thicken the oil no more than they need to open the gap."""
    touching = np.maximum((OPEN - film.rigid[0]) / film.beta, 0.0)
    p = np.minimum(guess, np.maximum(touching, MODERATE * oil.largest_pressure / film.scale))
    return oil.transform(np.minimum(p * film.scale, oil.largest_pressure)) / film.scale


def pseudo_transient(film: LinerBalance) -> tuple[bool, int]:
    """Implicit steps of a storage of its own towards the target, from short to long; the last one is the target itself.

    A film with its line inside the cells follows the one on the vertices, in the same way if it has to.

    Returns (found, Newton steps).
    """
    work, rates = film.film.work, film.rates
    work.warm = False
    _dry_guess(film)
    if film.fills:
        film.all_full(np.ones(film.u.full.shape, dtype=np.bool_))
    rate = (
        abs(film.film.vx) + abs(film.film.vz) + float(np.max(np.abs(film.rigid[2]))) + rates.liner + rates.mass + 1e-300
    )
    start = tuple(field.copy() for field in film.u)
    film.update_elements(film.u.P)

    def attempt(extra: float, line: FilmLine | None = None) -> tuple[bool, int]:
        film.rates = rates._replace(pseudo=extra)
        film.pseudo_old[:] = _stored(film, start)
        ok, steps = solve_with(film, line)
        film.rates, film.reusable = rates, film.reusable and extra == 0.0
        work.warm = work.warm or ok
        taken, given = (start, film.u) if ok else (film.u, start)
        for field, other in zip(taken, given, strict=True):
            field[:] = other
        if not ok:
            film.update_elements(film.u.P)
        return ok, steps

    ok, steps = pseudo_time(attempt, rate)
    if not ok or film.line is None:
        return ok, steps
    to_line = partial(attempt, line=film.line)
    ok, more = to_line(0.0)
    steps += more
    if not ok:
        ok, more = pseudo_time(to_line, rate)
    return ok, steps + more


def _stored(film: LinerBalance, start: tuple[np.ndarray, ...]) -> np.ndarray:
    """What pseudo time counts of the elements at the present state: mass, or the
    deflection by film and contact pressure, cut off or not."""
    P, fill, _ = start
    if not film.fills:
        return film.beta * (film.load.p + (P - film.load.drive))
    return fill * film.gaps.H if film.rho is None else film.rho * fill * film.gaps.H
