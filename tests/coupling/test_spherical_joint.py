"""A ball joint in Exudyn: kinematics, Jacobian, balance, frames, energy, Exudyn's ideal joint, what is refused."""

import dataclasses
import itertools
import math
import re
import warnings

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics import relative

OIL = ehd.Lubricant(viscosity=0.1)
HELD = {"socket_angles": (0.0, 2.3), "contact": ehd.RegularisedWall(onset=2e-6)}
BALL = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=OIL, n_phi=32, n_chi=12, **HELD)
KEPT = dataclasses.replace(BALL, cavitation=ehd.ElrodAdams(cavity_pressure=-1e3))
TANK = ehd.Sump(conductance=0.5, ambient=310.0, heat_capacity=1e-3)
HEATED = dataclasses.replace(
    KEPT, lubricant=ehd.oil("ISO VG 100"), thermal=ehd.LumpedThermal(supply_temperature=TANK, housing_conductance=0.1)
)
SIZE = (0.2, 0.02, 0.02)
MASS = 7800 * 0.2 * 0.02 * 0.02


def pendulum(bearing=BALL, spin=(3.0, 2.0, -4.0), turn=None, move=(0.0, 0.0, 0.0), ideal=False, node="EP"):
    """An arm on a ball, the cup below; ``turn`` and ``move`` place the whole model."""
    turn = np.eye(3) if turn is None else turn
    mbs = scenes.new_system()
    arm, omega, origin = turn @ [0.5 * SIZE[0], 0, 0], turn @ np.array(spin), np.array(move)
    body = mbs.CreateRigidBody(
        referencePosition=origin + arm,
        referenceRotationMatrix=turn,
        inertia=InertiaCuboid(7800, list(SIZE)),
        nodeType=scenes.NODE_TYPES[node],
        gravity=list(turn @ [0, 0, -9.81]),
        initialAngularVelocity=list(omega),
        initialVelocity=list(np.cross(omega, arm)),
    )
    ground = mbs.CreateGround()
    if ideal:
        return mbs, mbs.CreateSphericalJoint(itemNumbers=[ground, body], position=origin), body
    frame = {"rotationMatrixAxes": turn @ np.diag([1.0, -1.0, -1.0])}
    joint = ehd.CreateLubricatedSphericalJoint(mbs, "ball", [ground, body], origin, bearing, **frame)
    return mbs, joint, body


def run(mbs, end, steps, **options):
    mbs.Assemble()
    return ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(end, steps)), **options)


def output(mbs, body, name):
    return np.array(mbs.GetObjectOutputBody(body, getattr(exu.OutputVariableType, name)))


def test_motion_sees_what_is_relative_alone():
    """Turned, moved, and carried along by any rigid motion of both, with the rates of finite differences."""
    rng = np.random.default_rng(0)
    frames = rng.normal(size=(2, 3, 6))
    for frame in frames:
        frame[:, :3] = scenes.rotation(rng.normal(size=3))
    motion = relative.ball_motion(*frames)
    turn, shift, velocity, omega = scenes.rotation(rng.normal(size=3)), *rng.normal(size=(3, 3))
    carried = frames.copy()
    for frame, before in zip(carried, frames):
        frame[:, :3] = turn @ before[:, :3]
        frame[:, 3] = turn @ before[:, 3] + shift
        frame[:, 4] = turn @ before[:, 4] + velocity + np.cross(omega, frame[:, 3])
        frame[:, 5] = turn @ before[:, 5] + omega
    assert relative.ball_motion(*carried) == pytest.approx(motion, abs=1e-13)
    # half a microsecond on, by the velocities
    step, later = 1e-7, frames.copy()
    for frame in later:
        frame[:, :3] = scenes.rotation(step * frame[:, 5]) @ frame[:, :3]
        frame[:, 3] += step * frame[:, 4]
    rate = (relative.ball_motion(*later) - motion)[:3] / step
    assert rate == pytest.approx(motion[4:7], abs=1e-5)


PAIRS = [p for p in itertools.product(("ground", "EP", "Rxyz", "2D"), repeat=2) if p != ("ground",) * 2]


