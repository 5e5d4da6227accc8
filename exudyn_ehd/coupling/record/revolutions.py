"""Summary of a history by revolutions of the journal, or by periods."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Mapping

import numpy as np

from exudyn_ehd.status import ROUNDING, InputError, require_number
from exudyn_ehd.tables import Table


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Revolutions(Table):
    """Table of a history, a row per revolution: minimum film thickness, peak pressure, losses.

    ``print`` shows it in um, MPa, W and l/min; arrays, `to_csv` and `to_dataframe` have SI units. A quantity that the
    film does not provide is nan.

    Attributes
    ----------
    start : (k,) [s]
        First instant of the revolution. As ``time`` of the history.
    end : (k,) [s]
        Last instant of the revolution. As ``time`` of the history.
    minimum_gap : (k,) [m]
        Minimum film thickness of the revolution. As in the history.
    minimum_gap_time : (k,) [s]
        Instant of that minimum. As ``time`` of the history.
    minimum_gap_angle : (k,) [rad]
        Angle at which the film was thinnest at that instant. From x about z, 0 to 2 pi.
    minimum_gap_z : (k,) [m]
        Place along the axis at which the film was thinnest at that instant. Along z, 0 in the mid-plane.
    peak_pressure : (k,) [Pa]
        Highest film pressure of the revolution. Above ambient.
    peak_pressure_time : (k,) [s]
        Instant of that pressure. As ``time`` of the history.
    peak_angle : (k,) [rad]
        Angle of that pressure. From x about z, 0 to 2 pi.
    largest_eccentricity_ratio : (k,) [-]
        Largest eccentricity ratio along the bearing and in time. From 0.
    largest_load : (k,) [N]
        Largest force of film and contact across the axis. Size of the x and y part of ``force``.
    mean_power_loss : (k,) [W]
        Mean over time of ``power_loss``. Positive: taken from the motion.
    mean_leakage : (k,) [m3/s]
        Mean over time of ``leakage``. Positive outwards.
    mean_friction_torque : (k,) [N m]
        Mean over time of ``friction_torque``. On the journal, about z.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> table = joint.revolutions(period=1e-3)
    >>> table.minimum_gap.shape, bool(table.minimum_gap[1] < table.minimum_gap[0])
    ((2,), True)
    """

    start: np.ndarray
    end: np.ndarray
    minimum_gap: np.ndarray
    minimum_gap_time: np.ndarray
    minimum_gap_angle: np.ndarray
    minimum_gap_z: np.ndarray
    peak_pressure: np.ndarray
    peak_pressure_time: np.ndarray
    peak_angle: np.ndarray
    largest_eccentricity_ratio: np.ndarray
    largest_load: np.ndarray
    mean_power_loss: np.ndarray
    mean_leakage: np.ndarray
    mean_friction_torque: np.ndarray

    def __len__(self) -> int:
        return self.start.size

    def _columns(self) -> dict[str, np.ndarray]:
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def __repr__(self) -> str:
        return f"<Revolutions: {len(self)}, print them for a table>"


def revolution_times(time: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Instants (k + 1,) at which the journal has turned by 0, 1, ... k whole revolutions against the housing.

    Both senses of rotation count. The angle is the integral of the relative spin by the trapezoidal rule, linear
    between steps.
    """
    angle = np.abs(np.concatenate(([0.0], np.cumsum(0.5 * (omega[1:] + omega[:-1]) * np.diff(time)))) / math.tau)
    # for a journal that swings back, the first instant at an angle counts
    reached = np.maximum.accumulate(angle)
    # a run of whole revolutions ends a rounding short of the last one
    whole = int(np.floor(reached[-1] + ROUNDING))
    turns = np.minimum(np.arange(1.0, whole + 1.0), reached[-1])
    at = np.searchsorted(reached, turns)
    share = (turns - angle[at - 1]) / (angle[at] - angle[at - 1])
    return np.concatenate((time[:1], time[at - 1] + share * (time[at] - time[at - 1])))


def revolutions(history: Mapping[str, np.ndarray], period: float | None = None) -> Revolutions:
    """Summarise the whole revolutions of a history, given by its columns; see `JointHistory.revolutions`."""
    time = history["time"]
    if time.size < 2:
        raise InputError("JointHistory.revolutions: the history has no steps; run a solver first.")
    if period is None:
        edges = revolution_times(time, history["motion"][:, 8])
        if edges.size < 2:
            raise InputError(
                "JointHistory.revolutions: the journal has not turned once against the housing; give period=..., the "
                "duration of one cycle in s."
            )
    else:
        length = require_number("JointHistory.revolutions: period", period, "s", above=0.0)
        # a run of whole periods ends a rounding short of the last one
        whole = int(np.floor((time[-1] - time[0]) / length + ROUNDING))
        if whole == 0:
            raise InputError(
                f"JointHistory.revolutions: period must not exceed the history's {time[-1] - time[0]:g} s, got "
                f"{length:g} s."
            )
        edges = np.minimum(time[0] + length * np.arange(whole + 1.0), time[-1])
    rows = [_summary(history, a, b) for a, b in itertools.pairwise(edges)]
    return Revolutions(**{name: np.array([row[name] for row in rows]) for name in rows[0]})


def _summary(history: Mapping[str, np.ndarray], start: float, end: float) -> dict[str, float]:
    time = history["time"]
    # edges are sums of many steps: a step on an edge belongs to both sides, to rounding
    slack = ROUNDING * (end - start)
    inside = np.flatnonzero((time >= start - slack) & (time <= end + slack))
    if inside.size == 0:
        raise InputError(
            f"JointHistory.revolutions: no recorded step between {start:g} s and {end:g} s; the steps are longer than "
            "a revolution."
        )
    # the recorded steps within, and both ends by linear interpolation
    along = np.concatenate(([start], time[(time > start) & (time < end)], [end]))

    def mean(values: np.ndarray) -> float:
        v = np.interp(along, time, values)
        return float(np.sum(0.5 * (v[1:] + v[:-1]) * np.diff(along)) / (end - start))

    thinnest = _place(history["minimum_gap"], inside, np.nanargmin)
    highest = _place(history["peak_pressure"], inside, np.nanargmax)
    return {
        "start": start,
        "end": end,
        "minimum_gap": history["minimum_gap"][thinnest],
        "minimum_gap_time": time[thinnest],
        "minimum_gap_angle": history["minimum_gap_angle"][thinnest],
        "minimum_gap_z": history["minimum_gap_z"][thinnest],
        "peak_pressure": history["peak_pressure"][highest],
        "peak_pressure_time": time[highest],
        "peak_angle": history["peak_angle"][highest],
        "largest_eccentricity_ratio": float(history["largest_eccentricity_ratio"][inside].max()),
        "largest_load": float(np.hypot(history["force"][inside, 0], history["force"][inside, 1]).max()),
        "mean_power_loss": mean(history["power_loss"]),
        "mean_leakage": mean(history["leakage"]),
        "mean_friction_torque": mean(history["friction_torque"]),
    }


def _place(values: np.ndarray, inside: np.ndarray, find: Callable[[np.ndarray], np.intp]) -> int:
    """Row of the extreme value among those inside; the first of them if the film does not provide the quantity."""
    among = values[inside]
    return int(inside[0] if np.isnan(among).all() else inside[find(among)])
