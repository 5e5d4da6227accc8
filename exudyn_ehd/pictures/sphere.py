"""A patch of a sphere as seen along its axis: the angle about it around, the colatitude outwards."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes

from exudyn_ehd.pictures.records import Target
from exudyn_ehd.pictures.style import COLUMN, finish, headed, open_axes, style_ticks, styled
from exudyn_ehd.pictures.units import label, shown, unit_for
from exudyn_ehd.status import InputError


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
    if ax is not None and ax.name != "polar":
        raise InputError(
            f"plot_pressure: ax must be polar, got {ax.name} axes; use subplots(subplot_kw={{'projection': 'polar'}})."
        )
    unit = unit_for("pressure", pressure)
    ring = np.concatenate([phi, [2.0 * math.pi]])
    values = unit(np.concatenate([pressure, pressure[:1]]))
    if chi[0] < chi[1] - chi[0]:
        # closed at the pole, half an interval from the first row
        values = np.column_stack([np.full(len(ring), values[:-1, 0].mean()), values])
        chi = np.concatenate([[0.0], chi])
    with styled():
        figure, ax = open_axes(ax, (COLUMN, 0.95 * COLUMN), path, projection="polar")
        image = ax.contourf(ring, np.degrees(chi), values.T, levels=24, cmap="viridis")
        ax.set_rlim(0.0, math.degrees(chi[-1]))
        ax.set_rgrids([k for k in range(30, 180, 30) if chi[0] < math.radians(k) < chi[-1]], fmt="%d°", color="white")
        # across from the peak
        column = np.unravel_index(pressure.argmax(), pressure.shape)[0]
        ax.set_rlabel_position(math.degrees(phi[column]) + 157.5)
        ax.grid(True, lw=0.4, color="#D0D0D0")
        bar = figure.colorbar(image, ax=ax, label=label("pressure", unit), pad=0.12, shrink=0.8)
        style_ticks(bar.ax)
        ax.set_title(headed(title, f"peak pressure {shown('pressure', float(pressure.max()))}"))
        return finish(figure, path)
