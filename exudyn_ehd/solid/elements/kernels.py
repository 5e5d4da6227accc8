"""Compiled laws of the total Lagrangian element, and the loops of its tangent; those of its force are `blocks`.

Every element has n nodes; n is the length of the tuple ``size``, and so known when a kernel is compiled for it.

Legend: u, v nodal displacement and velocity; G gradients dN_a/dX of the shape functions at the quadrature points; w
volume weights (weight times det dX/dxi); F deformation gradient; E Green-Lagrange strain; S second, P = F S first
Piola-Kirchhoff stress; lam, mu Lamé's constants; g = F G; C = F F^T; h = F^-T G; J = det F.

St. Venant-Kirchhoff: S = lam tr(E) I + 2 mu E. Neo-Hooke: P = mu (F - F^-T) + lam ln(J) F^-T, not defined (nan) unless
J > 0; written as mu (H + F^-T H^T) and with log1p(J - 1), so that small strains keep their digits.

Matrices (3, 3) at a point are tuples of rows.

Parallel loops leave the sums over elements to one thread, in the order of the serial loops. Serial and parallel kernels
are distinct functions, since numba would let them share one cache entry.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

FAST = {"contract", "reassoc"}
"""Fused multiply-add and reordered sums; NaN and infinity keep their meaning, since solvers reject steps by them."""

UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Law(NamedTuple):
    """Material data of the kernels: Lamé's constants [Pa], viscosity time [s], and the kind of law."""

    lam: float
    mu: float
    beta: float
    neo_hooke: bool


@njit(cache=True, fastmath=FAST, inline="always")
def combined(a, fa, b, fb):
    """Matrix fa a + fb b."""
    a0, a1, a2 = a
    b0, b1, b2 = b
    return (
        (fa * a0[0] + fb * b0[0], fa * a0[1] + fb * b0[1], fa * a0[2] + fb * b0[2]),
        (fa * a1[0] + fb * b1[0], fa * a1[1] + fb * b1[1], fa * a1[2] + fb * b1[2]),
        (fa * a2[0] + fb * b2[0], fa * a2[1] + fb * b2[1], fa * a2[2] + fb * b2[2]),
    )


@njit(cache=True, fastmath=FAST, inline="always")
def transposed(a):
    """Matrix a^T."""
    a0, a1, a2 = a
    return (a0[0], a1[0], a2[0]), (a0[1], a1[1], a2[1]), (a0[2], a1[2], a2[2])


@njit(cache=True, fastmath=FAST, inline="always")
def dot(a, b):
    """Scalar product of two rows."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, fastmath=FAST, inline="always")
def cross(a, b):
    """Vector product of two rows."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True, fastmath=FAST, inline="always")
def product(a, b):
    """Matrix a b^T."""
    a0, a1, a2 = a
    b0, b1, b2 = b
    return (
        (dot(a0, b0), dot(a0, b1), dot(a0, b2)),
        (dot(a1, b0), dot(a1, b1), dot(a1, b2)),
        (dot(a2, b0), dot(a2, b1), dot(a2, b2)),
    )


@njit(cache=True, fastmath=FAST, inline="always")
def trace(a):
    """Sum of the diagonal."""
    return a[0][0] + a[1][1] + a[2][2]


@njit(cache=True, fastmath=FAST, inline="always")
def volume_change(h):
    """J - 1 of F = I + H, without loss of digits."""
    h0, h1, h2 = h
    minors = h0[0] * h1[1] - h0[1] * h1[0] + h0[0] * h2[2] - h0[2] * h2[0] + h1[1] * h2[2] - h1[2] * h2[1]
    return trace(h) + minors + dot(h0, cross(h1, h2))


@njit(cache=True)
def inverse_transposed(h):
    """Return ln J, nan unless J > 0, and F^-T for F = I + H."""
    change = volume_change(h)
    log = np.log1p(change) if change > -1.0 else np.nan
    f0, f1, f2 = combined(h, 1.0, UNIT, 1.0)
    cofactors = cross(f1, f2), cross(f2, f0), cross(f0, f1)
    return log, combined(cofactors, 1.0 / (1.0 + change), UNIT, 0.0)


@njit(cache=True, fastmath=FAST, inline="always")
def doubled_strain(h):
    """2 E = H + H^T + H^T H."""
    back = transposed(h)
    return combined(combined(h, 1.0, back, 1.0), 1.0, product(back, back), 1.0)


@njit(cache=True, fastmath=FAST, inline="always")
def viscous_strain(h, k, law):
    """2 (E + beta dE/dt) of H and its rate K, which S of `second_piola` takes; of Neo-Hooke's the rate's part only."""
    strain = combined(doubled_strain(h), 0.0 if law.neo_hooke else 1.0, UNIT, 0.0)
    if law.beta == 0.0:
        return strain
    change = combined(k, 1.0, product(transposed(h), transposed(k)), 1.0)
    return combined(strain, 1.0, combined(change, 1.0, transposed(change), 1.0), law.beta)


