"""`newton.newton` compiled as a whole for two films so fast that calls from Python would cost half as much again: one
on a liner without further effects, and one between rigid surfaces whose density follows its pressure."""

import numpy as np
from numba import njit

from exudyn_ehd.film.lubricant.density_field import density_at, density_slope_at
from exudyn_ehd.film.reynolds.balance import film_balance, terms_of, violation
from exudyn_ehd.film.solvers.liner.elements import plain_slopes
from exudyn_ehd.film.solvers.liner.gap_response import link_gradients
from exudyn_ehd.film.solvers.liner.kernels import plain_residual
from exudyn_ehd.film.solvers.liner.line_kernels import is_there, meet_line
from exudyn_ehd.film.solvers.newton import RULE, improves, is_final, pays_again, too_slow
from exudyn_ehd.film.solvers.steps import (
    BALANCED,
    ENDLESS,
    LEAST_DEFLECTION,
    LEAST_PRESSURE,
    ROUNDED,
    ROUNDING,
    SUCTION,
    copy_field,
    factor_film,
    flow_rounding,
    free_all,
    newton_step,
    select,
    take_over,
    take_step,
)

# Pa: a film at rest has no pressures but rounding, and no share of those would ever be small.
SMALLEST_PEAK = 1e-6
# First steps, taken whole; share of the way to the end of the oil's law that a later one covers at most.
WHOLE_STEPS, TO_THE_END = 16, 0.9


@njit(cache=True, inline="always")
def _balance(P, fill, fixed, numbers, kinds, terms, liner, oil, residual, line):
    """Norm of what does not hold, and the smallest gap, at P."""
    norm, gap = _balance_alone(P, fill, fixed, numbers, kinds, terms, liner, oil, residual)
    if is_there(line) and gap > 0.0:
        meet_line(P, numbers[0], terms[0], terms[1], line, residual)
        norm = violation(residual, P, fixed, numbers[0], True)
    return norm, gap


@njit(cache=True, inline="always")
def _balance_alone(P, fill, fixed, numbers, kinds, terms, liner, oil, residual):
    """`_balance` without a line inside the cells."""
    if liner is not None:
        load, rigid, G, delta_old, gaps, _, metric, known, rates, _ = liner
        return plain_residual(
            P, fixed, numbers, kinds, load, rigid, G, delta_old, gaps, metric, terms, known, rates, residual
        )
    if oil is not None:
        scale, floor, law, known, rho, _ = oil
        density_at(P, scale, floor, law, known, rho)
        film_balance(P, fill, rho, terms_of(terms, fixed), residual)
    return violation(residual, P, fixed, numbers[0], kinds[1]), 1.0


@njit(cache=True, inline="always")
def factor(u, fixed, numbers, terms, liner, oil, matrix, active, line):
    """Newton's matrix at u, for the state of the last balance, factored; returns (ok, count, width)."""
    P = u[0]
    if liner is not None:
        load, _, _, _, gaps, gap_slopes, metric, _, rates, by = liner
        _, vx, vz, beta = numbers
        plain_slopes(P, load, beta, rates[1], gap_slopes)
        link_gradients(P, None, None, terms, fixed, gaps, None, metric, vx, vz, by)
        elements = gap_slopes, load, rates, beta, by
        return factor_film(u, (None, None), terms, fixed, elements, matrix, active, None, line)
    if oil is not None:
        scale, floor, law, known, rho, rho_P = oil
        density_slope_at(P, scale, floor, law, known, rho_P)
        return factor_film(u, (rho, rho_P), terms, fixed, None, matrix, active, None, line)
    return False, 0, 0


@njit(cache=True, inline="always")
def _end(oil, step):
    """As for `take_step`."""
    return oil[2].highest / oil[0], TO_THE_END if step > WHOLE_STEPS else np.inf


@njit(cache=True, inline="always")
def _step(step, residual, u, numbers, kinds, gap, liner, oil, factored, count, width, trial, line):
    """As `newton_step`."""
    pc, vx, vz, beta = numbers
    base, slight = pc if pc > -np.inf else 0.0, LEAST_PRESSURE * (abs(vx) + abs(vz))
    if liner is not None:
        opening, elements = gap / beta, (liner[0], liner[4], liner[5])
        levels = (pc, base, max(LEAST_DEFLECTION * opening, slight), opening, ROUNDED * slight)
        end = ENDLESS
        return newton_step(residual, u, elements, end, factored, count, width, kinds, levels, trial, line, step - 1)
    if oil is not None:
        levels = (pc, base, max(SMALLEST_PEAK / oil[0], slight), np.inf, ROUNDED * slight)
        end = _end(oil, step)
        return newton_step(residual, u, None, end, factored, count, width, kinds, levels, trial, line, step - 1)
    return np.inf, np.inf, 0.0, 0.0, 0


