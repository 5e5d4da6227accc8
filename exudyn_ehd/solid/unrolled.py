"""Surfaces around an axis, unrolled to angle theta and place z: where points lie on them, where faces meet and end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.elements.element import Face, face_of
from exudyn_ehd.status import SMALL, InputError


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
