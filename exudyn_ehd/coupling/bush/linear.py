"""Factor of the iteration matrix of systems with meshes: sparse of the meshes, dense of all the rest.

With the coordinates b of meshes and r of all the rest, the iteration matrix is solved by

    W = J_bb^-1 J_br,    S = J_rr - J_rb W,
    y = J_bb^-1 f_b,   x_r = S^-1 (f_r - J_rb y),   x_b = y - W x_r.

Meshes hardly change, bodies that turn do in every step. Where a mesh meets the rest in films only, W = 0 and S = J_rr,
which a Newton iteration can have anew while the factor of the meshes lasts.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU

from exudyn_ehd.solid.linear import sparse_factor

# Coordinates and multipliers beside the meshes at most, which are solved for as dense.
LARGEST_REST = 200


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
        # columns first: rows of compressed columns take twenty times as long
        own, along = (system[:, columns][self.places] for columns in (self.places, self.rest))
        self.factor = factor = sparse_factor(own)
        self.nbytes = 12 * factor.nnz
        self.across = system[self.rest][:, self.places].tocsr()
        self.coupled = bool(along.nnz or self.across.nnz)
        self.moved = factor.solve(along.toarray()) if self.coupled else np.zeros(along.shape)
        self.renew_rest(system)

    def renew_rest(self, system: csc_matrix) -> None:
        """Factorise what is beside the meshes."""
        own = system[self.rest][:, self.rest].toarray() - self.across @ self.moved
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
            out[self.rest] = x = lu_solve(self.own, rest - self.across @ y)
            y -= self.moved @ x
        out[self.places] = y
        return out
