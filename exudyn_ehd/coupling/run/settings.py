"""Settings of a run: what a lubricated joint needs, what is refused, and initial velocities that do not fit the joints.

An ideal joint leaves a body one velocity. A film takes any, and stops what does not fit within the clearance, with
forces that nobody meant: journals are thrown across their bores at the start of a run. Exudyn does not make initial
velocities consistent.
"""

from __future__ import annotations

from collections.abc import Iterable

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.kinematics.relative import levers_of
from exudyn_ehd.coupling.watch.doubts import USUAL_RADIUS
from exudyn_ehd.coupling.watch.solver_state import StepControl
from exudyn_ehd.status import (
    InputError,
    PlausibilityWarning,
    require_bool,
    require_number,
    require_type,
    warn_user,
)

# Newton's absolute tolerance, N.
ABSOLUTE = 1e-8
# Steps in which a journal crosses the clearance. Below one nothing of the impact is resolved; below the first it is
# hardly, which is told of a journal that moves faster than the second times clearance x spin, a hundred times as fast
# as it orbits. Larger numbers of steps, and a smaller ratio, tell of more runs.
FEW_STEPS, FASTER = 10.0, 100.0


def require_settings(where: str, settings: object) -> None:
    """Refuse what are no settings of Exudyn."""
    if not isinstance(settings, exu.SimulationSettings):
        raise InputError(
            f"{where}.simulationSettings must be exudyn.SimulationSettings(), got {type(settings).__name__}."
        )


def require_time(where: str, settings: exu.SimulationSettings) -> None:
    """Refuse a run that ends before it starts, and an integrator that lets every vibration grow."""
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
        radius = require_number("ConfigureSolver.spectralRadius", spectralRadius, at_least=0.0, at_most=1.0)
        alpha.spectralRadius = radius
    elif alpha.spectralRadius == exu.SimulationSettings().timeIntegration.generalizedAlpha.spectralRadius:
        alpha.spectralRadius = USUAL_RADIUS
    for solver in (simulationSettings.timeIntegration, simulationSettings.staticSolver):
        solver.newton.relativeTolerance = tolerance
        solver.newton.absoluteTolerance = absoluteTolerance or max(ABSOLUTE, solver.newton.absoluteTolerance)
        solver.newton.adaptInitialResidual = False
        solver.newton.useModifiedNewton = modified
        solver.adaptiveStep = True
    return simulationSettings


def require_control(
    where: str, settings: exu.SimulationSettings, control: StepControl | None, *, implicit: bool = True
) -> None:
    """Refuse a control that is none of a run, or a run that has no use for one."""
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


def warn_of_misfit(states: Iterable[tuple[str, np.ndarray, JournalBearing]], step: float) -> None:
    """Warn of journals that cross their bores at the start of a run with steps of ``step`` s.

    ``states``: names of the joints, their motions (10,) there, and their bearings.
    """
    told: list[tuple[float, str]] = []
    for name, motion, bearing in states:
        c, speed = bearing.radial_clearance, float(np.linalg.norm(levers_of(bearing) * motion[4:8]))
        spin = float(np.linalg.norm(motion[8 : 9 if isinstance(bearing, JournalBearing) else None]))
        thrown = step * speed * FEW_STEPS > c and speed > FASTER * c * spin > 0.0
        if thrown or step * speed > c:
            told.append((speed, f"{speed:.3g} m/s in LubricatedJoint '{name}' (clearance {c:.3g} m)"))
    if told:
        warn_user(
            "SolveDynamic: the initial velocities do not fit the joints; journals move across their bores by "
            f"{', '.join(text for _, text in sorted(told, reverse=True))}, and their films stop them within the "
            "clearance: forces and pressures of the start are those of an impact. Give every body the velocities of "
            "the mechanism (that of its centre of mass is the joint's plus angular velocity x distance); for an impact "
            "that is meant take steps of a tenth of clearance / velocity or less.",
            PlausibilityWarning,
        )
