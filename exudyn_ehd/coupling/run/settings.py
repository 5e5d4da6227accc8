"""Simulation settings that a lubricated joint needs."""

from __future__ import annotations

import exudyn as exu

from exudyn_ehd.status import InputError, require_bool, require_number

# Spectral radius: Exudyn's default, and the one for films.
EXUDYNS_RADIUS, RADIUS = 0.9, 0.6
# Newton's absolute tolerance, N.
ABSOLUTE = 1e-8


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
            f"{radius:g}; beyond 1 vibrations grow in every step, ConfigureSolver sets {RADIUS:g}."
        )


def ConfigureSolver(
    simulationSettings: exu.SimulationSettings,
    relativeTolerance: float = 1e-6,
    useModifiedNewton: bool = False,
    absoluteTolerance: float | None = None,
    spectralRadius: float | None = None,
) -> exu.SimulationSettings:
    """Set the tolerances, Newton's method and the spectral radius that lubricated joints need; all else stays.

    - Newton's relative tolerance 1e-6 in place of 1e-8: a film's force is the result of a solve of its own and carries
      rounding noise of about 1e-10, so that residuals can't always fall by eight orders.
    - Newton's absolute tolerance 1e-8 in place of 1e-10, where it is tighter: next to a wall of 1e11 N/m the rounding
      of a position alone makes 1e-9 N, so that a journal at rest on it would never pass and be refused.
    - Newton's tolerance relative to its first residual only (``adaptInitialResidual`` off): where a first iterate
      lands deep in a contact, its residual is millions of times the step's forces, and a tolerance relative to it
      accepts any state on the way back.
    - Full Newton: the Jacobian of the film is exact and cheap (one tangent from the factor the force has left), and
      saves film evaluations. Set ``useModifiedNewton=True`` for models with large flexible bodies, where a new
      factorisation costs more than several film evaluations.
    - Spectral radius of generalized alpha 0.6, where Exudyn's 0.9 is still set: stiff films make every step that was
      halved an alternation of forces, which at 0.9 outlasts the next disturbance. A gudgeon pin at 3000 rpm, peak of
      208 MPa, 360 steps a turn: 820 rows with halved steps and 3.5 % too high a peak at 0.9, 361 rows and 0.02 % at
      0.6. What is resolved hardly feels it: a vibration of 80 steps per period loses 2e-5 of its amplitude per period
      (2e-7 at 0.9, 2e-4 at 0.3); for the growth of a whirl over thousands of turns name a radius of 0.9. A run with
      a larger one warns: velocities of journals then alternate from step to step, and growth may be wrong.
    - The step size control stays on (Exudyn's default): a film that can't be evaluated asks for a smaller step.

    Parameters
    ----------
    simulationSettings : exudyn.SimulationSettings
        Changed in place.
    relativeTolerance : float, default 1e-6
        Newton's relative tolerance.
    absoluteTolerance : float or None, default None
        Newton's absolute tolerance, N. None: 1e-8, and a larger one that is set already stays. Films that carry less
        than 1e-5 N want 1e-6 of their load.
    useModifiedNewton : bool, default False
        Keep the Jacobian over several steps.
    spectralRadius : float or None, default None
        Of generalized alpha, 0 to 1. None: 0.6 in place of Exudyn's default 0.9; one that is set already stays.

    Returns
    -------
    exudyn.SimulationSettings
        The same object.

    Raises
    ------
    InputError
        For what are no settings of Exudyn, tolerances that are not positive, or a spectral radius beyond 0 to 1.

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
    elif alpha.spectralRadius == EXUDYNS_RADIUS:
        alpha.spectralRadius = RADIUS
    for solver in (simulationSettings.timeIntegration, simulationSettings.staticSolver):
        solver.newton.relativeTolerance = tolerance
        solver.newton.absoluteTolerance = absoluteTolerance or max(ABSOLUTE, solver.newton.absoluteTolerance)
        solver.newton.adaptInitialResidual = False
        solver.newton.useModifiedNewton = modified
        solver.adaptiveStep = True
    return simulationSettings