@pytest.mark.parametrize(
    ("socket", "ball"),
    [
        p if p in (("EP", "Rxyz"), ("ground", "EP"), ("2D", "Rxyz")) else pytest.param(*p, marks=pytest.mark.slow)
        for p in PAIRS
    ],
)
def test_jacobian_is_the_derivative_of_the_force(socket, ball):
    """Central differences of 2e-8 in places and 1e-4 in rates agree to 2e-6 of a row's largest entry."""
    rng = np.random.default_rng(1)
    bearing = ehd.SphericalBearing(
        ball_radius=0.05, radial_clearance=1e-3, lubricant=OIL, n_phi=16, n_chi=6, cavitation=ehd.FullSommerfeld()
    )
    planar = np.array([1, 1, 0]) if "2D" in (socket, ball) else np.ones(3)
    mbs = scenes.new_system()
    bodies = []
    for node in (socket, ball):
        turn = scenes.rotation(rng.normal(size=3) * (np.ones(3) - planar if planar.sum() < 3 else 1.0))
        bodies.append(scenes.add_body(mbs, node, 0.3 * rng.normal(size=3) * planar, turn))
    place, axis = 0.2 * rng.normal(size=3) * planar, rng.normal(size=3)
    joint = ehd.CreateLubricatedSphericalJoint(mbs, "pair", bodies, place, bearing, axis=axis)
    mbs.Assemble()
    element = joint.element
    n = sum(side.size for side in element.sides)
    q, q_t = 2e-4 * rng.normal(size=n), 3.0 * rng.normal(size=n)

    def force(a, b):
        return element.force(mbs, 0.0, 0, a.tolist(), b.tolist()).copy()

    for f_q, f_qt, step in ((1.0, 0.0, 2e-8), (0.0, 1.0, 1e-4)):
        expected = np.empty((n, n))
        for k, unit in enumerate(np.eye(n)):
            a, b = step * unit * f_q, step * unit * f_qt
            expected[:, k] = (force(q + a, q_t + b) - force(q - a, q_t - b)) / (2 * step)
        got = -element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt)
        scale = np.abs(expected).max(axis=1, keepdims=True)
        assert (np.abs(got - expected) < 2e-6 * scale).all()


def test_forces_and_moments_of_ball_and_socket_cancel():
    mbs, joint, _ = pendulum()
    mbs.Assemble()
    element, rng = joint.element, np.random.default_rng(3)
    q = np.concatenate([1e-5 * rng.normal(size=3), 1e-5 * rng.normal(size=4)])
    element.force(mbs, 0.0, 0, q.tolist(), rng.normal(size=7).tolist())
    socket, ball = (side.frame for side in element.sides)
    loads, film = np.empty((4, 3)), element.last.evaluation.film.loads
    relative.global_loads(socket, ball, element.last.evaluation.wrench, loads)
    # of the film on the ball, with its moment about the ball's centre
    assert loads[2] == pytest.approx(socket[:, :3] @ film.wrench[:3])
    assert loads[3] == pytest.approx(socket[:, :3] @ film.torque, rel=1e-9)
    about = rng.normal(size=3)
    moment = loads[1] + loads[3] + sum(np.cross(f[:, 3] - about, p) for f, p in ((socket, loads[0]), (ball, loads[2])))
    assert np.abs(loads[0] + loads[2]).max() == 0.0
    assert np.abs(moment).max() < 1e-15 * np.linalg.norm(loads[2])


def test_a_turned_and_moved_model_has_the_same_run():
    histories = []
    for turn, move in ((None, (0, 0, 0)), (scenes.rotation([0.7, -1.9, 0.4]), (2.0, -5.0, 1.0))):
        mbs, joint, _ = pendulum(turn=turn, move=move)
        run(mbs, 0.02, 20)
        histories.append(joint.history)
    one, other = histories
    # places are known to 1e-15 m there, rates to Newton's tolerance, on a film that damps with 1e6 N s/m
    assert np.abs(one.place - other.place).max() < 1e-12
    assert np.abs(one.force - other.force).max() < 5e-4 * np.abs(one.force).max()
    assert np.abs(one.torque - other.torque).max() < 1e-6 * np.abs(one.torque).max()


