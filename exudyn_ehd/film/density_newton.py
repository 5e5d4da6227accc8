"""Kernels of the compressible film: balance, Newton's matrix, its sets and gradients; see `exudyn_ehd.film.compressible`.

Symbols: P transformed pressure, fill film fraction, rho density ratio at the vertices and rho_P its derivative to P; k, f conductance
and Couette flux of a link (those of a film of density 1) and ``sigma = fill_upstream (rho_a + rho_b) / 2`` on the link a -> b;
full: P is the unknown of a vertex, else its fill.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.band_lu import factor_lu, solve_lu, solve_lu_transposed
from exudyn_ehd.film.density import density_near, density_of_transformed, near_value
from exudyn_ehd.film.direct import PAD, number_cells
from exudyn_ehd.film.elrod import _add_entry

MAX_NEWTON_STEPS = 60
# Shares of the peak pressure: where a vertex changes sides, and the error at which the solution stands.
SET_TOLERANCE = 1e-12
ERROR_TOLERANCE = 1e-14
# A step so small leaves an error of its square; a factor from so near, or one with which steps shrink so fast, counts as exact.
LAST_STEP = 1e-7
# Steps without a limit; then the share of the way to the end of the law's range that one may cover, and steps in a row that may want more.
WHOLE_STEPS = 16
TO_THE_END = 0.9
MAX_CUT_STEPS = 16
EXACT_RATIO = 1e-8
FULL, CLIPPED, COMPLEMENTARY, FILLED = 0, 1, 2, 3
AT, RHO, RHO_P = 0, 6, 7
_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned: Any = np.uint64
_0, _1 = _unsigned(0), _unsigned(1)


class Balance(NamedTuple):
    """One film's coefficients, (n, m) each; the storage of a vertex is ``area (rho (grow fill + known) + kept)``."""

    kx: np.ndarray
    kz: np.ndarray
    fx: np.ndarray
    fz: np.ndarray
    grow: np.ndarray
    known: np.ndarray
    kept: np.ndarray
    area: np.ndarray
    fixed: np.ndarray


class Buffers(NamedTuple):
    """Arrays that a solution works on: numbering, factor (`dense_band`), right-hand side, fields (8, n, m) and residual (n, m).

    The fields are transformed pressures at which the law is known, p, s and its derivatives there (`density.density_of_transformed`), and rho and
    rho_P at the pressures of the last balance.
    """

    order: np.ndarray
    number: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    inv_diag: np.ndarray
    x: np.ndarray
    fields: np.ndarray
    residual: np.ndarray


@njit(cache=True, fastmath=_FAST)
def compressible_balance(P, fill, rho, film, out):
    """Mass that leaves every vertex (n, m) less what it holds in store: 0 where the film is solved."""
    n, m = P.shape
    kx, kz, fx, fz, area = film.kx, film.kz, film.fx, film.fz, film.area
    grow, known, kept = film.grow, film.known, film.kept
    for i in range(n):
        for j in range(m):
            store = rho[i, j] * (grow[i, j] * fill[i, j] + known[i, j]) + kept[i, j]
            out[i, j] = area[i, j] * store
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            f = fx[i, j]
            up = fill[i, j] if f >= 0.0 else fill[nxt, j]
            q = kx[i, j] * (P[i, j] - P[nxt, j]) + 0.5 * f * up * (rho[i, j] + rho[nxt, j])
            out[i, j] += q
            out[nxt, j] -= q
        for j in range(m - 1):
            f = fz[i, j]
            up = fill[i, j] if f >= 0.0 else fill[i, j + 1]
            q = kz[i, j] * (P[i, j] - P[i, j + 1]) + 0.5 * f * up * (rho[i, j] + rho[i, j + 1])
            out[i, j] += q
            out[i, j + 1] -= q


@njit(cache=True, fastmath=_FAST)
def _link_flows(kx, fx, P_a, P_b, rho_a, rho_b, out):
    """Mass flows of a full film over links a -> b, flat."""
    for c in range(out.size):
        out[c] = kx[c] * (P_a[c] - P_b[c]) + 0.5 * fx[c] * (rho_a[c] + rho_b[c])


