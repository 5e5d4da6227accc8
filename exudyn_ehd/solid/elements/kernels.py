"""Compiled loops of the total Lagrangian element: force and tangent.

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
    """What the kernels take of a material: Lamé's constants [Pa], viscosity time [s], and which law."""

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
def _volume_change(H):
    """J - 1 of F = I + H, without loss of digits."""
    trace = H[0, 0] + H[1, 1] + H[2, 2]
    minors = H[0, 0] * H[1, 1] - H[0, 1] * H[1, 0] + H[0, 0] * H[2, 2] - H[0, 2] * H[2, 0]
    minors += H[1, 1] * H[2, 2] - H[1, 2] * H[2, 1]
    whole = H[0, 0] * (H[1, 1] * H[2, 2] - H[1, 2] * H[2, 1]) - H[0, 1] * (H[1, 0] * H[2, 2] - H[1, 2] * H[2, 0])
    return trace + minors + whole + H[0, 2] * (H[1, 0] * H[2, 1] - H[1, 1] * H[2, 0])


@njit(cache=True, inline="always")
def _inverse_transposed(H, T_out):
    """Write F^-T for F = I + H, and return ln J; nan unless J > 0."""
    change = _volume_change(H)
    log = np.log1p(change) if change > -1.0 else np.nan
    f00, f11, f22 = 1.0 + H[0, 0], 1.0 + H[1, 1], 1.0 + H[2, 2]
    J = 1.0 + change
    T_out[0, 0], T_out[1, 1] = (f11 * f22 - H[1, 2] * H[2, 1]) / J, (f00 * f22 - H[0, 2] * H[2, 0]) / J
    T_out[2, 2], T_out[0, 1] = (f00 * f11 - H[0, 1] * H[1, 0]) / J, (H[1, 2] * H[2, 0] - H[1, 0] * f22) / J
    T_out[0, 2], T_out[1, 0] = (H[1, 0] * H[2, 1] - f11 * H[2, 0]) / J, (H[0, 2] * H[2, 1] - H[0, 1] * f22) / J
    T_out[1, 2], T_out[2, 0] = (H[0, 1] * H[2, 0] - f00 * H[2, 1]) / J, (H[0, 1] * H[1, 2] - H[0, 2] * f11) / J
    T_out[2, 1] = (H[0, 2] * H[1, 0] - f00 * H[1, 2]) / J
    return log


@njit(cache=True, fastmath=FAST, inline="always")
def _second_piola(H, Ht, law, S_out):
    """S = lam tr(E) I + 2 mu E with E + beta dE/dt in the place of E; of Neo-Hooke's material the rate's part only."""
    lam, mu, beta = law.lam, law.mu, law.beta
    for i in range(3):
        for j in range(i, 3):
            strain = 0.0
            if not law.neo_hooke:
                strain += H[i, j] + H[j, i]
                for k in range(3):
                    strain += H[k, i] * H[k, j]
            if beta != 0.0:
                rate = Ht[i, j] + Ht[j, i]
                for k in range(3):
                    rate += H[k, i] * Ht[k, j] + Ht[k, i] * H[k, j]
                strain += beta * rate
            S_out[i, j] = mu * strain
            S_out[j, i] = S_out[i, j]
    pressure = 0.5 * lam / mu * (S_out[0, 0] + S_out[1, 1] + S_out[2, 2])
    for i in range(3):
        S_out[i, i] += pressure


