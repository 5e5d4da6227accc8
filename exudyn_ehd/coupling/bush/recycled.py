"""Linear equations of a film's operator, by GMRES with what former ones have told.

The operators A of successive Newton iterations resemble each other. From the products A x that GMRES has made, an
approximation ``M = 1 + G V^T``, V orthonormal, is kept in Broyden's manner: the products of every solution change M
least so that M X = A X,

    G += (A X - M X) C^+,    C = V^T X,

with the parts of X outside of V as further columns of it. M preconditions the next equations from the right, by
Sherman, Morrison and Woodbury, ``M^-1 = 1 - G (1 + V^T G)^-1 V^T``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.solid.linear.gmres import gmres

# Columns of V at most, after which it starts anew.
LARGEST = 60
# Part of a direction outside of V, relative, from which it becomes a column.
OUTSIDE = 1e-3


class RecycledSolver:
    """Solves ``A z = b`` for a sequence of operators that change little."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Start anew, with M = 1."""
        self.V: np.ndarray = np.empty((0, 0))
        self.G: np.ndarray = self.V
        self.inner: np.ndarray = self.V

    def solve(
        self,
        product: Callable[[np.ndarray], np.ndarray],
        right: np.ndarray,
        tolerance: float,
        most: int,
    ) -> tuple[list[np.ndarray], np.ndarray]:
        """Directions (k of (n,)) and their weights (k,), whose sum is z.

        Parameters
        ----------
        product : function
            A x, (n,) of an (n,) array.
        right : (n,) array
        tolerance : float
            Norm of ``b - A z`` to reach.
        most : int
            Products at most.
        """
        tried: list[np.ndarray] = []
        answers: list[np.ndarray] = []
        if len(self.V) != len(right):
            self.V = self.G = np.empty((len(right), 0))

        def preconditioned(b: np.ndarray) -> np.ndarray:
            tried.append(self._approximate(b))
            answers.append(product(tried[-1]))
            return answers[-1]

        _, weights = gmres(preconditioned, right, tolerance, most)
        if tried:
            self._learn(tried, answers)
        return tried, weights

    def _approximate(self, b: np.ndarray) -> np.ndarray:
        """M^-1 b."""
        return b - self.G @ (self.inner @ (self.V.T @ b)) if self.V.size else b.copy()

    def _learn(self, tried: list[np.ndarray], answers: list[np.ndarray]) -> None:
        X, Y = np.array(tried).T, np.array(answers).T
        if self.V.shape[1] + len(tried) > LARGEST:
            self.V = self.G = np.empty((len(X), 0))
        # directions of M^-1 are no multiples of each other, but nearly so
        out = X - self.V @ (self.V.T @ X)
        out -= self.V @ (self.V.T @ out)
        left, sizes, _ = np.linalg.svd(out, full_matrices=False)
        new = left[:, sizes > OUTSIDE * np.linalg.norm(X, axis=0).max()]
        self.V = np.concatenate((self.V, new), axis=1)
        self.G = np.concatenate((self.G, np.zeros_like(new)), axis=1)
        C = self.V.T @ X
        self.G += (Y - X - self.G @ C) @ np.linalg.pinv(C, rcond=OUTSIDE)
        try:
            self.inner = np.linalg.inv(np.eye(self.V.shape[1]) + self.V.T @ self.G)
        except np.linalg.LinAlgError:
            self.forget()
