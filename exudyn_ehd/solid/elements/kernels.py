"""Compiled laws of the total Lagrangian element, and the loops of its tangent; those of its force are `blocks`.

Every element has n nodes; n is the length of the tuple ``size``, and so known when a kernel is compiled for it.

Legend: u, v nodal displacement and velocity; G gradients dN_a/dX of the shape functions at the quadrature points; w
volume weights (weight times det dX/dxi); F deformation gradient; E Green-Lagrange strain; S second, P = F S first
Piola-Kirchhoff stress; lam, mu Lamé's constants; g = F G; C = F F^T; h = F^-T G; J = det F.

St. Venant-Kirchhoff: S = lam tr(E) I + 2 mu E. Neo-Hooke: P = mu (F - F^-T) + lam ln(J) F^-T, not defined (nan) unless
J > 0; written as mu (H + F^-T H^T) and with log1p(J - 1), so that small strains keep their digits.

Elements come sorted by colour: two elements of one colour share no node, so that a parallel loop over one colour needs
no locks, and serial and parallel loops add in the same order: their results are equal to rounding. Serial and parallel
kernels are distinct functions, since numba would let them share one cache entry.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

FAST = {"contract", "reassoc"}
"""Fused multiply-add and reordered sums; NaN and infinity keep their meaning, since solvers reject steps by them."""


class Law(NamedTuple):
    """Material data of the kernels: Lamé's constants [Pa], viscosity time [s], and the kind of law."""

    lam: float
    mu: float
    beta: float
    neo_hooke: bool


@njit(cache=True, fastmath=FAST, inline="always")
def _gradient(nodal, Gq, size, F_out):
    """F_out[i, j] = sum_a nodal[i, a] Gq[j, a]; nodal (3, n), Gq (3, n), F_out (3, 3)."""
    n = len(size)
    for i in range(3):
        for j in range(3):
            total = 0.0
            for a in range(n):
                total += nodal[i, a] * Gq[j, a]
            F_out[i, j] = total


@njit(cache=True, fastmath=FAST, inline="always")
def volume_change(h):
    """J - 1 of F = I + H, without loss of digits; H row by row."""
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    minors = h00 * h11 - h01 * h10 + h00 * h22 - h02 * h20 + h11 * h22 - h12 * h21
    whole = h00 * (h11 * h22 - h12 * h21) - h01 * (h10 * h22 - h12 * h20) + h02 * (h10 * h21 - h11 * h20)
    return h00 + h11 + h22 + minors + whole


@njit(cache=True, inline="always")
def inverse_transposed(h):
    """Return ln J, nan unless J > 0, and F^-T row by row for F = I + H."""
    change = volume_change(h)
    log = np.log1p(change) if change > -1.0 else np.nan
    J = 1.0 + change
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    f00, f11, f22 = 1.0 + h00, 1.0 + h11, 1.0 + h22
    first = (f11 * f22 - h12 * h21) / J, (h12 * h20 - h10 * f22) / J, (h10 * h21 - f11 * h20) / J
    second = (h02 * h21 - h01 * f22) / J, (f00 * f22 - h02 * h20) / J, (h01 * h20 - f00 * h21) / J
    third = (h01 * h12 - h02 * f11) / J, (h02 * h10 - f00 * h12) / J, (f00 * f11 - h01 * h10) / J
    return log, first + second + third


@njit(cache=True, fastmath=FAST, inline="always")
def doubled_strain(h):
    """2 E = H + H^T + H^T H as 00, 11, 22, 01, 02, 12."""
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    e00 = 2.0 * h00 + h00 * h00 + h10 * h10 + h20 * h20
    e11 = 2.0 * h11 + h01 * h01 + h11 * h11 + h21 * h21
    e22 = 2.0 * h22 + h02 * h02 + h12 * h12 + h22 * h22
    e01 = h01 + h10 + h00 * h01 + h10 * h11 + h20 * h21
    e02 = h02 + h20 + h00 * h02 + h10 * h12 + h20 * h22
    return e00, e11, e22, e01, e02, h12 + h21 + h01 * h02 + h11 * h12 + h21 * h22


@njit(cache=True, fastmath=FAST, inline="always")
def doubled_rate(h, k):
    """2 dE/dt of H and its rate K, ordered as in `doubled_strain`."""
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    k00, k01, k02, k10, k11, k12, k20, k21, k22 = k
    e00 = 2.0 * (k00 + h00 * k00 + h10 * k10 + h20 * k20)
    e11 = 2.0 * (k11 + h01 * k01 + h11 * k11 + h21 * k21)
    e22 = 2.0 * (k22 + h02 * k02 + h12 * k12 + h22 * k22)
    e01 = k01 + k10 + h00 * k01 + k00 * h01 + h10 * k11 + k10 * h11 + h20 * k21 + k20 * h21
    e02 = k02 + k20 + h00 * k02 + k00 * h02 + h10 * k12 + k10 * h12 + h20 * k22 + k20 * h22
    return e00, e11, e22, e01, e02, k12 + k21 + h01 * k02 + k01 * h02 + h11 * k12 + k11 * h12 + h21 * k22 + k21 * h22


