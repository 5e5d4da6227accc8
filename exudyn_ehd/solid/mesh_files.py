"""Users' meshes of a bush from files: Abaqus input files, and through meshio any other format.

Of Abaqus input files are read parts and their instances, nodes, quadratic elements and node sets. Keywords that say
nothing about a mesh are passed over; those that would change it and are not read are refused.
"""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_ehd.solid.elements.kinds import ELEMENTS
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.mesh_import import HeldNodes, bush_mesh
from exudyn_ehd.status import InputError, require_number

# They would move nodes or add nodes and elements.
_UNREAD = ("INCLUDE", "SYSTEM", "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY")
_TYPES = {name: element for element in ELEMENTS for name in element.abaqus}
_WHERE = "mesh_from_file"
T = TypeVar("T")
# First letters of the names of solid elements in meshio.
_SOLIDS = ("tetra", "hexahedron", "wedge", "pyramid", "VTK_LAGRANGE")


@dataclass(frozen=True, kw_only=True, eq=False)
class FileMesh:
    """Mesh of one body in a file.

    Attributes
    ----------
    nodes : ndarray (n, 3)
        Positions in the file's unit; those of an instance in the assembly's frame.
    elements : ndarray of int (m, 20) or (m, 10)
        Rows of ``nodes``.
    numbers : ndarray of int (m,)
        Numbers of the elements in the file.
    sets : dict
        Rows of ``nodes`` by the names of node sets.
    """

    nodes: np.ndarray
    elements: np.ndarray
    numbers: np.ndarray
    sets: dict[str, np.ndarray]


@dataclass(eq=False)
class _Body:
    """A part or an instance: positions by node number, elements by type, node sets; types of other elements."""

    nodes: dict[int, list[float]] = field(default_factory=dict)
    elements: dict[str, list[list[int]]] = field(default_factory=dict)
    sets: dict[str, list[int]] = field(default_factory=dict)
    assembly_sets: dict[str, list[int]] = field(default_factory=dict)
    others: set[str] = field(default_factory=set)
    translation: list[float] = field(default_factory=list)
    rotation: list[float] = field(default_factory=list)

    def positions(self) -> np.ndarray:
        """Positions (n, 3), translated and then turned by an angle in degrees about the line through two points."""
        x = np.array(list(self.nodes.values()))
        if self.translation:
            x = x + self.translation
        if self.rotation:
            a, b, angle = np.array(self.rotation[:3]), np.array(self.rotation[3:6]), self.rotation[6]
            turn = np.radians(angle) * (b - a) / np.linalg.norm(b - a)
            x = Rotation.from_rotvec(turn).apply(x - a) + a
        return x


