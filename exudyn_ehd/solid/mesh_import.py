"""Users' meshes of a bush: from arrays, from Exudyn's ``FEMinterface``, and through meshio from files."""

from __future__ import annotations

import pathlib
import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

import numpy as np

from exudyn_ehd.solid.elements.element import ELEMENTS, element_of, face_of
from exudyn_ehd.solid.fe_bore import BodyMesh
from exudyn_ehd.solid.mesh import BushMesh, boundary_faces, patch, require_frame, surface_of
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_number, require_vector


@dataclass(frozen=True, kw_only=True)
class OnCylinder(Checked):
    """``held`` of an imported mesh: its nodes on a cylinder about the bush's axis.

    Parameters
    ----------
    radius : float
        Radius of the cylinder [m].
    tolerance : float, default 0.005
        Largest distance of a node from the cylinder, divided by its radius.

    Examples
    --------
    After the example of `BushMesh`:

    >>> held = ehd.OnCylinder(radius=0.04)
    >>> own = ehd.mesh_from_arrays(bush.nodes, bush.elements, bore_radius=0.03, held=held)
    """

    radius: float
    tolerance: float = 5e-3

    checks: ClassVar = {"radius": POSITIVE, "tolerance": POSITIVE}

    def __call__(self, positions: np.ndarray) -> np.ndarray:
        """Flags (n,) of positions (n, 3) in the bush frame [m]."""
        return np.abs(np.hypot(positions[:, 0], positions[:, 1]) - self.radius) <= self.tolerance * self.radius


@dataclass(frozen=True, kw_only=True)
class OnPlane:
    """``held`` of an imported mesh: its nodes on a plane.

    Parameters
    ----------
    point, normal : three numbers
        A point of the plane [m] and its normal (of any length), bush frame.
    tolerance : float, default 1e-5
        Largest distance of a node from the plane [m].

    Examples
    --------
    After the example of `BushMesh`:

    >>> held = ehd.OnPlane(point=(0, 0, -0.03), normal=(0, 0, 1))
    >>> held.tolerance  # m
    1e-05
    """

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    tolerance: float = 1e-5

    def __post_init__(self) -> None:
        require_vector("OnPlane.point", self.point, 3, "m")
        if not np.any(require_vector("OnPlane.normal", self.normal, 3)):
            raise InputError(f"OnPlane.normal must be a direction, got {self.normal!r}.")
        POSITIVE("OnPlane.tolerance", self.tolerance)

    def __call__(self, positions: np.ndarray) -> np.ndarray:
        """Flags (n,) of positions (n, 3) in the bush frame [m]."""
        # any length: neither its square nor its inverse need be a number
        normal = np.asarray(self.normal) / np.abs(self.normal).max()
        return np.abs((positions - np.asarray(self.point)) @ normal) <= self.tolerance * np.linalg.norm(normal)


HeldNodes: TypeAlias = Sequence[int] | np.ndarray | Callable[[np.ndarray], np.ndarray]
"""Nodes of a user's mesh by number, or flags (n,) of positions (n, 3) in the bush frame."""


