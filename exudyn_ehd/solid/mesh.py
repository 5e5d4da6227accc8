"""Meshes of a bearing bush: hollow cylinders of 20-node hexahedra; surfaces and lines of any mesh.

Bush frame: origin on the bearing axis, z = axis; theta counts from x about z. A structured mesh spans
z = -length/2 to length/2. A surface around the axis is unrolled to theta and z, where the faces are found in which
points lie, and the edges at which faces meet and end.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.elements.element import HEX_NODES, Element, Face, element_of, face_of
from exudyn_ehd.status import (
    POSITIVE,
    ROUNDING,
    SMALL,
    Checked,
    InputError,
    require_integer,
    require_number,
    require_vector,
)


def boundary_faces(elements: np.ndarray) -> np.ndarray:
    """Faces (f, a) of elements (m, n) that belong to one element only."""
    own = element_of(elements).faces
    faces = elements[:, own].reshape(-1, own.shape[1])
    corners = np.sort(faces[:, : face_of(own).corners], axis=1)
    _, index, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    return faces[np.sort(index[count == 1])]


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """A patch of element faces with a nodes each, around an axis.

    Parameters
    ----------
    positions : ndarray, shape (k, 3)
        Reference positions of the nodes [m], bush frame.
    nodes : ndarray of int, shape (k,)
        Mesh nodes of the surface, each once, ascending.
    faces : ndarray of int, shape (f, a)
        Mesh nodes of each face, outward normal x_,r × x_,s, order of `exudyn_ehd.solid.elements.element`.
    local_faces : ndarray of int, shape (f, a)
        The same faces as indices into ``nodes``.
    tolerance : float
        Largest distance of a point beyond its face, in natural coordinates.
    """

    positions: np.ndarray
    nodes: np.ndarray
    faces: np.ndarray
    local_faces: np.ndarray
    tolerance: float = SMALL

    @cached_property
    def theta(self) -> np.ndarray:
        """Angle of every node about z, shape (k,) [rad], in (-pi, pi]."""
        return np.arctan2(self.positions[:, 1], self.positions[:, 0])

    @cached_property
    def z(self) -> np.ndarray:
        """Axial coordinate of every node, shape (k,) [m]."""
        return np.ascontiguousarray(self.positions[:, 2])

    @cached_property
    def kind(self) -> Face:
        """Kind of the faces."""
        return face_of(self.local_faces)

    @property
    def count(self) -> int:
        """Number of faces."""
        return len(self.local_faces)

    @cached_property
    def cuts(self) -> tuple[np.ndarray, np.ndarray]:
        """Angles [rad], 0 to 2 pi, and places z [m], ascending, at which integrals over the faces are parted.

        The lines of their corners if these are as few as a structured mesh has; others are cut evenly, in steps of
        half a small face, which a tenth of the faces are smaller than.
        """
        ends = self.positions[self.local_faces[:, : self.kind.corners]]
        _, spread, low, high = _extents(self.positions[self.local_faces])
        angles = _distinct(np.arctan2(ends[..., 1], ends[..., 0]) % (2.0 * np.pi), 2.0 * np.pi)
        places = _distinct(ends[..., 2], float(np.ptp(ends[..., 2])))
        around, along = (0.5 * float(np.quantile(size, 0.1)) for size in (2.0 * spread, high - low))
        if angles.size * around > 2.0 * np.pi:
            angles = np.arange(0.0, 2.0 * np.pi, around)
        if (places.size - 1) * along > places[-1] - places[0]:
            places = np.arange(places[0], places[-1], along)
        return angles, places

    @cached_property
    def rims(self) -> np.ndarray:
        """Edges of one face only: middle and half of their angle [rad], lowest and highest z [m], shape (r, 4)."""
        corners = self.local_faces[:, : self.kind.corners]
        edges = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        edges, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
        return np.stack(_extents(self.positions[edges[uses == 1]]), axis=1)

    def locate(self, theta: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Find the face and its natural coordinates at angles and axial positions on a cylindrical surface.

        Parameters
        ----------
        theta, z : ndarray, shape (n,)
            Angle [rad] and axial position [m].

        Returns
        -------
        face : ndarray of int, shape (n,)
        natural : ndarray, shape (n, 2)
            (r, s), found by Newton's method on theta(r, s) and z(r, s).

        Raises
        ------
        InputError
            A point lies off the surface.
        """
        theta = np.asarray(theta, dtype=float).ravel()
        z = np.asarray(z, dtype=float).ravel()
        face, natural, best = self._nearest(theta, z)
        if np.any(best > self.tolerance):
            bad = int(np.argmax(best))
            raise InputError(
                f"The film's point theta = {theta[bad]:g} rad, z = {z[bad]:g} m must lie on the surface, which "
                f"spans z = {self.z.min():g} to {self.z.max():g} m; check position, axis, length and radius_tolerance, "
                "lengthen the bush, or close the hole there."
            )
        return face, natural

    def covers(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return which points (n,) lie on the surface."""
        return self._nearest(theta, z)[2] <= self.tolerance

    def _nearest(self, theta: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return face and natural coordinates of points (n,), and how far they lie beyond the face."""
        corner = self.positions[self.local_faces]
        close = near_faces(corner, theta, z)
        # a point off the surface is tried on any face
        close[~close.any(axis=1), 0] = True
        point, face = np.nonzero(close)
        natural = invert_faces(self.kind, corner[face], theta[point], z[point])
        inside = self.kind.outside(natural)
        best = np.full(len(theta), np.inf)
        np.minimum.at(best, point, inside)
        chosen = np.full(len(theta), -1)
        hits = np.flatnonzero(inside <= best[point])
        chosen[point[hits[::-1]]] = hits[::-1]
        return face[chosen], natural[chosen], best

    def interpolation(self, theta: np.ndarray, z: np.ndarray) -> csr_matrix:
        """Return S, shape (n, k), so that S @ nodal values are the values at the points (theta, z) of the surface."""
        face, natural = self.locate(theta, z)
        weights, _ = self.kind.shapes(natural)
        rows = np.repeat(np.arange(len(face)), weights.shape[1])
        return csr_matrix((weights.ravel(), (rows, self.local_faces[face].ravel())), shape=(len(face), len(self.nodes)))

    def on_grid(self, field: Callable[..., np.ndarray], theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Values (len(theta), len(z), k) of a field on the grid theta x z.

        ``field`` takes the map (p, nodes) to points, their angles and places (p,), and returns its values (p, k).
        """
        T, Z = (x.ravel() for x in np.meshgrid(theta, z, indexing="ij"))
        return field(self.interpolation(T, Z), T, Z).reshape(len(theta), len(z), -1)

    def radial_interpolation(self, theta: np.ndarray, z: np.ndarray) -> csr_matrix:
        """Return H, shape (n, 3 k), so that H @ displacements is the radial displacement at the points (theta, z).

        Displacements are ordered node by node as x, y, z in the bush frame [m]; positive is outward, which opens a gap.
        The direction (cos theta, sin theta, 0) is that of the point. Loads are carried back by H.T @ (pressure * area).
        """
        theta = np.asarray(theta, dtype=float).ravel()
        return directed(self.interpolation(theta, z), np.stack([np.cos(theta), np.sin(theta)], axis=1))

    def radial(self, displacements: np.ndarray) -> np.ndarray:
        """Radial part (m, k) on the surface's nodes of displacements (m, 3 n) of all nodes of the mesh."""
        direction = self.positions[:, :2] / np.linalg.norm(self.positions[:, :2], axis=1)[:, None]
        moved = displacements.reshape(len(displacements), -1, 3)[:, self.nodes, :2]
        return np.asarray(np.einsum("kai,ai->ka", moved, direction))


def patch(nodes: np.ndarray, faces: np.ndarray) -> Surface:
    """Patch of faces (f, a) on nodes (n, 3)."""
    used = np.unique(faces)
    return Surface(positions=nodes[used], nodes=used, faces=faces, local_faces=np.searchsorted(used, faces))


def directed(interpolation: csr_matrix, direction: np.ndarray, parts: int = 3) -> csr_matrix:
    """Map (p, parts n) from vectors at nodes, node by node, to their share along ``direction`` (p, d) at points (p,).

    ``interpolation`` (p, n); d = 2 leaves z out, vectors of two parts have none.
    """
    S, size = interpolation.tocoo(), direction.shape[1]
    values = S.data[:, None] * direction[S.row]
    rows, columns = np.repeat(S.row, size), (parts * S.col[:, None] + np.arange(size)).ravel()
    return csr_matrix((values.ravel(), (rows, columns)), shape=(S.shape[0], parts * S.shape[1]))


def near_faces(corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Flags (p, f): which points (p,) of an unrolled surface may lie on which faces with nodes ``corner`` (f, a, 3)."""
    centre, spread, low, high = _extents(corner)
    margin = 0.05 * (high - low)
    # points of a grid share their angles and places
    angles, angle = np.unique(theta, return_inverse=True)
    places, place = np.unique(z, return_inverse=True)
    around = np.abs(wrapped(angles[:, None] - centre)) <= 1.05 * spread + 1e-9
    along = (places[:, None] >= low - margin) & (places[:, None] <= high + margin)
    return np.asarray(around[angle] & along[place])


def invert_faces(kind: Face, corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Natural coordinates (n, 2) at which theta(r, s) and z(r, s) of a face are those of points (n,), one face each.

    Parameters
    ----------
    kind : Face
    corner : ndarray, shape (n, a, 3)
        Nodes of every point's face [m].
    theta, z : ndarray, shape (n,)
        [rad], [m]
    """

    def residual(x: np.ndarray, slope: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        error = np.stack([wrapped(np.arctan2(x[:, 1], x[:, 0]) - theta[own]), x[:, 2] - z[own]], axis=1)
        turn = (x[:, 0, None] * slope[:, 1] - x[:, 1, None] * slope[:, 0]) / (x[:, :2] ** 2).sum(axis=1)[:, None]
        return error, np.stack([turn, slope[:, 2]], axis=1)

    return kind.solve(corner, residual)


def wrapped(angle: np.ndarray) -> np.ndarray:
    """Return the angle in the range from -pi to pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _distinct(values: np.ndarray, span: float) -> np.ndarray:
    """Ascending values that differ by more than rounding."""
    ordered = np.sort(values.ravel())
    return ordered[np.concatenate(([True], np.diff(ordered) > 1e-7 * span))]


def _extents(corner: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Angle of the middle, largest angle from there, lowest and highest z of every face (f,) with nodes (f, a, 3)."""
    middle = corner.mean(axis=1)
    centre = np.arctan2(middle[:, 1], middle[:, 0])
    spread = np.abs(wrapped(np.arctan2(corner[..., 1], corner[..., 0]) - centre[:, None])).max(axis=1)
    return centre, spread, corner[..., 2].min(axis=1), corner[..., 2].max(axis=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A chain of quadratic element edges.

    Parameters
    ----------
    nodes : ndarray of int, shape (k,)
        Mesh nodes on the line, each once.
    edges : ndarray of int, shape (m, 3)
        Mesh nodes of each edge: corner, corner, mid-edge.
    """

    nodes: np.ndarray
    edges: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class BushMesh:
    """A mesh of 20-node hexahedra or of 10-node tetrahedra, with the surfaces that a bearing needs.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Undeformed positions [m], bush frame: z = bush axis, z = 0 on the bearing's mid-plane.
    elements : ndarray of int, shape (m, a)
        Node numbers from 0, a = 20 in the order of the Abaqus element C3D20, a = 10 in that of C3D10.
    bore, outer, end_low, end_high : Surface
        Inner cylinder, outer surface, and the end faces at the smallest and largest z.

    Examples
    --------
    After the example of `HollowCylinder`:

    >>> bush = mesh.mesh()
    >>> bush.nodes.shape, bush.bore.nodes.shape
    ((304, 3), (128,))
    """

    nodes: np.ndarray
    elements: np.ndarray
    bore: Surface
    outer: Surface
    end_low: Surface
    end_high: Surface

    @property
    def element(self) -> Element:
        """Kind of the elements: 20-node hexahedra or 10-node tetrahedra."""
        return element_of(self.elements)

    @cached_property
    def boundary(self) -> np.ndarray:
        """All faces that belong to one element only, shape (f, a), mesh nodes."""
        return boundary_faces(self.elements)

    @cached_property
    def sample_gradients(self) -> np.ndarray:
        """Gradients dN_a/dX (m, q, a, 3) [1/m] at the points of the elements at which stresses are most accurate."""
        return self.element.reference_gradients(self.nodes[self.elements], self.element.sampling)[0]

    def surface(self, nodes: np.ndarray) -> Surface:
        """Return the boundary faces all of whose nodes are in ``nodes`` (mesh node numbers)."""
        return surface_of(self.nodes, self.boundary, np.isin(np.arange(len(self.nodes)), nodes))

    def line(self, nodes: np.ndarray) -> Line:
        """Return the element edges all of whose nodes are in ``nodes`` (mesh node numbers)."""
        edges = self.elements[:, self.element.edges].reshape(-1, 3)
        edges[:, :2] = np.sort(edges[:, :2])
        edges = np.unique(edges, axis=0)
        edges = edges[np.isin(edges, nodes).all(axis=1)]
        if len(edges) == 0:
            raise InputError(
                f"BushMesh.line: the {len(np.atleast_1d(nodes))} nodes given must contain at least one whole element "
                "edge (two corners and the node between them), got none; take them from BushMesh.generatrix or from "
                "one grid line of the mesh."
            )
        return Line(nodes=np.unique(edges), edges=edges)

    def generatrix(self, surface: Surface, theta: float) -> Line:
        """Return the straight line at angle ``theta`` [rad] on the bore or on the outer surface.

        Raises
        ------
        InputError
            No grid line runs at this angle.
        """
        theta = require_number("BushMesh.generatrix: theta", theta, "rad")
        gap = np.abs(wrapped(surface.theta - theta))
        near = surface.nodes[gap < SMALL]
        if len(near) == 0:
            raise InputError(
                f"BushMesh.generatrix: theta must be the angle of a grid line, got {theta:g} rad; the nearest one is "
                f"{surface.theta[int(np.argmin(gap))]:g} rad: take that one or change the circumferential count."
            )
        return self.line(near)


def surface_of(nodes: np.ndarray, boundary: np.ndarray, member: np.ndarray) -> Surface:
    """Patch of the faces ``boundary`` (f, a) all of whose nodes are flagged by ``member`` (n,)."""
    return patch(nodes, boundary[member[boundary].all(axis=1)])


@dataclass(frozen=True, kw_only=True)
class HollowCylinder(Checked):
    """Mesh of a hollow cylinder: its dimensions and its numbers of elements.

    Parameters
    ----------
    inner_radius, thickness, length : float
        Radius of the bore, thickness of the wall, length along z [m]; the mesh reaches from z = -length/2 to length/2.
    axial, radial, circumferential : int, default 4, 2, 40
        Numbers of elements. With one radial layer the bore is 2 % too stiff under a pressure cos(4 theta); with three
        layers and 40 elements around the error is 1 % up to cos(5 theta).

    Examples
    --------
    >>> mesh = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.06, axial=2, radial=1, circumferential=16)
    >>> round(mesh.outer_radius, 3), mesh.mesh().elements.shape
    (0.04, (32, 20))
    """

    inner_radius: float
    thickness: float
    length: float
    axial: int = 4
    radial: int = 2
    circumferential: int = 40

    checks: ClassVar = {
        **dict.fromkeys(("inner_radius", "thickness", "length"), POSITIVE),
        **dict.fromkeys(("axial", "radial"), partial(require_integer, at_least=1)),
        "circumferential": partial(require_integer, at_least=3),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("HollowCylinder: its elements", self.axial * self.radial * self.circumferential, at_most=1e5)

    @property
    def outer_radius(self) -> float:
        """Inner radius plus thickness [m]."""
        return self.inner_radius + self.thickness

    def mesh(self) -> BushMesh:
        """Return the mesh; xi runs along r, eta along theta, zeta along z; all mid-edge nodes lie on the cylinders."""
        counts = np.array([self.radial, self.circumferential, self.axial])
        corner = np.stack(np.meshgrid(*(np.arange(c) for c in counts), indexing="ij"), axis=-1).reshape(-1, 1, 3)
        grid = 2 * corner + (HEX_NODES + 1).astype(int)
        grid[..., 1] %= 2 * self.circumferential
        shape = (2 * self.circumferential, 2 * self.axial + 1, 2 * self.radial + 1)
        key = np.ravel_multi_index((grid[..., 1], grid[..., 2], grid[..., 0]), shape)
        used, elements = np.unique(key, return_inverse=True)
        elements = elements.reshape(-1, 20)
        j, k, i = np.unravel_index(used, shape)
        radius = self.inner_radius + self.thickness * i / (2 * self.radial)
        theta = np.pi * j / self.circumferential
        z = self.length * (k / (2 * self.axial) - 0.5)
        nodes = np.stack([radius * np.cos(theta), radius * np.sin(theta), z], axis=1)
        boundary = boundary_faces(elements)
        members = (i == 0, i == 2 * self.radial, k == 0, k == 2 * self.axial)
        bore, outer, end_low, end_high = (surface_of(nodes, boundary, member) for member in members)
        return BushMesh(nodes=nodes, elements=elements, bore=bore, outer=outer, end_low=end_low, end_high=end_high)


def require_frame(where: str, axis: Sequence[float]) -> np.ndarray:
    """Columns x, y and z = axis; x is the user's x (else y) projected normal to it.

    Raises
    ------
    InputError
        For an axis without a direction.
    """
    z = require_vector(where, axis, 3)
    if not np.any(z):
        raise InputError(f"{where} must be a direction, got a zero vector; use (0, 0, 1) for z.")
    z = z / np.linalg.norm(z)
    return frame_of(z, np.eye(3)[0 if abs(z[0]) < 1.0 - ROUNDING else 1])


def frame_of(z: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Columns x, y and z, a unit vector; x is ``towards`` projected normal to z."""
    x = towards - z * (z @ towards)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
