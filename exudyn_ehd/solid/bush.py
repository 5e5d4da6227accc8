"""Flexible bushes: descriptions by the user, on the nodes of a mesh or reduced to modes of the bore, and these modes.

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
from typing import ClassVar

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.elements.element import HEX20, Quadrature
from exudyn_ehd.solid.mesh import BushMesh, HollowCylinder, Surface, directed
from exudyn_ehd.solid.pressure_modes import FilmSurface, film_modes, film_points, orthogonal_on
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange, held_solution, own_rule
from exudyn_ehd.status import (
    NOT_NEGATIVE,
    Checked,
    InputError,
    PlausibilityWarning,
    require_bool,
    require_number,
    require_type,
    warn_user,
)
from exudyn_ehd.storage import cached_arrays


def require_tolerance(where: str, tolerance: float) -> float:
    """Return the tolerance of a choice of modes, or raise `InputError`."""
    # below 2e-3 the waves of the search do not suffice
    return require_number(where, tolerance, at_least=2e-3, at_most=0.2, hint="0.07 is a good start.")


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
class _Solid(Checked):
    """Common part of both kinds of bush; parameters as in `ANCFBush`."""

    mesh: HollowCylinder | BushMesh
    material: SaintVenantKirchhoff
    quadrature: Quadrature | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        kind = type(self).__name__
        if not isinstance(self.mesh, HollowCylinder | BushMesh):
            raise InputError(
                f"{kind}.mesh must be a HollowCylinder or a BushMesh, got {type(self.mesh).__name__}; import your "
                "own mesh with mesh_from_file, mesh_from_fem or mesh_from_arrays."
            )
        require_type(f"{kind}.material", self.material, SaintVenantKirchhoff)
        element = HEX20 if isinstance(self.mesh, HollowCylinder) else self.mesh.element
        object.__setattr__(self, "quadrature", own_rule(kind, element, self.quadrature))

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
        Of hexahedra `IRONS14` by default, `GAUSS27` for the reference, `GAUSS8` for speed; of tetrahedra `HAMMER4` by
        default, `WALKINGTON14` for the reference; see `exudyn_ehd.solid.elements.element`.
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

    checks: ClassVar = {"parallel": require_bool, "damping": (Rayleigh, type(None))}

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

    checks: ClassVar = {"tolerance": require_tolerance, "tilted": require_bool}

    def solid(self, mesh: BushMesh) -> TotalLagrange:
        """Return the solid on a mesh."""
        return TotalLagrange(mesh=mesh, material=self.material, quadrature=self.quadrature)


def require_bore(mesh: HollowCylinder | BushMesh, radius: float, length: float) -> None:
    """Raise `InputError` for a bush whose bore does not fit a film of this bore radius and length, m."""
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
    if (around := mesh.bore.cuts[0].size) < 12:
        warn_user(
            f"ModalBush.mesh: a bore of {around} elements around is unusual, bearings have 12 or more: films "
            "on 8 are 3 to 9 % thicker than on 40. Refine the mesh.",
            PlausibilityWarning,
        )
    length = 2.0 * float(min(-mesh.bore.z.min(), mesh.bore.z.max())) if length is None else length
    surfaces = mesh.bore.nodes, mesh.bore.faces, mesh.outer.nodes
    steel = bush.material.youngs_modulus, bush.material.poisson_ratio
    described = steel, bush.tolerance, bush.tilted, length
    key = described, mesh.nodes, mesh.elements, surfaces, bush.quadrature
    data = cached_arrays("bush_modes", key, lambda: compute_modes(bush, mesh, length))
    return BoreModes(mesh=mesh, error=float(data.pop("error")), **data)


def film_surface(bore: Surface, length: float) -> FilmSurface:
    """Points on a bore under a film of ``length`` [m] about the mid-plane, without those in its holes."""
    theta, z, weight = film_points(bore, length)
    covered = bore.covers(theta, z)
    return FilmSurface(bore, (theta[covered], z[covered], weight[covered]), length, np.eye(3))


def compute_modes(bush: ModalBush, mesh: BushMesh, length: float) -> dict[str, np.ndarray]:
    """Arrays of `BoreModes` of a bush on its mesh under a film: one factorisation, one solution per pressure."""
    solve = held_solution(bush.solid(mesh).tangent(np.zeros_like(mesh.nodes)), mesh.outer.nodes)
    surface = film_surface(mesh.bore, length)
    found = film_modes(surface, solve, mesh.nodes.size, bush.tilted, bush.tolerance)
    modes = orthogonal_on(mesh.bore.radial(found.modes.T)) @ found.modes.T
    shape = mesh.bore.radial(modes)
    peak = shape[np.arange(len(shape)), np.argmax(np.abs(shape), axis=1)]
    displacements = (modes / peak[:, None]).reshape(len(peak), -1, 3)
    return {"displacements": displacements, "stiffness": 1.0 / peak**2, "error": np.array(found.error)}
