"""The bore of a flexible bush on the film grid.

``delta = S q``, its rate ``S q_t``, and generalised loads ``S^T (p A)``.

Modal and nodal bushes differ only in S and in the elasticity that resists q. delta > 0 points outward and opens the
gap. Displacements are in the joint frame, q in m. Loads follow from the transpose of S, so that the film's work on the
bush equals its work on q.

Transfer between the film's vertices and the faces of a bore, pressures as loads and displacements as gaps: the pressure
is interpolated along every line of vertices, ``p(x) = sum_v p_v L_v(x)``, by the cubic through the four vertices around
x. With the vertices' integration weights A_v and the bore's shape functions N

    load of a node  = int p N dA = sum_v p_v A_v S_v,    S_v = int L_v N dA / A_v,

and the displacement of the film's vertices is the mean of the bore's displacement with the same weights S. So the
film's work on the vertices equals its work on the bore. The integrals are Gauss sums over the film's intervals, divided
where faces meet. Shape functions at the vertices alone would not do: on intervals that are not smaller than the faces
they act as point loads, and the bore's displacement becomes a saw-tooth.

Around the bore, with even steps, the integrals of the cubics equal the vertices' weights and their first three moments
vanish. S is then a displacement to fourth order. Along the bore, A_v are the film's weights on vertices that are not
evenly spaced. There the L_v are changed as little as possible, until ``int L_v dz = A_v`` and
``int L_v z dz = A_v z_v``. The changes are differences of the pressure over four vertices, preferably those that vanish
for a linear pressure. Force and moments of the loads then are those of the film's wrench to round-off, rigid motions
are exact, and uniform pressures load the bore uniformly.

On the ends, where bores constrict a film, S is the local displacement. S is the local displacement also next to edges
at which faces end, as at slots and holes, because a mean over both sides of a slot is no displacement of the bore.
`end_means` gives the loads of pressures that do not vanish on the ends.
"""

from __future__ import annotations

import abc
from math import ceil

import numpy as np
from scipy.sparse import csr_matrix, diags, diags_array, kron, vstack

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.solid.bush import BoreModes
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.harmonics import POINTS, WEIGHTS
from exudyn_ehd.solid.journal import JournalModes
from exudyn_ehd.solid.mesh import Surface, directed
from exudyn_ehd.status import ROUNDING, SMALL

# Number of vertices of an interpolation. Gauss points of a panel are exact for cubics times quadratic shape functions.
STENCIL = 4
# Fraction of an interval below which a panel is omitted, and of half the length within which an edge counts as lying on
# the film's end. Larger: less accurate loads of films on edges close to vertices and to ends.
TOUCHING = 1e-4
# Size of the change in `_along` that does not vanish for linear pressures; that of the others is 1. Smaller: it is used
# less.
LINEAR = 0.03
# Largest number of points times faces that are searched at once. Larger: more memory.
LARGEST_BLOCK = 2e7


def vertex_means(faces: Surface, grid: FilmGrid) -> csr_matrix:
    """S (n m, nodes) of a bore for an (n, m) film grid, without directions; rows add up to one."""
    z, along, _ = _along(grid, faces.cuts[1] / grid.reference_length)
    theta, around = _around(grid, faces.cuts[0])
    means = kron(around, csr_matrix(along), format="csr")
    torn = _near_rims(faces, grid)
    if not torn.any():
        return means @ _values(faces, grid, theta, z)
    means = diags((~torn).astype(float)) @ means
    means.eliminate_zeros()
    used = np.unique(means.indices)
    places = np.flatnonzero(torn)
    own = csr_matrix((np.ones(places.size), (places, np.arange(places.size))), shape=(torn.size, places.size))
    sound = means[:, used] @ _values(faces, grid, theta, z, used)
    return sound + own @ _values(faces, grid, grid.x, grid.z, places)


def end_means(faces: Surface, grid: FilmGrid) -> csr_matrix:
    """Return S (2 n, nodes) of the loads ``int p N dA`` of p = (1 - zeta) / 2 and (1 + zeta) / 2, zeta = 2 z / L.

    Rows follow the n lines of vertices one after the other. They are divided by the integral of p, half the length.
    """
    z, _, weight = _along(grid, faces.cuts[1] / grid.reference_length)
    theta, around = _around(grid, faces.cuts[0])
    courses = csr_matrix(_end_courses(z, weight))
    return kron(around, courses, format="csr") @ _values(faces, grid, theta, z)


def separate_means(
    grid: FilmGrid, edges: np.ndarray
) -> tuple[np.ndarray, csr_matrix, np.ndarray, np.ndarray, np.ndarray]:
    """Means for shapes that are the product of a wave around and of a profile along z with edges (e,), m.

    Returns the angles (p,) of points around and the means (n, p); the places (q,) of points along, m, and the means
    (m, q); the means (2, q) along for `end_means`.
    """
    z, along, weight = _along(grid, edges / grid.reference_length)
    theta, around = _around(grid, np.zeros(0))
    return theta, around, grid.reference_length * z, along, _end_courses(z, weight)


