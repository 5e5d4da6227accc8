"""Pictures of one column of any table over another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_ehd.pictures.records import KINDS, QUANTITIES, Target, Unit, label, unit_for
from exudyn_ehd.pictures.style import WIDE, picture, style_ticks
from exudyn_ehd.tables import unit_of

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
