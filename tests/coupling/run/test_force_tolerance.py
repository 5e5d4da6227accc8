"""Newton's tolerance: rounding of positions far from the origin, under meganewtons; first guesses within a wall."""

import math

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder, RigidBodyInertia

import exudyn_ehd as ehd
from tests.sampling import sample

LOAD, MASS, RADIUS, SPEED, STEPS = 1e6, 1e5, 0.3, 50.0, 120


def rotor(place, solve, **newton):
    """A rotor of 100 t under its weight and a fifth of it turning, for two thirds of a turn from its equilibrium."""
    mbs = scenes.new_system()
    journal = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=MASS, inertiaTensor=0.5 * MASS * RADIUS**2 * np.eye(3)),
        referencePosition=list(place),
        initialAngularVelocity=[0, 0, SPEED],
        nodeType=exu.NodeType.RotationRxyz,
    )

    def load(mbs, t, vector):
        turning = 0.2 * LOAD * np.array([math.cos(SPEED * t), math.sin(SPEED * t)])
        return [turning[0], turning[1] - LOAD, 0.0]

    mbs.CreateForce(itemNumber=journal, loadVector=[0, -LOAD, 0], loadVectorUserFunction=load)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="rotor",
        itemNumbers=[mbs.CreateGround(referencePosition=list(place)), journal],
        position=list(place),
        axis=[0, 0, 1],
        bearing=ehd.JournalBearing(
            journal_radius=RADIUS,
            length=0.3,
            radial_clearance=3e-4,
            lubricant=ehd.Lubricant(viscosity=0.05),
            film=ehd.FiniteLength(n_theta=48, n_z=6),
        ),
        axial=ehd.Held(),
    )
    mbs.Assemble()
    joint.place_in_equilibrium(load=(0.2 * LOAD, -LOAD))
    settings = ehd.ConfigureSolver(scenes.settings(STEPS * 2.0 * math.pi / SPEED / 180, STEPS))
    for name, value in newton.items():
        setattr(settings.timeIntegration.newton, name, value)
    solve(mbs, settings)
    solver = mbs.sys["dynamicSolver"]
    assert settings.timeIntegration.newton.absoluteTolerance == newton.get("absoluteTolerance", 1e-8)
    return joint.history, solver


@pytest.mark.parametrize("solve", sample([ehd.SolveDynamic, ehd.SolveDynamicSparse], 1))
def test_no_step_is_halved_far_from_the_origin(solve):
    near, _ = rotor((0, 0, 0), lambda mbs, settings: mbs.SolveDynamic(settings))
    for place in ((0, 20, 0), (-70, 10, 80)):
        far, _ = rotor(place, solve)
        assert far.time.size == STEPS + 1
        assert np.abs(far.force - near.force)[:, :2].max() < 1e-6 * LOAD


def test_tolerance_is_a_share_of_the_forces_or_what_the_user_has_set():
    level = 0.1 * 1e-6 * LOAD
    assert rotor((0, 0, 0), ehd.SolveDynamic)[1].newton.absoluteTolerance == pytest.approx(level, rel=0.3)
    assert rotor((0, 0, 0), ehd.SolveDynamic, absoluteTolerance=2.0)[1].newton.absoluteTolerance == 2.0
    # of six coordinates and the multiplier that holds the axis
    each = rotor((0, 0, 0), ehd.SolveDynamic, weightTolerancePerCoordinate=True)[1].newton.absoluteTolerance
    assert each == pytest.approx(level / math.sqrt(7.0), rel=0.3)
    # a residual in coordinates
    assert rotor((0, 0, 0), ehd.SolveDynamic, residualMode=1)[1].newton.absoluteTolerance == 1e-8


@pytest.mark.parametrize("solve", [ehd.SolveDynamic, ehd.SolveDynamicSparse])
def test_a_steel_ring_that_flies_without_a_joint_halves_no_step(solve):
    """Rounding of places that have moved by decimetres makes forces of 1e-6 N."""
    mbs, steps, step = scenes.new_system(), 8, 2e-3
    mesh = ehd.HollowCylinder(inner_radius=0.03, thickness=0.012, length=0.03, axial=1, radial=1, circumferential=8)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    ring = ehd.CreateFlexibleBush(
        mbs,
        bush=ehd.ANCFBush(mesh=mesh, material=steel),
        outer=ehd.FreeOuter(),
        loads=[ehd.Gravity(acceleration=(0.0, -9.81, 0.0))],
        initialVelocity=(50.0, 0.0, 0.0),
    )
    mbs.Assemble()
    settings = ehd.ConfigureSolver(scenes.settings(steps * step, steps), relativeTolerance=1e-10)
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    times = []
    mbs.SetPostStepUserFunction(lambda mbs, t: not times.append(t))
    solve(mbs, settings)
    assert len(times) == 1 + steps
    falls = np.array([50.0, -9.81 * steps * step, 0.0])
    assert np.abs(ring.velocities() - falls).max() < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("place", sample([[0.0, 0.0, 0.0], [-70.0, 10.0, 80.0]], 1), ids=["near", "far"])