@njit(cache=True, fastmath=FAST, inline="always")
def second_piola(e, law):
    """S = lam tr(E) I + 2 mu E of 2 E."""
    return combined(e, law.mu, UNIT, 0.5 * law.lam * trace(e))


@njit(cache=True, fastmath=FAST, inline="always")
def _gradient(nodal, G, size, H_out):
    """Rows of H[i, j] = sum_a nodal[i, a] G[j, a]; nodal (3, n), G (3, n), H_out (3, 3)."""
    for i in range(3):
        for j in range(3):
            total = 0.0
            for a in range(len(size)):
                total += nodal[i, a] * G[j, a]
            H_out[i, j] = total
    return (
        (H_out[0, 0], H_out[0, 1], H_out[0, 2]),
        (H_out[1, 0], H_out[1, 1], H_out[1, 2]),
        (H_out[2, 0], H_out[2, 1], H_out[2, 2]),
    )


@njit(cache=True, fastmath=FAST, inline="always")
def _push(f, G, size, g_out):
    """g = f G; G (3, n), g_out (3, n)."""
    f0, f1, f2 = f
    for a in range(len(size)):
        column = G[0, a], G[1, a], G[2, a]
        g_out[0, a], g_out[1, a], g_out[2, a] = dot(f0, column), dot(f1, column), dot(f2, column)


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
    g, H = work[6 * n : 9 * n].reshape(3, n), work[9 * n :].reshape(3, 3)
    for a in range(n):
        for i in range(3):
            ue[i, a], ve[i, a] = u[nodes[a], i], v[nodes[a], i]
    K[:] = 0.0
    viscous = material - geometric if law.neo_hooke else material
    for q in range(len(w)):
        h, k = _gradient(ue, G[q], size, H), _gradient(ve, G[q], size, H)
        wg, wv = w[q] * geometric, w[q] * viscous
        if law.neo_hooke:
            log, t = inverse_transposed(h)
            _push(t, G[q], size, g)
            stress, none = combined(UNIT, law.mu, UNIT, 0.0), combined(UNIT, 0.0, UNIT, 0.0)
            _add_blocks(G[q], g, stress, none, wg, wg * law.lam, wg * (law.mu - law.lam * log), size, K)
            if law.beta == 0.0 and viscous == 0.0:
                continue
        S, f = second_piola(viscous_strain(h, k, law), law), combined(h, 1.0, UNIT, 1.0)
        _push(f, G[q], size, g)
        _add_blocks(G[q], g, S, product(f, f), wg, wv * law.lam, wv * law.mu, size, K)


@njit(cache=True, fastmath=FAST, inline="always")
def _add_blocks(G, g, S, C, wg, wl, wm, size, K):
    """Add ``wg (G_a S G_b) I + wl g_a g_b^T + wm (g_b g_a^T + (G_a G_b) C)`` to K (6, n, n)."""
    n = len(size)
    (S0, S1, S2), ((C00, C01, C02), (_, C11, C12), (_, _, C22)) = S, C
    for a in range(n):
        Ga = G[0, a], G[1, a], G[2, a]
        s0, s1, s2 = wg * dot(S0, Ga), wg * dot(S1, Ga), wg * dot(S2, Ga)
        m0, m1, m2 = wm * Ga[0], wm * Ga[1], wm * Ga[2]
        l0, l1, l2 = wl * g[0, a], wl * g[1, a], wl * g[2, a]
        t0, t1, t2 = wm * g[0, a], wm * g[1, a], wm * g[2, a]
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
    work = np.empty(9 * len(size) + 9)
    K = np.empty((6, len(size), len(size)))
    for e in range(len(elements)):
        _element_tangent(G[e], w[e], elements[e], size, u, v, law, geometric, material, work, K)
        _scatter(K, elements[e], size, stride, slot[e], data_out)


@njit(cache=True, fastmath=FAST, parallel=True)
def tangent_parallel(G, w, elements, size, u, v, law, geometric, material, stride, slot, data_out):
    """`tangent_serial` on several threads, with the same bits: sums are made on one."""
    data_out[:] = 0.0
    # of as many elements as the processor's cache holds
    K = np.empty((64, 6, len(size), len(size)))
    for first in range(0, len(elements), len(K)):
        count = min(len(K), len(elements) - first)
        for k in prange(count):
            work, e = np.empty(9 * len(size) + 9), first + k
            _element_tangent(G[e], w[e], elements[e], size, u, v, law, geometric, material, work, K[k])
        for k in range(count):
            _scatter(K[k], elements[first + k], size, stride, slot[first + k], data_out)
