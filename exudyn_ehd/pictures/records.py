"""Data of the pictures: a film on its grid, the film of a joint, and a history. Any object with these attributes can be
drawn. A quantity is shown in the usual unit of its size, with its factor from SI.
"""

from __future__ import annotations

import pathlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from matplotlib import axes, figure
    from matplotlib.projections import polar

    from exudyn_ehd.bearing import JournalBearing
    from exudyn_ehd.film.heat.options import Walls

Target = str | pathlib.Path | None
"""File that a picture is written to; None: it is not written."""
Axes: TypeAlias = "axes.Axes"
PolarAxes: TypeAlias = "polar.PolarAxes"
Figure: TypeAlias = "figure.Figure"
"""Types of matplotlib, for modules that must not import it."""


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
