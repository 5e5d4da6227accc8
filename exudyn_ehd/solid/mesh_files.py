"""Users' meshes of a bush from files: Abaqus input files, and through meshio any other format."""

from __future__ import annotations

import pathlib

import numpy as np

from exudyn_ehd.solid.abaqus_input import FileMesh, read_abaqus, wrong_elements
from exudyn_ehd.solid.elements.kinds import ELEMENTS
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.solid.mesh_import import Held, bush_mesh
from exudyn_ehd.status import InputError, require_number

_WHERE = "mesh_from_file"
# How the names of solid elements start in meshio.
_SOLIDS = ("tetra", "hexahedron", "wedge", "pyramid", "VTK_LAGRANGE")


def mesh_from_file(
    path: str | pathlib.Path,
    *,
    bore_radius: float,
    held: str | Held | None = None,
    instance: str | None = None,
    scale: float = 1.0,
    origin: tuple = (0.0, 0.0, 0.0),
    axis: tuple = (0.0, 0.0, 1.0),
) -> BushMesh:
    """Return the bush mesh of a file with 20-node hexahedra or 10-node tetrahedra, of one kind.

    Parameters
    ----------
    path : path
        An Abaqus input file (``.inp``: ``*Node``, ``*Element`` of a type C3D20 or C3D10, ``*Nset``, ``*Part``,
        ``*Instance`` with its translation and rotation), or any format with these elements that meshio reads
        (``pip install 'exudyn-ehd[mesh]'``). Elements on surfaces and lines are passed over.
    held : str, or as in `mesh_from_arrays`
        A string names a node set of the file; ``"instance.set"`` one of an instance's part where the assembly has a set
        of that name, too.
    instance : str, optional
        Which instance of an Abaqus assembly (without instances: which part) is the bush, if several have solid
        elements.
    scale : float
        Metres per unit of the file: 1e-3 for millimetres.
    bore_radius, origin, axis
        As in `mesh_from_arrays`, in metres after scaling, in the frame of the assembly; it also says what comes back.

    Returns
    -------
    BushMesh

    Raises
    ------
    InputError
        No such file, set or instance, several instances, other or mixed elements, or what `mesh_from_arrays` refuses.

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
        # Abaqus does not tell upper from lower case
        known = {name.lower(): nodes for name, nodes in mesh.sets.items()}
        if held.lower() not in known:
            raise InputError(
                f"{_WHERE}.held: {path.name} has no node set {held!r}, it has {sorted(mesh.sets) or 'none'}; name one "
                "of these, or give nodes, OnCylinder(...), OnPlane(...) or a function of the positions."
            )
        held = known[held.lower()]
    nodes = scale * mesh.nodes
    return bush_mesh(nodes, mesh.elements, mesh.numbers, bore_radius=bore_radius, held=held, origin=origin, axis=axis)


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
