"""Kernels of the film on an elastic liner: balance, Newton's matrix and the step control; see `exudyn_ehd.film.solvers.liner`.

Symbols: rigid (3, n, m) = gap, gap on links and rate of the undeformed surfaces; P pressure, pc cavity pressure, beta compliance
over pressure, all scaled; inverse_step 1 / dt; delta_old deflection at the start of the step; kind of closure; a, b ends of a
link.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.lu import add_flux, factor_lu
from exudyn_ehd.film.banded.numbering import number_cells
from exudyn_ehd.film.banded.substitution import solve_lu
from exudyn_ehd.film.banded.workspace import PAD

MAX_NEWTON_STEPS = 80
# Shares of the peak pressure: the error at which the solution stands, and steps too small for the residual to fall any further.
ERROR_TOLERANCE = 1e-13
STEP_TOLERANCE = 1e-8
# Share of the smallest gap; a peak pressure that deflects the liner by less counts as one that does by so much.
LEAST_DEFLECTION = 1e-10
# Share of the scaled speed, the pressure of a clearance (1) that is driven by it and closed after a radian: smaller peaks are those of a
# journal that is centred but for rounding, and count as so large.
LEAST_PRESSURE = 1e-6
# A factor from so near counts as that of the solution.
EXACT_STEP = 1e-7
# Of a sum of four flows, each a product of three numbers: a film that carries nothing is balanced to it, and no better.
ROUNDING = 1e-15
# Of the flows that drive a film: balances that may be left where suction is cut off.
BALANCED = 1e-7
FULL, CLIPPED, COMPLEMENTARY = 0, 1, 2
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def ends_open(rigid, P, beta, fixed):
    """Whether the gap is open where the pressure is prescribed, which is beyond the liner's reach."""
    n, m = P.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            if fixed[i, j]:
                if not rigid[0, i, j] + beta * P[i, j] > 0.0:
                    return False
                if fixed[nxt, j] and not rigid[1, i, j] + 0.5 * beta * (P[i, j] + P[nxt, j]) > 0.0:
                    return False
    return True


@njit(cache=True, fastmath=_FAST)
def deformed_film(
    rigid, P, beta, vx, vz, width_x, width_z, link_x, link_z, H_out, HF_out, kx_out, kz_out, fx_out, fz_out, b_out
):  # fmt: skip
    """Gaps on a liner that gives way by ``beta P``, and the coefficients of the film in them without its squeeze."""
    n, m = P.shape
    b_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            H_out[i, j] = rigid[0, i, j] + beta * P[i, j]
            h = rigid[1, i, j] + 0.5 * beta * (P[i, j] + P[nxt, j])
            d = 0.5 * beta * (P[nxt, j] - P[i, j])
            HF_out[i, j] = h
            kx_out[i, j] = h * (h * h + d * d) * lx * width_z[j]
            flux = v * h * width_z[j]
            fx_out[i, j] = flux
            b_out[i, j] -= flux
            b_out[nxt, j] += flux
        for j in range(m - 1):
            h = 0.5 * (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (P[i, j] + P[i, j + 1]))
            d = 0.5 * beta * (P[i, j + 1] - P[i, j])
            kz_out[i, j] = h * (h * h + d * d) * link_z[j] * width_x[i]
            flux = vz * h * width_x[i]
            fz_out[i, j] = flux
            b_out[i, j] -= flux
            b_out[i, j + 1] += flux
        kz_out[i, m - 1] = 0.0
        fz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def liner_link_derivatives(P, D, H, HF, beta, vx, vz, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ):
    """Derivatives of the links' flows with respect to their gaps and the speeds, at fixed pressure, as `sweep.LinkDerivatives`.

    ``P`` drives the flow, ``D`` bends the liner.
    """
    n, m = H.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            h = HF[i, j]
            d = 0.5 * beta * (D[nxt, j] - D[i, j])
            DX[i, j] = (linked * vx - (3.0 * h * h + d * d) * link_x[i] * (P[nxt, j] - P[i, j])) * width_z[j]
            SX[i, j] = linked * h * width_z[j]
        for j in range(m - 1):
            h = 0.5 * (H[i, j] + H[i, j + 1])
            d = 0.5 * beta * (D[i, j + 1] - D[i, j])
            DZ[i, j] = (vz - (3.0 * h * h + d * d) * link_z[j] * (P[i, j + 1] - P[i, j])) * width_x[i]
            SZ[i, j] = h * width_x[i]


