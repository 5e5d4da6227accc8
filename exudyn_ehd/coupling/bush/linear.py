"""Linear equations of systems with meshes.

Their factor: sparse of the meshes, dense of all the rest.

With the coordinates b of meshes and r of all the rest, the iteration matrix is solved by

    W = J_bb^-1 J_br,    S = J_rr - J_rb W,
    y = J_bb^-1 f_b,   x_r = S^-1 (f_r - J_rb y),   x_b = y - W x_r.

Meshes hardly change, bodies that turn do in every step. Where a mesh meets the rest in films only, W = 0 and S = J_rr,
which a Newton iteration can have anew while the factor of the meshes lasts.

Equations of a film's operator, by GMRES with what former ones have told.

The operators A of successive Newton iterations resemble each other. From the products A x that GMRES has made, an
approximation ``M = 1 + G V^T``, V orthonormal, is kept in Broyden's manner: the products of every solution change M
least so that M X = A X,

    G += (A X - M X) C^+,    C = V^T X,

with the parts of X outside of V as further columns of it. M preconditions the next equations from the right, by
Sherman, Morrison and Woodbury, ``M^-1 = 1 - G (1 + V^T G)^-1 V^T``.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU

from exudyn_ehd.solid.linear.solvers import SingleFactor, rough_factor, solve_by_products, sparse_factor

# Coordinates and multipliers beside the meshes at most, which are solved for as dense.
LARGEST_REST = 200
# Error that single precision may bring to an approximate solution, relative.
SINGLE = 1e-5
# Columns of V at most, after which it starts anew.
LARGEST = 60
# Part of a direction outside of V, relative, from which it becomes a column.
OUTSIDE = 1e-3


class SystemFactor:
    """Factor of an iteration matrix.

    Parameters
    ----------
    system : csc_matrix
    mesh : (n,) array of bool
        Coordinates of meshes; one factor of all where there are none, or much beside them.
    pivoting : float
        As in `sparse_factor`, of that one.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """

    def __init__(self, system: csc_matrix, mesh: np.ndarray, *, pivoting: float) -> None:
        self.places, self.rest = np.flatnonzero(mesh), np.flatnonzero(~mesh)
        self.whole: SuperLU | None = None
        if not len(self.places) or len(self.rest) > LARGEST_REST:
            self.whole = sparse_factor(system, pivoting=pivoting)
            self.nbytes, self.coupled = 12 * self.whole.nnz, True
            return
        self.factor = factor = rough_factor(_part(system, self.places), SINGLE)
        self.nbytes = factor.nbytes if isinstance(factor, SingleFactor) else 12 * factor.nnz
        # columns first: rows of compressed columns take twenty times as long
        along = system[:, self.rest][self.places]
        self.across = system[self.rest][:, self.places].tocsr()
        self.coupled = bool(along.nnz or self.across.nnz)
        self.moved = factor.solve(along.toarray()) if self.coupled else np.zeros((len(self.places), 0))
        self.renew_rest(system)

    def renew_rest(self, system: csc_matrix) -> None:
        """Factorise what is beside the meshes."""
        own = system[self.rest][:, self.rest].toarray()
        if self.coupled:
            own -= self.across @ self.moved
        with warnings.catch_warnings():
            warnings.simplefilter("error", LinAlgWarning)
            try:
                self.own = lu_factor(own) if len(own) else None
            except (LinAlgWarning, ValueError) as error:
                raise RuntimeError("singular") from error

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution (n,) for a right-hand side (n,)."""
        if self.whole is not None:
            return self.whole.solve(right)
        out = np.empty(len(right))
        y, rest = self.factor.solve(right[self.places]), right[self.rest]
        if self.own is not None:
            x = lu_solve(self.own, rest - self.across @ y if self.coupled else rest)
            out[self.rest] = x
            if self.coupled:
                y -= self.moved @ x
        out[self.places] = y
        return out


def _part(system: csc_matrix, places: np.ndarray) -> csc_matrix:
    return system if len(places) == system.shape[0] else system[places][:, places]


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
    ) -> np.ndarray:
        """Return z (n,).

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

        def recorded(z: np.ndarray) -> np.ndarray:
            # scipy works on the arrays that it gives and gets
            tried.append(z.copy())
            answers.append(product(z))
            return answers[-1].copy()

        z = solve_by_products(recorded, right, tolerance, most, self._approximate)
        if tried:
            self._learn(tried, answers)
        return z

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
