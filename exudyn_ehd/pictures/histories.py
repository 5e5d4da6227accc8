"""Pictures of a history: orbit in the clearance circle, polar diagram of the load, quantities over time or an angle,
waterfall of short-time spectra."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator, MultipleLocator

from exudyn_ehd.pictures.curves import REACH, RPM
from exudyn_ehd.pictures.records import QUANTITIES, HistoryRecord, Target, label, unit_for
from exudyn_ehd.pictures.style import (
    BLUE,
    SKY,
    TALL,
    VERMILION,
    WIDE,
    draw_clearance,
    headed,
    new_panels,
    picture,
    style_ticks,
    styled,
    write,
)
from exudyn_ehd.status import InputError


def plot_orbit(
    history: HistoryRecord,
    *,
    ends: bool = False,
    text: str = "",
    title: str = "",
    ax: Axes | None = None,
    path: Target = None,
) -> Figure:
    """Draw the orbit of the journal's axis in the mid-plane, in the circle that a rigid aligned journal can't leave.

    Parameters
    ----------
    history : HistoryRecord
    ends : bool
        Also draw the axis at both ends of the bearing.
    text : str
        Name of the orbit in the legend; two orbits in the same ``ax`` share one circle if their clearances agree.
    title : str
        Of the figure, if it is a new one.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    InputError
        If the history has no steps.
    """
    _require_steps("plot_orbit", history)
    c = history.radial_clearance
    unit = unit_for("length", c)
    own = ax is None
    with picture(ax, TALL, path, title=title) as (figure, ax):
        draw_clearance(ax, float(unit(c)), f"clearance {unit(c):.4g} {unit.symbol}")
        e = history.eccentricity
        if ends:
            half = 0.5 * history.length
            for sign, colour in ((-1.0, SKY), (1.0, VERMILION)):
                at = unit(e + sign * half * history.motion[:, 2:4])
                ax.plot(at[:, 0], at[:, 1], lw=0.8, color=colour, label=f"at z = {'+' if sign > 0 else '-'}L/2")
        (line,) = ax.plot(*unit(e).T, color=BLUE if own else None, label=text or "mid-plane")
        ax.set(xlabel=label("x", unit), ylabel=label("y", unit), aspect="equal")
        _mark_ends(ax, unit(e), line.get_color(), None if own else text)
    return figure


def plot_load(
    history: HistoryRecord, *, text: str = "", title: str = "", ax: PolarAxes | None = None, path: Target = None
) -> Figure:
    """Draw the tip of the load of the journal on the bush, housing's joint frame: the opposite of ``history.force``.

    Parameters
    ----------
    history : HistoryRecord
    text : str
        Name in the legend.
    title : str
        Stands before what is drawn.
    ax : matplotlib PolarAxes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    InputError
        If ``ax`` is not polar, or the history has no steps.
    """
    _require_steps("plot_load", history)
    load = -history.force[:, :2]
    size = np.hypot(load[:, 0], load[:, 1])
    unit = unit_for("force", size)
    own = ax is None
    with picture(ax, TALL, path, where="plot_load", projection="polar") as (figure, ax):
        angle = np.arctan2(load[:, 1], load[:, 0])
        (line,) = ax.plot(angle, unit(size), color=BLUE if own else None, label=text or "load on the bush")
        ax.set_rlim(bottom=0.0)
        ax.yaxis.set_major_locator(MaxNLocator(4))
        # between two labelled rays, where the fewest of the angles lie
        count, _ = np.histogram(np.mod(angle, 2.0 * np.pi), bins=8, range=(0.0, 2.0 * np.pi))
        ax.set_rlabel_position(22.5 + 45.0 * int(np.argmin(count)))
        ax.set_title(headed(title, f"load of the journal on the bush [{unit.symbol}]"))
        style_ticks(ax, grid=True)
        _mark_ends(ax, np.stack([angle, unit(size)], axis=1), line.get_color(), None if own else text)
    return figure


def _mark_ends(ax: Axes, points: np.ndarray, colour: str, text: str | None) -> None:
    """Mark start and end of a curve of points (n, 2), and make the legend.

    ``text`` is its name in others' axes; None: the picture is its own, and the ends are in the legend.
    """
    hidden = "" if text is None else "_"
    if len(points):
        ax.plot(*points[:1].T, "o", mfc="white", mec=colour, label=f"{hidden}start")
        ax.plot(*points[-1:].T, "o", color=colour, label=f"{hidden}end")
    if text is None:
        ax.figure.legend(loc="outside lower center", ncols=3)
    elif text:
        ax.legend()


def plot_traces(
    history: HistoryRecord,
    quantities: Enum | str | Sequence[Enum | str] = ("minimum_gap", "peak_pressure"),
    *,
    angle: np.ndarray | None = None,
    angle_text: str = "angle",
    text: str = "",
    title: str = "",
    ax: Axes | Sequence[Axes] | np.ndarray | None = None,
    path: Target = None,
) -> Figure:
    """Draw quantities below each other over the time, or over an angle.

    Parameters
    ----------
    history : HistoryRecord
    quantities : Quantity or str, or a sequence of them
        Scalars of the history.
    angle : (n,) array, optional
        Drawn along in place of the time, rad; for instance a crank angle, ``speed * history.time``.
    angle_text : str
        What the angle is.
    text : str
        Name in the legend.
    title : str
        Of the figure, if it is a new one.
    ax : matplotlib Axes or a sequence of them, optional
        One for every quantity.
    path : path, optional

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    InputError
        For quantities that are no scalars of a history, or that the film does not provide; for histories without steps.
    """
    _require_steps("plot_traces", history)
    names = [_checked(history, q) for q in ([quantities] if isinstance(quantities, (str, Enum)) else quantities)]
    given = None if ax is None else np.ravel(np.asarray(ax, dtype=object))
    if not names or (given is not None and given.size != len(names)):
        raise InputError(f"plot_traces: ax must be as many axes as quantities ({len(names)}, at least 1), got {ax!r}.")
    if angle is not None and np.shape(angle) != history.time.shape:
        raise InputError(
            f"plot_traces: angle must have shape {history.time.shape} as history.time, got {np.shape(angle)}."
        )
    along = history.time if angle is None else np.asarray(angle, dtype=float)
    unit = unit_for("time" if angle is None else "angle", along)
    with styled():
        size = WIDE[0], 1.35 * (len(names) + 0.5)
        panels = new_panels(len(names), size, path, title) if given is None else given
        figure = panels[0].figure
        for panel, name in zip(panels, names, strict=True):
            words, kind = QUANTITIES[name]
            shown = unit_for(kind, getattr(history, name))
            values = shown(getattr(history, name))
            panel.plot(unit(along), values, label=text or None)
            panel.set_ylabel(label(words, shown))
            if kind in ("length", "ratio"):
                # also of curves that were there before
                highest = max(panel.get_ylim()[1], 1.08 * float(np.nanmax(values)), 0.0)
                panel.set_ylim(min(0.0, 1.08 * panel.dataLim.y0), highest)
            if text:
                panel.legend()
        if angle is not None:
            # at most nine ticks on fractions or multiples of a turn, degrees
            distances = [15.0, 30.0, *(45.0 * 2.0**k for k in range(40))]
            widest = float(np.ptp(unit(along))) / 8.0
            panels[-1].xaxis.set_major_locator(MultipleLocator(next(b for b in distances if b >= widest)))
        panels[-1].set_xlabel(label("time" if angle is None else angle_text, unit))
        write(figure, path)
    return figure


def spectra(
    history: HistoryRecord, quantity: Enum | str = "eccentricity", *, window: float | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Amplitude spectra of a quantity over short windows (Hann) that run along the history.

    Parameters
    ----------
    history : HistoryRecord
        With all its steps; unequal ones are interpolated to their mean.
    quantity : Quantity or str
        Scalar of the history, or ``eccentricity`` for its x.
    window : float, optional
        Duration of one window, s; by default a twentieth of the history. Frequencies closer than 2 / window are one
        peak.

    Returns
    -------
    frequency : (n,) array
        Hz.
    time : (k,) array
        Middle of each window, s.
    amplitude : (n, k) array
        In the SI unit of the quantity; a sine of amplitude A has a peak of A.

    Raises
    ------
    InputError
        For a quantity that `plot_traces` does not take either, and for a window below 16 steps or beyond the history.
    """
    # imported here: other pictures do without it
    from scipy import signal

    _require_steps("plot_waterfall", history)
    of_place = str(getattr(quantity, "value", quantity)) == "eccentricity"
    values = history.eccentricity[:, 0] if of_place else getattr(history, _checked(history, quantity, "plot_waterfall"))
    duration, steps = float(np.ptp(history.time)) or 1.0, history.time.size - 1
    count = round(0.05 * steps if window is None else window / duration * steps)
    if not 16 <= count <= steps:
        raise InputError(
            f"plot_waterfall: window must hold at least 16 of the history's {steps} steps, which take "
            f"{duration:.4g} s, got {count} steps{'' if window is None else f' in {window!r} s'}."
        )
    frequency, time, amplitude = signal.spectrogram(
        np.interp(np.linspace(history.time[0], history.time[-1], steps + 1), history.time, values),
        steps / duration,
        window="hann",
        nperseg=count,
        noverlap=count - round(count / 8),
        nfft=4 * count,
        detrend="linear",
        scaling="spectrum",
        mode="magnitude",
    )
    return frequency, history.time[0] + time, 2.0 * amplitude


