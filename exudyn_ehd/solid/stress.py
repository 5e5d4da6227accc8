"""Cauchy and von Mises stress of a deformed bush, at nodes and at any material point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.status import InputError


@dataclass(frozen=True, kw_only=True, eq=False)
class MaterialPoints:
    """Points of the solid by element and natural coordinates.

    Parameters
    ----------
    element : ndarray of int, shape (n,)
    natural : ndarray, shape (n, 3)
    gradient : ndarray, shape (n, nodes of an element, 3)
        Of the shape functions along the reference positions [1/m].
    """

    element: np.ndarray
    natural: np.ndarray
    gradient: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class StressRecovery:
    """Stress of a mesh of one material.

    Parameters
    ----------
    mesh : BushMesh
        Reference positions.
    material : SaintVenantKirchhoff
    """

    mesh: BushMesh
    material: SaintVenantKirchhoff

    def cauchy_at(self, points: MaterialPoints, u: np.ndarray) -> np.ndarray:
        """Return sigma = F S F^T / det F, shape (n, 3, 3) [Pa], at material points; u has a row per mesh node [m]."""
        values = np.asarray(u)[self.mesh.elements[points.element]]
        return _cauchy(np.einsum("nai,naj->nij", values, points.gradient), self.material)

    def von_mises_at(self, points: MaterialPoints, u: np.ndarray) -> np.ndarray:
        """Return the von Mises stress, shape (n,) [Pa], at material points."""
        return von_mises(self.cauchy_at(points, u))

    def cauchy_at_nodes(self, u: np.ndarray) -> np.ndarray:
        """Return the Cauchy stress at all nodes, shape (mesh nodes, 3, 3) [Pa].

        Sampled at the 2 x 2 x 2 Gauss points, where the derivatives of the quadratic element are one order more
        accurate than elsewhere, extrapolated trilinearly to the nodes, and averaged over the elements that share a
        node; of tetrahedra at four points, linearly.
        """
        elements, gradient = self.mesh.elements, self.mesh.sample_gradients
        samples = _cauchy(np.einsum("eai,eqaj->eqij", np.asarray(u)[elements], gradient), self.material)
        at_nodes = np.einsum("aq,eqij->eaij", self.mesh.element.extrapolation, samples)
        total = np.zeros((len(self.mesh.nodes), 3, 3))
        np.add.at(total, elements, at_nodes)
        count = np.bincount(elements.ravel(), minlength=len(total))
        return total / count[:, None, None]

    def von_mises_at_nodes(self, u: np.ndarray) -> np.ndarray:
        """Return the von Mises stress of the averaged Cauchy stress at all nodes, shape (mesh nodes,) [Pa]."""
        return von_mises(self.cauchy_at_nodes(u))

    def locate(self, positions: np.ndarray) -> MaterialPoints:
        """Find the material points at reference positions, shape (n, 3) [m].

        Raises
        ------
        InputError
            A position lies outside the solid.
        """
        positions = np.atleast_2d(np.asarray(positions, dtype=float))
        corners, kind = self.mesh.nodes[self.mesh.elements], self.mesh.element
        _, near = scipy.spatial.cKDTree(corners.mean(axis=1)).query(positions, k=min(27, len(corners)))
        count = near.size // len(positions)
        nodes, target = corners[near.ravel()], np.repeat(positions, count, axis=0)
        natural = kind.solve(nodes, lambda x, slope, own: (x - target[own], slope))
        outside = kind.outside(natural).reshape(-1, count)
        best = outside.argmin(axis=1)
        if (lost := outside.min(axis=1) > 1e-6).any():
            raise InputError(
                f"StressRecovery.locate positions must lie inside the solid, got {positions[lost][0].tolist()} m in "
                "the reference configuration; a point on the cylinder between two nodes may lie a little outside the "
                "quadratic faces: move it inward."
            )
        chosen = np.arange(len(positions)) * count + best
        along, element = kind.shapes(natural[chosen])[1], near.ravel()[chosen]
        jacobian = np.einsum("nar,nai->nir", along, corners[element])
        gradient = np.einsum("nar,nri->nai", along, np.linalg.inv(jacobian))
        return MaterialPoints(element=element, natural=natural[chosen], gradient=gradient)


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Return sqrt(3/2 s:s), shape (...) [Pa], of stresses (..., 3, 3) with s their deviator."""
    deviator = stress - np.einsum("...ii->...", stress)[..., None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * np.einsum("...ij,...ij->...", deviator, deviator))


def _cauchy(H: np.ndarray, material: SaintVenantKirchhoff) -> np.ndarray:
    """Cauchy stress of displacement gradients H (..., 3, 3)."""
    F = H + np.eye(3)
    return material.first_piola(H) @ F.swapaxes(-1, -2) / np.linalg.det(F)[..., None, None]
