"""Users' meshes of a bush: from arrays, from Exudyn's ``FEMinterface``, and from files.

Abaqus input files are read here, any other format through meshio.
"""

from __future__ import annotations

import pathlib
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np

from exudyn_ehd.solid.hex20 import GAUSS27, boundary_faces, shape_gradients
from exudyn_ehd.solid.mesh import BushMesh, frame_of, patch, surface_of
from exudyn_ehd.status import InputError, require_number, require_numbers, require_vector

_WHERE = "mesh_from_file"
_HEXAHEDRA = ("C3D20", "C3D20R", "C3D20H", "C3D20RH")


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
        if not np.any(require_vector("OnPlane.normal", self.normal, 3)):
            raise InputError(f"OnPlane.normal must be a direction, got {self.normal!r}.")
        require_numbers(self, above=0.0, tolerance="m")

    def __call__(self, positions: np.ndarray) -> np.ndarray:
        """Flags (n,) of positions (n, 3) in the bush frame [m]."""
        # any length: neither its square nor its inverse need be a number
        normal = np.asarray(self.normal) / np.abs(self.normal).max()
        return np.abs((positions - np.asarray(self.point)) @ normal) <= self.tolerance * np.linalg.norm(normal)


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
    nodes, elements = fem.nodes["Position"], np.concatenate(sets)
    return mesh_from_arrays(nodes, elements, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


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
    bore = surface_of(nodes, boundary, np.abs(r - radius) < 0.01 * radius)
    if len(bore.nodes) == 0:
        raise InputError(
            f"mesh_from_arrays bore_radius must be the radius of the bore in m, got {radius:g}; no boundary face lies "
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


def _check_volume(nodes: np.ndarray, elements: np.ndarray) -> None:
    jacobian = np.einsum("qar,eai->eqir", shape_gradients(GAUSS27.points), nodes[elements])
    volume = np.linalg.det(jacobian).min(axis=1)
    if volume.min() <= 0:
        bad = np.flatnonzero(volume <= 0)
        raise InputError(
            f"mesh_from_arrays elements must have a positive volume everywhere, got {len(bad)} inverted or degenerate "
            f"ones, the first is element {bad[0]}; check the node order (Abaqus C3D20) and the mesh quality."
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class FileMesh:
    """What a file holds.

    Attributes
    ----------
    nodes : ndarray (n, 3)
        In the file's unit.
    elements : ndarray of int (m, 20)
        20-node hexahedra, rows of ``nodes``.
    sets : dict
        Rows of ``nodes`` by the names of node sets.
    """

    nodes: np.ndarray
    elements: np.ndarray
    sets: dict[str, np.ndarray]


def mesh_from_file(
    path: str | pathlib.Path,
    *,
    bore_radius: float,
    held: str | Held | None = None,
    scale: float = 1.0,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return the bush mesh of a file with 20-node hexahedra.

    Parameters
    ----------
    path : path
        An Abaqus input file (``.inp``: ``*Node``, ``*Element`` of type C3D20 or C3D20R, ``*Nset``; one part, without
        transformed instances), or any format with quadratic hexahedra that meshio reads
        (``pip install 'exudyn-ehd[mesh]'``).
    held : str, or as in `mesh_from_arrays`
        A string names a node set of the file.
    scale : float
        Metres per unit of the file: 1e-3 for millimetres.
    bore_radius, origin, axis
        As in `mesh_from_arrays`, in metres after scaling; it also says what comes back.

    Raises
    ------
    InputError
        No such file or set, elements of other types, or what `mesh_from_arrays` refuses.
    """
    path = pathlib.Path(path)
    if not path.is_file():
        raise InputError(f"{_WHERE}.path: there is no file {str(path)!r}.")
    scale = require_number(f"{_WHERE}.scale", scale, "m", above=0.0)
    mesh = read_abaqus(path) if path.suffix.lower() == ".inp" else _read_with_meshio(path)
    if isinstance(held, str):
        # Abaqus does not tell upper from lower case
        known = {name.lower(): nodes for name, nodes in mesh.sets.items()}
        if held.lower() not in known:
            raise InputError(
                f"{_WHERE}.held: {path.name} has no node set {held!r}, it has {sorted(mesh.sets) or 'none'}; name one "
                "of these, or give nodes, OnCylinder(...), OnPlane(...) or a function of the positions."
            )
        held = known[held.lower()]
    return mesh_from_arrays(
        scale * mesh.nodes, mesh.elements, bore_radius=bore_radius, held=held, origin=origin, axis=axis
    )


def read_abaqus(path: pathlib.Path) -> FileMesh:
    """Nodes, 20-node hexahedra and node sets of an Abaqus input file; other keywords are passed over."""
    nodes: dict[int, list[float]] = {}
    elements: list[list[int]] = []
    sets: dict[str, list[int]] = {}
    others = set()
    for keyword, options, lines in _blocks(path):
        if keyword == "NODE":
            for row in lines:
                nodes[int(row[0])] = [float(x) for x in row[1:4]]
                if "NSET" in options:
                    sets.setdefault(options["NSET"], []).append(int(row[0]))
        elif keyword == "ELEMENT" and options.get("TYPE", "").upper() in _HEXAHEDRA:
            numbers = [int(x) for row in lines for x in row]
            if len(numbers) % 21:
                raise InputError(
                    f"{_WHERE}: an *Element block of {path.name} has no 20 nodes for each of its elements."
                )
            elements += [numbers[i + 1 : i + 21] for i in range(0, len(numbers), 21)]
        elif keyword == "ELEMENT":
            others.add(options.get("TYPE", "?").upper())
        elif keyword == "NSET":
            chosen = sets.setdefault(options.get("NSET", ""), [])
            for row in lines:
                if "GENERATE" in options:
                    first, last, step = (*map(int, row), 1)[:3]
                    chosen += range(first, last + 1, step)
                else:
                    for name in row:
                        # sets may hold other sets by name
                        chosen += [int(name)] if name.lstrip("+-").isdigit() else sets.get(name, [])
    if not elements:
        raise InputError(_no_hexahedra(path, others))
    row_of = {number: row for row, number in enumerate(nodes)}
    missing = {number for element in elements for number in element} - row_of.keys()
    if missing:
        raise InputError(f"{_WHERE}: elements of {path.name} use node {min(missing)}, which the file does not define.")
    return FileMesh(
        nodes=np.array(list(nodes.values())),
        elements=np.array([[row_of[number] for number in element] for element in elements]),
        sets={name: np.array([row_of[n] for n in own if n in row_of], dtype=int) for name, own in sets.items()},
    )


def _blocks(path: pathlib.Path) -> Iterator[tuple[str, dict[str, str], list[list[str]]]]:
    """Keyword, options and data rows of every block of an Abaqus input file; options' names in capitals."""
    head, rows = "", []
    for line in [*path.read_text(errors="replace").splitlines(), "*END"]:
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if head.endswith(","):
            # options go on
            head += line
            continue
        if not line.startswith("*"):
            rows.append([field.strip() for field in line.split(",") if field.strip()])
            continue
        if head:
            first, *rest = (part.strip() for part in head[1:].split(","))
            pairs = (part.partition("=") for part in rest)
            yield first.upper(), {name.strip().upper(): value.strip() for name, _, value in pairs}, rows
        head, rows = line, []


def _read_with_meshio(path: pathlib.Path) -> FileMesh:
    try:
        import meshio
    except ImportError:
        raise InputError(
            f"{_WHERE}: meshio reads {path.suffix or 'such'} files and is not installed; pip install "
            "'exudyn-ehd[mesh]', or give an Abaqus input file (.inp)."
        ) from None
    try:
        data = meshio.read(path)
    except (Exception, SystemExit) as error:
        raise InputError(f"{_WHERE}: meshio can't read {path.name}: {error}.") from None
    blocks = [block.data for block in data.cells if block.type == "hexahedron20"]
    if not blocks:
        raise InputError(_no_hexahedra(path, {block.type for block in data.cells}))
    sets = {name: np.asarray(nodes, dtype=int) for name, nodes in data.point_sets.items()}
    return FileMesh(nodes=np.asarray(data.points, dtype=float), elements=np.concatenate(blocks), sets=sets)


def _no_hexahedra(path: pathlib.Path, others: set[str]) -> str:
    return (
        f"{_WHERE}: {path.name} must hold 20-node hexahedra (C3D20, hexahedron20), got {sorted(others) or 'none'}; "
        "mesh the bush with them. Tetrahedra serve for reduced bodies, bush=FEBore(fem=...)."
    )