def energy(mbs, body):
    v, w, p = (output(mbs, body, name) for name in ("Velocity", "AngularVelocityLocal", "Position"))
    inertia = InertiaCuboid(7800, list(SIZE))
    return 0.5 * inertia.mass * v @ v + 0.5 * w @ inertia.Inertia() @ w + inertia.mass * 9.81 * p[2]


@pytest.mark.parametrize("steps", [100, pytest.param(800, marks=pytest.mark.slow)])
def test_a_pendulum_loses_what_its_joint_turns_into_heat(steps):
    """The trapezoidal rule over the losses, second order in the step; a swing of 0.1 or 0.4 s."""
    end = 1e-3 * steps if steps < 1000 else 5e-4 * steps
    mbs, joint, body = pendulum()
    mbs.Assemble()
    first = energy(mbs, body)
    assert ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(end, steps)))
    lost, h = first - energy(mbs, body), joint.history
    assert lost > 0.05 * first
    assert lost == pytest.approx(np.trapezoid(h.power_loss, h.time), rel=1e-2 if steps < 1000 else 1e-3)


def test_thin_oil_moves_like_exudyns_ideal_joint():
    """The arm is where the ideal joint holds it, but for the clearance and a friction that turns it by 1e-4."""
    thin = ehd.SphericalBearing(
        ball_radius=0.008, radial_clearance=30e-6, lubricant=ehd.Lubricant(viscosity=0.003), n_phi=32, n_chi=12, **HELD
    )
    places = []
    for ideal in (False, True):
        mbs, joint, body = pendulum(thin, spin=(0.0, 2.0, -4.0), ideal=ideal)
        run(mbs, 0.2, 100)
        places.append(output(mbs, body, "Position"))
        if not ideal:
            assert joint.history.eccentricity_ratio[-1] > 0.5
    assert np.linalg.norm(places[0] - places[1]) < 2 * 30e-6


def test_a_static_solve_rests_on_the_wall():
    """The start place lies in the wall's range, since a film at rest has no stiffness."""
    mbs = scenes.new_system()
    inertia, start = InertiaCuboid(7800, list(SIZE)), [1e-6, 0, -29e-6]
    body = mbs.CreateRigidBody(inertia=inertia, initialDisplacement=start, gravity=[0, 0, -9.81])
    ground = mbs.CreateGround()
    joint = ehd.CreateLubricatedSphericalJoint(mbs, "ball", [ground, body], [0, 0, 0], BALL, axis=[0, 0, -1])
    mbs.CreateGenericJoint(itemNumbers=[ground, body], position=[0, 0, 0], constrainedAxes=[0, 0, 0, 1, 1, 1])
    mbs.Assemble()
    assert ehd.SolveStatic(mbs, ehd.ConfigureSolver(scenes.settings(1, 1)))
    assert joint.history.contact_load[-1] == pytest.approx(MASS * 9.81, rel=1e-6)
    assert joint.history.place[-1, :2] == pytest.approx(0.0, abs=1e-9)


def cup(velocity, viscosity=1e-4):
    """A cube of a kilogram whose ball flies in a cup, which opens upwards."""
    bearing = ehd.SphericalBearing(
        ball_radius=0.015,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=viscosity),
        contact=ehd.RegularisedWall(onset=4e-6),
        n_phi=32,
        n_chi=12,
    )
    mbs = scenes.new_system()
    body = mbs.CreateRigidBody(inertia=InertiaCuboid(7800, [0.05] * 3), initialVelocity=velocity)
    joint = ehd.CreateLubricatedSphericalJoint(
        mbs, "cup", [mbs.CreateGround(), body], [0, 0, 0], bearing, axis=[0, 0, -1], stepControl=ehd.StepControl()
    )
    return mbs, joint


def test_a_ball_that_leaves_its_socket_ends_the_run():
    mbs, joint = cup([0, 0.02, 1.0])
    with (
        pytest.warns(ehd.PlausibilityWarning, match=r"across their bores by 1 m/s in LubricatedJoint 'cup'"),
        pytest.raises(ehd.FilmError, match=r"'cup' .*the ball has left its socket"),
    ):
        run(mbs, 0.01, 100)
    assert 1.0e-3 < -joint.history.place[-1, 2] < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("steps", [100, 2000])
