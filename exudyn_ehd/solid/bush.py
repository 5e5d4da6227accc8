"""What a scene writes about a nodal flexible bush."""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_ehd.solid.hex20 import IRONS14, Quadrature
from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import InputError, require_number


@dataclass(frozen=True, kw_only=True)
class Rayleigh:
    """Rayleigh damping D = mass_rate M + stiffness_time K.

    Parameters
    ----------
    mass_rate : float
        [1/s], acts on the absolute velocity: it brakes rigid motion too.
    stiffness_time : float
        [s]; taken as the Kelvin-Voigt law of `TotalLagrange`, which equals stiffness_time K in the small and does no
        work in a rigid motion.
    """

    mass_rate: float = 0.0
    stiffness_time: float = 0.0

    def __post_init__(self) -> None:
        require_number("Rayleigh.mass_rate", self.mass_rate, "1/s", at_least=0.0)
        require_number("Rayleigh.stiffness_time", self.stiffness_time, "s", at_least=0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class ANCFBush:
    """A bush of 20-node hexahedra in absolute nodal coordinates.

    Parameters
    ----------
    mesh : HollowCylinder or BushMesh
        A structured cylinder, or a mesh of `mesh_from_arrays` or `mesh_from_fem`.
    material : SaintVenantKirchhoff
    quadrature : Quadrature
        `IRONS14` by default; `GAUSS27` for the reference, `GAUSS8` for speed.
    damping : Rayleigh, optional
    parallel : bool
        Loops over elements on numba's threads.
    """

    mesh: HollowCylinder | BushMesh
    material: SaintVenantKirchhoff
    quadrature: Quadrature = IRONS14
    damping: Rayleigh | None = None
    parallel: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.mesh, HollowCylinder | BushMesh):
            raise InputError(
                f"ANCFBush.mesh must be a HollowCylinder or a BushMesh, got {type(self.mesh).__name__}; import your "
                "own mesh with mesh_from_fem or mesh_from_arrays."
            )
        if not isinstance(self.material, SaintVenantKirchhoff):
            raise InputError(f"ANCFBush.material must be a SaintVenantKirchhoff(...), got {self.material!r}.")
        if not isinstance(self.quadrature, Quadrature):
            raise InputError(f"ANCFBush.quadrature must be IRONS14, GAUSS27 or GAUSS8, got {self.quadrature!r}.")
        if not isinstance(self.damping, Rayleigh | None):
            raise InputError(f"ANCFBush.damping must be a Rayleigh(...) or None, got {self.damping!r}.")
        if not isinstance(self.parallel, bool):
            raise InputError(f"ANCFBush.parallel must be True or False, got {self.parallel!r}.")

    def build_mesh(self) -> BushMesh:
        """Return the mesh, bush frame."""
        return self.mesh.mesh() if isinstance(self.mesh, HollowCylinder) else self.mesh

    def solid(self, mesh: BushMesh) -> TotalLagrange:
        """Return the solid on a mesh, which may have been moved to its place in the model."""
        viscosity = 0.0 if self.damping is None else self.damping.stiffness_time
        return TotalLagrange(
            mesh=mesh,
            material=self.material,
            quadrature=self.quadrature,
            viscosity_time=viscosity,
            parallel=self.parallel,
        )
