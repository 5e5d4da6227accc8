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
    doubled_strain,
    inverse_transposed,
    second_piola,
    viscous_strain,
    volume_change,
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
def _local(A, X, p, x, e):
    """H row by row at a point whose natural gradients begin at p of A, and its geometry at x of X."""
    a0, b0, c0 = A[p + e], A[p + BLOCK + e], A[p + 2 * BLOCK + e]
    a1, b1, c1 = A[p + 3 * BLOCK + e], A[p + 4 * BLOCK + e], A[p + 5 * BLOCK + e]
    a2, b2, c2 = A[p + 6 * BLOCK + e], A[p + 7 * BLOCK + e], A[p + 8 * BLOCK + e]
    x00, x01, x02 = X[x + e], X[x + BLOCK + e], X[x + 2 * BLOCK + e]
    x10, x11, x12 = X[x + 3 * BLOCK + e], X[x + 4 * BLOCK + e], X[x + 5 * BLOCK + e]
    x20, x21, x22 = X[x + 6 * BLOCK + e], X[x + 7 * BLOCK + e], X[x + 8 * BLOCK + e]
    first = a0 * x00 + a1 * x10 + a2 * x20, a0 * x01 + a1 * x11 + a2 * x21, a0 * x02 + a1 * x12 + a2 * x22
    second = b0 * x00 + b1 * x10 + b2 * x20, b0 * x01 + b1 * x11 + b2 * x21, b0 * x02 + b1 * x12 + b2 * x22
    third = c0 * x00 + c1 * x10 + c2 * x20, c0 * x01 + c1 * x11 + c2 * x21, c0 * x02 + c1 * x12 + c2 * x22
    return first + second + third


@njit(cache=True, fastmath=FAST, inline="always")
def _first_piola(h, s):
    """P = S + H S row by row."""
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    s00, s11, s22, s01, s02, s12 = s
    first = s00 + h00 * s00 + h01 * s01 + h02 * s02, s01 + h00 * s01 + h01 * s11 + h02 * s12
    second = s01 + h10 * s00 + h11 * s01 + h12 * s02, s11 + h10 * s01 + h11 * s11 + h12 * s12
    third = s02 + h20 * s00 + h21 * s01 + h22 * s02, s12 + h20 * s01 + h21 * s11 + h22 * s12
    last = s02 + h00 * s02 + h01 * s12 + h02 * s22, s12 + h10 * s02 + h11 * s12 + h12 * s22
    return first + (last[0],) + second + (last[1],) + third + (s22 + h20 * s02 + h21 * s12 + h22 * s22,)


@njit(cache=True, fastmath=FAST, inline="always")
def _neo_hooke(h, law, P):
    """P + mu (H + F^-T H^T) + lam ln(J) F^-T row by row."""
    log, t = inverse_transposed(h)
    log *= law.lam
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = h
    t00, t01, t02, t10, t11, t12, t20, t21, t22 = t
    mu = law.mu
    p00 = P[0] + mu * (h00 + t00 * h00 + t01 * h01 + t02 * h02) + log * t00
    p01 = P[1] + mu * (h01 + t00 * h10 + t01 * h11 + t02 * h12) + log * t01
    p02 = P[2] + mu * (h02 + t00 * h20 + t01 * h21 + t02 * h22) + log * t02
    p10 = P[3] + mu * (h10 + t10 * h00 + t11 * h01 + t12 * h02) + log * t10
    p11 = P[4] + mu * (h11 + t10 * h10 + t11 * h11 + t12 * h12) + log * t11
    p12 = P[5] + mu * (h12 + t10 * h20 + t11 * h21 + t12 * h22) + log * t12
    p20 = P[6] + mu * (h20 + t20 * h00 + t21 * h01 + t22 * h02) + log * t20
    p21 = P[7] + mu * (h21 + t20 * h10 + t21 * h11 + t22 * h12) + log * t21
    p22 = P[8] + mu * (h22 + t20 * h20 + t21 * h21 + t22 * h22) + log * t22
    return p00, p01, p02, p10, p11, p12, p20, p21, p22


@njit(cache=True, fastmath=FAST, inline="always")
def _pull(P, X, p, x, e, B_out):
    """B_ri = w P_ij dxi_r/dX_j."""
    w = X[x + 9 * BLOCK + e]
    for r in range(3):
        y = x + 3 * r * BLOCK + e
        x0, x1, x2, z = w * X[y], w * X[y + BLOCK], w * X[y + 2 * BLOCK], p + 3 * r * BLOCK + e
        B_out[z] = P[0] * x0 + P[1] * x1 + P[2] * x2
        B_out[z + BLOCK] = P[3] * x0 + P[4] * x1 + P[5] * x2
        B_out[z + 2 * BLOCK] = P[6] * x0 + P[7] * x1 + P[8] * x2


@njit(cache=True, fastmath=FAST)
def _stresses(A, At, X, points, law, B_out):
    """Write B from natural gradients of displacements, and of velocities if the law has a rate; all arrays are flat."""
    for q in range(points):
        p, x = 9 * BLOCK * q, 10 * BLOCK * q
        if law.neo_hooke or law.beta != 0.0:
            for e in range(BLOCK):
                h, k = _local(A, X, p, x, e), _local(At, X, p, x, e)
                P = _first_piola(h, second_piola(viscous_strain(h, k, law), law))
                if law.neo_hooke:
                    P = _neo_hooke(h, law, P)
                _pull(P, X, p, x, e, B_out)
        else:
            for e in range(BLOCK):
                h = _local(A, X, p, x, e)
                _pull(_first_piola(h, second_piola(doubled_strain(h), law)), X, p, x, e, B_out)


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


@njit(cache=True)
def smallest_volume_ratio(N, X, elements, u):
    """Smallest det F at the quadrature points, and the row of ``elements`` where it is; the last row with a nan."""
    least, where = np.inf, 0
    U, A, _, _ = _work(N)
    flat = A.reshape(A.size)
    for block in range(len(X)):
        first = block * BLOCK
        count = min(BLOCK, len(elements) - first)
        _gather(u, elements, first, count, U)
        np.dot(N, U, A)
        for q in range(len(N) // 3):
            for e in range(count):
                ratio = 1.0 + volume_change(_local(flat, X[block], 9 * BLOCK * q, 10 * BLOCK * q, e))
                if not ratio >= least:
                    least, where = ratio, first + e
    return least, where
