"""Kinds of elements: 20-node hexahedron, 10-node tetrahedron, and which of them a connectivity has.

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

Measured on the hollow cylinder of `exudyn_ehd.solid.elements.kinds`, its 320 hexahedra split into six each (ms on one
thread, 2 GHz; error against 14 points in the displacement under a pressure cos(2 theta)):

=============  =====  =======  ==================
rule           force  tangent  displacement error
=============  =====  =======  ==================
14 points      2.9    19       0
4 points       1.1    7.4      0.016 %
=============  =====  =======  ==================
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.solid.elements.element import Element, Quadrature, barycentric, face_of, with_middles

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


def boundary_faces(elements: np.ndarray) -> np.ndarray:
    """Faces (f, a) of elements (m, n) that belong to one element only."""
    own = element_of(elements).faces
    faces = elements[:, own].reshape(-1, own.shape[1])
    corners = np.sort(faces[:, : face_of(own).corners], axis=1)
    _, index, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    return faces[np.sort(index[count == 1])]
