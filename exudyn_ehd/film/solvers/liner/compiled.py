"""`newton.newton` compiled as a whole for a film that only the liner answers
to: as fast as it is, calls from Python would cost half as much again."""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.solvers.liner.elements import plain_slopes
from exudyn_ehd.film.solvers.liner.gap_response import link_gradients
from exudyn_ehd.film.solvers.liner.kernels import (
    BALANCED,
    LEAST_DEFLECTION,
    LEAST_PRESSURE,
    ROUNDED,
    ROUNDING,
    factor_liner,
    flow_rounding,
    liner_step,
    plain_residual,
    select,
    take_over,
    take_step,
)
from exudyn_ehd.film.solvers.newton import RULE


@njit(cache=True)
def _factor(P, fixed, numbers, elements, links, rates, matrix, active):
    """Newton's matrix at P, factored; returns (ok, count, width)."""
    _, vx, vz, beta = numbers
    load, _, _, _, gaps, gap_slopes = elements
    metric, terms, _ = links
    by, slopes, number, factored = matrix
    plain_slopes(P, load, beta, rates[1], gap_slopes)
    link_gradients(P, None, None, terms, fixed, gaps, None, metric, vx, vz, by)
    return factor_liner(
        (P, None, None),
        (None, None),
        terms,
        fixed,
        gap_slopes,
        load,
        rates,
        beta,
        by,
        slopes,
        metric,
        active,
        number,
        factored,
    )


@njit(cache=True)
def solve_plain(u, trial, fixed, numbers, kinds, elements, links, rates, matrix, residual, active, start):
    """Newton from ``u``, in place; returns (found, steps, exact, count, width).

    Parameters
    ----------
    u, trial : (P, fill, full)
    numbers, kinds : as for `plain_residual`
    elements : (load, rigid, G, old deflection, gaps, gap slopes), as fields
    links : (metric, terms, known), as fields
    matrix : (by, slopes, number, factored) of `factor_liner`
    start : (whether a factor is there, whether the sets are, count, width)
    """
    pc, vx, vz, beta = numbers
    clips, complementary = kinds
    load, rigid, G, delta_old, gaps, gap_slopes = elements
    metric, terms, known = links
    factored = matrix[3]
    ready, warm, count, width = start
    P = u[0]
    norm, gap = plain_residual(
        P, fixed, numbers, kinds, load, rigid, G, delta_old, gaps, metric, terms, known, rates, residual
    )
    if not gap > 0.0:
        return False, 0, False, count, width
    if not complementary or not warm:
        active[:] = np.logical_not(fixed)
    elif not ready:
        select(P, residual, fixed, pc, active)
    slight, noise = LEAST_PRESSURE * (abs(vx) + abs(vz)), flow_rounding(terms, rigid[2])
    reused = ready
    last = last_left = moved = 0.0
    for step in range(1, RULE.most_steps + 1):
        fresh = not ready
        if fresh:
            ok, count, width = _factor(P, fixed, numbers, elements, links, rates, matrix, active)
            if not ok:
                return False, step, False, count, width
            moved = 0.0
            if count == 0 or norm == 0.0:
                return True, step, True, count, width
        opening = gap / beta
        levels = (pc, pc if pc > -np.inf else 0.0, max(LEAST_DEFLECTION * opening, slight), opening, ROUNDED * slight)
        size, left, _, share, _ = liner_step(
            residual,
            u,
            load,
            gaps[0],
            gap_slopes[0],
            factored,
            count,
            width,
            (clips, complementary, False),
            levels,
            trial,
        )
        if not size < 1e300:
            return False, step, False, count, width
        from_last = reused and step == 1
        converged = size <= RULE.converged
        if not (fresh or from_last or converged) and size > RULE.contraction * last:
            ready = False
            continue
        before = norm
        for k in range(1 if from_last else RULE.most_halvings):
            if k > 0:
                share *= 0.5
                take_step(u, load, factored, count, share, pc, (complementary, False), 0.0, trial)
            norm, gap = plain_residual(
                trial[0], fixed, numbers, kinds, load, rigid, G, delta_old, gaps, metric, terms, known, rates, residual
            )
            if gap > 0.0 and (norm < before or size <= RULE.silent):
                break
        if from_last and not (gap > 0.0 and (norm < before or converged)):
            norm, gap = plain_residual(
                P, fixed, numbers, kinds, load, rigid, G, delta_old, gaps, metric, terms, known, rates, residual
            )
            if complementary:
                select(P, residual, fixed, pc, active)
            ready = False
            continue
        if not (gap > 0.0 and norm < 1e300):
            return False, step, False, count, width
        changes = 0
        if complementary:
            changes = take_over(trial[0], residual, fixed, pc, active, P)
        else:
            P[:] = trial[0]
        moved += share * size
        ready = changes == 0 and share == 1.0
        if ready:
            converged = converged and (not clips or norm <= BALANCED / ROUNDING * noise)
            rest = left * left / (RULE.square if fresh else RULE.converged * min(max(last_left, 1e-300), 1.0))
            if converged or (not from_last and rest <= 1.0):
                return True, step, not from_last and moved <= RULE.exact, count, width
        ready = ready and (fresh or from_last or size <= RULE.reusable * last)
        last, last_left = size, left
    if norm <= noise:
        # a film that carries nothing: its balances hold to rounding, and its steps never become small
        ok, count, width = _factor(P, fixed, numbers, elements, links, rates, matrix, active)
        return ok, RULE.most_steps, ok, count, width
    return False, RULE.most_steps, False, count, width
