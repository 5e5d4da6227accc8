"""Runs that end badly: the package's own errors, what they say, and what stays readable."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd

CLEARANCE = 50e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.025, length=0.025, radial_clearance=CLEARANCE, lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=4),
)  # fmt: skip


def system(bearing=BEARING, load=lambda t: -500.0, offset=0.0):
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    node = mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6, initialVelocities=[0, 0, 0, 0, 0, 300.0]))
    body = mbs.AddObject(eii.ObjectRigidBody(mass=2.0, inertia=[1e-3, 1e-3, 1e-3, 0, 0, 0], nodeNumber=node))
    marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, offset]))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=lambda mbs, t, v: [0, load(t), 0]
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def settings(steps=100, **options):
    return ehd.ConfigureSolver(scenes.settings(steps * 1e-4, steps), **options)


def test_film_error_comes_through_exudyn():
    mbs, joint = system(load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.FilmError) as caught:
        ehd.SolveDynamic(mbs, settings())
    text = str(caught.value)
    last = joint.history.time[-1]
    parts = [
        "'big end'",
        "t = ",
        "eccentricity ratio",
        "minimum gap",
        "gap closed",
        "contact=RegularisedWall",
        f"{last:.9g} s",
    ]
    for part in parts:
        assert part in text, (part, text)
    assert isinstance(caught.value.__cause__, exu.ExudynError)
    assert last > 0.0
    assert np.all(np.isfinite(joint.history.force))
    # and it is the touch: the last accepted gap is a sliver
    assert joint.history.minimum_gap[-1] < 0.01 * CLEARANCE


def test_static_solver_too():
    mbs, _ = system(load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.EHDError):
        ehd.SolveStatic(mbs, settings())


def test_errors_of_other_user_functions_pass():
    def load(t):
        if t > 2e-3:
            raise ValueError("no such load")
        return -500.0

    mbs, joint = system(load=load)
    with pytest.raises(exu.ExudynError) as caught:
        ehd.SolveDynamic(mbs, settings())
    assert not isinstance(caught.value, ehd.EHDError)
    assert isinstance(caught.value.__cause__, ValueError)
    assert joint.history.time[-1] == pytest.approx(2e-3, abs=2e-4)


def test_newton_that_does_not_converge_is_explained():
    mbs, joint = system()
    s = settings(relativeTolerance=1e-13)
    s.timeIntegration.newton.absoluteTolerance = 1e-300
    s.timeIntegration.newton.maxIterations = 2
    with pytest.raises(ehd.RunError) as caught:
        ehd.SolveDynamic(mbs, s)
    for part in ("'big end'", "t = ", "eccentricity ratio", "minimum gap", "ConfigureSolver", "StepControl"):
        assert part in str(caught.value)
    assert joint.history.time.size >= 1


def test_success_returns_true_and_options_arrive():
    mbs, joint = system()
    assert ehd.SolveDynamic(mbs, settings(20), solverType=exu.DynamicSolverType.TrapezoidalIndex2) is True
    assert joint.history.time.size == 21


def test_liner_is_advised_a_contact():
    import dataclasses

    liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e8)
    mbs, _ = system(dataclasses.replace(BEARING, bush=liner), load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.FilmError, match="RegularisedWall"):
        ehd.SolveDynamic(mbs, settings())