def plot_waterfall(
    history: HistoryRecord,
    quantity: Enum | str = "eccentricity",
    *,
    speed: np.ndarray | None = None,
    window: float | None = None,
    title: str = "",
    ax: Axes | None = None,
    path: Target = None,
) -> Figure:
    """Draw the spectra of a quantity over the time, or over a speed, with lines of the speed and of half of it.

    Parameters
    ----------
    history : HistoryRecord
        With all its steps.
    quantity : Quantity or str
        Scalar of the history; by default x of the journal's axis in the mid-plane.
    speed : (n,) array, optional
        Drawn along in place of the time, rad/s at ``history.time``: of the shaft, or ``history.motion[:, 8]``, the
        journal's spin against the housing, whose lines are drawn over the time. It may not turn back.
    window : float, optional
        Duration of one spectrum, s; see `spectra`.
    title : str
        Of the figure, if it is a new one.
    ax : matplotlib Axes, optional
    path : path, optional

    Returns
    -------
    matplotlib Figure
        Colours are amplitudes, down to a thousandth of the largest.

    Raises
    ------
    InputError
        As `spectra`, and for a speed of another shape or one that turns back.
    """
    frequency, time, amplitude = spectra(history, quantity, window=window)
    spin = np.abs(history.motion[:, 8] if speed is None else np.asarray(speed, dtype=float))
    at = np.interp(time, history.time, spin) if spin.shape == history.time.shape else np.zeros(0)
    if at.size != time.size or (speed is not None and abs(np.sign(np.diff(at)).sum()) < time.size - 1):
        raise InputError(
            f"plot_waterfall: speed must have shape {history.time.shape} as history.time and rise, or fall, "
            f"throughout, got shape {spin.shape}; leave it out for spectra over the time."
        )
    below = frequency <= (REACH * at.max() / (2.0 * np.pi) or np.inf)
    words, kind = QUANTITIES.get(str(getattr(quantity, "value", quantity)), ("x of the journal", "length"))
    largest = float(amplitude[below].max()) or 1.0
    unit, along = unit_for(kind, largest), unit_for("time", time) if speed is None else RPM
    # amplitudes of a temperature without its offset
    across, shown = along(time if speed is None else at), unit.factor * np.maximum(amplitude[below].T, 1e-3 * largest)
    with picture(ax, WIDE, path, title=title) as (figure, ax):
        colours = ax.pcolormesh(frequency[below], across, shown, norm=LogNorm(), shading="nearest", rasterized=True)
        for order, style in ((1.0, ":"), (0.5, "--")):
            ax.plot(order * at / (2.0 * np.pi), across, style, color="white", label=f"{order:g} x speed")
        ax.set(xlabel="frequency [Hz]", ylabel=label("time" if speed is None else "speed", along))
        ax.legend(loc="lower right", labelcolor="white")
        style_ticks(figure.colorbar(colours, ax=ax, label=label(f"amplitude: {words}".replace("\n", " "), unit)).ax)
    return figure


def _require_steps(where: str, history: HistoryRecord) -> None:
    if history.time.size == 0:
        raise InputError(f"{where}: the history has no steps; run a solver first.")


def _checked(history: HistoryRecord, quantity: Enum | str, where: str = "plot_traces") -> str:
    name = str(getattr(quantity, "value", quantity))
    if name not in QUANTITIES or name == "time":
        known = ", ".join(sorted(set(QUANTITIES) - {"time"}))
        raise InputError(f"{where}: quantities must be scalars of a history, got {quantity!r}; known are {known}.")
    if not np.isfinite(getattr(history, name)).any():
        raise InputError(
            f"{where}: this film has no {QUANTITIES[name][0]}, the history holds nan throughout; name other quantities."
        )
    return name
