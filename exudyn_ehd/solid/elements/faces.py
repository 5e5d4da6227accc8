"""Faces of elements: the 8-node quadrilateral, the triangles of six and of three nodes.

Legend: (r, s) natural coordinates, of a quadrilateral in [-1, 1]^2, of a triangle r, s >= 0 and r + s <= 1; corners
come first, then the nodes on the edges 0-1, 1-2 and so on.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from exudyn_ehd.solid.elements.shapes import Cell, linear_simplex, quadratic_simplex


@dataclass(frozen=True, kw_only=True, eq=False)
class Face(Cell):
    """A kind of face with a nodes.

    Parameters
    ----------
    nodes, shapes
        As in `Cell`, d = 2.
    corners : int
        4 of a quadrilateral, 3 of a triangle.
    outline : ndarray of int
        Nodes around the face, closed.
    triangles : ndarray of int, shape (t, 3)
        Flat triangles that make it up.
    """

    corners: int
    outline: np.ndarray
    triangles: np.ndarray

    @property
    def middle(self) -> float:
        """Both natural coordinates of the middle."""
        return 0.0 if self.corners == 4 else 1.0 / 3.0

    def from_square(self, points: np.ndarray) -> np.ndarray:
        """Natural coordinates of points (n, 2) of the square [-1, 1]^2; its last side is a triangle's last corner."""
        if self.corners == 4:
            return points
        x, y = 0.5 * (1.0 + points.T)
        return np.stack([x * (1.0 - y), y], axis=1)

    def gauss(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Points (n*n, 2) and weights (n*n,): on a quadrilateral the n x n Gauss rule, on a triangle this collapsed.

        The latter is exact for total degree 2 n - 2.
        """
        x, w = np.polynomial.legendre.leggauss(n)
        points = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
        weights = np.einsum("i,j->ij", w, w).ravel()
        if self.corners == 3:
            weights *= (1.0 - points[:, 1]) / 8.0
        return self.from_square(points), weights

    @cached_property
    def rule(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Weights (q,) for loads, and there the shape functions (q, a) and their gradients (q, a, 2)."""
        points, weights = self.gauss(3 if self.corners == 4 else 4)
        value, gradient = self.shapes(points)
        return weights, value, gradient


_SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)], dtype=float)


def _quadrilateral(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    points = np.atleast_2d(points)
    r, s = points.T
    value = np.empty((len(points), 8))
    gradient = np.empty((len(points), 8, 2))
    for a, (ra, sa) in enumerate(_SQUARE):
        if a < 4:
            value[:, a] = (1 + r * ra) * (1 + s * sa) * (r * ra + s * sa - 1) / 4
            gradient[:, a, 0] = ra * (1 + s * sa) * (2 * r * ra + s * sa) / 4
            gradient[:, a, 1] = sa * (1 + r * ra) * (r * ra + 2 * s * sa) / 4
        elif ra == 0:
            value[:, a] = (1 - r**2) * (1 + s * sa) / 2
            gradient[:, a, 0] = -r * (1 + s * sa)
            gradient[:, a, 1] = sa * (1 - r**2) / 2
        else:
            value[:, a] = (1 - s**2) * (1 + r * ra) / 2
            gradient[:, a, 0] = ra * (1 - s**2) / 2
            gradient[:, a, 1] = -s * (1 + r * ra)
    return value, gradient


QUADRILATERAL = Face(
    nodes=_SQUARE,
    corners=4,
    shapes=_quadrilateral,
    outline=np.array([0, 4, 1, 5, 2, 6, 3, 7, 0]),
    triangles=np.array([(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 7), (5, 6, 7)]),
)
"""Eight nodes, serendipity: the face of a 20-node hexahedron."""
TRIANGLE = Face(
    nodes=np.array([(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)]),
    corners=3,
    shapes=partial(quadratic_simplex, np.array([(0, 1), (1, 2), (2, 0)])),
    outline=np.array([0, 3, 1, 4, 2, 5, 0]),
    triangles=np.array([(0, 3, 5), (3, 1, 4), (4, 2, 5), (3, 4, 5)]),
)
"""Six nodes: the face of a 10-node tetrahedron."""
FLAT_TRIANGLE = Face(
    nodes=np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
    corners=3,
    shapes=linear_simplex,
    outline=np.array([0, 1, 2, 0]),
    triangles=np.array([(0, 1, 2)]),
)
"""Three nodes."""


def face_of(faces: np.ndarray) -> Face:
    """The kind of faces (f, a) with these nodes."""
    return {8: QUADRILATERAL, 6: TRIANGLE, 3: FLAT_TRIANGLE}[faces.shape[1]]