@njit(cache=True, fastmath=_FAST)
def _gather_flows(area, rho, grow, across, across_in, along, along_in, out):
    """Flows that leave and the mass in store, less the flows that come in, flat."""
    for c in range(out.size):
        out[c] = area[c] * rho[c] * grow[c] + across[c] - across_in[c] + along[c] - along_in[c]


@njit(cache=True)
def full_balance(P, rho, film, out):
    """As `compressible_balance` for a full film without a history, in loops that the compiler vectorises."""
    n, m = P.shape
    size = n * m
    last = size - m
    p, r, q = P.reshape(-1), rho.reshape(-1), out.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    area, grow = film.area.reshape(-1), film.grow.reshape(-1)
    along = np.empty(size + m)
    across = np.empty(size + 1)
    _link_flows(kx[:last], fx[:last], p[:last], p[m:], r[:last], r[m:], along[m:size])
    _link_flows(kx[last:], fx[last:], p[last:], p[:m], r[last:], r[:m], along[size:])
    along[:m] = along[size:]
    # nothing flows over the last row's links in z
    _link_flows(kz[: size - 1], fz[: size - 1], p[: size - 1], p[1:], r[: size - 1], r[1:], across[1:size])
    across[0] = across[size] = 0.0
    _gather_flows(area, r, grow, across[1:], across[:size], along[m:], along[:size], q)


@njit(cache=True)
def link_factors(fill, rho, fx, fz, sigma_x_out, sigma_z_out):
    """sigma on the links in theta and z (0 behind the last row)."""
    n, m = rho.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            up = fill[i, j] if fx[i, j] >= 0.0 else fill[nxt, j]
            sigma_x_out[i, j] = 0.5 * up * (rho[i, j] + rho[nxt, j])
        for j in range(m - 1):
            up = fill[i, j] if fz[i, j] >= 0.0 else fill[i, j + 1]
            sigma_z_out[i, j] = 0.5 * up * (rho[i, j] + rho[i, j + 1])
        sigma_z_out[i, m - 1] = 0.0


@njit(cache=True)
def _add_link(a, b, full_a, full_b, k, f, fill_a, fill_b, rho_a, rho_b, by_a, by_b, lower, upper):
    """Derivatives of the flux over one link a -> b into the rows of its ends; a, b are unknowns or -1."""
    mean = 0.5 * (rho_a + rho_b)
    up = fill_a if f >= 0.0 else fill_b
    if a >= 0:
        if full_a:
            d = k + 0.5 * f * up * by_a
        else:
            d = f * mean if f >= 0.0 else 0.0
        upper[a, 0] += d
        if b >= 0:
            _add_entry(lower, upper, b, a, -d)
    if b >= 0:
        if full_b:
            d = -k + 0.5 * f * up * by_b
        else:
            d = f * mean if f < 0.0 else 0.0
        upper[b, 0] -= d
        if a >= 0:
            _add_entry(lower, upper, a, b, d)


@njit(cache=True)
def assemble_compressible(fill, rho, rho_P, film, full, number, order, count, width, lower, upper):
    """Newton's matrix of the numbered vertices into the two bands."""
    n, m = rho.shape
    kx, kz, fx, fz, area = film.kx, film.kz, film.fx, film.fz, film.area
    grow, known = film.grow, film.known
    for r in range(count):
        for d in range(width + 1 + PAD):
            lower[r, d] = 0.0
            upper[r, d] = 0.0
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        for j in range(m):
            a = number[i, j]
            b = number[nxt, j]
            if (a >= 0 or b >= 0) and kx[i, j] != 0.0:
                _add_link(
                    a, b, full[i, j], full[nxt, j], kx[i, j], fx[i, j], fill[i, j], fill[nxt, j], rho[i, j],
                    rho[nxt, j], rho_P[i, j], rho_P[nxt, j], lower, upper,
                )  # fmt: skip
            if j + 1 < m:
                b = number[i, j + 1]
                if a >= 0 or b >= 0:
                    _add_link(
                        a, b, full[i, j], full[i, j + 1], kz[i, j], fz[i, j], fill[i, j], fill[i, j + 1],
                        rho[i, j], rho[i, j + 1], rho_P[i, j], rho_P[i, j + 1], lower, upper,
                    )  # fmt: skip
            if a >= 0:
                if full[i, j]:
                    store = rho_P[i, j] * (grow[i, j] * fill[i, j] + known[i, j])
                else:
                    store = rho[i, j] * grow[i, j]
                upper[a, 0] += area[i, j] * store


