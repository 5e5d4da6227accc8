"""The bore of a flexible bush on the film grid.

``delta = S q``, its rate ``S q_t``, and generalised loads ``S^T (p A)``.

Modal and nodal bushes differ in S (and in what resists q) only. delta > 0 points outward and opens the gap.
Displacements are those in the joint frame, q in m; loads are carried back by the transpose, so that the film's work
on the bush is its work on q.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.film.banded.many_sides import TILE
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.sensitivity.bore_stencil import put_rows
from exudyn_ehd.film.sensitivity.vertex_stencil import stencil_by_vertices, stencil_products
from exudyn_ehd.joint.bore.columns import (
    by_columns,
    column_displacements,
    column_loads,
    project_columns,
    put_sparse,
)
from exudyn_ehd.joint.bore.transfer import end_means, separate_means, vertex_means
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.journal.modes import JournalModes
from exudyn_ehd.solid.mesh import Surface, directed
from exudyn_ehd.solid.modes.static import BoreModes

# Singular values of the shapes' courses along z, over the largest one, that count as round-off.
ROUNDING = 1e-13
# Mean displacement of a mode around the bore, over its largest radial one, that counts as rounding.
TURNED = 1e-6
_NO_PLACES, _NO_VALUES = np.zeros(0, dtype=np.int32), np.zeros(0)


class Bore(Protocol):
    """Flexible bore with k coordinates on an (n, m) film grid, as a bearing model uses it."""

    @property
    def size(self) -> int:
        """k, the number of coordinates."""

    @property
    def shapes(self) -> np.ndarray | csr_matrix:
        """S (n m, k)."""

    @property
    def twist(self) -> np.ndarray | None:
        """Loads (k,) of a moment of 1 Nm of the film about the axis, 1/m; None: none."""

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m) for coordinates or rates q (k,)."""

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,) for a field f (n, m)."""

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k) for (r, n, m)."""

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at flat vertices ``places`` times ``weight``, both (count,), into tiles from column ``first`` on.

        Tiles as made by `exudyn_ehd.film.banded.many_sides.make_tiles`.
        """

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray, size: int) -> np.ndarray:
        """``X^T B S`` (size, k) for the first columns X of the tiles ``fields`` and the stencil B.

        B is that of `exudyn_ehd.film.sensitivity.bore_stencil.gap_stencil`.

        It has five weights at five flat vertices per row, both (count, 5), the first of which is the row's own.
        """

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""

    def of_journal(self, q: np.ndarray) -> np.ndarray | float:
        """Return the opening of the gap (n, m) by an elastic journal's part of q."""

    def end_shapes(self) -> np.ndarray:
        """Return S (2, k) for linear pressures that vanish at one end: the first at L/2, the second at -L/2.

        Loads are these times the integral of the pressure over the bore's area.
        """


