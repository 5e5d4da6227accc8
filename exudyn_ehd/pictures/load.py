"""Polar diagram of the load that the journal puts on the bush."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from exudyn_ehd.pictures.data import History
from exudyn_ehd.pictures.style import BLUE, COLUMN, finish, open_axes, styled
from exudyn_ehd.pictures.units import unit_for
from exudyn_ehd.status import InputError

SIZE = (COLUMN, 1.15 * COLUMN)


def plot_load(history: History, *, text: str = "", ax: Any = None, path: Any = None) -> Any:
    """Draw the tip of the load vector of the journal on the bush, the opposite of ``history.force``, in the housing's joint frame.

    Parameters
    ----------
    history : History
    text : str
        Name in the legend.
    ax : matplotlib PolarAxes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    InputError
        If ``ax`` is not polar.
    """
    if ax is not None and ax.name != "polar":
        raise InputError(
            f"plot_load: ax must be polar, got {ax.name} axes; use subplots(subplot_kw={{'projection': 'polar'}})."
        )
    load = -history.force[:, :2]
    size = np.hypot(load[:, 0], load[:, 1])
    unit = unit_for("force", size)
    with styled():
        own = ax is None
        figure, ax = open_axes(ax, SIZE, projection="polar")
        angle = np.arctan2(load[:, 1], load[:, 0])
        (line,) = ax.plot(angle, unit(size), color=BLUE if own else None, label=text or "load on the bush")
        if size.size:
            ax.plot(
                angle[:1], unit(size[:1]), "o", mfc="white", mec=line.get_color(), label="start" if own else "_start"
            )
            ax.plot(angle[-1:], unit(size[-1:]), "o", color=line.get_color(), label="end" if own else "_end")
        ax.set_rlim(bottom=0.0)
        ax.yaxis.set_major_locator(MaxNLocator(4))
        ax.set_rlabel_position(_freest(angle))
        ax.set_title(f"load of the journal on the bush [{unit.symbol}]")
        ax.grid(True, lw=0.4, color="#D0D0D0")
        if own:
            figure.legend(loc="outside lower center", ncols=3)
        elif text:
            ax.legend()
        return finish(figure, path)


def _freest(angle: np.ndarray) -> float:
    """Angle between two labelled rays, in degrees, where the fewest of the angles (rad) lie: for the radial labels."""
    count, _ = np.histogram(np.mod(angle, 2.0 * np.pi), bins=8, range=(0.0, 2.0 * np.pi))
    return 22.5 + 45.0 * int(np.argmin(count))
