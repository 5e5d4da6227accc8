"""The bore of a flexible bush on the film grid: ``delta = S q``, its rate ``S q_t``, and generalised loads ``S^T (p A)``.

Modal and nodal bushes differ in S (and in what resists q) only. delta > 0 points outward and opens the gap. Displacements
are those in the joint frame, q in m; loads are carried back by the transpose, so that the film's work on the bush is its work on q.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.sparse import csr_matrix, diags

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.stencil import add_modes, add_transposed, combine_rows, sparse_product, weighted_rows
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.mesh import Surface
from exudyn_ehd.solid.reduce import BoreModes


class Bore(Protocol):
    """What a bearing model needs from a flexible bore with k coordinates on an (n, m) film grid."""

    @property
    def size(self) -> int:
        """k, the number of coordinates."""

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m) for coordinates or rates q (k,)."""

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,) for a field f (n, m)."""

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k) for (r, n, m)."""

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at flat vertices ``places`` (count,), times ``weight`` (count,), into out (count, >= first + k) from column ``first`` on."""

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray) -> np.ndarray:
        """``X^T B S`` (r, k) for X = ``fields`` (count, r) and B with five weights at five flat vertices per row, both (count, 5)."""

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""


class ModalBore:
    """Bore that moves in modes.

    Parameters
    ----------
    modes : BoreModes or ReducedBore
    grid : FilmGrid

    Attributes
    ----------
    shapes : (n m, k) array
        S.
    stiffness : (k,) array
        Modal stiffness, N/m.
    modes : BoreModes or ReducedBore
    """

    def __init__(self, modes: BoreModes | ReducedBore, grid: FilmGrid) -> None:
        self.modes = modes
        self.grid_shape = grid.shape
        self.shapes = modes.radial(grid.x, grid.z * grid.reference_length).reshape(-1, modes.count)
        self.transposed = np.ascontiguousarray(self.shapes.T)
        self.stiffness = modes.stiffness

    @property
    def size(self) -> int:
        """k, the number of modes."""
        return self.stiffness.size

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m)."""
        return (self.shapes @ q).reshape(self.grid_shape)

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,)."""
        return self.transposed @ field.ravel()

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k)."""
        return fields.reshape(len(fields), -1) @ self.shapes

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""
        place, rate = np.zeros(len(self.shapes)), np.zeros(len(self.shapes))
        add_modes(self.transposed, q, q_t, place, rate)
        return place.reshape(self.grid_shape), rate.reshape(self.grid_shape)

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at vertices, weighted, into columns of out."""
        weighted_rows(self.shapes, places, weight, first, out)

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray) -> np.ndarray:
        """X^T B S (r, k)."""
        rows = np.empty((len(weight), self.size))
        combine_rows(weight, places, self.shapes, rows)
        return fields.T @ rows

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""
        return (self.transposed * field.ravel()) @ self.shapes


class NodalBore:
    """Bore that moves with the nodes of a mesh; q holds their x and y displacements in the joint frame, node by node.

    Parameters
    ----------
    surface : Surface
        The mesh's bore.
    grid : FilmGrid

    Attributes
    ----------
    shapes : csr matrix (n m, k)
        S, k twice the number of nodes.
    values : csr matrix (n m, nodes)
        Shape functions at the film's vertices.
    """

    def __init__(self, surface: Surface, grid: FilmGrid) -> None:
        self.grid_shape, self.grid = grid.shape, grid
        T, Z = np.meshgrid(grid.x, grid.z * grid.reference_length, indexing="ij")
        full = surface.radial_interpolation(T.ravel(), Z.ravel())
        columns = (3 * np.arange(len(surface.nodes))[:, None] + np.arange(2)).ravel()
        self.values: csr_matrix = surface.interpolation(T.ravel(), Z.ravel())
        self.shapes: csr_matrix = full[:, columns].tocsr()
        self.transposed: csr_matrix = self.shapes.T.tocsr()

    @property
    def size(self) -> int:
        """k, two coordinates per node."""
        return self.shapes.shape[1]

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m)."""
        return (self.shapes @ q).reshape(self.grid_shape)

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,)."""
        T, out = self.transposed, np.empty(self.size)
        sparse_product(T.indptr, T.indices, T.data, np.ascontiguousarray(field).reshape(-1), out)
        return out

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k)."""
        return fields.reshape(len(fields), -1) @ self.shapes

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""
        place, rate = np.empty(self.grid_shape), np.empty(self.grid_shape)
        S = self.shapes
        sparse_product(S.indptr, S.indices, S.data, q, place.reshape(-1))
        sparse_product(S.indptr, S.indices, S.data, q_t, rate.reshape(-1))
        return place, rate

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at vertices, weighted, into columns of out."""
        out[:, first : first + self.size] = diags(weight).dot(self.shapes[places]).toarray()

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray) -> np.ndarray:
        """X^T B S (r, k)."""
        at_vertices = np.zeros((self.shapes.shape[0], fields.shape[1]))
        add_transposed(weight, places, fields, at_vertices)
        return (self.transposed @ at_vertices).T

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""
        return (self.transposed.multiply(field.ravel()) @ self.shapes).toarray()
