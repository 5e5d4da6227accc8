"""Scenes: a journal at a prescribed position, evaluated with its exact tangent as in the steps of an implicit run.

A scene looks at several directions of the eccentricity, one degree apart, because the rupture line snaps to the grid:
errors are the worst over the directions, the time is that of one evaluation with tangent, each started from the one
before.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.temperature import settled_history
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.status import FilmError, InputError, Status, require_integer, require_number
from tests.benchmarks.accuracy.scenes.setting import Outcome, QuantityOfInterest, Setting

DEGREE = math.pi / 180.0
# Shortest measured stretch, s.
SHORTEST = 5e-3

QUANTITIES = (
    QuantityOfInterest(name="load", unit="N", text="film force"),
    QuantityOfInterest(name="attitude", unit="rad", scale=1.0, text="direction of the film force, error in rad"),
    QuantityOfInterest(name="friction", unit="Nm", text="friction torque on the journal"),
    QuantityOfInterest(name="peak pressure", unit="Pa", text="peak pressure"),
    QuantityOfInterest(name="minimum film thickness", unit="m", text="minimum film thickness"),
    QuantityOfInterest(name="leakage", unit="m3/s", text="flow out of both ends"),
    QuantityOfInterest(name="stiffness", unit="N/m", text="stiffness, largest entry"),
    QuantityOfInterest(name="damping", unit="N s/m", text="damping, largest entry"),
)
_FROM_MODEL = {
    "friction": "friction_torque",
    "peak pressure": "peak_pressure",
    "leakage": "leakage",
    "minimum film thickness": "minimum_gap",
}


@dataclasses.dataclass(frozen=True, kw_only=True)
class SteadyScene:
    """A journal held at an eccentricity.

    Parameters
    ----------
    name, title : str
    bearing : JournalBearing
        The rungs replace its options.
    speed : float
        rad/s.
    eccentricity_ratio : float
        e/c at the mid-plane.
    tilt_ratio : float
        Share of the mid-plane's minimum film thickness that the tilt takes at one end, 0 to 1; the journal tilts in the
        plane of its eccentricity.
    directions : int
        How many directions of the eccentricity, one degree apart.
    start_direction : float
        The first one, rad.
    """

    name: str
    title: str
    bearing: JournalBearing
    speed: float
    eccentricity_ratio: float
    tilt_ratio: float = 0.0
    directions: int = 8
    start_direction: float = 0.0
    quantities: tuple[QuantityOfInterest, ...] = QUANTITIES
    per: str = "evaluation with tangent"

    def __post_init__(self) -> None:
        require_number("SteadyScene.speed", self.speed, "rad/s")
        require_integer("SteadyScene.directions", self.directions, at_least=1)
        for name in ("eccentricity_ratio", "tilt_ratio"):
            if require_number(f"SteadyScene.{name}", getattr(self, name), at_least=0.0) >= 1.0:
                raise InputError(f"SteadyScene.{name} must be below 1, got {getattr(self, name)!r}.")

    def motions(self) -> np.ndarray:
        """Motions (directions, 10) as in `exudyn_ehd.joint.solved_film`."""
        angles = self.start_direction + DEGREE * np.arange(self.directions)
        state = self.speed, self.eccentricity_ratio, self.tilt_ratio
        return np.array([motion_at(self.bearing, *state, angle) for angle in angles])

    def prepare(self, setting: Setting) -> Callable[[], Outcome]:
        """Build the model; the run evaluates all directions, often enough to be measured."""
        model: Any = build_model(setting.bearing(self.bearing))
        motions = self.motions()
        values, iterations, films = measure_motions(model, motions)

        def run() -> Outcome:
            seconds = time_of_sweep(model, motions)
            return Outcome(values=values, seconds=seconds, newton=iterations, films=films)

        return run


def _evaluate(model: Any, motion: np.ndarray) -> Any:
    """Steady evaluation; a heated film and a flexible bore settle."""
    if isinstance(model, ImpedanceModel):
        return model.evaluate(motion)
    return model.evaluate_steady(motion, settled_history(model, motion))


def _tangent(model: Any, evaluation: Any) -> np.ndarray:
    return evaluation.tangent() if isinstance(model, ImpedanceModel) else evaluation.steady_tangent()


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


def time_of_sweep(model: Any, motions: np.ndarray) -> float:
    """Processor time per position in s, over as many sweeps as can be measured."""
    rounds, start = 0, time.process_time()
    while True:
        _sweep(model, motions)
        rounds += 1
        spent = time.process_time() - start
        if spent > SHORTEST:
            return spent / (rounds * len(motions))


def _sweep(model: Any, motions: np.ndarray) -> None:
    for motion in motions:
        _tangent(model, _evaluate(model, motion))


def _films(model: Any) -> int:
    """Films that a model has solved; a map solves none."""
    return 0 if isinstance(model, ImpedanceModel) else model.parts.evaluations.count


def measure_motions(model: Any, motions: np.ndarray) -> tuple[dict[str, np.ndarray], float, float]:
    """Quantities over the directions in the frame of the eccentricity, iterations and film evaluations per position."""
    columns: dict[str, list[Any]] = {}
    iterations, before = 0, _films(model)
    for motion in motions:
        evaluation = _evaluate(model, motion)
        if evaluation.status is not Status.CONVERGED:
            raise FilmError(f"{evaluation.status.name}: {evaluation.status.advice}")
        iterations += evaluation.iterations
        angle = math.atan2(motion[1], motion[0])
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        radial, tangential = turn @ evaluation.wrench[:2]
        tangent = _tangent(model, evaluation)
        known = evaluation.quantities()
        row: dict[str, Any] = {"load": math.hypot(radial, tangential), "attitude": math.atan2(tangential, -radial)}
        row |= {name: known[key] for name, key in _FROM_MODEL.items() if key in known}
        row["stiffness"] = -turn @ tangent[:2, :2] @ turn.T
        row["damping"] = -turn @ tangent[:2, 4:6] @ turn.T
        for name, value in row.items():
            columns.setdefault(name, []).append(value)
    films = _films(model) - before
    return {n: np.array(v) for n, v in columns.items()}, iterations / len(motions), films / len(motions)