def _on_lines(grid: FilmGrid, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle, rad, and z, m, of places with scaled z (m,) on each of the n lines of a grid, (n m,)."""
    T, Z = np.meshgrid(grid.x, z * grid.reference_length, indexing="ij")
    return T.ravel(), Z.ravel()


def _centres(grid: FilmGrid) -> np.ndarray:
    """Scaled centres (2,) of linear pressures that vanish at one end."""
    return grid.z[-1] * np.array([-1.0, 1.0]) / 3.0


class ModalBore:
    """Bore that moves in modes, journal that does, or both: what either opens the gap by adds up.

    ``S = [S_bore, S_journal]``, ``q`` likewise. Along z a bush moves as its mesh does, by a few polynomials (nine with
    four quadratic elements). With a basis N of these courses every shape is N C at each column in theta, and fields
    that meet N first meet C in place of S in the large products.

    Parameters
    ----------
    modes : BoreModes, ReducedBore or None
    grid : FilmGrid
    journal : JournalModes or None
        Its modes follow those of the bore.

    Attributes
    ----------
    stiffness : (k,) array
        Modal stiffness, N/m.
    modes : BoreModes, ReducedBore or None
    journal : JournalModes or None
    own : int
        Number of the bore's modes.
    shapes : (n m, k) array
        S.
    twist : (k,) array or None
        As in `Bore`. A reduced body gets the film's moment by the mean motion of its bore.
    """

    def __init__(
        self, modes: BoreModes | ReducedBore | None, grid: FilmGrid, journal: JournalModes | None = None
    ) -> None:
        self.modes, self.grid, self.journal = modes, grid, journal
        self.grid_shape = grid.shape
        self.stiffness = np.concatenate([part.stiffness for part in (modes, journal) if part is not None])
        self.own = 0 if modes is None else modes.count
        self.twist = None
        if isinstance(modes, BoreModes):
            turned = modes.twist(2.0 * float(grid.z[-1]) * grid.reference_length)
            if np.abs(turned).max() * grid.reference_length > TURNED:
                self.twist = np.concatenate((turned, np.zeros(self.size - self.own)))
        shapes = []
        if modes is not None:
            places = _on_lines(grid, grid.z)
            shapes.append(modes.radial_of(vertex_means(modes.faces, grid), *places).reshape(*grid.shape, modes.count))
        if journal is not None:
            theta, around, z, along, _ = separate_means(grid, journal.edges)
            shapes.append((around @ journal.around(theta))[:, None] * (along @ journal.along(z)))
        whole = np.concatenate(shapes, axis=2) if len(shapes) > 1 else shapes[0]
        self.shapes = np.ascontiguousarray(whole).reshape(-1, self.size)
        self._along, coordinates = courses(whole)
        # twice around: every run of columns is one block
        self._courses = np.tile(coordinates, (2, 1))

    @property
    def size(self) -> int:
        """k, the number of modes."""
        return self.stiffness.size

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m)."""
        return self.displacements(q, q)[0]

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,)."""
        return self.contract(field[None])[0]

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k)."""
        found: np.ndarray = fields.reshape(len(fields), -1) @ self.shapes
        return found

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""
        return (self.shapes @ q).reshape(self.grid_shape), (self.shapes @ q_t).reshape(self.grid_shape)

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at vertices, weighted, into columns of out."""
        put_rows(self.shapes, places, weight, first, out)

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray, size: int) -> np.ndarray:
        """X^T B S (size, k)."""
        if not len(places):
            return np.zeros((size, self.size))
        out = np.empty((size, self.size))
        first, by_vertex, row = stencil_by_vertices(weight, places[:, 0], self.grid_shape)
        seen = np.empty((len(row), TILE))
        # one tile after the other: a tile's fields stay in the cache until they are multiplied
        for start in range(0, size, TILE):
            rows = min(TILE, size - start)
            stencil_products(by_vertex, row, fields[start // TILE], seen)
            along = (self._along @ seen.reshape(-1, self.grid_shape[1], TILE)).reshape(-1, TILE)
            # columns behind the last one are the first ones again
            np.matmul(
                along[:, :rows].T, self._courses[first * len(self._along) :][: len(along)], out[start : start + rows]
            )
        return out

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""
        found: np.ndarray = (self.shapes * field.reshape(-1, 1)).T @ self.shapes
        return found

    def end_shapes(self) -> np.ndarray:
        """S for linear pressures (2, k)."""
        parts = []
        if self.modes is not None:
            places = _on_lines(self.grid, _centres(self.grid))
            shapes = self.modes.radial_of(end_means(self.modes.faces, self.grid), *places)
            parts.append(shapes.reshape(-1, 2, self.own).mean(axis=0))
        if self.journal is not None:
            _, _, z, _, courses = separate_means(self.grid, self.journal.edges)
            parts.append((courses @ self.journal.along(z)) * (self.journal.waves == 0.0))
        return np.concatenate(parts, axis=1)

    def of_journal(self, q: np.ndarray) -> np.ndarray:
        """Return the opening of the gap (n, m) by the journal's part of q."""
        return self.displacement(np.where(np.arange(self.size) < self.own, 0.0, q))

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the opening of the gap by unit coordinates on the grid theta x z, m, (len(theta), len(z), k)."""
        return np.concatenate(
            [part.radial(theta, z) for part in (self.modes, self.journal) if part is not None], axis=2
        )


def courses(shapes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Basis along z and coordinates of shapes (n, m, k).

    Returns
    -------
    basis : (u, m) array
        N^T.
    coordinates : (n u, k) array
        C: shape = N C at every column in theta.
    """
    n, m, k = shapes.shape
    directions, sizes, _ = np.linalg.svd(shapes.transpose(1, 0, 2).reshape(m, n * k), full_matrices=False)
    basis = np.ascontiguousarray(directions[:, sizes > ROUNDING * sizes[0]].T)
    return basis, (basis @ shapes).reshape(-1, k)


