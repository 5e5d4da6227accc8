"""Solution of a film whose gaps and conductances do not follow its pressure, by the method that its closure requires.

At constant density, a film that does not rupture, or whose pressures are clipped afterwards, is linear. All others are
solved by Newton's method of `exudyn_ehd.film.solvers.newton`.

If Newton's method fails from the initial guess, pseudo-transient continuation follows. An additional storage at every
vertex slows the film down and is reduced step by step; the last solution has none.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.closures import FilmSystem, has_unfed_row
from exudyn_ehd.film.cavitation.linear_film import clip_pressure, extend_film, mean_in_cells, solve_linear
from exudyn_ehd.film.cavitation.states import CLIPPED, OIL, RUPTURE
from exudyn_ehd.film.reynolds.balance import store_content
from exudyn_ehd.film.solvers.matrix import factor_film
from exudyn_ehd.film.solvers.newton import solve_film, solve_rupturing
from exudyn_ehd.status import ROUNDING, Status

MOST_STEPS = 200
# Rates of the additional storage, over the rate of the film: first rate; rate above which the continuation fails; rate
# below which the film without additional storage is tried; rate below which its failure ends the continuation. A larger
# first rate, or smaller last ones, are more robust and cost more steps.
FIRST_RATE, LARGEST_RATE, TRIAL_RATE, SMALLEST_RATE = 100.0, 1e6, 1e-3, 1e-7
# Factors on the storage's rate after a film that is solved, and after a failure. A smaller first one risks failures, a
# larger one costs steps.
RATE_REDUCTION, RATE_GROWTH = 0.3, 8.0


def pseudo_time(attempt: Callable[[float], tuple[bool, int]], rate: float) -> tuple[bool, int]:
    """Solve a film by pseudo-transient continuation; returns (found, Newton steps).

    Parameters
    ----------
    attempt : function of a rate, 1/s
        Solves with an additional storage of that rate, 0: none; returns (found, Newton steps). A solved film is the
        initial guess of the next call.
    rate : float
        Rate of the film itself, 1/s, > 0.
    """
    extra, total = FIRST_RATE * rate, 0
    for _ in range(MOST_STEPS):
        ok, steps = attempt(extra)
        total += steps
        if not ok:
            extra *= RATE_GROWTH
            if extra > LARGEST_RATE * rate:
                return False, total
            continue
        extra *= RATE_REDUCTION
        if extra < TRIAL_RATE * rate:
            ok, steps = attempt(0.0)
            total += steps
            if ok:
                return True, total
            if extra < SMALLEST_RATE * rate:
                return False, total
    return False, total


def recover(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film for which Newton's method fails from a full film; returns (status, Newton steps).

    Where the density follows the pressure, Newton's method starts again from the film of a nearly incompressible oil.
    If it fails and pressures reach the end of the law's range, the status is NO_PRESSURE. In all other cases of failure
    pseudo-transient continuation follows.
    """
    density, steps = s.density, 0
    if density is not None:
        work.warm = False
        # nearly incompressible, so that the film is linear
        scale, density.scale = density.scale, ROUNDING * density.scale
        ok, steps = solve_system(s, work)
        density.scale = scale
        beyond = ok and density.is_exhausted(s.linear_pressure)
        for crosses in (True, False) if ok else ():
            # first let steps cross the end of the law, then end them there, as the iteration may oscillate about it
            work.warm, density.crosses = True, crosses
            ok, count = solve_system(s, work)
            steps += count
            if ok:
                break
        density.crosses = False
        if ok or beyond or density.is_exhausted(s.linear_pressure):
            return (Status.CONVERGED if ok else Status.NO_PRESSURE), steps
    status, count = solve_in_pseudo_time(s, work)
    return status, steps + count