def _end_courses(z: np.ndarray, weight: np.ndarray) -> np.ndarray:
    half = 0.5 * float(weight.sum())
    return np.asarray(0.5 * np.stack([1.0 - z / half, 1.0 + z / half]) * weight / half)


def _values(
    faces: Surface, grid: FilmGrid, theta: np.ndarray, z: np.ndarray, chosen: np.ndarray | None = None
) -> csr_matrix:
    """Values (p, nodes) of the shape functions at the points theta x z, scaled z.

    ``chosen``: flat indices of the points, if not all.
    """
    at = np.arange(theta.size * z.size) if chosen is None else chosen
    parts = np.array_split(at, ceil(at.size * faces.count / LARGEST_BLOCK))
    places = grid.reference_length * z
    return vstack([faces.interpolation(theta[p // z.size], places[p % z.size]) for p in parts], format="csr")


def _near_rims(faces: Surface, grid: FilmGrid) -> np.ndarray:
    """Vertices (n m,) that share an interval of their interpolation with an edge at which faces end.

    At such edges the displacement of a bore may jump. Edges on the ends of the film or beyond do not count.
    """
    R, m, reach = grid.reference_length, grid.z.size, STENCIL // 2
    end = float(grid.z[-1]) * (1.0 - TOUCHING)
    near = np.clip(np.arange(m) + reach * np.array([[-1], [1]]), 0, m - 1)
    low, high = np.clip(grid.z[near], -end, end)
    middle, half, bottom, top = faces.rims.T
    inner = (bottom / R <= end) & (top / R >= -end)
    torn = np.zeros(grid.shape, dtype=bool)
    for k in np.flatnonzero(inner):
        away = np.abs((grid.x - middle[k] + np.pi) % (2.0 * np.pi) - np.pi)
        torn |= (away <= half[k] + reach * grid.width_x[0])[:, None] & (bottom[k] / R <= high) & (top[k] / R >= low)
    return torn.ravel()


def _panels(start: float, width: float, cuts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points of an interval and their weights, in units of its width from its start, between ascending cuts."""
    inside = (cuts - start) / width
    edges = np.concatenate(([0.0], inside[(inside > TOUCHING) & (inside < 1.0 - TOUCHING)], [1.0]))
    size = np.diff(edges)[:, None]
    return (edges[:-1, None] + 0.5 * size * (1.0 + POINTS)).ravel(), (0.5 * size * WEIGHTS).ravel()


def _lagrange(nodes: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Polynomials (x, nodes) that are one at a node each and zero at the others."""
    return np.asarray(np.vander(x, nodes.size) @ np.linalg.inv(np.vander(nodes)))


def _around(grid: FilmGrid, cuts: np.ndarray) -> tuple[np.ndarray, csr_matrix]:
    """Angles (p,) of the points around the bore, and the means (n, p)."""
    n, step = grid.x.size, float(grid.width_x[0])
    angles, values, vertices = [], [], []
    for i, start in enumerate(grid.x):
        x, weight = _panels(0.0, step, np.sort((cuts - start) % (2.0 * np.pi)))
        angles.append(start + step * x)
        values.append(_lagrange(np.arange(STENCIL) - 1.0, x) * weight[:, None])
        vertices.append(np.broadcast_to((i - 1 + np.arange(STENCIL)) % n, values[-1].shape))
    theta = np.concatenate(angles)
    places = np.concatenate(vertices).ravel(), np.repeat(np.arange(theta.size), STENCIL)
    return theta, csr_matrix((np.concatenate(values).ravel(), places))


def _along(grid: FilmGrid, cuts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scaled places (p,) of the points along the bore, the means (m, p) and the points' weights (p,)."""
    z, area = grid.z, grid.weight_z
    m, half = z.size, 0.5 * float(area.sum())
    # slices that have no vertices on the ends reach up to these
    edges = np.concatenate(([-half], z[1:-1], [half]))
    on_ends = abs(float(z[-1]) - half) < ROUNDING * half
    places, weights, values, changes = [], [], [], []
    for j, width in enumerate(np.diff(edges)):
        x, weight = _panels(edges[j], width, cuts)
        near = np.arange(max(0, min(j - 1, m - STENCIL)), m)[:STENCIL]
        scaled = (z[near] - edges[j]) / width
        value, change = np.zeros((x.size, m)), np.zeros((near.size - 1, m))
        value[:, near] = _lagrange(scaled, x)
        slope = scaled - scaled.mean()
        change[0, near] = LINEAR * slope / np.linalg.norm(slope)
        # differences that vanish for a linear pressure
        change[1:, near] = np.linalg.svd(np.vander(scaled, 2).T)[2][2:]
        places.append(edges[j] + width * x)
        weights.append(width * weight)
        values.append(value)
        changes.append(np.broadcast_to(change, (x.size, *change.shape)))
    at, share = np.concatenate(places), np.concatenate(weights)
    L = _with_moments(z, area, (at, share), np.concatenate(values), np.concatenate(changes), on_ends)
    means = (L * share[:, None] / area).T
    if not on_ends:
        return at, means, share
    means = np.pad(means, ((0, 0), (1, 1)))
    means[[0, -1]] = np.eye(means.shape[1])[[0, -1]]
    return np.concatenate(([-half], at, [half])), means, np.pad(share, 1)


def _with_moments(
    z: np.ndarray,
    area: np.ndarray,
    points: tuple[np.ndarray, np.ndarray],
    L: np.ndarray,
    changes: np.ndarray,
    on_ends: bool,
) -> np.ndarray:
    """Return the interpolation (p, m) with the smallest changes for which its integrals are the vertices' weights.

    The first moments of the integrals about the vertices vanish.

    Parameters
    ----------
    z, area : (m,) arrays
        Vertices and their weights.
    points : (p,) arrays
        Places and weights.
    L : (p, m) array
        Interpolation.
    changes : (p, c, m) array
        Possible additions to it at each point.
    on_ends : bool
        True: no conditions for the first and the last vertex.
    """
    at, share = points
    counts = slice(1, -1) if on_ends else slice(None)
    moments = np.stack([np.ones((at.size, z.size)), (at[:, None] - z) / np.gradient(z)])
    lack = np.stack([area, 0.0 * area]) - np.einsum("p,kpm,pm->km", share, moments, L)
    # divided by the root of the point's weight, so that equal changes of a field have the same size on all panels
    root = np.sqrt(share)
    lack, wanted = lack[:, counts].ravel(), np.einsum("p,kpm,pcm->kmpc", root, moments, changes)[:, counts]
    matrix = wanted.reshape(lack.size, changes.shape[0] * changes.shape[1])
    amount = np.linalg.lstsq(matrix, lack, rcond=1e-10)[0].reshape(changes.shape[:2])
    out: np.ndarray = L + np.einsum("p,pc,pcm->pm", 1.0 / root, amount, changes)
    return out


def dense(matrix: np.ndarray | csr_matrix) -> np.ndarray:
    """Return a matrix as an array."""
    return matrix if isinstance(matrix, np.ndarray) else np.asarray(matrix.toarray())


class Bore(abc.ABC):
    """Flexible bore with k coordinates on an (n, m) film grid.

    Attributes
    ----------
    grid : FilmGrid
    shapes : array or csr matrix (n m, k)
        S.
    size, own : int
        k, and number of the bore's coordinates; those of an elastic journal follow.
    twist : (k,) array or None
        Generalised loads on the coordinates by a moment of 1 Nm of the film about the axis, 1/m; None: zero.
    """

    def __init__(self, grid: FilmGrid, shapes: np.ndarray | csr_matrix, own: int) -> None:
        self.grid, self.shapes, self.size, self.own = grid, shapes, int(shapes.shape[1]), own
        self._onto = shapes.T if isinstance(shapes, np.ndarray) else shapes.T.tocsr()
        self.twist: np.ndarray | None = None

    def displacement(self, q: np.ndarray) -> np.ndarray:
        """S q (n, m) for coordinates or rates q (k,)."""
        return np.asarray(self.shapes @ q).reshape(self.grid.shape)

    def load(self, fields: np.ndarray) -> np.ndarray:
        """S^T f (..., k) for every field f of (..., n, m)."""
        return np.asarray((self._onto @ fields.reshape(*fields.shape[:-2], -1).T).T)

    def product(self, field: np.ndarray) -> np.ndarray:
        """S^T diag(f) S (k, k) for a field f (n, m)."""
        return dense(self._onto @ (diags_array(field.ravel()) @ self.shapes))

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
    """Bore that moves in modes, journal that moves in modes, or both; their openings of the gap are added.

    ``S = [S_bore, S_journal]``, ``q`` likewise.

    Parameters
    ----------
    modes : BoreModes, ReducedBore or None
    grid : FilmGrid
    journal : JournalModes or None
        Modes of the journal, whose coordinates follow those of the bore.

    Attributes
    ----------
    stiffness : (k,) array
        Modal stiffness, N/m.
    modes : BoreModes, ReducedBore or None
    journal : JournalModes or None
    twist : (k,) array or None
        As in `Bore`; None for a reduced body, which gets the film's moment through the mean motion of its bore.
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
            if np.abs(turned).max() * grid.reference_length > SMALL:
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
        S without directions, from `vertex_means`.
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