def test_a_ball_that_hits_its_socket_comes_back(steps):
    """0.8 m/s onto the wall: what it has lost behind the impact is the work on film and wall."""
    mbs, joint = cup([0, 0.05, -0.8])
    run(mbs, 2e-4, steps)
    h = joint.history
    assert h.minimum_gap.min() < 4e-6 and h.contact_load.max() > 1e4
    assert -0.8 < h.velocity[-1, 2] < 0.0
    mass = InertiaCuboid(7800, [0.05] * 3).mass
    lost = 0.5 * mass * (0.05**2 + 0.8**2 - (h.velocity[-1] ** 2).sum())
    work = (h.force * h.velocity).sum(1) + (h.torque * h.angular_velocity).sum(1)
    assert -np.trapezoid(work, h.time) == pytest.approx(lost, rel=3e-2 if steps == 100 else 1e-6)
    # the limiter keeps the film from closing, against whose pressure the ball goes on: a tenth of the loss is there
    assert 0.85 * lost < np.trapezoid(h.power_loss, h.time) < lost


def test_a_film_that_can_not_be_is_told_by_name():
    """Explicit solvers take every step: one through the socket, and many that chatter."""
    bare = ehd.SphericalBearing(ball_radius=0.015, radial_clearance=30e-6, lubricant=OIL, n_phi=16, n_chi=4)
    for bearing, steps, message in (
        (bare, 10, r"'ball' can't be evaluated .* clearances, .* the gap closed somewhere"),
        (BALL, 400, r"'ball' .*"),
    ):
        mbs, _, _ = pendulum(bearing, node="Rxyz")
        mbs.Assemble()
        with pytest.raises(ehd.FilmError, match=message):
            ehd.SolveDynamic(mbs, scenes.settings(0.1, steps), solverType=exu.DynamicSolverType.ExplicitEuler)


@pytest.mark.parametrize("bearing", [BALL, KEPT, HEATED])
def test_a_stored_run_goes_on(bearing, tmp_path):
    mbs, joint, _ = pendulum(bearing)
    run(mbs, 0.02, 20)
    whole = joint.history
    mbs, joint, _ = pendulum(bearing)
    run(mbs, 0.01, 10)
    ehd.SaveState(mbs, tmp_path / "state.npz")
    mbs, joint, _ = pendulum(bearing)
    run(mbs, 0.02, 10, restart=tmp_path / "state.npz")
    again = joint.history
    assert again.time == pytest.approx(whole.time)
    # to the tolerance of Newton's method
    assert np.abs(again.place - whole.place).max() < 1e-11
    if bearing.thermal is not None:
        assert again.film_temperature == pytest.approx(whole.film_temperature, abs=1e-6)
        assert again.sump_temperature == pytest.approx(whole.sump_temperature, abs=1e-6)


def test_a_run_with_conserved_oil_shows_the_film_that_its_steps_have_led_to():
    mbs, joint, _ = pendulum(KEPT, spin=(30.0, 20.0, -4.0))
    run(mbs, 0.02, 40)
    film, h = joint.film(), joint.history
    assert film.force == pytest.approx(h.force[-1], rel=1e-6)
    assert 0.0 < film.fill.min() < 0.99 and not film.unbroken.all()
    # a steady film has other cavities
    motion = {"place": h.place[-1], "velocity": h.velocity[-1], "angular_velocity": h.angular_velocity[-1]}
    assert np.abs(ehd.steady_spherical(KEPT, **motion).fill - film.fill).max() > 0.01
    assert joint.audit()["mass conservation"].on


