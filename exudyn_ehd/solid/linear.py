"""Solvers of scipy for sparse matrices, with the options that meshes need."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_matrix, spmatrix
from scipy.sparse.linalg import LinearOperator, SuperLU, gcrotmk, splu


def sparse_factor(A: spmatrix, *, pivoting: float = 0.0) -> SuperLU:
    """SuperLU of a matrix with a symmetric pattern, which keeps its diagonal as pivots from that share of a column on.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    options = {"SymmetricMode": True}
    return splu(A.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=pivoting, options=options)


def held_solution(K: csr_matrix, nodes: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Displacements of a body with three coordinates a node under nodal forces, both (n, k), with some nodes held.

    Raises
    ------
    RuntimeError
        If the stiffness matrix (n, n) of the rest is singular.
    """
    free = np.ones(K.shape[0], dtype=bool)
    free[(3 * nodes[:, None] + np.arange(3)).ravel()] = False
    factor = sparse_factor(K[free][:, free])

    def solve(loads: np.ndarray) -> np.ndarray:
        out = np.zeros_like(loads)
        out[free] = factor.solve(np.ascontiguousarray(loads[free]))
        return out

    return solve


def solve_by_products(
    product: Callable[[np.ndarray], np.ndarray],
    right: np.ndarray,
    tolerance: float,
    most: int,
) -> np.ndarray:
    """Return x (n,) with ``product(x) = right``: generalised minimal residual.

    Parameters
    ----------
    product : function
        A x, (n,) of an (n,) array.
    right : (n,) array
    tolerance : float
        Norm of ``right - A x`` to reach.
    most : int
        Products at most.
    """
    if not np.linalg.norm(right) > tolerance:
        return np.zeros_like(right)

    A = LinearOperator((right.size, right.size), matvec=product, dtype=float)
    x: np.ndarray = gcrotmk(A, right, rtol=0.0, atol=tolerance, m=most, k=0, maxiter=1)[0]
    return x
