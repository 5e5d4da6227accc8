"""Kernels of the film on a liner that touches or keeps its oil: columns, balance, Newton's matrix; see `exudyn_ehd.film.compliant`.

Symbols, all scaled: P pressure, pc cavity pressure, beta compliance; G true gap, H the gap that the film sees, HF that on the links
i -> i+1, D deflection, E = H - (film gap of the undeformed surfaces); a, b ends of a link. ``_P``, ``_r``, ``_fill``: derivatives to the
pressure, to the undeformed gap, and to the fill.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.band_lu import PAD, add_flux, factor_lu, solve_lu
from exudyn_ehd.film.direct import number_cells

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class Columns(NamedTuple):
    """The state of every column of liner, (n, m) arrays.

    Attributes
    ----------
    H, HF, D, E : (n, m) arrays
        Film gap at vertices and on links, deflection, and what it adds to the film gap.
    H_P, D_P, H_r, D_r, E_r : (n, m) arrays
        Derivatives to the pressure and to the undeformed gap at fixed pressure.
    link : (n, m) array
        Derivative of HF to the true gap on the link.
    rate, rate_P, rate_r, rate_t : (n, m) arrays
        dH/dt with its derivatives to the pressure, the undeformed gap and the undeformed rate.
    """

    H: np.ndarray
    HF: np.ndarray
    D: np.ndarray
    E: np.ndarray
    H_P: np.ndarray
    D_P: np.ndarray
    H_r: np.ndarray
    D_r: np.ndarray
    E_r: np.ndarray
    link: np.ndarray
    rate: np.ndarray
    rate_P: np.ndarray
    rate_r: np.ndarray
    rate_t: np.ndarray


class Storage(NamedTuple):
    """What a control volume's content gains per time, with its derivatives to pressure and fill, (n, m) arrays."""

    gain: np.ndarray
    gain_P: np.ndarray
    gain_fill: np.ndarray


@njit(cache=True, fastmath=_FAST)
def press_columns(rigid, P, fixed, pc, clips, beta, G_out):
    """Gap under the film's pressure alone; a film that clips presses with no less than pc."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            p = P[i, j]
            if clips and not fixed[i, j] and p < pc:
                p = pc
            G_out[i, j] = rigid[0, i, j] + beta * p


@njit(cache=True, fastmath=_FAST)
def move_columns(rigid, G, delta_old, inverse, c):
    """Deflections, and gaps and rate of the deformed surfaces, into ``c`` (Columns), where a limiter may change them."""
    n, m = G.shape
    for i in range(n):
        for j in range(m):
            d = G[i, j] - rigid[0, i, j]
            c.D[i, j] = d
            c.H[i, j] = G[i, j]
            c.rate[i, j] = rigid[2, i, j] + (d - delta_old[i, j]) * inverse
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            c.HF[i, j] = rigid[1, i, j] + 0.5 * (c.D[i, j] + c.D[nxt, j])


@njit(cache=True, fastmath=_FAST)
def answer_columns(rigid_film, rigid_slope, P, contact_G, bend, fixed, pc, clips, beta, inverse, c):
    """What the columns answer to pressure and undeformed gap, for film gaps, rate and their slope (``c.rate_t``) in ``c`` (Columns).

    ``contact_G`` is d(contact pressure)/dG over the film's scale, ``bend`` the film gap's second derivative times the gap's rate.
    """
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            follow = 1.0 / (1.0 - beta * contact_G[i, j])
            free = not clips or fixed[i, j] or P[i, j] >= pc
            s = c.rate_t[i, j]
            c.E[i, j] = c.H[i, j] - rigid_film[i, j]
            c.D_P[i, j] = beta * follow if free else 0.0
            c.H_P[i, j] = s * c.D_P[i, j]
            c.D_r[i, j] = follow - 1.0
            c.H_r[i, j] = s * follow
            c.E_r[i, j] = c.H_r[i, j] - rigid_slope[i, j]
            c.rate_P[i, j] = (bend[i, j] + s * inverse) * c.D_P[i, j]
            c.rate_r[i, j] = bend[i, j] * follow + s * inverse * c.D_r[i, j]


@njit(cache=True, fastmath=_FAST)
def set_storage(c, P, fill, area, mass_old, mass_inverse, with_rate, extra, extra_old, conserves, beta, out):
    """Storage ``out`` of every vertex: of the mass fill H over a step, of the gap's rate, and of pseudo time (``extra``)."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            w = area[i, j]
            f = fill[i, j]
            if conserves:
                pull = mass_inverse + extra
                mass = f * c.H[i, j]
                gain = mass * pull - mass_old[i, j] * mass_inverse - extra_old[i, j] * extra
                by_p = f * c.H_P[i, j] * pull
                by_fill = c.H[i, j] * pull
                if with_rate:
                    gain += f * c.rate[i, j]
                    by_p += f * c.rate_P[i, j]
                    by_fill += c.rate[i, j]
                out.gain[i, j], out.gain_P[i, j], out.gain_fill[i, j] = w * gain, w * by_p, w * by_fill
            else:
                out.gain[i, j] = w * (c.rate[i, j] + extra * (beta * P[i, j] - extra_old[i, j]))
                out.gain_P[i, j] = w * (c.rate_P[i, j] + extra * beta)


