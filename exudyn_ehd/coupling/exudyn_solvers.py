"""Exudyn's solvers: settings that joints need, kind and state of the running solver, its user functions.

`StepControl` is the user's option for the steps. Steps that are too coarse for a film are rejected here, through
Exudyn's step control; `exudyn_ehd.coupling.run.step_size` chooses steps by their error.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, TypeAlias, cast

import exudyn as exu

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import CURRENT, Trial
from exudyn_ehd.coupling.kinematics.relative import BoreGap
from exudyn_ehd.joint.spherical.steady import TOUCHING
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import Checked, InputError, require_bool, require_number, require_type, warn_user

Solver: TypeAlias = exu.MainSolverImplicitSecondOrder | exu.MainSolverStatic | exu.MainSolverExplicit
Stored: TypeAlias = tuple[Solver | None, Solver | None]
# Stored solvers before the first run: objects that differ from any solver, and from None.
NO_RUN: Stored = (cast(Solver, object()), cast(Solver, object()))
# Spectral radius for films, and Newton's absolute tolerance, N; see `ConfigureSolver`.
USUAL_RADIUS, ABSOLUTE = 0.6, 1e-8


def stored_solvers(mbs: exu.MainSystem) -> Stored:
    """The solver objects that Exudyn's SolveDynamic and SolveStatic left in ``mbs.sys``; new ones for every run."""
    stored = mbs.sys
    return stored.get("dynamicSolver"), stored.get("staticSolver")


def running_solver(before: Stored, now: Stored) -> Solver | None:
    """Return the running solver, by the stored solvers of the previous run and now; None if it is not in ``mbs.sys``.

    A stored solver outlives its run, and after an exception it looks as if it were still running. So the running solver
    is recognised as a new object.
    """
    changed = [solver for old, solver in zip(before, now, strict=True) if solver is not None and solver is not old]
    working = [solver for solver in changed if not solver.output.finishedSuccessfully]
    # of two new solvers, the other one has run without evaluating this joint: its timer has stopped, or never started
    return min(working, key=lambda solver: solver.timer.total, default=None)


def warn_unknown(name: str) -> None:
    """Warn that steps of the joint ``name`` are made by a solver that is not stored in ``mbs.sys``."""
    warn_user(
        f"LubricatedJoint '{name}': the solver at work is not in mbs.sys: its films take velocities as they are, which "
        "lets journals drift at coarse steps, and a step without a film ends the run where a smaller one might do. Use "
        "ehd.SolveDynamic, mbs.SolveDynamic without storeSolver=False, or mbs.sys['dynamicSolver'] = solver before a "
        "run of a solver of your own.",
        UserWarning,
    )


def is_static(solver: Solver | None) -> bool:
    """Return whether ``solver`` is a static one: its time is a load parameter."""
    return isinstance(solver, exu.MainSolverStatic)


def is_explicit(solver: Solver | None) -> bool:
    """Return whether ``solver`` is an explicit integrator."""
    return isinstance(solver, exu.MainSolverExplicit)


def is_implicit(solver: Solver | None) -> bool:
    """Return whether ``solver`` is implicit: forces at the end of a step, coordinates by a second-order rule."""
    return isinstance(solver, exu.MainSolverImplicitSecondOrder)


def is_finished(solver: Solver | None) -> bool:
    """Return whether the run of ``solver`` has ended successfully; True without a solver, False after a failed run."""
    return solver is None or bool(solver.output.finishedSuccessfully)


def require_end(where: str, mbs: exu.MainSystem, solver: Solver | None) -> None:
    """Raise `InputError` unless a system is in the end state of a finished run of ``solver``."""
    time = mbs.systemData.GetTime(CURRENT)
    if solver is not None and is_finished(solver) and time != solver.it.currentTime:
        raise InputError(
            f"{where}: the system is at t = {time:.9g} s, and its last run has ended at {solver.it.currentTime:.9g} s: "
            "its state was changed since (ComputeLinearizedSystem, Assemble, another solve); read or store it right "
            "behind the run."
        )


def can_reject_step(solver: Solver | None) -> bool:
    """Return whether ``solver`` is running and can repeat the step with a smaller size if a force is nan.

    Implicit and static solvers can, down to their smallest step size. Explicit ones would accept the nan, and initial
    accelerations (step size zero) can't be repeated.
    """
    if solver is None or is_explicit(solver) or is_finished(solver) or solver.timer.total >= 0.0:
        return False
    # the solver's copy of the data decides, not the settings
    iteration = solver.it
    return bool(iteration.adaptiveStep) and iteration.currentStepSize > iteration.minStepSize * (1.0 + 1e-6)