@njit(cache=True)
def assemble_full(rho_P, film, number, order, count, lower, upper):
    """As `assemble_compressible` where every unknown is a pressure and every film full, into dense bands (count, stride).

    Row by row with flat unsigned indices, which need no check of their sign.
    """
    n, m = number.shape
    size, rows = _unsigned(n * m), _unsigned(m)
    last = size - rows
    by, places = rho_P.reshape(-1), number.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    area, grow = film.area.reshape(-1), film.grow.reshape(-1)
    low, up = lower.reshape(-1), upper.reshape(-1)
    stride = _unsigned(lower.shape[1])
    for q in range(low.size):
        low[q] = 0.0
    for q in range(up.size):
        up[q] = 0.0
    for r in range(count):
        row = _unsigned(r)
        c = _unsigned(order[r])
        nxt = c + rows if c < last else c - last
        prv = c - rows if c >= rows else c + last
        # links in theta, then in z, where those at the film's ends conduct nothing
        k, f, b = kx[c], 0.5 * fx[c], places[nxt]
        diagonal = k
        carried = area[c] * grow[c] + f
        if k != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] += f * by[nxt] - k
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] += f * by[nxt] - k
        k, f, b = kx[prv], 0.5 * fx[prv], places[prv]
        diagonal += k
        carried -= f
        if k != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] -= f * by[prv] + k
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] -= f * by[prv] + k
        k, f = kz[c], 0.5 * fz[c]
        diagonal += k
        carried += f
        if k != 0.0 and places[c + _1] >= 0:
            up[row * stride + _1] += f * by[c + _1] - k
        if c > _0:
            k, f = kz[c - _1], 0.5 * fz[c - _1]
            diagonal += k
            carried -= f
            if k != 0.0 and places[c - _1] >= 0:
                low[(row - _1) * stride + _1] -= f * by[c - _1] + k
        up[row * stride] = diagonal + carried * by[c]


@njit(cache=True)
def dense_band(buffer, count, width):
    """The part of a contiguous buffer that holds a band, row after row."""
    stride = width + 1 + PAD
    return buffer.reshape(-1)[: count * stride].reshape(count, stride)


@njit(cache=True)
def factor_compressible(fill, film, kind, full, b):
    """Newton's matrix at the density in ``b.fields``, factored; returns (ok, count, width)."""
    if kind == COMPLEMENTARY:
        count, width = number_cells(full, film.kx, b.order, b.number)
    else:
        count, width = number_cells(np.logical_not(film.fixed), film.kx, b.order, b.number)
    lower, upper = dense_band(b.lower, count, width), dense_band(b.upper, count, width)
    if kind == FILLED:
        assemble_compressible(
            fill, b.fields[RHO], b.fields[RHO_P], film, full, b.number, b.order, count, width, lower, upper
        )
    else:
        assemble_full(b.fields[RHO_P], film, b.number, b.order, count, lower, upper)
    return factor_lu(lower, upper, count, width, b.inv_diag), count, width


@njit(cache=True)
def _take(P, fill, full, order, count, x, pc, kind, end):
    """Add the step x; returns its largest share of the peak pressure (or of a full film), the peak and how often the law's end cut it.

    The density climbs ever more steeply towards ``end``, where the pressure has no bound (viscosity laws whose integral is finite), and is
    taken as constant beyond, so that whole steps across it can bounce back for ever. Cut steps cover nine tenths of the way.
    """
    m = P.shape[1]
    cuts = 0
    reference = 0.0 if kind == FULL else pc
    peak = 1e-300
    by_pressure = 0.0
    by_fill = 0.0
    for r in range(count):
        i = order[r] // m
        j = order[r] - i * m
        if full[i, j]:
            if P[i, j] < end <= P[i, j] + x[r]:
                P[i, j] += TO_THE_END * (end - P[i, j])
                cuts += 1
            else:
                P[i, j] += x[r]
            peak = max(peak, abs(P[i, j] - reference))
            by_pressure = max(by_pressure, abs(x[r]))
        else:
            fill[i, j] += x[r]
            by_fill = max(by_fill, abs(x[r]))
    return max(by_pressure / peak, by_fill), peak, cuts


