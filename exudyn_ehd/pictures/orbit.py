"""Orbit of the journal in the clearance circle."""

from __future__ import annotations

from typing import Any

import numpy as np

from exudyn_ehd.pictures.data import History
from exudyn_ehd.pictures.style import BLUE, COLUMN, GREY, SKY, VERMILION, finish, open_axes, style_ticks, styled
from exudyn_ehd.pictures.units import Unit, label, unit_for

SIZE = (COLUMN, 1.12 * COLUMN)


def plot_orbit(history: History, *, ends: bool = False, text: str = "", ax: Any = None, path: Any = None) -> Any:
    """Draw the orbit of the journal's axis in the mid-plane, in the circle of radius c that a rigid aligned journal can't leave.

    Parameters
    ----------
    history : History
    ends : bool
        Also draw the axis at both ends of the bearing.
    text : str
        Name of the orbit in the legend; two orbits in the same ``ax`` share one circle if their clearances agree.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
    """
    c = history.radial_clearance
    unit = unit_for("length", c)
    with styled():
        own = ax is None
        figure, ax = open_axes(ax, SIZE)
        draw_clearance(ax, c, unit)
        e = history.eccentricity
        if ends:
            half = 0.5 * history.length
            for sign, colour in ((-1.0, SKY), (1.0, VERMILION)):
                at = unit(e + sign * half * history.motion[:, 2:4])
                ax.plot(at[:, 0], at[:, 1], lw=0.8, color=colour, label=f"at z = {'+' if sign > 0 else '-'}L/2")
        (line,) = ax.plot(*unit(e).T, color=BLUE if own else None, label=text or "mid-plane")
        if len(e):
            ax.plot(*unit(e[0]), "o", mfc="white", mec=line.get_color(), label="start" if own else "_start")
            ax.plot(*unit(e[-1]), "o", color=line.get_color(), label="end" if own else "_end")
        ax.set(xlabel=label("x", unit), ylabel=label("y", unit), aspect="equal")
        if own:
            figure.legend(loc="outside lower center", ncols=3)
        elif text:
            ax.legend()
        return finish(figure, path)


def draw_clearance(ax: Any, c: float, unit: Unit) -> None:
    """Draw the clearance circle, once per radius and axes."""
    name = f"clearance {unit(c):.4g} {unit.symbol}"
    if any(line.get_label() == name for line in ax.lines):
        return
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    ax.plot(unit(c) * np.cos(around), unit(c) * np.sin(around), "--", color=GREY, lw=0.8, label=name)
    style_ticks(ax)