@pytest.mark.parametrize("solve", sample([ehd.SolveDynamic, ehd.SolveDynamicSparse], 1))
def test_a_housing_that_falls_with_its_nodal_bush_halves_no_step(solve, place):
    """Nodes on a carrier have the rounding of their places: forces of 1e-6 N at centimetres, of 1e-3 N at 100 m."""
    mbs, steps, step = scenes.new_system(), 40, 1e-4
    mesh = ehd.HollowCylinder(inner_radius=0.03003, thickness=0.02, length=0.066, axial=1, radial=1, circumferential=8)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    bodies = [
        mbs.CreateRigidBody(
            inertia=RigidBodyInertia(mass=mass, inertiaTensor=0.02 * np.eye(3)),
            referencePosition=list(place),
            gravity=[0.0, -9.81, 0.0],
            initialAngularVelocity=[0.0, 0.0, speed],
            nodeType=exu.NodeType.RotationRxyz,
        )
        for mass, speed in ((3.0, 0.0), (2.0, 300.0))
    ]
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="film",
        itemNumbers=bodies,
        position=list(place),
        axis=[0, 0, 1],
        bearing=ehd.JournalBearing(
            journal_radius=0.03,
            length=0.066,
            radial_clearance=3e-5,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=32, n_z=4),
            bush=ehd.ANCFBush(mesh=mesh, material=steel),
        ),
    )
    mbs.Assemble()
    settings = ehd.ConfigureSolver(scenes.settings(steps * step, steps))
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.timeIntegration.adaptiveStep = False
    solve(mbs, settings)
    assert joint.history.time.size == 1 + steps
    for body in bodies:
        speed = mbs.GetObjectOutputBody(body, exu.OutputVariableType.Velocity, [0, 0, 0])[1]
        assert speed == pytest.approx(-9.81 * steps * step, rel=1e-6)


@pytest.mark.parametrize("load", [200.0, 400.0, 800.0])
def test_a_first_residual_deep_in_a_contact_lets_no_state_pass(load):
    """A load that starts at once moves the first guess of a coarse step through the wall, where forces are millions of
    times those of the step: mass times acceleration is the sum of forces all the same.

    Newton's tolerance of 1e-6 counts from the forces of the iterate before the last, up to some ten times these.
    """
    bearing = ehd.JournalBearing(
        journal_radius=0.01,
        length=0.01,
        radial_clearance=7e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        contact=ehd.RegularisedWall(onset=5e-7),
    )
    mbs = scenes.new_system()
    inertia = InertiaCylinder(7800, 0.06, 0.01, 2)
    shaft = mbs.CreateRigidBody(
        inertia=inertia, initialAngularVelocity=[0, 0, 300.0], nodeType=exu.NodeType.RotationRxyz
    )
    mbs.CreateForce(itemNumber=shaft, loadVector=[0, -load, 0])
    joint = ehd.CreateLubricatedJoint(
        mbs, "journal", [mbs.CreateGround(), shaft], [0, 0, 0], [0, 0, 1], bearing, axial=ehd.Held()
    )
    mbs.Assemble()
    for steps in (1, 3):
        settings = ehd.ConfigureSolver(scenes.settings(steps * 2.0 * math.pi / 300.0 / 45, steps))
        ehd.SolveDynamic(mbs, settings)
        acceleration = mbs.GetObjectOutputBody(shaft, exu.OutputVariableType.Acceleration, [0, 0, 0])[:2]
        force = joint.history.force[-1][:2]
        missed = inertia.mass * acceleration - force + [0.0, load]
        assert np.abs(missed).max() < 1e-4 * np.abs(force).max()
        joint.forget()


@pytest.mark.parametrize("solve", [ehd.SolveDynamic, exu.MainSystem.SolveDynamic])
def test_forces_below_newtons_absolute_tolerance_are_told(solve):
    """Pivots under loads of 1e-7 N that turn had forces that were 7 % off, without a word."""
    small = {"journal_radius": 4e-5, "length": 4e-5, "radial_clearance": 4e-8}
    bearing = ehd.JournalBearing(
        **small, lubricant=ehd.Lubricant(viscosity=0.02), film=ehd.FiniteLength(n_theta=32, n_z=4)
    )

    def run(**options):
        mbs = exu.SystemContainer().AddSystem()
        inertia = RigidBodyInertia(mass=1e-2, inertiaTensor=1e-11 * np.eye(3))
        journal = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0, 0, 0.5])
        mbs.CreateForce(itemNumber=journal, loadVector=[0, -1e-6, 0])
        joint = ehd.CreateLubricatedJoint(mbs, "pivot", [mbs.CreateGround(), journal], [0, 0, 0], [0, 0, 1], bearing)
        mbs.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 10, 1.0
        settings.solution.file.write = False
        solve(mbs, ehd.ConfigureSolver(settings, **options))
        return joint.history.force

    with pytest.warns(
        UserWarning, match=r"'pivot': Newton's absolute tolerance .* 9.8e-07 N, .* absoluteTolerance=1e-12\)"
    ):
        run()
    run(absoluteTolerance=1e-12)