def solve_in_pseudo_time(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film by pseudo-transient continuation from a full film; returns (status, Newton steps).

    If it fails, the status is NO_OIL for a film without rates in which a row has run dry.
    """
    largest = max(float(np.max(np.abs(s.fx))), float(np.max(np.abs(s.fz))), float(np.max(np.abs(s.H_t * s.area))))
    largest += float(np.max(s.kx) * np.max(np.abs(s.pressure[s.fixed] - s.base), initial=0.0))
    rate = largest / float(np.min(s.area[s.area > 0.0])) + s.inverse_step
    mass = (s.mass_old if s.inverse_step > 0.0 else s.H).copy()
    work.warm = runs_dry = False

    def attempt(extra: float) -> tuple[bool, int]:
        nonlocal runs_dry
        inverse = s.inverse_step + extra
        blend = (s.inverse_step * s.mass_old + extra * mass) / inverse if inverse > 0.0 else s.mass_old
        # in a steady film the gap's rate is kept: extra (fill H - mass) + fill dH/dt
        H = s.H + s.H_t / extra if s.inverse_step == 0.0 < extra else s.H
        store_content(s.fields, H, s.H_t, inverse, blend, s.instant)
        ok, steps = solve_system(s, work)
        if ok:
            np.multiply(s.fill, s.H, out=mass)
            if s.density is not None:
                np.multiply(mass, s.density.rho, out=mass)
            runs_dry = has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure)
        return ok, steps

    ok, steps = pseudo_time(attempt, rate if rate > 0.0 else 1.0)
    if ok:
        return Status.CONVERGED, steps
    return (Status.NO_OIL if runs_dry and not s.H_t.any() else Status.NOT_CONVERGED), steps


def _states_of(s: FilmSystem, work: Workspace) -> tuple[np.ndarray | None, ...]:
    """Return the argument ``state`` of `solve_film`."""
    return work.u, work.above, s.fill if s.kind == OIL else None


def solve_system(s: FilmSystem, work: Workspace) -> tuple[bool, int]:
    """Solve by Newton's method, from the last film if ``work.warm``, else from a full film; returns (found, steps)."""
    s.terms.late[:] = s.late
    ok, steps = work.take_end(
        *solve_film(
            s.kind, s.base, work.warm, work.size, work.active, _states_of(s, work), *_film_of(s, work),
            (s.linear_pressure, work.residual, work.unknowns, None), None,
        )
    )  # fmt: skip
    work.warm = ok
    return ok, steps


def factor_solution(s: FilmSystem, work: Workspace) -> None:
    """Refactor Newton's matrix at the last solution of a film that is not linear."""
    oil, _, film, feedback, matrix = _film_of(s, work)
    full = work.active if s.kind >= RUPTURE else ~s.fixed
    rest = oil, film, feedback, None, matrix, full, (False, work.count, work.width)
    _, work.count, work.width = factor_film(s.kind, s.linear_pressure, *rest)


def _film_of(s: FilmSystem, work: Workspace) -> tuple[object, ...]:
    """Return the arguments from ``oil`` to ``matrix`` of `solve_film`."""
    fill, rho = s.fill if s.kind == OIL else None, s.density
    oil = (fill, None, None) if rho is None else (fill, rho.rho, rho.rho_P)
    matrix = work.symmetric if s.kind != OIL and rho is None else work.matrix
    return oil, None if rho is None else rho.fields(s.floor), s.film, None, matrix


def solve_sets(system: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film whose gaps and conductances do not follow its pressure, from the last film if ``work.warm``, else
    from a full film; returns (status, linear solves)."""
    s = system
    if s.kind == OIL or s.density is not None:
        outcome = _solve_by_newton(s, work)
    elif s.kind == RUPTURE:
        outcome = _solve_rupturing(s, work)
    else:
        outcome = _solve_linear(s, work)
    if s.kind == CLIPPED:
        linear, pc = s.linear_pressure, s.cavity_pressure
        clip_pressure(linear, s.fixed, pc, s.pressure, work.active)
        if s.continued is not None:
            mean_in_cells(linear, s.fixed, s.linked, pc, work.active, s.pressure)
    return outcome


def _solve_linear(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve the linear film of all vertices that are not prescribed."""
    np.logical_not(s.fixed, out=work.active)
    links, P = (s.kx, s.kz, s.b), s.linear_pressure
    ok, work.count, work.width = solve_linear(links, work.active, work.symmetric, work.unknowns, P)
    work.exact = ok
    return (Status.CONVERGED if ok else Status.NOT_CONVERGED), 1


def _solve_rupturing(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film of Swift and Stieber; continue its pressures beyond a rupture line between columns, if there is
    one."""
    pc, places = s.cavity_pressure, (s.pressure, work.residual, work.unknowns, None)
    rest = work.active, _states_of(s, work), s.film, work.symmetric, places
    ok, steps = work.take_end(*solve_rupturing(work.size, pc, s.line is not None, work.warm, s.H_t, *rest))
    work.warm = ok
    if s.column_line is not None:
        # the factor has additional rows and cannot be reused for chord steps
        size, work.ready, work.exact = (work.count, work.width), False, ok
        work.count = extend_film(s.column_line, s.b, (s.fixed, work.active), pc, work.symmetric, size, s.pressure)
    return (Status.CONVERGED if ok else Status.NOT_CONVERGED), steps


def _solve_by_newton(s: FilmSystem, work: Workspace) -> tuple[Status, int]:
    """Solve a film that conserves mass or has a density law by Newton's method; if it fails from a full film, by
    `recover`."""
    was_warm, status = work.warm, Status.CONVERGED
    store_content(s.fields, s.H, s.H_t, s.inverse_step, s.mass_old, s.instant)
    ok, steps = solve_system(s, work)
    if not ok:
        status = Status.NOT_CONVERGED
    elif s.closes and has_unfed_row(s.pressure, s.H, s.fixed, s.turns, s.cavity_pressure):
        ok = False
    if not (ok or was_warm):
        status, count = recover(s, work)
        steps += count
    work.warm = status is Status.CONVERGED
    return status, steps
