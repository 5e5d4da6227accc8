"""Step control: the steps that it lets pass, what it leaves alone, and its input."""

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd

CLEARANCE = 50e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=0.025,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=4),
)


def run(control, step=1e-3, solver=None):
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    body = mbs.CreateRigidBody(
        inertia=InertiaCuboid(7800, [0.05, 0.05, 0.1]),
        nodeType=exu.NodeType.RotationRxyz,
        initialAngularVelocity=[0, 0, 300.0],
        gravity=[0, -500.0, 0],
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="j",
        itemNumbers=[ground, body],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=BEARING,
        stepControl=control,
    )
    mbs.Assemble()
    settings = ehd.ConfigureSolver(scenes.settings(0.01, round(0.01 / step)))
    mbs.SolveDynamic(settings, **({} if solver is None else {"solverType": solver}))
    return joint


@pytest.mark.parametrize("share", [0.05, 0.2])
def test_no_step_changes_the_gap_by_more_than_its_share(share):
    joint = run(ehd.StepControl(largest_gap_change=share))
    gap = CLEARANCE * (1.0 - joint.history.largest_eccentricity_ratio)
    change = np.abs(np.diff(gap)) / gap[:-1]
    # to rounding
    assert change.max() <= share * (1.0 + 1e-9)
    assert (
        "in 'j' the gap changed by more than StepControl.largest_gap_change" in joint.element.failures.refused.values()
    )
    assert np.diff(joint.history.time).min() > 1.1e-8
    # Newton's iterates count too, so that steps end well below; not by orders
    assert change.max() > 0.1 * share


def test_a_control_that_has_nothing_to_do_changes_no_bit():
    plain, watched = run(None, 2e-5), run(ehd.StepControl(largest_gap_change=1.0), 2e-5)
    assert not any("StepControl" in reason for reason in watched.element.failures.refused.values())
    np.testing.assert_array_equal(watched.history.motion, plain.history.motion)


@pytest.mark.slow
def test_explicit_solvers_are_not_touched():
    control = ehd.StepControl(largest_gap_change=0.01)
    plain, watched = (run(c, 1e-5, exu.DynamicSolverType.RK44) for c in (None, control))
    np.testing.assert_array_equal(watched.history.motion, plain.history.motion)


def test_input():
    for bad in (0.0, 0.001, 1.5, np.nan, "0.1", True):
        with pytest.raises(ehd.InputError, match=r"StepControl\.largest_gap_change"):
            ehd.StepControl(largest_gap_change=bad)
    with pytest.raises(ehd.InputError, match="stepControl"):
        run(0.2)
