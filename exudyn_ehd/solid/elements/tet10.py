"""The 10-node tetrahedron: nodes, shape functions, faces and quadratures.

Legend: (xi, eta, zeta) natural coordinates >= 0 with xi + eta + zeta <= 1; L_i barycentric coordinates of the corners,
L_0 = 1 - xi - eta - zeta. The node order is that of the Abaqus element C3D10, of VTK and of Exudyn's ``FEMinterface``:
corners 0-3, the first three counter-clockwise seen from the fourth, then the nodes on the edges 0-1, 1-2, 2-0, 0-3,
1-3, 2-3.

Shape functions: L_i (2 L_i - 1) of a corner, 4 L_i L_j of the node on edge i-j.

Measured on the hollow cylinder of `exudyn_ehd.solid.elements.hex20`, its 320 hexahedra split into six each (ms on one
thread, 2 GHz; error against 14 points in the displacement under a pressure cos(2 theta)):

=============  =====  =======  ==================
rule           force  tangent  displacement error
=============  =====  =======  ==================
14 points      2.9    19       0
4 points       1.1    7.4      0.016 %
=============  =====  =======  ==================
"""

from __future__ import annotations

from functools import partial

import numpy as np

from exudyn_ehd.solid.elements.element import Element, Quadrature
from exudyn_ehd.solid.elements.shapes import linear_simplex, quadratic_simplex

EDGES = np.array([(0, 1, 4), (1, 2, 5), (2, 0, 6), (0, 3, 7), (1, 3, 8), (2, 3, 9)])
"""Edges as (corner, corner, mid-edge node), shape (6, 3)."""
FACES = np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (2, 0, 3, 6, 7, 9)])
"""6-node triangles whose normal x_,r × x_,s points outward, shape (4, 6)."""

_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], dtype=float)
shapes = partial(quadratic_simplex, EDGES[:, :2])
"""Shape functions (p, 10) and their gradients (p, 10, 3) at natural coordinates (p, 3)."""


def _orbits(degree: int, four: list[tuple[float, float]], six: list[tuple[float, float]]) -> Quadrature:
    """Rule of symmetric orbits: four points with L = (1 - 3 a, a, a, a), six with L = (1/2 - a, 1/2 - a, a, a)."""
    points, weights = [], []
    for a, weight in four:
        points.append(a + (1.0 - 4.0 * a) * np.eye(4))
        weights.append(np.full(4, weight))
    for a, weight in six:
        pair = np.full((6, 4), a)
        pair[np.arange(6)[:, None], EDGES[:, :2]] = 0.5 - a
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

NODES = np.concatenate([_CORNERS, 0.5 * (_CORNERS[EDGES[:, 0]] + _CORNERS[EDGES[:, 1]])])
"""Natural coordinates of the nodes, shape (10, 3)."""

TET10 = Element(
    name="10-node tetrahedra",
    abaqus=("C3D10", "C3D10H", "C3D10HS", "C3D10I", "C3D10M", "C3D10MH"),
    meshio="tetra10",
    fem="Tet10",
    nodes=NODES,
    edges=EDGES,
    faces=FACES,
    shapes=shapes,
    rules={"HAMMER4": HAMMER4, "WALKINGTON14": WALKINGTON14},
    exact=WALKINGTON14,
    sampling=HAMMER4,
    extrapolation=linear_simplex(NODES)[0] @ np.linalg.inv(linear_simplex(HAMMER4.points)[0]),
)
"""The element."""
