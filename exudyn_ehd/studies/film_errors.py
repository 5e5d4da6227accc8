"""What a steady film says of a bearing, and how far two grids are apart in it."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.film import settled_history
from exudyn_ehd.joint.balance.limits import advice
from exudyn_ehd.joint.model.impedance import ImpedanceEvaluation, ImpedanceModel
from exudyn_ehd.joint.model.quantities import supply_flows
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.static.equilibrium import whirl_threshold
from exudyn_ehd.status import FilmError, Status

Motions: TypeAlias = Sequence[np.ndarray] | np.ndarray
Model: TypeAlias = BearingModel | ImpedanceModel
Evaluated: TypeAlias = Evaluation | ImpedanceEvaluation
Values: TypeAlias = dict[str, float | np.ndarray]
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
# Shortest measured stretch, s.
SHORTEST = 5e-3


def scale_of(name: str, reference: np.ndarray) -> float:
    """What errors of a quantity against ``reference`` are divided by."""
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


def measure_motions(model: Model, motions: Motions) -> tuple[dict[str, np.ndarray], float, float]:
    """Quantities over the motions in the frame of the eccentricity, iterations and film evaluations per motion.

    Raises
    ------
    FilmError
        Where there is no film.
    """
    columns: dict[str, list[float | np.ndarray]] = {}
    iterations, before = 0, _films(model)
    for motion in motions:
        evaluation = _evaluate(model, motion)
        if evaluation.status is not Status.CONVERGED:
            raise FilmError(f"{evaluation.status.name}: {advice(evaluation.status, model.bearing)}")
        iterations += evaluation.iterations
        for name, value in _quantities(model, evaluation, motion).items():
            columns.setdefault(name, []).append(value)
    films = _films(model) - before
    return {n: np.array(v) for n, v in columns.items()}, iterations / len(motions), films / len(motions)


def time_of_sweep(model: Model, motions: Motions) -> float:
    """Processor time in s per motion, with tangent and warm starts, over as many sweeps as can be measured."""
    rounds, start = 0, time.process_time()
    while True:
        for motion in motions:
            _tangent(_evaluate(model, motion))
        rounds += 1
        spent = time.process_time() - start
        if spent > SHORTEST:
            return spent / (rounds * len(motions))


def _quantities(model: Model, evaluation: Evaluated, motion: np.ndarray) -> Values:
    angle = math.atan2(motion[1], motion[0])
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    radial, tangential = turn @ evaluation.wrench[:2]
    tangent = _tangent(evaluation)
    known = evaluation.quantities()
    row: Values = {
        "load": math.hypot(radial, tangential),
        "attitude": math.atan2(tangential, -radial),
    }
    row |= {name: known[key] for name, key in _FROM_MODEL.items() if key in known}
    stiffness, damping = (-turn @ tangent[:2, k : k + 2] @ turn.T for k in (0, 4))
    # at rest as at any speed: the critical mass has none in it
    mass = whirl_threshold(stiffness, damping, abs(float(motion[8])) or 1.0)[1]
    row |= {"stiffness": stiffness, "damping": damping, "critical mass": mass}
    if model.bearing.supply and isinstance(evaluation, Evaluation) and evaluation.film is not None:
        row["supply flow"] = supply_flows(evaluation.film)
    return row


def _evaluate(model: Model, motion: np.ndarray) -> Evaluated:
    """Steady evaluation; a heated film and a flexible bore settle."""
    if isinstance(model, ImpedanceModel):
        return model.evaluate(motion)
    return model.evaluate_steady(motion, settled_history(model, motion))


def _tangent(evaluation: Evaluated) -> np.ndarray:
    return evaluation.steady_tangent() if isinstance(evaluation, Evaluation) else evaluation.tangent()


def _films(model: Model) -> int:
    """Films that a model has solved; a map solves none."""
    return 0 if isinstance(model, ImpedanceModel) else int(model.parts.evaluations.count)
