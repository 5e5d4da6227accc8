"""Exudyn's solvers with this package's errors, and runs that continue from a stored state.

Initial velocities: an ideal joint allows one velocity of a body. A film allows any velocity, and stops a velocity that
does not fit within the clearance, by large forces: the journal crosses its bore at the start of a run. Exudyn does not
make initial velocities consistent.
"""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from functools import partial
from typing import overload

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import CURRENT, INITIAL, START_OF_STEP, objects_of, require_system
from exudyn_ehd.coupling.exudyn_solvers import StepControl, hooked, require_control, require_settings, require_time
from exudyn_ehd.coupling.kinematics.relative import levers_of
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.coupling.run.newton import StartGuess, free_bushes, refuse
from exudyn_ehd.coupling.run.periodic import Closing, LastCycle, UntilPeriodic, run_progress
from exudyn_ehd.coupling.run.restart import SystemState, load_state, settle
from exudyn_ehd.coupling.run.step_size import steps_by_error
from exudyn_ehd.status import EHDError, InputError, PlausibilityWarning, RunError, require_type, warn_user

JOINTS = "lubricatedJoints"
# Limits of a warning about initial velocities: number of steps in which a journal crosses the clearance, below which
# the impact is hardly resolved; velocity over clearance times spin, which is a hundred times that of an orbit. A larger
# number of steps, and a smaller ratio: more warnings.
FEW_STEPS, FASTER = 10.0, 100.0
_IMPLICIT = (exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.TrapezoidalIndex2)


def register_joint(mbs: exu.MainSystem, make: Callable[[exu.MainSystem], Joint]) -> None:
    """Register a joint in a system, by a function that makes its handle from the system.

    The handle itself would keep the system alive for ever, because Python cannot see the references of the system's
    variables.
    """
    mbs.variables.setdefault(JOINTS, []).append(make)


def joints_of(mbs: exu.MainSystem) -> list[Joint]:
    """Lubricated joints of a system in the order of their creation, without those from before ``mbs.Reset()``."""
    known = mbs.variables.get(JOINTS, [])
    joints = [make(mbs) for make in known]
    # Exudyn's Reset does not change variables
    present = [joint.element.presence.found(mbs) is not None for joint in joints]
    if not all(present):
        mbs.variables[JOINTS] = [make for make, there in zip(known, present, strict=True) if there]
    return [joint for joint, there in zip(joints, present, strict=True) if there]


def require_new(where: str, mbs: exu.MainSystem, name: str) -> None:
    """Raise `InputError`, in the name of ``where``, for a name that another lubricated joint of the system has."""
    if not isinstance(name, str):
        raise InputError(f"{where}.name must be a str, got {name!r}.")
    if name in {joint.name for joint in joints_of(mbs)}:
        raise InputError(
            f"{where}.name '{name}' is taken by another lubricated joint of the system; names are for messages: "
            "choose another."
        )


def require_run(where: str, mbs: exu.MainSystem, settings: exu.SimulationSettings) -> None:
    """Raise `InputError` for a wrong system or settings, and for a system with deleted items of a joint."""
    require_system(where, mbs)
    require_settings(where, settings)
    for joint in joints_of(mbs):
        joint.element.presence.require(mbs)


