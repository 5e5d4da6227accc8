"""Mass balance of the compressible film and the matrix of its derivatives; see `exudyn_ehd.film.solvers.compressible`.

Symbols: P transformed pressure, fill film fraction, rho density ratio at the vertices and rho_P its derivative to P; k, f conductance
and Couette flux of a link (those of a film of density 1) and ``sigma = fill_upstream (rho_a + rho_b) / 2`` on the link a -> b;
full: P is the unknown of a vertex, else its fill.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.workspace import PAD

_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned = np.uint64
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


@njit(cache=True, fastmath=_FAST)
def _full_link_slopes(k, f, by_a, by_b, a_out, b_out):
    """Derivatives of the mass flows of a full film over links a -> b to the pressures at a and b, flat."""
    for c in range(a_out.size):
        a_out[c] = k[c] + 0.5 * f[c] * by_a[c]
        b_out[c] = 0.5 * f[c] * by_b[c] - k[c]


@njit(cache=True, fastmath=_FAST)
def _link_slopes(k, f, full_a, full_b, fill_a, fill_b, rho_a, rho_b, by_a, by_b, a_out, b_out):
    """Derivatives of the mass flows over links a -> b to the unknowns at a and b, pressures or fills, flat."""
    for c in range(a_out.size):
        mean = 0.5 * f[c] * (rho_a[c] + rho_b[c])
        half = 0.5 * f[c] * (fill_a[c] if f[c] >= 0.0 else fill_b[c])
        forth = mean if f[c] >= 0.0 else 0.0
        back = 0.0 if f[c] >= 0.0 else mean
        a_out[c] = k[c] + half * by_a[c] if full_a[c] else forth
        b_out[c] = half * by_b[c] - k[c] if full_b[c] else back


@njit(cache=True, fastmath=_FAST)
def _storage_slopes(area, full, fill, rho, by, grow, known, out):
    """Derivatives of the storage to the unknowns, flat."""
    for c in range(out.size):
        out[c] = area[c] * (by[c] * (grow[c] * fill[c] + known[c]) if full[c] else rho[c] * grow[c])


@njit(cache=True)
def assemble_compressible(fill, rho, rho_P, film, full, number, order, count, lower, upper):
    """Newton's matrix of the numbered vertices into dense bands (count, stride); unknowns are pressures where ``full``, else fills."""
    n, m = rho.shape
    size = n * m
    last = size - m
    share, sides, r, by = fill.reshape(-1), full.reshape(-1), rho.reshape(-1), rho_P.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    slopes = np.empty((5, size))
    slopes[2:4, -1] = 0.0
    _link_slopes(
        kx[:last], fx[:last], sides[:last], sides[m:], share[:last], share[m:], r[:last], r[m:], by[:last], by[m:],
        slopes[0, :last], slopes[1, :last],
    )  # fmt: skip
    _link_slopes(
        kx[last:], fx[last:], sides[last:], sides[:m], share[last:], share[:m], r[last:], r[:m], by[last:], by[:m],
        slopes[0, last:], slopes[1, last:],
    )  # fmt: skip
    _link_slopes(
        kz[:-1], fz[:-1], sides[:-1], sides[1:], share[:-1], share[1:], r[:-1], r[1:], by[:-1], by[1:],
        slopes[2, :-1], slopes[3, :-1],
    )  # fmt: skip
    _storage_slopes(
        film.area.reshape(-1), sides, share, r, by, film.grow.reshape(-1), film.known.reshape(-1), slopes[4]
    )
    _fill_bands(kx, kz, slopes, number, order, count, lower, upper)


@njit(cache=True)
def assemble_full(rho_P, film, number, order, count, lower, upper):
    """As `assemble_compressible` where every unknown is a pressure, every film full and nothing kept."""
    n, m = number.shape
    size = n * m
    last = size - m
    by = rho_P.reshape(-1)
    kx, fx, kz, fz = film.kx.reshape(-1), film.fx.reshape(-1), film.kz.reshape(-1), film.fz.reshape(-1)
    slopes = np.empty((5, size))
    slopes[2:4, -1] = 0.0
    _full_link_slopes(kx[:last], fx[:last], by[:last], by[m:], slopes[0, :last], slopes[1, :last])
    _full_link_slopes(kx[last:], fx[last:], by[last:], by[:m], slopes[0, last:], slopes[1, last:])
    _full_link_slopes(kz[:-1], fz[:-1], by[:-1], by[1:], slopes[2, :-1], slopes[3, :-1])
    area, grow, store = film.area.reshape(-1), film.grow.reshape(-1), slopes[4]
    for c in range(size):
        store[c] = area[c] * grow[c] * by[c]
    _fill_bands(kx, kz, slopes, number, order, count, lower, upper)


@njit(cache=True)
def _fill_bands(kx, kz, slopes, number, order, count, lower, upper):
    """Bands of the numbered vertices from the derivatives of the links' flows in theta and in z and of the storage: slopes (5, n m).

    Row by row with flat unsigned indices, which need no check of their sign.
    """
    n, m = number.shape
    size, rows = _unsigned(n * m), _unsigned(m)
    last = size - rows
    places = number.reshape(-1)
    ax, bx, az, bz, store = slopes[0], slopes[1], slopes[2], slopes[3], slopes[4]
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
        diagonal = store[c] + ax[c] - bx[prv] + az[c]
        b = places[nxt]
        if kx[c] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] += bx[c]
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] += bx[c]
        b = places[prv]
        if kx[prv] != 0.0 and b >= 0:
            if b > r:
                up[row * stride + _unsigned(b - r)] -= ax[prv]
            else:
                low[_unsigned(b) * stride + _unsigned(r - b)] -= ax[prv]
        if kz[c] != 0.0 and places[c + _1] >= 0:
            up[row * stride + _1] += bz[c]
        if c > _0:
            diagonal -= bz[c - _1]
            if kz[c - _1] != 0.0 and places[c - _1] >= 0:
                low[(row - _1) * stride + _1] -= az[c - _1]
        up[row * stride] = diagonal


@njit(cache=True)
def dense_band(buffer, count, width):
    """The part of a contiguous buffer that holds a band, row after row."""
    stride = width + 1 + PAD
    return buffer.reshape(-1)[: count * stride].reshape(count, stride)
