"""Mass balance of the compressible film and the matrix of its derivatives; see `exudyn_ehd.film.compressible`.

Symbols: P transformed pressure, fill film fraction, rho density ratio at the vertices and rho_P its derivative to P; k, f conductance
and Couette flux of a link (those of a film of density 1) and ``sigma = fill_upstream (rho_a + rho_b) / 2`` on the link a -> b;
full: P is the unknown of a vertex, else its fill.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.direct import PAD
from exudyn_ehd.film.elrod import _add_entry

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