@njit(cache=True)
def _select(P, fill, r, fixed, full, pc, kind, floor):
    """Vertices change sides: pressures below ``floor``, films above 1 (or, without a fill, oil that piles up); returns their number."""
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
            elif r[i, j] <= 0.0:
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
def _balance_at(P, fill, film, kind, scale, floor, law, share, b):
    """Density and balance at P."""
    c = b.fields
    known = c[AT], c[AT + 1], c[AT + 2], c[AT + 3], c[AT + 4], c[AT + 5]
    if not density_near(P, scale, floor, law, share, *known, c[RHO], c[RHO_P]):
        density_of_transformed(P, scale, floor, law, share, *known, c[RHO], c[RHO_P])
    _balance(P, fill, film, kind, b)


@njit(cache=True)
def _balance(P, fill, film, kind, b):
    if kind == FILLED:
        compressible_balance(P, fill, b.fields[RHO], film, b.residual)
    else:
        full_balance(P, b.fields[RHO], film, b.residual)


@njit(cache=True)
def solve_compressible(film, scale, pc, kind, law, share, held, count, width, full, b, P, fill):
    """Newton from P, fill and the sets in ``full``; returns (ok, steps, exact, count, width).

    A factor serves further steps as long as the sets stay and each step is five times smaller than the last; the first step takes
    that of the last film (``count``, ``width``) if there is one (``held``). A film that presses against the end of the law's range for
    `MAX_CUT_STEPS` has no pressure there. ``exact`` says that the last factor is that of the
    solution.
    """
    floor = -np.inf if kind == FULL else pc
    m = P.shape[1]
    _start(P, fill, film, full, pc, kind)
    _balance_at(P, fill, film, kind, scale, floor, law, share, b)
    last = moved = 0.0
    fresh = not held
    end = law.highest / scale
    cut_steps = 0
    for step in range(MAX_NEWTON_STEPS):
        if fresh:
            ok, count, width = factor_compressible(fill, film, kind, full, b)
            if not ok:
                return False, step + 1, False, count, width
            moved = 0.0
        for r in range(count):
            i = b.order[r] // m
            b.x[r] = -b.residual[i, b.order[r] - i * m]
        solve_lu(
            dense_band(b.lower, count, width), dense_band(b.upper, count, width), b.inv_diag, count, width,
            b.x.reshape(1, b.x.size),
        )  # fmt: skip
        size, peak, cuts = _take(P, fill, full, b.order, count, b.x, pc, kind, end if step >= WHOLE_STEPS else np.inf)
        if not size < 1e300:
            return False, step + 1, False, count, width
        if size <= ERROR_TOLERANCE:
            return True, step + 1, not (held and step == 0) and moved <= LAST_STEP, count, width
        moved += size
        _balance_at(P, fill, film, kind, scale, floor, law, share, b)
        changes = 0
        if kind >= COMPLEMENTARY:
            changes = _select(P, fill, b.residual, film.fixed, full, pc, kind, pc - SET_TOLERANCE * peak)
        if changes > 0:
            # those that left had the cavity's density already
            _balance(P, fill, film, kind, b)
        cut_steps = cut_steps + 1 if cuts > 0 else 0
        if cut_steps > MAX_CUT_STEPS:
            return False, step + 1, False, count, width
        if changes > 0 or cuts > 0:
            fresh = True
            continue
        borrowed = held and step == 0
        ratio = size / last if not fresh and last > 0.0 else size
        standing = size <= ERROR_TOLERANCE
        if standing or (
            not borrowed and ((fresh and size <= LAST_STEP) or (not fresh and ratio * size <= ERROR_TOLERANCE))
        ):
            exact = not borrowed and (moved <= LAST_STEP or (not fresh and ratio <= EXACT_RATIO))
            return True, step + 1, exact, count, width
        fresh = not fresh and not borrowed and ratio > 0.2
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
def solved_viscosity(P, scale, floor, law, fields, p_out, ratio_out, ratio_P_out, p_P_out):
    """Scaled pressure, viscosity ratio and both derivatives to P from the fields that the balance was solved with.

    False where P has no pressure, or was below ``floor`` and so has none in the fields.
    """
    n, m = P.shape
    per_scale = 1.0 / scale
    for i in range(n):
        for j in range(m):
            q = P[i, j] * scale
            if not law.lowest < q < law.highest or P[i, j] < floor:
                return False
            near, p, s, s_q = near_value(
                q, fields[AT, i, j], fields[AT + 1, i, j], fields[AT + 2, i, j], fields[AT + 3, i, j], fields[AT + 4, i, j],
                fields[AT + 5, i, j],
            )  # fmt: skip
            if not near:
                return False
            rho = fields[RHO, i, j]
            p_out[i, j] = p * per_scale
            p_P_out[i, j] = s
            ratio_out[i, j] = s * rho
            ratio_P_out[i, j] = s_q * rho * scale + fields[RHO_P, i, j] * s
    return True


