"""Newton's matrix, steps and sets of a film, on the elements of a liner; see `newton`.

What is handed over together travels in plain tuples: a tuple with names takes numba longer to look at than these
kernels take to run. ``u`` and ``trial`` are (P, fill, full), fill and full None where no oil is counted; ``matrix`` is
(slopes, number, factored), ``factored`` (order, x, lower, upper, 1 / diagonal).
"""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import add_corners, add_tangents, assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells, number_with_corners
from exudyn_ehd.film.banded.substitution import solve_lu_one
from exudyn_ehd.film.reynolds.balance import film_slopes, terms_of
from exudyn_ehd.film.solvers.liner.elements import Rates, load_of, slopes_of
from exudyn_ehd.film.solvers.liner.gap_response import add_gap_slopes
from exudyn_ehd.film.solvers.liner.line_kernels import add_line, bend_to_line, is_there, lean_to_line

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
# Root of the curvature that balances have in s.
CURVED = 10.0
# Share of a gap that a step may use up, so that it stays open.
CLOSING = 0.8
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, nogil=True)
def factor_film(u, density, terms, fixed, liner, matrix, active, thin, line):
    """Newton's matrix of the ``active`` vertices, factored; returns (ok, count, width).

    ``density``: (rho, drho/dP), None of a constant one; ``liner``: (gap slopes, load, rates, beta, by),
    ``by`` of `link_gradients`; ``thin``: `ShearThinning.response` of conductances that follow the pressure,
    or None; ``line`` of `line_kernels`.
    """
    P, fill, full = u
    rho, rho_P = density
    slopes, number, factored = matrix
    order, _, lower, upper, inv_diag = factored
    film = terms_of(terms, fixed)
    links = film.kx
    if thin is None:
        count, width = number_cells(active, links, order, number)
    else:
        # Couette flows couple where pressure flow is dropped
        links = np.abs(film.kx) + np.abs(film.fx)
        count, width = number_with_corners(active, links, order, number)
    film_slopes(fill, full, rho, rho_P, film, slopes)
    if thin is not None:
        add_tangents(thin[0], film.kx, film.kz, full, slopes)
    gap_slopes, load, rates, beta, by = liner
    add_gap_slopes(P, fill, full, rho, film, slopes_of(gap_slopes), load_of(load), Rates(*rates), beta, by, slopes)
    if is_there(line):
        add_line(line, active, slopes[4])
    L, U = dense_band(lower, count, width), dense_band(upper, count, width)
    assemble(links, film.kz, slopes, number, order, count, L, U)
    if thin is not None:
        add_corners(thin[1], thin[2:], film.kx, film.kz, full, number, L, U)
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
def free_all(fixed, active):
    """Every vertex that is not prescribed is an unknown."""
    known, free = fixed.reshape(-1), active.reshape(-1)
    for c in range(free.size):
        free[c] = not known[c]


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


@njit(cache=True, inline="always")
def take_over(trial, r, fixed, pc, active, P_out):
    """`select` with the pressures of a trial, which become the film's."""
    copy_field(trial, P_out)
    return select(P_out, r, fixed, pc, active)


@njit(cache=True, inline="always")
def _solve(residual, factored, count, width, P, pc, line, taken):
    """Newton's step of the numbered unknowns; returns as `bend_to_line`."""
    order, x, lower, upper, inv_diag = factored
    flat = residual.reshape(-1)
    for r in range(count):
        x[r] = -flat[order[r]]
    if is_there(line):
        lean_to_line(P, pc, order, count, line, x)
    if count > 0:
        L, U = dense_band(lower, count, width), dense_band(upper, count, width)
        solve_lu_one(L, U, inv_diag, count, width, x)
    if not is_there(line):
        return 0.0
    return bend_to_line(P, pc, order, count, line, taken, x)


@njit(cache=True)
def _sizes(P_now, sides, elements, order, steps, count, base, least):
    """Largest step of a pressure and of a fill, peak with and without suction,
    share of the step that uses up at most `CLOSING` of any gap."""
    P = P_now.reshape(-1)
    if sides is not None:
        full = sides.reshape(-1)
    load, gap, yields = load_of(elements[0]), elements[1][0].reshape(-1), elements[2][0].reshape(-1)
    p, drive, slope = load.p.reshape(-1), load.drive.reshape(-1), load.slope.reshape(-1)
    largest = filled = 0.0
    peak = pressing = least
    share = 1.0
    for r in range(count):
        x, c = steps[r], order[r]
        if not abs(x) < 1e300:
            return np.inf, np.inf, peak, pressing, 1.0
        if sides is not None and not full[c]:
            filled = max(filled, abs(x))
            continue
        over = p[c] + (P[c] - drive[c]) - base
        pressing = max(pressing, over)
        largest = max(largest, abs(x * slope[c]))
        closing = -x * yields[c]
        if closing > CLOSING * gap[c]:
            share = min(share, CLOSING * gap[c] / closing)
        peak = max(peak, abs(over))
    return largest, filled, peak, pressing, share


