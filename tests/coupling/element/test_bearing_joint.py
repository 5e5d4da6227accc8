"""The real film behind the joint: static and linearised results against `equilibrium`, Jacobian, restart."""

import exudyn as exu
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling.api import CreateLubricatedJoint
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.coupling.handle import LubricatedJoint
from exudyn_ehd.coupling.record.history import Quantity

BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=40e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=48, n_z=8),
)
SPEED = 300.0
LOAD = 6.0 * 9.81


def rotor(node="RotVec", bearing=BEARING, **options):
    mbs = scenes.new_system()
    ground = scenes.add_body(mbs, "ground")
    body = scenes.add_body(mbs, node, spin=(0, 0, SPEED), gravity=[0, -9.81, 0], **options)
    joint = CreateLubricatedJoint(mbs, "rotor", [ground, body], [0, 0, 0], [0, 0, 1], bearing)
    return mbs, joint, ground, body


@pytest.mark.parametrize("node", ["EP", "RotVec", "2D"])
def test_static_solve_finds_the_equilibrium(node):
    mbs, joint, ground, body = rotor(node)
    scenes.hold_axially_and_in_spin(mbs, ground, body)
    mbs.Assemble()
    mbs.SolveStatic(scenes.settings(1, 1))
    expected = ehd.equilibrium(BEARING, speed=SPEED, load=(0.0, -LOAD))
    found = joint.history.eccentricity[-1] / BEARING.radial_clearance
    # Newton's tolerance 1e-10 of the residual in both, times a compliance of order one in clearances
    np.testing.assert_allclose(found, np.asarray(expected.position) / BEARING.radial_clearance, rtol=0, atol=1e-7)


def test_linearised_system_has_the_bearings_coefficients():
    mbs, joint, ground, body = rotor("Rxyz")
    scenes.hold_axially_and_in_spin(mbs, ground, body)
    mbs.Assemble()
    mbs.SolveStatic(scenes.settings(1, 1), updateInitialValues=True)
    assert len(joint.history.time) == 2
    _, stiffness, damping = mbs.ComputeLinearizedSystem(scenes.settings(1, 1))
    expected = ehd.equilibrium(BEARING, speed=SPEED, load=(0.0, -LOAD))
    # the same tangent, at two equilibria that agree to 1e-7
    np.testing.assert_allclose(
        stiffness[:2, :2], expected.stiffness, rtol=0, atol=1e-5 * np.abs(stiffness[:2, :2]).max()
    )
    np.testing.assert_allclose(damping[:2, :2], expected.damping, rtol=0, atol=1e-5 * np.abs(damping[:2, :2]).max())


def test_rotor_settles_where_the_equilibrium_is():
    mbs, joint, *_ = rotor()
    assert isinstance(joint, LubricatedJoint)
    sensor = joint.AddSensor(Quantity.PEAK_PRESSURE)
    mbs.Assemble()
    settings = ConfigureSolver(scenes.settings(0.3, 600))
    mbs.SolveDynamic(settings)
    history = joint.history
    friction = abs(history.friction_torque[-1])
    speed = history.motion[-1, 8]
    expected = ehd.equilibrium(BEARING, speed=speed, load=(0.0, -LOAD))
    difference = history.eccentricity[-1] - expected.position
    # the rotor slows down by friction, and the journal lags a little behind the moving equilibrium
    assert np.hypot(*difference) < 0.01 * BEARING.radial_clearance
    inertia = 1000.0 * 0.1 * 0.2 * 0.3 * (0.1**2 + 0.2**2) / 12.0
    slope = (history.motion[-1, 8] - history.motion[-2, 8]) / (history.time[-1] - history.time[-2])
    # moment balance about the body's axis: friction, and e x F about the centre of mass, which lies on the journal axis
    assert -slope * inertia == pytest.approx(friction, rel=0.01)
    assert np.all(history.peak_pressure > 0.0) or history.peak_pressure[0] == 0.0
    assert len(mbs.GetSensorStoredData(sensor)) > 10