class NodalBore:
    """Bore that moves with the nodes of a mesh; q holds their x and y displacements in the joint frame, node by node.

    Parameters
    ----------
    surface : Surface
        The mesh's bore.
    grid : FilmGrid

    Attributes
    ----------
    values : csr matrix (n m, nodes)
        Of `exudyn_ehd.joint.bore.transfer.vertex_means`.
    columns : Columns
        The same with the normals.
    shapes : csr matrix (n m, k)
        S, k twice the number of nodes.
    """

    def __init__(self, surface: Surface, grid: FilmGrid) -> None:
        self.grid_shape, self.grid = grid.shape, grid
        theta, _ = _on_lines(grid, grid.z)
        self.surface, self.values = surface, vertex_means(surface, grid)
        self.columns = by_columns(self.values, grid)
        self.shapes: csr_matrix = directed(self.values, np.stack([np.cos(theta), np.sin(theta)], axis=1), 2)
        self.twist = None

    @property
    def size(self) -> int:
        """k, two coordinates per node."""
        return self.shapes.shape[1]

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m)."""
        return self.displacements(q, q)[0]

    def load(self, field: np.ndarray) -> np.ndarray:
        """S^T f (k,)."""
        out = np.empty(self.size)
        column_loads(self.columns, np.ascontiguousarray(field), out)
        return out

    def contract(self, fields: np.ndarray) -> np.ndarray:
        """Every field's S^T f, (r, k)."""
        return np.stack([self.load(field) for field in fields])

    def displacements(self, q: np.ndarray, q_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S q and S q_t (n, m)."""
        place, rate = np.empty(self.grid_shape), np.empty(self.grid_shape)
        column_displacements(self.columns, q, q_t, place.reshape(-1), rate.reshape(-1))
        return place, rate

    def fill_rows(self, places: np.ndarray, weight: np.ndarray, first: int, out: np.ndarray) -> None:
        """Rows of S at vertices, weighted, into columns of out."""
        rows = self.shapes[places]
        put_sparse(rows.indptr, rows.indices, rows.data, weight, first, out)

    def project(self, weight: np.ndarray, places: np.ndarray, fields: np.ndarray, size: int) -> np.ndarray:
        """X^T B S (size, k)."""
        out = np.empty((size, self.size))
        self.project_on(weight, places, fields, (np.zeros(size + 1, dtype=np.int32), _NO_PLACES, _NO_VALUES), out)
        return out

    def project_on(
        self,
        weight: np.ndarray,
        places: np.ndarray,
        fields: np.ndarray,
        direct: tuple[np.ndarray, np.ndarray, np.ndarray],
        out: np.ndarray,
    ) -> None:
        """(X^T B + D) S (size, k) into out; D (size, n m) by indptr, indices and data of a CSR matrix."""
        # without a film no row of the fields is read
        stencil = stencil_by_vertices(weight, places[:, 0], self.grid_shape)
        if not len(places):
            stencil = 0, stencil[1][:0], stencil[2][:0]
        project_columns(self.columns, stencil, fields, direct, out)

    def of_journal(self, q: np.ndarray) -> float:
        """Return zero: the journal is rigid."""
        return 0.0

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k)."""
        return (self.shapes.T.multiply(field.ravel()) @ self.shapes).toarray()

    def end_shapes(self) -> np.ndarray:
        """S for linear pressures (2, k)."""
        theta, _ = _on_lines(self.grid, _centres(self.grid))
        normals = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        shapes = directed(end_means(self.surface, self.grid), normals, 2)
        return shapes.toarray().reshape(-1, 2, self.size).mean(axis=0)
