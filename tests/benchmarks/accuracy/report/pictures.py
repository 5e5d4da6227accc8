"""Work-precision diagrams with their Pareto fronts, and the one-page summary."""

from __future__ import annotations

import itertools
import math
import pathlib
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from matplotlib.transforms import Bbox

from exudyn_ehd.pictures.style import BLACK, GREY, PALETTE, RC, style_ticks, styled
from exudyn_ehd.tables import format_seconds
from tests.benchmarks.accuracy.report.front import cheapest, pareto_front
from tests.benchmarks.accuracy.table import Row

# Left, lower, right, upper, in pixels.
Box = tuple[float, float, float, float]
LEVELS = (0.1, 0.01, 0.001)
# Errors below this are rounding.
FLOOR = 1e-12
FILM_FAMILIES = (
    "2D, Swift-Stieber",
    "2D, Swift-Stieber, line on vertices",
    "2D, Gümbel",
    "impedance map",
    "short bearing",
    "long bearing",
    "FD + SOR, Gümbel",
)
MARKERS = "osD^vP*X<>ph8"


def work_precision(rows: Sequence[Row], title: str, per: str) -> Figure:
    """Error against time of one study and quantity: families by colour, the Pareto front as a line with labels.

    Parameters
    ----------
    rows : sequence of Row
        Of one quantity.
    title : str
    per : str
        What the time is the time of.
    """
    with styled():
        figure = Figure(figsize=(7.2, 5.2), layout="constrained")
        axes = figure.add_subplot()
        draw_points(axes, rows, per)
        style_ticks(axes)
        axes.set_title(title)
        # labels need the final place of the axes
        figure.draw_without_rendering()
        _place_labels(axes, [row for row in rows if _drawable(row)])
    return figure


def _drawable(row: Row) -> bool:
    return row.timed and row.error < 1e3


def _error(row: Row) -> float:
    return max(row.error, FLOOR)


def draw_points(axes: Axes, rows: Sequence[Row], per: str) -> None:
    """Points, front and the reference's own error; without labels."""
    points = [row for row in rows if _drawable(row)]
    if not points:
        axes.text(0.5, 0.5, "no timed point", ha="center", transform=axes.transAxes)
        return
    for family, k in _places(points).items():
        own = [row for row in points if row.family == family]
        t = np.array([row.seconds for row in own])
        axes.errorbar(
            t,
            [_error(row) for row in own],
            xerr=[t - [r.low for r in own], [r.high for r in own] - t],
            fmt=MARKERS[k % len(MARKERS)],
            color=PALETTE[k % len(PALETTE)],
            label=family,
            elinewidth=0.6,
            ms=4.0,
            zorder=3,
            mfc=PALETTE[k % len(PALETTE)] if k < len(PALETTE) else "white",
        )
    reference = points[0]
    axes.set(xscale="log", yscale="log", xlabel=f"processor time per {per}, one thread", ylabel=_ylabel(reference))
    low = min(_error(row) for row in points)
    own_error = reference.reference_error
    lower, upper = 0.4 * min(low, max(own_error, 0.1 * low)), 3.0 * max(_error(row) for row in points)
    axes.set_ylim(lower, upper)
    if own_error > lower:
        axes.axhspan(lower, own_error, color=GREY, alpha=0.18, lw=0, label="reference's own error")
    times = [row.seconds for row in points]
    axes.set_xlim(0.5 * min(times), 2.5 * max(times))
    line = _front_line(points, upper, 2.5 * max(times))
    axes.plot(*line.T, color=BLACK, lw=0.8, zorder=2, label="Pareto front")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: format_seconds(value)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100.0 * value:.4g} %"))
    # within two decades the labels of the ticks between are needed, else they would crowd
    wide = axes.get_xlim()[1] > 200.0 * axes.get_xlim()[0]
    between = FuncFormatter(lambda value, _: format_seconds(value) if f"{value:.0e}"[0] in "25" else "")
    axes.xaxis.set_minor_formatter(NullFormatter() if wide else between)
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major")
    axes.figure.legend(loc="outside lower center", ncols=4)


