"""Results of a steady film of a bearing, and the difference of two grids in them.

Converged reference, and an estimate of its own error from three levels of refinement
-------------------------------------------------------------------------------------
With values f1, f2, f3 on levels that are each ``ratio`` times finer than the one before and an error ~ h^p,

    p = log(|f2 - f1| / |f3 - f2|) / log(ratio),    |f3 - f| = |f3 - f2| / (ratio^p - 1).

Source: L. F. Richardson, Phil. Trans. Royal Soc. A 210 (1911) 307; use and limits as in P. J. Roache, J. Fluids
Engineering 116 (1994) 405. The observed order is cut off at the scheme's formal order, beyond which it is luck, and at
1/2, below which the levels do not converge visibly (the rupture line snaps to columns): the estimate then is
pessimistic.
"""

from __future__ import annotations

import math
import time
import timeit
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.limits import advice
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.model.results import supply_flows
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.static.dynamic_stiffness import whirl_threshold
from exudyn_ehd.status import FilmError, InputError, Status

LOWEST_ORDER = 0.5
Motions: TypeAlias = Sequence[np.ndarray] | np.ndarray
QuantityValues: TypeAlias = dict[str, float | np.ndarray]
# Quantities, and what their errors are divided by; None: the largest absolute value of the reference.
SCALES: Mapping[str, float | None] = {
    "load": None,
    "attitude": 1.0,
    "friction": None,
    "peak pressure": None,
    "minimum film thickness": None,
    "leakage": None,
    "stiffness": None,
    "damping": None,
    "critical mass": None,
    "supply flow": None,
}
_FROM_MODEL = {
    "friction": "friction_torque",
    "peak pressure": "peak_pressure",
    "leakage": "leakage",
    "minimum film thickness": "minimum_gap",
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Converged:
    """A reference value.

    Attributes
    ----------
    value : ndarray
        Value of the finest level, not extrapolated.
    error : float
        Estimate of the distance from ``value`` to the limit.
    order : float
        Order it rests on.
    """

    value: np.ndarray
    error: float
    order: float


def converged(levels: Sequence[np.ndarray], *, ratio: float, formal_order: float, scale: float) -> Converged:
    """Reference from three levels.

    Parameters
    ----------
    levels : three arrays of one shape
        Coarse to fine.
    ratio : float
        Refinement from level to level, > 1.
    formal_order : float
        Order of the scheme for smooth solutions.
    scale : float
        Differences are the largest over the array, divided by it.

    Raises
    ------
    InputError
        For anything but three finite levels.
    """
    if len(levels) != 3 or not all(np.all(np.isfinite(level)) for level in levels):
        raise InputError(f"converged: levels must be three finite values, coarse to fine, got {levels!r}.")
    first, last = (float(np.max(np.abs(np.asarray(levels[k]) - levels[k + 1]))) / scale for k in (0, 1))
    order = order_of(first, last, ratio, formal_order)
    return Converged(value=np.asarray(levels[2]), error=last / (ratio**order - 1.0), order=order)


def order_of(first: float, last: float, ratio: float, formal_order: float) -> float:
    """Order of a scheme from the differences between three levels, each ``ratio`` times finer than the one before."""
    if not last > 0.0:
        return formal_order
    observed = math.log(first / last) / math.log(ratio) if first > 0.0 else LOWEST_ORDER
    return min(max(observed, LOWEST_ORDER), formal_order)


def scale_of(name: str, reference: np.ndarray) -> float:
    """Return the divisor of a quantity's errors against ``reference``."""
    scale = SCALES[name]
    largest = float(np.max(np.abs(reference))) if scale is None else scale
    return largest if largest > 0.0 else 1.0


def motion_at(
    bearing: JournalBearing, speed: float, eccentricity_ratio: float, tilt_ratio: float, direction: float
) -> np.ndarray:
    """Motion (10,) of a journal that only spins, eccentric and tilted towards ``direction``.

    The tilt takes ``tilt_ratio`` of the minimum film thickness.
    """
    radial = np.array([math.cos(direction), math.sin(direction)])
    motion = np.zeros(10)
    motion[:2] = eccentricity_ratio * bearing.radial_clearance * radial
    motion[2:4] = 2.0 * tilt_ratio * bearing.radial_clearance * (1.0 - eccentricity_ratio) / bearing.length * radial
    motion[8] = speed
    return motion


def measure_motions(model: BearingModel, motions: Motions) -> dict[str, np.ndarray]:
    """Quantities over the motions, in the frame of the eccentricity.

    Raises
    ------
    FilmError
        If there is no film.
    """
    columns: dict[str, list[float | np.ndarray]] = {}
    for motion in motions:
        evaluation = evaluate_at(model, motion)
        if evaluation.status is not Status.CONVERGED:
            raise FilmError(f"{evaluation.status.name}: {advice(evaluation.status, model.bearing)}")
        for name, value in _quantities(model, evaluation, motion).items():
            columns.setdefault(name, []).append(value)
    return {name: np.array(values) for name, values in columns.items()}


def time_of_sweep(model: BearingModel, motions: Motions) -> float:
    """Processor time in s per motion, with tangent and warm starts, over as many sweeps as can be measured."""

    def sweep() -> None:
        for motion in motions:
            evaluate_at(model, motion).steady_tangent()

    rounds, spent = timeit.Timer(sweep, timer=time.process_time).autorange()
    return spent / (rounds * len(motions))


def _quantities(model: BearingModel, evaluation: Evaluation, motion: np.ndarray) -> QuantityValues:
    angle = math.atan2(motion[1], motion[0])
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    radial, tangential = turn @ evaluation.wrench[:2]
    tangent = evaluation.steady_tangent()
    known = evaluation.quantities()
    row: QuantityValues = {
        "load": math.hypot(radial, tangential),
        "attitude": math.atan2(tangential, -radial),
    }
    row |= {name: known[key] for name, key in _FROM_MODEL.items() if key in known}
    stiffness, damping = (-turn @ tangent[:2, k : k + 2] @ turn.T for k in (0, 4))
    # at rest as at any speed: the critical mass has none in it
    mass = whirl_threshold(stiffness, damping, abs(float(motion[8])) or 1.0)[1]
    row |= {"stiffness": stiffness, "damping": damping, "critical mass": mass}
    if model.bearing.supply and evaluation.film is not None:
        row["supply flow"] = supply_flows(evaluation.film)
    return row


def evaluate_at(model: BearingModel, motion: np.ndarray) -> Evaluation:
    """Steady evaluation; a heated film and a flexible bore settle."""
    return model.evaluate_steady(motion, settled_history(model, motion) if model.bearing.thermal else None)
