"""Descriptions of flexible bushes by the user: on the nodes of a mesh, or reduced to modes of the bore."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from exudyn_ehd.solid.elements.element import Quadrature
from exudyn_ehd.solid.elements.kinds import HEX20
from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange, own_rule
from exudyn_ehd.status import NOT_NEGATIVE, Checked, InputError, require_number, require_type

# Limits of a modal bush's tolerance. Below the smallest, the waves of its search do not suffice.
SMALLEST_TOLERANCE, LARGEST_TOLERANCE = 2e-3, 0.2


@dataclass(frozen=True, kw_only=True)
class Rayleigh(Checked):
    """Damping of an `ANCFBush` by Rayleigh, D = mass_rate M + stiffness_time K.

    Parameters
    ----------
    mass_rate : float, default 0.0
        Factor of the mass [1/s]. It acts on the absolute velocity, so it brakes rigid motion too.
    stiffness_time : float, default 0.0
        Factor of the stiffness [s]: a mode of the angular frequency w has the damping ratio stiffness_time w / 2. At
        large strain it is the Kelvin-Voigt law, which does no work in a rigid motion.

    Examples
    --------
    >>> damping = ehd.Rayleigh(stiffness_time=1e-6)
    >>> damping.mass_rate  # 1/s
    0.0
    """

    mass_rate: float = 0.0
    stiffness_time: float = 0.0

    checks: ClassVar = {"mass_rate": NOT_NEGATIVE, "stiffness_time": NOT_NEGATIVE}


@dataclass(frozen=True, kw_only=True, eq=False)
class _Solid:
    """Common part of both kinds of bush; parameters as in `ANCFBush`."""

    mesh: HollowCylinder | BushMesh
    material: SaintVenantKirchhoff
    quadrature: Quadrature | None = None

    def __post_init__(self) -> None:
        kind = type(self).__name__
        if not isinstance(self.mesh, HollowCylinder | BushMesh):
            raise InputError(
                f"{kind}.mesh must be a HollowCylinder or a BushMesh, got {type(self.mesh).__name__}; import your "
                "own mesh with mesh_from_file, mesh_from_fem or mesh_from_arrays."
            )
        require_type(f"{kind}.material", self.material, SaintVenantKirchhoff)
        element = HEX20 if isinstance(self.mesh, HollowCylinder) else self.mesh.element
        object.__setattr__(self, "quadrature", own_rule(kind, element, self.quadrature))
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(field.default, bool) and not isinstance(value, bool):
                raise InputError(f"{kind}.{field.name} must be True or False, got {value!r}.")

    def build_mesh(self) -> BushMesh:
        """Return the mesh, bush frame."""
        return self.mesh.mesh() if isinstance(self.mesh, HollowCylinder) else self.mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class ANCFBush(_Solid):
    """A bush as a finite-element mesh whose nodes all move in the run (ANCF): any strain, slowest.

    For soft bushes, or where the bush's own inertia counts; otherwise `ModalBush` is far faster. In a joint it moves
    with its mass; `steady` and `equilibrium` use its static equilibrium.

    Parameters
    ----------
    mesh : HollowCylinder or BushMesh
        A structured cylinder, or a mesh of `mesh_from_file`, `mesh_from_arrays` or `mesh_from_fem`.
    material : SaintVenantKirchhoff or NeoHooke
        `NeoHooke` for soft bushes, beyond strains of a few per cent.
    quadrature : Quadrature or None, default None
        Of hexahedra (`exudyn_ehd.solid.elements.kinds`) `IRONS14` by default, `GAUSS27` for the reference, `GAUSS8` for
        speed; of tetrahedra (`exudyn_ehd.solid.elements.kinds`) `HAMMER4` by default, `WALKINGTON14` for the reference.
    damping : Rayleigh or None, default None
        Material damping; None: undamped.
    parallel : bool, default False
        True runs the loops over elements on numba's threads.

    Examples
    --------
    After the examples of `HollowCylinder` and `SaintVenantKirchhoff`:

    >>> bush = ehd.ANCFBush(mesh=mesh, material=steel)
    >>> b = dict(journal_radius=0.02997, length=0.06, radial_clearance=30e-6, lubricant=ehd.Lubricant(viscosity=9e-3))
    >>> ehd.JournalBearing(**b, bush=bush).bush is bush
    True
    """

    damping: Rayleigh | None = None
    parallel: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        require_type("ANCFBush.damping", self.damping, Rayleigh, type(None))

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


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalBush(_Solid):
    """A linear elastic bush, reduced to modes of its bore; outer surface fixed to the housing.

    The usual choice for steel, bronze and polymers, at strains below 1 %; `ANCFBush` for larger ones.

    It follows the oil pressure without inertia: its mass and weight belong to the housing's body, and acceleration does
    not deform the bush. This omits, at 1 g, a bore deflection of up to 0.1 nm in steel, 1.2 nm in a polymer of
    3 GPa and 0.3 um in rubber of 10 MPa (20 mm thick around a bore of 60 mm, held outside; it grows with the
    acceleration and the square of the thickness). Take `ANCFBush` where that is a large share of the film thickness.

    Parameters
    ----------
    mesh : HollowCylinder or BushMesh
        Mesh in the bush frame, which is the joint frame. Take two or more radial layers: a finer mesh takes longer to
        reduce, but not to run.
    material : SaintVenantKirchhoff
        Its density is not used.
    tolerance : float, default 0.07
        Largest relative error of the bore deflection, 2e-3 to 0.2: smaller takes more modes. At 0.07 peak pressure and
        minimum film thickness differ by at most 0.9 % from those of the unreduced mesh, with 33 to 128 modes (57 to
        164 for tilted journals). Measured on 150 random bushes: 12 to 24 elements around; held outside, on half of it,
        on a foot of 1.1 rad or at an end; 1 to 3 times as long as the film; walls of 0.15 to 1 radius; 3e9 to 2e11 Pa.

        The error is the root mean square over the film's length divided by that of the deflection; for a bush that
        moves as a whole, by that of its local deformation (`exudyn_ehd.solid.pressure_modes`). It holds for sampled
        films of all directions at an eccentricity ratio of 0.9, on tilted, wavy and crowned bores too. Under other
        films it can be larger than the one that ``BoreModes.error`` gives: up to 1.5 times under 600 random films at
        ratios of 0.5 to 0.93 (9 bushes); on round bores up to 1.1 times at 0.9, 1.4 at 0.93 and 1.9 at 0.95 (aligned:
        1.2 at 0.95).
    tilted : bool, default True
        False omits the modes that are odd in z, for journals that stay parallel to the bore; a warning tells if one
        tilts. A bush that is not symmetric about its mid-plane gets these modes in any case.
    quadrature : Quadrature or None, default None
        Quadrature of the stiffness, as in `ANCFBush`.

    Examples
    --------
    After the examples of `HollowCylinder` and `SaintVenantKirchhoff`:

    >>> bush = ehd.ModalBush(mesh=mesh, material=steel, tolerance=0.1, tilted=False)
    >>> b = dict(journal_radius=0.02997, length=0.06, radial_clearance=30e-6, lubricant=ehd.Lubricant(viscosity=9e-3))
    >>> ehd.JournalBearing(**b, bush=bush).bush.tolerance
    0.1
    """

    tolerance: float = 0.07
    tilted: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        require_tolerance("ModalBush.tolerance", self.tolerance)

    def solid(self, mesh: BushMesh) -> TotalLagrange:
        """Return the solid on a mesh."""
        return TotalLagrange(mesh=mesh, material=self.material, quadrature=self.quadrature)


def require_tolerance(where: str, tolerance: float) -> float:
    """Return the tolerance of a choice of modes, or raise `InputError`."""
    hint = "0.07 is a good start."
    return require_number(where, tolerance, at_least=SMALLEST_TOLERANCE, at_most=LARGEST_TOLERANCE, hint=hint)


def require_bore(mesh: HollowCylinder | BushMesh, radius: float, length: float) -> None:
    """Refuse a bush whose bore is not that of a film of this bore radius and length, m."""
    if isinstance(mesh, HollowCylinder):
        own, what, ends = mesh.inner_radius, "HollowCylinder.inner_radius", (-0.5 * mesh.length, 0.5 * mesh.length)
    else:
        place = mesh.bore.positions
        own, what = float(np.hypot(place[:, 0], place[:, 1]).mean()), "a mesh whose bore's mean radius"
        ends = float(mesh.bore.z.min()), float(mesh.bore.z.max())
    if abs(own - radius) > 0.02 * radius:
        raise InputError(
            f"JournalBearing.bush must have the bearing's bore radius {radius:g} m within 2 %, got {what} = {own:g} m."
        )
    half = 0.5 * length * (1.0 - 1e-9)
    if ends[0] > -half or ends[1] < half:
        raise InputError(
            f"JournalBearing.bush must be at least as long as the film, {length:g} m about its mid-plane, got "
            f"a bore from {ends[0]:g} to {ends[1]:g} m."
        )