@overload
def SolveDynamic(
    mbs: exu.MainSystem,
    simulationSettings: exu.SimulationSettings,
    *,
    restart: SystemState | str | pathlib.Path | None = None,
    stepControl: StepControl | None = None,
    until_periodic: None = None,
    threads: int | None = 1,
    **options: object,
) -> bool: ...
@overload
def SolveDynamic(
    mbs: exu.MainSystem,
    simulationSettings: exu.SimulationSettings,
    *,
    restart: SystemState | str | pathlib.Path | None = None,
    stepControl: StepControl | None = None,
    until_periodic: UntilPeriodic,
    threads: int | None = 1,
    **options: object,
) -> LastCycle: ...
def SolveDynamic(
    mbs: exu.MainSystem,
    simulationSettings: exu.SimulationSettings,
    *,
    restart: SystemState | str | pathlib.Path | None = None,
    stepControl: StepControl | None = None,
    until_periodic: UntilPeriodic | None = None,
    threads: int | None = 1,
    **options: object,
) -> bool | LastCycle:
    """Integrate in time as ``mbs.SolveDynamic``, with fewer Newton iterations, clearer errors and restarts.

    Newton's method of a step starts at the accelerations of the steps before (`StartGuess`). The solution is the same,
    with two to four times fewer iterations, and without halved steps and the errors in the forces that these leave.
    Exudyn starts at zero accelerations, some 0.3 h^2 a away from the solution (step h, acceleration a): in a crank
    drive at steps of a degree, more than the film thickness.

    If a film can't be evaluated, the run ends with this package's error, which names the joint and the remedy, instead
    of an Exudyn error with this one as its cause. If Newton's method does not converge, the error describes the last
    accepted state of every joint. Either way ``joint.history`` holds all accepted steps, and `SaveState` stores the
    last one.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    simulationSettings : exudyn.SimulationSettings
    restart : SystemState, path or None, default None
        Result or file of `SaveState`: the run goes on from this state. The system must be assembled, and of the same
        build: coordinates, joints, bearings. ``startTime`` of the settings is set to the state's time; ``endTime`` must
        be later, and ``numberOfSteps`` divides the time between them. With the same step size and full Newton, results
        equal those of a run without the stop, to round-off: motions, films with their memory, and histories.
    stepControl : StepControl or None, default None
        ``StepControl(error=0.02)``: steps are chosen by the error that they make in the films. None: steps of the
        settings.
    until_periodic : UntilPeriodic or None, default None
        Ends the run as soon as the orbits of all joints repeat themselves. None: the run ends at ``endTime``.
    threads : int or None, default 1
        Not supported any more: films are evaluated one after the other.
    **options
        As in ``mbs.SolveDynamic``: solverType, updateInitialValues, ...; storeSolver is always True.

    Returns
    -------
    bool or LastCycle
        True after success, as ``mbs.SolveDynamic``; with ``until_periodic`` the last cycle.

    Raises
    ------
    FilmError
        If a film could not be evaluated, or if the steps of an explicit solver are too large for it.
    RunError
        If the solver failed for another reason, or if the orbits have not closed by ``endTime``.
    InputError
        If the restart belongs to another system; if the step control has no ``error``, the solver is explicit or
        ``adaptiveStep`` is off; if a run with ``until_periodic`` has no joints or no time for three periods.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> load = mbs.CreateForce(itemNumber=shaft, loadVector=[0, -500, 0])
    >>> mbs.Assemble()
    >>> ehd.SolveDynamic(mbs, settings)
    True
    >>> round(float(1e6 * joint.history.minimum_gap[-1]), 2)  # um
    23.72
    """
    require_run("SolveDynamic", mbs, simulationSettings)
    state = None
    if restart is not None:
        state = restart if isinstance(restart, SystemState) else load_state(restart)
    else:
        require_time("SolveDynamic", simulationSettings)
    time, kind = simulationSettings.timeIntegration, options.get("solverType")
    implicit = (time.solverType if kind is None else kind) in _IMPLICIT
    require_control("SolveDynamic", simulationSettings, stepControl, implicit=implicit)
    joints = joints_of(mbs)
    if not implicit:
        for element in (joint.element for joint in joints if joint.element.is_massless):
            raise element.failures.no_mass()
        _refuse_inactive(mbs)
    require_type("SolveDynamic.until_periodic", until_periodic, UntilPeriodic, type(None))
    with ExitStack() as around:
        if state is not None:
            around.enter_context(_restarted(mbs, simulationSettings, state))
        elif mbs.systemIsConsistent:
            states = [(j.name, j.element.motion(mbs, INITIAL), j.element.model.bearing) for j in joints]
            warn_of_misfit(states, (time.endTime - time.startTime) / time.numberOfSteps)
        watch = None if until_periodic is None else Closing(joints, until_periodic, simulationSettings)
        if watch is not None:
            around.enter_context(hooked(mbs, "PostStep", watch.after_step))
        around.enter_context(running("SolveDynamic", mbs, simulationSettings, stepControl, threads))
        if implicit:
            start = StartGuess([joint.element for joint in joints], simulationSettings)
            around.enter_context(hooked(mbs, "PreNewtonResidual", start.begin))
            around.enter_context(hooked(mbs, "PostNewton", start.go_on))
        # films read step size, integration rule and state from the stored solver
        good = bool(mbs.SolveDynamic(simulationSettings, **options | {"storeSolver": True}))
    return good if watch is None else watch.last_cycle(mbs)


