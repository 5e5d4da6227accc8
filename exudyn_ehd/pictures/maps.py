"""Maps: a field of the film unrolled over angle and bearing length, the pressure of a ball's socket along its axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patheffects import withStroke
from matplotlib.projections.polar import PolarAxes

from exudyn_ehd.film.arcs import columns_of_arcs
from exudyn_ehd.film.supply.areas import covers, placed
from exudyn_ehd.pictures.records import FilmRecord, Target, Unit, label, shown, unit_for
from exudyn_ehd.pictures.style import BLACK, GREY, TALL, WIDE, headed, picture, style_ticks
from exudyn_ehd.status import ROUNDING, InputError

# Points of a picture around and along.
FINE = (721, 121)
# Places without a bore, between arcs.
NO_BORE = "0.85"
# White dashes with a rim, for maps of any colour and legends on white.
RUPTURE: dict[str, Any] = {
    "color": "white",
    "linestyle": "dashed",
    "linewidth": 0.9,
    "path_effects": [withStroke(linewidth=1.7, foreground=GREY)],
}


@dataclass(frozen=True)
class MapField:
    """A field of the film and how its map looks.

    Parameters
    ----------
    name : str
        Attribute of the film.
    text, kind : str
        Of the colour bar, and of `unit_for`.
    colours : str
        Matplotlib's name.
    absent : str
        What to do if the film has no such field.
    """

    name: str
    text: str
    kind: str
    colours: str
    absent: str = ""


_CONTACTS = "give the bearing asperity=GreenwoodTripp(...) or contact=RegularisedWall(...)."
_ELROD = "only a mass-conserving film has one: cavitation=ElrodAdams(...)."
FIELDS = {
    field.name: field
    for field in (
        MapField("pressure", "pressure", "pressure", "viridis"),
        MapField("gap", "gap", "length", "cividis"),
        MapField("fill", "film fraction", "ratio", "Blues", _ELROD),
        MapField(
            "temperature", "film temperature", "temperature", "inferno", "give the bearing thermal=FilmEnergy(...)."
        ),
        MapField("contact_pressure", "contact pressure", "pressure", "magma", _CONTACTS),
        MapField("wear_depth", "wear depth", "depth", "cividis", "give the bearing wear=ArchardWear(...)."),
    )
}
PRESSURE = FIELDS["pressure"]


def field_values(film: FilmRecord, field: MapField) -> np.ndarray:
    """The field (n, m) of a film; a single temperature fills the whole map.

    Raises
    ------
    InputError
        If the film has none.
    """
    if (values := getattr(film, field.name, None)) is None:
        joints = "" if hasattr(film, field.name) else " Films of joints have it: joint.film()."
        raise InputError(f"plot_{field.name}: this film has no {field.text}; {field.absent}{joints}")
    return np.broadcast_to(np.asarray(values, dtype=float), film.pressure.shape)


def resampled(film: FilmRecord, values: np.ndarray, angles: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Field on the grid of angles (k,) and places (l,) along the axis, linear between vertices; nan between arcs."""
    rows, arcs = np.stack([np.interp(along, film.z, row) for row in values]), film.bearing.bore_arcs
    if len(arcs) < 2:
        return np.stack([np.interp(angles, film.theta, column, period=math.tau) for column in rows.T], axis=1)
    out = np.full((angles.size, along.size), np.nan)
    for part in columns_of_arcs(film.theta, arcs):
        first, last = film.theta[part][[0, -1]]
        at = first + np.mod(angles - first + ROUNDING, math.tau)
        inside = at <= last + 2.0 * ROUNDING
        out[inside] = np.stack([np.interp(at[inside], film.theta[part], row) for row in rows[part].T], axis=1)
    return out


def on_picture(film: FilmRecord, values: np.ndarray, *, prescribed_ends: bool = True) -> np.ndarray:
    """Field (n, m) on the uniform grid of a picture, linear between vertices.

    With ``prescribed_ends=False`` the two rows at the bearing's ends take their neighbours' values: there a film
    fraction is that of the surroundings, not of the film.
    """
    if not prescribed_ends and values.shape[1] > 2:
        values = np.column_stack([values[:, 1], values[:, 1:-1], values[:, -2]])
    return resampled(film, values, np.linspace(*span(film), FINE[0]), np.linspace(film.z[0], film.z[-1], FINE[1]))


