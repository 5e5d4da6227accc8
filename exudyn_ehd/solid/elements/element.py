"""Description of a kind of element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_ehd.solid.elements.shapes import Cell


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
    abaqus : tuple of str
        Types of Abaqus with these nodes in this order.
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
    abaqus: tuple[str, ...]
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