@njit(cache=True, fastmath=FAST, inline="always")
def second_piola(e, law):
    """S = lam tr(E) I + 2 mu E of 2 E, both as 00, 11, 22, 01, 02, 12."""
    e00, e11, e22, e01, e02, e12 = e
    mu, pressure = law.mu, 0.5 * law.lam * (e00 + e11 + e22)
    return mu * e00 + pressure, mu * e11 + pressure, mu * e22 + pressure, mu * e01, mu * e02, mu * e12


@njit(cache=True, fastmath=FAST, inline="always")
def viscous_strain(h, k, law):
    """2 (E + beta dE/dt), which S of `second_piola` takes; of Neo-Hooke's material the rate's part only."""
    e00, e11, e22, e01, e02, e12 = doubled_strain(h)
    if law.neo_hooke:
        e00 = e11 = e22 = e01 = e02 = e12 = 0.0
    if law.beta != 0.0:
        r00, r11, r22, r01, r02, r12 = doubled_rate(h, k)
        e00, e11, e22 = e00 + law.beta * r00, e11 + law.beta * r11, e22 + law.beta * r22
        e01, e02, e12 = e01 + law.beta * r01, e02 + law.beta * r02, e12 + law.beta * r12
    return e00, e11, e22, e01, e02, e12


@njit(cache=True, inline="always")
def _entries(H):
    return H[0, 0], H[0, 1], H[0, 2], H[1, 0], H[1, 1], H[1, 2], H[2, 0], H[2, 1], H[2, 2]


@njit(cache=True, fastmath=FAST, inline="always")
def _dot(a, b, i, j):
    return a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2]


