"""Elements and their faces: shape functions, quadratures, the 20-node hexahedron and the 10-node tetrahedron.

Functions take natural coordinates (p, d) of points, and return values (p, n) and gradients (p, n, d) of n nodes.

Faces are the 8-node quadrilateral, the triangles of six and of three nodes.

Legend: (r, s) natural coordinates, of a quadrilateral in [-1, 1]^2, of a triangle r, s >= 0 and r + s <= 1; corners
come first, then the nodes on the edges 0-1, 1-2 and so on.

20-node serendipity hexahedron
------------------------------
Legend: (xi, eta, zeta) natural coordinates in [-1, 1]^3; N_a shape function of node a. The node order is that of the
Abaqus element C3D20, which Exudyn's ``FEMinterface`` uses too: corners 0-3 at zeta = -1 and 4-7 at zeta = +1, both
counter-clockwise seen from +zeta, then the mid-edge nodes of the lower face (8-11), of the upper face (12-15) and of
the upright edges (16-19).

Measured on a hollow cylinder of 320 elements (ms on one thread, 2 GHz; error against 27 points in the displacement of a
cylinder pinched by a quarter of its diameter):

=============  =====  =======  ==================
rule           force  tangent  displacement error
=============  =====  =======  ==================
27 points      1.1    5.8      0
14 points      0.6    3.2      0.007 %
8 points       0.4    2.2      0.5 %
=============  =====  =======  ==================

10-node tetrahedron
-------------------
Legend: (xi, eta, zeta) natural coordinates >= 0 with xi + eta + zeta <= 1; L_i barycentric coordinates of the corners,
L_0 = 1 - xi - eta - zeta. The node order is that of the Abaqus element C3D10, of VTK and of Exudyn's ``FEMinterface``:
corners 0-3, the first three counter-clockwise seen from the fourth, then the nodes on the edges 0-1, 1-2, 2-0, 0-3,
1-3, 2-3.

Shape functions: L_i (2 L_i - 1) of a corner, 4 L_i L_j of the node on edge i-j.

Measured on the same hollow cylinder, its 320 hexahedra split into six each (ms on one thread, 2 GHz; error against 14
points in the displacement under a pressure cos(2 theta)):

=============  =====  =======  ==================
rule           force  tangent  displacement error
=============  =====  =======  ==================
14 points      2.9    19       0
4 points       1.1    7.4      0.016 %
=============  =====  =======  ==================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

Residual: TypeAlias = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Residual (m, d) and its derivatives (m, d, d) to natural coordinates, of positions (m, 3), their derivatives
(m, 3, d), and the numbers (m,) of the points."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """A square or cube, -1 to 1, or a simplex with coordinates >= 0 of sum <= 1, with its nodes.

    Parameters
    ----------
    nodes : ndarray, shape (n, d)
        Natural coordinates of the corners, and of the middles of the edges if the cell is quadratic.
    """

    nodes: np.ndarray

    @property
    def is_simplex(self) -> bool:
        """Return whether it is a triangle or a tetrahedron."""
        return bool(self.nodes.min() >= 0.0)

    def shapes(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return shape functions (p, n) and their gradients (p, n, d) at natural coordinates (p, d)."""
        shapes = simplex_shapes if self.is_simplex else serendipity_shapes
        return shapes(self.nodes, np.atleast_2d(points))

    def outside(self, natural: np.ndarray) -> np.ndarray:
        """Return the distance of points (p, d) beyond the cell, in natural coordinates; negative inside."""
        if self.is_simplex:
            return np.maximum(-natural.min(axis=1), natural.sum(axis=1) - 1.0)
        return np.abs(natural).max(axis=1) - 1.0

    def solve(self, corners: np.ndarray, residual: Residual) -> np.ndarray:
        """Natural coordinates (m, d) of points at which a residual vanishes, by Newton's method.

        Points that leave their cell stay within 1.5 of its middle.

        Parameters
        ----------
        corners : ndarray, shape (m, n, 3)
            Nodes of every point's cell [m].
        residual : Residual
        """
        natural = np.tile(self.nodes.mean(axis=0), (len(corners), 1))
        moving = np.arange(len(corners))
        for _ in range(20):
            value, slope = self.shapes(natural[moving])
            nodes = corners[moving]
            error, jacobian = residual((value[:, None] @ nodes)[:, 0], nodes.swapaxes(1, 2) @ slope, moving)
            step = np.linalg.solve(jacobian, error[..., None])[..., 0]
            natural[moving] = np.clip(natural[moving] - step, -1.5, 1.5)
            moving = moving[np.abs(step).max(axis=1) >= 1e-13]
            if not moving.size:
                break
        return natural


