"""Films of a run as files: orbit and pressure as gif or mp4; film and bush as VTK.

VTK files take the package meshio, an optional extra: ``pip install exudyn-ehd[vtk]``.

A series is a ``.pvd`` file, which ParaView opens as one animation, next to a folder with a ``.vtu`` file per part and
instant. Everything stands in the joint frame, in SI units.
"""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np
from matplotlib import animation
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from exudyn_ehd.film.arcs import columns_of_arcs
from exudyn_ehd.pictures.maps import (
    PRESSURE,
    colour_limits,
    cylinder_points,
    draw_map,
    draw_rupture,
    field_values,
    on_picture,
)
from exudyn_ehd.pictures.records import HistoryRecord, JointFilm, label, unit_for
from exudyn_ehd.pictures.style import BLUE, PAGE, VERMILION, WIDE, draw_clearance, style_ticks, styled
from exudyn_ehd.status import InputError, require_integer, require_number
from exudyn_ehd.storage import replacing

if TYPE_CHECKING:
    from exudyn_ehd.solid.total_lagrange import StressRecovery


class Frames:
    """The picture of an animation, brought to one instant after the other.

    Parameters
    ----------
    films : sequence of JointFilm
    history : HistoryRecord
    """

    def __init__(self, films: Sequence[JointFilm], history: HistoryRecord) -> None:
        self.films, self.history = films, history
        extremes = np.array([(film.pressure.min(), film.pressure.max()) for film in films])
        self.unit = unit_for("pressure", extremes)
        self.length = unit_for("length", history.radial_clearance)
        self.time = unit_for("time", history.time)
        limits = colour_limits(self.unit(extremes))
        with styled():
            self.figure = Figure(figsize=(PAGE, WIDE[1]), layout="constrained")
            self.left, self.right = self.figure.subplots(1, 2, width_ratios=(1.0, 1.75))
            radius = float(self.length(history.radial_clearance))
            draw_clearance(self.left, radius, f"clearance {radius:.4g} {self.length.symbol}")
            (self.trail,) = self.left.plot([], [], color=BLUE, lw=0.8)
            (self.point,) = self.left.plot([], [], "o", color=VERMILION)
            self.left.set(xlabel=label("x", self.length), ylabel=label("y", self.length), aspect="equal")
            self.image = draw_map(self.right, films[0], PRESSURE, self.unit, limits, outlines=False)
            style_ticks(self.right)
            bar = self.figure.colorbar(self.image, ax=self.right, label=label("pressure", self.unit), pad=0.02)
            style_ticks(bar.ax)
            self.title = self.figure.suptitle(" ")
        self.outline: ContourSet | None = None

    def show(self, film: JointFilm) -> None:
        """Bring the picture to the instant of a film."""
        until = self.history.time <= film.time
        self.trail.set_data(*self.length(self.history.eccentricity[until]).T)
        self.point.set_data(*[[value] for value in self.length(film.motion[:2])])
        self.image.set_data(self.unit(on_picture(film, field_values(film, PRESSURE))).T)
        if self.outline is not None:
            self.outline.remove()
        self.outline = draw_rupture(self.right, film)
        peak = float(self.unit(film.pressure.max()))
        self.title.set_text(
            f"t = {float(self.time(film.time)):.3f} {self.time.symbol}, largest pressure {peak:.3g} {self.unit.symbol}"
        )


def animate(
    films: Sequence[JointFilm],
    history: HistoryRecord,
    path: str | pathlib.Path,
    *,
    frames_per_second: int = 15,
    largest_count: int = 150,
) -> None:
    """Write the animation: the orbit up to every instant in the clearance circle, and the map of the pressure.

    Parameters
    ----------
    films : sequence of JointFilm
    history : HistoryRecord
    path : path
        Ending in ``.gif`` or ``.mp4``.
    frames_per_second : int
    largest_count : int
        Most frames.

    Raises
    ------
    InputError
        For other endings, or ``.mp4`` without the program ffmpeg.
    """
    rate = require_integer("animate: frames_per_second", frames_per_second, at_least=1)
    count = require_integer("animate: largest_count", largest_count, at_least=1)
    target = pathlib.Path(path)
    writer = _writer(target, rate)
    target.parent.mkdir(parents=True, exist_ok=True)
    chosen = np.unique(np.linspace(0, len(films) - 1, min(count, len(films))).round().astype(int))
    picture = Frames(films, history)
    with writer.saving(picture.figure, str(target), picture.figure.dpi):
        for k in chosen:
            picture.show(films[k])
            writer.grab_frame()


def _writer(target: pathlib.Path, rate: int) -> animation.AbstractMovieWriter:
    if target.suffix == ".gif":
        return animation.PillowWriter(fps=rate)
    if target.suffix != ".mp4":
        raise InputError(f"animate: path must end in .gif or .mp4, got '{target}'.")
    if not animation.FFMpegWriter.isAvailable():
        raise InputError("animate: .mp4 needs the program ffmpeg, which is not installed; install it, or write a .gif.")
    return animation.FFMpegWriter(fps=rate)


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
    try:
        import meshio
    except ImportError:
        raise InputError(
            "export_vtk needs the package meshio, which is not installed; pip install meshio (or exudyn-ehd[vtk])."
        ) from None
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
    points = cylinder_points(r, film.theta, film.z).reshape(-1, 3)
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
    from exudyn_ehd.solid.total_lagrange import StressRecovery

    assert isinstance(bush, ANCFBush | ModalBush)
    return StressRecovery(mesh=bush.build_mesh(), material=bush.material)
