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
        [1/s], acts on the absolute velocity: it brakes rigid motion too.
    stiffness_time : float, default 0.0
        [s]; taken as the Kelvin-Voigt law of `TotalLagrange`, which equals stiffness_time K in the small and does no
        work in a rigid motion.

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

    Any strain and rotation in a joint; `steady` and `equilibrium` take its static equilibrium.

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
    parallel : bool, default False
        Loops over elements on numba's threads.

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

    Its mass and weight are the housing's: weight and acceleration do not bend the bush itself. At 1 g its
    bore would move by up to 0.1 nm in steel, 1.2 nm in a polymer of 3 GPa and 0.3 um in rubber of 10 MPa (20 mm thick
    around a bore of 60 mm, held outside; it grows with the acceleration, and with the square of the thickness): take
    `ANCFBush` where that is no small share of the film.

    Parameters
    ----------
    mesh : HollowCylinder or BushMesh
        Bush frame = joint frame. Build it fine: two or more radial layers; the modes cost the same in a run.
    material : SaintVenantKirchhoff
        Its density is not used.
    tolerance : float, default 0.07
        Largest error of the bore's displacement on the film's own length under sampled films of all directions, in the
        root mean square over the surface, over that displacement; of a bush that moves as a whole over what it deforms
        locally (see `solid.pressure_modes`); 2e-3 to 0.2. The sampled films have an eccentricity ratio of 0.9, on
        bores that are tilted, wavy or crowned too. At 0.07, of 150 random bushes on meshes of 12 to 24 around (held
        outside, on half of it, on a foot of 1.1 rad or at an end, 1 to 3 times as long as the film, walls of 0.15 to 1
        radius, 3e9 to 2e11 Pa, aligned and tilted) peak pressure and minimum film thickness are within 0.9 % of the
        nodal bush's (33 to 128 modes aligned, 57 to 164 tilted). The largest error under 600 random films with ratios
        of 0.5 to 0.93 is 0.67 to 1.5 of the error that `BoreModes.error` tells, for 9 bushes. Under films on round
        bores it is at most 1.1 of it at 0.9, 1.4 at 0.93 and 1.9 at 0.95; aligned at most 1.2 at 0.95.
    tilted : bool, default True
        False leaves out the modes that are odd in z: for journals that stay parallel, others are warned of. A bush
        that is not symmetric about its mid-plane gets them all the same.
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
