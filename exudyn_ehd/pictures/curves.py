"""Curves of one column of a table over another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_ehd.pictures.records import Target
from exudyn_ehd.pictures.style import COLUMN, finish, open_axes, style_ticks, styled
from exudyn_ehd.pictures.units import QUANTITIES, Unit, label, unit_for
from exudyn_ehd.tables import unit_of

SIZE = (1.2 * COLUMN, 0.8 * COLUMN)


class Curve(NamedTuple):
    """A curve with its name in the legend; ``x``, ``y`` (n,) in SI units."""

    text: str
    x: np.ndarray
    y: np.ndarray


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
        Of the columns x and y; quantities that are known are shown in their usual unit.
    units : dict
        Of columns by name, for others.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
    """
    shown = [_shown(name, np.concatenate([curve[k + 1] for curve in curves]), units) for k, name in enumerate(names)]
    with styled():
        figure, ax = open_axes(ax, SIZE, path)
        for curve in curves:
            order = np.argsort(curve.x)
            ax.plot(shown[0][1](curve.x[order]), shown[1][1](curve.y[order]), "o-", label=curve.text or None)
        ax.set(xlabel=shown[0][0], ylabel=shown[1][0])
        ax.grid(True, lw=0.4, color="#D0D0D0")
        style_ticks(ax)
        if any(curve.text for curve in curves):
            ax.legend()
        return finish(figure, path)


def _shown(name: str, values: np.ndarray, units: Mapping[str, str]) -> tuple[str, Unit]:
    """Label of a column, and the unit in which it is shown."""
    if name in QUANTITIES and name not in units:
        text, kind = QUANTITIES[name]
        unit = unit_for(kind, values)
        return label(text.replace("\n", " "), unit), unit
    symbol = unit_of(name, units)
    text = name.replace("_", " ")
    return (text if symbol is None else f"{text} [{symbol}]"), Unit(symbol or "")
