"""The ``plot_...`` methods of what is or has a film or a history. Matplotlib is imported when something is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import Any, cast

import numpy as np

from exudyn_ehd.pictures.records import Axes, Figure, FilmRecord, HistoryRecord, PolarAxes, Target


def _title_of(item: object) -> str:
    """Name of a joint, which is the title of its pictures; empty for anything else."""
    return getattr(item, "name", "")


class FilmPictures:
    """Pictures of a film at one instant; mixed into a `pictures.records.FilmRecord`, or into what has one by `_film`.

    Every method draws into ``ax`` if given (a matplotlib Axes, so that pictures can be combined) or into a figure of
    its own, which ``plt.show()`` shows, writes it to ``path`` if given, and returns the figure.
    """

    def plot_pressure(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of the pressure, with the boundary of the unbroken film and the housing's supply areas.

        The angle from x about z [degrees] runs to the right, z [mm] upwards. It draws into ``ax``, a matplotlib Axes,
        or a figure of its own, writes it to ``path`` if given, and returns the figure. An `InputError` says so if the
        film has no such field.
        """
        return self._map("pressure", ax, path)

    def plot_gap(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of the gap, as `plot_pressure`."""
        return self._map("gap", ax, path)

    def plot_fill(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of the film fraction of a mass-conserving film, as `plot_pressure`."""
        return self._map("fill", ax, path)

    def plot_temperature(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of the film's temperature, as `plot_pressure`."""
        return self._map("temperature", ax, path)

    def plot_contact_pressure(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of the pressure of asperities or wall, as `plot_pressure`; for films of joints only."""
        return self._map("contact_pressure", ax, path)

    def plot_wear_depth(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Unrolled map of what was worn off the bore, as `plot_pressure`; for films of joints only."""
        return self._map("wear_depth", ax, path)

    def plot_bearing(
        self, *, camera: tuple[float, float] | None = None, ax: Axes | None = None, path: Target = None
    ) -> Figure:
        """The bearing in space: pressure, journal, load on the bush; ``camera`` is elevation and azimuth, degrees.

        At azimuth -90 y is upright and x to the right; by default the pressure is in view. ``ax`` (with three axes)
        and ``path`` as for `plot_pressure`.
        """
        from exudyn_ehd.pictures.bush import plot_bearing

        return plot_bearing(self._film(), camera=camera, title=_title_of(self), ax=ax, path=path)

    def _film(self) -> FilmRecord:
        """Return the film to draw."""
        return cast(FilmRecord, self)

    def _map(self, field: str, ax: Axes | None, path: Target) -> Figure:
        from exudyn_ehd.pictures import maps

        return maps.plot_map(self._film(), maps.FIELDS[field], title=_title_of(self), ax=ax, path=path)


class HistoryPictures:
    """Pictures of a history; mixed into a `pictures.records.HistoryRecord`, or into what has one by `_history`.

    See `FilmPictures`.
    """

    def plot_orbit(self, *, ends: bool = False, text: str = "", ax: Axes | None = None, path: Target = None) -> Figure:
        """Orbit of the journal in the clearance circle, with ``ends`` also at both ends; ``text`` is for a legend.

        x to the right, y upwards, joint frame. It draws into ``ax``, a matplotlib Axes, or a figure of its own, writes
        it to ``path`` if given, and returns the figure.
        """
        from exudyn_ehd.pictures.histories import plot_orbit

        return plot_orbit(self._history(), ends=ends, text=text, title=_title_of(self), ax=ax, path=path)

    def plot_load(self, *, text: str = "", ax: PolarAxes | None = None, path: Target = None) -> Figure:
        """Polar diagram of the load of the journal on the bush, in the housing's joint frame.

        The load is the opposite of ``history.force``, its angle from x about z. ``text`` is for a legend, ``ax`` must
        be polar; else as `plot_orbit`.
        """
        from exudyn_ehd.pictures.histories import plot_load

        return plot_load(self._history(), text=text, title=_title_of(self), ax=ax, path=path)

    def plot_traces(
        self, quantities: Enum | str | Sequence[Enum | str] = ("minimum_gap", "peak_pressure"), **options: Any
    ) -> Figure:
        """Quantities over time, or over an ``angle``; options: `exudyn_ehd.pictures.histories.plot_traces`.

        ``quantities`` are names of scalars in `JointHistory`, one panel each. Options: ``angle`` (n,) [rad], e.g.
        ``speed * history.time``, and its name ``angle_text``; ``text`` for a legend; ``title``; ``ax``, one Axes for
        each panel; ``path``.
        """
        from exudyn_ehd.pictures.histories import plot_traces

        return plot_traces(self._history(), quantities, **{"title": _title_of(self), **options})

    def plot_waterfall(
        self,
        quantity: Enum | str = "eccentricity",
        *,
        speed: np.ndarray | None = None,
        window: float | None = None,
        ax: Axes | None = None,
        path: Target = None,
    ) -> Figure:
        """Short-time spectra, of ``window`` seconds each, over the time or over a ``speed`` (n,) in rad/s.

        For whirl and run-ups. Colours are amplitudes of a scalar in `JointHistory`, or of x of the ``eccentricity``;
        lines are the speed, by default the journal's spin, and half of it. ``speed`` has a value for each row and must
        not turn back. ``window`` is by default a twentieth of the history. ``ax`` and ``path`` as for `plot_orbit`.
        """
        from exudyn_ehd.pictures.histories import plot_waterfall

        return plot_waterfall(
            self._history(), quantity, speed=speed, window=window, title=_title_of(self), ax=ax, path=path
        )

    def _history(self) -> HistoryRecord:
        """Return the history to draw."""
        return cast(HistoryRecord, self)
