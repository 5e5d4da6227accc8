"""The driver of Newton's method for a film whose gap or density depends on its pressure; see `solvers.newton`."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.solvers.liner.balance import LinerBalance
from exudyn_ehd.film.solvers.liner.line import FilmLine
from exudyn_ehd.film.solvers.newton import RULE, Step, improves, is_final, pays_again, too_slow
from exudyn_ehd.film.solvers.steps import admit


def solve(film: LinerBalance) -> tuple[bool, int]:
    """Newton for the film that is asked for, from the present state and sets: (found, steps)."""
    ok, steps = True, 0
    if film.line is None or not film.film.work.warm:
        # the way to a film without its line is the safer one
        ok, steps = solve_with(film, None)
    if film.line is None or not ok:
        return ok, steps
    film.film.work.warm = True
    ok, more = solve_with(film, film.line)
    return ok, steps + more


def solve_with(film: LinerBalance, line: FilmLine | None) -> tuple[bool, int]:
    """`solve` with the line inside the cells, or without."""
    # prescribed vertices move with rotating supplies, the cavity's scaled pressure with the viscosity
    if film.film.complementary:
        admit(*film.sides(film.u), film.film.grid.fixed, film.film.system.cavity_pressure)
    film.met = line
    return film.solve_plain() if film.plain and not film.fills else newton(film)


def newton(film: LinerBalance) -> tuple[bool, int]:
    """Solve from the film's present state, in place; returns (found, steps)."""
    norm, gap = film.balance(film.u)
    if not gap > 0.0:
        return False, 0
    film.begin()
    reused = ready = film.reusable
    film.reusable = film.exact = False
    last, last_left, moved, once = 0.0, 0.0, 0.0, False
    for count in range(1, RULE.most_steps + 1):
        fresh = not ready
        if fresh:
            if not film.factor():
                return False, count
            moved = 0.0
            if film.film.work.count == 0 or norm == 0.0:
                film.exact = film.reusable = True
                return True, count
        step = film.step(gap)
        if not step.size < 1e300:
            return False, count
        from_last = reused and count == 1
        converged = step.size <= RULE.converged
        if not (fresh or from_last or converged) and too_slow(step.size, last):
            ready = False
            continue
        share, trial_norm, trial_gap = _search(film, step, norm, 1 if from_last else RULE.most_halvings)
        if from_last and not improves(trial_gap, trial_norm, norm, step.size, film.changes):
            norm, gap = film.balance(film.u)
            film.undo()
            ready = False
            continue
        norm, gap = trial_norm, trial_gap
        if not (gap > 0.0 and norm < 1e300):
            return False, count
        changes = film.accept()
        moved += share * step.size
        if film.nothing_left(norm):
            film.exact = film.reusable = film.factor()
            return film.exact, count
        ready = changes == 0 and share == 1.0
        if ready:
            converged = converged and film.settled(norm)
            # the suction that is cut off may be far larger than what stays: one more step finds its last digits
            converged, once = converged and (once or not film.clips), converged
            if converged or (not from_last and is_final(step.left, last_left, fresh)):
                if not converged:
                    film.correct(gap)
                film.exact = not from_last and moved <= RULE.exact
                film.reusable = True
                return film.sound(), count
        ready = ready and pays_again(step.size, last, fresh or from_last)
        # how steps with another film's factor shrink says nothing about what is left
        last, last_left = step.size, 0.0 if from_last else step.left
    return False, RULE.most_steps


def _search(film: LinerBalance, step: Step, norm: float, most: int) -> tuple[float, float, float]:
    """Halve the step until the balances improve; returns (share of the step, norm, smallest gap)."""
    share, changes, trial_norm, gap = step.share, film.changes, np.inf, -1.0
    for k in range(most):
        if k > 0:
            share *= 0.5
            changes = film.move(share, step.peak)
        trial_norm, gap = film.balance(film.trial)
        if improves(gap, trial_norm, norm, step.size, changes):
            break
    return share, trial_norm, gap