@njit(cache=True, fastmath=FAST)
def _element_force(G, w, nodes, size, u, v, law, work, f_out):
    """Add f_a = sum_q w P G_a of one element to f_out; G (nq, 3, n), work (9 n + 45,)."""
    n = len(size)
    ue = work[: 3 * n].reshape(3, n)
    ve = work[3 * n : 6 * n].reshape(3, n)
    fe = work[6 * n : 9 * n].reshape(3, n)
    rest = work[9 * n :]
    H = rest[:9].reshape(3, 3)
    Ht = rest[9:18].reshape(3, 3)
    S = rest[18:27].reshape(3, 3)
    P = rest[27:36].reshape(3, 3)
    T = rest[36:45].reshape(3, 3)
    for a in range(n):
        for i in range(3):
            ue[i, a] = u[nodes[a], i]
            fe[i, a] = 0.0
            if law.beta != 0.0:
                ve[i, a] = v[nodes[a], i]
    for q in range(len(w)):
        _gradient(ue, G[q], size, H)
        if law.beta != 0.0:
            _gradient(ve, G[q], size, Ht)
        _second_piola(H, Ht, law, S)
        for i in range(3):
            for j in range(3):
                P[i, j] = w[q] * (S[i, j] + H[i, 0] * S[0, j] + H[i, 1] * S[1, j] + H[i, 2] * S[2, j])
        if law.neo_hooke:
            log = law.lam * _inverse_transposed(H, T)
            for i in range(3):
                for j in range(3):
                    shear = H[i, j] + T[i, 0] * H[j, 0] + T[i, 1] * H[j, 1] + T[i, 2] * H[j, 2]
                    P[i, j] += w[q] * (law.mu * shear + log * T[i, j])
        for i in range(3):
            p0, p1, p2 = P[i, 0], P[i, 1], P[i, 2]
            for a in range(n):
                fe[i, a] += p0 * G[q, 0, a] + p1 * G[q, 1, a] + p2 * G[q, 2, a]
    for a in range(n):
        for i in range(3):
            f_out[nodes[a], i] += fe[i, a]


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
    rest = work[9 * n :]
    H = rest[:9].reshape(3, 3)
    Ht = rest[9:18].reshape(3, 3)
    S = rest[18:27].reshape(3, 3)
    T = rest[27:36].reshape(3, 3)
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
        if law.neo_hooke:
            log = law.lam * _inverse_transposed(H, T)
            for i in range(3):
                for a in range(n):
                    g[i, a] = T[i, 0] * G[q, 0, a] + T[i, 1] * G[q, 1, a] + T[i, 2] * G[q, 2, a]
                for j in range(3):
                    S[i, j] = law.mu if i == j else 0.0
            T[:] = 0.0
            wg = w[q] * geometric
            _add_blocks(G[q], g, S, T, wg, wg * law.lam, wg * (law.mu - log), size, K)
            if law.beta == 0.0 and viscous == 0.0:
                continue
        _second_piola(H, Ht, law, S)
        for i in range(3):
            H[i, i] += 1.0
            for a in range(n):
                g[i, a] = H[i, 0] * G[q, 0, a] + H[i, 1] * G[q, 1, a] + H[i, 2] * G[q, 2, a]
        for i in range(3):
            for j in range(3):
                T[i, j] = H[i, 0] * H[j, 0] + H[i, 1] * H[j, 1] + H[i, 2] * H[j, 2]
        wv = w[q] * viscous
        _add_blocks(G[q], g, S, T, w[q] * geometric, wv * law.lam, wv * law.mu, size, K)


@njit(cache=True, fastmath=FAST, inline="always")
def _add_blocks(G, g, S, C, wg, wl, wm, size, K):
    """Add ``wg (G_a S G_b) I + wl g_a g_b^T + wm (g_b g_a^T + (G_a G_b) C)`` to K (6, n, n)."""
    n = len(size)
    C00, C11, C22, C01, C02, C12 = C[0, 0], C[1, 1], C[2, 2], C[0, 1], C[0, 2], C[1, 2]
    for a in range(n):
        G0, G1, G2 = G[0, a], G[1, a], G[2, a]
        s0 = wg * (S[0, 0] * G0 + S[0, 1] * G1 + S[0, 2] * G2)
        s1 = wg * (S[0, 1] * G0 + S[1, 1] * G1 + S[1, 2] * G2)
        s2 = wg * (S[0, 2] * G0 + S[1, 2] * G1 + S[2, 2] * G2)
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


@njit(cache=True)
def smallest_volume_ratio(G, elements, size, u):
    """Smallest det F at the quadrature points, and the row of ``elements`` where it is."""
    n = len(size)
    least, where = np.inf, 0
    nodal, H = np.empty((3, n)), np.empty((3, 3))
    for e in range(len(elements)):
        for a in range(n):
            for i in range(3):
                nodal[i, a] = u[elements[e, a], i]
        for q in range(G.shape[1]):
            _gradient(nodal, G[e, q], size, H)
            ratio = 1.0 + _volume_change(H)
            if not ratio >= least:
                least, where = ratio, e
    return least, where


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
def force_serial(G, w, elements, size, u, v, law, f_out):
    """Internal force of all elements.

    Parameters
    ----------
    G : (m, nq, 3, n) [1/m]; w : (m, nq) [m^3]; elements : (m, n)
    size : tuple of n entries
    u, v : (nodes, 3) [m], [m/s]
    law : Law
    f_out : (nodes, 3) [N], overwritten
    """
    f_out[:] = 0.0
    work = np.empty(9 * len(size) + 45)
    for e in range(len(elements)):
        _element_force(G[e], w[e], elements[e], size, u, v, law, work, f_out)


@njit(cache=True, fastmath=FAST, parallel=True)
def force_parallel(G, w, elements, colours, size, u, v, law, f_out):
    """`force_serial` on several threads; elements colours[c] to colours[c + 1] share no node."""
    f_out[:] = 0.0
    for c in range(len(colours) - 1):
        first, count = colours[c], colours[c + 1] - colours[c]
        chunks = min(count, 8)
        for chunk in prange(chunks):
            work = np.empty(9 * len(size) + 45)
            for e in range(first + chunk * count // chunks, first + (chunk + 1) * count // chunks):
                _element_force(G[e], w[e], elements[e], size, u, v, law, work, f_out)


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
    work = np.empty(9 * len(size) + 36)
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
            work = np.empty(9 * len(size) + 36)
            K = np.empty((6, len(size), len(size)))
            for e in range(first + chunk * count // chunks, first + (chunk + 1) * count // chunks):
                _element_tangent(G[e], w[e], elements[e], size, u, v, law, geometric, material, work, K)
                _scatter(K, elements[e], size, stride, slot[e], data_out)
