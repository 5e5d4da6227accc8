"""Record of the accepted steps of one joint."""

from __future__ import annotations

import dataclasses
import enum
import math
import pathlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from exudyn_ehd.coupling.record.revolutions import Revolutions, revolutions
from exudyn_ehd.joint.audit.samples import RecordedSteps
from exudyn_ehd.joint.step_error import BLOCKS, LOADS
from exudyn_ehd.pictures.mixins import HistoryPictures
from exudyn_ehd.pictures.records import History, shown
from exudyn_ehd.status import InputError
from exudyn_ehd.storage import replacing, require_path
from exudyn_ehd.tables import data_frame, write_csv

if TYPE_CHECKING:
    from pandas import DataFrame

FORMAT = "exudyn_ehd JointHistory 5"
DIMENSIONS = ("radial_clearance", "journal_radius", "length")
_PARTS = {
    "motion": ("x", "y", "bx", "by", "x_t", "y_t", "bx_t", "by_t", "omega", "w"),
    "force": ("force_x", "force_y", "force_z"),
    "moment": ("moment_x", "moment_y", "moment_z"),
}
_MOTION_UNITS = ("m", "m", "rad", "rad", "m/s", "m/s", "rad/s", "rad/s", "rad/s", "m/s")


class Quantity(enum.Enum):
    """Quantities that a sensor can record; the value is the name in `JointHistory`.

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
    FILM_TEMPERATURE = "film_temperature"
    PEAK_TEMPERATURE = "peak_temperature"
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


# Scalar quantities of the film: those behind motion, eccentricities and loads.
_SCALARS = tuple(member.value for member in Quantity)[6:]
TIME, _MOTION, _ECCENTRICITY, _RATIO, _RATIO_MAX, _WRENCH, _FIRST_SCALAR = 0, 1, 11, 13, 14, 15, 21
FIRST_BLOCK = _FIRST_SCALAR + len(_SCALARS)
LOAD = slice(FIRST_BLOCK + BLOCKS.size, FIRST_BLOCK + BLOCKS.size + LOADS)
WIDTH = LOAD.stop
# Tangent's blocks in a row, of a ball what `pack_of_ball` keeps, and the numbers behind a row that is settled.
TANGENT, PACK = slice(FIRST_BLOCK, LOAD.start), slice(FIRST_BLOCK, FIRST_BLOCK + 15)
STEP_COUNT, STEP_ERROR = WIDTH, WIDTH + 1
_BLOCKS = BLOCKS.ravel()
# Places in a row.
MINIMUM_GAP, PEAK_PRESSURE = (_FIRST_SCALAR + _SCALARS.index(name) for name in ("minimum_gap", "peak_pressure"))
FORCE = slice(_WRENCH, _WRENCH + 3)
COLUMNS: dict[str, int | slice] = {
    "time": TIME,
    "motion": slice(_MOTION, _MOTION + 10),
    "eccentricity": slice(_ECCENTRICITY, _ECCENTRICITY + 2),
    "eccentricity_ratio": _RATIO,
    "largest_eccentricity_ratio": _RATIO_MAX,
    "force": slice(_WRENCH, _WRENCH + 3),
    "moment": slice(_WRENCH + 3, _WRENCH + 6),
    **{name: _FIRST_SCALAR + i for i, name in enumerate(_SCALARS)},
    "step_error": STEP_ERROR,
    "step_count": STEP_COUNT,
}
# Columns that are written as text.
_NAMES = tuple(COLUMNS)[:-1]


@dataclasses.dataclass(frozen=True, kw_only=True)
class JointHistory(RecordedSteps, History, HistoryPictures):
    """Accepted steps of one joint, first the initial state, last the state now.

    All vectors are in the joint frame (fixed in the housing, z = axis), force and moment act on the journal, moment
    about the bearing's centre. A quantity that the film does not provide is nan.

    Attributes
    ----------
    time : ndarray (n,)
        [s]; in a static solve Exudyn's load parameter.
    motion : ndarray (n, 10)
        x, y [m], bx, by [rad], their rates as the film takes them (`exudyn_ehd.joint.step_rates`), relative spin omega
        [rad/s], axial velocity w [m/s].
    eccentricity : ndarray (n, 2)
        Journal axis in the mid-plane [m].
    eccentricity_ratio : ndarray (n,)
        |eccentricity| / radial clearance in the mid-plane.
    largest_eccentricity_ratio : ndarray (n,)
        The largest along the length, at one of the ends.
    force, moment : ndarray (n, 3)
        [N], [N m], of the journal's film and contact; the films on the end faces are apart.
    minimum_gap, peak_pressure, friction_torque, power_loss, leakage, contact_load : ndarray (n,)
        Minimum film thickness [m], [Pa], [N m], [W], [m3/s], [N].
    contact_torque, supply_flow, film_temperature, peak_temperature : ndarray (n,)
        [N m], [m3/s], [K], [K].
    minimum_gap_angle, minimum_gap_z, peak_angle : ndarray (n,)
        Place of the minimum film thickness [rad, m] and angle of the peak pressure [rad], 0 to 2 pi.
    bore_displacement : ndarray (n,)
        Largest displacement of a liner or of a flexible bore [m].
    stored_power : ndarray (n,)
        Power that a liner and touching surfaces take up, negative: give back [W]; not in ``power_loss``.
    bush_temperature, journal_temperature, clearance : ndarray (n,)
        Mean temperatures at the film of walls that conduct, or with two temperatures across the film, of all surfaces
        [K], and the radial clearance that they leave [m].
    axial_position, thrust_force, thrust_torque : ndarray (n,)
        Of a joint with ``thrust``, else nan as all ``thrust_...``: place of the journal between its faces [m], axial
        force of their films [N] and torque about the bearing's axis [N m] on the journal.
    thrust_minimum_gap, thrust_peak_pressure, thrust_power_loss, thrust_contact_load : ndarray (n,)
        Smallest film thickness [m], highest pressure [Pa], loss [W] and load carried by contact [N] of all faces.
    step_error : ndarray (n,)
        Estimated error of the gap that the time steps have made, over the minimum film thickness of the step; of
        implicit solvers, from the third step on, else nan (`exudyn_ehd.joint.step_error`).
    step_count : ndarray (n,)
        Number of the accepted step, 0 for the initial state; it has gaps where the record was thinned (`Every`,
        `Period`): the first, last and worst steps are there, and ``step_error`` is the largest since the row before.
    radial_clearance, journal_radius, length : float
        Dimensions of the bearing [m].

    Notes
    -----
    The history of a joint makes each of its arrays when it is asked for, and keeps it; that of a `File` reads it then.

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
    peak_temperature: np.ndarray
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
    step_count: np.ndarray
    journal_radius: float

    def __getattr__(self, name: str) -> Any:
        column = self.__dict__.get("_column")
        if column is None or name not in COLUMNS:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
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
        """Return whether accepted steps are missing between the rows."""
        return has_gaps(self.step_count)

    def __repr__(self) -> str:
        if not self.time.size:
            return "<JointHistory without steps: run a solver first>"
        gap, peak = float(self.minimum_gap.min()), float(self.peak_pressure.max())
        steps = f"{self.step_count[-1] - self.step_count[0] + 1} steps"
        steps += f" in {self.time.size} rows" if self.is_thinned else ""
        steps = "the initial state, without a run," if self.step_count[-1] == 0 else steps
        return (
            f"<JointHistory of {steps} from {self.time[0]:.6g} to {self.time[-1]:.6g} s: "
            f"minimum film thickness {shown('length', gap)}, peak pressure {shown('pressure', peak)}>"
        )

    def between(self, start: float = -math.inf, end: float = math.inf) -> JointHistory:
        """The steps with ``start <= time <= end``, to rounding: a billionth of the record's length.

        Parameters
        ----------
        start, end : float
            s.

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
        slack = 1e-9 * float(np.ptp(self.time)) if self.time.size else 0.0
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
            values = getattr(self, name)
            # the eccentricity is the motion's x and y
            if name in _PARTS:
                columns |= dict(zip(_PARTS[name], values.T, strict=True))
            elif name != "eccentricity":
                columns[name] = values
        return columns

    def revolutions(self, *, period: float | None = None) -> Revolutions:
        """Minimum film thickness and its place, peak pressure, mean loss and leakage of every whole revolution.

        Print it for a table.

        Parameters
        ----------
        period : float, optional
            Duration of a cycle, s, counted from the first row; for journals that swing. By default revolutions of the
            journal against the housing are counted.

        Returns
        -------
        Revolutions
            A table, one row for each.

        Raises
        ------
        InputError
            If there is no whole revolution or period, and of a thinned record (`Every`, `Period`).
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