def SolveStatic(mbs: exu.MainSystem, simulationSettings: exu.SimulationSettings, **options: object) -> bool:
    """Find a static equilibrium as ``mbs.SolveStatic``, with clearer errors; see `SolveDynamic`.

    A film without relative speed, a journal's spin and its place along the axis have no stiffness of their own: give
    speeds by initial velocities, and hold what is free by supports, springs or constraints.

    Films are steady ones, but heat is not in balance: a film with ``thermal`` keeps its initial temperature, and a
    warning says so. With ``updateInitialValues=True`` the next run starts with the oil content of these films.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    simulationSettings : exudyn.SimulationSettings
    **options
        As in ``mbs.SolveStatic``.

    Returns
    -------
    bool
        As ``mbs.SolveStatic``.

    Raises
    ------
    FilmError, RunError
        As `SolveDynamic`.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> ground = mbs.CreateGround()
    >>> _ = mbs.CreateGenericJoint(itemNumbers=[ground, shaft], position=[0, 0, 0], constrainedAxes=[0, 0, 1, 1, 1, 1])
    >>> load = mbs.CreateForce(itemNumber=shaft, loadVector=[0, -500, 0])
    >>> mbs.Assemble()
    >>> ehd.SolveStatic(mbs, settings)
    True
    >>> round(joint.history.force[-1, 1])  # N, along y
    500
    """
    require_run("SolveStatic", mbs, simulationSettings)
    if heated := [joint.name for joint in joints_of(mbs) if joint.element.model.bearing.thermal is not None]:
        warn_user(
            f"SolveStatic: the film of joint '{heated[0]}' keeps its initial temperature, as a static solution has no "
            "balance of heat; give thermal=... the initial_temperature that is in balance, or take SolveEquilibrium.",
            UserWarning,
        )
    with own_errors(mbs, "SolveStatic"):
        found = bool(mbs.SolveStatic(simulationSettings, **options | {"storeSolver": True}))
    for joint in joints_of(mbs) if found and options.get("updateInitialValues") else ():
        settle(mbs, joint.element, heated=False)
    return found


def _refuse_inactive(mbs: exu.MainSystem) -> None:
    """Raise an error that names an inactive joint, for which Exudyn's explicit solvers give only a number."""
    for number, data in objects_of(mbs):
        if "Joint" in data["objectType"] and not data.get("activeConnector", True):
            raise InputError(
                f"SolveDynamic: explicit solvers refuse constraints, also inactive ones like object {int(number)} "
                f"'{data['name']}' (ReplaceJoint switches joints off and leaves them in the model); take an implicit "
                "solver, or a model without that joint and CreateLubricatedJoint."
            )


def SaveState(mbs: exu.MainSystem, path: str | pathlib.Path) -> SystemState:
    """Store the last accepted state of a system with all its lubricated joints; the file appears whole or not at all.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system after a run, successful or not.
    path : path
        File to write, ending in ``.npz``.

    Returns
    -------
    SystemState
        The stored state, for ``SolveDynamic(restart=...)`` in this process; another one reads the file.

    Raises
    ------
    InputError
        If the system has no run to take a state from.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> state = ehd.SaveState(mbs, "state.npz")
    >>> settings.timeIntegration.endTime = 4e-3
    >>> ehd.SolveDynamic(mbs, settings, restart="state.npz")  # goes on, also in another process
    True
    """
    require_system("SaveState", mbs)
    (state := SystemState.of(mbs, joints_of(mbs))).save(path)
    return state


@contextmanager
def own_errors(mbs: exu.MainSystem, where: str) -> Iterator[None]:
    """Turn Exudyn's errors into this package's; errors of other user functions pass."""
    refused: dict[tuple[float, float], str] = {}
    for joint in joints_of(mbs):
        joint.element.steps.in_own_run, joint.element.failures.refused = True, refused
    try:
        yield
        for joint in joints_of(mbs):
            joint.element.require_film(mbs.systemData.GetTime())
    except exu.ExudynError as error:
        cause: BaseException = error
        while cause.__cause__ is not None:
            cause = cause.__cause__
        if isinstance(cause, EHDError):
            static = f"{_unheld(mbs)} " if where == "SolveStatic" else ""
            raise type(cause)(f"{cause} {static}{_kept(mbs)}") from error
        # Exudyn wraps an interrupt like any other exception of a user function
        if isinstance(cause, KeyboardInterrupt):
            raise KeyboardInterrupt(_kept(mbs)) from error
        if cause is not error:
            raise
        # Exudyn's input errors have a clear message; only errors of its solvers need more text
        if not isinstance(error, exu.SolverError):
            raise RunError(f"{where}: {str(error).strip()} {_kept(mbs)}") from error
        raise RunError(f"{where}: {_story(mbs, static=where == 'SolveStatic')}") from error
    finally:
        for joint in joints_of(mbs):
            joint.element.steps.in_own_run = False
            joint.element.steps.tell(mbs)