def _places(points: Sequence[Row]) -> dict[str, int]:
    """Place in palette and markers by family; film models have the same in all pictures."""
    families = list(dict.fromkeys(row.family for row in points))
    if any(family in FILM_FAMILIES for family in families):
        families = [*FILM_FAMILIES, *(f for f in families if f not in FILM_FAMILIES)]
    present = {row.family for row in points}
    return {family: k for k, family in enumerate(families) if family in present}


def _front_line(points: Sequence[Row], top: float, right: float) -> np.ndarray:
    """Corners (k, 2) of the border of what no point beats, from ``top`` to ``right``."""
    corners = []
    last = top
    for k in pareto_front([row.seconds for row in points], [_error(row) for row in points]):
        t, error = points[k].seconds, _error(points[k])
        corners += [(t, last), (t, error)]
        last = error
    return np.array([*corners, (right, last)])


def _ylabel(row: Row) -> str:
    return f"error of {row.quantity} against {row.reference}"


def short_label(row: Row) -> str:
    """Label of a point: what its colour does not tell."""
    text = re.sub(
        r"^(2D|line on vertices|Gümbel|Swift-Stieber|full Sommerfeld|mass conserving|short|modal|nodal|Newton|SOR)"
        r" (?=\d)",
        "",
        row.setting,
    )
    text = text.replace(" x ", "x").replace(" steps", "")
    text = re.sub(r", rho [\d.]+$", "", text)
    return re.sub(r"1e-0(\d)", r"1e-\1", text)


def _place_labels(axes: Axes, points: Sequence[Row]) -> None:
    """Write the labels of the Pareto front next to their points, where they cover neither a label nor a point.

    Labels far from their points get a thin line. Points off the front have none: no one could tell whose they are.
    """
    to_screen, scale, size = axes.transData.transform, axes.figure.dpi / 72.0, 5.5
    place = np.array([to_screen((row.seconds, _error(row))) for row in points])
    taken = [(x - 3 * scale, y - 3 * scale, x + 3 * scale, y + 3 * scale) for x, y in place]
    # error bars and front are no place for text either
    for row, (_, y) in zip(points, place, strict=True):
        left, right = (to_screen((t, 1.0))[0] for t in (row.low, row.high))
        taken.append((left, y - scale, right, y + scale))
    line = to_screen(_front_line(points, axes.get_ylim()[1], axes.get_xlim()[1]))
    for (x0, y0), (x1, y1) in itertools.pairwise(line):
        taken.append((min(x0, x1) - scale, min(y0, y1) - scale, max(x0, x1) + scale, max(y0, y1) + scale))
    for k in pareto_front([row.seconds for row in points], [_error(row) for row in points]):
        text = short_label(points[k])
        w, h = (0.60 * size * len(text) + 1.0) * scale, 1.15 * size * scale
        found = _free_place(place[k], (w, h), taken, axes.get_window_extent(), scale)
        if found is None:
            continue
        cx, cy, distance = found
        taken.append(_box(cx, cy, w, h))
        thin = {"arrowstyle": "-", "lw": 0.35, "color": GREY, "shrinkA": 0.0, "shrinkB": 2.0}
        axes.annotate(
            text,
            (points[k].seconds, _error(points[k])),
            xytext=tuple(axes.transData.inverted().transform((cx, cy))),
            textcoords="data",
            fontsize=size,
            ha="center",
            va="center",
            arrowprops=thin if distance > 9.0 else None,
            zorder=4,
            annotation_clip=False,
        )


def _free_place(
    point: np.ndarray, size: tuple[float, float], taken: Sequence[Box], page: Bbox, scale: float
) -> tuple[float, float, float] | None:
    """Centre of a label of a size (pixels) and its distance to its point (pt): the nearest that covers nothing."""
    w, h = size
    for distance in (5.0, 9.0, 14.0, 20.0, 28.0, 38.0, 50.0, 65.0):
        for angle in (20, -20, 160, -160, 60, -60, 90, -90, 120, -120, 0, 180):
            cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            aside = 0.5 * w if cosine > 0.2 else -0.5 * w if cosine < -0.2 else 0.0
            cx, cy = point[0] + distance * cosine * scale + aside, point[1] + distance * sine * scale
            mine = _box(cx, cy, w, h)
            inside = mine[0] > page.x0 and mine[2] < page.x1 and mine[1] > page.y0 and mine[3] < page.y1
            if inside and not any(_overlap(mine, other) for other in taken):
                return cx, cy, distance
    return None


