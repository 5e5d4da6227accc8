"""Friction of a steadily loaded bearing against speed: the Stribeck curve from boundary to full film lubrication."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.static.equilibrium import LOAD_TOLERANCE, first_guess
from exudyn_ehd.status import FilmError, InputError, Status, require_number

MAX_STEPS = 200


@dataclass(frozen=True, eq=False)
class StribeckResult:
    """Stribeck curve, one entry per speed in the order given; SI units.

    Attributes
    ----------
    speeds : (n,) array
        Spin omega, rad/s.
    friction_coefficient : (n,) array
        Friction torque on the journal about its own axis / (R load).
    friction_torque, contact_torque : (n,) arrays
        Size of the whole torque and of its part from boundary friction, Nm.
    contact_load_share : (n,) array
        Contact load / load; above what the film leaves it the film pulls.
    eccentricity_ratio, minimum_gap : (n,) arrays
        e/c; minimum film thickness of the nominal surfaces, m (negative where asperities are pressed flat).
    film_ratio : (n,) array
        lambda = ``minimum_gap`` / composite roughness; nan for smooth surfaces.
    power_loss, contact_power_loss, leakage : (n,) arrays
        W, W, m3/s.
    hersey : (n,) array
        mu omega / (load / (2 R L)), dimensionless.
    position : (n, 2) array
        x, y of the journal axis, m.
    """

    speeds: np.ndarray
    friction_coefficient: np.ndarray
    friction_torque: np.ndarray
    contact_torque: np.ndarray
    contact_load_share: np.ndarray
    eccentricity_ratio: np.ndarray
    minimum_gap: np.ndarray
    film_ratio: np.ndarray
    power_loss: np.ndarray
    contact_power_loss: np.ndarray
    leakage: np.ndarray
    hersey: np.ndarray
    position: np.ndarray

    @property
    def lowest_friction(self) -> tuple[float, float]:
        """Speed and friction coefficient at the curve's minimum, among the speeds computed."""
        k = int(np.argmin(self.friction_coefficient))
        return float(self.speeds[k]), float(self.friction_coefficient[k])


def stribeck(bearing: JournalBearing, *, load: float, speeds: Sequence[float] | np.ndarray) -> StribeckResult:
    """Equilibrium and friction under a constant load (N, in -y on the journal) over a range of speeds.

    Speeds are worked through from the fastest to the slowest, each starting from the last position; where Newton's
    method does not settle, speeds in between lead to it.

    Parameters
    ----------
    bearing : JournalBearing
        With ``inlet=Periodic()``; a curve that turns up at low speed needs ``asperity=GreenwoodTripp(...)``.
    load : float
        N, > 0.
    speeds : sequence of float
        Spins, rad/s, all > 0, in any order.

    Raises
    ------
    InputError
        For a load or speeds that are not positive, or an inlet that a moving journal can't have.
    FilmError
        If no equilibrium was found at a speed.
    """
    size = require_number("stribeck: load", load, "N", above=0.0)
    values = np.atleast_1d(np.array(speeds, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values)) or not np.all(values > 0.0):
        raise InputError(
            f"stribeck: speeds must be finite numbers > 0 rad/s, got {speeds!r}; np.geomspace(...) spreads them well."
        )
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError("stribeck: inlet=MaximumGap() is for prescribed positions (`steady`); use Periodic().")
    model = build_study_model(bearing, 0.0)
    force = np.array([0.0, -size])
    order = np.argsort(-values)
    position = first_guess(bearing, float(values[order[0]]), force, np.zeros(2))
    last = float(values[order[0]])
    rows: list[dict[str, float | np.ndarray]] = [{}] * values.size
    for k in order:
        found = _follow(model, position, last, float(values[k]), force)
        position, last = found.motion[:2], float(values[k])
        rows[k] = _row(found, last, size)
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return StribeckResult(speeds=values, **columns)


def _follow(model: BearingModel, position: np.ndarray, last: float, speed: float, force: np.ndarray) -> Evaluation:
    """Equilibrium at ``speed`` from the one at ``last``, halving the way (in the logarithm) where Newton fails."""
    target, halvings = speed, 0
    while True:
        found = _settle(model, position, target, force)
        if found is not None and target == speed:
            return found
        if found is not None:
            position, last, target = found.motion[:2], target, speed
            continue
        halvings += 1
        target = float(np.sqrt(last * target))
        if halvings > 30 or abs(target / last - 1.0) < 1e-3:
            raise FilmError(
                f"stribeck: no equilibrium found at {speed:.4g} rad/s under {abs(force[1]):.4g} N, next to "
                f"{last:.4g} rad/s; give "
                "the bearing asperity=GreenwoodTripp(...) so that contact carries what the film can't, or refine "
                "its film grid."
            )


def _settle(model: BearingModel, start: np.ndarray, speed: float, force: np.ndarray) -> Evaluation | None:
    """Newton's method with steps below a tenth of the clearance, halved while the unbalance grows.

    None if it does not settle.
    """
    size = float(np.hypot(*force))
    longest = 0.1 * model.bearing.radial_clearance
    motion = np.zeros(10)
    motion[:2], motion[8] = start, speed
    evaluation = model.evaluate(motion)
    if evaluation.status is not Status.CONVERGED:
        return None
    for _ in range(MAX_STEPS):
        unbalance = evaluation.wrench[:2] + force
        error = float(np.hypot(*unbalance))
        if error < LOAD_TOLERANCE * size:
            return evaluation
        step = np.linalg.solve(evaluation.tangent()[:2, :2], -unbalance)
        step *= min(1.0, longest / (float(np.hypot(*step)) + 1e-300))
        base = motion[:2].copy()
        for _ in range(12):
            motion[:2] = base + step
            evaluation = model.evaluate(motion)
            if evaluation.status is Status.CONVERGED and (
                float(np.hypot(*(evaluation.wrench[:2] + force))) < max(error, 4.0 * size)
            ):
                break
            step *= 0.5
        if evaluation.status is not Status.CONVERGED:
            return None
    return None


def _row(evaluation: Evaluation, speed: float, load: float) -> dict[str, float | np.ndarray]:
    """Columns of the result at one equilibrium."""
    q, b = evaluation.quantities(), evaluation.model.bearing
    rough = b.asperity if b.asperity is not None else b.roughness
    torque = abs(q["friction_torque"])
    return {
        "friction_coefficient": torque / (b.journal_radius * load),
        "friction_torque": torque,
        "contact_torque": abs(q["contact_torque"]),
        "contact_load_share": q["contact_load"] / load,
        "eccentricity_ratio": q["eccentricity_ratio"],
        "minimum_gap": q["minimum_gap"],
        "film_ratio": np.nan if rough is None else q["minimum_gap"] / rough.composite_roughness,
        "power_loss": q["power_loss"],
        "contact_power_loss": q["contact_power_loss"],
        "leakage": q["leakage"],
        "hersey": b.lubricant.viscosity * speed * 2.0 * b.journal_radius * b.length / load,
        "position": evaluation.motion[:2].copy(),
    }
