"""Scenes: a journal at a prescribed position, evaluated with its exact tangent as in the steps of an implicit run.

A scene looks at several directions of the eccentricity, one degree apart, because the rupture line snaps to the grid:
errors are the worst over the directions, the time is that of one evaluation with tangent, each started from the one
before.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.model.build import ImpedanceModel, build_model
from exudyn_ehd.status import InputError, require_integer, require_number
from exudyn_ehd.studies.film_errors import evaluate_at, measure_motions, motion_at, time_of_sweep
from tests.benchmarks.accuracy.scenes.setting import Outcome, QuantityOfInterest, Setting

DEGREE = math.pi / 180.0
QUANTITIES = (
    QuantityOfInterest(name="load", unit="N", text="film force"),
    QuantityOfInterest(name="attitude", unit="rad", scale=1.0, text="direction of the film force, error in rad"),
    QuantityOfInterest(name="friction", unit="Nm", text="friction torque on the journal"),
    QuantityOfInterest(name="peak pressure", unit="Pa", text="peak pressure"),
    QuantityOfInterest(name="minimum film thickness", unit="m", text="minimum film thickness"),
    QuantityOfInterest(name="leakage", unit="m3/s", text="flow out of both ends"),
    QuantityOfInterest(name="stiffness", unit="N/m", text="stiffness, largest entry"),
    QuantityOfInterest(name="damping", unit="N s/m", text="damping, largest entry"),
    QuantityOfInterest(name="critical mass", unit="kg", text="mass from which on the journal whirls"),
    QuantityOfInterest(name="supply flow", unit="m3/s", text="flow from the supply"),
)


class SteadyMap:
    """An impedance map with the calls of a film's model that the scenes make."""

    def __init__(self, model: ImpedanceModel) -> None:
        self.bearing, self.model = model.bearing, model

    def evaluate_steady(self, motion: np.ndarray, history: None) -> SimpleNamespace:
        """Return the evaluation; a map has no film, and no history."""
        found = self.model.evaluate(motion)
        return SimpleNamespace(
            status=found.status,
            wrench=found.wrench,
            iterations=found.iterations,
            quantities=found.quantities,
            steady_tangent=found.tangent,
            film=None,
        )


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
        if isinstance(model, ImpedanceModel):
            model = SteadyMap(model)
        motions = self.motions()
        iterations = sum(evaluate_at(model, motion).iterations for motion in motions) / len(motions)
        # a map solves none
        films = model.parts.evaluations / len(motions) if hasattr(model, "parts") else 0.0
        values = measure_motions(model, motions)

        def run() -> Outcome:
            seconds = time_of_sweep(model, motions)
            return Outcome(values=values, seconds=seconds, newton=iterations, films=films)

        return run