def test_a_film_warms_up_in_a_run_to_the_balance_of_its_power():
    """Oil of constant viscosity: the steps' heat is what capacity, housing and oil have taken up."""
    warm = ehd.LumpedThermal(supply_temperature=313.0, housing_conductance=0.2, capacity=0.05)
    bearing = dataclasses.replace(BALL, thermal=warm)
    mbs, joint, _ = pendulum(bearing, spin=(30.0, 20.0, -4.0))
    plain, cold, _ = pendulum(spin=(30.0, 20.0, -4.0))
    run(mbs, 0.02, 40)
    run(plain, 0.02, 40)
    h, its = joint.history, cold.history
    assert h.force == pytest.approx(its.force, rel=1e-6, abs=1e-6 * np.abs(its.force).max())
    T, steps = h.film_temperature, np.diff(h.time)
    assert T[0] == 313.0 and (np.diff(T) >= 0.0).all() and np.isnan(its.film_temperature).all()
    area = joint.element.model.patch.area.sum() * 0.015**2
    stored = 0.05 + OIL.density * OIL.specific_heat * area * 30e-6
    most = np.concatenate([[0.0], np.cumsum(h.power_loss[1:] * steps)]) / stored
    # the temperature of a step is that at its start; some of the heat leaves with the oil
    assert 0.3 * most[-2] < T[-1] - 313.0 < most[-2]
    assert joint.film().temperature == pytest.approx(T[-1], abs=0.2)


def test_what_a_user_sees():
    mbs, joint, _ = pendulum()
    sensors = {name: joint.AddSensor(name) for name in ("minimum_gap", "force")}
    local = joint.AddSensor(exu.OutputVariableType.ForceLocal)
    run(mbs, 0.01, 10)
    h = joint.history
    # sensors are written at the start and at the end
    assert mbs.GetSensorStoredData(sensors["minimum_gap"])[:, 1] == pytest.approx(h.minimum_gap[[0, -1]])
    assert mbs.GetSensorStoredData(sensors["force"])[:, 1:] == pytest.approx(h.force[[0, -1]])
    assert mbs.GetSensorStoredData(local)[:, 1:] == pytest.approx(-h.force[[0, -1]])
    assert (
        "ball of 30 mm" in repr(joint)
        and "11 steps" in repr(h)
        and "without steps" in repr(type(h)(**{f: np.zeros(0) for f in vars(h)}))
    )
    assert mbs.GetObject(joint.objectNumber)["name"] == joint.name == "ball"
    joint.stop_at(force=1.0)
    joint.forget()
    with pytest.raises(ehd.FilmError, match="beyond the limits"):
        ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.01, 10)))


def test_input_is_checked():
    create = ehd.CreateLubricatedSphericalJoint
    mbs, joint, body = pendulum()
    ground = mbs.CreateGround()
    for arguments, message in (
        (("ball", [ground, body], [0, 0, 0], BALL), "CreateLubricatedSphericalJoint.name 'ball' is taken by another"),
        (("b", [ground, ground], [0, 0, 0], BALL), "CreateLubricatedSphericalJoint.itemNumbers: both items are ground"),
        (("b", [ground, body], [0, 0], BALL), "CreateLubricatedSphericalJoint.position must be 3"),
        (("b", [ground, body], [0, 0, 0], None), "CreateLubricatedSphericalJoint.bearing must be Spherical"),
        (("b", [ground, body], [0, 0, 0], BALL, [0, 0, 0]), "CreateLubricatedSphericalJoint.axis must not be zero"),
    ):
        with pytest.raises(ehd.InputError, match=message):
            create(mbs, *arguments)
    far = mbs.CreateRigidBody(inertia=InertiaCuboid(7800, [0.1] * 3), initialDisplacement=[0, 0, 1e-3])
    with pytest.raises(ehd.InputError, match="the ball is outside the socket"):
        create(mbs, "b", [ground, far], [0, 0, 0], BALL)
    with pytest.raises(
        ehd.InputError,
        match=r"AddSensor: quantity must be .* one of eccentricity_ratio, force, min",
    ):
        joint.AddSensor("leakage")
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match="assembled already"):
        create(mbs, "b", [ground, body], [0, 0, 0], BALL)
    with pytest.raises(ehd.InputError, match="joint 'ball' holds a ball"):
        ehd.SolveDynamic(mbs, scenes.settings(0.01, 10), until_periodic=ehd.UntilPeriodic(period=0.002))
    with pytest.raises(ehd.InputError, match=r"LubricatedSphericalJoint.audit: joint 'ball' has no accepted steps"):
        pendulum()[1].audit()


BELT = {"socket_angles": (0.7, math.pi - 0.7)}


