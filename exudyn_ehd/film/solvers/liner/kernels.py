"""Kernels of a film on a liner: its balance, Newton's matrix, steps and sets;
see `exudyn_ehd.film.solvers.liner.balance`.

What is handed over together travels in plain tuples, ``u`` and ``trial`` as (P, fill, full), ``factored`` as (order,
x, lower, upper, 1 / diagonal): a tuple with names takes numba longer to look at than these kernels take to run.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.lubricant.density import density_ratio
from exudyn_ehd.film.solvers.balance import film_balance, film_slopes, terms_of, violation
from exudyn_ehd.film.solvers.liner.elements import (
    Rates,
    bend_links,
    deflect,
    gaps_of,
    load_of,
    plain_links,
    set_storage,
    slopes_of,
)
from exudyn_ehd.film.solvers.liner.gap_response import add_gap_slopes
from exudyn_ehd.film.solvers.newton import solve_step

# Share of the smallest gap: a peak pressure that deflects the liner by less counts as one that does by so much.
LEAST_DEFLECTION = 1e-10
# Share of the scaled speed, the pressure of a clearance (1) that is driven by it and closed after a
# radian: smaller peaks are those of a journal that is centred to rounding, and count as so large.
LEAST_PRESSURE = 1e-6
# Of a sum of four flows, each a product of three numbers: a film that carries nothing is balanced to it, and no better.
ROUNDING = 1e-15
# Of the flows that drive a film: balances that may be left where suction is cut off.
BALANCED = 1e-7
# Pressures over the peak, and over the least that counts as one, by which
# vertices may lie below the cavity's before they rupture.
SUCTION, ROUNDED = 1e-12, 1e-8
# Largest growth of an oil's viscosity in one step, as a logarithm.
LARGEST_THICKENING = 4.0
# Share of a gap that a step may use up, so that it stays open.
CLOSING = 0.8
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def density_of_load(load_fields, P, scale, a, b, rho_out, rho_P_out):
    """Density ratio under the pressure on the elements, and its derivative to the unknown; none where a film clips."""
    load = load_of(load_fields)
    p, x, drive, slope = load.p.reshape(-1), P.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1)
    rho, rho_P = rho_out.reshape(-1), rho_P_out.reshape(-1)
    for c in range(p.size):
        rho[c], by = density_ratio(p[c] * scale, a, b)
        rho_P[c] = by * scale * slope[c] if x[c] == drive[c] else 0.0


@njit(cache=True)
def liner_residual(
    P, fill, rho, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, complementary, out
):  # fmt: skip
    """Balance of every vertex for settled elements and unbent links; returns the norm of those that do not hold."""
    film, gaps = terms_of(terms, fixed), gaps_of(gap_fields)
    set_storage(gaps, load_of(load_fields), P, fill is not None, known, Rates(*rates), beta, film)
    bend_links(gaps, film)
    film_balance(P, fill, rho, film, out)
    return violation(out, P, fixed, pc, complementary)


@njit(cache=True)
def plain_residual(
    P, fixed, numbers, kinds, load_fields, rigid, G, delta_old, gap_fields, metric, terms, known, rates, out
):  # fmt: skip
    """Balance of a film that only the liner answers to; returns (norm of what does not hold, smallest gap).

    ``numbers``: (pc, vx, vz, beta); ``kinds``: (clips, complementary).
    """
    pc, vx, vz, beta = numbers
    clips, complementary = kinds
    at_vertices, at_links = deflect(P, fixed, pc, clips, load_fields, rigid, beta, G, delta_old, rates[1], gap_fields)
    smallest = min(at_vertices, at_links)
    if not smallest > 0.0:
        return np.inf, smallest
    plain_links(gap_fields, metric, vx, vz, terms)
    norm = liner_residual(
        P, None, None, load_fields, gap_fields, terms, fixed, known, rates, beta, pc, complementary, out
    )
    return norm, smallest


@njit(cache=True)
def factor_liner(
    u, density, terms, fixed, slope_fields, load_fields, rates, beta, by, slopes, metric, active, number, factored
):  # fmt: skip
    """Newton's matrix of the ``active`` vertices, factored; ``by`` of `link_gradients`. Returns (ok, count, width)."""
    P, fill, full = u
    rho, rho_P = density
    order, _, lower, upper, inv_diag = factored
    film, answer, load = terms_of(terms, fixed), slopes_of(slope_fields), load_of(load_fields)
    count, width = number_cells(active, metric[0], order, number)
    film_slopes(fill, full, rho, rho_P, film, slopes)
    add_gap_slopes(P, fill, full, rho, film, answer, load, Rates(*rates), beta, by, slopes)
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(metric[0], metric[1], slopes, number, order, count, L, U)
    return factor_lu(L, U, count, width, inv_diag), count, width


@njit(cache=True, fastmath=_FAST)
def flow_rounding(terms, rate):
    """Norm of the balances' rounding: of the Couette flows over the links, and of the squeeze."""
    fx, fz, area, moved = terms[2].reshape(-1), terms[3].reshape(-1), terms[7].reshape(-1), rate.reshape(-1)
    total = 0.0
    for c in range(fx.size):
        squeeze = moved[c] * area[c]
        total += fx[c] * fx[c] + fz[c] * fz[c] + squeeze * squeeze
    return ROUNDING * np.sqrt(total)


