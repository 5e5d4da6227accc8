"""Initial guess of Newton's method in a step: an unchanged motion with fewer iterations, for every integrator and node
type; hooks are given back."""

import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling.run.newton import coordinates_of, lasting
from tests.mechanisms.exudyn_data.spatial import spatial_crank
from tests.sampling import sample

CRANK, SPEED, MASS = 0.05, 300.0, 1.0
BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=25e-6,
    lubricant=ehd.Lubricant(viscosity=0.01),
    film=ehd.ShortBearing(n_theta=64),
    # a line that jumps from column to column is the harder film
    cavitation=ehd.SwiftStieber(line_in_cells=False),
)


def crank_pin(node="Rxyz", speed=SPEED):
    """A body that a crank pin carries around: 4.5 km/s2, and a film in between. Housing free of rotation by soft
    springs."""
    mbs = scenes.new_system()
    origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    crank_node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialVelocities=[0, 0, speed]))
    crank = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=crank_node, mass=1.0, inertia=1e-3))
    for coordinate, rate in ((0, 0.0), (1, 0.0), (2, speed)):
        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[
                    origin,
                    mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=crank_node, coordinate=coordinate)),
                ],
                offsetUserFunction=lambda mbs, t, item, offset, rate=rate: rate * t,
                offsetUserFunction_t=lambda mbs, t, item, offset, rate=rate: rate,
            )
        )
    carried = scenes.add_body(mbs, node, position=(CRANK, 0, 0), velocity=(0, CRANK * speed, 0))
    joint = ehd.CreateLubricatedJoint(
        mbs, name="pin", itemNumbers=[carried, crank], position=[CRANK, 0, 0], axis=[0, 0, 1], bearing=BEARING
    )
    scenes.hold_axially_and_in_spin(mbs, mbs.CreateGround(), carried)
    mbs.Assemble()
    return mbs, joint


def turn(steps, tolerance=1e-6, turns=0.5, speed=SPEED):
    return ehd.ConfigureSolver(scenes.settings(turns * 2.0 * math.pi / speed, round(turns * steps)), tolerance)


def run(settings, *, own, node="Rxyz", **options):
    """History, and Newton's iterations behind the start, which falls from the middle of the bore."""
    mbs, joint = crank_pin(node)
    counts = []

    def count(mbs, t):
        if t > 0.05 * 2.0 * math.pi / SPEED:
            counts.append(mbs.sys["dynamicSolver"].it.newtonStepsCount)
        return True

    mbs.SetPostStepUserFunction(count)
    if own:
        ehd.SolveDynamic(mbs, settings, **options)
    else:
        mbs.SolveDynamic(settings, **options)
    return joint.history, counts[-1] - counts[0]


def force_error(h, reference):
    """Largest relative error of the force behind the start."""
    late = h.time > 0.2 * 2.0 * math.pi / SPEED
    force = np.interp(h.time[late], reference.time, np.linalg.norm(reference.force, axis=1))
    return np.abs(np.linalg.norm(h.force[late], axis=1) / force - 1.0).max()


@pytest.mark.parametrize("node", sample(["2D", "Rxyz", "EP", "RotVec"], 2))
@pytest.mark.parametrize("radius", [0.0, 0.8])
def test_same_motion(node, radius):
    """Newton converges to the step's solution from either start; the integrator's parameters scale both."""
    settings = turn(720, 1e-10, turns=0.2)
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    (a, more), (b, less) = (run(settings, own=own, node=node) for own in (False, True))
    assert a.time.size == b.time.size == 145
    assert np.abs(a.eccentricity - b.eccentricity).max() < 1e-6 * BEARING.radial_clearance
    # Newton's tolerance is one of its first residual, which is larger from Exudyn's start
    assert np.abs(a.force - b.force).max() < 1e-4 * np.abs(a.force).max()
    # rotations of Lie group nodes are left where Exudyn starts them
    assert less < 0.8 * more