def with_middles(corners: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Natural coordinates of the nodes: corners (c, d), then the middles of edges (k, 2)."""
    return np.concatenate([corners, corners[edges].mean(axis=1)])


def barycentric(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Barycentric coordinates L of a triangle or a tetrahedron, the shape functions of its corners."""
    p, d = points.shape
    slopes = np.vstack([-np.ones(d), np.eye(d)])
    return np.column_stack([1.0 - points.sum(axis=1), points]), np.broadcast_to(slopes, (p, d + 1, d))


def simplex_shapes(nodes: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions L_i (2 L_i - 1) of the corners and 4 L_i L_j of the nodes on edges i-j; L_i of corners alone."""
    L, dL = barycentric(points)
    if len(nodes) == L.shape[1]:
        return L, dL
    i, j = np.nonzero(barycentric(nodes)[0] == 0.5)[1].reshape(-1, 2).T
    value = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, i] * L[:, j]], axis=1)
    ends, between = (4.0 * L - 1.0)[:, :, None] * dL, L[:, i, None] * dL[:, j] + L[:, j, None] * dL[:, i]
    return value, np.concatenate([ends, 4.0 * between], axis=1)


def serendipity_shapes(nodes: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions of the quadratic square (d = 2) and cube (d = 3), with x_i = xi_i xi_ia of node a.

    Corners: N = prod(1 + x_i) (sum x_i - d + 1) / 2^d; the node on an edge along k: N = (1 - xi_k^2) times the product
    of the other 1 + x_i, over 2^(d - 1).
    """
    x, d, along = points[:, None], nodes.shape[1], nodes == 0.0
    is_corner = ~along.any(axis=1)
    factors, slopes = np.where(along, 1.0 - x**2, 1.0 + x * nodes), np.where(along, -2.0 * x, nodes)
    product = factors.prod(axis=2)
    bubble = np.where(is_corner, 0.5 * ((x * nodes).sum(axis=2) - d + 1.0), 1.0)
    rise = np.where(is_corner[:, None], 0.5 * nodes, 0.0)
    others = np.stack([np.delete(factors, i, axis=2).prod(axis=2) for i in range(d)], axis=2)
    gradient = others * slopes * bubble[..., None] + product[..., None] * rise
    return product * bubble / 2 ** (d - 1), gradient / 2 ** (d - 1)


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
    nodes
        As in `Cell`, d = 2.
    triangles : ndarray of int, shape (t, 3)
        Flat triangles that make it up.
    """

    triangles: np.ndarray

    @property
    def corners(self) -> int:
        """Number of corners: 4 of a quadrilateral, 3 of a triangle."""
        return 3 if self.is_simplex else 4

    @property
    def outline(self) -> np.ndarray:
        """Nodes around the face, closed."""
        return np.append(np.arange(len(self.nodes)).reshape(-1, self.corners).T, 0)

    def from_square(self, points: np.ndarray) -> np.ndarray:
        """Natural coordinates of points (n, 2) of the square [-1, 1]^2; its last side is a triangle's last corner."""
        if not self.is_simplex:
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
        if self.is_simplex:
            weights *= (1.0 - points[:, 1]) / 8.0
        return self.from_square(points), weights

    @cached_property
    def rule(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Weights (q,) for loads, and there the shape functions (q, a) and their gradients (q, a, 2)."""
        points, weights = self.gauss(4 if self.is_simplex else 3)
        value, gradient = self.shapes(points)
        return weights, value, gradient


def _around(corners: list[tuple[float, float]]) -> np.ndarray:
    """Corners and middles of the edges between neighbours, in order."""
    count = np.arange(len(corners))
    return with_middles(np.array(corners), np.stack([count, np.roll(count, -1)], axis=1))


QUADRILATERAL = Face(
    nodes=_around([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
    triangles=np.array([(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 7), (5, 6, 7)]),
)
"""Eight nodes, serendipity: the face of a 20-node hexahedron."""
TRIANGLE = Face(
    nodes=_around([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
    triangles=np.array([(0, 3, 5), (3, 1, 4), (4, 2, 5), (3, 4, 5)]),
)
"""Six nodes: the face of a 10-node tetrahedron."""
FLAT_TRIANGLE = Face(nodes=TRIANGLE.nodes[:3], triangles=np.array([(0, 1, 2)]))
"""Three nodes."""


def face_of(faces: np.ndarray) -> Face:
    """The kind of faces (f, a) with these nodes."""
    return {8: QUADRILATERAL, 6: TRIANGLE, 3: FLAT_TRIANGLE}[faces.shape[1]]


HEX_EDGES = np.array(
    [
        *[(0, 1, 8), (1, 2, 9), (2, 3, 10), (3, 0, 11)],
        *[(4, 5, 12), (5, 6, 13), (6, 7, 14), (7, 4, 15)],
        *[(0, 4, 16), (1, 5, 17), (2, 6, 18), (3, 7, 19)],
    ]
)
"""Edges as (corner, corner, mid-edge node), shape (12, 3)."""
HEX_NODES = with_middles(
    np.array(
        [
            *[(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)],
            *[(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
        ]
    ),
    HEX_EDGES[:, :2],
)
"""Natural coordinates of the nodes, shape (20, 3)."""


def gauss_cube(n: int) -> Quadrature:
    """Return the tensor product of the n-point Gauss-Legendre rule, exact for degree 2 n - 1 in each direction."""
    x, w = np.polynomial.legendre.leggauss(n)
    points = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel()
    return Quadrature(points=points, weights=weights, degree=2 * n - 1)


GAUSS27 = gauss_cube(3)
"""Full integration."""
IRONS14 = Quadrature(
    points=np.concatenate([np.sqrt(19 / 30) * np.vstack([np.eye(3), -np.eye(3)]), np.sqrt(19 / 33) * HEX_NODES[:8]]),
    weights=np.repeat([320 / 361, 121 / 361], [6, 8]),
    degree=5,
)
"""Rule of 14 points that goes by the name of Irons: six on the axes, eight on the diagonals. Nearly the accuracy of 27
points at half the cost; exact for a straight-edged element under constant strain."""
GAUSS8 = gauss_cube(2)
"""Reduced integration: cheapest and softest. Needs two rows of elements along or across the wall."""

HEX20 = Element(
    name="20-node hexahedra",
    abaqus="C3D20",
    meshio="hexahedron20",
    fem="Hex20",
    nodes=HEX_NODES,
    edges=HEX_EDGES,
    # xi = -1, +1, eta = -1, +1, zeta = -1, +1
    faces=np.array(
        [
            (0, 4, 7, 3, 16, 15, 19, 11),
            (1, 2, 6, 5, 9, 18, 13, 17),
            (0, 1, 5, 4, 8, 17, 12, 16),
            (3, 7, 6, 2, 19, 14, 18, 10),
            (0, 3, 2, 1, 11, 10, 9, 8),
            (4, 5, 6, 7, 12, 13, 14, 15),
        ]
    ),
    rules={"IRONS14": IRONS14, "GAUSS27": GAUSS27, "GAUSS8": GAUSS8},
    exact=GAUSS27,
    sampling=GAUSS8,
    # trilinear
    extrapolation=np.prod(1 + 3 * GAUSS8.points[None, :, :] * HEX_NODES[:, None, :], axis=2) / 8,
)
"""The 20-node hexahedron."""

TET_EDGES = np.array([(0, 1, 4), (1, 2, 5), (2, 0, 6), (0, 3, 7), (1, 3, 8), (2, 3, 9)])
"""Edges as (corner, corner, mid-edge node), shape (6, 3)."""
TET_NODES = with_middles(np.eye(4)[:, 1:], TET_EDGES[:, :2])
"""Natural coordinates of the nodes, shape (10, 3)."""


def _orbits(degree: int, four: list[tuple[float, float]], six: list[tuple[float, float]]) -> Quadrature:
    """Rule of symmetric orbits: four points with L = (1 - 3 a, a, a, a), six with L = (1/2 - a, 1/2 - a, a, a)."""
    points, weights = [], []
    for a, weight in four:
        points.append(a + (1.0 - 4.0 * a) * np.eye(4))
        weights.append(np.full(4, weight))
    for a, weight in six:
        pair = np.full((6, 4), a)
        pair[np.arange(6)[:, None], TET_EDGES[:, :2]] = 0.5 - a
        points.append(pair)
        weights.append(np.full(6, weight))
    return Quadrature(points=np.concatenate(points)[:, 1:], weights=np.concatenate(weights), degree=degree)


HAMMER4 = _orbits(2, [((5.0 - np.sqrt(5.0)) / 20.0, 1.0 / 24.0)], [])
"""Four points, exact for the stiffness of a straight-edged element. P. C. Hammer and A. H. Stroud, Math. Tables Aids
Comput. 10 (1956) 137."""
WALKINGTON14 = _orbits(
    5,
    [(0.31088591926330060980, 0.018781320953002641800), (0.092735250310891226402, 0.012248840519393658257)],
    [(0.045503704125649649492, 0.0070910034628469110730)],
)
"""Fourteen points, exact for the mass of a straight-edged element and for a curved patch under constant strain. N. J.
Walkington, Quadrature on simplices of arbitrary dimension, 2000."""

TET10 = Element(
    name="10-node tetrahedra",
    abaqus="C3D10",
    meshio="tetra10",
    fem="Tet10",
    nodes=TET_NODES,
    edges=TET_EDGES,
    faces=np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (2, 0, 3, 6, 7, 9)]),
    rules={"HAMMER4": HAMMER4, "WALKINGTON14": WALKINGTON14},
    exact=WALKINGTON14,
    sampling=HAMMER4,
    extrapolation=barycentric(TET_NODES)[0] @ np.linalg.inv(barycentric(HAMMER4.points)[0]),
)
"""The 10-node tetrahedron."""

ELEMENTS = (HEX20, TET10)


def element_of(elements: np.ndarray) -> Element:
    """The element with as many nodes as a connectivity (m, n) has columns."""
    return next(element for element in ELEMENTS if element.size == elements.shape[1])
