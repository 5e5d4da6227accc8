"""The bore of a flexible bush on the film grid.

``delta = S q``, its rate ``S q_t``, and generalised loads ``S^T (p A)``.

Modal and nodal bushes differ in S (and in what resists q) only. delta > 0 points outward and opens the gap.
Displacements are those in the joint frame, q in m; loads are carried back by the transpose, so that the film's work
on the bush is its work on q.
"""

from __future__ import annotations

import abc

import numpy as np
from scipy.sparse import csr_matrix, diags_array

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.joint.bore.transfer import end_means, separate_means, vertex_means
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.journal.modes import JournalModes
from exudyn_ehd.solid.modes.static import BoreModes
from exudyn_ehd.solid.unrolled import Surface, directed

# Mean displacement of a mode around the bore, over its largest radial one, that counts as rounding.
TURNED = 1e-6


class Bore(abc.ABC):
    """Flexible bore with k coordinates on an (n, m) film grid.

    Attributes
    ----------
    grid : FilmGrid
    shapes : array or csr matrix (n m, k)
        S.
    own : int
        Number of the bore's coordinates; those of an elastic journal follow.
    twist : (k,) array or None
        Loads of a moment of 1 Nm of the film about the axis, 1/m; None: none.
    """

    def __init__(self, grid: FilmGrid, shapes: np.ndarray | csr_matrix, own: int) -> None:
        self.grid, self.shapes, self.own = grid, shapes, own
        self._onto = shapes.T if isinstance(shapes, np.ndarray) else shapes.T.tocsr()
        self.twist: np.ndarray | None = None

    @property
    def size(self) -> int:
        """k, the number of coordinates."""
        return int(self.shapes.shape[1])

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m) for coordinates or rates q (k,)."""
        return np.asarray(self.shapes @ q).reshape(self.grid.shape)

    def load(self, fields: np.ndarray) -> np.ndarray:
        """S^T f (..., k) for every field f of (..., n, m)."""
        return np.asarray((self._onto @ fields.reshape(*fields.shape[:-2], -1).T).T)

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k) for a field f (n, m)."""
        found = self._onto @ (diags_array(field.ravel()) @ self.shapes)
        return found if isinstance(found, np.ndarray) else np.asarray(found.toarray())

    def without_journal(self, q: np.ndarray) -> np.ndarray:
        """Return the displacement (n, m) of the bore itself, without an elastic journal's part of q."""
        return self.displacement(np.where(np.arange(self.size) < self.own, q, 0.0))

    @abc.abstractmethod
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


class ModalBore(Bore):
    """Bore that moves in modes, journal that does, or both: what either opens the gap by adds up.

    ``S = [S_bore, S_journal]``, ``q`` likewise.

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
    twist : (k,) array or None
        As in `Bore`. A reduced body gets the film's moment by the mean motion of its bore.
    """

    def __init__(
        self, modes: BoreModes | ReducedBore | None, grid: FilmGrid, journal: JournalModes | None = None
    ) -> None:
        self.modes, self.journal = modes, journal
        self.stiffness = np.concatenate([part.stiffness for part in (modes, journal) if part is not None])
        shapes = []
        if modes is not None:
            places = _on_lines(grid, grid.z)
            shapes.append(modes.radial_of(vertex_means(modes.faces, grid), *places).reshape(*grid.shape, modes.count))
        if journal is not None:
            theta, around, z, along, _ = separate_means(grid, journal.edges)
            shapes.append((around @ journal.around(theta))[:, None] * (along @ journal.along(z)))
        whole = np.concatenate(shapes, axis=2).reshape(-1, self.stiffness.size)
        super().__init__(grid, whole, 0 if modes is None else modes.count)
        if isinstance(modes, BoreModes):
            turned = modes.twist(2.0 * float(grid.z[-1]) * grid.reference_length)
            if np.abs(turned).max() * grid.reference_length > TURNED:
                self.twist = np.concatenate((turned, np.zeros(self.size - self.own)))

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

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the opening of the gap by unit coordinates on the grid theta x z, m, (len(theta), len(z), k)."""
        return np.concatenate(
            [part.radial(theta, z) for part in (self.modes, self.journal) if part is not None], axis=2
        )


class NodalBore(Bore):
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
    """

    shapes: csr_matrix

    def __init__(self, surface: Surface, grid: FilmGrid) -> None:
        self.surface, self.values = surface, vertex_means(surface, grid)
        theta, _ = _on_lines(grid, grid.z)
        shapes = directed(self.values, np.stack([np.cos(theta), np.sin(theta)], axis=1), 2)
        super().__init__(grid, shapes, shapes.shape[1])

    def end_shapes(self) -> np.ndarray:
        """S for linear pressures (2, k)."""
        theta, _ = _on_lines(self.grid, _centres(self.grid))
        normals = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        shapes = directed(end_means(self.surface, self.grid), normals, 2)
        return shapes.toarray().reshape(-1, 2, self.size).mean(axis=0)
