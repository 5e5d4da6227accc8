"""Meshes of a bearing bush: hollow cylinders of 20-node hexahedra, their surfaces and lines.

Bush frame: origin on the bearing axis, z = axis; theta counts from x about z. A structured mesh spans
z = -length/2 to length/2.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.hex20 import EDGES, GAUSS27, NODES, boundary_faces, face_shapes, shape_gradients
from exudyn_ehd.status import InputError, require_integer, require_number, require_numbers, require_vector


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A chain of quadratic element edges.

    Parameters
    ----------
    nodes : ndarray of int, shape (k,)
        Mesh nodes on the line, each once.
    edges : ndarray of int, shape (m, 3)
        Mesh nodes of each edge: corner, corner, mid-edge.
    """

    nodes: np.ndarray
    edges: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """A patch of 8-node element faces.

    Parameters
    ----------
    positions : ndarray, shape (k, 3)
        Reference positions of the nodes [m], bush frame.
    nodes : ndarray of int, shape (k,)
        Mesh nodes of the surface, each once, ascending.
    faces : ndarray of int, shape (f, 8)
        Mesh nodes of each face, outward normal x_,r × x_,s, order of `hex20.FACE_NODES`.
    local_faces : ndarray of int, shape (f, 8)
        The same faces as indices into ``nodes``.
    """

    positions: np.ndarray
    nodes: np.ndarray
    faces: np.ndarray
    local_faces: np.ndarray

    @cached_property
    def theta(self) -> np.ndarray:
        """Angle of every node about z, shape (k,) [rad], in (-pi, pi]."""
        return np.arctan2(self.positions[:, 1], self.positions[:, 0])

    @cached_property
    def z(self) -> np.ndarray:
        """Axial coordinate of every node, shape (k,) [m]."""
        return np.ascontiguousarray(self.positions[:, 2])

    def locate(self, theta: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Find the face and its natural coordinates at angles and axial positions on a cylindrical surface.

        Parameters
        ----------
        theta, z : ndarray, shape (n,)
            Angle [rad] and axial position [m].

        Returns
        -------
        face : ndarray of int, shape (n,)
        natural : ndarray, shape (n, 2)
            (r, s) in [-1, 1], found by Newton's method on theta(r, s) and z(r, s).

        Raises
        ------
        InputError
            A point lies off the surface.
        """
        theta = np.asarray(theta, dtype=float).ravel()
        z = np.asarray(z, dtype=float).ravel()
        corner = self.positions[self.local_faces]
        close = near_faces(corner, theta, z)
        # a point off the surface is tried on any face, and refused there
        close[~close.any(axis=1), 0] = True
        point, face = np.nonzero(close)
        natural = invert_faces(face_shapes, corner[face], theta[point], z[point])
        inside = np.abs(natural).max(axis=1)
        best = np.full(len(theta), np.inf)
        np.minimum.at(best, point, inside)
        if np.any(best > 1 + 1e-6):
            bad = int(np.argmax(best))
            raise InputError(
                f"Surface.locate: the point theta = {theta[bad]:g} rad, z = {z[bad]:g} m must lie on the surface, "
                f"which spans z = {self.z.min():g} to {self.z.max():g} m; move the film grid onto the bush or lengthen "
                "the bush."
            )
        chosen = np.full(len(theta), -1)
        hits = np.flatnonzero(inside <= best[point])
        chosen[point[hits[::-1]]] = hits[::-1]
        return face[chosen], natural[chosen]

    def interpolation(self, theta: np.ndarray, z: np.ndarray) -> csr_matrix:
        """Return S, shape (n, k), so that S @ nodal values are the values at the points (theta, z) of the surface."""
        face, natural = self.locate(theta, z)
        weights, _ = face_shapes(natural)
        rows = np.repeat(np.arange(len(face)), 8)
        return csr_matrix((weights.ravel(), (rows, self.local_faces[face].ravel())), shape=(len(face), len(self.nodes)))

    def radial_interpolation(self, theta: np.ndarray, z: np.ndarray) -> csr_matrix:
        """Return H, shape (n, 3 k), so that H @ displacements is the radial displacement at the points (theta, z).

        Displacements are ordered node by node as x, y, z in the bush frame [m]; positive is outward, which opens a gap.
        The direction (cos theta, sin theta, 0) is that of the point. Loads are carried back by H.T @ (pressure * area).
        """
        theta = np.asarray(theta, dtype=float).ravel()
        return directed(self.interpolation(theta, z), np.stack([np.cos(theta), np.sin(theta)], axis=1))

    def radial(self, displacements: np.ndarray) -> np.ndarray:
        """Radial part (m, k) on the surface's nodes of displacements (m, 3 n) of all nodes of the mesh."""
        direction = self.positions[:, :2] / np.linalg.norm(self.positions[:, :2], axis=1)[:, None]
        moved = displacements.reshape(len(displacements), -1, 3)[:, self.nodes, :2]
        return np.asarray(np.einsum("kai,ai->ka", moved, direction))


def directed(interpolation: csr_matrix, direction: np.ndarray) -> csr_matrix:
    """Map (p, 3 n) from vectors at nodes, node by node, to their parts along ``direction`` (p, d) at points (p,).

    ``interpolation`` (p, n); d = 2 leaves z out.
    """
    S, size = interpolation.tocoo(), direction.shape[1]
    values = S.data[:, None] * direction[S.row]
    rows, columns = np.repeat(S.row, size), (3 * S.col[:, None] + np.arange(size)).ravel()
    return csr_matrix((values.ravel(), (rows, columns)), shape=(S.shape[0], 3 * S.shape[1]))


def near_faces(corner: np.ndarray, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Flags (p, f): which points (p,) of an unrolled surface may lie on which faces with nodes ``corner`` (f, a, 3)."""
    middle = corner.mean(axis=1)
    centre = np.arctan2(middle[:, 1], middle[:, 0])
    spread = np.abs(wrapped(np.arctan2(corner[..., 1], corner[..., 0]) - centre[:, None])).max(axis=1)
    low, high = corner[..., 2].min(axis=1), corner[..., 2].max(axis=1)
    margin = 0.05 * (high - low)
    close = np.abs(wrapped(theta[:, None] - centre)) <= 1.05 * spread + 1e-9
    return np.asarray(close & (z[:, None] >= low - margin) & (z[:, None] <= high + margin))


def invert_faces(
    shapes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    corner: np.ndarray,
    theta: np.ndarray,
    z: np.ndarray,
    start: float = 0.0,
) -> np.ndarray:
    """Natural coordinates (n, 2) of points (n,) on a face each, by Newton's method on theta(r, s) and z(r, s).

    Parameters
    ----------
    shapes : function
        Shape functions (n, a) and gradients (n, a, 2) at natural coordinates (n, 2).
    corner : ndarray, shape (n, a, 3)
        Nodes of every point's face [m].
    theta, z : ndarray, shape (n,)
        [rad], [m]
    start : float
        Both natural coordinates of a face's middle.
    """
    natural = np.full((len(corner), 2), start)
    for _ in range(20):
        value, gradient = shapes(natural)
        x = np.einsum("na,nai->ni", value, corner)
        slope = np.einsum("nar,nai->nir", gradient, corner)
        error = np.stack([wrapped(np.arctan2(x[:, 1], x[:, 0]) - theta), x[:, 2] - z], axis=1)
        turn = (x[:, 0, None] * slope[:, 1] - x[:, 1, None] * slope[:, 0]) / (x[:, :2] ** 2).sum(axis=1)[:, None]
        step = np.linalg.solve(np.stack([turn, slope[:, 2]], axis=1), error[..., None])[..., 0]
        natural = np.clip(natural - step, -1.5, 1.5)
        if step.size == 0 or np.abs(step).max() < 1e-13:
            break
    return natural


def wrapped(angle: np.ndarray) -> np.ndarray:
    """The same angle within -pi and pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@dataclass(frozen=True, kw_only=True, eq=False)
class BushMesh:
    """A mesh of 20-node hexahedra with the surfaces that a bearing needs.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions [m], bush frame.
    elements : ndarray of int, shape (m, 20)
        Connectivity in the order of `hex20.NODES`.
    bore, outer, end_low, end_high : Surface
        Inner cylinder, outer surface, and the end faces at the smallest and largest z.
    """

    nodes: np.ndarray
    elements: np.ndarray
    bore: Surface
    outer: Surface
    end_low: Surface
    end_high: Surface

    @cached_property
    def boundary(self) -> np.ndarray:
        """All faces that belong to one element only, shape (f, 8), mesh nodes."""
        return boundary_faces(self.elements)

    def surface(self, nodes: np.ndarray) -> Surface:
        """Return the boundary faces all of whose nodes are in ``nodes`` (mesh node numbers)."""
        return _surface(self.nodes, self.boundary, np.isin(np.arange(len(self.nodes)), nodes))

    def line(self, nodes: np.ndarray) -> Line:
        """Return the element edges all of whose nodes are in ``nodes`` (mesh node numbers)."""
        edges = np.unique(self.elements[:, EDGES].reshape(-1, 3), axis=0)
        swapped = edges[:, 0] > edges[:, 1]
        edges[swapped] = edges[swapped][:, [1, 0, 2]]
        edges = np.unique(edges, axis=0)
        edges = edges[np.isin(edges, nodes).all(axis=1)]
        if len(edges) == 0:
            raise InputError(
                f"BushMesh.line: the {len(np.atleast_1d(nodes))} nodes given must contain at least one whole element "
                "edge (two corners and the node between them), got none; take them from BushMesh.generatrix or from "
                "one grid line of the mesh."
            )
        return Line(nodes=np.unique(edges), edges=edges)

    def generatrix(self, surface: Surface, theta: float) -> Line:
        """Return the straight line at angle ``theta`` [rad] on the bore or on the outer surface.

        Raises
        ------
        InputError
            No grid line runs at this angle.
        """
        theta = require_number("BushMesh.generatrix theta", theta, "rad")
        near = surface.nodes[np.abs(wrapped(surface.theta - theta)) < 1e-6]
        if len(near) == 0:
            gap = np.abs(wrapped(surface.theta - theta))
            raise InputError(
                f"BushMesh.generatrix theta must be the angle of a grid line, got {theta:g} rad; the nearest one is "
                f"{surface.theta[int(np.argmin(gap))]:g} rad: take that one or change the circumferential count."
            )
        return self.line(near)


def _surface(nodes: np.ndarray, boundary: np.ndarray, member: np.ndarray) -> Surface:
    return _patch(nodes, boundary[member[boundary].all(axis=1)])


def _patch(nodes: np.ndarray, faces: np.ndarray) -> Surface:
    used = np.unique(faces)
    return Surface(positions=nodes[used], nodes=used, faces=faces, local_faces=np.searchsorted(used, faces))


@dataclass(frozen=True, kw_only=True)
class HollowCylinder:
    """A hollow cylinder and the counts of its structured mesh.

    Parameters
    ----------
    inner_radius, thickness, length : float
        [m]
    axial, radial, circumferential : int
        Elements in each direction. One radial layer is 2 % too stiff for a bore pressure cos(4 theta), three give 1 %
        up to cos(5 theta) with 40 elements around.
    """

    inner_radius: float
    thickness: float
    length: float
    axial: int = 4
    radial: int = 2
    circumferential: int = 40

    def __post_init__(self) -> None:
        require_numbers(self, above=0.0, inner_radius="m", thickness="m", length="m")
        for name, least in (("axial", 1), ("radial", 1), ("circumferential", 3)):
            require_integer(f"HollowCylinder.{name}", getattr(self, name), at_least=least)
        require_number("HollowCylinder: its elements", self.axial * self.radial * self.circumferential, at_most=1e5)

    @property
    def outer_radius(self) -> float:
        """Inner radius plus thickness [m]."""
        return self.inner_radius + self.thickness

    def mesh(self) -> BushMesh:
        """Return the mesh; xi runs along r, eta along theta, zeta along z; all mid-edge nodes lie on the cylinders."""
        counts = np.array([self.radial, self.circumferential, self.axial])
        corner = np.stack(np.meshgrid(*(np.arange(c) for c in counts), indexing="ij"), axis=-1).reshape(-1, 1, 3)
        grid = 2 * corner + (NODES + 1).astype(int)
        grid[..., 1] %= 2 * self.circumferential
        shape = (2 * self.circumferential, 2 * self.axial + 1, 2 * self.radial + 1)
        key = np.ravel_multi_index((grid[..., 1], grid[..., 2], grid[..., 0]), shape)
        used, elements = np.unique(key, return_inverse=True)
        elements = elements.reshape(-1, 20)
        j, k, i = np.unravel_index(used, shape)
        radius = self.inner_radius + self.thickness * i / (2 * self.radial)
        theta = np.pi * j / self.circumferential
        z = self.length * (k / (2 * self.axial) - 0.5)
        nodes = np.stack([radius * np.cos(theta), radius * np.sin(theta), z], axis=1)
        boundary = boundary_faces(elements)
        members = (i == 0, i == 2 * self.radial, k == 0, k == 2 * self.axial)
        bore, outer, end_low, end_high = (_surface(nodes, boundary, member) for member in members)
        return BushMesh(nodes=nodes, elements=elements, bore=bore, outer=outer, end_low=end_low, end_high=end_high)


class FEMData(Protocol):
    """What is read of Exudyn's ``FEMinterface``: nodes['Position'] (n, 3) and elements, a list with 'Hex20' (m, 20)."""

    nodes: dict
    elements: list


@dataclass(frozen=True, kw_only=True)
class OnCylinder:
    """Nodes on a cylinder about the bush's axis: ``held`` of an imported mesh.

    Parameters
    ----------
    radius : float
        [m]
    tolerance : float
        On a node's radius, over the radius.
    """

    radius: float
    tolerance: float = 5e-3

    def __post_init__(self) -> None:
        require_numbers(self, above=0.0, radius="m", tolerance="")

    def __call__(self, positions: np.ndarray) -> np.ndarray:
        """Flags (n,) of positions (n, 3) in the bush frame [m]."""
        return np.abs(np.hypot(positions[:, 0], positions[:, 1]) - self.radius) <= self.tolerance * self.radius


@dataclass(frozen=True, kw_only=True)
class OnPlane:
    """Nodes on a plane: ``held`` of an imported mesh.

    Parameters
    ----------
    point, normal : three numbers
        A point of the plane [m] and its normal, bush frame.
    tolerance : float
        Distance from the plane [m].
    """

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    tolerance: float = 1e-5

    def __post_init__(self) -> None:
        require_vector("OnPlane.point", self.point, 3, "m")
        if not np.linalg.norm(require_vector("OnPlane.normal", self.normal, 3)) > 0.0:
            raise InputError(f"OnPlane.normal must be a direction, got {self.normal!r}.")
        require_numbers(self, above=0.0, tolerance="m")

    def __call__(self, positions: np.ndarray) -> np.ndarray:
        """Flags (n,) of positions (n, 3) in the bush frame [m]."""
        normal = np.asarray(self.normal) / np.linalg.norm(self.normal)
        return np.abs((positions - np.asarray(self.point)) @ normal) <= self.tolerance


Held: TypeAlias = Sequence[int] | np.ndarray | Callable[[np.ndarray], np.ndarray]
"""Nodes of a user's mesh by number, or flags (n,) of positions (n, 3) in the bush frame."""


def mesh_from_fem(
    fem: FEMData,
    *,
    bore_radius: float,
    held: Held | None = None,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return the bush mesh of a ``FEMinterface`` that holds 20-node hexahedra.

    Parameters
    ----------
    fem : FEMinterface
        Exudyn's, with Hex20 elements (Abaqus C3D20 order) only.
    bore_radius, held, origin, axis
        As in `mesh_from_arrays`, which also says what comes back and what is refused.
    """
    sets = [np.asarray(block["Hex20"], dtype=int) for block in fem.elements if len(block.get("Hex20", ())) > 0]
    other = sorted({key for block in fem.elements for key in block if key not in ("Name", "Hex20") and len(block[key])})
    if not sets or other:
        raise InputError(
            f"mesh_from_fem fem.elements must hold Hex20 elements only, got {['Hex20'] * bool(sets) + other}; mesh the "
            "bush with C3D20 elements and put other parts into a FEMinterface of their own."
        )
    position = np.asarray(fem.nodes["Position"], dtype=float)
    elements = np.concatenate(sets)
    return mesh_from_arrays(position, elements, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


def mesh_from_arrays(
    nodes: np.ndarray,
    elements: np.ndarray,
    *,
    bore_radius: float,
    held: Held | None = None,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return a bush mesh from a user's own nodes and C3D20 connectivity; the bore is found by its radius.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [m] in the user's frame.
    elements : ndarray of int, shape (m, 20)
        Abaqus C3D20 node order, zero-based.
    bore_radius : float
        Radius [m] of the bore; its corner nodes must lie within 1 % of the radius.
    held : nodes, `OnCylinder`, `OnPlane` or function, optional
        Where the housing holds the bush: the faces all of whose nodes are among these (numbers, or flags of the user's
        nodes), or have the function of positions (n, 3) in the bush frame [m] true. By default every face that belongs
        neither to the bore nor to the ends.
    origin, axis : three numbers
        A point on the bearing's mid-plane and axis, and the axis direction, user's frame. The mesh comes back in the
        bush frame; with the default axis its x and y are the user's.

    Returns
    -------
    BushMesh
        Outer surface: the faces that are held; ends: the boundary faces normal to the axis at the smallest and the
        largest z. Unused nodes are dropped.

    Warns
    -----
    UserWarning
        If held faces reach the bore (a chamfer, a groove, an oil hole), whose edge is then clamped.

    Raises
    ------
    InputError
        No bore at this radius, no held face, inverted elements, or array shapes that don't fit.
    """
    radius = require_number("mesh_from_arrays bore_radius", bore_radius, "m", above=0.0)
    nodes, elements = np.asarray(nodes, dtype=float), np.asarray(elements, dtype=int)
    if nodes.ndim != 2 or nodes.shape[1] != 3 or elements.ndim != 2 or elements.shape[1] != 20:
        raise InputError(
            f"mesh_from_arrays nodes and elements must have shapes (n, 3) and (m, 20), got {nodes.shape} and "
            f"{elements.shape}; only 20-node hexahedra are supported."
        )
    centre = require_vector("mesh_from_arrays origin", origin, 3, "m")
    nodes = (nodes - centre) @ _frame(require_vector("mesh_from_arrays axis", axis, 3)).T
    for number in (elements.min(initial=len(nodes)), elements.max(initial=-1)):
        counts = "subtract 1 from numbers that count from 1, as Abaqus does."
        require_number("mesh_from_arrays elements", number, at_least=0, at_most=len(nodes) - 1, hint=counts)
    used, elements = np.unique(elements, return_inverse=True)
    nodes, elements = nodes[used], elements.reshape(-1, 20)
    _check_volume(nodes, elements)
    boundary = boundary_faces(elements)
    r, z = np.hypot(nodes[:, 0], nodes[:, 1]), nodes[:, 2]
    flat = 1e-4 * np.ptp(z)
    low, high = z < z.min() + flat, z > z.max() - flat
    bore = _surface(nodes, boundary, np.abs(r - radius) < 0.01 * radius)
    if len(bore.nodes) == 0:
        raise InputError(
            f"mesh_from_arrays bore_radius must be the radius of the bore in m, got {radius:g}; no boundary face lies "
            f"there: the nodes have radii {r.min():g} to {r.max():g} m. Check units, origin and axis."
        )
    on_bore = np.isin(np.arange(len(r)), bore.nodes)
    outer = _held_faces(nodes, boundary, used, held, (low, high, on_bore))
    reaching = np.intersect1d(outer, bore.nodes).size
    if reaching:
        warnings.warn(
            f"mesh_from_arrays: {reaching} nodes of the bore belong to held faces (a chamfer, a groove or a hole) and "
            "are clamped; name the held faces, e.g. held=OnCylinder(radius=...) for the outer cylinder alone.",
            stacklevel=2,
        )
    return BushMesh(
        nodes=nodes,
        elements=elements,
        bore=bore,
        outer=_patch(nodes, outer),
        end_low=_surface(nodes, boundary, low),
        end_high=_surface(nodes, boundary, high),
    )


def _held_faces(
    nodes: np.ndarray, boundary: np.ndarray, used: np.ndarray, held: Held | None, elsewhere: tuple[np.ndarray, ...]
) -> np.ndarray:
    """Faces (f, 8) that the housing holds; ``used`` are the user's numbers of the nodes, ``elsewhere`` flags (n,) of
    the ends and, last, of the bore."""
    whole = [member[boundary].all(axis=1) for member in elsewhere]
    if held is None:
        return boundary[~np.any(whole, axis=0)]
    if callable(held):
        member = np.asarray(held(nodes))
    else:
        numbers = np.asarray(held)
        member = np.isin(used, np.flatnonzero(numbers) if numbers.dtype == bool else numbers)
    if member.shape != (len(nodes),) or member.dtype != bool:
        raise InputError(
            f"mesh_from_arrays held: the function must give one bool for each of {len(nodes)} nodes, got an array of "
            f"shape {member.shape} and type {member.dtype}."
        )
    faces = boundary[member[boundary].all(axis=1) & ~whole[-1]]
    if len(faces) == 0:
        r = np.hypot(nodes[:, 0], nodes[:, 1])
        raise InputError(
            f"mesh_from_arrays held: {int(member.sum())} nodes are chosen, and no boundary face besides the bore has "
            f"all of its 8 nodes among them; the nodes have radii {r.min():g} to {r.max():g} m and z from "
            f"{nodes[:, 2].min():g} to {nodes[:, 2].max():g} m in the bush frame. Check units, radius and tolerance."
        )
    return faces


def _frame(axis: np.ndarray) -> np.ndarray:
    """Rotation matrix whose rows are the bush axes; z = axis, x = the user's x (else y) projected normal to it."""
    length = np.linalg.norm(axis)
    if length == 0:
        raise InputError("mesh_from_arrays axis must be a direction, got a zero vector; use (0, 0, 1) for z.")
    z = axis / length
    return frame_of(z, np.eye(3)[0 if abs(z[0]) < 1 - 1e-9 else 1]).T


def frame_of(z: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Columns x, y and z, a unit vector; x is ``towards`` projected normal to z."""
    x = towards - z * (z @ towards)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _check_volume(nodes: np.ndarray, elements: np.ndarray) -> None:
    jacobian = np.einsum("qar,eai->eqir", shape_gradients(GAUSS27.points), nodes[elements])
    volume = np.linalg.det(jacobian).min(axis=1)
    if volume.min() <= 0:
        bad = np.flatnonzero(volume <= 0)
        raise InputError(
            f"mesh_from_arrays elements must have a positive volume everywhere, got {len(bad)} inverted or degenerate "
            f"ones, the first is element {bad[0]}; check the node order (Abaqus C3D20) and the mesh quality."
        )
