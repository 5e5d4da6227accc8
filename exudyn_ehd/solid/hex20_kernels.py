"""Compiled loops of the total Lagrangian element: force and tangent.

Legend: u, v nodal displacement and velocity; G gradients dN_a/dX of the shape functions at the quadrature points; w
volume weights (weight times det dX/dxi); F deformation gradient; E Green-Lagrange strain; S second, P = F S first
Piola-Kirchhoff stress; lam, mu Lamé's constants; g = F G; C = F F^T.

Elements come sorted by colour: two elements of one colour share no node, so that a parallel loop over one colour needs
no locks, and serial and parallel loops add in the same order: their results are equal bit for bit. Serial and parallel
kernels are distinct functions, since numba would let them share one cache entry.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange

FAST = {"contract", "reassoc"}
"""Fused multiply-add and reordered sums; NaN and infinity keep their meaning, since solvers reject steps by them."""


@njit(cache=True, fastmath=FAST, inline="always")
def _gradient(nodal, Gq, F_out):
    """F_out[i, j] = sum_a nodal[i, a] Gq[j, a]; nodal (3, 20), Gq (3, 20), F_out (3, 3)."""
    for i in range(3):
        for j in range(3):
            total = 0.0
            for a in range(20):
                total += nodal[i, a] * Gq[j, a]
            F_out[i, j] = total


@njit(cache=True, fastmath=FAST, inline="always")
def _second_piola(H, Ht, lam, mu, beta, S_out):
    """S = lam tr(E) I + 2 mu E with E + beta dE/dt in the place of E; H = du/dX, Ht its rate."""
    for i in range(3):
        for j in range(i, 3):
            strain = H[i, j] + H[j, i]
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


@njit(cache=True, fastmath=FAST, inline="always")
def _element_force(G, w, nodes, u, v, lam, mu, beta, work, f_out):
    """Add f_a = sum_q w P G_a of one element to f_out (n, 3); G (nq, 3, 20), work (60 + 60 + 60 + 36,)."""
    ue = work[:60].reshape(3, 20)
    ve = work[60:120].reshape(3, 20)
    fe = work[120:180].reshape(3, 20)
    H = work[180:189].reshape(3, 3)
    Ht = work[189:198].reshape(3, 3)
    S = work[198:207].reshape(3, 3)
    P = work[207:216].reshape(3, 3)
    for a in range(20):
        for i in range(3):
            ue[i, a] = u[nodes[a], i]
            fe[i, a] = 0.0
            if beta != 0.0:
                ve[i, a] = v[nodes[a], i]
    for q in range(len(w)):
        _gradient(ue, G[q], H)
        if beta != 0.0:
            _gradient(ve, G[q], Ht)
        _second_piola(H, Ht, lam, mu, beta, S)
        for i in range(3):
            for j in range(3):
                P[i, j] = w[q] * (S[i, j] + H[i, 0] * S[0, j] + H[i, 1] * S[1, j] + H[i, 2] * S[2, j])
        for i in range(3):
            p0, p1, p2 = P[i, 0], P[i, 1], P[i, 2]
            for a in range(20):
                fe[i, a] += p0 * G[q, 0, a] + p1 * G[q, 1, a] + p2 * G[q, 2, a]
    for a in range(20):
        for i in range(3):
            f_out[nodes[a], i] += fe[i, a]


@njit(cache=True, fastmath=FAST, inline="always")
def _element_tangent(G, w, nodes, u, v, lam, mu, beta, geometric, material, work, K):
    """Six blocks 00, 11, 22, 01, 02, 12 of the element tangent into K (6, 20, 20).

    K_ab = w [geometric (G_a S G_b) I + material (lam g_a g_b^T + mu g_b g_a^T + mu (G_a G_b) F F^T)], from the
    variation of f_a = w F S G_a; the other three blocks are transposes, since K is symmetric.
    """
    ue = work[:60].reshape(3, 20)
    ve = work[60:120].reshape(3, 20)
    g = work[120:180].reshape(3, 20)
    H = work[180:189].reshape(3, 3)
    Ht = work[189:198].reshape(3, 3)
    S = work[198:207].reshape(3, 3)
    for a in range(20):
        for i in range(3):
            ue[i, a] = u[nodes[a], i]
            if beta != 0.0:
                ve[i, a] = v[nodes[a], i]
    K[:] = 0.0
    for q in range(len(w)):
        _gradient(ue, G[q], H)
        if beta != 0.0:
            _gradient(ve, G[q], Ht)
        _second_piola(H, Ht, lam, mu, beta, S)
        for i in range(3):
            H[i, i] += 1.0
            for a in range(20):
                g[i, a] = H[i, 0] * G[q, 0, a] + H[i, 1] * G[q, 1, a] + H[i, 2] * G[q, 2, a]
        C00 = H[0, 0] * H[0, 0] + H[0, 1] * H[0, 1] + H[0, 2] * H[0, 2]
        C11 = H[1, 0] * H[1, 0] + H[1, 1] * H[1, 1] + H[1, 2] * H[1, 2]
        C22 = H[2, 0] * H[2, 0] + H[2, 1] * H[2, 1] + H[2, 2] * H[2, 2]
        C01 = H[0, 0] * H[1, 0] + H[0, 1] * H[1, 1] + H[0, 2] * H[1, 2]
        C02 = H[0, 0] * H[2, 0] + H[0, 1] * H[2, 1] + H[0, 2] * H[2, 2]
        C12 = H[1, 0] * H[2, 0] + H[1, 1] * H[2, 1] + H[1, 2] * H[2, 2]
        wg, wl, wm = w[q] * geometric, w[q] * material * lam, w[q] * material * mu
        for a in range(20):
            G0, G1, G2 = G[q, 0, a], G[q, 1, a], G[q, 2, a]
            s0 = wg * (S[0, 0] * G0 + S[0, 1] * G1 + S[0, 2] * G2)
            s1 = wg * (S[0, 1] * G0 + S[1, 1] * G1 + S[1, 2] * G2)
            s2 = wg * (S[0, 2] * G0 + S[1, 2] * G1 + S[2, 2] * G2)
            m0, m1, m2 = wm * G0, wm * G1, wm * G2
            l0, l1, l2 = wl * g[0, a], wl * g[1, a], wl * g[2, a]
            t0, t1 = wm * g[0, a], wm * g[1, a]
            t2 = wm * g[2, a]
            for b in range(20):
                s = s0 * G[q, 0, b] + s1 * G[q, 1, b] + s2 * G[q, 2, b]
                d = m0 * G[q, 0, b] + m1 * G[q, 1, b] + m2 * G[q, 2, b]
                K[0, a, b] += s + d * C00 + (l0 + t0) * g[0, b]
                K[1, a, b] += s + d * C11 + (l1 + t1) * g[1, b]
                K[2, a, b] += s + d * C22 + (l2 + t2) * g[2, b]
                K[3, a, b] += d * C01 + l0 * g[1, b] + t1 * g[0, b]
                K[4, a, b] += d * C02 + l0 * g[2, b] + t2 * g[0, b]
                K[5, a, b] += d * C12 + l1 * g[2, b] + t2 * g[1, b]


@njit(cache=True, inline="always")
def _scatter(K, nodes, stride, slot, data_out):
    """Add an element's blocks to CSR values; slot[a, b] is entry (3 I, 3 J), the next row of node I is stride[I] on."""
    for a in range(20):
        row = stride[nodes[a]]
        for b in range(20):
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
def force_serial(G, w, elements, u, v, lam, mu, beta, f_out):
    """Internal force of all elements.

    Parameters
    ----------
    G : (m, nq, 3, 20) [1/m]; w : (m, nq) [m^3]; elements : (m, 20); u, v : (n, 3) [m], [m/s]
    lam, mu : [Pa]; beta : [s]
    f_out : (n, 3) [N], overwritten
    """
    f_out[:] = 0.0
    work = np.empty(216)
    for e in range(len(elements)):
        _element_force(G[e], w[e], elements[e], u, v, lam, mu, beta, work, f_out)


