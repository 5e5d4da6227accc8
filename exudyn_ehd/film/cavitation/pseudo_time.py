"""Pseudo-transient continuation for a film that Newton's method does not find from its initial guess.

An additional storage at every vertex slows the film down and is reduced step by step; the last solution has none.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.solve import base_of, solve_system
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.reynolds.balance import store_content
from exudyn_ehd.status import Status

MOST_STEPS = 200
# Rates of the storage over that of the film: of the first one, of one above which the continuation ends, and of one
# below which the film without storage is tried.
FIRST, HOPELESS, LAST = 100.0, 1e6, 1e-3
# Factors of the storage after a film that is found, and after one that is not.
FADES, GROWS = 0.3, 8.0
# Share of its compressibility with which an oil counts as nearly incompressible.
SOFTEST = 1e-9
# ``first`` and ``least`` of `pseudo_time` for `follow`, whose rate is the largest flow into a vertex over the smallest
# area.
FIRST_RATE, LAST_RATE = 0.01, 1e-7


def pseudo_time(
    attempt: Callable[[float], tuple[bool, int]], rate: float, first: float = FIRST, *, least: float = 0.0
) -> tuple[bool, int]:
    """Find a film by pseudo-transient continuation; returns (found, Newton steps).

    Parameters
    ----------
    attempt : function of a rate, 1/s
        Solves with a storage of that rate, 0 for the film itself, and keeps a film that is found as the start of the
        next; returns (found, Newton steps).
    rate : float
        Rate of the film itself, 1/s, > 0.
    first : float
        Rate of the first storage over ``rate``.
    least : float
        Rate over ``rate`` of the smallest storage from which the film without one is tried.
    """
    extra, total = first * rate, 0
    for _ in range(MOST_STEPS):
        ok, steps = attempt(extra)
        total += steps
        if not ok:
            extra *= GROWS
            if extra > HOPELESS * rate:
                return False, total
            continue
        extra *= FADES
        if extra < LAST * rate:
            ok, steps = attempt(0.0)
            total += steps
            if ok:
                return True, total
            if extra < least * rate:
                return False, total
    return False, total


def recover(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Find a film that Newton's method does not find from a full one; returns (status, Newton steps).

    Where the density follows the pressure, Newton's method starts from the film of a nearly incompressible oil. If it
    fails and pressures reach the end of the law's range, the status is NO_PRESSURE. A film that is still not found is
    followed in pseudo time.
    """
    density, steps = s.density, 0
    if density is not None:
        work.warm = False
        scale, density.scale = density.scale, SOFTEST * density.scale
        ok, steps = solve_system(s, work)
        density.scale = scale
        beyond = ok and density.is_exhausted(s.linear_pressure)
        for crosses in (True, False) if ok else ():
            # the iteration oscillates about the end of the law, unless its steps stop there
            work.warm, density.crosses = True, crosses
            ok, count = solve_system(s, work)
            steps += count
            if ok:
                break
        density.crosses = False
        if ok or beyond or density.is_exhausted(s.linear_pressure):
            return (Status.CONVERGED if ok else Status.NO_PRESSURE), steps
    status, count = follow(s, work)
    return status, steps + count


def follow(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Follow a film in pseudo time from a full one; returns (status, Newton steps). The status is NO_OIL if rows run
    dry on the way."""
    largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
    largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - base_of(s)), initial=0.0))
    rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
    mass = (s.mass_old if s.inverse_step > 0.0 else s.H).copy()
    work.warm = runs_dry = False

    def attempt(extra: float) -> tuple[bool, int]:
        nonlocal runs_dry
        inverse = s.inverse_step + extra
        blend = (s.inverse_step * s.mass_old + extra * mass) / inverse if inverse > 0.0 else s.mass_old
        # in a steady film the gap's rate is kept: extra (fill H - mass) + fill dH/dt
        H = s.H + s.H_t / extra if s.inverse_step == 0.0 < extra else s.H
        store_content(s.term_fields, H, s.H_t, inverse, blend, s.instant)
        ok, steps = solve_system(s, work)
        if ok:
            np.multiply(s.fill, s.H, out=mass)
            if s.density is not None:
                np.multiply(mass, s.density.rho, out=mass)
            runs_dry = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
        return ok, steps

    ok, steps = pseudo_time(attempt, rate if rate > 0.0 else 1.0, FIRST_RATE, least=LAST_RATE)
    if ok:
        return Status.CONVERGED, steps
    return (Status.NO_OIL if runs_dry and not s.H_t.any() else Status.NOT_CONVERGED), steps