@pytest.mark.parametrize("newmark", sample([False, True], 1))
def test_newmark_and_index_2(newmark):
    settings = turn(720, 1e-10, turns=0.2)
    if newmark:
        settings.timeIntegration.generalizedAlpha.useNewmark = True
    solver = exu.DynamicSolverType.GeneralizedAlpha if newmark else exu.DynamicSolverType.TrapezoidalIndex2
    (a, more), (b, less) = (run(settings, own=own, solverType=solver) for own in (False, True))
    assert np.abs(a.eccentricity - b.eccentricity).max() < 1e-6 * BEARING.radial_clearance
    assert less < 0.8 * more


@pytest.mark.slow
def test_coarse_steps_of_a_crank_don_t_chatter():
    """Steps of 1.5 degrees that start from zero accelerations are farther from the solution than the film is thick."""
    settings, fine = turn(240), turn(1440)
    with pytest.warns(ehd.RingingWarning, match="'pin': from t = "):
        plain, more = run(settings, own=False)
    (better, less), (reference, _) = (run(s, own=True) for s in (settings, fine))
    assert 0.3 * CRANK * (2.0 * math.pi / 240) ** 2 > 0.4 * BEARING.radial_clearance
    assert better.time.size < plain.time.size
    assert less < 0.4 * more
    assert force_error(better, reference) < 0.002 < 0.2 < force_error(plain, reference)


@pytest.mark.slow
def test_own_sparse_solver_starts_there_too():
    mbs, joint = crank_pin()
    done = ehd.SolveDynamicSparse(mbs, turn(240))
    counted = mbs.sys["dynamicSolver"].it
    assert (counted.newtonStepsCount, counted.newtonJacobiCount) == (done.iterations, done.jacobians)
    reference, _ = run(turn(1440), own=True)
    assert force_error(joint.history, reference) < 0.002
    # from zero accelerations 45 of 479, with 15 iterations each
    assert done.rejected <= 2 and done.iterations < 10 * done.steps


@pytest.mark.slow
def test_chatter_is_told_once_per_run_and_audited():
    mbs, joint = crank_pin()
    for _ in range(2):
        with pytest.warns(ehd.RingingWarning) as told:
            mbs.SolveDynamic(turn(240))
        assert len(told) == 1 and "ehd.SolveDynamic" in str(told[0].message)
    found = joint.audit()["ringing"]
    assert found.matters and found.value >= 4.0 and "ehd.SolveDynamic" in found.advice
    ehd.SolveDynamic(mbs, turn(240))
    found = joint.audit()["ringing"]
    assert not found.matters and found.advice == ""


def test_user_function_is_called_and_given_back():
    mbs, _ = crank_pin()
    calls = []
    mbs.SetPreNewtonResidualUserFunction(lambda mbs, t, iteration, discontinuous: calls.append(iteration))
    ehd.SolveDynamic(mbs, turn(360, turns=0.02))
    count = len(calls)
    assert count > 7 and 0 in calls and 1 in calls
    mbs.SolveDynamic(turn(360, turns=0.02))
    assert len(calls) > count

    def fails(mbs, t, iteration, discontinuous):
        raise ValueError("own")

    mbs.SetPreNewtonResidualUserFunction(fails)
    with pytest.raises(exu.ExudynError, match="own"):
        ehd.SolveDynamic(mbs, turn(360, turns=0.02))
    assert mbs.GetPreNewtonResidualUserFunction()["function"] is fails


def test_no_function_is_left_behind():
    mbs, _ = crank_pin()
    ehd.SolveDynamic(mbs, turn(360, turns=0.02))
    assert not mbs.GetPreNewtonResidualUserFunction()
    ehd.SolveDynamic(mbs, turn(360, turns=0.02), storeSolver=False)
    assert not mbs.GetPreNewtonResidualUserFunction()


