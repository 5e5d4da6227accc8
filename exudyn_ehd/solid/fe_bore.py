"""The bore of a finite-element body that a user has reduced to modes: which faces carry the film, and how they move.

The nodes on the bore are found by their place; the shape functions of their faces carry displacements to the film and
pressures back. With Psi the bore nodes' displacements in the modes q,

    u(theta, z) = S Psi q = P q + Theta q x r + residual,

the first two terms being the rigid motion that fits u best on the film's area. The joint's frame takes part in it, so
that the gap of the film sees the residual only, ``delta = e_r (S Psi - P - Theta x r) q``: a rod may bend by many
clearances without error. Loads are carried back by the transposes.

Source of the modes: static (attachment) modes, R. R. Craig, J. Modal Analysis 2 (1987) 59, here for pressures on a bore
as in `exudyn_ehd.solid.bush`.

Faces of the surface under the film are unrolled with their shape functions. They are those of hexahedra, or triangles
of three or six nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np
from scipy.sparse import csr_matrix, spmatrix

from exudyn_ehd.progress import announced
from exudyn_ehd.solid.bush import require_tolerance
from exudyn_ehd.solid.mesh import Surface, boundary_faces, patch, require_frame
from exudyn_ehd.solid.pressure_modes import ALONG, AROUND, FilmSurface, film_modes, film_points
from exudyn_ehd.solid.total_lagrange import held_solution
from exudyn_ehd.status import POSITIVE, SMALL, Checked, InputError, require_bool, require_number, require_vector

# Largest distance of a point beyond a face, in natural coordinates: facets, and films as long as the bore.
OUTSIDE = 0.02


class BodyMesh(Protocol):
    """Attributes of a body's ``FEMinterface`` that are read and written."""

    nodes: dict[str, np.ndarray]
    elements: list[dict[str, np.ndarray]]
    surface: list
    modeBasis: dict[str, Any]
    stiffnessMatrix: spmatrix
    massMatrix: spmatrix

    def VolumeToSurfaceElements(self) -> None:
        """Find the triangles of the surface."""

    def GetSurfaceTriangles(self) -> list:
        """Triangles of three nodes."""

    def GetSurfaceTriangles6(self) -> list:
        """Triangles of six nodes."""


