"""Film and bush as VTK files through the package meshio, an optional extra: ``pip install exudyn-ehd[vtk]``.

A series is a ``.pvd`` file, which ParaView opens as one animation, next to a folder with a ``.vtu`` file per part and
instant. Everything stands in the joint frame, in SI units.
"""

from __future__ import annotations

import importlib
import pathlib
from collections.abc import Sequence
from types import ModuleType
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from exudyn_ehd.film.arcs import columns_of_arcs
from exudyn_ehd.pictures.records import JointFilm
from exudyn_ehd.status import InputError, require_number
from exudyn_ehd.storage import replacing

if TYPE_CHECKING:
    from exudyn_ehd.solid.stress import StressRecovery


def export_films(
    films: Sequence[JointFilm], path: str | pathlib.Path, *, magnification: float = 1.0
) -> list[pathlib.Path]:
    """Write films, and the bush where there is one.

    The film is a surface of quadrilaterals on the bore, moved by its displacement, with the fields pressure, gap,
    unbroken and, where there are any, fill, temperature and bore displacement. The bush is its mesh, moved
    by the displacement of its nodes, with displacement and von Mises stress.

    Parameters
    ----------
    films : sequence of JointFilm
    path : path
        Ending in ``.pvd``.
    magnification : float
        Factor on the displacements in the drawn positions; fields stay true.

    Returns
    -------
    list of Path
        What was written, the ``.pvd`` first.

    Raises
    ------
    InputError
        Without meshio, or for other endings.
    """
    meshio = _meshio()
    target = pathlib.Path(path)
    if target.suffix != ".pvd":
        raise InputError(
            f"export_vtk: path must end in .pvd, got '{target}'; the .vtu files lie in a folder next to it."
        )
    factor = require_number("export_vtk: magnification", magnification)
    folder = target.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    written, entries = [], []
    recovery: StressRecovery | None = None
    for k, film in enumerate(films):
        parts = [("film", *film_mesh(film, factor))]
        if film.bush_displacement is not None:
            recovery = recovery or _recovery(film.bearing.bush)
            parts.append(("bush", *bush_mesh(film, recovery, factor)))
        for number, (name, points, cells, fields) in enumerate(parts):
            file = folder / f"{name}_{k:05d}.vtu"
            meshio.Mesh(points, cells, point_data=fields).write(file, binary=True)
            written.append(file)
            relative = quoteattr(f"{folder.name}/{file.name}")
            entries.append(f'    <DataSet timestep="{film.time!r}" part="{number}" name="{name}" file={relative}/>\n')
    with replacing(target) as out:
        out.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n')
        out.write("  <Collection>\n")
        out.writelines(entries)
        out.write("  </Collection>\n</VTKFile>\n")
    return [target, *written]


def film_mesh(
    film: JointFilm, magnification: float = 1.0
) -> tuple[np.ndarray, list[tuple[str, np.ndarray]], dict[str, np.ndarray]]:
    """Points (n m, 3), cells and point fields of the film on the bore; a closed ring, or its arcs."""
    n, m = film.pressure.shape
    delta = np.zeros((n, m)) if film.bore_displacement is None else film.bore_displacement
    r = film.bearing.journal_radius + film.bearing.radial_clearance + magnification * delta
    x, y = r * np.cos(film.theta)[:, None], r * np.sin(film.theta)[:, None]
    points = np.stack([x, y, np.broadcast_to(film.z, (n, m))], axis=-1).reshape(-1, 3)
    last = [part.stop - 1 for part in columns_of_arcs(film.theta, film.bearing.bore_arcs)]
    i, j = (index.ravel() for index in np.meshgrid(np.delete(np.arange(n), last), np.arange(m - 1), indexing="ij"))
    following = (i + 1) % n
    # normals point to the axis, towards the journal
    quads = np.stack([i * m + j, i * m + j + 1, following * m + j + 1, following * m + j], axis=1)
    fields = {"pressure [Pa]": film.pressure, "gap [m]": film.gap, "unbroken": film.unbroken.astype(float)}
    optional = {
        "fill": film.fill,
        "temperature [K]": film.temperature,
        "bore displacement [m]": film.bore_displacement,
        "contact pressure [Pa]": film.contact_pressure,
        "wear depth [m]": film.wear_depth,
    }
    fields |= {name: np.broadcast_to(values, (n, m)) for name, values in optional.items() if values is not None}
    return points, [("quad", quads)], {name: np.ravel(values).astype(float) for name, values in fields.items()}


def bush_mesh(
    film: JointFilm, recovery: StressRecovery, magnification: float = 1.0
) -> tuple[np.ndarray, list[tuple[str, np.ndarray]], dict[str, np.ndarray]]:
    """Points (k, 3), cells and point fields of the bush; ``recovery`` is the `StressRecovery` of its mesh."""
    u = film.bush_displacement
    assert u is not None
    # the nodes' order of Abaqus is VTK's, too
    cells = [(recovery.mesh.element.meshio, recovery.mesh.elements)]
    fields = {"displacement [m]": u, "von Mises stress [Pa]": recovery.von_mises_at_nodes(u)}
    return recovery.mesh.nodes + magnification * u, cells, fields


def _recovery(bush: object) -> StressRecovery:
    from exudyn_ehd.solid.bush import ANCFBush, ModalBush
    from exudyn_ehd.solid.stress import StressRecovery

    assert isinstance(bush, ANCFBush | ModalBush)
    return StressRecovery(mesh=bush.build_mesh(), material=bush.material)


def _meshio() -> ModuleType:
    try:
        return importlib.import_module("meshio")
    except ImportError:
        raise InputError(
            "export_vtk needs the package meshio, which is not installed; pip install meshio (or exudyn-ehd[vtk])."
        ) from None