def test_what_lasts():
    one = np.zeros(5, dtype=int)
    before, now = np.array([1.0, -2.0, 3.0, 0.1, 0.0]), np.array([1.2, -1.9, 2.5, -0.1, 5e-3])
    smaller = [1.0, -1.9, 2.5, 0.0, 0.0]
    assert lasting([(0.0, now)], one) is None
    assert np.array_equal(lasting([(0.0, before), (0.1, now)], one), smaller)
    assert not np.any(lasting([(0.0, before), (0.1, 3.0 * now)], one))
    assert not np.any(lasting([(0.0, before), (0.1, np.zeros(5))], one))
    # in a line if evenly spaced and nearly straight
    line = [(0.0, 2.0 * before - now), (0.1, before), (0.2, now)]
    assert np.allclose(lasting(line, one), 2.0 * now - before)
    assert np.array_equal(lasting([(0.05, line[0][1]), *line[1:]], one), smaller)
    assert np.array_equal(lasting([(0.0, before), *line[1:]], one), smaller)
    # a body that rings leaves the others alone
    ringing = np.array([1.0, -1.9, 2.5, 500.0, -500.0])
    assert not np.any(lasting([(0.0, before), (0.1, ringing)], one))
    assert np.array_equal(
        lasting([(0.0, before), (0.1, ringing)], np.array([0, 0, 0, 1, 1])), [1.0, -1.9, 2.5, 0.0, 0.0]
    )


@pytest.mark.parametrize("node", ["Rxyz", "EP", "RotVec"])
def test_rotations_of_lie_group_nodes_are_not_added_to(node):
    mbs, _ = crank_pin(node)
    mask, _ = coordinates_of(mbs, ())
    assert np.count_nonzero(mask == 0.0) == (3 if node == "RotVec" else 0)


def test_constraint_forces_are_those_of_exudyns_own_start():
    """A spatial slider-crank on ideal joints: what Newton's first iteration leaves of its constraints must not jump
    from step to step with the start, which forces of 3 N felt by 14 N. The run has steps with and without a guess.

    Exudyn's own start closes them at a tight tolerance; at the usual one its first steps are open too.
    """

    def force(solve, **tolerance):
        mbs = scenes.new_system()
        model = spatial_crank(mbs)
        mbs.Assemble()
        forces = []
        mbs.SetPostStepUserFunction(
            lambda mbs, t: not forces.append(mbs.GetObjectOutput(model.joint, exu.OutputVariableType.ForceLocal))
        )
        solve(mbs, ehd.ConfigureSolver(scenes.settings(0.05, 100), **tolerance))
        return np.array(forces)

    expected = force(lambda mbs, settings: mbs.SolveDynamic(settings), relativeTolerance=1e-13)
    got = force(ehd.SolveDynamic)
    assert np.linalg.norm(expected, axis=1).min() > 1.0
    np.testing.assert_allclose(got, expected, atol=5e-3)


@pytest.mark.parametrize("clearance", [80e-6, 20e-6])
def test_forces_are_smooth_where_newton_takes_another_pass(clearance):
    """The spatial crank with its joint on a film, which is unloaded at the start and rings for some steps. Passes that
    began again at zero accelerations changed its force of 2 N by 6 N, again and again."""
    mbs = scenes.new_system()
    model = spatial_crank(mbs)
    bearing = ehd.JournalBearing(
        journal_radius=0.01,
        length=0.02,
        radial_clearance=clearance,
        lubricant=ehd.Lubricant(viscosity=5e7 * clearance**2),
        film=ehd.FiniteLength(n_theta=32, n_z=6),
    )
    film = ehd.ReplaceJoint(mbs, model.joint, bearing=bearing, tilt=ehd.Held())
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.04, 80)))
    assert mbs.sys["dynamicSolver"].it.newtonStepsCount < 140
    force = film.history.force[15:, :2]
    assert np.linalg.norm(force, axis=1).min() > 1.0
    assert np.linalg.norm(force[2:] - 2.0 * force[1:-1] + force[:-2], axis=1).max() < 0.2