@njit(cache=True)
def liner_shear_rhs(order, count, weight, H, active, beta, rhs_out):
    """Derivative of ``sum weight / H`` through the liner's answer to the pressure at the unknowns: rhs_out (count,)."""
    m = H.shape[1]
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        rhs_out[r] = -weight[i, j] * beta / (H[i, j] * H[i, j]) if active[i, j] else 0.0


@njit(cache=True, fastmath=_FAST)
def liner_residual(
    rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r_out
):  # fmt: skip
    """Balance of every vertex (outflow - inflow + squeeze); returns (norm of what is violated, smallest gap).

    A vertex at the cavity pressure violates only by r < 0 if the closure is complementary.
    """
    n, m = P.shape
    smallest = 1e300
    r_out[:] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            pa = P[i, j]
            pb = P[nxt, j]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[nxt, j]) else max(pb, pc)
            h = rigid[1, i, j] + 0.5 * beta * (da + db)
            smallest = min(smallest, h)
            d = 0.5 * beta * (db - da)
            q = width_z[j] * (v * h - h * (h * h + d * d) * lx * (pb - pa))
            r_out[nxt, j] -= q
            own = rigid[0, i, j] + beta * da
            smallest = min(smallest, own)
            rate = rigid[2, i, j] + (beta * da - delta_old[i, j]) * inverse_step
            r_out[i, j] += q + rate * width_x[i] * width_z[j]
        for j in range(m - 1):
            pa = P[i, j]
            pb = P[i, j + 1]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            db = pb if (kind != CLIPPED or fixed[i, j + 1]) else max(pb, pc)
            h = 0.5 * (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (da + db))
            d = 0.5 * beta * (db - da)
            q = width_x[i] * (vz * h - h * (h * h + d * d) * link_z[j] * (pb - pa))
            r_out[i, j] += q
            r_out[i, j + 1] -= q
    total = 0.0
    for i in range(n):
        for j in range(m):
            if not fixed[i, j]:
                r = r_out[i, j]
                if kind == COMPLEMENTARY and P[i, j] <= pc:
                    r = min(r, 0.0)
                total += r * r
    return np.sqrt(total), smallest


@njit(cache=True)
def flow_rounding(H, HF, rate, vx, vz, width_x, width_z, link_x):
    """Norm of the balances' rounding: of the Couette flows over the links, and of the squeeze."""
    n, m = H.shape
    total = 0.0
    for i in range(n):
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            total += (v * HF[i, j] * width_z[j]) ** 2 + (vz * H[i, j] * width_x[i]) ** 2
            total += (rate[i, j] * width_x[i] * width_z[j]) ** 2
    return ROUNDING * np.sqrt(total)