@njit(cache=True, fastmath=_FAST)
def compliant_residual(c, P, fill, gain, vx, vz, width_x, width_z, link_x, link_z, r_out):
    """Balance of every vertex: outflow - inflow + storage."""
    n, m = P.shape
    for i in range(n):
        for j in range(m):
            r_out[i, j] = gain[i, j]
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            h = c.HF[i, j]
            d = 0.5 * (c.E[nxt, j] - c.E[i, j])
            f = fill[i, j] if v >= 0.0 else fill[nxt, j]
            q = width_z[j] * (v * f * h - h * (h * h + d * d) * lx * (P[nxt, j] - P[i, j]))
            r_out[i, j] += q
            r_out[nxt, j] -= q
        for j in range(m - 1):
            h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
            q = width_x[i] * (vz * f * h - h * (h * h + d * d) * link_z[j] * (P[i, j + 1] - P[i, j]))
            r_out[i, j] += q
            r_out[i, j + 1] -= q


@njit(cache=True)
def violation(c, r, P, fixed, pc, complementary):
    """(norm of the balances that do not hold, smallest film gap); at pc oil may be drawn away if ``complementary``."""
    n, m = P.shape
    total = 0.0
    smallest = 1e300
    for i in range(n):
        for j in range(m):
            smallest = min(smallest, min(c.H[i, j], c.HF[i, j]))
            if not fixed[i, j]:
                s = r[i, j]
                if complementary and P[i, j] <= pc:
                    s = min(s, 0.0)
                total += s * s
    return np.sqrt(total), smallest


@njit(cache=True)
def assemble_compliant(
    c, P, fill, full, storage, vx, vz, width_x, width_z, link_x, link_z, number, count, width, lower, upper
):  # fmt: skip
    """d(balance)/d(unknown) of the numbered vertices into the two bands; the unknown is P where ``full``, else the fill."""
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
                upper[a, 0] += storage.gain_P[i, j] if full[i, j] else storage.gain_fill[i, j]
            if (a >= 0 or b >= 0) and lx != 0.0:
                h = c.HF[i, j]
                d = 0.5 * (c.E[nxt, j] - c.E[i, j])
                f = fill[i, j] if v >= 0.0 else fill[nxt, j]
                drop = lx * (P[nxt, j] - P[i, j])
                k = width_z[j] * h * (h * h + d * d) * lx
                by_h = 0.5 * width_z[j] * c.link[i, j] * (v * f - (3.0 * h * h + d * d) * drop)
                by_d = width_z[j] * h * d * drop
                carried = width_z[j] * v * h
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
                h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
                d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
                f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
                drop = link_z[j] * (P[i, j + 1] - P[i, j])
                k = width_x[i] * h * (h * h + d * d) * link_z[j]
                by_h = 0.5 * width_x[i] * (vz * f - (3.0 * h * h + d * d) * drop)
                by_d = width_x[i] * h * d * drop
                carried = width_x[i] * vz * h
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
def longest_step(c, full, order, count, x):
    """Share of the step x that uses up at most 80 % of any vertex's film gap."""
    m = c.H.shape[1]
    share = 1.0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        if full[i, j]:
            change = c.H_P[i, j] * x[k]
            if change < -0.8 * c.H[i, j]:
                share = min(share, -0.8 * c.H[i, j] / change)
    return share


@njit(cache=True)
def step_size(P, full, order, count, x, pc, clips, least, opening):
    """Largest step over the peak pressure (at least ``least``), or of a fill; the square of what is left after it; the peak.

    What a film that clips cuts off may lie far below pc and drops over the bent gaps, so that its steps are small by what presses and by
    ``opening``, the pressure that opens the smallest gap. Infinite for steps that are not finite.
    """
    m = P.shape[1]
    peak = least
    pressing = least
    largest = 0.0
    filled = 0.0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        if not abs(x[k]) < 1e300:
            return np.inf, np.inf, peak
        if full[i, j]:
            peak = max(peak, abs(P[i, j] - pc))
            pressing = max(pressing, P[i, j] - pc)
            largest = max(largest, abs(x[k]))
        else:
            filled = max(filled, abs(x[k]))
    unit = min(pressing, opening) if clips else peak
    return max(largest / peak, filled), max(largest / unit, filled) ** 2, peak