@njit(cache=True)
def select(P, r, fixed, pc, active):
    """Vertices that carry pressure or are about to, as oil piles up there; returns the number of changes."""
    x, leaves, known, free = P.reshape(-1), r.reshape(-1), fixed.reshape(-1), active.reshape(-1)
    changes = 0
    for c in range(x.size):
        new = not known[c] and (x[c] > pc or leaves[c] <= 0.0)
        if new != free[c]:
            free[c] = new
            changes += 1
    return changes


@njit(cache=True)
def take_over(trial, r, fixed, pc, active, P_out):
    """`select` with the pressures of a trial, which become the film's."""
    P_out[:] = trial
    return select(P_out, r, fixed, pc, active)


@njit(cache=True)
def liner_step(residual, u, load_fields, H, H_P, factored, count, width, kinds, levels, trial):
    """Newton's step of the numbered unknowns with the factor at hand; returns
    the entries of `newton.Step`, and as `take_step`.

    All in pressures on the elements, the cavity's among them, the peak at least the least one.
    What a film that clips cuts off may lie far below pc and drops over the bent gaps, so that
    its steps are small by what presses and by ``opening``, the pressure that opens the smallest
    gap. Infinite for steps that are not finite. The share uses up at most `CLOSING` of any gap.

    Parameters
    ----------
    kinds : (clips, complementary, fills)
    levels : (pc, pc on the elements, least peak, opening, least suction)
    """
    order, steps, lower, upper, inv_diag = factored
    clips, complementary, fills = kinds
    pc, cavity_load, least, opening, suction = levels
    P_now, _, sides = u
    solve_step(residual, order, steps, lower, upper, inv_diag, count, width)
    load = load_of(load_fields)
    P, full, drive = P_now.reshape(-1), sides.reshape(-1), load.drive.reshape(-1)
    p, slope, gap, yields = load.p.reshape(-1), load.slope.reshape(-1), H.reshape(-1), H_P.reshape(-1)
    peak = least
    pressing = least
    largest = 0.0
    filled = 0.0
    share = 1.0
    for r in range(count):
        x, c = steps[r], order[r]
        if not abs(x) < 1e300:
            return np.inf, np.inf, peak, 1.0, 0
        if full[c]:
            cut = P[c] - drive[c]
            over = p[c] + cut - cavity_load
            peak = max(peak, abs(over))
            pressing = max(pressing, over)
            largest = max(largest, abs(x * slope[c]))
            closing = -x * yields[c]
            if closing > CLOSING * gap[c]:
                share = min(share, CLOSING * gap[c] / closing)
        else:
            filled = max(filled, abs(x))
    unit = min(pressing, opening) if clips else peak
    share = 1.0 if clips else share
    changes = take_step(
        u, load_fields, factored, count, share, pc, (complementary, fills), max(SUCTION * peak, suction), trial
    )
    return max(largest / peak, filled), max(largest / unit, filled), peak, share, changes


@njit(cache=True, inline="always")
def _moved(P, x, drive, slope, bend):
    """P + x; above ``drive`` no further than the pressure p(P) would go along its tangent.

    p grows exponentially with P: there, with ``bend`` = p'' the rate
    k = p'' / p' of growth, x becomes (1 - exp(-k x)) / k.
    """
    target = P + x
    rise = target - drive
    if bend <= 0.0 or rise <= 0.0:
        return target
    k = bend / slope
    return drive - np.expm1(-min(k * rise, LARGEST_THICKENING)) / k


@njit(cache=True)
def take_step(u, load_fields, factored, count, share, pc, kinds, tolerance, trial):
    """Trial state after ``share`` of the step, projected on what a closure
    allows; returns how many vertices rupture or fill up.

    ``kinds``: (complementary, fills).
    """
    P_now, fill_now, full_now = u
    P_out, fill_out, full_out = trial
    complementary, fills = kinds
    P_out[:] = P_now
    if fills:
        fill_out[:] = fill_now
        full_out[:] = full_now
    load, order, steps = load_of(load_fields), factored[0], factored[1]
    P, fill, full, sides = P_out.reshape(-1), fill_out.reshape(-1), full_out.reshape(-1), full_now.reshape(-1)
    drive, slope, bend = load.drive.reshape(-1), load.slope.reshape(-1), load.bend.reshape(-1)
    changes = 0
    for r in range(count):
        c = order[r]
        x = share * steps[r]
        if sides[c]:
            p = _moved(P[c], x, drive[c], slope[c], bend[c])
            if complementary and p < pc:
                p = pc
            if fills and p < pc:
                if p < pc - tolerance:
                    full[c] = False
                    changes += 1
                p = pc
            P[c] = p
        else:
            f = fill[c] + x
            if f > 1.0:
                if f > 1.0 + 1e-12:
                    full[c] = True
                    changes += 1
                f = 1.0
            fill[c] = f
    return changes