@njit(cache=True, fastmath=FAST)
def _element_tangent(G, w, nodes, size, u, v, law, geometric, material, work, K):
    """Six blocks 00, 11, 22, 01, 02, 12 of the element tangent into K (6, n, n).

    St. Venant-Kirchhoff, from the variation of f_a = w F S G_a:

        K_ab = w [geometric (G_a S G_b) I + material (lam g_a g_b^T + mu g_b g_a^T + mu (G_a G_b) F F^T)]

    Neo-Hooke: ``w geometric [mu (G_a G_b) I + lam h_a h_b^T + (mu - lam ln J) h_b h_a^T]``, and of the viscosity the
    formula above. The other three blocks are transposes, since K is symmetric.
    """
    n = len(size)
    ue = work[: 3 * n].reshape(3, n)
    ve = work[3 * n : 6 * n].reshape(3, n)
    g = work[6 * n : 9 * n].reshape(3, n)
    H, Ht = work[9 * n : 9 * n + 9].reshape(3, 3), work[9 * n + 9 :].reshape(3, 3)
    for a in range(n):
        for i in range(3):
            ue[i, a] = u[nodes[a], i]
            if law.beta != 0.0:
                ve[i, a] = v[nodes[a], i]
    K[:] = 0.0
    viscous = material - geometric if law.neo_hooke else material
    for q in range(len(w)):
        _gradient(ue, G[q], size, H)
        if law.beta != 0.0:
            _gradient(ve, G[q], size, Ht)
        h, k = _entries(H), _entries(Ht)
        if law.neo_hooke:
            log, T = inverse_transposed(h)
            for a in range(n):
                for i in range(3):
                    g[i, a] = T[3 * i] * G[q, 0, a] + T[3 * i + 1] * G[q, 1, a] + T[3 * i + 2] * G[q, 2, a]
            wg, mu = w[q] * geometric, law.mu
            stress, none = (mu, mu, mu, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            _add_blocks(G[q], g, stress, none, wg, wg * law.lam, wg * (mu - law.lam * log), size, K)
            if law.beta == 0.0 and viscous == 0.0:
                continue
        S = second_piola(viscous_strain(h, k, law), law)
        for i in range(3):
            H[i, i] += 1.0
            for a in range(n):
                g[i, a] = H[i, 0] * G[q, 0, a] + H[i, 1] * G[q, 1, a] + H[i, 2] * G[q, 2, a]
        F = _entries(H)
        C00, C11, C22 = _dot(F, F, 0, 0), _dot(F, F, 3, 3), _dot(F, F, 6, 6)
        C = C00, C11, C22, _dot(F, F, 0, 3), _dot(F, F, 0, 6), _dot(F, F, 3, 6)
        wv = w[q] * viscous
        _add_blocks(G[q], g, S, C, w[q] * geometric, wv * law.lam, wv * law.mu, size, K)


@njit(cache=True, fastmath=FAST, inline="always")
def _add_blocks(G, g, S, C, wg, wl, wm, size, K):
    """Add ``wg (G_a S G_b) I + wl g_a g_b^T + wm (g_b g_a^T + (G_a G_b) C)`` to K (6, n, n)."""
    n = len(size)
    S00, S11, S22, S01, S02, S12 = S
    C00, C11, C22, C01, C02, C12 = C
    for a in range(n):
        G0, G1, G2 = G[0, a], G[1, a], G[2, a]
        s0 = wg * (S00 * G0 + S01 * G1 + S02 * G2)
        s1 = wg * (S01 * G0 + S11 * G1 + S12 * G2)
        s2 = wg * (S02 * G0 + S12 * G1 + S22 * G2)
        m0, m1, m2 = wm * G0, wm * G1, wm * G2
        l0, l1, l2 = wl * g[0, a], wl * g[1, a], wl * g[2, a]
        t0, t1 = wm * g[0, a], wm * g[1, a]
        t2 = wm * g[2, a]
        for b in range(n):
            s = s0 * G[0, b] + s1 * G[1, b] + s2 * G[2, b]
            d = m0 * G[0, b] + m1 * G[1, b] + m2 * G[2, b]
            K[0, a, b] += s + d * C00 + (l0 + t0) * g[0, b]
            K[1, a, b] += s + d * C11 + (l1 + t1) * g[1, b]
            K[2, a, b] += s + d * C22 + (l2 + t2) * g[2, b]
            K[3, a, b] += d * C01 + l0 * g[1, b] + t1 * g[0, b]
            K[4, a, b] += d * C02 + l0 * g[2, b] + t2 * g[0, b]
            K[5, a, b] += d * C12 + l1 * g[2, b] + t2 * g[1, b]


@njit(cache=True, inline="always")
def _scatter(K, nodes, size, stride, slot, data_out):
    """Add an element's blocks to CSR values; slot[a, b] is entry (3 I, 3 J), the next row of node I is stride[I] on."""
    n = len(size)
    for a in range(n):
        row = stride[nodes[a]]
        for b in range(n):
            p = slot[a, b]
            data_out[p] += K[0, a, b]
            data_out[p + 1] += K[3, a, b]
            data_out[p + 2] += K[4, a, b]
            p += row
            data_out[p] += K[3, b, a]
            data_out[p + 1] += K[1, a, b]
            data_out[p + 2] += K[5, a, b]
            p += row
            data_out[p] += K[4, b, a]
            data_out[p + 1] += K[5, b, a]
            data_out[p + 2] += K[2, a, b]


@njit(cache=True, fastmath=FAST)
def tangent_serial(G, w, elements, size, u, v, law, geometric, material, stride, slot, data_out):
    """Tangent of all elements as values of a fixed CSR pattern.

    Parameters
    ----------
    G, w, elements, size, u, v, law : as in `force_serial`
    geometric, material : factors of the two parts of the tangent
    stride : (nodes,) entries per matrix row of each node; slot : (m, n, n) entry (3 I, 3 J) of each node pair
    data_out : (nnz,) [N/m], overwritten
    """
    data_out[:] = 0.0
    work = np.empty(9 * len(size) + 18)
    K = np.empty((6, len(size), len(size)))
    for e in range(len(elements)):
        _element_tangent(G[e], w[e], elements[e], size, u, v, law, geometric, material, work, K)
        _scatter(K, elements[e], size, stride, slot[e], data_out)


@njit(cache=True, fastmath=FAST, parallel=True)
def tangent_parallel(G, w, elements, colours, size, u, v, law, geometric, material, stride, slot, data_out):
    """`tangent_serial` on several threads; elements colours[c] to colours[c + 1] share no node."""
    data_out[:] = 0.0
    for c in range(len(colours) - 1):
        first, count = colours[c], colours[c + 1] - colours[c]
        chunks = min(count, 8)
        for chunk in prange(chunks):
            work = np.empty(9 * len(size) + 18)
            K = np.empty((6, len(size), len(size)))
            for e in range(first + chunk * count // chunks, first + (chunk + 1) * count // chunks):
                _element_tangent(G[e], w[e], elements[e], size, u, v, law, geometric, material, work, K)
                _scatter(K, elements[e], size, stride, slot[e], data_out)
