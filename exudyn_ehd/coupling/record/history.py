"""Record of the accepted steps of one joint."""

from __future__ import annotations

import dataclasses
import enum
import itertools
import math
import pathlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_ehd.coupling.record.revolutions import Revolutions, revolutions
from exudyn_ehd.film.heat.options import FilmEnergy
from exudyn_ehd.joint.audit.samples import RecordedSteps
from exudyn_ehd.joint.step_error import BALL, LOAD_COLUMNS, FilmLoad, recorded_entries
from exudyn_ehd.pictures.mixins import HistoryPictures
from exudyn_ehd.pictures.records import HistoryRecord, shown
from exudyn_ehd.status import ROUNDING, InputError, did_you_mean
from exudyn_ehd.storage import replacing, require_path
from exudyn_ehd.tables import data_frame, write_csv

if TYPE_CHECKING:
    from pandas import DataFrame

FORMAT = "exudyn_ehd JointHistory 7"
DIMENSIONS = ("radial_clearance", "journal_radius", "length")
_PARTS = {
    "motion": ("x", "y", "bx", "by", "x_t", "y_t", "bx_t", "by_t", "omega", "w"),
    "eccentricity": ("x", "y"),
    "force": ("force_x", "force_y", "force_z"),
    "moment": ("moment_x", "moment_y", "moment_z"),
}
_MOTION_UNITS = ("m", "m", "rad", "rad", "m/s", "m/s", "rad/s", "rad/s", "rad/s", "m/s")


class Quantity(enum.Enum):
    """Names of quantities that a sensor can record; their values are the names in `JointHistory`.

    An alternative to the names as text, for `LubricatedJoint.AddSensor` and the plot methods. Units and signs:
    `JointHistory`.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> sensor = joint.AddSensor(ehd.Quantity.PEAK_PRESSURE)
    >>> ehd.Quantity("force").name
    'FORCE'
    """

    MOTION = "motion"
    ECCENTRICITY = "eccentricity"
    ECCENTRICITY_RATIO = "eccentricity_ratio"
    LARGEST_ECCENTRICITY_RATIO = "largest_eccentricity_ratio"
    FORCE = "force"
    MOMENT = "moment"
    MINIMUM_GAP = "minimum_gap"
    PEAK_PRESSURE = "peak_pressure"
    FRICTION_TORQUE = "friction_torque"
    POWER_LOSS = "power_loss"
    LEAKAGE = "leakage"
    CONTACT_LOAD = "contact_load"
    CONTACT_TORQUE = "contact_torque"
    SUPPLY_FLOW = "supply_flow"
    LOWEST_POCKET_PRESSURE = "lowest_pocket_pressure"
    HIGHEST_POCKET_PRESSURE = "highest_pocket_pressure"
    FILM_TEMPERATURE = "film_temperature"
    PEAK_TEMPERATURE = "peak_temperature"
    SUMP_TEMPERATURE = "sump_temperature"
    MINIMUM_GAP_ANGLE = "minimum_gap_angle"
    MINIMUM_GAP_Z = "minimum_gap_z"
    PEAK_ANGLE = "peak_angle"
    BORE_DISPLACEMENT = "bore_displacement"
    STORED_POWER = "stored_power"
    BUSH_TEMPERATURE = "bush_temperature"
    JOURNAL_TEMPERATURE = "journal_temperature"
    CLEARANCE = "clearance"
    AXIAL_POSITION = "axial_position"
    THRUST_FORCE = "thrust_force"
    THRUST_MINIMUM_GAP = "thrust_minimum_gap"
    THRUST_PEAK_PRESSURE = "thrust_peak_pressure"
    THRUST_TORQUE = "thrust_torque"
    THRUST_POWER_LOSS = "thrust_power_loss"
    THRUST_CONTACT_LOAD = "thrust_contact_load"
    WEAR_DEPTH = "wear_depth"
    WORN_VOLUME = "worn_volume"


