"""Solvers of scipy for sparse matrices, with the options that meshes need."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import spmatrix
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


class SingleFactor:
    """Factor of a sparse matrix in single precision, which halves memory and time of substitutions.

    Parameters
    ----------
    A : sparse matrix
    """

    def __init__(self, A: spmatrix) -> None:
        self.factor = sparse_factor(A.astype(np.float32))
        self.nbytes = 8 * self.factor.nnz

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution of one right-hand side (n,), or of several (n, k)."""
        # within the range of single precision
        scale = float(np.abs(right).max(initial=0.0)) or 1.0
        solution: np.ndarray = scale * self.factor.solve((right / scale).astype(np.float32)).astype(float)
        return solution


def rough_factor(A: spmatrix, error: float) -> SingleFactor | SuperLU:
    """Factor in single precision if its solutions are within that relative error, else in double precision.

    The error of a probe's solution is that which one step of iterative refinement corrects.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    try:
        single = SingleFactor(A)
    except RuntimeError:
        # perhaps in single precision alone, whose range is small
        return sparse_factor(A)
    probe = np.sin(np.arange(1.0, A.shape[0] + 1))
    found = single.solve(probe)
    missed = single.solve(probe - A @ found)
    # nan is not within it
    return single if np.linalg.norm(missed) <= error * np.linalg.norm(found) else sparse_factor(A)


def solve_by_products(
    product: Callable[[np.ndarray], np.ndarray],
    right: np.ndarray,
    tolerance: float,
    most: int,
    preconditioner: Callable[[np.ndarray], np.ndarray] | None = None,
) -> np.ndarray:
    """Return x (n,) with ``product(x) = right``: generalised minimal residual, preconditioned from the right.

    Parameters
    ----------
    product : function
        A x, (n,) of an (n,) array.
    right : (n,) array
    tolerance : float
        Norm of ``right - A x`` to reach.
    most : int
        Products at most.
    preconditioner : function, optional
        Approximate inverse of A times an (n,) array.
    """
    if not np.linalg.norm(right) > tolerance:
        return np.zeros_like(right)

    def operator(function: Callable[[np.ndarray], np.ndarray]) -> LinearOperator:
        return LinearOperator((right.size, right.size), matvec=function, dtype=float)

    M = None if preconditioner is None else operator(preconditioner)
    x: np.ndarray = gcrotmk(operator(product), right, rtol=0.0, atol=tolerance, m=most, k=0, maxiter=1, M=M)[0]
    return x