@njit(cache=True)
def assemble_liner(
    rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, number, count, width, lower,
    upper,
):  # fmt: skip
    """d(balance)/dP of the numbered vertices into the two bands."""
    n, m = P.shape
    for r in range(count):
        for d in range(width + 1 + PAD):
            lower[r, d] = 0.0
            upper[r, d] = 0.0
    storage = beta * inverse_step
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        lx = link_x[i]
        v = vx if lx != 0.0 else 0.0
        for j in range(m):
            a = number[i, j]
            b = number[nxt, j]
            pa = P[i, j]
            da = pa if (kind != CLIPPED or fixed[i, j]) else max(pa, pc)
            if a >= 0 and storage != 0.0 and da == pa:
                upper[a, 0] += storage * width_x[i] * width_z[j]
            if (a >= 0 or b >= 0) and lx != 0.0:
                pb = P[nxt, j]
                db = pb if (kind != CLIPPED or fixed[nxt, j]) else max(pb, pc)
                h = rigid[1, i, j] + 0.5 * beta * (da + db)
                d = 0.5 * beta * (db - da)
                drop = lx * (pb - pa)
                k = width_z[j] * h * (h * h + d * d) * lx
                by_h = 0.5 * width_z[j] * beta * (v - (3.0 * h * h + d * d) * drop)
                by_d = width_z[j] * beta * h * d * drop
                add_flux(
                    a, b, k + (by_h + by_d if da == pa else 0.0), -k + (by_h - by_d if db == pb else 0.0), lower, upper
                )
            if j + 1 == m:
                continue
            b = number[i, j + 1]
            if a >= 0 or b >= 0:
                pb = P[i, j + 1]
                db = pb if (kind != CLIPPED or fixed[i, j + 1]) else max(pb, pc)
                h = 0.5 * (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (da + db))
                d = 0.5 * beta * (db - da)
                drop = link_z[j] * (pb - pa)
                k = width_x[i] * h * (h * h + d * d) * link_z[j]
                by_h = 0.5 * width_x[i] * beta * (vz - (3.0 * h * h + d * d) * drop)
                by_d = width_x[i] * beta * h * d * drop
                add_flux(
                    a, b, k + (by_h + by_d if da == pa else 0.0), -k + (by_h - by_d if db == pb else 0.0), lower, upper
                )


@njit(cache=True)
def factor_liner(
    rigid, P, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step,
    active, order, number, lower, upper, inv_diag,
):  # fmt: skip
    """Newton's matrix at P, factored; returns (ok, count, width)."""
    count, width = number_cells(active, links, order, number)
    assemble_liner(
        rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, number, count, width,
        lower, upper,
    )  # fmt: skip
    return factor_lu(lower, upper, count, width, inv_diag), count, width


@njit(cache=True)
def select(P, r, fixed, pc, kind, active):
    """Vertices that carry pressure or are about to; returns the number of changes."""
    n, m = P.shape
    changes = 0
    for i in range(n):
        for j in range(m):
            new = not fixed[i, j] and (kind != COMPLEMENTARY or P[i, j] > pc or r[i, j] <= 0.0)
            if new != active[i, j]:
                active[i, j] = new
                changes += 1
    return changes


@njit(cache=True)
def _longest_step(H0, P, order, count, x, beta):
    """Share of the step x that uses up at most 80 % of any vertex's gap."""
    m = P.shape[1]
    share = 1.0
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        change = beta * x[k]
        gap = H0[i, j] + beta * P[i, j]
        if change < -0.8 * gap and gap > 0.0:
            share = min(share, -0.8 * gap / change)
    return share


@njit(cache=True)
def _take(P, x, share, order, count, pc, kind, trial_out):
    """Trial pressures P + share x, cut off at the cavity pressure."""
    m = P.shape[1]
    trial_out[:] = P
    for k in range(count):
        i = order[k] // m
        j = order[k] - i * m
        p = P[i, j] + share * x[k]
        trial_out[i, j] = pc if (kind == COMPLEMENTARY and p < pc) else p


