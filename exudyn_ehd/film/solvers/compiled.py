"""`newton.newton` compiled as a whole for a film on a liner without further effects, so fast that calls from Python
would cost half as much again."""

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.balance import violation
from exudyn_ehd.film.solvers.liner.elements import plain_slopes
from exudyn_ehd.film.solvers.liner.gap_response import link_gradients
from exudyn_ehd.film.solvers.liner.kernels import plain_residual
from exudyn_ehd.film.solvers.liner.line_kernels import is_there, meet_line
from exudyn_ehd.film.solvers.newton import RULE, improves, is_final, pays_again, too_slow
from exudyn_ehd.film.solvers.steps import (
    BALANCED,
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


@njit(cache=True, inline="always")
def _balance(P, fixed, numbers, kinds, terms, liner, residual, line):
    """Norm of what does not hold, and the smallest gap, at P."""
    load, rigid, G, delta_old, gaps, _, metric, known, rates, _ = liner
    norm, gap = plain_residual(
        P, fixed, numbers, kinds, load, rigid, G, delta_old, gaps, metric, terms, known, rates, residual
    )
    if is_there(line) and gap > 0.0:
        meet_line(P, numbers[0], terms[0], terms[1], line, residual)
        norm = violation(residual, P, fixed, numbers[0], True)
    return norm, gap


@njit(cache=True, inline="always")
def _factor(P, fixed, numbers, terms, liner, matrix, active, line):
    """Newton's matrix at P, for the state of the last balance, factored; returns (ok, count, width)."""
    load, _, _, _, gaps, gap_slopes, metric, _, rates, by = liner
    _, vx, vz, beta = numbers
    plain_slopes(P, load, beta, rates[1], gap_slopes)
    link_gradients(P, None, None, terms, fixed, gaps, None, metric, vx, vz, by)
    elements = gap_slopes, load, rates, beta, by
    return factor_film((P, None, None), (None, None), terms, fixed, elements, matrix, active, None, line)


@njit(cache=True, nogil=True)
def solve(P, trial, fixed, numbers, kinds, terms, rate, liner, matrix, residual, active, start, line):
    """Newton from P, in place; returns (found, steps, exact, count, width).

    Parameters
    ----------
    numbers : (pc, vx, vz, compliance)
    kinds : (clips, whether vertices at pc are no unknowns)
    rate : (n, m) array
        Of the undeformed gap.
    liner : (load, rigid, G, old deflection, gaps, gap slopes, metric, known, rates, by of `link_gradients`)
    matrix : (slopes, number, factored) of `factor_film`
    active : unknown vertices
    start : (whether a factor is there, whether the sets are, count, width)
    line : that of `line_kernels`
    """
    u, new, elements = (P, None, None), (trial, None, None), (liner[0], liner[4], liner[5])
    pc, vx, vz, beta = numbers
    clips, chooses = kinds
    ready, warm, count, width = start
    base, slight = pc if pc > -np.inf else 0.0, LEAST_PRESSURE * (abs(vx) + abs(vz))
    norm, gap = _balance(P, fixed, numbers, kinds, terms, liner, residual, line)
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
            ok, count, width = _factor(P, fixed, numbers, terms, liner, matrix, active, line)
            if not ok:
                return False, step, False, count, width
            moved = 0.0
            if count == 0 or norm == 0.0:
                return True, step, True, count, width
        opening = gap / beta
        levels = pc, base, max(LEAST_DEFLECTION * opening, slight), opening, ROUNDED * slight
        size, left, peak, share, changes = newton_step(
            residual, u, elements, matrix[2], count, width, kinds, levels, new, line, step - 1
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
                changes = take_step(u, elements, matrix[2], count, share, pc, chooses, SUCTION * peak, new)
            norm, gap = _balance(trial, fixed, numbers, kinds, terms, liner, residual, line)
            if improves(gap, norm, before, size, changes):
                break
        if from_last and not improves(gap, norm, before, size, changes):
            norm, gap = _balance(P, fixed, numbers, kinds, terms, liner, residual, line)
            if chooses:
                select(P, residual, fixed, pc, active)
            ready = False
            continue
        if not (gap > 0.0 and norm < 1e300):
            return False, step, False, count, width
        if chooses:
            changes += take_over(trial, residual, fixed, pc, active, P)
        else:
            copy_field(trial, P)
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
        ok, count, width = _factor(P, fixed, numbers, terms, liner, matrix, active, line)
        return ok, RULE.most_steps, ok, count, width
    return False, RULE.most_steps, False, count, width