def user_function(mbs: exu.MainSystem, moment: str) -> Any:
    """Return the user's function for a moment of the solver, e.g. ``"PostNewton"``; 0, as in Exudyn, for none."""
    found = getattr(mbs, f"Get{moment}UserFunction")()
    function = found["function"] if isinstance(found, dict) else found
    return function if callable(function) else 0


def idle(moment: str) -> Callable[..., Any]:
    """Return a user function for a moment of the solver that has no effect."""
    return lambda *_: (0.0, -1.0) if moment == "PostNewton" else True


@contextmanager
def hooked(mbs: exu.MainSystem, moment: str, function: Callable[..., object]) -> Iterator[None]:
    """Context in which a function replaces the user's function for a moment of the solver.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    moment : str
        As in the names of Exudyn's functions, e.g. ``"PostNewton"``.
    function : callable
        Function with the replaced function as its first argument, which it must call, and then Exudyn's arguments.
    """
    own = user_function(mbs, moment)
    put = getattr(mbs, f"Set{moment}UserFunction")
    put(partial(function, own or idle(moment)))
    try:
        yield
    finally:
        put(own)


def require_settings(where: str, settings: object) -> None:
    """Raise `InputError` for an object that is not Exudyn's SimulationSettings."""
    if not isinstance(settings, exu.SimulationSettings):
        raise InputError(
            f"{where}.simulationSettings must be exudyn.SimulationSettings(), got {type(settings).__name__}."
        )


def require_time(where: str, settings: exu.SimulationSettings) -> None:
    """Raise `InputError` for a run that ends before it starts, and for an integrator that amplifies vibrations."""
    time = settings.timeIntegration
    if not time.endTime > time.startTime:
        raise InputError(
            f"{where}.simulationSettings.timeIntegration.endTime must be after startTime = {time.startTime:.9g} s, got "
            f"{time.endTime:.9g} s."
        )
    radius = time.generalizedAlpha.spectralRadius
    if not radius <= 1.0:
        raise InputError(
            f"{where}.simulationSettings.timeIntegration.generalizedAlpha.spectralRadius must be between 0 and 1, got "
            f"{radius:g}; beyond 1 vibrations grow in every step, ConfigureSolver sets {USUAL_RADIUS:g}."
        )


