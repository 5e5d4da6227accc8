"""Number of time steps that a bearing needs in a mechanism, measured on the bearing alone under one cycle's load.

The journal, a mass with a given spin, carries the cycle's load on the film, in Exudyn and with the settings of
`ConfigureSolver`, for two periods; the second one counts. Runs with N and 2 N steps a period differ by

    d_N = max over the instants of the coarser run of |h_N - h_2N| / max(min h_2N, c / 100),    h the minimum film
          thickness,

which falls fourfold from N to 2 N where the integrator has reached its second order. What is left to the limit behind
the run with N steps is then d_N + d_2N + ... of all finer runs, and behind the last d / (r - 1) with the last factor r
between changes, cut off at 4 and at the square root of 2. A last r above 8, of an order above the integrator's, says
that the run before was too coarse to belong to the order of the others: one more is made.
"""

from __future__ import annotations

import dataclasses
import math
import warnings

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    MarkerNodeCoordinate,
    NodePointGround,
    NodeRigidBody2D,
    ObjectConnectorCoordinate,
    ObjectRigidBody2D,
)
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.api import CreateLubricatedJoint
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.coupling.run.solve import SolveDynamic
from exudyn_ehd.joint.balance.position import CLOSED
from exudyn_ehd.progress import without_lines
from exudyn_ehd.status import EHDError, InputError, RunError, require_number, require_plausible, require_type, warn_user
from exudyn_ehd.studies.film_errors import order_of

# Steps a period of the coarsest run, and number of runs, each with twice the steps of the one before.
FEWEST, LEVELS = 90, 7
# Safety factor: other moving parts of a mechanism add to the error of its bearing.
MARGIN = 2.0


@dataclasses.dataclass(frozen=True, kw_only=True)
class StepRecommendation:
    """Result of `recommend_steps`: the number of steps and its error, or the reason why none was found.

    Attributes
    ----------
    found : bool
        False: no number of steps that was tried keeps the error, or the film fails; ``reason`` says which.
    steps : int
        Steps in one period. Set ``timeIntegration.numberOfSteps`` to this number times the number of periods.
    error : float
        Upper bound of the error of the minimum film thickness, divided by its smallest value in the period.
    evidence : tuple of str
        Change of the minimum film thickness from each number of steps to its double.
    reason : str
        The request and the steps found, or why there are none.

    Examples
    --------
    After the example of `recommend_steps`:

    >>> advice.found, advice.error < 0.02
    (True, True)
    """

    found: bool
    reason: str
    steps: int = 0
    error: float = math.nan
    evidence: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join([self.reason, *(f"  {line}" for line in self.evidence)])


def recommend_steps(
    bearing: JournalBearing,
    error: float = 0.01,
    *,
    speed: float | ArrayLike,
    period: float,
    load: ArrayLike,
    mass: float,
) -> StepRecommendation:
    """Find the fewest time steps in a period that keep the error of the minimum film thickness below a limit.

    It runs the bearing alone for two periods of the load with more and more steps: seconds for a rigid bearing. The
    answer is at least 90 steps, because the other parts of a mechanism have time-step errors of their own.

    Parameters
    ----------
    bearing : JournalBearing
        Any whose journal moves without tilt or axial motion; with an `ANCFBush` it takes minutes.
    error : float, default 0.01
        Largest error of the minimum film thickness at any instant, divided by its smallest value in the period.
    speed : float or (n,) array
        Spin of the journal in the housing, rad/s: one number, or for a pin that swings one at each row of the load.
    period : float
        Period of the load, s: one turn of a crank, two turns for a four-stroke engine.
    load : (n, 2) array
        External force (x, y) on the journal in the housing's frame, N, at n >= 8 equal intervals of a period, the
        first at its start; for example from a run with an ideal joint.
    mass : float
        Mass that moves in the film, kg: that of the lighter of the two bodies.

    Returns
    -------
    StepRecommendation

    Raises
    ------
    InputError
        For arguments of a wrong type or shape, or outside their ranges.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    >>> load = 2000.0 * np.column_stack([np.sin(turn), -1.5 + np.cos(turn)])
    >>> advice = ehd.recommend_steps(bearing, 0.02, speed=314.0, period=0.02, load=load, mass=1.0)
    >>> 90 <= advice.steps <= 720
    True
    """
    require_type("recommend_steps: bearing", bearing, JournalBearing)
    require_number("recommend_steps: error", error, above=0.0, below=1.0, hint="it is relative: 0.01 is 1 %.")
    require_number("recommend_steps: period", period, "s", above=0.0)
    require_number("recommend_steps: mass", mass, "kg", above=0.0)
    cycle, spins = _require_cycle(load, speed)
    motion = _two_periods(np.broadcast_to(spins, len(cycle)), period)
    force = _two_periods(cycle, period)
    runs: list[np.ndarray] = []
    changes: list[float] = []
    evidence: list[str] = []
    for level in range(LEVELS):
        steps = FEWEST * 2**level
        try:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                runs.append(_second_period(bearing, steps, period, motion, force, mass))
        except EHDError as failure:
            return StepRecommendation(
                found=False, reason=f"the film fails with {steps} steps a period: {failure}", evidence=tuple(evidence)
            )
        if level:
            floor = max(float(np.min(runs[-1])), CLOSED * bearing.radial_clearance)
            changes.append(float(np.max(np.abs(runs[-1][::2] - runs[-2]))) / floor)
            evidence.append(f"{steps // 2} to {steps} steps a period: {100.0 * changes[-1]:.2g} %")
        bounds = _bounds(changes)
        if kept := [k for k, bound in enumerate(bounds) if bound <= error]:
            # those of the finest run; warnings of coarser ones are about steps that nobody takes
            for text, kind in {(str(w.message), w.category) for w in caught}:
                warn_user(text, kind)
            steps, left = FEWEST * 2 ** kept[0], bounds[kept[0]]
            reason = f"{steps} steps a period: the minimum film thickness within {error:g}, bound {left:.2g}"
            return StepRecommendation(found=True, steps=steps, error=left, reason=reason, evidence=tuple(evidence))
    return StepRecommendation(
        found=False,
        reason=f"no number of steps up to {FEWEST * 2 ** (LEVELS - 3)} a period keeps the minimum film thickness "
        f"within {error:g}; try StepControl(error=...)",
        evidence=tuple(evidence),
    )