QUANTITIES = tuple(member.value for member in Quantity)
# Scalar quantities of the film: those behind motion, eccentricities and loads.
_SCALARS = QUANTITIES[QUANTITIES.index("minimum_gap") :]
# Columns that are written as text.
_NAMES = ("time", *QUANTITIES, "step_error")
# Numbers in a row: quantities, the tangent's entries, most of them of a ball, and the load on the film, then those of a
# row that is settled.
_SIZES = {name: len(_PARTS.get(name, [name])) for name in ("time", *QUANTITIES)}
_SIZES |= {"tangent": len(recorded_entries(BALL)[0]), "load": sum(LOAD_COLUMNS), "step_count": 1, "step_error": 1}
_PLACES = {
    name: slice(end - size, end)
    for (name, size), end in zip(_SIZES.items(), itertools.accumulate(_SIZES.values()), strict=True)
}
TANGENT, LOAD, FORCE = (_PLACES[name] for name in ("tangent", "load", "force"))
WIDTH = LOAD.stop
SETTLED_WIDTH = sum(_SIZES.values())
TIME, MINIMUM_GAP, PEAK_PRESSURE, STEP_COUNT, STEP_ERROR = (
    _PLACES[name].start for name in ("time", "minimum_gap", "peak_pressure", "step_count", "step_error")
)
COLUMNS: dict[str, int | slice] = {
    name: _PLACES[name] if _SIZES[name] > 1 else _PLACES[name].start for name in (*_NAMES, "step_count")
}