def test_return_dict():
    mbs = scenes.new_system()
    items = [scenes.add_body(mbs, "ground"), scenes.add_body(mbs, "EP")]
    made = CreateLubricatedJoint(
        mbs, "pin", items, position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING, returnDict=True
    )
    assert set(made) == {"joint", "objectNumber", "constraintNumber"}
    assert mbs.GetObject(made["objectNumber"])["name"] == "pin"


@pytest.mark.parametrize("cavitation", [ehd.SwiftStieber(), ehd.Gumbel(), ehd.FullSommerfeld()], ids=repr)
def test_jacobian_of_the_real_film(cavitation):
    """Central differences of the element's force between two moving bodies, tilted, squeezing.

    Steps of 1e-8 m against 3e-5 m of gap: truncation (3e-4)^2 = 1e-7 times a constant, rounding 1e-17 / 1e-8 in
    positions, but relative to a force that hardly changes when both bodies' common frame turns, hence 1e-6 of the
    largest entry of the same kind of coordinate (measured 3e-7).
    """
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=40e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=8),
        cavitation=cavitation,
    )
    mbs = scenes.new_system()
    one = scenes.add_body(mbs, "Rxyz", (0.1, 0, 0), scenes.rotation([0.1, 0.2, 0.3]))
    two = scenes.add_body(mbs, "EP", (0, 0.05, 0), scenes.rotation([0.4, -0.2, 0.3]))
    joint = CreateLubricatedJoint(mbs, "pin", [one, two], [0, 0, 0], [0.2, 0.1, 1.0], bearing)
    mbs.Assemble()
    rng = np.random.default_rng(2)
    q, q_t = np.zeros(13), rng.normal(size=13)
    q[6:9] = [1.0e-5, -8e-6, 5e-6]
    q[9:] = 2e-5 * rng.normal(size=4)
    q_t *= 1e-2

    def force(a, b):
        return joint.element.force(mbs, 0.0, 0, a.tolist(), b.tolist()).copy()

    stiffness = -joint.element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 1.0, 0.0)
    damping = -joint.element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 0.0, 1.0)
    for block in (slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 13)):
        for k in range(13)[block]:
            d = np.zeros(13)
            d[k] = 1e-8
            column = (force(q + d, q_t) - force(q - d, q_t)) / 2e-8
            scale = np.abs(stiffness[:, block]).max()
            np.testing.assert_allclose(stiffness[:, k], column, rtol=0, atol=1e-6 * scale)
            d[k] = 1e-6
            column = (force(q, q_t + d) - force(q, q_t - d)) / 2e-6
            scale = np.abs(damping[:, block]).max()
            np.testing.assert_allclose(damping[:, k], column, rtol=0, atol=1e-6 * scale)


def test_vanishing_gap_names_the_joint_and_the_remedy():
    """Without rotation and squeeze nothing carries: the journal falls into the bore."""
    mbs, joint, *_ = rotor(
        bearing=ehd.JournalBearing(
            journal_radius=0.02,
            length=0.02,
            radial_clearance=40e-6,
            lubricant=ehd.Lubricant(viscosity=1e-6),
            film=ehd.FiniteLength(n_theta=48, n_z=8),
        )
    )
    mbs.Assemble()
    with pytest.raises(exu.ExudynError) as caught:
        mbs.SolveDynamic(ConfigureSolver(scenes.settings(0.05, 50)))
    text = str(caught.value.__cause__)
    assert "rotor" in text
    assert "RegularisedWall" in text
    assert joint.history.minimum_gap.min() > 0.0


def test_joints_without_names_live_side_by_side():
    mbs = scenes.new_system()
    ground, one, two = (scenes.add_body(mbs, kind) for kind in ("ground", "EP", "EP"))
    joints = [
        CreateLubricatedJoint(
            mbs, itemNumbers=pair, position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING, axial=ehd.Held()
        )
        for pair in ([ground, one], [one, two])
    ]
    assert joints[0].name != joints[1].name and all(joint.name.startswith("lubricated joint") for joint in joints)
    mbs.Assemble()
