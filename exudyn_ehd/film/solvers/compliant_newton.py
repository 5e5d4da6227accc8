"""Kernels of Newton's method for the film on columns of liner: matrix, lengths of steps, trial states; see `exudyn_ehd.film.solvers.compliant`.

Symbols as in `exudyn_ehd.film.solvers.compliant_columns`; x the Newton step of the numbered unknowns, a, b ends of a link.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lu import add_flux, factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD
from exudyn_ehd.film.solvers.compliant_columns import BEND, DRIVE, LOAD_P, SLOPE, columns_of
from exudyn_ehd.film.solvers.compliant_links import across, across_slopes, along, along_slopes

# Largest growth of an oil's viscosity in one step, as a logarithm.
LARGEST_THICKENING = 4.0


@njit(cache=True)
def assemble_compliant(
    columns, links, P, fill, full, gain_P, gain_fill, vx, vz, width_x, width_z, link_x, link_z, number, count, width,
    lower, upper,
):  # fmt: skip
    """d(balance)/d(unknown) of the numbered vertices into the two bands; the unknown is P where ``full``, else the fill."""
    c = columns_of(columns)
    n, m = P.shape
    for r in range(count):
        for d in range(width + 1 + PAD):
            lower[r, d] = 0.0
            upper[r, d] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            a = number[i, j]
            b = number[nxt, j]
            if a >= 0:
                upper[a, 0] += gain_P[i, j] if full[i, j] else gain_fill[i, j]
            if (a >= 0 or b >= 0) and lx != 0.0:
                d = 0.5 * (c.E[nxt, j] - c.E[i, j])
                f = fill[i, j] if v >= 0.0 else fill[nxt, j]
                drop = lx * (P[nxt, j] - P[i, j])
                h = c.HF[i, j]
                k, carrier = along(links, i, j, h, d)
                k_h, k_d, _, carrier_h = along_slopes(links, i, j, h, d)
                k *= width_z[j] * lx
                by_h = 0.5 * width_z[j] * c.link[i, j] * (v * f * carrier_h - k_h * drop)
                by_d = 0.5 * width_z[j] * k_d * drop
                carried = width_z[j] * v * carrier
                if full[i, j]:
                    out_a = k + by_h * c.D_P[i, j] + by_d * c.H_P[i, j]
                else:
                    out_a = carried if v >= 0.0 else 0.0
                if full[nxt, j]:
                    out_b = -k + by_h * c.D_P[nxt, j] - by_d * c.H_P[nxt, j]
                else:
                    out_b = carried if v < 0.0 else 0.0
                add_flux(a, b, out_a, out_b, lower, upper)
            if j + 1 == m:
                continue
            b = number[i, j + 1]
            if a >= 0 or b >= 0:
                d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
                f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
                drop = link_z[j] * (P[i, j + 1] - P[i, j])
                h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
                k, carrier = across(links, i, j, h, d)
                k_h, k_d, _, carrier_h = across_slopes(links, i, j, h, d)
                k *= width_x[i] * link_z[j]
                by_h = 0.5 * width_x[i] * (vz * f * carrier_h - k_h * drop)
                by_d = 0.5 * width_x[i] * k_d * drop
                carried = width_x[i] * vz * carrier
                if full[i, j]:
                    out_a = k + (by_h + by_d) * c.H_P[i, j]
                else:
                    out_a = carried if vz >= 0.0 else 0.0
                if full[i, j + 1]:
                    out_b = -k + (by_h - by_d) * c.H_P[i, j + 1]
                else:
                    out_b = carried if vz < 0.0 else 0.0
                add_flux(a, b, out_a, out_b, lower, upper)


@njit(cache=True)
def factor_compliant(
    columns, links, P, fill, full, gain_P, gain_fill, vx, vz, width_x, width_z, link_x, link_z, metric, active, order,
    number, lower, upper, inv_diag,
):  # fmt: skip
    """Newton's matrix of the ``active`` vertices, factored; returns (ok, count, width)."""
    count, width = number_cells(active, metric, order, number)
    assemble_compliant(
        columns, links, P, fill, full, gain_P, gain_fill, vx, vz, width_x, width_z, link_x, link_z, number, count, width,
        lower, upper,
    )  # fmt: skip
    return factor_lu(lower, upper, count, width, inv_diag), count, width