@njit(cache=True, fastmath=FAST, parallel=True)
def force_parallel(G, w, elements, colours, u, v, lam, mu, beta, f_out):
    """`force_serial` on several threads; elements colours[c] to colours[c + 1] share no node."""
    f_out[:] = 0.0
    for c in range(len(colours) - 1):
        first, count = colours[c], colours[c + 1] - colours[c]
        chunks = min(count, 8)
        for chunk in prange(chunks):
            work = np.empty(216)
            for e in range(first + chunk * count // chunks, first + (chunk + 1) * count // chunks):
                _element_force(G[e], w[e], elements[e], u, v, lam, mu, beta, work, f_out)


@njit(cache=True, fastmath=FAST)
def tangent_serial(G, w, elements, u, v, lam, mu, beta, geometric, material, stride, slot, data_out):
    """Tangent of all elements as values of a fixed CSR pattern.

    Parameters
    ----------
    G, w, elements, u, v, lam, mu, beta : as in `force_serial`
    geometric, material : factors of the two parts of the tangent
    stride : (n,) entries per matrix row of each node; slot : (m, 20, 20) entry (3 I, 3 J) of each node pair
    data_out : (nnz,) [N/m], overwritten
    """
    data_out[:] = 0.0
    work = np.empty(207)
    K = np.empty((6, 20, 20))
    for e in range(len(elements)):
        _element_tangent(G[e], w[e], elements[e], u, v, lam, mu, beta, geometric, material, work, K)
        _scatter(K, elements[e], stride, slot[e], data_out)


@njit(cache=True, fastmath=FAST, parallel=True)
def tangent_parallel(G, w, elements, colours, u, v, lam, mu, beta, geometric, material, stride, slot, data_out):
    """`tangent_serial` on several threads; elements colours[c] to colours[c + 1] share no node."""
    data_out[:] = 0.0
    for c in range(len(colours) - 1):
        first, count = colours[c], colours[c + 1] - colours[c]
        chunks = min(count, 8)
        for chunk in prange(chunks):
            work = np.empty(207)
            K = np.empty((6, 20, 20))
            for e in range(first + chunk * count // chunks, first + (chunk + 1) * count // chunks):
                _element_tangent(G[e], w[e], elements[e], u, v, lam, mu, beta, geometric, material, work, K)
                _scatter(K, elements[e], stride, slot[e], data_out)