def _box(cx: float, cy: float, w: float, h: float) -> Box:
    return cx - 0.5 * w, cy - 0.5 * h, cx + 0.5 * w, cy + 0.5 * h


def _overlap(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def summary_rows(tables: Iterable[tuple[Sequence[Row], str]]) -> list[list[str]]:
    """One line per study and quantity under `HEADINGS`, with the cheapest setting within 10, 1 and 0.1 %.

    Parameters
    ----------
    tables : pairs of rows and the study's title
    """
    out = []
    for rows, title in tables:
        for quantity in dict.fromkeys(row.quantity for row in rows):
            block = [row for row in rows if row.quantity == quantity]
            first = next((row for row in block if row.timed), None)
            if first is None:
                continue
            line = [title, quantity, f"{first.reference}, {100.0 * first.reference_error:.1g} %"]
            for level in LEVELS:
                row = cheapest(block, level)
                line.append("-" if row is None else f"{row.setting}: {format_seconds(row.seconds)}")
            out.append(line)
    return out


HEADINGS = ["scene: ladder", "quantity", "reference, its own error", "within 10 %", "within 1 %", "within 0.1 %"]


def summary_text(lines: Sequence[Sequence[str]]) -> str:
    """The summary as a Markdown table."""
    out = ["| " + " | ".join(HEADINGS) + " |", "|" + "---|" * len(HEADINGS)]
    last = ""
    for line in lines:
        title = "" if line[0] == last else line[0]
        out.append("| " + " | ".join([title, *line[1:]]) + " |")
        last = line[0]
    return "\n".join(out) + "\n"


def summary_figure(lines: Sequence[Sequence[str]], note: str) -> Figure:
    """The summary on one page."""
    with styled():
        height = 0.6 + 0.135 * (len(lines) + 2)
        figure = Figure(figsize=(11.7, height))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, 1.0), ylim=(0.0, height))
        axes.axis("off")
        columns = (0.01, 0.26, 0.345, 0.505, 0.67, 0.835)
        y = height - 0.25
        axes.text(
            0.01,
            y,
            "The cheapest setting that keeps an error, and its processor time (one thread)",
            fontsize=9,
            weight="bold",
        )
        axes.text(0.99, y, note, fontsize=6, ha="right")
        y -= 0.24
        for x, heading in zip(columns, HEADINGS, strict=True):
            axes.text(x, y, heading, fontsize=6.5, weight="bold")
        last = ""
        for line in lines:
            y -= 0.135
            if line[0] != last:
                axes.plot([0.01, 0.99], [y + 0.1, y + 0.1], color=GREY, lw=0.3)
            for x, text in zip(columns, ["" if line[0] == last else line[0], *line[1:]], strict=True):
                axes.text(x, y, text, fontsize=5.6)
            last = line[0]
    return figure


def write_pictures(folder: pathlib.Path, tables: Iterable[tuple[Sequence[Row], str, str]]) -> list[pathlib.Path]:
    """Work-precision diagrams of all tables: rows, title, what the time is of; returns the files."""
    out = []
    for rows, title, per in tables:
        for quantity in dict.fromkeys(row.quantity for row in rows):
            block = [row for row in rows if row.quantity == quantity]
            if not any(_drawable(row) for row in block):
                continue
            path = folder / f"{block[0].study}_{quantity.replace(' ', '_')}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            save(work_precision(block, title, per), path)
            out.append(path)
    return out


def unit_of(notes: Sequence[str]) -> str:
    """Unit of work that a study's times refer to (a step, a film), from its table's notes."""
    return notes[1].split(";")[0].removeprefix("time per ")


def save(figure: Figure, path: pathlib.Path, **options: Any) -> None:
    """Write a picture."""
    figure.savefig(path, dpi=RC["savefig.dpi"], **options)