def surface_faces(fem: BodyMesh) -> np.ndarray:
    """Boundary faces (f, a) of a ``FEMinterface``, mesh node numbers, counter-clockwise from outside.

    20-node hexahedra give their 8-node faces; any other mesh the triangles of ``VolumeToSurfaceElements``, which is
    called if there are none: six-node ones for 10-node tetrahedra.

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
            "FEBore.fem has neither elements nor surface triangles: import the mesh with its elements (fem.elements), "
            "which tell how the nodes share the pressure."
        )
    return np.asarray(triangles, dtype=int)


def bore_faces(where: str, fem: BodyMesh, positions: np.ndarray, chosen: np.ndarray) -> Surface:
    """Faces of a mesh all of whose nodes are among ``chosen``.

    Parameters
    ----------
    where : str
        For messages.
    fem : FEMinterface
    positions : ndarray, shape (n, 3)
        All nodes, bore frame [m].
    chosen : ndarray of int
        Mesh nodes on the bore.
    """
    faces = surface_faces(fem)
    faces = faces[np.isin(faces, chosen).all(axis=1)]
    if len(faces) == 0:
        raise InputError(
            f"{where}: none of the mesh's surface faces has all of its nodes among the {len(chosen)} on the bore; "
            "check radius_tolerance, and that the FEMinterface is the body's own."
        )
    return replace(patch(positions, faces), tolerance=OUTSIDE)


def find_bore(
    where: str,
    positions: np.ndarray,
    radius: float,
    length: float,
    tolerance: float,
    nodes: tuple[int, ...] | None = None,
    outer: bool = False,
) -> np.ndarray:
    """Numbers of the nodes on a bore, or on the cylinder of a journal.

    Parameters
    ----------
    where : str
        For messages.
    positions : ndarray, shape (n, 3)
        All nodes in the joint's frame [m].
    radius, length : float
        Radius and length of the film's area [m].
    tolerance : float
        On a node's radius, over the radius.
    nodes : sequence of int, optional
        Nodes to search; by default all.
    outer : bool
        True for a journal, whose surface is farthest from its axis.

    Raises
    ------
    InputError
        Too few nodes, or nodes that leave part of the film without support.
    """
    r = np.hypot(positions[:, 0], positions[:, 1])
    if nodes is None:
        # a little beyond the film: other bores on the same axis don't count
        member = (np.abs(r - radius) <= tolerance * radius) & (np.abs(positions[:, 2]) <= 0.75 * length)
        if member.any():
            # a bore's surface is what is nearest to its axis, up to the spread of radii by facets; the next layer of a
            # fine mesh may be within the tolerance
            spread = 5e-3 * radius
            member &= r >= r[member].max() - spread if outer else r <= r[member].min() + spread
        chosen = np.flatnonzero(member)
    else:
        chosen = np.array(nodes, dtype=int)
        if chosen.size and (chosen.min() < 0 or chosen.max() >= len(r)):
            raise InputError(
                f"{where}: nodes must be mesh nodes 0 to {len(r) - 1}, got {chosen.min()} to {chosen.max()}."
            )
    if chosen.size < 12:
        nearest = np.sort(np.abs(r - radius))[:12].max() / radius if len(r) >= 12 else np.inf
        raise InputError(
            f"{where}: {chosen.size} nodes lie on the bore of radius {radius:g} m within {tolerance:g} of it and "
            f"{0.75 * length:g} m of the mid-plane, at least 12 are needed; the twelve nearest are within "
            f"{nearest:.2g}. Check position, axis, journal radius and units, or raise radius_tolerance."
        )
    angle = np.sort(np.arctan2(positions[chosen, 1], positions[chosen, 0]))
    gap = np.diff(np.append(angle, angle[0] + 2.0 * np.pi)).max()
    if gap > 0.6:
        raise InputError(
            f"{where}: the nodes on the bore leave {gap:.3g} rad of it without any, at most 0.6 rad are allowed; give "
            "a closed bore, or a finer mesh."
        )
    z = positions[chosen, 2]
    if max(z.min() + 0.5 * length, 0.5 * length - z.max()) > SMALL * length:
        raise InputError(
            f"{where}: the bore's nodes must span the film, z = -{0.5 * length:g} to {0.5 * length:g} m about the "
            f"mid-plane, got {z.min():.6g} to {z.max():.6g} m; check position and bearing length."
        )
    return chosen


@dataclass(frozen=True, kw_only=True, eq=False)
class FESurface(Checked):
    """A surface of an ObjectFFRFreducedOrder under the film; see `FEBore` and `FEJournal`."""

    fem: BodyMesh
    nodes: tuple[int, ...] | None = None
    radius_tolerance: float = 0.02
    settled: bool = True
    exact_jacobian: bool = True

    checks: ClassVar = {"radius_tolerance": POSITIVE, "settled": require_bool, "exact_jacobian": require_bool}

    def __post_init__(self) -> None:
        super().__post_init__()
        own = type(self).__name__
        if not hasattr(self.fem, "elements"):
            raise InputError(f"{own}.fem must be the FEMinterface that the body was made of, got {self.fem!r}.")
        if self.nodes is not None:
            try:
                numbers = np.asarray(self.nodes)
                good = numbers.ndim == 1 and numbers.size > 0 and numbers.dtype.kind in "iu" and numbers.min() >= 0
            except (TypeError, ValueError):
                good = False
            if not good:
                raise InputError(
                    f"{own}.nodes must be mesh node numbers (integers from 0), got {self.nodes!r}; None finds the "
                    "nodes on the film's surface."
                )


@dataclass(frozen=True, kw_only=True, eq=False)
class FEBore(FESurface):
    """Bore of a finite-element housing (ObjectFFRFreducedOrder), which deforms under the oil pressure by its modes.

    First give the body the modes that an oil pressure excites (`add_bore_modes`). Without them the bore deflects by the
    body's other modes only, and is too stiff.

    Parameters
    ----------
    fem : FEMinterface
        The mesh that the reduced body was made of, with its elements.
    nodes : sequence of int or None, default None
        Numbers of the mesh nodes on the bore; by default those on the cylinder around the joint's axis.
    radius_tolerance : float, default 0.02
        Largest difference of a node's radius from the bearing's bore radius, divided by that radius.
    settled : bool, default True
        True: if the body's modes start at zero, they start in equilibrium with the film of the initial configuration,
        the body's frame held. False: the bore starts undeformed and oscillates at first.
    exact_jacobian : bool, default True
        True: the joint replaces Exudyn's body by one with its exact Jacobian (`ReplaceReducedBody`). False: the body
        stays Exudyn's, whose Jacobian comes from finite differences.

    Examples
    --------
    After the example of `mesh_from_fem`:

    >>> bore = ehd.FEBore(fem=fem)  # JournalBearing(..., bush=bore); the housing is the reduced body made of fem
    """


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedBore:
    """A bore, or a journal's cylinder, found in a reduced body, in the joint's frame.

    What `FEBore` becomes when its joint is made.

    Parameters
    ----------
    faces : Surface
    displacements : ndarray, shape (n, 3, k)
        Their displacements per unit of the modes.
    stiffness_matrix : ndarray, shape (k, k)
        Stiffness of the modes, with the body's frame held.
    radius, length : float
        Radius and length of the film's area [m].
    settled, exact_jacobian : bool
        As in `FEBore`.
    """

    faces: Surface
    displacements: np.ndarray
    stiffness_matrix: np.ndarray
    radius: float
    length: float
    settled: bool = True
    exact_jacobian: bool = True
    rigid: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        theta, z, weight = quadrature(self.length)
        field_ = self._displaced(self.faces.interpolation(theta, z))
        place = np.stack([self.radius * np.cos(theta), self.radius * np.sin(theta), z], axis=1)
        object.__setattr__(self, "rigid", _rigid_fit(place, weight, field_))

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.displacements.shape[2]

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Stiffness (k,) of the modes in the film's object: zero, since the body has its own."""
        return np.zeros(self.count)

    def _displaced(self, values: csr_matrix) -> np.ndarray:
        return (values @ self.displacements.reshape(len(self.displacements), -1)).reshape(-1, 3, self.count)

    def held(self) -> ReducedBore:
        """Return this bore with its whole displacement left to the gap, for a frame that does not follow the bore."""
        out = replace(self)
        object.__setattr__(out, "rigid", np.zeros_like(self.rigid))
        return out

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Radial displacement against the averaged rigid motion on the grid theta x z, (len(theta), len(z), k)."""
        return self.faces.on_grid(self.radial_of, theta, z)

    def radial_of(self, values: csr_matrix, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return `radial` (p, k) at points (p,), where ``values`` (p, n) maps nodal displacements to the points."""
        normal = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        u = self._displaced(values)[:, :2]
        turn = np.stack([self.rigid[4][None] * z[:, None], -self.rigid[3][None] * z[:, None]], axis=1)
        residual = u - self.rigid[None, :2] - turn
        return np.ascontiguousarray(np.einsum("pik,pi->pk", residual, normal))


