"""Internal force of a mesh, by blocks of elements.

All elements of a kind have the same gradients dN_a/dxi_r at their quadrature points, so that the natural gradients of
the displacement in a block of elements are one product of matrices, and so are the nodes' forces,

    A[q r, i e] = sum_a dN_a/dxi_r(q) u_i(a, e),    f_i(a, e) = sum_qr dN_a/dxi_r(q) B[q r, i e].

Between the two, one loop over elements that lie next to each other takes the displacement gradients
H_ij = A_ri dxi_r/dX_j to the stresses, and these back to B_ri = w P_ij dxi_r/dX_j. The last block is filled up with
elements without volume.

Legend: as in `kernels`; X (blocks, points * 10 * BLOCK) holds per point dxi_r/dX_j, row by row, and the weight w.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from exudyn_ehd.solid.elements.kernels import (
    FAST,
    combined,
    doubled_strain,
    inverse_transposed,
    product,
    second_piola,
    transposed,
    viscous_strain,
)

# Elements of a block: what a block's gradients take stays in the processor's cache.
BLOCK = 32


def blocks_of(inverse: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """X of inverse Jacobians (m, q, 3, 3) and weights (m, q)."""
    m, points = weight.shape
    padded = np.zeros((-(-m // BLOCK) * BLOCK, points, 10))
    padded[:m, :, :9], padded[:m, :, 9] = inverse.reshape(m, points, 9), weight
    return np.ascontiguousarray(padded.reshape(-1, BLOCK, points, 10).transpose(0, 2, 3, 1)).reshape(
        -1, points * 10 * BLOCK
    )


@njit(cache=True, fastmath=FAST, inline="always")
def _entries(flat, p):
    """Matrix whose entries begin at p, a block apart."""
    return (
        (flat[p], flat[p + BLOCK], flat[p + 2 * BLOCK]),
        (flat[p + 3 * BLOCK], flat[p + 4 * BLOCK], flat[p + 5 * BLOCK]),
        (flat[p + 6 * BLOCK], flat[p + 7 * BLOCK], flat[p + 8 * BLOCK]),
    )


@njit(cache=True, fastmath=FAST, inline="always")
def _local(A, X, p, x):
    """H at a point whose natural gradients begin at p of A, and its geometry at x of X."""
    return product(transposed(_entries(A, p)), transposed(_entries(X, x)))


@njit(cache=True, fastmath=FAST, inline="always")
def _first_piola(h, s):
    """P = S + H S."""
    return combined(s, 1.0, product(h, s), 1.0)


@njit(cache=True, fastmath=FAST, inline="always")
def _neo_hooke(h, law, P):
    """P + mu (H + F^-T H^T) + lam ln(J) F^-T."""
    log, t = inverse_transposed(h)
    elastic = combined(h, law.mu, product(t, h), law.mu)
    return combined(combined(P, 1.0, elastic, 1.0), 1.0, t, law.lam * log)


@njit(cache=True, fastmath=FAST, inline="always")
def _pull(P, X, p, x, B_out):
    """B_ri = w P_ij dxi_r/dX_j."""
    w, (b0, b1, b2) = X[x + 9 * BLOCK], product(_entries(X, x), P)
    B_out[p], B_out[p + BLOCK], B_out[p + 2 * BLOCK] = w * b0[0], w * b0[1], w * b0[2]
    B_out[p + 3 * BLOCK], B_out[p + 4 * BLOCK], B_out[p + 5 * BLOCK] = w * b1[0], w * b1[1], w * b1[2]
    B_out[p + 6 * BLOCK], B_out[p + 7 * BLOCK], B_out[p + 8 * BLOCK] = w * b2[0], w * b2[1], w * b2[2]


@njit(cache=True, fastmath=FAST)
def _stresses(A, At, X, points, law, B_out):
    """Write B from natural gradients of displacements, and of velocities if the law has a rate; all arrays are flat."""
    for q in range(points):
        p, x = 9 * BLOCK * q, 10 * BLOCK * q
        if law.neo_hooke or law.beta != 0.0:
            for e in range(BLOCK):
                h, k = _local(A, X, p + e, x + e), _local(At, X, p + e, x + e)
                P = _first_piola(h, second_piola(viscous_strain(h, k, law), law))
                if law.neo_hooke:
                    P = _neo_hooke(h, law, P)
                _pull(P, X, p + e, x + e, B_out)
        else:
            for e in range(BLOCK):
                h = _local(A, X, p + e, x + e)
                _pull(_first_piola(h, second_piola(doubled_strain(h), law)), X, p + e, x + e, B_out)


@njit(cache=True, inline="always")
def _gather(nodal, elements, first, count, U_out):
    """U_out[a, i e] = nodal[elements[first + e, a], i] of ``count`` elements; what is beyond stays."""
    for a in range(elements.shape[1]):
        for e in range(count):
            node = elements[first + e, a]
            for i in range(3):
                U_out[a, i * BLOCK + e] = nodal[node, i]


@njit(cache=True)
def _block_force(N, M, X, elements, first, u, v, law, work, F_out):
    """Nodal forces of a block, F_out (n, 3 BLOCK); work as from `_work`."""
    U, A, At, B = work
    count = min(BLOCK, len(elements) - first)
    if law.beta != 0.0:
        _gather(v, elements, first, count, U)
        np.dot(N, U, At)
    _gather(u, elements, first, count, U)
    np.dot(N, U, A)
    _stresses(A.reshape(A.size), At.reshape(A.size), X, len(N) // 3, law, B.reshape(B.size))
    np.dot(M, B, F_out)


@njit(cache=True, inline="always")
def _work(N):
    """Zero nodal values, and gradients of displacements, of velocities, and what forces are made of."""
    size = len(N), 3 * BLOCK
    return np.zeros((N.shape[1], 3 * BLOCK)), np.empty(size), np.zeros(size), np.empty(size)


@njit(cache=True, inline="always")
def _scatter(F, elements, first, f_out):
    for a in range(elements.shape[1]):
        for e in range(min(BLOCK, len(elements) - first)):
            node = elements[first + e, a]
            for i in range(3):
                f_out[node, i] += F[a, i * BLOCK + e]


@njit(cache=True)
def force_serial(N, M, X, elements, u, v, law, f_out):
    """Internal force of all elements.

    Parameters
    ----------
    N : (3 q, n), dN_a/dxi_r of point and direction; M : (n, 3 q), its transpose
    X : (blocks, 10 q BLOCK) [1/m], [m^3]; elements : (m, n)
    u, v : (nodes, 3) [m], [m/s]
    law : Law
    f_out : (nodes, 3) [N], overwritten
    """
    f_out[:] = 0.0
    work, F = _work(N), np.empty((N.shape[1], 3 * BLOCK))
    for block in range(len(X)):
        _block_force(N, M, X[block], elements, block * BLOCK, u, v, law, work, F)
        _scatter(F, elements, block * BLOCK, f_out)


@njit(cache=True, parallel=True)
def force_parallel(N, M, X, elements, u, v, law, f_out):
    """`force_serial` on several threads, with the same bits: sums are made on one."""
    f_out[:] = 0.0
    F = np.empty((len(X), N.shape[1], 3 * BLOCK))
    for block in prange(len(X)):
        _block_force(N, M, X[block], elements, block * BLOCK, u, v, law, _work(N), F[block])
    for block in range(len(X)):
        _scatter(F[block], elements, block * BLOCK, f_out)
