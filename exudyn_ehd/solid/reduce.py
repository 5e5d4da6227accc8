"""A bush reduced to what its bore does under an oil film: static modes of film-like pressures.

With the outer surface fixed and small strain, a pressure p on the bore displaces it by ``H K^-1 H^T A p`` (H: radial bore
displacement of the nodal displacements, A: areas, K: stiffness in the reference configuration). The bore's compliance alone selects
nothing: it falls only like one over the order of a pressure wave. Film pressures do: the sample is the positive part of the
short bearing's pressure,

    p ~ -(dh/dtheta) / h^3 (1 - zeta^2),   h = 1 + (eps + tau zeta) cos(theta - phi),   zeta = 2 z / length,

at eccentricity ratios eps from moderate to high, aligned and tilted (tau), for loads all around (phi). The displacements under the
sample span the candidates; their principal directions in the norm of the strain energy (proper orthogonal decomposition) are the
modes, as many as keep the error of every sampled bore displacement below the tolerance times its largest value.

The modes have no mass of their own: under a film the bush follows quasi-statically, and its mass belongs to the body that
carries it.

Source of the idea: static (attachment) modes, R. R. Craig, J. Modal Analysis 2 (1987) 59; derived here for pressures on a bore.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse.linalg import splu

from exudyn_ehd.solid.hex20 import IRONS14, Quadrature, face_gauss, face_shapes
from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder, Surface
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError, require_integer, require_number


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalBush:
    """A linear elastic bush, reduced to modes of its bore; outer surface fixed to the housing.

    Parameters
    ----------
    mesh : HollowCylinder or BushMesh
        Bush frame = joint frame. Build it fine: two or more radial layers; the modes cost the same in a run.
    material : SaintVenantKirchhoff
        Its density is not used.
    tolerance : float
        Largest error of a sampled bore displacement over its largest value, 1e-5 to 0.2.
    tilted : bool
        False leaves tilted films out of the sample, which halves the modes; for journals that stay parallel.
    directions : int
        Load directions of the sample.
    quadrature : Quadrature
        Of the stiffness.
    """

    mesh: HollowCylinder | BushMesh
    material: SaintVenantKirchhoff
    tolerance: float = 0.01
    tilted: bool = True
    directions: int = 24
    quadrature: Quadrature = IRONS14

    def __post_init__(self) -> None:
        if not isinstance(self.mesh, HollowCylinder | BushMesh):
            raise InputError(
                f"ModalBush.mesh must be a HollowCylinder or a BushMesh, got {type(self.mesh).__name__}; import your "
                "own mesh with mesh_from_fem or mesh_from_arrays."
            )
        if not isinstance(self.material, SaintVenantKirchhoff):
            raise InputError(f"ModalBush.material must be a SaintVenantKirchhoff(...), got {self.material!r}.")
        tolerance = require_number("ModalBush.tolerance", self.tolerance, at_least=1e-5)
        if tolerance > 0.2:
            raise InputError(
                f"ModalBush.tolerance must be within 1e-5 and 0.2, got {tolerance:g}; 0.01 is a good start."
            )
        require_integer("ModalBush.directions", self.directions, at_least=8)
        if not isinstance(self.tilted, bool):
            raise InputError(f"ModalBush.tilted must be True or False, got {self.tilted!r}.")

    def build_mesh(self) -> BushMesh:
        """Return the mesh, bush frame."""
        return self.mesh.mesh() if isinstance(self.mesh, HollowCylinder) else self.mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreModes:
    """Modes of a bore.

    Parameters
    ----------
    mesh : BushMesh
    displacements : ndarray, shape (k, n, 3)
        Nodal displacements of every mode on the whole mesh, bush frame; the largest radial bore displacement of a mode is 1, so
        that its coordinate is in m.
    stiffness : ndarray, shape (k,)
        Modal stiffness [N/m]; the modes are orthogonal.
    error : float
        Largest error of a sampled bore displacement over its largest value.
    """

    mesh: BushMesh
    displacements: np.ndarray
    stiffness: np.ndarray
    error: float

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.stiffness.size

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Radial displacement of the bore at the grid theta x z for unit coordinates, shape (len(theta), len(z), k)."""
        T, Z = np.meshgrid(theta, z, indexing="ij")
        H = self.mesh.bore.radial_interpolation(T.ravel(), Z.ravel())
        bore = self.displacements[:, self.mesh.bore.nodes].reshape(self.count, -1)
        return np.ascontiguousarray((H @ bore.T).reshape(T.shape + (self.count,)))


# Eccentricity ratios of the sampled films, and tilts as share of the gap left at the loaded side.
SAMPLE_ECCENTRICITIES = (0.5, 0.8, 0.93)
SAMPLE_TILTS = (0.6, -0.6)


