"""Bush meshes from files: Abaqus input files by a reader of our own, any other format through meshio."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.solid.mesh import BushMesh, Held, mesh_from_arrays
from exudyn_ehd.status import InputError, require_number

_WHERE = "mesh_from_file"
_HEXAHEDRA = ("C3D20", "C3D20R", "C3D20H", "C3D20RH")


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