def ConfigureSolver(
    simulationSettings: exu.SimulationSettings,
    relativeTolerance: float = 1e-6,
    useModifiedNewton: bool = False,
    absoluteTolerance: float | None = None,
    spectralRadius: float | None = None,
) -> exu.SimulationSettings:
    """Set the tolerances, Newton's method and the spectral radius that lubricated joints need; all else stays.

    Time integration and static solver get the same values:

    - Newton's relative tolerance: 1e-6 in place of Exudyn's 1e-8. A film's force is itself the result of an iteration
      and carries relative noise of about 1e-10, so that residuals can't always fall by eight orders of magnitude.
    - Newton's absolute tolerance: at least 1e-8 N; Exudyn has 1e-10. On a contact wall of 1e11 N/m the round-off of a
      position alone makes 1e-9 N, so that a journal at rest on it would never converge.
    - ``adaptInitialResidual`` off: the tolerance is relative to the first residual only. An iterate deep in a contact
      has a residual of millions of times the step's forces; a tolerance relative to that accepts a wrong state.
    - Full Newton: the Jacobian of the film is exact and cheap, and saves film evaluations. Set
      ``useModifiedNewton=True`` for models with large flexible bodies, where a new factorisation costs more than
      several film evaluations.
    - Spectral radius of generalized alpha: 0.6, where Exudyn's 0.9 is still set. After a halved step the force of a
      stiff film alternates from step to step; at 0.9 this lasts until the next disturbance. Example: a gudgeon pin at
      3000 rpm with a peak pressure of 208 MPa and 360 steps a turn. At 0.9 halved steps make 820 rows instead of 361,
      and the peak pressure is 3.5 % too high; at 0.6 no step is halved, and the error is 0.02 %. Motions that the steps
      resolve are hardly damped: a vibration of 80 steps per period loses 2e-5 of its amplitude per period (2e-7 at 0.9,
      2e-4 at 0.3). For the growth of a whirl over thousands of turns set 0.9. A run above 0.9 warns: velocities of
      journals then alternate from step to step, and the growth may be wrong.
    - ``adaptiveStep`` on, as by default: Exudyn repeats a step with half its size if a film can't be evaluated.

    Parameters
    ----------
    simulationSettings : exudyn.SimulationSettings
        Changed in place.
    relativeTolerance : float, default 1e-6
        Newton's relative tolerance.
    absoluteTolerance : float or None, default None
        Newton's absolute tolerance, N. None: 1e-8, or the value already set if that is larger. For films that carry
        less than 1e-5 N give 1e-6 of their load.
    useModifiedNewton : bool, default False
        True: keep the Jacobian over several steps.
    spectralRadius : float or None, default None
        Spectral radius of generalized alpha, 0 to 1; smaller damps more. None: 0.6 if Exudyn's default 0.9 is set; any
        other value stays.

    Returns
    -------
    exudyn.SimulationSettings
        The same object.

    Raises
    ------
    InputError
        For an object that is no SimulationSettings, tolerances that are not positive, or a spectral radius outside 0 to
        1.

    Examples
    --------
    >>> settings = exu.SimulationSettings()
    >>> settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 2e-3, 20
    >>> settings.solution.file.write, settings.staticSolver.verboseMode = False, 0
    >>> settings = ehd.ConfigureSolver(settings)
    >>> settings.timeIntegration.generalizedAlpha.spectralRadius
    0.6
    """
    require_settings("ConfigureSolver", simulationSettings)
    modified = require_bool("ConfigureSolver.useModifiedNewton", useModifiedNewton)
    tolerance = require_number("ConfigureSolver.relativeTolerance", relativeTolerance, above=0.0)
    if absoluteTolerance is not None:
        require_number("ConfigureSolver.absoluteTolerance", absoluteTolerance, "N", above=0.0)
    alpha = simulationSettings.timeIntegration.generalizedAlpha
    if spectralRadius is not None:
        where = "ConfigureSolver.spectralRadius"
        alpha.spectralRadius = require_number(where, spectralRadius, at_least=0.0, at_most=1.0)
    elif alpha.spectralRadius == exu.SimulationSettings().timeIntegration.generalizedAlpha.spectralRadius:
        alpha.spectralRadius = USUAL_RADIUS
    for solver in (simulationSettings.timeIntegration, simulationSettings.staticSolver):
        solver.newton.relativeTolerance = tolerance
        solver.newton.absoluteTolerance = absoluteTolerance or max(ABSOLUTE, solver.newton.absoluteTolerance)
        solver.newton.adaptInitialResidual = False
        solver.newton.useModifiedNewton = modified
        solver.adaptiveStep = True
    return simulationSettings


