"""Data of the pictures: a film on its grid, the film of a joint, and a history. Any object with these attributes can be
drawn. A quantity is shown in the usual unit of its size, with its factor from SI.

The ``plot_...`` methods of what is or has a film or a history import matplotlib when something is drawn.
"""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from enum import Enum

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from exudyn_ehd.bearing import JournalBearing
    from exudyn_ehd.film.heat.options import Walls

Target = str | pathlib.Path | None
"""File that a picture is written to; None: it is not written."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmRecord:
    """A film at one instant; joint frame, SI units, arrays ``[theta, z]``.

    Attributes
    ----------
    theta, z : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (n, m) arrays
        Pa (gauge), m.
    unbroken : (n, m) bool array
        True where the film is not cavitated.
    fill : (n, m) array or None
        Film fraction; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        K; None for an isothermal bearing.
    walls : Walls or None
        Temperatures of bush and journal, and the clearance that they leave; None where none conducts and
        the film has one temperature across it.
    bore_displacement : (n, m) array or None
        Deflection of a flexible bore or a liner, m, positive outward; None for a rigid one.
    force, moment : (3,) arrays
        On the journal, moment about the joint origin.
    bearing : JournalBearing
    motion : (10,) array
        Motion of the journal, as in `exudyn_ehd.joint.solved_film`; with a flexible bore its coordinates and rates
        follow.
    """

    theta: np.ndarray
    z: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray | None
    temperature: float | np.ndarray | None
    bore_displacement: np.ndarray | None
    force: np.ndarray
    moment: np.ndarray
    bearing: JournalBearing = field(repr=False)
    motion: np.ndarray = field(repr=False)
    walls: Walls | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class JointFilm(FilmRecord):
    """The film of a joint at one instant of a run.

    Attributes
    ----------
    time : float
        s.
    contact_pressure : (n, m) array or None
        Pressure of asperities or wall, Pa; None without contact.
    wear_depth : (n, m) array or None
        Worn off the bore up to this instant, m; None without wear.
    bush_displacement : (k, 3) array or None
        Displacements of all nodes of a bush's mesh against the housing, joint frame, m; None without a bush.
    """

    time: float
    contact_pressure: np.ndarray | None
    wear_depth: np.ndarray | None
    bush_displacement: np.ndarray | None = None


@dataclass(frozen=True, kw_only=True)
class HistoryRecord:
    """Accepted steps of a joint and the bearing's dimensions; joint frame, SI units.

    Attributes
    ----------
    time : ndarray (n,)
        [s]
    motion : ndarray (n, 10)
        As in `exudyn_ehd.joint.solved_film`.
    eccentricity : ndarray (n, 2)
        Journal axis in the mid-plane [m].
    force : ndarray (n, 3)
        On the journal [N].
    radial_clearance, length : float
        Dimensions of the bearing [m].
    """

    time: np.ndarray
    motion: np.ndarray
    eccentricity: np.ndarray
    force: np.ndarray
    radial_clearance: float
    length: float


@dataclass(frozen=True)
class Unit:
    """A unit for the eye.

    Parameters
    ----------
    symbol : str
    factor, offset : float
        Shown value = factor x SI value + offset.
    """

    symbol: str
    factor: float = 1.0
    offset: float = 0.0

    def __call__(self, values: np.ndarray | float) -> np.ndarray:
        """Values in this unit."""
        return np.asarray(values) * self.factor + self.offset


# Kind: units with the magnitude (SI) from which they are used, largest first.
_UNITS: dict[str, tuple[tuple[float, Unit], ...]] = {
    "pressure": ((1e5, Unit("MPa", 1e-6)), (1e2, Unit("kPa", 1e-3)), (0.0, Unit("Pa"))),
    "length": ((1e-3, Unit("mm", 1e3)), (0.0, Unit("µm", 1e6))),
    "depth": ((1e-3, Unit("mm", 1e3)), (1e-7, Unit("µm", 1e6)), (0.0, Unit("nm", 1e9))),
    "angle": ((0.0, Unit("°", 180.0 / np.pi)),),
    "time": ((1.0, Unit("s")), (1e-3, Unit("ms", 1e3)), (0.0, Unit("µs", 1e6))),
    "force": ((2e3, Unit("kN", 1e-3)), (0.1, Unit("N")), (0.0, Unit("mN", 1e3))),
    "torque": ((0.5, Unit("N m")), (0.0, Unit("mN m", 1e3))),
    "power": ((1e4, Unit("kW", 1e-3)), (0.5, Unit("W")), (0.0, Unit("mW", 1e3))),
    "flow": ((1e-7, Unit("cm³/s", 1e6)), (0.0, Unit("mm³/s", 1e9))),
    "temperature": ((0.0, Unit("°C", 1.0, -273.15)),),
    "stress": ((0.0, Unit("MPa", 1e-6)),),
    "ratio": ((0.0, Unit("-")),),
    "volume": ((0.0, Unit("mm³", 1e9)),),
}
# Kinds of columns by their SI unit.
KINDS = {
    "m": "length",
    "rad": "angle",
    "s": "time",
    "Pa": "pressure",
    "N": "force",
    "N m": "torque",
    "W": "power",
    "m3/s": "flow",
    "K": "temperature",
    "m3": "volume",
}
# Name of a quantity: what is written on an axis, in lines as long as a panel is high, and its kind.
QUANTITIES: dict[str, tuple[str, str]] = {
    "time": ("time", "time"),
    "eccentricity_ratio": ("eccentricity ratio", "ratio"),
    "largest_eccentricity_ratio": ("largest eccentricity\nratio", "ratio"),
    "minimum_gap": ("minimum film\nthickness", "length"),
    "peak_pressure": ("peak pressure", "pressure"),
    "friction_torque": ("friction torque", "torque"),
    "power_loss": ("power loss", "power"),
    "stored_power": ("stored power", "power"),
    "step_error": ("error of the\ntime steps", "ratio"),
    "leakage": ("leakage", "flow"),
    "contact_load": ("contact load", "force"),
    "contact_torque": ("contact torque", "torque"),
    "axial_position": ("axial position", "length"),
    "thrust_force": ("thrust force", "force"),
    "thrust_minimum_gap": ("minimum film\nthickness, faces", "length"),
    "thrust_peak_pressure": ("peak pressure,\nfaces", "pressure"),
    "thrust_torque": ("thrust torque", "torque"),
    "thrust_power_loss": ("power loss,\nfaces", "power"),
    "thrust_contact_load": ("contact load,\nfaces", "force"),
    "supply_flow": ("supply flow", "flow"),
    "lowest_pocket_pressure": ("lowest pocket\npressure", "pressure"),
    "highest_pocket_pressure": ("highest pocket\npressure", "pressure"),
    "film_temperature": ("film temperature", "temperature"),
    "peak_temperature": ("peak temperature", "temperature"),
    "sump_temperature": ("sump temperature", "temperature"),
    "bush_temperature": ("bush temperature", "temperature"),
    "journal_temperature": ("journal temperature", "temperature"),
    "clearance": ("radial clearance", "length"),
    "wear_depth": ("wear depth", "depth"),
    "worn_volume": ("worn volume", "volume"),
}


def unit_for(kind: str, values: np.ndarray | float) -> Unit:
    """The unit in which values (SI) of a kind are shown: the largest that leaves their greatest magnitude readable."""
    finite = np.abs(np.asarray(values, dtype=float))
    finite = finite[np.isfinite(finite)]
    largest = float(finite.max()) if finite.size else 0.0
    # 0.0 stands for everything smaller; a quantity that is zero throughout gets the first unit
    units = _UNITS[kind]
    if largest == 0.0:
        return units[0][1]
    return next(unit for limit, unit in units if largest >= limit)


def shown(kind: str, value: float) -> str:
    """A value (SI) with its unit, three digits."""
    unit = unit_for(kind, value)
    return f"{float(unit(value)):.3g} {unit.symbol}"


def label(text: str, unit: Unit) -> str:
    """Axis label: text [unit]."""
    return f"{text} [{unit.symbol}]"


class Titled:
    """Objects that may have a name, which is the title of their pictures."""

    def _title(self) -> str:
        return ""


class FilmPictures(Titled):
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

        return plot_bearing(self._film(), camera=camera, title=self._title(), ax=ax, path=path)

    def _film(self) -> FilmRecord:
        """Return the film to draw."""
        return cast(FilmRecord, self)

    def _map(self, field: str, ax: Axes | None, path: Target) -> Figure:
        from exudyn_ehd.pictures import maps

        return maps.plot_map(self._film(), maps.FIELDS[field], title=self._title(), ax=ax, path=path)


class HistoryPictures(Titled):
    """Pictures of a history; mixed into a `pictures.records.HistoryRecord`, or into what has one by `_history`.

    See `FilmPictures`.
    """

    def plot_orbit(self, *, ends: bool = False, text: str = "", ax: Axes | None = None, path: Target = None) -> Figure:
        """Orbit of the journal in the clearance circle, with ``ends`` also at both ends; ``text`` is for a legend.

        x to the right, y upwards, joint frame. It draws into ``ax``, a matplotlib Axes, or a figure of its own, writes
        it to ``path`` if given, and returns the figure.
        """
        from exudyn_ehd.pictures.histories import plot_orbit

        return plot_orbit(self._history(), ends=ends, text=text, title=self._title(), ax=ax, path=path)

    def plot_load(self, *, text: str = "", ax: PolarAxes | None = None, path: Target = None) -> Figure:
        """Polar diagram of the load of the journal on the bush, in the housing's joint frame.

        The load is the opposite of ``history.force``, its angle from x about z. ``text`` is for a legend, ``ax`` must
        be polar; else as `plot_orbit`.
        """
        from exudyn_ehd.pictures.histories import plot_load

        return plot_load(self._history(), text=text, title=self._title(), ax=ax, path=path)

    def plot_traces(
        self, quantities: Enum | str | Sequence[Enum | str] = ("minimum_gap", "peak_pressure"), **options: Any
    ) -> Figure:
        """Quantities over time, or over an ``angle``; options: `exudyn_ehd.pictures.histories.plot_traces`.

        ``quantities`` are names of scalars in `JointHistory`, one panel each. Options: ``angle`` (n,) [rad], e.g.
        ``speed * history.time``, and its name ``angle_text``; ``text`` for a legend; ``title``; ``ax``, one Axes for
        each panel; ``path``.
        """
        from exudyn_ehd.pictures.histories import plot_traces

        return plot_traces(self._history(), quantities, **{"title": self._title(), **options})

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
            self._history(), quantity, speed=speed, window=window, title=self._title(), ax=ax, path=path
        )

    def _history(self) -> HistoryRecord:
        """Return the history to draw."""
        return cast(HistoryRecord, self)