@njit(cache=True)
def take_step(
    P, fill, full, order, count, x, share, pc, complementary, conserves, tolerance, P_out, fill_out, full_out
):
    """Trial P + share x, or fill + share x, projected on what a closure allows; returns how many vertices rupture or fill up."""
    m = P.shape[1]
    P_out[:] = P
    fill_out[:] = fill
    full_out[:] = full
    changes = 0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        if full[i, j]:
            p = P[i, j] + share * x[k]
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


@njit(cache=True)
def compliant_sensitivities(
    lam, c, P, fill, gain_r, gain_t, vx, vz, width_x, width_z, link_x, link_z, cell, face, rate, speed
):  # fmt: skip
    """Gradients of the adjoint functionals lam (k, n, m) to the undeformed gap at vertices and links, its rate and the speeds.

    ``gain_r``, ``gain_t`` (n, m): derivatives of the storage to the undeformed gap and rate.
    """
    count, n, m = lam.shape
    for k in range(count):
        for i in range(n):
            for j in range(m):
                cell[k, i, j] = -lam[k, i, j] * gain_r[i, j]
                rate[k, i, j] = -lam[k, i, j] * gain_t[i, j]
        sx = 0.0
        sz = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            lx = link_x[i]
            v = vx if lx != 0.0 else 0.0
            for j in range(m):
                h = c.HF[i, j]
                d = 0.5 * (c.E[nxt, j] - c.E[i, j])
                f = fill[i, j] if v >= 0.0 else fill[nxt, j]
                drop = lx * (P[nxt, j] - P[i, j])
                out = (lam[k, nxt, j] - lam[k, i, j]) * width_z[j]
                by_h = out * c.link[i, j] * (v * f - (3.0 * h * h + d * d) * drop)
                by_d = out * h * d * drop
                face[k, i, j] = by_h
                cell[k, i, j] += 0.5 * by_h * c.D_r[i, j] + by_d * c.E_r[i, j]
                cell[k, nxt, j] += 0.5 * by_h * c.D_r[nxt, j] - by_d * c.E_r[nxt, j]
                if lx != 0.0:
                    sx += out * f * h
            for j in range(m - 1):
                h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
                d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
                f = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
                drop = link_z[j] * (P[i, j + 1] - P[i, j])
                out = (lam[k, i, j + 1] - lam[k, i, j]) * width_x[i]
                by_h = 0.5 * out * (vz * f - (3.0 * h * h + d * d) * drop)
                by_d = out * h * d * drop
                cell[k, i, j] += by_h * c.H_r[i, j] + by_d * c.E_r[i, j]
                cell[k, i, j + 1] += by_h * c.H_r[i, j + 1] - by_d * c.E_r[i, j + 1]
                sz += out * f * h
        speed[k, 0] = sx
        speed[k, 1] = sz


@njit(cache=True)
def compliant_coefficients(c, vx, vz, width_x, width_z, link_x, link_z, kx_out, kz_out, fx_out, fz_out, b_out):
    """Conductances and Couette fluxes of a full film in the deformed gap; ``b_out`` without storage."""
    n, m = c.H.shape
    b_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            h = c.HF[i, j]
            d = 0.5 * (c.E[nxt, j] - c.E[i, j])
            kx_out[i, j] = h * (h * h + d * d) * link_x[i] * width_z[j]
            fx_out[i, j] = v * h * width_z[j]
            b_out[i, j] -= fx_out[i, j]
            b_out[nxt, j] += fx_out[i, j]
        for j in range(m - 1):
            h = 0.5 * (c.H[i, j] + c.H[i, j + 1])
            d = 0.5 * (c.E[i, j + 1] - c.E[i, j])
            kz_out[i, j] = h * (h * h + d * d) * link_z[j] * width_x[i]
            fz_out[i, j] = vz * h * width_x[i]
            b_out[i, j] -= fz_out[i, j]
            b_out[i, j + 1] += fz_out[i, j]
        kz_out[i, m - 1] = 0.0
        fz_out[i, m - 1] = 0.0


@njit(cache=True)
def newton_step(
    c, P, fill, full, storage, vx, vz, width_x, width_z, link_x, link_z, links, active, order, number, lower, upper,
    inv_diag, r, x,
):  # fmt: skip
    """Factor Newton's matrix of the ``active`` vertices and solve for the step x; returns (ok, count, width)."""
    count, width = number_cells(active, links, order, number)
    assemble_compliant(
        c, P, fill, full, storage, vx, vz, width_x, width_z, link_x, link_z, number, count, width, lower, upper
    )
    if not factor_lu(lower, upper, count, width, inv_diag):
        return False, count, width
    m = P.shape[1]
    for k in range(count):
        i = order[k] // m
        x[k] = -r[i, order[k] - i * m]
    if count > 0:
        solve_lu(lower, upper, inv_diag, count, width, x.reshape(1, x.size))
    return True, count, width