def _kept(mbs: exu.MainSystem) -> str:
    time = mbs.systemData.GetTime(START_OF_STEP)
    return f"The last accepted state is at t = {time:.9g} s; joint.history holds all steps up to it."


def _story(mbs: exu.MainSystem, *, static: bool) -> str:
    """Describe the joints in the step in which a solver gave up, for its error message."""
    time = mbs.systemData.GetTime(START_OF_STEP)
    parts = [f"Exudyn's solver ended without success at t = {time:.9g} s, though every film could be evaluated; "]
    for joint in joints_of(mbs):
        history = joint.element.steps.history(mbs)
        if not history.time.size:
            continue
        parts.append(
            f"LubricatedJoint '{joint.name}': {joint.element.failures.place(history.motion[-1])}minimum film thickness "
            f"{np.fmin(history.minimum_gap, history.thrust_minimum_gap)[-1]:.6g} m, "
            f"force {np.linalg.norm(history.force[-1]):.6g} N; "
        )
    if static:
        parts.append(f"{_unheld(mbs)[:-1]}; ")
    parts.append(
        "Newton's method most likely did not converge at the smallest step: use ConfigureSolver(simulationSettings), "
        "smaller steps or a StepControl, soften jumps of loads and speeds, and check constraints that leave nothing "
        "to move. joint.history holds all accepted steps."
    )
    return "".join(parts)


def _unheld(mbs: exu.MainSystem) -> str:
    """Name the motions without stiffness in a static solve, for messages."""
    free = "".join(f"FlexibleBush '{bush.name}', which no support or carrier holds, " for bush in free_bushes(mbs))
    return (
        f"In a static solve {free}a film without relative speed, a journal's spin and its place along the axis have no "
        "stiffness of their own: give speeds by initial velocities and hold what is free by supports, springs or "
        "constraints."
    )


@contextmanager
def running(
    where: str,
    mbs: exu.MainSystem,
    settings: exu.SimulationSettings,
    control: StepControl | None,
    threads: int | None,
) -> Iterator[None]:
    """Context for the run of a solver, with this package's errors.

    Steps are chosen by ``control``, steps without a valid film are rejected, and progress is shown.
    """
    if threads not in (1, None):
        raise InputError(
            f"{where}.threads is not supported any more, got {threads!r}: films are evaluated one after the other; let "
            "several runs take a core each, as parameter_study(processes=...) does."
        )
    joints = joints_of(mbs)
    films = [joint.element for joint in joints]
    aim = None if control is None else control.error
    with (
        nullcontext() if aim is None else steps_by_error(mbs, settings, films, aim),
        hooked(mbs, "PostNewton", partial(refuse, films)),
        own_errors(mbs, where),
        run_progress(mbs, settings, joints),
    ):
        yield


@contextmanager
def _restarted(mbs: exu.MainSystem, settings: exu.SimulationSettings, state: SystemState) -> Iterator[None]:
    """Context that sets a state in a system for a run; user functions and settings are restored at its end."""
    require_system("SolveDynamic.restart", mbs, assembled=True)
    state.put_into(mbs, joints_of(mbs))
    integration = settings.timeIntegration
    integration.startTime = state.time
    if not integration.endTime > state.time:
        raise InputError(
            f"SolveDynamic.restart: endTime must be after the stored state's time {state.time:.9g} s, got "
            f"{integration.endTime:.9g} s."
        )
    alpha = integration.generalizedAlpha
    first = [True]

    def pre_step(own: Callable[..., object], mbs: exu.MainSystem, t: float) -> bool:
        if first[0]:
            # Exudyn starts with algorithmic accelerations equal to the others; these differ once a run is under way
            mbs.systemData.SetODE2Coordinates_tt(state.accelerations.tolist(), CURRENT)
            first[0] = False
        return bool(own(mbs, t))

    if state.algorithmic is None:
        yield
        return
    computes, alpha.computeInitialAccelerations = alpha.computeInitialAccelerations, False
    try:
        with hooked(mbs, "PreStep", pre_step):
            yield
    finally:
        alpha.computeInitialAccelerations = computes


def warn_of_misfit(states: Iterable[tuple[str, np.ndarray, JournalBearing]], step: float) -> None:
    """Warn of journals that cross their bores at the start of a run with steps of ``step`` s.

    ``states``: names of the joints, their initial motions (10,), and their bearings.
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
