"""Newton's method for the compressible film and its sets; see `exudyn_ehd.film.solvers.compressible`.

Symbols: P transformed pressure, fill film fraction, rho density ratio at the vertices
and rho_P its derivative to P; full: P is the unknown of a vertex, else its fill.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.assemble import assemble, dense_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu, solve_lu_transposed
from exudyn_ehd.film.lubricant.density_field import density_at, density_slope_at
from exudyn_ehd.film.solvers.balance import film_balance, film_slopes

MAX_NEWTON_STEPS = 60
# Shares of the peak pressure: where a vertex changes sides, and the error at which the solution has converged.
SET_TOLERANCE = 1e-12
ERROR_TOLERANCE = 1e-14
# Pa: a film at rest has no pressures but rounding, and no share of those would ever be small.
SMALLEST_PEAK = 1e-6
# A step so small leaves an error of its square; a factor from so near, or one
# with which steps shrink so fast, counts as exact.
LAST_STEP = 1e-7
# First steps, taken whole; share of the way to the end of the law's range that a
# later one covers at most; steps in a row cut like that after which there is no film.
WHOLE_STEPS = 16
TO_THE_END = 0.9
MAX_CUT_STEPS = 16
# Share of the pressure that a wedge as deep as the gap makes: below it a film without a solution
# so far is that of a journal in the centre to rounding, whose pressures are rounding too.
ROUNDING_SHARE = 1e-6
# Rounding of a vertex's balance, share of the largest flow, and of that wedge's pressure: no reason to change sides.
ROUNDING = 1e-14
EXACT_RATIO = 1e-8
FULL, CLIPPED, COMPLEMENTARY, FILLED = 0, 1, 2, 3
_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Buffers(NamedTuple):
    """Arrays that a solution works on: numbering, factor (`dense_band`),
    right-hand side, what is known of the law and fields.

    ``known`` (6, n m) as of `exudyn_ehd.film.lubricant.density_field`; rho and
    residual are those of the last balance, rho_P that of the last factor.
    """

    order: np.ndarray
    number: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    inv_diag: np.ndarray
    x: np.ndarray
    known: np.ndarray
    rho: np.ndarray
    rho_P: np.ndarray
    residual: np.ndarray


@njit(cache=True)
def factor_compressible(P, fill, film, kind, scale, floor, law, share, full, b):
    """Newton's matrix at P and the density in ``b``, factored; returns (ok, count, width)."""
    density_slope_at(P, scale, floor, law, share, b.known, b.rho_P)
    if kind == COMPLEMENTARY:
        count, width = number_cells(full, film.kx, b.order, b.number)
    else:
        count, width = number_cells(np.logical_not(film.fixed), film.kx, b.order, b.number)
    lower, upper = dense_band(b.lower, count, width), dense_band(b.upper, count, width)
    slopes = np.empty((5, P.size))
    if kind == FILLED:
        film_slopes(fill, full, b.rho, b.rho_P, film, slopes)
    else:
        film_slopes(None, None, b.rho, b.rho_P, film, slopes)
    assemble(film.kx, film.kz, slopes, b.number, b.order, count, lower, upper)
    return factor_lu(lower, upper, count, width, b.inv_diag), count, width


@njit(cache=True)
def _gather_negative(residual, order, count, x_out):
    flat = residual.reshape(-1)
    for r in range(count):
        x_out[r] = -flat[order[r]]


@njit(cache=True)
def _wedge(film):
    """Pressure that the Couette flow of a full gap builds up over a link, and that flow, the largest over the film."""
    pressure = 0.0
    flow = 0.0
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    for c in range(kx.size):
        flow = max(flow, abs(fx[c]), abs(fz[c]))
        if kx[c] > 0.0:
            pressure = max(pressure, abs(fx[c]) / kx[c])
        if kz[c] > 0.0:
            pressure = max(pressure, abs(fz[c]) / kz[c])
    return pressure, flow


@njit(cache=True)
def _take(P, fill, full, order, count, x, pc, kind, end, least):
    """Add the step x; returns its largest share of the peak pressure (or of a
    full film), the peak and how often the law's end cut it.

    The peak counts as ``least`` at least.

    The density climbs ever more steeply towards ``end``, where the pressure has no bound
    (viscosity laws whose integral is finite), and is taken as constant beyond, so that
    whole steps across it can bounce back for ever. Cut steps cover nine tenths of the way.
    """
    at, share, sides = P.reshape(-1), fill.reshape(-1), full.reshape(-1)
    cuts = 0
    reference = 0.0 if kind == FULL else pc
    peak = least
    by_pressure = 0.0
    by_fill = 0.0
    for r in range(count):
        c = order[r]
        if kind != FILLED or sides[c]:
            old = at[c]
            new = old + x[r]
            if old < end <= new:
                new = old + TO_THE_END * (end - old)
                cuts += 1
            at[c] = new
            peak = max(peak, abs(new - reference))
            by_pressure = max(by_pressure, abs(x[r]))
        else:
            share[c] += x[r]
            by_fill = max(by_fill, abs(x[r]))
    return max(by_pressure / peak, by_fill), peak, cuts


@njit(cache=True, fastmath=_FAST)
def _unsettled(P, r, fixed, full, floor):
    """How many vertices `_select` would move where films have no fill."""
    changes = 0.0
    for c in range(P.size):
        leaves = full[c] & (P[c] < floor)
        joins = (not full[c]) & (not fixed[c]) & (r[c] <= 0.0)
        changes += 1.0 if leaves | joins else 0.0
    return changes