@njit(cache=True)
def solve_liner(
    rigid, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step, delta_old,
    cold, held, count, width, active, order, number, lower, upper, inv_diag, x, r, trial, P,
):  # fmt: skip
    """Newton from P, ``cold`` from all free vertices; returns (ok, steps, exact, count, width).

    A factor serves further steps as long as the set stays and each step is five times smaller than the last; the first step takes
    that of the last film (``count``, ``width``) if there is one (``held``). ``exact`` says that the last factor belongs to the solution.
    """
    n, m = P.shape
    if kind == COMPLEMENTARY:
        for i in range(n):
            for j in range(m):
                if not fixed[i, j] and P[i, j] < pc:
                    P[i, j] = pc
    norm, smallest = liner_residual(
        rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r
    )
    if not smallest > 0.0:
        return False, 0, False, 0, 1
    if cold:
        # Vertices leave all at once but join one row per step: start from all of them.
        active[:] = np.logical_not(fixed)
    elif not held:
        select(P, r, fixed, pc, kind, active)
    reference = pc if kind != FULL else 0.0
    last = moved = 0.0
    factored = held
    for step in range(MAX_NEWTON_STEPS):
        fresh = not factored
        if fresh:
            ok, count, width = factor_liner(
                rigid, P, vx, vz, width_x, width_z, link_x, link_z, links, fixed, pc, kind, beta, inverse_step,
                active, order, number, lower, upper, inv_diag,
            )  # fmt: skip
            if not ok:
                return False, step + 1, False, count, width
            if count == 0 or norm == 0.0:
                return True, step + 1, True, count, width
            moved = 0.0
        # pressures that no gap answers to are none: a film at rest ends here
        peak = max(LEAST_DEFLECTION * smallest / beta, LEAST_PRESSURE * (abs(vx) + abs(vz)))
        pressing = peak
        for k in range(count):
            i = order[k] // m
            j = order[k] - i * m
            x[k] = -r[i, j]
            peak = max(peak, abs(P[i, j] - reference))
            pressing = max(pressing, P[i, j] - reference)
        # What is cut off may lie far below the cavity pressure and drops over the bent gaps: there a step is small by what presses and
        # by what opens the smallest gap.
        bent = min(pressing, smallest / beta) if kind == CLIPPED else peak
        solve_lu(lower, upper, inv_diag, count, width, x.reshape(1, x.size))
        largest = 0.0
        for k in range(count):
            if not abs(x[k]) < 1e300:
                return False, step + 1, False, count, width
            largest = max(largest, abs(x[k]))
        borrowed = held and step == 0
        standing = largest <= ERROR_TOLERANCE * peak
        if not fresh and not borrowed and not standing and largest > 0.2 * last:
            factored = False
            continue
        share = _longest_step(rigid[0], P, order, count, x, beta) if kind != CLIPPED else 1.0
        before = norm
        for _ in range(1 if borrowed else 12):
            _take(P, x, share, order, count, pc, kind, trial)
            norm, smallest = liner_residual(
                rigid, trial, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old,
                r,
            )  # fmt: skip
            if smallest > 0.0 and (norm < before or largest <= STEP_TOLERANCE * peak):
                break
            share *= 0.5
        if borrowed and not (smallest > 0.0 and (norm < before or standing)):
            norm, smallest = liner_residual(
                rigid, P, vx, vz, width_x, width_z, link_x, link_z, fixed, pc, kind, beta, inverse_step, delta_old, r
            )
            select(P, r, fixed, pc, kind, active)
            factored = False
            continue
        if not (smallest > 0.0 and norm < 1e300):
            return False, step + 1, False, count, width
        P[:] = trial
        moved += share * largest
        changes = select(P, r, fixed, pc, kind, active)
        factored = changes == 0 and share == 1.0
        if factored:
            # What is left: about the square of a Newton step, or a step times its ratio to the last one.
            rest, unit = (10.0 * largest * largest, bent) if fresh else (largest * largest, last)
            if kind == CLIPPED:
                unit = min(unit, bent)
            if standing and kind == CLIPPED:
                # suction without bounds makes any step a small one
                driven = flow_rounding(rigid[0], rigid[1], rigid[2], vx, vz, width_x, width_z, link_x) / ROUNDING
                standing = norm <= BALANCED * driven
            if standing or (not borrowed and rest <= ERROR_TOLERANCE * bent * unit):
                return True, step + 1, not borrowed and moved <= EXACT_STEP * peak, count, width
        last = largest
    return False, MAX_NEWTON_STEPS, False, count, width