def bore_modes(bush: ModalBush) -> BoreModes:
    """Compute the modes of a bush: one factorisation of its stiffness, one solve per sampled pressure.

    Raises
    ------
    InputError
        If the sample can't meet the tolerance with fewer modes than pressures.
    """
    mesh = bush.build_mesh()
    solid = TotalLagrange(mesh=mesh, material=bush.material, quadrature=bush.quadrature)
    loads = sample_loads(mesh.bore, len(mesh.nodes), bush.directions, bush.tilted)
    free = np.ones(3 * len(mesh.nodes), dtype=bool)
    free[(3 * mesh.outer.nodes[:, None] + np.arange(3)).ravel()] = False
    K = solid.tangent(np.zeros_like(mesh.nodes))[free][:, free].tocsc()
    factor = splu(K, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    solutions = np.zeros((loads.shape[1], free.size))
    solutions[:, free] = factor.solve(np.ascontiguousarray(loads[free])).T
    radial = _radial(mesh.bore, solutions.reshape(len(solutions), -1, 3)[:, mesh.bore.nodes])
    size = np.abs(radial).max(axis=1)
    energy = (solutions @ loads) / np.outer(size, size)
    values, vectors = eigh(0.5 * (energy + energy.T))
    values, vectors = values[::-1], vectors[:, ::-1]
    keep, error = _enough(radial / size[:, None], vectors, bush.tolerance)
    if keep == 0:
        raise InputError(
            f"ModalBush.tolerance {bush.tolerance:g} can't be met with {len(values)} sampled pressures (error {error:.2g}); "
            "raise directions."
        )
    coefficients = vectors[:, :keep].T / size
    shape = coefficients @ radial
    peak = shape[np.arange(keep), np.argmax(np.abs(shape), axis=1)]
    return BoreModes(
        mesh=mesh,
        displacements=(coefficients / peak[:, None] @ solutions).reshape(keep, -1, 3),
        stiffness=values[:keep] / peak**2,
        error=error,
    )


def _radial(bore: Surface, displacements: np.ndarray) -> np.ndarray:
    """Radial part (k, n) of bore displacements (k, n, 3)."""
    direction = bore.positions[:, :2] / np.linalg.norm(bore.positions[:, :2], axis=1)[:, None]
    return np.einsum("kai,ai->ka", displacements[..., :2], direction)


def _enough(radial: np.ndarray, vectors: np.ndarray, tolerance: float) -> tuple[int, float]:
    """Smallest number of principal directions that meets the tolerance, and its error; 0 if all are needed.

    The projection of snapshot t in the energy norm is ``sum_k vectors[t, k] (vectors[:, k] . radial)``.
    """
    low, high = 1, len(vectors) - 1

    def worst(count: int) -> float:
        V = vectors[:, :count]
        return float(np.abs(V @ (V.T @ radial) - radial).max())

    if worst(high) > tolerance:
        return 0, worst(high)
    while low < high:
        middle = (low + high) // 2
        if worst(middle) <= tolerance:
            high = middle
        else:
            low = middle + 1
    return low, worst(low)


def sample_loads(bore: Surface, nodes: int, directions: int, tilted: bool, points: int = 4) -> np.ndarray:
    """Consistent nodal forces, radially outward, of the sampled film pressures.

    Parameters
    ----------
    bore : Surface
    nodes : int
        Number of nodes of the mesh.
    directions : int
        Load directions.
    tilted : bool
        With tilted films.
    points : int
        Gauss points per face and direction.

    Returns
    -------
    ndarray, shape (3 nodes, k)
        [N] for pressures of 1 Pa at their peaks.
    """
    natural, weight = face_gauss(points)
    value, slope = face_shapes(natural)
    corner = bore.positions[bore.local_faces]
    x = np.einsum("qa,fai->fqi", value, corner)
    tangent = np.einsum("qar,fai->fqri", slope, corner)
    area = np.linalg.norm(np.cross(tangent[:, :, 0], tangent[:, :, 1]), axis=2) * weight
    theta, zeta = np.arctan2(x[..., 1], x[..., 0]), 2.0 * x[..., 2] / np.ptp(bore.z)
    pressure = sample_pressures(theta.ravel(), zeta.ravel(), directions, tilted).reshape(area.shape + (-1,))
    direction = x[..., :2] / np.linalg.norm(x[..., :2], axis=2)[..., None]
    share = np.einsum("fq,fqk,fqi,qa->faik", area, pressure, direction, value, optimize=True)
    loads = np.zeros((nodes, 3, share.shape[-1]))
    np.add.at(loads[:, :2], bore.faces, share)
    return loads.reshape(3 * nodes, -1)


def sample_pressures(theta: np.ndarray, zeta: np.ndarray, directions: int, tilted: bool) -> np.ndarray:
    """Sampled pressures at points theta [rad], zeta = 2 z / length, shape (n, k); each with peak 1 over the points."""
    columns = []
    for eps in SAMPLE_ECCENTRICITIES:
        for share in (0.0, *SAMPLE_TILTS) if tilted else (0.0,):
            local = eps + share * (1.0 - eps) * zeta
            for phi in 2.0 * np.pi * np.arange(directions) / directions:
                h = 1.0 + local * np.cos(theta - phi)
                p = np.maximum(local * np.sin(theta - phi), 0.0) / h**3 * (1.0 - zeta**2)
                columns.append(p / p.max())
    return np.stack(columns, axis=1)
