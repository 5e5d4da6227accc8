"""Description of a kind of element and of its faces; shape functions of simplices, and their gradients.

Functions take natural coordinates (p, d) of points, and return values (p, n) and gradients (p, n, d) of n nodes.

Faces are the 8-node quadrilateral, the triangles of six and of three nodes.

Legend: (r, s) natural coordinates, of a quadrilateral in [-1, 1]^2, of a triangle r, s >= 0 and r + s <= 1; corners
come first, then the nodes on the edges 0-1, 1-2 and so on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """A square or cube, -1 to 1, or a simplex with coordinates >= 0 of sum <= 1, with its nodes.

    Parameters
    ----------
    nodes : ndarray, shape (n, d)
        Natural coordinates.
    shapes : function
        Shape functions (p, n) and their gradients (p, n, d) at natural coordinates (p, d).
    """

    nodes: np.ndarray
    shapes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

    @property
    def is_simplex(self) -> bool:
        """Return whether it is a triangle or a tetrahedron."""
        return bool(self.nodes.min() >= 0.0)

    def outside(self, natural: np.ndarray) -> np.ndarray:
        """Return the distance of points (p, d) beyond the cell, in natural coordinates; negative inside."""
        if self.is_simplex:
            return np.maximum(-natural.min(axis=1), natural.sum(axis=1) - 1.0)
        return np.abs(natural).max(axis=1) - 1.0


def linear_simplex(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Barycentric coordinates L of a triangle or a tetrahedron, the shape functions of its corners."""
    points = np.atleast_2d(points)
    p, d = points.shape
    slopes = np.vstack([-np.ones(d), np.eye(d)])
    return np.column_stack([1.0 - points.sum(axis=1), points]), np.broadcast_to(slopes, (p, d + 1, d))


def quadratic_simplex(edges: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions L_i (2 L_i - 1) of the corners and 4 L_i L_j of the nodes on edges i-j, shape (e, 2)."""
    L, dL = linear_simplex(points)
    i, j = edges.T
    value = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, i] * L[:, j]], axis=1)
    ends, between = (4.0 * L - 1.0)[:, :, None] * dL, L[:, i, None] * dL[:, j] + L[:, j, None] * dL[:, i]
    return value, np.concatenate([ends, 4.0 * between], axis=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Quadrature:
    """Integration rule on the cube [-1, 1]^3, or on the tetrahedron xi, eta, zeta >= 0, xi + eta + zeta <= 1.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Natural coordinates.
    weights : ndarray, shape (n,)
        Weights; their sum is the volume, 8 of the cube and 1/6 of the tetrahedron.
    degree : int
        Highest total degree of polynomials integrated exactly.
    """

    points: np.ndarray
    weights: np.ndarray
    degree: int

    def __repr__(self) -> str:
        return f"Quadrature({len(self.weights)} points, degree {self.degree})"


@dataclass(frozen=True, kw_only=True, eq=False)
class Element(Cell):
    """A kind of element with n nodes.

    Parameters
    ----------
    name : str
        In messages, in the plural.
    abaqus : str
        Type of Abaqus with these nodes in this order.
    meshio : str
        Its name in meshio and VTK.
    fem : str
        Its name in Exudyn's ``FEMinterface``.
    nodes : ndarray, shape (n, 3)
        Natural coordinates.
    edges : ndarray of int, shape (k, 3)
        Corner, corner, mid-edge node.
    faces : ndarray of int, shape (f, a)
        Normals x_,r × x_,s point outward.
    shapes : function
        Shape functions (p, n) and their gradients (p, n, 3) at natural coordinates (p, 3).
    rules : dict
        Quadratures of the stiffness by their names; the first is the default.
    exact : Quadrature
        Quadrature of the mass, exact with straight edges.
    sampling : Quadrature
        Points at which stresses are most accurate.
    extrapolation : ndarray, shape (n, q)
        Map from values at these points to values at the nodes.
    """

    name: str
    abaqus: str
    meshio: str
    fem: str
    edges: np.ndarray
    faces: np.ndarray
    rules: dict[str, Quadrature]
    exact: Quadrature
    sampling: Quadrature
    extrapolation: np.ndarray

    @property
    def size(self) -> int:
        """Number of nodes."""
        return len(self.nodes)

    @property
    def default(self) -> Quadrature:
        """The usual quadrature of the stiffness."""
        return next(iter(self.rules.values()))

    def accepts(self, rule: Quadrature) -> bool:
        """Return whether a quadrature is one of this element's shape."""
        volume = float(self.exact.weights.sum())
        return abs(float(np.sum(rule.weights)) - volume) < 1e-6 * volume

    def reference_gradients(self, corners: np.ndarray, rule: Quadrature) -> tuple[np.ndarray, np.ndarray]:
        """Return dN_a/dX, shape (m, q, n, 3) [1/m], and volume weights (m, q) [m^3] of elements (m, n, 3)."""
        inverse, weight = self.inverse_jacobians(corners, rule)
        return np.einsum("qar,eqri->eqai", self.shapes(rule.points)[1], inverse), weight

    def inverse_jacobians(self, corners: np.ndarray, rule: Quadrature) -> tuple[np.ndarray, np.ndarray]:
        """Return dxi_r/dX_i, shape (m, q, 3, 3) [1/m], and volume weights (m, q) [m^3] of elements (m, n, 3)."""
        jacobian = np.einsum("qar,eai->eqir", self.shapes(rule.points)[1], corners)
        return np.linalg.inv(jacobian), rule.weights * np.linalg.det(jacobian)


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
