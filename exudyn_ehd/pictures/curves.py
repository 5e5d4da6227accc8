"""Curves: rotors in films over their speed (Campbell diagram, decrements, places, unbalance response), and one column
of any table over another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from exudyn_ehd.pictures.records import KINDS, QUANTITIES, Target, Unit, label, unit_for
from exudyn_ehd.pictures.style import (
    BLUE,
    GREY,
    TALL,
    VERMILION,
    WIDE,
    draw_clearance,
    new_panels,
    picture,
    style_ticks,
    styled,
    write,
)
from exudyn_ehd.tables import unit_of

RPM, HERTZ = Unit("1/min", 30.0 / np.pi), Unit("Hz", 0.5 / np.pi)
# Vibrations that decay faster than this share of their frequency are no resonances: shown small.
OVERDAMPED = 0.5
# Largest frequency, over the highest speed, that is shown.
REACH = 1.15
_SENSE = LinearSegmentedColormap.from_list("sense of whirl", [VERMILION, GREY, BLUE])


def plot_campbell(table: Mapping[str, np.ndarray], *, ax: Axes | None = None, path: Target = None) -> Figure:
    """Draw frequencies over the speed: small where overdamped, crossed where growing, colour by sense of whirl.

    Parameters
    ----------
    table : dict
        Of `RotorResult.campbell`.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
    """
    with picture(ax, WIDE, path) as (figure, ax):
        speed = np.abs(table["speed"])
        x = np.broadcast_to(RPM(speed)[:, None], table["frequency"].shape)
        y, light = HERTZ(table["frequency"]), table["damping_ratio"] < OVERDAMPED
        top = REACH * max(float(HERTZ(speed.max())), 1e-9)
        for part, size in ((~light & np.isfinite(y), 3.0), (light, 14.0)):
            dots = ax.scatter(x[part], y[part], s=size, c=table["whirl"][part], cmap=_SENSE, vmin=-1, vmax=1, lw=0)
        growing = table["growth"] > 0.0
        if growing.any():
            ax.plot(x[growing], y[growing], "x", color="black", ms=3.0, mew=0.6, label="grows: unstable")
        for order, style in ((1.0, "--"), (0.5, ":")):
            ax.plot(RPM(speed), HERTZ(order * speed), style, color=GREY, lw=0.8, label=f"{order:g} x speed")
        ax.set(xlabel=label("speed", RPM), ylabel=label("frequency", HERTZ), ylim=(0.0, top))
        ax.legend(loc="upper left")
        bar = figure.colorbar(dots, ax=ax, ticks=[-1, 0, 1])
        bar.ax.set_yticklabels(["backward", "straight line", "forward"])
        style_ticks(bar.ax)
    return figure


def plot_stability(table: Mapping[str, np.ndarray], *, ax: Axes | None = None, path: Target = None) -> Figure:
    """Draw logarithmic decrements of what a Campbell diagram shows; arguments as `plot_campbell`."""
    with picture(ax, WIDE, path) as (figure, ax):
        speed, values = np.abs(table["speed"]), table["log_decrement"]
        x = np.broadcast_to(RPM(speed)[:, None], values.shape)
        shown = (table["damping_ratio"] < OVERDAMPED) & (table["frequency"] < REACH * speed.max())
        ax.axhline(0.0, color="black", lw=0.6)
        for part, colour, text in ((values > 0.0, BLUE, "decays"), (values <= 0.0, VERMILION, "grows: unstable")):
            if np.any(part & shown):
                ax.plot(x[part & shown], values[part & shown], ".", color=colour, label=text)
        ax.set(xlabel=label("speed", RPM), ylabel="logarithmic decrement [-]")
        style_ticks(ax, grid=True)
        ax.legend()
    return figure


def plot_positions(
    speeds: np.ndarray, places: np.ndarray, names: Sequence[str], *, ax: Axes | None = None, path: Target = None
) -> Figure:
    """Draw the loci of journals (k, j, 2), over their clearances, over the speeds (k,)."""
    with picture(ax, TALL, path) as (figure, ax):
        draw_clearance(ax, 1.0, "clearance")
        slowest = int(np.argmin(np.abs(speeds)))
        for k, name in enumerate(names):
            (line,) = ax.plot(*places[:, k].T, ("-", "--", ":")[k % 3], lw=1.4, label=name)
            text = f"slowest, {float(RPM(abs(speeds[slowest]))):.0f} {RPM.symbol}"
            ax.plot(*places[slowest, k], "o", color=line.get_color(), label=text if k == len(names) - 1 else None)
        ticks = np.linspace(-1.0, 1.0, 5)
        ax.set(xlabel="x / c [-]", ylabel="y / c [-]", aspect="equal", xticks=ticks, yticks=ticks)
        figure.legend(loc="outside lower center", ncols=2)
    return figure


def plot_response(
    speeds: np.ndarray,
    curves: Sequence[tuple[str, np.ndarray, np.ndarray]],
    stable: np.ndarray,
    *,
    path: Target = None,
) -> Figure:
    """Draw named amplitudes (k,) in m and phases (k,) in rad over the speeds (k,), dotted where not stable."""
    with styled():
        upper, lower = new_panels(2, TALL, path)
        unit = unit_for("length", np.concatenate([amplitude for _, amplitude, _ in curves]))
        x = RPM(np.abs(speeds))
        for text, amplitude, phase in curves:
            for panel, y in ((upper, unit(amplitude)), (lower, np.degrees(np.unwrap(phase)))):
                (line,) = panel.plot(x, np.where(stable, y, np.nan), label=text)
                panel.plot(x, np.where(stable, np.nan, y), ":", color=line.get_color())
        upper.set(ylabel=label("amplitude", unit), ylim=(0.0, None))
        lower.set(xlabel=label("speed", RPM), ylabel="phase relative to\nthe unbalance [°]")
        upper.legend()
        write(upper.figure, path)
    return upper.figure


def plot_map(
    values: np.ndarray,
    thresholds: np.ndarray,
    limits: tuple[float, float],
    name: tuple[str, Unit],
    *,
    ax: Axes | None = None,
    path: Target = None,
) -> Figure:
    """Draw threshold speeds over a parameter, stable below and unstable above, between the ``limits``."""
    with picture(ax, WIDE, path) as (figure, ax):
        text, unit = name
        order = np.argsort(values)
        x, y = unit(values[order]), RPM(np.clip(thresholds[order], *limits))
        ax.fill_between(x, y, RPM(limits[1]), color=VERMILION, alpha=0.2, lw=0, label="unstable")
        ax.fill_between(x, RPM(limits[0]), y, color=BLUE, alpha=0.15, lw=0, label="stable")
        ax.plot(x, y, "o-", color="black", ms=3.0)
        ax.set(xlabel=label(text, unit), ylabel=label("speed", RPM), ylim=RPM(np.array(limits)))
        ax.margins(x=0.0)
        ax.legend()
    return figure


Curve: TypeAlias = tuple[str, np.ndarray, np.ndarray]
"""Name in the legend, x and y (n,) in SI units."""


def plot_curves(
    curves: Sequence[Curve],
    names: tuple[str, str],
    units: Mapping[str, str],
    *,
    ax: Axes | None = None,
    path: Target = None,
) -> Figure:
    """Draw curves with a legend.

    Parameters
    ----------
    curves : sequence of Curve
    names : (str, str)
        Names of the columns x and y; known quantities are shown in their usual unit.
    units : dict
        Units of other columns by name.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
    """
    columns = [column(name, np.concatenate([curve[k + 1] for curve in curves]), units) for k, name in enumerate(names)]
    x_unit, y_unit = (unit for _, unit in columns)
    with picture(ax, WIDE, path) as (figure, ax):
        for text, x, y in curves:
            order = np.argsort(x)
            ax.plot(x_unit(x[order]), y_unit(y[order]), "o-", label=text or None)
        xlabel, ylabel = (label(text, unit) if unit.symbol else text for text, unit in columns)
        ax.set(xlabel=xlabel, ylabel=ylabel)
        style_ticks(ax, grid=True)
        if any(text for text, _, _ in curves):
            ax.legend()
    return figure


def column(name: str, values: np.ndarray, units: Mapping[str, str]) -> tuple[str, Unit]:
    """Return the label of a column and the unit in which its SI values are shown; ``units`` holds those of others."""
    text, kind = QUANTITIES.get(name, (name.replace("_", " "), None))
    if name in units:
        return name.replace("_", " "), Unit(units[name])
    symbol = unit_of(name) or ""
    kind = kind or KINDS.get(symbol)
    return text.replace("\n", " "), Unit(symbol) if kind is None else unit_for(kind, values)
