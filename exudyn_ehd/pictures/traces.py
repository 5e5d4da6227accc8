"""Quantities of a history over time or over an angle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from exudyn_ehd.pictures.data import History
from exudyn_ehd.pictures.style import COLUMN, PAGE, finish, style_ticks, styled
from exudyn_ehd.pictures.units import QUANTITIES, label, unit_for
from exudyn_ehd.status import InputError

MARGIN, PANEL = 0.55, 1.35
_TICKS = [15.0, 30.0, *(45.0 * 2.0**k for k in range(40))]


def plot_traces(
    history: History,
    quantities: Sequence[Any] = ("minimum_gap", "peak_pressure"),
    *,
    angle: np.ndarray | None = None,
    angle_text: str = "angle",
    text: str = "",
    axes: Any = None,
    path: Any = None,
) -> Any:
    """Draw quantities below each other over the time, or over an angle.

    Parameters
    ----------
    history : History
    quantities : sequence of Quantity or str
        Scalars of the history.
    angle : (n,) array, optional
        Drawn along in place of the time, rad; for instance a crank angle, ``speed * history.time``.
    angle_text : str
        What the angle is.
    text : str
        Name in the legend.
    axes : sequence of matplotlib Axes, optional
        One for every quantity.
    path : path, optional

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    InputError
        For quantities that are no scalars of a history, or that the film does not provide.
    """
    names = [_checked(history, q) for q in quantities]
    if not names or (axes is not None and np.size(axes) != len(names)):
        raise InputError(
            f"plot_traces: axes must be as many as the quantities ({len(names)}, at least 1), got {axes!r}."
        )
    if angle is not None and np.shape(angle) != history.time.shape:
        raise InputError(
            f"plot_traces: angle must have shape {history.time.shape} as history.time, got {np.shape(angle)}."
        )
    along = history.time if angle is None else np.asarray(angle, dtype=float)
    unit = unit_for("time" if angle is None else "angle", along)
    with styled():
        own = axes is None
        if own:
            figure = Figure(
                figsize=(0.62 * PAGE if len(names) > 1 else COLUMN, MARGIN + PANEL * len(names)), layout="constrained"
            )
            axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        axes = np.atleast_1d(np.asarray(axes, dtype=object))
        for ax, name in zip(axes, names, strict=True):
            words, kind = QUANTITIES[name]
            values = getattr(history, name)
            shown = unit_for(kind, values)
            ax.plot(unit(along), shown(values), label=text or None)
            ax.set_ylabel(label(words, shown))
            if own:
                style_ticks(ax)
                ax.grid(True, lw=0.4, color="#D0D0D0")
                ax.margins(x=0.0)
            if kind in ("length", "ratio"):
                largest = float(np.nanmax(shown(values)))
                ax.set_ylim(0.0, max(ax.get_ylim()[1], 1.08 * largest))
            if text:
                ax.legend()
        if angle is not None:
            # at most nine ticks on fractions or multiples of a turn
            span = float(np.ptp(unit(along))) if along.size else 0.0
            axes[-1].xaxis.set_major_locator(MultipleLocator(next(b for b in _TICKS if span <= 8.0 * b)))
        if own:
            axes[0].figure.align_ylabels(list(axes))
        axes[-1].set_xlabel(label("time" if angle is None else angle_text, unit))
        return finish(axes[0].figure, path)


def _checked(history: History, quantity: Any) -> str:
    name = str(getattr(quantity, "value", quantity))
    if name not in QUANTITIES or name == "time":
        known = ", ".join(sorted(set(QUANTITIES) - {"time"}))
        raise InputError(f"plot_traces: quantities must be scalars of a history, got {quantity!r}; known are {known}.")
    if not np.isfinite(getattr(history, name)).any():
        raise InputError(
            f"plot_traces: this film has no {QUANTITIES[name][0]}, the history holds nan throughout; name other quantities."
        )
    return name