@njit(cache=True, inline="always")
def _shorter(step, u, chooses, liner, oil, factored, count, share, pc, tolerance, trial):
    """As `take_step`."""
    if liner is not None:
        return take_step(
            u, (liner[0], liner[4], liner[5]), ENDLESS, factored, count, share, pc, chooses, tolerance, trial
        )
    if oil is not None:
        return take_step(u, None, _end(oil, step), factored, count, share, pc, chooses, tolerance, trial)
    return 0


@njit(cache=True, inline="always")
def _accept(u, trial, residual, fixed, pc, chooses, active, changes):
    """The trial state becomes the present one; returns how many vertices change sides."""
    if chooses:
        return changes + take_over(trial[0], residual, fixed, pc, active, u[0])
    copy_field(trial[0], u[0])
    copy_field(trial[1], u[1])
    copy_field(trial[2], u[2])
    return changes


@njit(cache=True, nogil=True)
def solve(u, trial, fixed, numbers, kinds, terms, rate, liner, oil, matrix, residual, active, start, line):
    """Newton from ``u``, in place; returns (found, steps, exact, count, width).

    Parameters
    ----------
    u, trial : (P, fill, full)
    numbers : (pc, vx, vz, compliance)
    kinds : (clips, whether vertices at pc are no unknowns)
    rate : (n, m) array
        Of the undeformed gap.
    liner : (load, rigid, G, old deflection, gaps, gap slopes, metric, known, rates, by of `link_gradients`) or None
    oil : (scale, floor, law, known, rho, rho_P) of `density_field` or None
    matrix : (slopes, number, factored) of `factor_film`
    active : unknown vertices
    start : (whether a factor is there, whether the sets are, count, width)
    line : that of `line_kernels`
    """
    pc, P, fill = numbers[0], u[0], u[1]
    clips, chooses = kinds
    ready, warm, count, width = start
    norm, gap = _balance(P, fill, fixed, numbers, kinds, terms, liner, oil, residual, line)
    if not gap > 0.0:
        return False, 0, False, count, width
    if not chooses or not warm:
        free_all(fixed, active)
    elif not ready:
        select(P, residual, fixed, pc, active)
    reused = ready
    last = last_left = moved = 0.0
    once = False
    for step in range(1, RULE.most_steps + 1):
        fresh = not ready
        if fresh:
            ok, count, width = factor(u, fixed, numbers, terms, liner, oil, matrix, active, line)
            if not ok:
                return False, step, False, count, width
            moved = 0.0
            if count == 0 or norm == 0.0:
                return True, step, True, count, width
        size, left, peak, share, changes = _step(
            step, residual, u, numbers, kinds, gap, liner, oil, matrix[2], count, width, trial, line
        )
        if not size < 1e300:
            return False, step, False, count, width
        from_last = reused and step == 1
        converged = size <= RULE.converged
        if not (fresh or from_last or converged) and too_slow(size, last):
            ready = False
            continue
        before = norm
        for k in range(1 if from_last else RULE.most_halvings):
            if k > 0:
                share *= 0.5
                changes = _shorter(step, u, chooses, liner, oil, matrix[2], count, share, pc, SUCTION * peak, trial)
            norm, gap = _balance(trial[0], trial[1], fixed, numbers, kinds, terms, liner, oil, residual, line)
            if improves(gap, norm, before, size, changes):
                break
        if from_last and not improves(gap, norm, before, size, changes):
            norm, gap = _balance(P, fill, fixed, numbers, kinds, terms, liner, oil, residual, line)
            if chooses:
                select(P, residual, fixed, pc, active)
            ready = False
            continue
        if not (gap > 0.0 and norm < 1e300):
            return False, step, False, count, width
        changes = _accept(u, trial, residual, fixed, pc, chooses, active, changes)
        moved += share * size
        ready = changes == 0 and share == 1.0
        if ready:
            converged = converged and (not clips or norm <= BALANCED / ROUNDING * flow_rounding(terms, rate))
            # the suction that is cut off may be far larger than what stays: one more step finds its last digits
            converged, once = converged and (not clips or once), converged
            if converged or (not from_last and is_final(left, last_left, fresh)):
                return True, step, not from_last and moved <= RULE.exact, count, width
        ready = ready and pays_again(size, last, fresh or from_last)
        # how steps with another film's factor shrink says nothing about what is left
        last, last_left = size, 0.0 if from_last else left
    if norm <= flow_rounding(terms, rate):
        # a film that carries nothing: its balances hold to rounding, and its steps never become small
        ok, count, width = factor(u, fixed, numbers, terms, liner, oil, matrix, active, line)
        return ok, RULE.most_steps, ok, count, width
    return False, RULE.most_steps, False, count, width