@njit(cache=True)
def newton_step(
    r, P, load, columns, contact_G, beta, full, order, count, width, lower, upper, inv_diag, cavity_load, clips, least,
    opening, x,
):  # fmt: skip
    """Newton's step x of the numbered unknowns with the factor at hand.

    Returns (largest step over the peak pressure, or of a fill; over what counts as much after it; the peak; share of the step to take).

    All in pressures on the columns, pc being ``cavity_load`` among them, the peak at least ``least``. What a film that clips cuts off may
    lie far below pc and drops over the bent gaps, so that its steps are small by what presses and by ``opening``, the pressure that opens the
    smallest gap. Infinite for steps that are not finite. The share uses up at most 80 % of any vertex's film gap.
    """
    c = columns_of(columns)
    m = P.shape[1]
    for k in range(count):
        i = order[k] // m
        x[k] = -r[i, order[k] - i * m]
    if count > 0:
        solve_lu(lower, upper, inv_diag, count, width, x.reshape(1, x.size))
    peak = least
    pressing = least
    largest = 0.0
    filled = 0.0
    share = 1.0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        if not abs(x[k]) < 1e300:
            return np.inf, np.inf, peak, 1.0
        if full[i, j]:
            cut = P[i, j] - load[DRIVE, i, j]
            over = load[LOAD_P, i, j] + cut - cavity_load
            peak = max(peak, abs(over))
            pressing = max(pressing, over)
            change = x[k] * load[SLOPE, i, j]
            largest = max(largest, abs(change))
            if change < 0.0 and cut == 0.0:
                change *= c.rate_t[i, j] * beta / (1.0 - beta * contact_G[i, j])
                if change < -0.8 * c.H[i, j]:
                    share = min(share, -0.8 * c.H[i, j] / change)
        else:
            filled = max(filled, abs(x[k]))
    unit = min(pressing, opening) if clips else peak
    return max(largest / peak, filled), max(largest / unit, filled), peak, 1.0 if clips else share


@njit(cache=True, inline="always")
def _moved(P, x, drive, slope, bend):
    """P + x; above ``drive`` no further than the pressure p(P) would go along its tangent.

    p grows exponentially with P: there, with ``bend`` = p'' the rate k = p'' / p' of growth, x becomes (1 - exp(-k x)) / k.
    """
    target = P + x
    rise = target - drive
    if bend == 0.0 or rise <= 0.0:
        return target
    k = bend / slope
    return drive - np.expm1(-min(k * rise, LARGEST_THICKENING)) / k


@njit(cache=True)
def take_step(
    P, load, fill, full, order, count, x, share, pc, complementary, conserves, tolerance, P_out, fill_out, full_out
):
    """Trial P + share x, or fill + share x, projected on what a closure allows; returns how many vertices rupture or fill up."""
    m = P.shape[1]
    P_out[:] = P
    if conserves:
        fill_out[:] = fill
        full_out[:] = full
    changes = 0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        if full[i, j]:
            p = _moved(P[i, j], share * x[k], load[DRIVE, i, j], load[SLOPE, i, j], load[BEND, i, j])
            if complementary and p < pc:
                p = pc
            if conserves and p < pc:
                if p < pc - tolerance:
                    full_out[i, j] = False
                    changes += 1
                p = pc
            P_out[i, j] = p
        else:
            f = fill[i, j] + share * x[k]
            if f > 1.0:
                if f > 1.0 + 1e-12:
                    full_out[i, j] = True
                    changes += 1
                f = 1.0
            fill_out[i, j] = f
    return changes
