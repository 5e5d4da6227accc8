"""One style for all pictures: sizes for a column and a page, small type, a palette safe for colour-blind readers.

Palette: M. Okabe and K. Ito, Color Universal Design (2008). Maps use matplotlib's perceptually uniform colours.
"""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from typing import Any, cast

import matplotlib
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends import BackendFilter, backend_registry
from matplotlib.figure import Figure

from exudyn_ehd.pictures.records import Target
from exudyn_ehd.status import InputError

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#000000",
    "#808080",
)
PALETTE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
# Width of a page, sizes of pictures that are about square, as wide as a column, and of maps and curves, inch.
PAGE, TALL, WIDE = 7.2, (3.5, 3.9), (4.5, 3.2)
# Matplotlib's backends that show nothing, in lower case.
FILES_ONLY = [name.lower() for name in backend_registry.list_builtin(BackendFilter.NON_INTERACTIVE)]

RC = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "axes.linewidth": 0.6,
    "axes.prop_cycle": cycler(color=list(PALETTE)),
    "axes.grid": False,
    "grid.linewidth": 0.4,
    "grid.color": "#D0D0D0",
    "lines.linewidth": 1.1,
    "lines.markersize": 4.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "savefig.facecolor": "white",
    "savefig.dpi": 200,
    "figure.facecolor": "white",
}
TEXT = (
    "font.size",
    "axes.titlesize",
    "axes.labelsize",
    "figure.titlesize",
    "figure.labelsize",
    "legend.title_fontsize",
)
SMALL_TEXT = ("xtick.labelsize", "ytick.labelsize", "legend.fontsize")

# Type of pictures in column or page width, pt; ticks and legends are set an eighth smaller.
_type_size: ContextVar[float] = ContextVar("type size of the styled context", default=8.0)


@contextmanager
def styled(type_size: float | None = None) -> Iterator[None]:
    """Context, or decorator, in which everything drawn has the style; the user's own settings come back after it.

    It sets all sizes of type, whatever others have left in matplotlib's settings: Exudyn's ``mbs.PlotSensor`` leaves
    large ones.

    Parameters
    ----------
    type_size : float, optional
        Type of titles and labels, pt; by default that of the styled context around this one, or 8 pt. Figures
        wider than a page take more.
    """
    size = _type_size.get() if type_size is None else type_size
    sizes = dict.fromkeys(TEXT, size) | dict.fromkeys(SMALL_TEXT, 0.875 * size)
    token = _type_size.set(size)
    try:
        with matplotlib.rc_context(RC | sizes):
            yield
    finally:
        _type_size.reset(token)


def new_figure(size: tuple[float, float], path: Target = None) -> Figure:
    """New figure of ``size`` (inch); call it inside `styled`.

    ``plt.show()`` shows it, unless it is written to a ``path`` or matplotlib has nothing to show figures with: pyplot
    would keep those for ever.
    """
    if path is None and matplotlib.get_backend().lower() not in FILES_ONLY:
        # imported here: it may open windows
        from matplotlib import pyplot

        return pyplot.figure(figsize=size, layout="constrained")
    return Figure(figsize=size, layout="constrained")


def new_panels(count: int, size: tuple[float, float], path: Target = None, title: str = "") -> np.ndarray:
    """Axes (count,) below each other in a new figure, with grids and one axis along; call it inside `styled`."""
    figure = new_figure(size, path)
    figure.suptitle(title)
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    for panel in panels:
        style_ticks(panel, grid=True)
        panel.margins(x=0.0)
    figure.align_ylabels(panels)
    return np.asarray(panels)


@contextmanager
def picture(
    ax: Axes | None,
    size: tuple[float, float],
    path: Target = None,
    *,
    title: str = "",
    where: str = "",
    projection: str | None = None,
    **options: Any,
) -> Iterator[tuple[Figure, Any]]:
    """Draw within, in the style, into the axes given or into new ones; the figure is written behind it.

    Parameters
    ----------
    ax : matplotlib Axes or None
    size : (float, float)
        Of a new figure, inch.
    path : path, optional
        Where the figure is written; its suffix sets the format.
    title : str
        Of new axes.
    where, projection : str
        Name of the picture for messages, and matplotlib's name of the projection that axes must have.
    **options
        For ``Figure.add_subplot``.

    Raises
    ------
    InputError
        For axes of another projection.
    """
    if ax is not None and projection is not None and ax.name != projection:
        raise InputError(
            f"{where}: ax must be {projection}, got {ax.name} axes; use "
            f"subplots(subplot_kw={{'projection': '{projection}'}})."
        )
    with styled():
        if ax is not None:
            figure = cast(Figure, ax.figure)
        else:
            figure = new_figure(size, path)
            ax = figure.add_subplot(projection=projection, **options)
            ax.set_title(title)
            style_ticks(ax)
        yield figure, ax
        write(figure, path)


def headed(title: str, text: str) -> str:
    """A text under its title, if there is one."""
    return f"{title}\n{text}" if title else text


def draw_clearance(ax: Axes, radius: float, name: str) -> None:
    """Draw a clearance circle about the origin, once per name and axes."""
    if any(line.get_label() == name for line in ax.lines):
        return
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    ax.plot(radius * np.cos(around), radius * np.sin(around), "--", color=GREY, lw=0.8, label=name)
    style_ticks(ax)


def style_ticks(ax: Axes, *, grid: bool = False) -> None:
    """Give ticks, and lines of a ``grid``, their style inside of `styled`: matplotlib makes most of them outside."""
    ax.tick_params(which="both", labelsize=matplotlib.rcParams["xtick.labelsize"])
    ax.tick_params(width=RC["xtick.major.width"])
    if grid:
        ax.grid(True, lw=RC["grid.linewidth"], color=RC["grid.color"])


def _close(figure: Figure, **_: object) -> None:
    from matplotlib import pyplot

    pyplot.close(figure)


def write(figure: Figure, path: Target) -> None:
    """Write the figure if a path is given, and let a notebook show it once, whether its cell returns it or not.

    IPython's inline backend shows what a cell returns, and behind the cell what pyplot holds: pyplot forgets a figure
    as soon as it is shown.
    """
    if matplotlib.get_backend().endswith("inline"):
        # IPython asks for it before it shows the figure; None leaves everything to its own formats
        figure._repr_mimebundle_ = partial(_close, figure)  # type: ignore[attr-defined]
    if path is not None:
        path = pathlib.Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path)
