"""A bush reduced to what its bore does under an oil film: static modes of the pressures of films.

With the outer surface fixed and small strain, a pressure p on the bore displaces it by ``H K^-1 H^T A p`` (H: radial
bore displacement of the nodal displacements, A: areas, K: stiffness in the reference configuration). The modes are the
displacements under the leading pressures of films of the bearing's own length, see `exudyn_ehd.solid.pressure_modes`.

Pressure works on the modes, and the moment M about the bore's axis that the film's shear has, spread evenly around,

    Q = S^T (p A) + g M,

g the mean rotation of the bore in the modes. A bush on a narrow foot is rocked by it: without g the peak pressure is
up to 1.9 % off; a round bush has none. The rest of the shear, clearance over radius of it, and the pressure on the
bore's own slope displace the bore radially by 3e-4 of what pressure does in steel, 1e-3 at E = 1e9 Pa (5 mm on
c / R = 1e-3), 8e-3 at 1e7 Pa and c / R = 3e-3, measured on meshes. `ANCFBush` has them.

The modes have no mass: the bush follows the film, and its mass belongs to the body that carries it.

Source of the idea: static (attachment) modes, R. R. Craig, J. Modal Analysis 2 (1987) 59; derived here for pressures on
a bore.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid import pressure_modes
from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.linear import held_solution
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.pressure_modes import FilmSurface, film_modes, film_points, orthogonal_on
from exudyn_ehd.solid.unrolled import Surface, directed
from exudyn_ehd.status import PlausibilityWarning, warn_user
from exudyn_ehd.storage import cached_arrays

# Elements around a bore, of which fewer are warned of: on 8 the minimum film thickness is 3 to 9 % off.
FEWEST_AROUND = 12


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreModes:
    """Modes of a bore.

    Parameters
    ----------
    mesh : BushMesh
    displacements : ndarray, shape (k, n, 3)
        Nodal displacements of every mode on the whole mesh, bush frame; the largest radial bore displacement of a
        mode is 1, so that its coordinate is in m.
    stiffness : ndarray, shape (k,)
        Modal stiffness [N/m]; the modes are orthogonal in energy and on the bore, the softest come first.
    error : float
        Error under the sampled films, as in `ModalBush`.
    """

    mesh: BushMesh
    displacements: np.ndarray
    stiffness: np.ndarray
    error: float

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.stiffness.size

    @property
    def faces(self) -> Surface:
        """Faces of the bore."""
        return self.mesh.bore

    def largest_strain(self, coordinates: np.ndarray) -> float:
        """Return the largest linear strain of the bush at coordinates (k,) [m]."""
        u = np.tensordot(coordinates, self.displacements, 1)[self.mesh.elements]
        gradient = np.einsum("eai,eqaj->eqij", u, self.mesh.sample_gradients)
        return float(np.abs(np.linalg.eigvalsh(0.5 * (gradient + gradient.swapaxes(-1, -2)))).max())

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Radial displacement of the bore at the grid theta x z for unit coordinates, shape (len(theta), len(z), k)."""
        return self.faces.on_grid(self.radial_of, theta, z)

    def radial_of(self, values: csr_matrix, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return `radial` (p, k) at points (p,), where ``values`` (p, nodes) maps nodal displacements to the points."""
        H = directed(values, np.stack([np.cos(theta), np.sin(theta)], axis=1))
        bore = self.displacements[:, self.faces.nodes].reshape(self.count, -1)
        return np.ascontiguousarray(H @ bore.T)

    def twist(self, length: float) -> np.ndarray:
        """Loads (k,) of a moment of 1 Nm about the axis as a uniform traction around the bore of a film [1/m]."""
        surface = film_surface(self.faces, length)
        radius = float(np.hypot(*self.mesh.nodes[self.faces.nodes[0], :2]))
        bore = self.displacements[:, self.faces.nodes].reshape(self.count, -1)
        return np.asarray(bore @ surface.twist)[:, 0] / (radius * surface.weight.sum())


def bore_modes(bush: ModalBush, length: float | None = None) -> BoreModes:
    """The modes of a bush from the disk (see `exudyn_ehd.storage`), or computed and stored there.

    Parameters
    ----------
    bush : ModalBush
    length : float, optional
        Length of the film about the bush's mid-plane [m]; by default as long as the bush's bore.

    Raises
    ------
    InputError
        If the tolerance takes more waves than the search allows.
    """
    mesh = bush.build_mesh()
    if (around := mesh.bore.cuts[0].size) < FEWEST_AROUND:
        warn_user(
            f"ModalBush.mesh: a bore of {around} elements around is unusual, bearings have {FEWEST_AROUND} or more: "
            "films on 8 are 3 to 9 % thicker than on 40. Refine the mesh.",
            PlausibilityWarning,
        )
    length = 2.0 * float(min(-mesh.bore.z.min(), mesh.bore.z.max())) if length is None else length
    surfaces = mesh.bore.nodes, mesh.bore.faces, mesh.outer.nodes
    steel = bush.material.youngs_modulus, bush.material.poisson_ratio
    described = pressure_modes.FORMAT, steel, bush.tolerance, bush.tilted, length
    key = described, mesh.nodes, mesh.elements, surfaces, bush.quadrature

    def compute() -> dict[str, np.ndarray]:
        modes = compute_modes(bush, mesh, length)
        return {"displacements": modes.displacements, "stiffness": modes.stiffness, "error": np.array(modes.error)}

    data = cached_arrays("bush_modes", key, compute)
    return BoreModes(
        mesh=mesh, displacements=data["displacements"], stiffness=data["stiffness"], error=float(data["error"])
    )


def film_surface(bore: Surface, length: float) -> FilmSurface:
    """Points on a bore under a film of ``length`` [m] about the mid-plane, without those in its holes."""
    theta, z, weight = film_points(bore, length)
    covered = bore.covers(theta, z)
    return FilmSurface(bore, (theta[covered], z[covered], weight[covered]), length, np.eye(3))


def compute_modes(bush: ModalBush, mesh: BushMesh, length: float) -> BoreModes:
    """Compute the modes of a bush on its mesh under a film: one factorisation, one solution per pressure."""
    solve = held_solution(bush.solid(mesh).tangent(np.zeros_like(mesh.nodes)), mesh.outer.nodes)
    surface = film_surface(mesh.bore, length)
    found = film_modes(surface, solve, mesh.nodes.size, bush.tilted, bush.tolerance)
    modes = orthogonal_on(mesh.bore.radial(found.modes.T)) @ found.modes.T
    shape = mesh.bore.radial(modes)
    peak = shape[np.arange(len(shape)), np.argmax(np.abs(shape), axis=1)]
    return BoreModes(
        mesh=mesh,
        displacements=(modes / peak[:, None]).reshape(len(peak), -1, 3),
        stiffness=1.0 / peak**2,
        error=found.error,
    )