@dataclasses.dataclass(frozen=True, kw_only=True)
class JointHistory(RecordedSteps, HistoryRecord, HistoryPictures):
    """Accepted steps of one joint, first the initial state, last the state now; an array for each quantity.

    `exudyn_ehd/API.md` has the columns below as a table, with those of ball joints and of tables of revolutions.

    All vectors are in the joint frame (fixed in the housing, origin on the bearing's mid-plane, z = axis). Forces act
    on the journal. A quantity that the film does not provide is nan.

    Attributes
    ----------
    time : (n,) [s]
        Time at the end of the step. In a static solve Exudyn's load parameter.
    motion : (n, 10) [m, rad, m/s, rad/s]
        Motion of the journal against the housing: x, y, bx, by, x_t, y_t, bx_t, by_t, omega, w. At the place z along
        the bearing the journal's axis is at (x + bx z, y + by z): x and y in m, the slopes bx and by in rad. x_t to
        by_t, m/s and rad/s, are the rates of these four that the film takes (`exudyn_ehd.joint.time_step`); omega,
        rad/s, is the spin about z, w, m/s, the velocity along z.
    eccentricity : (n, 2) [m]
        Position of the journal's axis in the mid-plane. Along x and y from the bore's axis, the first two of
        ``motion``.
    eccentricity_ratio : (n,) [-]
        Distance of the journal axis from the bore's in the mid-plane, over the radial clearance. From 0; 1
        where rigid, round surfaces touch.
    largest_eccentricity_ratio : (n,) [-]
        The larger of the eccentricity ratios at the two ends of the bearing. From 0, as ``eccentricity_ratio``.
    force : (n, 3) [N]
        Force of film and contact. On the journal, along x, y, z; without the films on the end faces.
    moment : (n, 3) [N m]
        Moment of film and contact. On the journal, about the frame's origin, along x, y, z; without the films on the
        end faces. Its z part is the sum of ``friction_torque`` and the moment of ``force`` about the origin.
    minimum_gap : (n,) [m]
        Minimum film thickness over the whole bearing, its edges included. Above 0; in contact,
        the distance of the surfaces as if nothing were flattened, which may be below 0.
    peak_pressure : (n,) [Pa]
        Highest film pressure. Above ambient; without contact pressure; nan with an `ImpedanceMap`.
    friction_torque : (n,) [N m]
        Torque of the film's shear and of contact on the journal about its own axis. Negative where it brakes a spin in
        the positive sense about z.
    power_loss : (n,) [W]
        Mechanical power that turns into heat in film and contact or pumps oil. Positive: taken from the motion; without
        ``stored_power`` and without the films on the end faces.
    leakage : (n,) [m3/s]
        Oil that leaves through both ends together. Positive outwards; nan with an `ImpedanceMap`.
    contact_load : (n,) [N]
        Force that touching surfaces carry: the size of the vector sum of their pressure. From 0, a part of ``force``.
    contact_torque : (n,) [N m]
        Torque of the friction of touching surfaces on the journal about its own axis. Sign as
        ``friction_torque``, of which it is a part; nan with an `ImpedanceMap`.
    supply_flow : (n,) [m3/s]
        Oil that comes from all supply areas together, or enters an arc at its edges. Positive into the film; nan
        without ``supply`` and ``arc``; of areas that turn with the journal see `Hole`.
    lowest_pocket_pressure : (n,) [Pa]
        Lowest pressure of the supply areas with a restrictor. Above ambient; nan without a restrictor.
    highest_pocket_pressure : (n,) [Pa]
        Highest pressure of the supply areas with a restrictor. As ``lowest_pocket_pressure``.
    film_temperature : (n,) [K]
        Mean temperature of the film over its area. Absolute; nan without ``thermal``.
    peak_temperature : (n,) [K]
        Highest temperature in the film. Absolute; nan without ``thermal``.
    sump_temperature : (n,) [K]
        Temperature of the oil that enters from a `Sump`, at the start of the row's step. Absolute; nan without one.
    minimum_gap_angle : (n,) [rad]
        Angle at which the film is thinnest. From x about z, 0 to 2 pi.
    minimum_gap_z : (n,) [m]
        Place along the axis at which the film is thinnest. Along z, from -length/2 to length/2; 0 where the film is as
        thin along the whole bearing.
    peak_angle : (n,) [rad]
        Angle of the highest film pressure. From x about z, 0 to 2 pi; nan with an `ImpedanceMap`.
    bore_displacement : (n,) [m]
        Largest displacement of the surface of a liner or of a flexible bore. Size, from 0; nan between rigid surfaces.
    stored_power : (n,) [W]
        Power that a liner and touching surfaces take up as elastic energy. Negative where they give it back; not in
        ``power_loss``.
    bush_temperature : (n,) [K]
        Mean temperature of the bore's surface, of walls that conduct (`Conduction`) at the start of the row's step.
        Absolute; nan unless a wall conducts or the film has two temperatures across it.
    journal_temperature : (n,) [K]
        Mean temperature of the journal's surface. As ``bush_temperature``.
    clearance : (n,) [m]
        Radial clearance with the thermal growth of the walls. Below the cold one where the journal grows more; nan as
        ``bush_temperature``.
    axial_position : (n,) [m]
        Place of the journal along the axis between the faces of ``thrust``. Along z, 0 in the middle; nan without
        ``thrust``, as all that follow up to ``thrust_contact_load``.
    thrust_force : (n,) [N]
        Axial force of the films on the end faces. On the journal, along z; not in ``force``.
    thrust_minimum_gap : (n,) [m]
        Minimum film thickness on the end faces. As ``minimum_gap``.
    thrust_peak_pressure : (n,) [Pa]
        Highest film pressure on the end faces. Above ambient.
    thrust_torque : (n,) [N m]
        Torque of the films on the end faces. On the journal about z: negative where it brakes a spin in the positive
        sense; not in ``moment`` or ``friction_torque``.
    thrust_power_loss : (n,) [W]
        Power that turns into heat or pumps oil on the end faces. Positive: taken from the motion; not in
        ``power_loss``.
    thrust_contact_load : (n,) [N]
        Sum of the loads that the end faces carry by contact. From 0, a part of ``thrust_force``.
    wear_depth : (n,) [m]
        Largest depth worn off the bore since the start. From 0; nan without ``wear``.
    worn_volume : (n,) [m3]
        Volume worn off the bore since the start. As ``wear_depth``.
    step_error : (n,) [-]
        Estimated error of the gap that the time steps have made, over the minimum film thickness of the step. From 0;
        of implicit solvers, from the third step on, else nan (`exudyn_ehd.joint.step_error`).
    step_count : (n,) [-]
        Number of the accepted step. 0 for the initial state; it has gaps where the record was thinned (`Every`,
        `Period`): the first, last and worst steps are there, and ``step_error`` is the largest since the row before.
    radial_clearance, journal_radius, length : float
        Dimensions of the bearing [m].

    Notes
    -----
    An array is made when it is first used, and kept; that of a `File` is read at that moment.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> history = joint.history
    >>> history.time.shape, history.force.shape
    ((21,), (21, 3))
    >>> round(float(1e-6 * history.peak_pressure.max()), 2)  # MPa
    1.17
    >>> history.save("main.npz")
    """

    eccentricity_ratio: np.ndarray
    largest_eccentricity_ratio: np.ndarray
    moment: np.ndarray
    friction_torque: np.ndarray
    contact_torque: np.ndarray
    supply_flow: np.ndarray
    lowest_pocket_pressure: np.ndarray
    highest_pocket_pressure: np.ndarray
    peak_temperature: np.ndarray
    sump_temperature: np.ndarray
    minimum_gap_angle: np.ndarray
    minimum_gap_z: np.ndarray
    peak_angle: np.ndarray
    stored_power: np.ndarray
    clearance: np.ndarray
    axial_position: np.ndarray
    thrust_force: np.ndarray
    thrust_minimum_gap: np.ndarray
    thrust_peak_pressure: np.ndarray
    thrust_torque: np.ndarray
    thrust_contact_load: np.ndarray
    wear_depth: np.ndarray
    worn_volume: np.ndarray
    step_count: np.ndarray
    journal_radius: float

    def __getattr__(self, name: str) -> Any:
        column = self.__dict__.get("_column")
        if column is None or name not in COLUMNS:
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}"
                + (f"; did you mean {meant!r}?" if (meant := did_you_mean(name, COLUMNS)) else "")
            )
        self.__dict__[name] = values = column(name)
        return values

    def __getstate__(self) -> dict[str, Any]:
        # what is sent to other processes is read here
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    @classmethod
    def of_columns(cls, column: Callable[[str], np.ndarray], dimensions: Mapping[str, float]) -> JointHistory:
        """A history whose columns, by the names `COLUMNS`, are made when they are asked for."""
        history = object.__new__(cls)
        history.__dict__.update(dimensions, _column=column)
        return history

    @property
    def is_thinned(self) -> bool:
        """Return whether accepted steps are missing between the rows, as with `Every` and `Period`."""
        return has_gaps(self.step_count)

    def __repr__(self) -> str:
        if not self.time.size:
            return "<JointHistory without steps: run a solver first>"
        # of all films, those on end faces included
        gap = float(np.fmin(self.minimum_gap, self.thrust_minimum_gap).min())
        peak = float(np.fmax(self.peak_pressure, self.thrust_peak_pressure).max())
        steps = f"{self.step_count[-1] - self.step_count[0] + 1} steps"
        steps += f" in {self.time.size} rows" if self.is_thinned else ""
        steps = "the initial state, without a run," if self.step_count[-1] == 0 else steps
        return (
            f"<JointHistory of {steps} from {self.time[0]:.6g} to {self.time[-1]:.6g} s: "
            f"minimum film thickness {shown('length', gap)}, peak pressure {shown('pressure', peak)}>"
        )

    def between(self, start: float = -math.inf, end: float = math.inf) -> JointHistory:
        """The steps with ``start <= time <= end``, each limit widened by a billionth of the record's length.

        Parameters
        ----------
        start, end : float, default -inf, inf
            First and last time, s.

        Returns
        -------
        JointHistory

        Raises
        ------
        InputError
            If the start lies after the end.
        """
        if not start <= end:
            raise InputError(f"JointHistory.between: start must not lie after end, got {start!r} and {end!r} s.")
        slack = ROUNDING * float(np.ptp(self.time)) if self.time.size else 0.0
        kept = (self.time >= start - slack) & (self.time <= end + slack)
        # columns of which a part is wanted are not kept
        known, column = self.__dict__, self.__dict__.get("_column")
        columns = {name: (known[name] if name in known or not column else column(name))[kept] for name in COLUMNS}
        return JointHistory(**columns, **{name: getattr(self, name) for name in DIMENSIONS})

    def save(self, path: str | pathlib.Path) -> None:
        """Write everything to a NumPy file (npz); it appears whole or not at all. `load_history` reads it.

        Parameters
        ----------
        path : path
            Ending in ``.npz``.
        """
        require_path("JointHistory.save (to_csv writes text)", path, ".npz")
        with replacing(path, binary=True) as file:
            np.savez_compressed(file, format=FORMAT, **self.__getstate__())

    def to_csv(self, path: str | pathlib.Path) -> None:
        """Write all columns as text, names and SI units in the first line; vectors by their components.

        Parameters
        ----------
        path : path
        """
        write_csv(path, self._columns(), more=dict(zip(_PARTS["motion"], _MOTION_UNITS, strict=True)))

    def to_dataframe(self) -> DataFrame:
        """The columns of `to_csv` as a pandas DataFrame; needs pandas.

        Returns
        -------
        pandas DataFrame
            SI units, a row per step.
        """
        return data_frame(self._columns())

    def _columns(self) -> dict[str, np.ndarray]:
        """Columns (n,) by name, vectors by their components."""
        columns: dict[str, np.ndarray] = {}
        for name in _NAMES:
            # the eccentricity is the motion's x and y
            columns |= dict(zip(_PARTS.get(name, [name]), np.atleast_2d(getattr(self, name).T), strict=True))
        return columns

    def revolutions(self, *, period: float | None = None) -> Revolutions:
        """Minimum film thickness and its place, peak pressure, mean loss and leakage of every whole revolution.

        Print it for a table.

        Parameters
        ----------
        period : float or None, default None
            Duration of a cycle, s, from the first row on, for journals that swing. None: rows are whole turns of the
            journal against the housing.

        Returns
        -------
        Revolutions
            A table, one row for each.

        Raises
        ------
        InputError
            If there is no whole revolution or period, or if the record is thinned (`Every`, `Period`).
        """
        if self.is_thinned:
            raise InputError(
                f"JointHistory.revolutions: the record is thinned and keeps {self.time.size} of "
                f"{np.ptp(self.step_count) + 1} states, which do not give extremes and means of a revolution; "
                "record all steps, with File(...) where memory is short."
            )
        return revolutions({name: getattr(self, name) for name in COLUMNS}, period)


