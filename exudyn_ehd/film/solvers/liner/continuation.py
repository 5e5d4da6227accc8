"""Where a film starts that can't go on from the last one; see `exudyn_ehd.film.solvers.nonlinear`.

First Newton's method from a dry guess; if that fails, pseudo time: a storage of
its own, added to every vertex, holds the film back and is taken away step by step.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.solvers.liner.balance import LinerBalance
from exudyn_ehd.film.solvers.newton import newton

MAX_PSEUDO_STEPS = 200
# Smallest gap of a dry guess, and the share of an oil's largest pressure that it may take at leisure.
OPEN, MODERATE = 0.01, 0.1
# Gap below which a dry guess opens the liner: a tenth of the clearance.
THIN = 0.1
# Pseudo rates over those of the film: of the first storage, of one that no film comes out of, and of one that is none.
FIRST, HOPELESS, LAST = 100.0, 1e6, 1e-3


def cold_start(film: LinerBalance) -> tuple[bool, int]:
    """Newton's method from a dry guess: (found, steps); a film that keeps its mass from one that ruptures without."""
    work = film.film.work
    work.warm = False
    _dry_guess(film)
    if not film.fills:
        return film.solve()
    film.fills = False
    ok, steps = newton(film)
    film.fills, film.reusable = True, False
    if not ok:
        return False, steps
    film.all_full(np.logical_or(work.active, film.film.grid.fixed))
    ok, more = film.solve()
    return ok, steps + more


def _dry_guess(film: LinerBalance) -> None:
    """Pressure that would keep a thin film open: half the gap's mean where the
    undeformed surfaces come closer than that."""
    H0 = film.rigid[0]
    guess = np.zeros(H0.shape)
    if film.contact is None and H0.min() < THIN:
        guess = np.maximum((THIN - H0) / film.beta, 0.0)
    if film.oil is not None:
        guess = _transformed(film, film.oil, guess)
    free = ~film.film.grid.fixed
    lowest = film.film.system.cavity_pressure if film.film.ruptures else 0.0
    film.u.P[free] = np.maximum(guess, lowest)[free]


def _transformed(film: LinerBalance, oil: PressureLaw, guess: np.ndarray) -> np.ndarray:
    """Unknowns of guessed pressures (n, m), which thicken the oil no more than they need to open the gap."""
    touching = np.maximum((OPEN - film.rigid[0]) / film.beta, 0.0)
    p = np.minimum(guess, np.maximum(touching, MODERATE * oil.largest_pressure / film.scale))
    return oil.transform(np.minimum(p * film.scale, oil.largest_pressure)) / film.scale


def pseudo_transient(film: LinerBalance) -> tuple[bool, int]:
    """Implicit steps of a storage of its own towards the target, from short to long; the last one is the target itself.

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
    extra, total = FIRST * rate, 0
    start = _copy(film)
    film.settle(film.u.P)
    for _ in range(MAX_PSEUDO_STEPS):
        film.rates = rates._replace(pseudo=extra)
        film.pseudo_old[:] = _stored(film, start)
        ok, steps = film.solve()
        film.rates, film.reusable = rates, False
        total += steps
        if ok:
            work.warm = True
            start = _copy(film)
            extra *= 0.3
            if extra >= LAST * rate:
                continue
            ok, steps = film.solve()
            total += steps
            if ok:
                return True, total
        else:
            extra *= 8.0
            if extra > HOPELESS * rate:
                return False, total
        for field, old in zip(film.u, start, strict=True):
            field[:] = old
        film.settle(film.u.P)
    return False, total


def _copy(film: LinerBalance) -> tuple[np.ndarray, ...]:
    return tuple(field.copy() for field in film.u)


def _stored(film: LinerBalance, start: tuple[np.ndarray, ...]) -> np.ndarray:
    """What pseudo time counts of the settled elements under the state at hand:
    mass, or the deflection by what presses, cut off or not."""
    P, fill, _ = start
    if not film.fills:
        return film.beta * (film.load.p + (P - film.load.drive))
    return fill * film.gaps.H if film.rho is None else film.rho * fill * film.gaps.H
