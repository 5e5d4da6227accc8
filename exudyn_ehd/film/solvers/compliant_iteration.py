"""Newton's method for the film on columns of liner, with factors that are held as long as they serve; see `exudyn_ehd.film.solvers.compliant`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.cavitation.elrod_adams import LARGEST_DEFICIT
from exudyn_ehd.film.solvers.compliant_newton import factor_compliant, newton_step, take_step
from exudyn_ehd.film.solvers.liner_newton import (
    BALANCED,
    CLIPPED,
    COMPLEMENTARY,
    EXACT_STEP,
    FULL,
    LEAST_DEFLECTION,
    LEAST_PRESSURE,
    ROUNDING,
    flow_rounding,
    select,
)

if TYPE_CHECKING:
    from exudyn_ehd.film.solvers.compliant import CompliantFilmSolver

MAX_NEWTON_STEPS = 60
# Shares of the peak pressure: the error at which the solution stands and that may be left after a step, its bound on the square of a step
# with a fresh factor, and steps too small for the residual to fall any further.
STANDING, SQUARE_TOLERANCE, STEP_TOLERANCE = 1e-13, 1e-14, 1e-8
# Pressures over the peak, and over the least that counts as one, by which vertices may lie below the cavity's before they rupture.
SUCTION, ROUNDED = 1e-12, 1e-8
# Largest last step that is not worth another look at gaps and balances.
POLISHING = 1e-10
# Steps with a factor at hand that are not so much shorter than the last are not taken; one that leaves so much is the factor's last.
CONTRACTION, SERVING = 0.2, 0.005


def newton(
    solver: CompliantFilmSolver, P: np.ndarray, fill: np.ndarray, conserves: bool, extra: float, extra_old: np.ndarray
) -> tuple[bool, int]:
    """Newton from P and fill, in place; ``extra`` is the rate of pseudo time, towards ``extra_old``. Returns (found, steps).

    A factor serves further steps as long as the set stays and each step is five times smaller than the last; the first step takes
    that of the last film if there is one.
    """
    s, g, w, pc = solver, solver.grid, solver.work, solver.system.cavity_pressure
    kind = FULL if conserves else s.kind
    complementary = kind == COMPLEMENTARY
    if complementary:
        np.copyto(P, np.maximum(P, pc), where=~g.fixed)
    norm, smallest = s.balance(P, fill, conserves, extra, extra_old)
    if not smallest > 0.0:
        return False, 0
    if not conserves:
        s.full[:] = True
    # without complementarity every vertex has an unknown
    active = w.active if complementary else ~g.fixed
    held = s.held and w.warm and extra == 0.0
    if complementary and not w.warm:
        np.logical_not(g.fixed, out=active)
    elif complementary and not held:
        select(P, s.residual, g.fixed, pc, kind, active)
    s.held = False
    x = w.unknowns
    # what a journal centred but for rounding makes of the speed
    slight = LEAST_PRESSURE * (abs(s.vx) + abs(s.vz))
    noise = flow_rounding(s.columns.H, s.columns.HF, s.rigid[2], s.vx, s.vz, g.width_x, g.width_z, g.link_x)
    lower, upper = w.lower, w.upper
    factored, last, last_size, moved = held, 0.0, 0.0, 0.0
    for step in range(1, MAX_NEWTON_STEPS + 1):
        fresh = not factored
        if fresh:
            if not factor(s, P, fill, active, conserves, extra):
                return False, step
            moved = 0.0
            if w.count == 0 or norm == 0.0:
                s.exact, s.held = True, extra == 0.0
                return True, step
        opening = smallest / s.beta
        error, size, peak, share = newton_step(
            s.residual, P, s.load, s.fields, s.contact_G, s.beta, s.full, w.order, w.count, w.width, lower, upper,
            w.inv_diag, s.cavity_load, kind == CLIPPED, max(LEAST_DEFLECTION * opening, slight), opening, x,
        )  # fmt: skip
        if not error < 1e300:
            return False, step
        borrowed = held and step == 1
        standing = error <= STANDING
        if not fresh and not borrowed and not standing and error > CONTRACTION * last:
            factored = False
            continue
        before = norm
        for k in range(1 if borrowed else 12):
            if k > 0:
                share *= 0.5
                s.press(P)
            changes = take_step(
                P, s.load, fill, s.full, w.order, w.count, x, share, pc, complementary, conserves, max(SUCTION * peak, ROUNDED * slight),
                s.trial, s.trial_fill, s.trial_full,
            )  # fmt: skip
            norm, smallest_trial = s.balance(s.trial, s.trial_fill, conserves, extra, extra_old)
            if smallest_trial > 0.0 and (norm < before or error <= STEP_TOLERANCE or (conserves and changes > 0)):
                break
        if borrowed and not (smallest_trial > 0.0 and (norm < before or standing)):
            norm, smallest = s.balance(P, fill, conserves, extra, extra_old)
            if complementary:
                select(P, s.residual, g.fixed, pc, kind, active)
            factored = False
            continue
        smallest = smallest_trial
        if not (smallest > 0.0 and norm < 1e300):
            return False, step
        P[:] = s.trial
        if conserves:
            fill[:], s.full[:] = s.trial_fill, s.trial_full
        else:
            changes = select(P, s.residual, g.fixed, pc, kind, active) if complementary else 0
        moved += share * error
        if norm <= noise and not conserves:
            s.exact = s.held = factor(s, P, fill, active, conserves, extra)
            return s.exact, step
        # a factor that leaves much of a step serves no more after it
        serves = fresh or borrowed or error <= SERVING * last
        factored = changes == 0 and share == 1.0
        if factored:
            # What is left: about the square of a Newton step, or a step times its ratio to the last one.
            rest = size * size / (SQUARE_TOLERANCE if fresh else STANDING * min(max(last_size, 1e-300), 1.0))
            if standing and kind == CLIPPED:
                # suction without bounds makes any step a small one
                standing = norm <= BALANCED * noise / ROUNDING
            if standing or (not borrowed and rest <= 1.0):
                if not standing and extra == 0.0:
                    _polish(s, P, fill, conserves, complementary, max(LEAST_DEFLECTION * opening, slight), opening)
                s.exact = not borrowed and moved <= EXACT_STEP and extra == 0.0
                s.held = extra == 0.0
                return not conserves or _sound(s, fill), step
        factored = factored and serves
        last, last_size = error, size
    return False, MAX_NEWTON_STEPS


def _polish(
    solver: CompliantFilmSolver,
    P: np.ndarray,
    fill: np.ndarray,
    conserves: bool,
    complementary: bool,
    least: float,
    opening: float,
) -> None:
    """Add one more step to P and fill alone, for the balances where the gap is wide: what is left changes the gaps by next to nothing."""
    s, w, pc = solver, solver.work, solver.system.cavity_pressure
    lower, upper = w.lower, w.upper
    error, _, peak, _ = newton_step(
        s.residual, P, s.load, s.fields, s.contact_G, s.beta, s.full, w.order, w.count, w.width, lower, upper, w.inv_diag,
        s.cavity_load, False, least, opening, w.unknowns,
    )  # fmt: skip
    if not error <= POLISHING:
        return
    changes = take_step(
        P, s.load, fill, s.full, w.order, w.count, w.unknowns, 1.0, pc, complementary, conserves, SUCTION * peak, s.trial,
        s.trial_fill, s.trial_full,
    )  # fmt: skip
    if changes > 0:
        return
    if not s.press(s.trial):
        s.press(P)
        return
    P[:] = s.trial
    if conserves:
        fill[:] = s.trial_fill


def factor(
    solver: CompliantFilmSolver, P: np.ndarray, fill: np.ndarray, active: np.ndarray, conserves: bool, extra: float
) -> bool:
    """Factor Newton's matrix at P and fill, where the columns stand; arguments as for `newton`."""
    g, w = solver.grid, solver.work
    if not solver.answered:
        solver.answer(P, fill, conserves, extra)
    lower, upper = w.lower, w.upper
    ok, w.count, w.width = factor_compliant(
        solver.fields, solver.link_flux, P, fill, solver.full, solver.gain_P, solver.gain_fill, solver.vx, solver.vz,
        g.width_x, g.width_z, g.link_x, g.link_z, solver.links, active, w.order, w.number, lower, upper, w.inv_diag,
    )  # fmt: skip
    return ok


def _sound(solver: CompliantFilmSolver, fill: np.ndarray) -> bool:
    """Whether no vertex holds less than nothing, but for rounding, which is cut off; sets the full vertices."""
    np.logical_and(solver.full, ~solver.grid.fixed, out=solver.work.active)
    if not fill.min() > -LARGEST_DEFICIT:
        return False
    np.maximum(fill, 0.0, out=fill)
    return True