def read_abaqus(where: str, path: pathlib.Path, instance: str | None = None) -> FileMesh:
    """Read one body.

    Parameters
    ----------
    where : str
        For messages.
    path : path
    instance : str, optional
        Name of the instance, if there are several.

    Raises
    ------
    InputError
        What `exudyn_ehd.mesh_from_file` refuses.
    """
    try:
        bodies = _Reader(where, path).bodies()
    except (ValueError, IndexError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{where}: a data line of {path.name} can't be read: {error}.") from None
    solid = {name: body for name, body in bodies.items() if body.elements}
    if instance is not None:
        if (named := _by_name(bodies, instance)) is None:
            known = sorted(name for name in bodies if name)
            raise InputError(f"{where}.instance: {path.name} has no {instance!r}, it has {known or 'none'}.")
        solid = {instance: named}
    if len(solid) > 1:
        raise InputError(
            f"{where}: {path.name} has {len(solid)} bodies with solid elements, {sorted(solid)}; name the bush, e.g. "
            f"instance={min(solid)!r}."
        )
    types = {kind for body in solid.values() for kind in body.elements}
    if len({_TYPES.get(kind) for kind in types}) != 1 or not types <= _TYPES.keys():
        others = {kind for body in bodies.values() for kind in body.others}
        raise InputError(wrong_elements(where, path, types or others))
    (body,) = solid.values()
    return _mesh(where, path, body)


def wrong_elements(where: str, path: pathlib.Path, got: set[str]) -> str:
    """Message on a file that holds other elements, or mixed ones."""
    known = " or ".join(f"{element.name} ({element.abaqus[0]}, {element.meshio})" for element in ELEMENTS)
    return f"{where}: {path.name} must hold {known}, of one kind, got {sorted(got) or 'none'}; mesh the bush with them."


def _mesh(where: str, path: pathlib.Path, body: _Body) -> FileMesh:
    rows = np.array([row for block in body.elements.values() for row in block])
    numbers, row_of = np.array(list(body.nodes), dtype=int), {number: row for row, number in enumerate(body.nodes)}
    if missing := set(rows[:, 1:].ravel().tolist()) - row_of.keys():
        raise InputError(f"{where}: elements of {path.name} use node {min(missing)}, which the file does not define.")
    order = np.argsort(numbers)
    elements = order[np.searchsorted(numbers, rows[:, 1:], sorter=order)]
    sets = {name: np.array([row_of[n] for n in own if n in row_of], dtype=int) for name, own in body.sets.items()}
    return FileMesh(nodes=body.positions(), elements=elements, numbers=rows[:, 0], sets=sets)


class _Reader:
    """Goes through the blocks of a file; parts and instances by their names, the root's own body without one."""

    def __init__(self, where: str, path: pathlib.Path) -> None:
        self.where, self.path = where, path
        self.root = self.scope = _Body()
        self.parts: dict[str, _Body] = {}
        self.instances: dict[str, _Body] = {}
        for keyword, options, rows in _blocks(path):
            elsewhere = keyword in ("NODE", "ELEMENT", "NSET") and "INPUT" in options
            if keyword in _UNREAD or elsewhere or (keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R"):
                raise InputError(
                    f"{where}: {path.name} has *{keyword.capitalize()} with data that are not read "
                    f"({', '.join(_UNREAD)}, INPUT=, SYSTEM=); write the nodes and elements out, in Cartesian "
                    "coordinates, into one file."
                )
            if keyword == "PART":
                self.scope = self.parts[options.get("NAME", "")] = _Body()
            elif keyword == "INSTANCE":
                self.scope = self.instances[options.get("NAME", "")] = self._instance(options, rows)
            elif keyword in ("END PART", "END INSTANCE"):
                self.scope = self.root
            elif keyword == "NODE":
                self._add_nodes(options, rows)
            elif keyword == "ELEMENT":
                self._add_elements(options.get("TYPE", "?").upper(), rows)
            elif keyword == "NSET" and "ELSET" not in options:
                self._add_set(options, rows)

    def bodies(self) -> dict[str, _Body]:
        """Instances, without them parts, without these the root."""
        for name, body in self.instances.items():
            own = {f"{name}.{key}": nodes for key, nodes in body.sets.items()}
            body.sets = {**body.sets, **own, **body.assembly_sets}
        found = self.instances or self.parts
        return {**found, "": self.root} if self.root.elements or not found else found

    def _instance(self, options: dict[str, str], rows: list[list[str]]) -> _Body:
        part, numbers = _by_name(self.parts, options.get("PART", "")), [[_number(x) for x in row] for row in rows]
        if part is None:
            raise InputError(
                f"{self.where}: the instance {options.get('NAME', '')!r} of {self.path.name} must have a PART of this "
                f"file, got {options.get('PART')!r}; the parts are {sorted(self.parts) or 'none'}."
            )
        if [len(row) for row in numbers] not in ([], [3], [3, 7]):
            raise InputError(
                f"{self.where}: the instance {options.get('NAME', '')!r} of {self.path.name} must have a line of three "
                "numbers, its translation (zeros for none), and then one of seven, two points of an axis and degrees."
            )
        return _Body(
            nodes=dict(part.nodes),
            elements={kind: list(block) for kind, block in part.elements.items()},
            sets={key: list(own) for key, own in part.sets.items()},
            others=set(part.others),
            translation=numbers[0] if numbers else [],
            rotation=numbers[1] if len(numbers) > 1 else [],
        )

    def _add_nodes(self, options: dict[str, str], rows: list[list[str]]) -> None:
        for number, *place in rows:
            self.scope.nodes[int(number)] = [*(_number(x) for x in place[:3]), 0.0, 0.0, 0.0][:3]
            if "NSET" in options:
                self.scope.sets.setdefault(options["NSET"], []).append(int(number))

    def _add_elements(self, kind: str, rows: list[list[str]]) -> None:
        if "C3D" not in kind and not kind.startswith(("COH", "CSS", "SC")):
            self.scope.others.add(kind)
            return
        block = self.scope.elements.setdefault(kind, [])
        if kind not in _TYPES:
            return
        numbers, size = [int(x) for row in rows for x in row if x], _TYPES[kind].size
        if len(numbers) % (size + 1):
            raise InputError(
                f"{self.where}: an *Element block of {self.path.name} has no {size} nodes for each of its elements."
            )
        block += [numbers[i : i + size + 1] for i in range(0, len(numbers), size + 1)]

    def _add_set(self, options: dict[str, str], rows: list[list[str]]) -> None:
        name = options.get("NSET", "")
        body = self._named(options["INSTANCE"]) if "INSTANCE" in options else self.scope
        sets = body.sets if body is self.scope else body.assembly_sets
        chosen = sets.setdefault(name, [])
        for row in rows:
            if "GENERATE" in options:
                first, last, step = (*map(int, filter(None, row)), 1)[:3]
                chosen += range(first, last + 1, step)
                continue
            for member in filter(None, row):
                owner, _, rest = member.rpartition(".")
                if owner:
                    # of an instance, seen from the assembly
                    other = self._named(owner)
                    other.assembly_sets.setdefault(name, []).extend(self._members(rest, (other.sets,)))
                else:
                    chosen += self._members(member, (sets, body.sets))

    def _members(self, member: str, places: tuple[dict[str, list[int]], ...]) -> list[int]:
        """Node numbers of a row's entry: a number, or another set by name."""
        if member.lstrip("+-").isdigit():
            return [int(member)]
        for sets in places:
            if (nodes := _by_name(sets, member)) is not None:
                return nodes
        raise InputError(
            f"{self.where}: a node set of {self.path.name} names {member!r}, which is not defined before it."
        )

    def _named(self, instance: str) -> _Body:
        if (body := _by_name(self.instances, instance)) is None:
            raise InputError(
                f"{self.where}: {self.path.name} has a node set of {instance!r}, which is no instance of it."
            )
        return body


def _by_name(known: Mapping[str, T], name: str) -> T | None:
    """Return what has a name, or None: Abaqus does not tell upper from lower case."""
    return {key.lower(): value for key, value in known.items()}.get(name.lower())


def _number(text: str) -> float:
    """A coordinate; blank is zero, D an exponent of Fortran's."""
    return float(text.upper().replace("D", "E")) if text else 0.0


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
            # a comma at the end opens no further entry
            rows.append([entry.strip() for entry in line.rstrip(", ").split(",")])
            continue
        if head:
            first, *rest = (part.strip() for part in head[1:].split(","))
            pairs = (part.partition("=") for part in rest)
            yield first.upper(), {name.strip().upper(): value.strip().strip('"') for name, _, value in pairs}, rows
        head, rows = line, []


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
        An Abaqus input file (``.inp``: ``*Node``, ``*Element`` of a type C3D20 or C3D10, ``*Nset``, ``*Part``,
        ``*Instance`` with its translation and rotation), or any format with these elements that meshio reads
        (``pip install 'exudyn-ehd[mesh]'``). Elements on surfaces and lines are ignored.
    held : str, or as in `mesh_from_arrays`, or None, default None
        Where the housing holds the bush. A string names a node set of the file; where assembly and part both have a set
        of this name, ``"instance.set"`` is the part's.
    instance : str or None, default None
        Which instance of an Abaqus assembly (without instances: which part) is the bush, if several have solid
        elements.
    scale : float, default 1.0
        Metres per unit of the file: 1e-3 for millimetres.
    bore_radius : float
        Radius of the bore in metres, after scaling, as in `mesh_from_arrays`, where the surfaces of the result are
        explained.
    origin, axis : three numbers, default (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        As in `mesh_from_arrays`, in metres after scaling, in the frame of the assembly.

    Returns
    -------
    BushMesh

    Raises
    ------
    InputError
        No such file, set or instance, several instances, other or mixed elements, and as `mesh_from_arrays`.

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
    if path.suffix.lower() == ".inp":
        mesh = read_abaqus(_WHERE, path, instance)
    elif instance is not None:
        raise InputError(f"{_WHERE}.instance is for Abaqus input files (.inp), got {instance!r} for {path.name}.")
    else:
        mesh = _read_with_meshio(path)
    if isinstance(held, str):
        if (nodes := _by_name(mesh.sets, held)) is None:
            raise InputError(
                f"{_WHERE}.held: {path.name} has no node set {held!r}, it has {sorted(mesh.sets) or 'none'}; name one "
                "of these, or give nodes, OnCylinder(...), OnPlane(...) or a function of the positions."
            )
        held = nodes
    places = scale * mesh.nodes
    return bush_mesh(places, mesh.elements, mesh.numbers, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


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
    types = {block.type for block in data.cells}
    solid = {name for name in types if name.startswith(_SOLIDS)}
    if len(solid) != 1 or not solid <= {element.meshio for element in ELEMENTS}:
        raise InputError(wrong_elements(_WHERE, path, solid or types))
    elements = np.concatenate([block.data for block in data.cells if block.type in solid])
    sets = {name: np.asarray(nodes, dtype=int) for name, nodes in data.point_sets.items()}
    nodes = np.asarray(data.points, dtype=float)
    return FileMesh(nodes=nodes, elements=elements, numbers=np.arange(len(elements)), sets=sets)