@dataclass(frozen=True, kw_only=True)
class StepControl(Checked):
    """Step control: limit the change of the gap in a step, or choose the steps of a run by their error.

    **Of a joint** (``CreateLubricatedJoint(stepControl=StepControl(largest_gap_change=0.1))``): for journals that fall
    onto a contact. Newton's method may converge for a step in which the journal falls from the centre onto its contact,
    or crosses the contact's range at once: the motion is then wrong, without a sign. With the control Exudyn halves a
    step in which the gap changes by more than the limit, and doubles the step again after some good ones
    (``adaptiveStep...`` of its settings). Newton's iterates count too, so that accepted steps end well below the limit.
    At Exudyn's smallest step size every step is accepted. Explicit and static solvers ignore the control.

    **Of a run** (``SolveDynamic(mbs, simulationSettings, stepControl=StepControl(error=0.02))``, `SolveDynamicSparse`
    alike): for loads in bursts. Steps grow and shrink so that the estimated error of the gaps of all joints,
    ``history.step_error``, stays near ``error``; a step with a far larger error is repeated with a smaller size.
    ``numberOfSteps`` of the settings still counts: it gives a reference step, the run's duration over it. The first
    step is an eighth of that, the largest is four times as long. Steps also end at the times at which solution file and
    sensors are written (``writePeriod``).

    Write user functions of loads that depend on time alone: they are called again at earlier times within a step, to
    find jumps. A pulse is found if it lasts a sixteenth of its step. Impacts, and loads that are set from step to step,
    are not seen if they come and go within one step: let the shortest one last five steps.

    Parameters
    ----------
    largest_gap_change : float, default 0.25
        Of a joint: largest change of the minimum gap of the rigid surfaces in a step, over that gap at the start of the
        step (or over the contact's range, if that is larger); the same for the end faces; 0.01 to 1.
    error : float or None, default None
        Of a run: error of the gap to aim at, over the minimum film thickness; 1e-4 to 0.5. The gaps of end faces do not
        count: their films have no estimate. Nor do errors by the memory of films with `ElrodAdams` or `FilmEnergy`
        count, as a warning says: `recommend_steps` measures them.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> mbs.Assemble()
    >>> ehd.SolveDynamic(mbs, settings, stepControl=ehd.StepControl(error=0.02))
    True
    >>> bool(np.nanmax(joint.history.step_error) < 0.05)
    True
    """

    largest_gap_change: float = 0.25
    error: float | None = None

    checks: ClassVar = {
        "largest_gap_change": partial(
            require_number, at_least=0.01, at_most=1.0, hint="leave the control out with stepControl=None."
        ),
        "error": partial(require_number, at_least=1e-4, at_most=0.5),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.error is not None and self.largest_gap_change != StepControl.largest_gap_change:
            raise InputError(
                "StepControl: error is for a whole run, largest_gap_change for one joint; give one StepControl to "
                "SolveDynamic and another to CreateLubricatedJoint."
            )


def require_of_joint(where: str, control: object) -> None:
    """Raise `InputError` unless ``control`` is a step control of a joint, or None."""
    require_type(where, control, StepControl, type(None))
    if isinstance(control, StepControl) and control.error is not None:
        raise InputError(
            f"{where}: StepControl.error sets the steps of a whole run; give it to ehd.SolveDynamic(mbs, "
            "simulationSettings, stepControl=...) or SolveDynamicSparse (mbs.SolveDynamic has no control of errors)."
        )


def require_control(
    where: str, settings: exu.SimulationSettings, control: StepControl | None, *, implicit: bool = True
) -> None:
    """Raise `InputError` for a step control without ``error``, or for a run that does not support one."""
    require_type(f"{where}.stepControl", control, StepControl, type(None))
    if control is None:
        return
    if control.error is None:
        raise InputError(
            f"{where}.stepControl: StepControl.error is missing, the error that the steps aim at (0.02); "
            "largest_gap_change is of a joint: CreateLubricatedJoint(stepControl=...)."
        )
    if not implicit or not settings.timeIntegration.adaptiveStep:
        raise InputError(
            f"{where}.stepControl needs an implicit solver and timeIntegration.adaptiveStep=True, with which Exudyn "
            "can repeat steps; ConfigureSolver(simulationSettings) sets it."
        )


class GapWatch:
    """Check of the steps of one joint by its `StepControl`.

    Parameters
    ----------
    control : StepControl
    bearing : JournalBearing
    """

    def __init__(self, control: StepControl, bearing: JournalBearing) -> None:
        self.share, self.bore, faces = control.largest_gap_change, BoreGap(bearing), getattr(bearing, "thrust", None)
        # ranges of bore and end faces
        ranges = [SMALLEST_GAP_SHARE * bearing.radial_clearance]
        if bearing.contact is not None:
            ranges.append(bearing.contact.onset)
        if bearing.asperity is not None:
            ranges.append(TOUCHING * bearing.asperity.composite_roughness)
        self.ranges = [max(ranges), 0.0]
        if faces is not None:
            least = SMALLEST_GAP_SHARE * faces.clearance
            self.ranges[1] = least if faces.contact is None else faces.contact.onset
        self.before = self.sizes = [math.nan, math.nan]

    def _gaps(self, trial: Trial) -> list[float]:
        """Smallest gaps of bore and end faces."""
        return [self.bore.smallest(trial.motion), math.nan if trial.faces is None else trial.faces.minimum_gap]

    def start(self, trial: Trial, film: float) -> None:
        """Store the gaps at the start of a step; ``film``: minimum film thickness there, nan if it is unknown."""
        bore, faces = self.before = self._gaps(trial)
        self.sizes = [max(bore if math.isnan(film) else film, self.ranges[0]), max(faces, self.ranges[1])]

    def rejects(self, trial: Trial, solver: Solver | None) -> bool:
        """Return whether the step to this state is too coarse and can be repeated."""
        # the comparison is False for a gap that is not finite, which the film reports
        changes = zip(self._gaps(trial), self.before, self.sizes, strict=True)
        too_far = any(abs(now - before) > self.share * size for now, before, size in changes)
        return too_far and is_implicit(solver) and can_reject_step(solver)