def _require_cycle(load: ArrayLike, speed: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Load (n, 2) and spin, one number or (n,)."""
    cycle, spins = np.asarray(load, dtype=float), np.asarray(speed, dtype=float)
    if cycle.ndim != 2 or cycle.shape[1] != 2 or len(cycle) < 8 or not np.all(np.isfinite(cycle)):
        raise InputError(
            f"recommend_steps: load must be an array (n, 2) of finite forces in N, n >= 8, got shape {cycle.shape}."
        )
    if spins.shape not in ((), (len(cycle),)) or not np.all(np.isfinite(spins)):
        raise InputError(
            f"recommend_steps: speed must be a finite number or one for each of the {len(cycle)} rows of load, rad/s, "
            f"got shape {spins.shape}."
        )
    require_plausible("recommend_steps: load", load, cycle)
    require_plausible("recommend_steps: speed", speed, spins)
    return cycle, spins


def _bounds(changes: list[float]) -> list[float]:
    """Bounds of the distances to the limit of the runs that have two finer ones, from the changes between all."""
    finer, order = 2.0, 2.0  # steps from run to run, and the order of the integrator
    if len(changes) < 2 or changes[-2] > finer ** (order + 1.0) * changes[-1]:
        return []
    behind = changes[-1] / (finer ** order_of(changes[-2], changes[-1], finer, order) - 1.0)
    return [MARGIN * (sum(changes[k:]) + behind) for k in range(len(changes) - 1)]


def _two_periods(values: np.ndarray, period: float) -> PchipInterpolator:
    """Return two periods, from time 0, of a function that stays between values (n, ...) at equal intervals.

    Monotone cubics; an interval more on either side gives the slopes at the ends.
    """
    rows = np.arange(-1, 2 * len(values) + 2)
    return PchipInterpolator(period / len(values) * rows, values[rows % len(values)])


def _second_period(
    bearing: JournalBearing,
    steps: int,
    period: float,
    spin: PchipInterpolator,
    force: PchipInterpolator,
    mass: float,
) -> np.ndarray:
    """Minimum film thickness (steps + 1,) over the second period."""
    turned = spin.antiderivative()
    start = float(turned(0.0))

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    # where the load presses it
    first = force(0.0)
    place = 0.5 * bearing.radial_clearance * first / max(float(np.hypot(*first)), 1e-300)
    node = mbs.AddNode(
        NodeRigidBody2D(
            referenceCoordinates=[0, 0, 0],
            initialCoordinates=[*place, 0.0],
            initialVelocities=[0.0, 0.0, float(spin(0.0))],
        )
    )
    inertia = 0.5 * mass * bearing.journal_radius**2
    body = mbs.AddObject(ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
    rotation = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    mbs.AddObject(
        ObjectConnectorCoordinate(
            markerNumbers=[fixed, rotation],
            offsetUserFunction=lambda mbs, t, item, offset: float(turned(t)) - start,
            offsetUserFunction_t=lambda mbs, t, item, offset: float(spin(t)),
        )
    )
    mbs.CreateForce(
        itemNumber=body, loadVector=[0.0, 0.0, 0.0], loadVectorUserFunction=lambda mbs, t, load: [*force(t), 0.0]
    )
    items = [mbs.CreateGround(), body]
    joint = CreateLubricatedJoint(
        mbs, name="journal", itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 2.0 * period, 2 * steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ConfigureSolver(settings)
    with without_lines():
        if not SolveDynamic(mbs, settings):
            raise RunError("recommend_steps: Exudyn's solver gave up for a reason of its own; see its messages.")
        history = joint.history
    grid = period + period * np.arange(steps + 1) / steps
    return np.interp(grid, history.time, history.minimum_gap)