def eccentricity_ratios(motion: np.ndarray, radial_clearance: float, length: float) -> tuple[float, float]:
    """Eccentricity ratio in the mid-plane and the largest along the length (which is at an end: it is convex)."""
    x, y, bx, by = motion[:4].tolist()
    half = 0.5 * length
    ends = max((x + bx * half) ** 2 + (y + by * half) ** 2, (x - bx * half) ** 2 + (y - by * half) ** 2)
    return (x * x + y * y) ** 0.5 / radial_clearance, ends**0.5 / radial_clearance


def make_row(
    time: float,
    motion: np.ndarray,
    ratios: tuple[float, float],
    wrench: np.ndarray,
    quantities: Mapping[str, float],
    tangent: np.ndarray | None = None,
    load: np.ndarray | None = None,
) -> np.ndarray:
    """One row of the record; step errors need the ``tangent`` (6, 10) and the ``load`` (20,) on the film."""
    row = np.empty(WIDTH)
    scalars = [quantities.get(name, math.nan) for name in _SCALARS]
    row[:FIRST_BLOCK] = [time, *motion.tolist(), *motion[:2].tolist(), *ratios, *wrench.tolist(), *scalars]
    row[TANGENT] = np.nan if tangent is None else tangent.take(_BLOCKS)
    row[LOAD] = np.nan if load is None else load
    return row