def quadrature(length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points theta, z (p,) and weights (p,), of sum one, on a bore of this length."""
    theta = 2.0 * np.pi * np.arange(AROUND) / AROUND - np.pi
    node, weight = np.polynomial.legendre.leggauss(ALONG)
    T, Z = np.meshgrid(theta, 0.5 * length * node, indexing="ij")
    return T.ravel(), Z.ravel(), np.tile(weight, AROUND) / (2.0 * AROUND)


def _rigid_fit(place: np.ndarray, weight: np.ndarray, field_: np.ndarray) -> np.ndarray:
    """Translations and rotations (6, k) that fit displacements (p, 3, k) at places (p, 3) best."""
    # u = t + phi x r
    turned = np.cross(np.eye(3), place[:, None]).transpose(0, 2, 1)
    rows = np.concatenate((np.broadcast_to(np.eye(3), turned.shape), turned), axis=2)
    normal = np.einsum("p,pia,pib->ab", weight, rows, rows)
    return np.linalg.solve(normal, np.einsum("p,pia,pik->ak", weight, rows, field_))


@dataclass(frozen=True, kw_only=True)
class BoreModesReport:
    """Result of `add_bore_modes`: how many modes were added, and the error before and after.

    Parameters
    ----------
    added, total : int
        Modes added, and modes now in the basis.
    error_before, error : float
        Error of the bore's shape under sampled films, with the basis before and now, as a share (0.07 is 7 %) of the
        local part of the shape (`exudyn_ehd.solid.pressure_modes`). The shape is the radial displacement without its
        rigid motion. Why the local part: a slender eye becomes oval by far more than the film thickness, so that every
        error would look small relative to the whole. Films of larger eccentricity ratios than the sampled 0.9 may
        exceed the error by the factors in `ModalBush`.

    Examples
    --------
    After the example of `add_bore_modes`:

    >>> report.added == report.total
    True
    """

    added: int
    total: int
    error_before: float
    error: float


def add_bore_modes(
    fem: BodyMesh,
    *,
    position: Sequence[float],
    axis: Sequence[float],
    radius: float,
    length: float,
    fixed_nodes: Sequence[int],
    tolerance: float = 0.07,
    tilted: bool = True,
    radius_tolerance: float = 0.02,
    nodes: tuple[int, ...] | None = None,
) -> BoreModesReport:
    """Add modes to a finite-element body (``FEMinterface``): deflections of its bore under an oil film.

    Call it after the modes of the interfaces (``ComputeHurtyCraigBamptonModes``) and before the ObjectFFRFreducedOrder
    is made. The new modes are the static displacements under smooth pressures on the bore, with ``fixed_nodes`` held,
    as many as `ModalBush` would take; they are orthogonal in energy to the modes that the body has.

    Parameters
    ----------
    fem : FEMinterface
        With nodes, elements, stiffness matrix, and a mode basis or none.
    position, axis : three numbers
        Mid-plane point [m] and direction of the bore's axis, in the body's frame.
    radius, length : float
        Radius and length of the bore under the film [m].
    fixed_nodes : sequence of int
        Numbers of the mesh nodes that are held: those of the first interface, which carries the body's frame.
    tolerance : float, default 0.07
        Largest relative error of the bore's shape, as in `ModalBush`; defined in `BoreModesReport`.
    tilted : bool, default True
        False omits the modes that are odd along the axis, as in `ModalBush`. A body that is not symmetric about the
        bore's mid-plane gets them in any case.
    radius_tolerance : float, default 0.02
        As in `FEBore`.
    nodes : sequence of int or None, default None
        As in `FEBore`.

    Returns
    -------
    BoreModesReport

    Raises
    ------
    InputError
        No bore there, a body that is not held, or a tolerance that is too small for the search.

    Examples
    --------
    After the examples of `SaintVenantKirchhoff` and `mesh_from_fem`:

    >>> solid = ehd.ANCFBush(mesh=mesh, material=steel).solid(bush)
    >>> fem.stiffnessMatrix, fem.massMatrix = solid.tangent(0.0 * bush.nodes).tocsr(), solid.mass.tocsr()
    >>> place = dict(position=[0, 0, 0], axis=[0, 0, 1], radius=0.03, length=0.06, fixed_nodes=bush.outer.nodes)
    >>> report = ehd.add_bore_modes(fem, **place, tolerance=0.1, tilted=False)
    >>> report.error < 0.1
    True
    """
    where = "add_bore_modes"
    point = require_vector(f"{where}.position", position, 3, "m")
    rotation = require_frame(f"{where}.axis", axis)
    radius = require_number(f"{where}.radius", radius, "m", above=0.0)
    length = require_number(f"{where}.length", length, "m", above=0.0)
    tolerance = require_tolerance(f"{where}.tolerance", tolerance)
    place = (np.asarray(fem.nodes["Position"], dtype=float) - point) @ rotation
    bore = find_bore(where, place, radius, length, radius_tolerance, nodes)
    fixed = np.unique(np.asarray(fixed_nodes, dtype=int))
    if fixed.size < 3 or np.isin(fixed, bore).any():
        raise InputError(
            f"{where}.fixed_nodes must be three nodes or more off the bore that hold the body, got {fixed.size}, "
            f"{int(np.isin(fixed, bore).sum())} of them on the bore; give the nodes of the first interface of your "
            "mode basis."
        )
    faces = bore_faces(where, fem, place, bore)
    surface = FilmSurface(faces, film_points(faces, length), length, rotation)
    K = csr_matrix(fem.stiffnessMatrix)
    with announced("exudyn_ehd: computing the modes of a bore ..."):
        try:
            solve = held_solution(K, fixed)
        except RuntimeError as singular:
            raise InputError(
                f"{where}.fixed_nodes don't hold the body: its stiffness is singular ({singular})."
            ) from None
        found = film_modes(surface, solve, K.shape[0], tilted, tolerance, without_rigid=True)
    modes = found.modes / np.abs(surface.radial @ found.modes[surface.places]).max(axis=0)
    old = np.asarray(fem.modeBasis["matrix"], dtype=float) if len(fem.modeBasis) else np.zeros((K.shape[0], 0))
    modes = _beyond(K, old, modes)
    basis = np.hstack([old, modes])

    def error_of(basis: np.ndarray) -> float:
        q = np.linalg.lstsq(basis.T @ (K @ basis), basis.T @ found.loads, rcond=None)[0]
        reduced = surface.without_rigid(surface.weighted(basis[surface.places] @ q))
        return float((np.linalg.norm(reduced - found.exact, axis=0) / found.scale).max())

    error_before, error = error_of(old), error_of(basis)
    fem.modeBasis = {"matrix": basis, "type": fem.modeBasis.get("type", "HCBmodes")}
    return BoreModesReport(added=modes.shape[1], total=basis.shape[1], error_before=error_before, error=error)


def _beyond(K: csr_matrix, old: np.ndarray, new: np.ndarray) -> np.ndarray:
    """New modes without what the old ones can do, orthogonal in energy to them; those with nothing left are dropped."""
    if old.shape[1] == 0:
        return new
    energy = np.einsum("ij,ij->j", new, K @ new)
    rest = new - old @ np.linalg.lstsq(old.T @ (K @ old), old.T @ (K @ new), rcond=None)[0]
    return rest[:, np.einsum("ij,ij->j", rest, K @ rest) > SMALL * energy]