@njit(cache=True)
def solve_exact_transposed(fill, film, kind, full, count, width, b, exact, x):
    """Solve the transposed system at the solution for every row of x (k, count), in place; ``exact``: its factor is there."""
    if not exact:
        factor_compressible(fill, film, kind, full, b)
    solve_lu_transposed(
        dense_band(b.lower, count, width), dense_band(b.upper, count, width), b.inv_diag, count, width, x
    )


@njit(cache=True, fastmath=_FAST)
def carry_density(sigma_x, sigma_z, cx_h, cx, cz_h, cz, vx, vz, width_x, width_z, link_x, DX, DZ, SX, SZ):
    """Correct the Couette parts of a full film's link derivatives (see `exudyn_ehd.film.sweep`) for sigma on the links."""
    n, m = sigma_x.shape
    for i in range(n):
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            more = linked * width_z[j] * (sigma_x[i, j] - 1.0)
            DX[i, j] += more * vx * cx_h[i, j]
            SX[i, j] += more * cx[i, j]
        for j in range(m - 1):
            more = width_x[i] * (sigma_z[i, j] - 1.0)
            DZ[i, j] += more * vz * cz_h[i, j]
            SZ[i, j] += more * cz[i, j]


@njit(cache=True, fastmath=_FAST)
def dense_link_derivatives(P, rho, H, HF, vx, vz, flow_x, width_x, width_z, link_x, link_z, DX, DZ, SX, SZ):
    """`sweep.plain_link_derivatives` of a film that is full everywhere, with the density's mean on the links."""
    n, m = H.shape
    for i in range(n):
        nxt = i + 1 if i + 1 < n else 0
        linked = 0.5 if link_x[i] != 0.0 else 0.0
        lx = 3.0 * link_x[i] * flow_x
        wx = width_x[i]
        for j in range(m):
            h = HF[i, j]
            sigma = linked * (rho[i, j] + rho[nxt, j])
            DX[i, j] = (sigma * vx - lx * h * h * (P[nxt, j] - P[i, j])) * width_z[j]
            SX[i, j] = sigma * h * width_z[j]
        for j in range(m - 1):
            h = 0.5 * (H[i, j] + H[i, j + 1])
            sigma = 0.5 * (rho[i, j] + rho[i, j + 1])
            DZ[i, j] = (sigma * vz - 3.0 * h * h * link_z[j] * (P[i, j + 1] - P[i, j])) * wx
            SZ[i, j] = sigma * h * wx


@njit(cache=True, fastmath=_FAST)
def carry_density_plain(sigma_x, sigma_z, H, HF, vx, vz, width_x, width_z, link_x, DX, DZ, SX, SZ):
    """As `carry_density` for the plain film's carriers."""
    n, m = H.shape
    for i in range(n):
        linked = 1.0 if link_x[i] != 0.0 else 0.0
        for j in range(m):
            more = linked * width_z[j] * (sigma_x[i, j] - 1.0)
            DX[i, j] += more * vx
            SX[i, j] += more * HF[i, j]
        for j in range(m - 1):
            more = width_x[i] * (sigma_z[i, j] - 1.0)
            DZ[i, j] += more * vz
            SZ[i, j] += more * 0.5 * (H[i, j] + H[i, j + 1])