def mesh_from_fem(
    fem: BodyMesh,
    *,
    bore_radius: float,
    held: HeldNodes | None = None,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return the bush mesh of a ``FEMinterface`` that holds 20-node hexahedra or 10-node tetrahedra.

    Parameters
    ----------
    fem : FEMinterface
        Exudyn's, with Hex20 elements (Abaqus C3D20 order) or Tet10 elements (C3D10) only.
    bore_radius : float
        Radius of the bore [m], as in `mesh_from_arrays`, where the surfaces of the result are explained.
    held : nodes, `OnCylinder`, `OnPlane`, function or None, default None
        As in `mesh_from_arrays`.
    origin, axis : three numbers, default (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        As in `mesh_from_arrays`.

    Returns
    -------
    BushMesh

    Raises
    ------
    InputError
        For other elements, and as `mesh_from_arrays`.

    Examples
    --------
    After the example of `BushMesh`:

    >>> from exudyn.FEM import FEMinterface
    >>> fem = FEMinterface()
    >>> fem.nodes = {"Position": bush.nodes}
    >>> fem.elements = [{"Name": "bush", "Hex20": bush.elements}]
    >>> ehd.mesh_from_fem(fem, bore_radius=0.03).elements.shape
    (32, 20)
    """
    kinds = sorted({key for block in fem.elements for key in block if key != "Name" and len(block[key])})
    if len(kinds) != 1 or kinds[0] not in [element.fem for element in ELEMENTS]:
        raise InputError(
            f"mesh_from_fem: fem.elements must hold Hex20 or Tet10 elements, of one kind, got {kinds}; mesh the bush "
            "with C3D20 or C3D10 elements and put other parts into a FEMinterface of their own."
        )
    sets = [np.asarray(block[kinds[0]], dtype=int) for block in fem.elements if len(block.get(kinds[0], ()))]
    nodes, elements = fem.nodes["Position"], np.concatenate(sets)
    return mesh_from_arrays(nodes, elements, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


def mesh_from_arrays(
    nodes: np.ndarray,
    elements: np.ndarray,
    *,
    bore_radius: float,
    held: HeldNodes | None = None,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return a bush mesh from a user's own nodes and connectivity; the bore is found by its radius.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [m] in the user's frame.
    elements : ndarray of int, shape (m, 20) or (m, 10)
        Hexahedra in the node order of Abaqus C3D20 or tetrahedra in that of C3D10 (VTK's, not Gmsh's), zero-based.
    bore_radius : float
        Radius [m] of the bore; faces whose corners are within 1 % of it belong to the bore.
    held : nodes, `OnCylinder`, `OnPlane`, function or None, default None
        Where the housing holds the bush: the faces all of whose nodes are selected. Give node numbers, one flag (bool)
        per node, or a function that takes positions (n, 3) in the bush frame [m] and returns flags (n,). By default
        every boundary face that belongs neither to the bore nor to the ends.
    origin, axis : three numbers, default (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        Point where the bush's axis crosses the bearing's mid-plane [m], and direction of the axis, both in the user's
        frame. The result is in the bush frame: this origin, z = axis; with the default axis x and y are the user's.

    Returns
    -------
    BushMesh
        Outer surface: the faces that are held; ends: the boundary faces normal to the axis at the smallest and the
        largest z. Unused nodes are dropped.

    Warns
    -----
    UserWarning
        If held faces reach the bore (a chamfer, a groove, an oil hole), so that the bore's edge is clamped; or if faces
        stay free because only their corner nodes are selected.

    Raises
    ------
    InputError
        No bore at this radius, no held face, inverted elements, or array shapes that don't fit.

    Examples
    --------
    After the example of `BushMesh`:

    >>> own = ehd.mesh_from_arrays(bush.nodes, bush.elements, bore_radius=0.03, held=ehd.OnCylinder(radius=0.04))
    >>> own.outer.nodes.size == bush.outer.nodes.size
    True
    """
    radius = require_number("mesh_from_arrays.bore_radius", bore_radius, "m", above=0.0)
    try:
        nodes, elements = np.asarray(nodes, dtype=float), np.asarray(elements, dtype=int)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"mesh_from_arrays: nodes and elements must be arrays of numbers, all elements of one kind: {error}."
        ) from None
    if nodes.ndim != 2 or nodes.shape[1] != 3 or elements.ndim != 2 or elements.shape[1] not in (20, 10):
        raise InputError(
            f"mesh_from_arrays: nodes and elements must have shapes (n, 3) and (m, 20) or (m, 10), got {nodes.shape} "
            f"and {elements.shape}; only 20-node hexahedra and 10-node tetrahedra are supported, one kind in a mesh."
        )
    centre = require_vector("mesh_from_arrays.origin", origin, 3, "m")
    nodes = (nodes - centre) @ require_frame("mesh_from_arrays.axis", axis)
    for number in (elements.min(initial=len(nodes)), elements.max(initial=-1)):
        counts = "subtract 1 from numbers that count from 1, as Abaqus does."
        require_number("mesh_from_arrays.elements", number, at_least=0, at_most=len(nodes) - 1, hint=counts)
    used, own = np.unique(elements, return_inverse=True)
    nodes, elements = nodes[used], own.reshape(elements.shape)
    _check_volume(nodes, elements)
    boundary = boundary_faces(elements)
    r, z = np.hypot(nodes[:, 0], nodes[:, 1]), nodes[:, 2]
    flat = 1e-4 * np.ptp(z)
    low, high = z < z.min() + flat, z > z.max() - flat
    # edges may be straight: the nodes on them then lie off the cylinder
    bore = patch(nodes, boundary[(np.abs(r - radius) < 0.01 * radius)[_corners(boundary)].all(axis=1)])
    if len(bore.nodes) == 0:
        raise InputError(
            f"mesh_from_arrays.bore_radius must be the radius of the bore in m, got {radius:g}; no boundary face lies "
            f"there: the nodes have radii {r.min():g} to {r.max():g} m. Check units, origin and axis."
        )
    outer = _held_faces(nodes, boundary, used, held, (low, high, np.isin(np.arange(len(r)), bore.nodes)))
    if reaching := np.intersect1d(outer, bore.nodes).size:
        warnings.warn(
            f"mesh_from_arrays: {reaching} nodes of the bore belong to held faces (a chamfer, a groove or a hole) and "
            "are clamped; name the held faces, e.g. held=OnCylinder(radius=...) for the outer cylinder alone.",
            stacklevel=2,
        )
    return BushMesh(
        nodes=nodes,
        elements=elements,
        bore=bore,
        outer=patch(nodes, outer),
        end_low=surface_of(nodes, boundary, low),
        end_high=surface_of(nodes, boundary, high),
    )


def _held_faces(
    nodes: np.ndarray, boundary: np.ndarray, used: np.ndarray, held: HeldNodes | None, elsewhere: tuple[np.ndarray, ...]
) -> np.ndarray:
    """Faces (f, a) that the housing holds; ``used`` are the user's numbers of the nodes, ``elsewhere`` flags (n,) of
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
            f"mesh_from_arrays.held: the function must give one bool for each of {len(nodes)} nodes, got an array of "
            f"shape {member.shape} and type {member.dtype}."
        )
    inside = member[boundary].all(axis=1)
    faces = boundary[inside & ~whole[-1]]
    if left := np.count_nonzero(member[_corners(boundary)].all(axis=1) & ~np.any([inside, *whole], axis=0)):
        warnings.warn(
            f"mesh_from_arrays.held: {left} faces have their corners, but not all of their nodes among the held ones, "
            "and are left free; raise the tolerance (nodes on straight edges lie off a cylinder), or name all nodes.",
            stacklevel=3,
        )
    if len(faces) == 0:
        r = np.hypot(nodes[:, 0], nodes[:, 1])
        raise InputError(
            f"mesh_from_arrays.held: {int(member.sum())} nodes are chosen, and no boundary face besides the bore has "
            f"all of its nodes among them; the nodes have radii {r.min():g} to {r.max():g} m and z from "
            f"{nodes[:, 2].min():g} to {nodes[:, 2].max():g} m in the bush frame. Check units, radius and tolerance."
        )
    return faces


def _corners(faces: np.ndarray) -> np.ndarray:
    """Corners (f, c) of faces (f, a)."""
    return faces[:, : face_of(faces).corners]


def _check_volume(nodes: np.ndarray, elements: np.ndarray) -> None:
    element = element_of(elements)
    jacobian = np.einsum("qar,eai->eqir", element.shapes(element.exact.points)[1], nodes[elements])
    volume = np.linalg.det(jacobian).min(axis=1)
    if volume.min() <= 0:
        bad = np.flatnonzero(volume <= 0)
        raise InputError(
            f"mesh_from_arrays.elements must have a positive volume everywhere, got {len(bad)} inverted or degenerate "
            f"ones, the first is element {bad[0]}; check the node order (Abaqus {element.abaqus}) and the mesh's "
            "quality."
        )


_WHERE = "mesh_from_file"
# First letters of the names of solid elements in meshio.
_SOLIDS = ("tetra", "hexahedron", "wedge", "pyramid", "VTK_LAGRANGE")
# Parts of an Abaqus input file that meshio passes over: what moves or makes nodes and elements, names in node sets.
_PASSED_OVER = re.compile(
    r"^\*(?:(?:include|system|ngen|nfill|ncopy|nmap|elgen|elcopy)\b|node\b.*(?:system|input) *="
    r"|instance\b.*\n *[-+.\d]|nset\b.*\n(?:[-+\d ,]*\n)*? *[a-z_])",
    re.IGNORECASE | re.MULTILINE,
)


def mesh_from_file(
    path: str | pathlib.Path,
    *,
    bore_radius: float,
    held: str | HeldNodes | None = None,
    instance: str | None = None,
    scale: float = 1.0,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return the bush mesh in a file whose elements are all 20-node hexahedra or all 10-node tetrahedra.

    Parameters
    ----------
    path : path
        File of any format with these elements that meshio reads (``pip install 'exudyn-ehd[mesh]'``), such as vtu, msh,
        or an Abaqus input file (``.inp``) of one body. Elements on surfaces and lines are ignored.
    held : str, or as in `mesh_from_arrays`, or None, default None
        Where the housing holds the bush. A string names a node set of the file.
    instance : None, default None
        Not supported any more: save the bush as a file of its own.
    scale : float, default 1.0
        Metres per unit of the file: 1e-3 for millimetres.
    bore_radius : float
        Radius of the bore in metres, after scaling, as in `mesh_from_arrays`, where the surfaces of the result are
        explained.
    origin, axis : three numbers, default (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        As in `mesh_from_arrays`, in metres after scaling, in the frame of the file.

    Returns
    -------
    BushMesh

    Raises
    ------
    InputError
        No such file or set, several bodies, other or mixed elements, and as `mesh_from_arrays`.

    Examples
    --------
    After the example of `BushMesh`:

    >>> rows = ["*Node", *(", ".join(map(str, [k, *x])) for k, x in enumerate(bush.nodes.tolist(), 1))]
    >>> rows += ["*Element, type=C3D20", *(", ".join(map(str, [k, *(e + 1)])) for k, e in enumerate(bush.elements, 1))]
    >>> with open("bush.inp", "w") as file:
    ...     print(*rows, sep=chr(10), file=file)
    >>> ehd.mesh_from_file("bush.inp", bore_radius=0.03).elements.shape
    (32, 20)
    """
    path = pathlib.Path(path)
    if not path.is_file():
        raise InputError(f"{_WHERE}.path: there is no file {str(path)!r}.")
    scale = require_number(f"{_WHERE}.scale", scale, "m", above=0.0)
    if instance is not None:
        raise InputError(
            f"{_WHERE}.instance is not supported any more, got {instance!r}; save the bush alone, or give "
            "mesh_from_fem(fem, ...) the first part of an Abaqus file, read by fem.ImportFromAbaqusInputFile(path)."
        )
    nodes, elements, sets = _read(path)
    if isinstance(held, str):
        if (named := {name.lower(): own for name, own in sets.items()}.get(held.lower())) is None:
            raise InputError(
                f"{_WHERE}.held: {path.name} has no node set {held!r}, it has {sorted(sets) or 'none'}; name one "
                "of these, or give nodes, OnCylinder(...), OnPlane(...) or a function of the positions."
            )
        held = named
    return mesh_from_arrays(scale * nodes, elements, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


def _read(path: pathlib.Path) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Positions (n, 3) in the file's unit, elements (m, 20) or (m, 10), and nodes by the names of node sets."""
    try:
        import meshio
    except ImportError:
        raise InputError(
            f"{_WHERE}: meshio reads {path.suffix or 'such'} files and is not installed; pip install "
            "'exudyn-ehd[mesh]'."
        ) from None
    text = path.read_text(errors="replace") if path.suffix.lower() == ".inp" else ""
    other, blocks = _PASSED_OVER.search(text), len(re.findall(r"(?im)^\*node\b(?! *(?:output|print|file))", text))
    if other or blocks > 1:
        raise InputError(
            f"{_WHERE}: meshio reads one body from an Abaqus file, with all nodes in one *Node block and node sets of "
            f"numbers; {path.name} has {blocks} such blocks{f' and {other[0]!r}' if other else ''}; save the bush "
            "alone, nodes and elements written out, or give mesh_from_fem(fem, ...) the first part of the file, read "
            "by fem.ImportFromAbaqusInputFile(path)."
        )
    try:
        data = meshio.read(path)
    except (Exception, SystemExit) as error:
        raise InputError(f"{_WHERE}: meshio can't read {path.name}: {error!r}.") from None
    types = {block.type for block in data.cells}
    solid = {name for name in types if name.startswith(_SOLIDS)}
    if len(solid) != 1 or not solid <= {element.meshio for element in ELEMENTS}:
        known = " or ".join(f"{element.name} ({element.abaqus}, {element.meshio})" for element in ELEMENTS)
        got = sorted(solid or types) or "none"
        raise InputError(f"{_WHERE}: {path.name} must hold {known}, of one kind, got {got}; mesh the bush with them.")
    elements = np.concatenate([block.data for block in data.cells if block.type in solid])
    sets = {name: np.asarray(nodes, dtype=int) for name, nodes in data.point_sets.items()}
    return np.asarray(data.points, dtype=float), elements, sets
