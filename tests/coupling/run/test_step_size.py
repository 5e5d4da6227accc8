"""Steps by their error: their sizes, the times they end at, the user's functions, and what is refused."""

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from tests.sampling import sample

CONTROL = ehd.StepControl(error=0.02)


def scene(**options):
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        film=ehd.FiniteLength(n_theta=32, n_z=6),
        **{"lubricant": ehd.Lubricant(viscosity=0.02)} | options,
    )
    mbs = scenes.new_system()
    journal = mbs.CreateRigidBody(
        inertia=InertiaCylinder(density=7800.0, length=0.1, outerRadius=0.025, axis=2),
        initialAngularVelocity=[0.0, 0.0, 300.0],
        nodeType=exu.NodeType.RotationRxyz,
    )
    mbs.CreateForce(itemNumber=journal, loadVector=[0.0, -3000.0, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="bearing",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
        axial=ehd.Held(),
    )
    return mbs, joint, joint.AddSensor(ehd.Quantity.FORCE)


def settings(end=0.02, steps=100):
    return ehd.ConfigureSolver(scenes.settings(end, steps))


def test_steps_grow_and_shrink_and_the_functions_of_the_user_are_called():
    mbs, joint, _ = scene()
    mbs.Assemble()
    accepted, solved = [], []

    def after_step(mbs, t):
        accepted.append(t)
        return True

    def after_newton(mbs, t):
        solved.append(t)
        return [0.0, -1.0]

    mbs.SetPostStepUserFunction(after_step)
    mbs.SetPostNewtonUserFunction(after_newton)
    run = settings()
    run.solution.sensors.writePeriod = 0.1
    before = run.timeIntegration.adaptiveStepRecoverySteps
    ehd.SolveDynamic(mbs, run, stepControl=CONTROL)
    history = joint.history
    steps = np.diff(history.time)
    assert history.time[-1] == pytest.approx(0.02, abs=1e-12)
    # from an eighth of the settings' step up to more than it
    assert steps[0] == pytest.approx(2.5e-5) and steps.max() > 3e-4
    assert np.nanmax(history.step_error) < 2.0 * CONTROL.error
    # every accepted step, the initial state first
    np.testing.assert_allclose(accepted, history.time, rtol=1e-12)
    assert len(solved) >= len(accepted) - 1
    assert mbs.GetPostStepUserFunction()["function"] is after_step
    assert mbs.GetPostNewtonUserFunction()["function"] is after_newton
    assert run.timeIntegration.adaptiveStepRecoverySteps == before


def test_a_user_who_repeats_steps_is_heard():
    mbs, joint, _ = scene()
    mbs.Assemble()

    def after_newton(mbs, t):
        return [2.0 if mbs.sys["dynamicSolver"].it.currentStepSize > 6.1e-5 else 0.0, 6e-5]

    mbs.SetPostNewtonUserFunction(after_newton)
    ehd.SolveDynamic(mbs, settings(0.002), stepControl=CONTROL)
    assert np.diff(joint.history.time).max() <= 6e-5 * (1.0 + 1e-9)


@pytest.mark.parametrize("sparse", sample([False, True], 1))
def test_steps_end_at_the_times_of_output(sparse):
    mbs, joint, sensor = scene()
    mbs.Assemble()
    run = settings()
    run.solution.sensors.writePeriod = 1e-3
    if sparse:
        ehd.SolveDynamicSparse(mbs, run, stepControl=CONTROL)
    else:
        ehd.SolveDynamic(mbs, run, stepControl=CONTROL)
    written = mbs.GetSensorStoredData(sensor)[:, 0]
    np.testing.assert_allclose(written, np.linspace(0.0, 0.02, 21), atol=1e-11)
    assert np.diff(joint.history.time).min() > 1e-6


@pytest.mark.filterwarnings("ignore:StepControl.error.*oil content:UserWarning")
def test_a_run_that_goes_on():
    """Restart from a state, with the record and the estimate of both parts."""
    mbs, joint, _ = scene(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    mbs.Assemble()
    ehd.SolveDynamic(mbs, settings(0.01, 50), stepControl=CONTROL)
    state = ehd.SystemState.of(mbs, [joint])
    ehd.SolveDynamic(mbs, settings(0.02, 50), restart=state, stepControl=CONTROL)
    history = joint.history
    assert history.time[0] == 0.0 and history.time[-1] == pytest.approx(0.02, abs=1e-12)
    assert np.all(np.diff(history.time) > 0.0) and np.nanmax(history.step_error) < 2.0 * CONTROL.error


def test_input():
    mbs, _, _ = scene()
    mbs.Assemble()
    for bad in (0.0, 1.0, np.nan, "0.1", True):
        with pytest.raises(ehd.InputError, match=r"StepControl\.error"):
            ehd.StepControl(error=bad)
    with pytest.raises(ehd.InputError, match="largest_gap_change"):
        ehd.StepControl(error=0.02, largest_gap_change=0.1)
    for solve in (ehd.SolveDynamic, ehd.SolveDynamicSparse):
        with pytest.raises(ehd.InputError, match=r"StepControl\.error is missing"):
            solve(mbs, settings(), stepControl=ehd.StepControl())
        with pytest.raises(ehd.InputError, match="stepControl"):
            solve(mbs, settings(), stepControl=0.02)
        fixed = settings()
        fixed.timeIntegration.adaptiveStep = False
        with pytest.raises(ehd.InputError, match="adaptiveStep"):
            solve(mbs, fixed, stepControl=CONTROL)
    explicit = settings()
    explicit.timeIntegration.solverType = exu.DynamicSolverType.RK44
    with pytest.raises(ehd.InputError, match="implicit solver"):
        ehd.SolveDynamic(mbs, explicit, stepControl=CONTROL)
    with pytest.raises(ehd.InputError, match="implicit solver"):
        ehd.SolveDynamic(mbs, settings(), stepControl=CONTROL, solverType=exu.DynamicSolverType.RK44)


def test_a_joint_refuses_what_is_of_a_run():
    mbs = scenes.new_system()
    with pytest.raises(ehd.InputError, match="of a whole run"):
        ehd.CreateLubricatedJoint(mbs, name="j", stepControl=CONTROL)


@pytest.mark.parametrize("thermal", [False, True])
def test_errors_that_no_estimate_contains_are_told(thermal):
    """Once for a joint, before the run: those of the oil content and of temperatures follow from no accepted state."""
    options = {"thermal": ehd.FilmEnergy(supply_temperature=313.0)} if thermal else {"cavitation": ehd.ElrodAdams()}
    mbs, *_ = scene(lubricant=ehd.oil("ISO VG 32"), **options)
    mbs.Assemble()
    with pytest.warns(UserWarning, match="are not estimated") as told:
        ehd.SolveDynamic(mbs, settings(0.001, 5), stepControl=CONTROL)
    assert [str(warning.message).count("temperatures" if thermal else "oil content") for warning in told] == [1]
