"""Shape functions of a finite-element body's surface on its unrolled bore: faces of hexahedra, and triangles of three or six nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.hex20 import face_shapes
from exudyn_ehd.solid.mesh import boundary_faces
from exudyn_ehd.status import InputError

# How far a point may lie beyond a face, in natural coordinates: facets, and films as long as the bore.
OUTSIDE = 0.02


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreFaces:
    """Faces on a bore.

    Parameters
    ----------
    positions : ndarray, shape (n, 3)
        Nodes of the bore, bore frame (z = axis) [m].
    faces : ndarray of int, shape (f, a)
        Their numbers face by face; a = 8 (serendipity quadrilateral, corners first), 6 (triangle: corners, then the nodes on the edges
        0-1, 1-2, 2-0) or 3.
    """

    positions: np.ndarray
    faces: np.ndarray

    def interpolation(self, theta: np.ndarray, z: np.ndarray) -> csr_matrix:
        """S, shape (p, n): values at points of the bore from values at the nodes.

        Raises
        ------
        InputError
            Points off the faces.
        """
        theta, z = np.asarray(theta, dtype=float).ravel(), np.asarray(z, dtype=float).ravel()
        corner = self.positions[self.faces]
        point, face = self._candidates(theta, z, corner)
        natural = self._invert(corner[face], theta[point], z[point])
        outside = self._outside(natural)
        order = np.lexsort((outside, point))
        first = order[np.unique(point[order], return_index=True)[1]]
        lost = np.setdiff1d(np.arange(theta.size), point)
        if lost.size or outside[first].max() > OUTSIDE:
            bad = lost[0] if lost.size else point[first[np.argmax(outside[first])]]
            raise InputError(
                f"FEBore: the point theta = {theta[bad]:g} rad, z = {z[bad]:g} m of the film lies on no face of the bore, whose nodes span z = "
                f"{self.positions[:, 2].min():g} to {self.positions[:, 2].max():g} m; holes in the bore are not supported: check position, "
                "axis, length and radius_tolerance."
            )
        values, _ = self._shapes(natural[first])
        rows = np.repeat(point[first], self.faces.shape[1])
        return csr_matrix(
            (values.ravel(), (rows, self.faces[face[first]].ravel())), shape=(theta.size, len(self.positions))
        )

    def _shapes(self, natural: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values (n, a) and gradients (n, a, 2)."""
        if self.faces.shape[1] == 8:
            return face_shapes(natural)
        r, s = natural.T
        L = np.stack([1.0 - r - s, r, s], axis=1)
        dL = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        if self.faces.shape[1] == 3:
            return L, np.broadcast_to(dL, (len(r), 3, 2))
        pairs = ((0, 1), (1, 2), (2, 0))
        value = np.column_stack([L * (2.0 * L - 1.0), *(4.0 * L[:, i] * L[:, j] for i, j in pairs)])
        ends = (4.0 * L - 1.0)[:, :, None] * dL
        edges = [4.0 * (L[:, i, None] * dL[j] + L[:, j, None] * dL[i]) for i, j in pairs]
        return value, np.concatenate([ends, np.stack(edges, axis=1)], axis=1)

    def _outside(self, natural: np.ndarray) -> np.ndarray:
        if self.faces.shape[1] == 8:
            return np.abs(natural).max(axis=1) - 1.0
        return np.maximum(-natural.min(axis=1), natural.sum(axis=1) - 1.0)

    def _candidates(self, theta: np.ndarray, z: np.ndarray, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        centre = np.arctan2(corner[..., 1].mean(axis=1), corner[..., 0].mean(axis=1))
        spread = np.abs(_wrap(np.arctan2(corner[..., 1], corner[..., 0]) - centre[:, None])).max(axis=1)
        low, high = corner[..., 2].min(axis=1), corner[..., 2].max(axis=1)
        margin = 0.05 * (high - low)
        close = np.abs(_wrap(theta[:, None] - centre)) <= 1.05 * spread + 1e-9
        close &= (z[:, None] >= low - margin) & (z[:, None] <= high + margin)
        point, face = np.nonzero(close)
        return point, face

    def _invert(self, corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        natural = np.full((len(corner), 2), 0.0 if self.faces.shape[1] == 8 else 1.0 / 3.0)
        for _ in range(20):
            value, gradient = self._shapes(natural)
            x = np.einsum("na,nai->ni", value, corner)
            slope = np.einsum("nar,nai->nir", gradient, corner)
            error = np.stack([_wrap(np.arctan2(x[:, 1], x[:, 0]) - theta), x[:, 2] - z], axis=1)
            turn = (x[:, 0, None] * slope[:, 1] - x[:, 1, None] * slope[:, 0]) / (x[:, :2] ** 2).sum(axis=1)[:, None]
            step = np.linalg.solve(np.stack([turn, slope[:, 2]], axis=1), error[..., None])[..., 0]
            natural = np.clip(natural - step, -1.5, 1.5)
            if step.size == 0 or np.abs(step).max() < 1e-13:
                break
        return natural


def _wrap(angle: np.ndarray) -> np.ndarray:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def surface_faces(fem: Any) -> np.ndarray:
    """Boundary faces (f, a) of a ``FEMinterface``, mesh node numbers, as `BoreFaces` takes them.

    20-node hexahedra give their 8-node faces; any other mesh the triangles of ``VolumeToSurfaceElements``, which is called if there are none:
    six-node ones for 10-node tetrahedra.

    Raises
    ------
    InputError
        If there are no elements to find faces of.
    """
    blocks = [np.asarray(block["Hex20"], dtype=int) for block in fem.elements if len(block.get("Hex20", ()))]
    if blocks:
        return boundary_faces(np.concatenate(blocks))
    if not fem.surface and fem.elements:
        fem.VolumeToSurfaceElements()
    triangles = fem.GetSurfaceTriangles6() or fem.GetSurfaceTriangles()
    if len(triangles) == 0:
        raise InputError(
            "FEBore.fem has neither elements nor surface triangles: import the mesh with its elements (fem.elements), which tell how the "
            "nodes share the pressure."
        )
    return np.asarray(triangles, dtype=int)