def swung(viscosity, steps, **options):
    """A belt's pendulum, of which the film carries the arm across the belt's axis and along it."""
    mbs, joint, _ = pendulum(dataclasses.replace(BALL, lubricant=ehd.Lubricant(viscosity=viscosity), **BELT))
    run(mbs, 0.3, steps, **options)
    return joint


def step_error(history, fine):
    """True error of the ball's place behind the first steps, over the film thickness."""
    place = np.column_stack([np.interp(history.time, fine.time, fine.place[:, k]) for k in range(3)])
    return (np.linalg.norm(history.place - place, axis=1) / history.minimum_gap)[3:].max()


@pytest.mark.slow
@pytest.mark.parametrize("viscosity", [0.02, 0.006])
def test_errors_of_the_steps(viscosity):
    """Against a run of tiny steps; bodies make errors of their own, which are not told."""
    fine = swung(viscosity, 3200).history
    for steps in (60, 80, 100):
        h = swung(viscosity, steps).history
        true = step_error(h, fine)
        assert true > 0.05 and 0.6 < np.nanmax(h.step_error) / true < 1.4
    joint = swung(viscosity, 100, stepControl=ehd.StepControl(error=0.02))
    assert step_error(joint.history, fine) < 0.02
    # what fixed steps need for it
    assert joint.element.evaluations < 2.2 * swung(viscosity, 140).element.evaluations


@pytest.mark.slow
def test_the_audit_of_a_run():
    """The audit of the record names a sufficient number of steps and the worst films."""
    joint = swung(0.006, 80)
    audit = joint.audit()
    found = audit["time step"]
    assert found.matters and found.value == pytest.approx(np.nanmax(joint.history.step_error))
    steps = int(re.search(r"take (\d+) steps in all", found.advice)[1])
    assert 120 <= steps <= 400
    better = swung(0.006, steps)
    assert not better.audit()["time step"].matters
    assert audit["piezoviscosity"].value == pytest.approx(2e-8 * joint.history.peak_pressure.max(), rel=1e-6)
    assert audit["squeeze"].matters and audit["contact"].on


@pytest.mark.parametrize("velocity", [(0.0, 0.0, -0.01), (0.01, 0.0, 0.0)])
def test_newtons_method_comes_back_from_behind_the_end_of_a_pressure_law(velocity):
    """First guesses squeeze faster than the oil's law carries, as at journals."""
    oil = ehd.Lubricant(viscosity=0.1, pressure_law=ehd.RoelandsPressure(coefficient=1e-8))
    ball = dataclasses.replace(BALL, lubricant=oil)
    mbs = scenes.new_system()
    arm = mbs.CreateRigidBody(
        inertia=InertiaCuboid(7800, [0.06, 0.06, 0.06]),
        initialVelocity=list(velocity),
        nodeType=scenes.NODE_TYPES["Rxyz"],
    )
    joint = ehd.CreateLubricatedSphericalJoint(mbs, "ball", [mbs.CreateGround(), arm], [0, 0, 0], ball, axis=[0, 0, -1])
    assert run(mbs, 1e-3, 20)
    assert joint.history.time.size == 21 and np.all(np.isfinite(joint.history.force))
    assert joint.element.failures.refused == {}


def test_forces_below_newtons_tolerance_are_told():
    """An arm of a grain's weight on thin oil; with the tolerance that the warning names there is none."""
    told = []
    for options in ({}, {"absoluteTolerance": 1e-14}):
        mbs = scenes.new_system()
        arm = mbs.CreateRigidBody(
            inertia=InertiaCuboid(1e-4, [0.05] * 3), gravity=[0, 0, -9.81], initialAngularVelocity=[5.0, 0, 0]
        )
        gas = dataclasses.replace(BALL, lubricant=ehd.Lubricant(viscosity=1e-6))
        ehd.CreateLubricatedSphericalJoint(mbs, "ball", [mbs.CreateGround(), arm], [0, 0, 0], gas)
        mbs.Assemble()
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(1e-4, 10), **options))
        told.append([str(w.message) for w in found if "Newton's absolute tolerance of" in str(w.message)])
    assert len(told[0]) == 1 and not told[1], told