@njit(cache=True)
def _select(P, fill, r, fixed, full, pc, kind, floor, piled):
    """Vertices change sides: pressures below ``floor``, films above 1 (or,
    without a fill, oil that piles up); returns their number.

    Oil piles up where the balance r is not above ``piled``.
    """
    if kind != FILLED and _unsettled(P.reshape(-1), r.reshape(-1), fixed.reshape(-1), full.reshape(-1), floor) == 0.0:
        return 0
    n, m = P.shape
    changes = 0
    for i in range(n):
        for j in range(m):
            if fixed[i, j]:
                continue
            if full[i, j]:
                if P[i, j] < floor:
                    full[i, j] = False
                    P[i, j] = pc
                    changes += 1
            elif kind == FILLED:
                if fill[i, j] > 1.0 + SET_TOLERANCE:
                    full[i, j] = True
                    fill[i, j] = 1.0
                    changes += 1
            elif r[i, j] <= piled:
                full[i, j] = True
                changes += 1
    return changes


@njit(cache=True)
def _start(P, fill, film, full, pc, kind):
    """Known values at vertices without that unknown."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            if film.fixed[i, j]:
                full[i, j] = False
            elif kind in (FULL, CLIPPED):
                full[i, j] = True
            elif full[i, j]:
                P[i, j] = max(P[i, j], pc)
            else:
                P[i, j] = pc
            if kind == FILLED and (film.fixed[i, j] or full[i, j]):
                fill[i, j] = 1.0


@njit(cache=True)
def _balance(P, fill, film, kind, b):
    if kind == FILLED:
        film_balance(P, fill, b.rho, film, b.residual)
    else:
        film_balance(P, None, b.rho, film, b.residual)


@njit(cache=True)
def solve_compressible(film, scale, pc, kind, law, share, reused, count, width, full, b, P, fill):
    """Newton from P, fill and the sets in ``full``; returns (ok, steps, exact, count, width).

    A factor is reused as long as the sets stay and each step is five times smaller
    than the last; the first step takes that of the last film (``count``, ``width``) if there is
    one (``reused``). A film that presses against the end of the law's range for `MAX_CUT_STEPS`
    has no pressure there. ``exact`` says that the last factor is that of the solution.
    """
    floor = -np.inf if kind == FULL else pc
    _start(P, fill, film, full, pc, kind)
    density_at(P, scale, floor, law, share, b.known, b.rho)
    _balance(P, fill, film, kind, b)
    last = moved = 0.0
    fresh = not reused
    end = law.highest / scale
    least, slack, piled = SMALLEST_PEAK / scale, 0.0, 0.0
    cut_steps = 0
    for step in range(MAX_NEWTON_STEPS):
        if fresh:
            ok, count, width = factor_compressible(P, fill, film, kind, scale, floor, law, share, full, b)
            if not ok:
                return False, step + 1, False, count, width
            moved = 0.0
        _gather_negative(b.residual, b.order, count, b.x)
        solve_lu(
            dense_band(b.lower, count, width), dense_band(b.upper, count, width), b.inv_diag, count, width,
            b.x.reshape(1, b.x.size),
        )  # fmt: skip
        if step == WHOLE_STEPS:
            wedge, flow = _wedge(film)
            least, slack, piled = max(least, ROUNDING_SHARE * wedge), 100.0 * ROUNDING * wedge, -ROUNDING * flow
        size, peak, cuts = _take(
            P, fill, full, b.order, count, b.x, pc, kind, end if step >= WHOLE_STEPS else np.inf, least
        )
        if not size < 1e300:
            return False, step + 1, False, count, width
        if size <= ERROR_TOLERANCE:
            return True, step + 1, not (reused and step == 0) and moved <= LAST_STEP, count, width
        moved += size
        density_at(P, scale, floor, law, share, b.known, b.rho)
        _balance(P, fill, film, kind, b)
        changes = 0
        if kind >= COMPLEMENTARY:
            lowest = pc - max(SET_TOLERANCE * peak, slack)
            changes = _select(P, fill, b.residual, film.fixed, full, pc, kind, lowest, piled)
        if changes > 0:
            # those that left had the cavity's density already
            _balance(P, fill, film, kind, b)
        cut_steps = cut_steps + 1 if cuts > 0 else 0
        if cut_steps > MAX_CUT_STEPS:
            return False, step + 1, False, count, width
        if changes > 0 or cuts > 0:
            fresh = True
            continue
        from_last = reused and step == 0
        ratio = size / last if not fresh and last > 0.0 else size
        converged = size <= ERROR_TOLERANCE
        if converged or (
            not from_last and ((fresh and size <= LAST_STEP) or (not fresh and ratio * size <= ERROR_TOLERANCE))
        ):
            exact = not from_last and (moved <= LAST_STEP or (not fresh and ratio <= EXACT_RATIO))
            return True, step + 1, exact, count, width
        fresh = not fresh and not from_last and ratio > 0.2
        last = size
    return False, MAX_NEWTON_STEPS, False, count, width


@njit(cache=True)
def raise_to(P, fixed, lowest):
    """Free pressures below ``lowest``, which are so by rounding, in place."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            if P[i, j] < lowest and not fixed[i, j]:
                P[i, j] = lowest


@njit(cache=True)
def solve_exact_transposed(P, fill, film, kind, scale, floor, law, full, count, width, b, exact, x):
    """Solve the transposed system at the solution for every row of x (k,
    count), in place; ``exact``: its factor is there."""
    if not exact:
        factor_compressible(P, fill, film, kind, scale, floor, law, 1.0, full, b)
    solve_lu_transposed(
        dense_band(b.lower, count, width), dense_band(b.upper, count, width), b.inv_diag, count, width, x
    )
