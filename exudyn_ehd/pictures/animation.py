"""Animation of orbit and pressure as gif or mp4."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence

import numpy as np
from matplotlib import animation
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from exudyn_ehd.pictures.histories import draw_clearance
from exudyn_ehd.pictures.maps import PRESSURE, draw_map, draw_rupture, field_values, on_picture
from exudyn_ehd.pictures.records import HistoryRecord, JointFilm, label, unit_for
from exudyn_ehd.pictures.style import BLUE, PAGE, VERMILION, WIDE, style_ticks, styled
from exudyn_ehd.status import InputError, require_integer


class Frames:
    """The picture of an animation, brought to one instant after the other.

    Parameters
    ----------
    films : sequence of JointFilm
    history : HistoryRecord
    """

    def __init__(self, films: Sequence[JointFilm], history: HistoryRecord) -> None:
        self.films, self.history = films, history
        largest = max(float(np.max(film.pressure)) for film in films)
        lowest = min(float(np.min(film.pressure)) for film in films)
        self.unit = unit_for("pressure", max(abs(largest), abs(lowest)))
        self.length = unit_for("length", history.radial_clearance)
        self.time = unit_for("time", history.time)
        limits = float(self.unit(lowest)), float(self.unit(max(largest, lowest + 1.0)))
        with styled():
            self.figure = Figure(figsize=(PAGE, WIDE[1]), layout="constrained")
            self.left, self.right = self.figure.subplots(1, 2, width_ratios=(1.0, 1.75))
            draw_clearance(self.left, history.radial_clearance, self.length)
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