def has_gaps(step_count: np.ndarray) -> bool:
    """Return whether accepted steps are missing between the rows of these numbers (n,)."""
    return bool(np.any(np.diff(step_count) > 1))


def make_row(
    time: float,
    motion: np.ndarray,
    ratios: tuple[float, float],
    wrench: np.ndarray,
    quantities: Mapping[str, float],
    tangent: np.ndarray | None = None,
    load: FilmLoad | None = None,
) -> np.ndarray:
    """One row of the record; step errors need the `recorded_entries` of the tangent and the load on the film."""
    row = np.empty(WIDTH)
    scalars = [quantities.get(name, math.nan) for name in _SCALARS]
    row[: TANGENT.start] = [time, *motion.tolist(), *motion[:2].tolist(), *ratios, *wrench.tolist(), *scalars]
    row[TANGENT.start :] = np.nan
    if tangent is not None:
        row[TANGENT][: tangent.size] = tangent
    if load is not None:
        np.concatenate(load, out=row[LOAD])
    return row


def error_of_pockets(bearing: object, history: JointHistory) -> tuple[float, int]:
    """Largest error of a pressure behind a restrictor in one step, over the highest pressure there, and the step's end.

    Areas with a compressible volume are integrated by backward Euler: the error of a step is half of the change of the
    rate in it, times the step. Without such a volume the error is 0.
    """
    supply = getattr(bearing, "supply", ())
    if history.time.size < 3 or not any(getattr(area.supply, "compressible_volume", 0.0) > 0.0 for area in supply):
        return 0.0, 0
    steps = np.diff(history.time)
    pressures = np.array([history.lowest_pocket_pressure, history.highest_pocket_pressure])
    errors = 0.5 * steps[1:] * np.abs(np.diff(np.diff(pressures) / steps)).max(axis=0)
    highest = max(float(np.abs(pressures).max()), 1e-300)
    k = int(errors.argmax())
    return float(errors[k]) / highest, k + 2


def unseen_errors(bearing: object) -> str:
    """Parts of a film's memory, in words, whose errors by the time steps are not estimated; empty without them.

    Errors by oil content and by temperatures fall nearly with the square of the step. Both may exceed the estimated
    ones by far: with 120 steps per period errors by temperatures by up to twenty times.
    """
    closure, thermal = getattr(bearing, "cavitation", None), getattr(bearing, "thermal", None)
    found = {"oil content": getattr(closure, "conserves_mass", False), "temperatures": isinstance(thermal, FilmEnergy)}
    return " and ".join(name for name, remembers in found.items() if remembers)