@njit(cache=True)
def newton_step(residual, u, elements, factored, count, width, kinds, levels, trial, line, taken):
    """Newton's step of the numbered unknowns with the factor at hand; returns
    the entries of `newton.Step`, and as `take_step`.

    All in pressures on the elements, the cavity's among them, the peak at least the least one.
    What a film that clips cuts off may lie far below pc and drops over the bent gaps, so that
    its steps are small by the pressure and by ``opening``, the pressure that opens the smallest
    gap. Infinite for steps that are not finite.

    Parameters
    ----------
    elements : (load, gaps, gap slopes), as fields
    kinds : (clips, whether vertices at pc are no unknowns)
    levels : (pc, pc on the elements, least peak, opening, least suction)
    line, taken : that of `line_kernels`, and steps before
    """
    clips, chooses = kinds
    pc, base, least, opening, suction = levels
    along_line = _solve(residual, factored, count, width, u[0], pc, line, taken)
    largest, filled, peak, pressing, share = _sizes(u[0], u[2], elements, factored[0], factored[1], count, base, least)
    if not largest < np.inf:
        return np.inf, np.inf, peak, 1.0, 0
    if is_there(line):
        largest = max(largest, CURVED * along_line * np.sqrt(peak))
    unit = min(pressing, opening) if clips else peak
    share = 1.0 if clips else share
    changes = take_step(u, elements, factored, count, share, pc, chooses, max(SUCTION * peak, suction), trial)
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


@njit(cache=True, inline="always")
def take_step(u, elements, factored, count, share, pc, chooses, tolerance, trial):
    """Trial state after ``share`` of the step, projected on what a closure
    allows; returns how many vertices rupture or fill up."""
    return _take(u[0], u[1], u[2], elements, factored, count, share, pc, chooses, tolerance, *trial)


@njit(cache=True, fastmath=_FAST)
def copy_field(field, out):
    """out = field (n, m), if there is one; flat, which is faster by far."""
    if field is not None:
        source, target = field.reshape(-1), out.reshape(-1)
        for c in range(target.size):
            target[c] = source[c]


@njit(cache=True)
def _take(
    P_now, fill_now, sides, elements, factored, count, share, pc, chooses, tolerance, P_out, fill_out, full_out
):  # fmt: skip
    order, steps = factored[0], factored[1]
    copy_field(P_now, P_out)
    copy_field(fill_now, fill_out)
    copy_field(sides, full_out)
    P = P_out.reshape(-1)
    if sides is not None:
        fill, full, was = fill_out.reshape(-1), full_out.reshape(-1), sides.reshape(-1)
    load = load_of(elements[0])
    drive, slope, bend = load.drive.reshape(-1), load.slope.reshape(-1), load.bend.reshape(-1)
    lowest = pc if chooses or sides is not None else -np.inf
    changes = 0
    for r in range(count):
        c = order[r]
        x = share * steps[r]
        if sides is not None and not was[c]:
            f = fill[c] + x
            if f > 1.0:
                full[c], f = True, 1.0
                changes += 1
            fill[c] = f
            continue
        p = _moved(P[c], x, drive[c], slope[c], bend[c])
        if sides is not None and p < pc - tolerance:
            full[c] = False
            changes += 1
        P[c] = max(p, lowest)
    return changes


@njit(cache=True)
def admit(P, fill, full, fixed, pc):
    """State that a film may have which nowhere falls below pc; prescribed vertices are full."""
    x, known = P.reshape(-1), fixed.reshape(-1)
    if full is not None:
        share, sides = fill.reshape(-1), full.reshape(-1)
    for c in range(x.size):
        if full is not None:
            sides[c] |= known[c]
            if sides[c]:
                share[c] = 1.0
            else:
                x[c] = pc
        if x[c] < pc and not known[c]:
            x[c] = pc