def cylinder_points(radius: np.ndarray | float, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Points (k, l, 3) at a radius (k, l), angles (k,) and places (l,) along the axis."""
    r = np.broadcast_to(radius, (theta.size, z.size))
    return np.stack([r * np.cos(theta)[:, None], r * np.sin(theta)[:, None], np.broadcast_to(z, r.shape)], axis=-1)


def span(film: FilmRecord) -> tuple[float, float]:
    """First and last angle of a film, rad: those of its one arc, or a turn."""
    return (0.0, math.tau) if len(film.bearing.bore_arcs) != 1 else (float(film.theta[0]), float(film.theta[-1]))


def plot_map(
    film: FilmRecord, field: MapField, *, title: str = "", ax: Axes | None = None, path: Target = None
) -> Figure:
    """Draw the unrolled map of a field.

    The dashed line is the edge of the cavity, black lines bound the supply areas in the housing, grey parts lie between
    arcs; a legend says so.

    Parameters
    ----------
    film : FilmRecord
    field : MapField
    title : str
        Stands above the field's telling value.
    ax : matplotlib Axes, optional
        Where to draw; by default a new figure.
    path : path, optional
        Where to write the figure.

    Returns
    -------
    matplotlib Figure
    """
    values = field_values(film, field)
    unit = unit_for(field.kind, values)
    own = ax is None
    with picture(ax, WIDE, path) as (figure, ax):
        image = draw_map(ax, film, field, unit)
        style_ticks(figure.colorbar(image, ax=ax, label=label(field.text, unit), pad=0.02).ax)
        if own and ax.get_legend_handles_labels()[0]:
            figure.legend(loc="outside lower center", ncols=2)
        ax.set_title(headed(title, _extreme(film, field, values, unit)))
    return figure


def draw_map(
    ax: Axes,
    film: FilmRecord,
    field: MapField,
    unit: Unit,
    limits: tuple[float, float] | None = None,
    *,
    outlines: bool = True,
) -> AxesImage:
    """Draw the map with axes and outlines into ``ax``; returns the image. ``limits`` of colours in its unit."""
    values = unit(on_picture(film, field_values(film, field), prescribed_ends=field.name != "fill"))
    low, high = limits or ((0.0, 1.0) if field.name == "fill" else colour_limits(values))
    first, last = np.degrees(span(film))
    image = ax.imshow(
        values.T,
        origin="lower",
        aspect="auto",
        interpolation="bilinear",
        extent=(first, last, 1e3 * film.z[0], 1e3 * film.z[-1]),
        cmap=matplotlib.colormaps[field.colours].with_extremes(bad=NO_BORE),
        vmin=low,
        vmax=high,
    )
    # lines without points stand for the outlines in a legend
    if outlines and draw_rupture(ax, film) is not None:
        ax.plot([], [], **RUPTURE, label="edge of the cavity")
    if _draw_supply(ax, film):
        ax.plot([], [], color=BLACK, linewidth=0.8, label="supply area")
    if np.isnan(values).any():
        ax.plot([], [], "s", color=NO_BORE, markersize=8, label="no bore")
    ax.set(
        xlabel="angle θ [°]",
        ylabel="z [mm]",
        xlim=(first, last),
        ylim=(1e3 * film.z[0], 1e3 * film.z[-1]),
        xticks=[*range(0, 361, 60)] if last - first == 360.0 else np.round(np.linspace(first, last, 5)),
    )
    return image


def colour_limits(values: np.ndarray) -> tuple[float, float]:
    """Colour limits: the values' range; never empty."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    # a uniform field (a single temperature, a concentric journal) to rounding
    if high - low <= ROUNDING * max(abs(low), abs(high)):
        half = 0.01 * max(abs(low), 1.0)
        return low - half, high + half
    return low, high


def draw_rupture(ax: Axes, film: FilmRecord) -> ContourSet | None:
    """Draw the boundary of the unbroken film; None if there is none inside."""
    # vertices with a prescribed pressure are none of the solver's: full where the pressure is above the cavity's
    full = film.unbroken | (film.pressure > film.bearing.cavitation.cavity_pressure)
    whole = full.astype(float)
    for part in columns_of_arcs(film.theta, film.bearing.bore_arcs):
        whole[[part.start, part.stop - 1]] = whole[[part.start + 1, part.stop - 2]]
    inner = whole[:, 1:-1]
    if inner.size == 0 or inner.min() == inner.max():
        return None
    # prescribed end rows count as neither: the boundary runs straight into the ends
    whole[:, 0], whole[:, -1] = whole[:, 1], whole[:, -2]
    theta = np.linspace(*span(film), FINE[0])
    drawn = resampled(film, whole, theta, film.z)
    edge = ax.contour(np.degrees(theta), 1e3 * film.z, drawn.T, levels=[0.5], colors=["white"])
    edge.set(**{name: value for name, value in RUPTURE.items() if name != "color"})
    return edge


def _draw_supply(ax: Axes, film: FilmRecord) -> bool:
    """Outlines of the supply areas that lie in the housing; whether there are any."""
    theta = np.linspace(0.0, math.tau, FINE[0])
    z = np.linspace(film.z[0], film.z[-1], FINE[1])
    fixed = [area for area in placed(film.bearing.supply, film.bearing.length) if not area.rotating]
    for area in fixed:
        inside = covers(area, theta, z, film.bearing.journal_radius).astype(float)
        # a frame of zeros closes outlines that run along the map's edge
        ax.contour(np.degrees(theta), 1e3 * z, inside.T, levels=[0.5], colors=BLACK, linewidths=0.8)
    return bool(fixed)


def _extreme(film: FilmRecord, field: MapField, values: np.ndarray, unit: Unit) -> str:
    """Title: the field's telling value with its place."""
    lowest = field.name in ("gap", "fill")
    i, j = np.unravel_index(np.argmin(values) if lowest else np.argmax(values), values.shape)
    angle = math.degrees(math.fmod(film.theta[i] + math.tau, math.tau))
    size = f"{unit(values[i, j]):.4g} {unit.symbol}".removesuffix(" -")
    word = "smallest" if lowest else "largest"
    return f"{word} {size} at θ = {angle:.0f}°, z = {1e3 * film.z[j]:.3g} mm"


def plot_patch(
    phi: np.ndarray,
    chi: np.ndarray,
    pressure: np.ndarray,
    *,
    title: str = "",
    ax: PolarAxes | None = None,
    path: Target = None,
) -> Figure:
    """Draw the pressure of a patch.

    Parameters
    ----------
    phi, chi : (n,), (m,) arrays
        Angles about the axis and colatitudes, rad.
    pressure : (n, m) array
        Pa.
    title : str
        Stands above the peak pressure.
    ax : polar matplotlib Axes, optional
        Where to draw; by default a new figure.
    path : path, optional
        Where to write the figure.

    Raises
    ------
    InputError
        If ``ax`` is not polar.
    """
    unit = unit_for("pressure", pressure)
    ring = np.concatenate([phi, [2.0 * math.pi]])
    values = unit(np.concatenate([pressure, pressure[:1]]))
    if chi[0] < chi[1] - chi[0]:
        # closed at the pole, half an interval from the first row
        values = np.column_stack([np.full(len(ring), values[:-1, 0].mean()), values])
        chi = np.concatenate([[0.0], chi])
    with picture(ax, TALL, path, where="plot_pressure", projection="polar") as (figure, ax):
        image = ax.contourf(ring, np.degrees(chi), values.T, levels=24, cmap="viridis")
        ax.set_rlim(0.0, math.degrees(chi[-1]))
        ax.set_rgrids([k for k in range(30, 180, 30) if chi[0] < math.radians(k) < chi[-1]], fmt="%d°", color="white")
        # across from the peak
        column = np.unravel_index(pressure.argmax(), pressure.shape)[0]
        ax.set_rlabel_position(math.degrees(phi[column]) + 157.5)
        style_ticks(ax, grid=True)
        style_ticks(figure.colorbar(image, ax=ax, label=label("pressure", unit), pad=0.12, shrink=0.8).ax)
        ax.set_title(headed(title, f"peak pressure {shown('pressure', float(pressure.max()))}"))
    return figure
