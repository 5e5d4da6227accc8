"""Pressures on bores as loads of a mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from exudyn_ehd.solid.mesh import Surface

Pressure = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""p [Pa] at angles theta [rad] and at zeta = 2 z / length, from -1 to 1 over a bore's length."""


def pressure_loads(bore: Surface, nodes: int, pressures: Sequence[Pressure], points: int = 5) -> np.ndarray:
    """Consistent nodal forces, radially outward, of pressures on a bore.

    Parameters
    ----------
    bore : Surface
    nodes : int
        Number of nodes of the mesh.
    pressures : sequence of Pressure
    points : int
        Gauss points per face and direction; on triangles as in `Face.gauss`.

    Returns
    -------
    ndarray, shape (3 nodes, k)
        [N]
    """
    natural, weight = bore.kind.gauss(points)
    value, slope = bore.kind.shapes(natural)
    corner = bore.positions[bore.local_faces]
    x = np.einsum("qa,fai->fqi", value, corner)
    tangent = np.einsum("qar,fai->fqri", slope, corner)
    area = np.linalg.norm(np.cross(tangent[:, :, 0], tangent[:, :, 1]), axis=2) * weight
    theta = np.arctan2(x[..., 1], x[..., 0])
    zeta = (2.0 * x[..., 2] - bore.z.min() - bore.z.max()) / np.ptp(bore.z)
    direction = x[..., :2] / np.linalg.norm(x[..., :2], axis=2)[..., None]
    loads = np.zeros((nodes, 3, len(pressures)))
    for k, pressure in enumerate(pressures):
        share = np.einsum("fq,fqi,qa->fai", area * pressure(theta, zeta), direction, value)
        np.add.at(loads[:, :2, k], bore.faces, share)
    return loads.reshape(3 * nodes, -1)
