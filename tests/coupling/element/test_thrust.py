"""Joints with films on their end faces in Exudyn models."""

import dataclasses
import math

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics import relative

C, RI, RO, MU = 40e-6, 0.026, 0.05, 0.03


def _bearing(viscosity=MU, **options):
    faces = {"inner_radius": RI, "outer_radius": RO, "clearance": C, "n_theta": 48, "n_r": 6} | options
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=viscosity),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        thrust=ehd.ThrustFaces(**faces),
    )


@pytest.mark.parametrize("offset", (0.0, 0.15))
@pytest.mark.parametrize(
    "closure", (ehd.SwiftStieber(), pytest.param(ehd.FullSommerfeld(), marks=pytest.mark.slow)), ids=("swift", "full")
)
def test_jacobian(closure, offset):
    """Central differences of the faces' force between two moving bodies; ``offset``: distance of the joint points.

    Steps of 1e-8 m against 4e-5 m of gap: as in `test_bearing_joint`, 1e-6 of the largest entry of its kind.
    """
    bearing = dataclasses.replace(_bearing(profile=ehd.TaperLand(pads=4, depth=3e-5)), cavitation=closure)
    mbs = scenes.new_system()
    one = scenes.add_body(mbs, "Rxyz", (0.1, 0, 0), scenes.rotation([0.1, 0.2, 0.3]))
    two = scenes.add_body(mbs, "EP", (0, 0.05, 0), scenes.rotation([0.4, -0.2, 0.3]))
    joint = ehd.CreateLubricatedJoint(mbs, "pin", [one, two], [0, 0, 0], [0.2, 0.1, 1.0], bearing)
    element = joint.element
    if offset:
        # the same joint, with its journal's point elsewhere on the axis
        side = element.sides[1]
        side.rho += offset * side.rotation[:, 2]
        element.collars = relative.collar_kinematics(offset)
    mbs.Assemble()
    rng = np.random.default_rng(2)
    q, q_t = np.zeros(13), 1e-2 * rng.normal(size=13)
    q[6:9] = [1.0e-5, -8e-6, 1.5e-5]
    q[9:] = 2e-5 * rng.normal(size=4)
    q_t[9:] += [0.0, 1.0, 2.0, 20.0]

    def force(q, q_t):
        return element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())

    first = force(q, q_t)
    assert np.all(np.isfinite(first)) and np.abs(first).max() > 1.0
    for f_q, f_qt, step in ((1.0, 0.0, 1e-9), (0.0, 1.0, 1e-6)):
        jacobian = element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt)
        columns = []
        for k in range(13):
            d = step * np.eye(13)[k]
            plus, minus = (force(q + f_q * s * d, q_t + f_qt * s * d) for s in (1, -1))
            columns.append(-(plus - minus) / (2 * step))
        kinds = np.r_[np.zeros(3), np.ones(3), np.zeros(3), np.ones(4)].astype(int)
        expected = np.array(columns).T
        for a in (0, 1):
            for b in (0, 1):
                block = np.ix_(kinds == a, kinds == b)
                assert np.abs(jacobian[block] - expected[block]).max() < 2e-6 * np.abs(expected[block]).max()


def _rotor(bearing, *, omega=200.0, mass=3.0, axial_velocity=0.0, load=(0.0, 0.0, 0.0), start=0.0, axis=2, **options):
    mbs = exu.SystemContainer().AddSystem()
    turn = np.eye(3) if axis == 2 else np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    inertia = InertiaCylinder(mass / (math.pi * 0.03**2 * 0.1), 0.1, 0.03, 2)
    shaft = mbs.CreateRigidBody(
        inertia=inertia,
        referenceRotationMatrix=turn,
        initialVelocity=(turn @ [0, 0, axial_velocity]).tolist(),
        initialDisplacement=(turn @ [0, 0, start]).tolist(),
        initialAngularVelocity=(turn @ [0, 0, omega]).tolist(),
    )
    ground = mbs.CreateGround()
    joint = ehd.CreateLubricatedJoint(
        mbs, "main", [ground, shaft], [0, 0, 0], turn[:, 2], bearing, rotationMatrixAxes=turn, **options
    )
    if any(load):
        mbs.CreateForce(itemNumber=shaft, loadVector=(turn @ np.array(load)).tolist())
    mbs.Assemble()
    return mbs, joint, shaft


def _run(mbs, end, steps):
    settings = exu.SimulationSettings()
    ehd.ConfigureSolver(settings)
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    ehd.SolveDynamic(mbs, settings)


@pytest.mark.slow
def test_journal_floats_where_steady_says():
    """Under an axial load the rotor comes to rest where the films of its pads carry it, along any axis."""
    bearing, load = _bearing(profile=ehd.TaperLand(pads=4, depth=3e-5)), 2000.0

    def force(z, speed=200.0):
        film = ehd.steady(bearing, speed=speed, eccentricity_ratio=0.0, axial_position=z)
        return film.faces.axial_force + load

    guess = brentq(force, 0.0, 0.9 * C, xtol=1e-10)
    ends = []
    for axis in (2, 0):
        # a heavy rotor, which keeps its spin while the films settle, in some 10 ms
        mbs, joint, _ = _rotor(bearing, mass=300.0, load=(0.0, 0.0, load), axis=axis, start=0.9 * guess)
        _run(mbs, 6e-2, 100)
        ends.append(joint.history)
    history = ends[0]
    speed = history.motion[-1, 8]
    assert history.axial_position[-1] == pytest.approx(brentq(force, 0.0, 0.9 * C, args=(speed,), xtol=1e-10), rel=2e-3)
    assert history.thrust_force[-1] == pytest.approx(-load, rel=1e-3)
    assert history.thrust_power_loss[-1] == pytest.approx(-speed * history.thrust_torque[-1], rel=1e-3)
    assert history.thrust_minimum_gap[-1] == pytest.approx(C - history.axial_position[-1], rel=1e-6)
    # the whole model turned: the same numbers
    assert ends[1].axial_position == pytest.approx(history.axial_position, rel=1e-6, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("bore", (ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)), ids=("swift", "elrod"))
def test_placed_in_equilibrium(bore):
    """Between the faces where it stands along the axis; their share keeps the journal of a heavy rotor there."""
    faced = _bearing(profile=ehd.TaperLand(pads=4, depth=3e-5), cavitation=ehd.SwiftStieber())
    bearing, load = dataclasses.replace(faced, cavitation=bore), (100.0, -800.0)
    place = ehd.equilibrium(bearing, speed=200.0, load=load, axial_load=1500.0).film.faces.axial_position
    mbs, joint, _ = _rotor(bearing, mass=300.0, load=(*load, 1500.0), start=place)
    found = joint.place_in_equilibrium(load=load)
    assert found.film.faces.axial_position == pytest.approx(place, rel=1e-12)
    _run(mbs, 1e-3, 10)
    history = joint.history
    assert np.abs(history.eccentricity - found.position).max() < 1e-4 * 50e-6
    # the spin falls by 1e-4
    assert np.abs(history.axial_position - place).max() < 1e-4 * C


@pytest.mark.slow
def test_axial_damping():
    """A free rotor without pads loses its axial speed as two squeezed washers take it: v = v0 exp(-D t / m)."""
    s = RI / RO
    one = 1.5 * math.pi * MU * RO**4 / C**3 * (1 - s**4 + (1 - s**2) ** 2 / math.log(s))
    mass, v0 = 30.0, 1e-4
    bearing = dataclasses.replace(_bearing(), cavitation=ehd.FullSommerfeld())
    mbs, joint, _ = _rotor(bearing, omega=0.0, mass=mass, axial_velocity=v0)
    time = mass / (2 * one)
    _run(mbs, 2 * time, 200)
    history = joint.history
    # the squeeze of gaps that move by v0 m / D, 1e-4 of the clearance; trapezoidal steps of time / 100
    assert history.motion[:, 9] == pytest.approx(v0 * np.exp(-history.time / time), abs=2e-4 * v0)


@pytest.mark.slow
def test_impact_settles():
    """A heavy rotor thrown at a face is stopped by film and wall, bounces, and calms down."""
    wall = ehd.RegularisedWall(onset=6e-6, pressure=2e8)
    bearing = _bearing(1e-3, profile=ehd.TaperLand(pads=4, depth=3e-5), contact=wall)
    mbs, joint, _ = _rotor(bearing, omega=100.0, mass=300.0, axial_velocity=0.25)
    _run(mbs, 3e-3, 120)
    history = joint.history
    assert history.thrust_contact_load.max() > 1e3
    assert np.abs(history.axial_position).max() < 1.1 * C
    assert abs(history.motion[-1, 9]) < 0.1 * 0.25
    assert history.thrust_contact_load[-1] == 0.0
    # what film and wall have taken is the momentum
    impulse = np.trapezoid(history.thrust_force, history.time)
    assert impulse == pytest.approx(300.0 * (history.motion[-1, 9] - 0.25), rel=0.01)


def _pushed(force, end, steps, *, control=None, **options):
    """A shaft that a force pushes towards one of its plane faces."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    shaft = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.5, 0.025, 2), initialAngularVelocity=[0, 0, 300.0])
    bearing = _bearing(contact=ehd.RegularisedWall(onset=0.1 * C))
    joint = ehd.CreateLubricatedJoint(mbs, "a", [ground, shaft], [0, 0, 0], [0, 0, 1], bearing, stepControl=control)
    mbs.CreateForce(itemNumber=shaft, loadVector=[0, 0, force])
    mbs.Assemble()
    return joint, lambda: ehd.SolveDynamic(mbs, scenes.settings(end, steps), **options)


@pytest.mark.slow
def test_step_control_watches_the_faces():
    """Steps of 1 ms / 10 change their gap by a quarter and more; with a control by no more than it says."""
    changes = []
    for control in (None, ehd.StepControl(largest_gap_change=0.05)):
        joint, run = _pushed(2e5, 1e-3, 10, control=control)
        run()
        gap = joint.history.thrust_minimum_gap
        changes.append((np.abs(np.diff(gap)) / np.maximum(gap[:-1], 0.1 * C)).max())
    assert changes[0] > 0.1
    assert changes[1] < 0.05


@pytest.mark.slow
def test_the_history_of_a_run_that_faces_end_is_there():
    joint, run = _pushed(3e6, 0.02, 200)
    joint.stop_at(pressure=1e8)
    with pytest.raises(ehd.FilmError, match="its thrust faces have a film that neither"):
        run()
    assert joint.history.time.size > 1
    assert np.isfinite(joint.history.thrust_minimum_gap).all()


@pytest.mark.slow
def test_a_journal_that_creeps_along_its_axis_is_not_periodic():
    """Its orbit has closed long before."""
    joint, run = _pushed(1000.0, 0.03, 60, until_periodic=ehd.UntilPeriodic(period=5e-3, tolerance=0.02))
    with pytest.raises(ehd.RunError, match="have not closed"):
        run()
    place = joint.history.axial_position
    assert place[-1] - place[-11] > 0.02 * 50e-6


@pytest.mark.slow
def test_audit():
    """A row says what the faces take; advice about the journal's film is given as without them."""
    mbs, joint, _ = _rotor(
        _bearing(0.05, profile=ehd.TaperLand(pads=4, depth=3e-5)), omega=500.0, load=(50.0, 0.0, 500.0)
    )
    _run(mbs, 1e-3, 20)
    audit, history = joint.audit(), joint.history
    loss = history.thrust_power_loss.mean()
    assert audit["thrust faces"].value == pytest.approx(loss / (loss + history.power_loss.mean()))
    assert audit["thrust faces"].on and audit["thrust faces"].matters
    assert audit["heat of thrust faces"].matters
    assert "LumpedThermal" in audit["heat of thrust faces"].advice
    film = ehd.steady(joint.bearing, speed=500.0, eccentricity_ratio=0.5)
    with pytest.raises(KeyError):
        film.audit()["thrust faces"]


@pytest.mark.slow
def test_forces_of_the_joint_and_momentum():
    """Exudyn's sensors read the sum of the forces of journal film and faces; two free bodies keep momentum."""
    bearing = _bearing(profile=ehd.TaperLand(pads=4, depth=3e-5))
    mbs = exu.SystemContainer().AddSystem()
    inertia = InertiaCylinder(7800, 0.1, 0.05, 2)
    start = {"initialAngularVelocity": [0, 0, 200.0], "initialVelocity": [0, 0.0, 2e-2]}
    shaft = mbs.CreateRigidBody(inertia=inertia, **start)
    housing = mbs.CreateRigidBody(inertia=inertia)
    joint = ehd.CreateLubricatedJoint(mbs, "main", [housing, shaft], [0, 0, 0], [0, 0, 1], bearing)
    sensor = joint.AddSensor(exu.OutputVariableType.ForceLocal)
    axial = joint.AddSensor(ehd.Quantity.THRUST_FORCE)
    mbs.Assemble()
    _run(mbs, 1e-3, 100)
    history = joint.history
    local, force = mbs.GetSensorStoredData(sensor), mbs.GetSensorStoredData(axial)
    assert local[-1, 3] == pytest.approx(-history.force[-1, 2] - history.thrust_force[-1], rel=1e-6)
    assert force[-1, 1] == history.thrust_force[-1]
    velocity = [np.array(mbs.GetObjectOutputBody(b, exu.OutputVariableType.Velocity)) for b in (shaft, housing)]
    assert sum(velocity) == pytest.approx([0, 0, 2e-2], abs=1e-9)
    spin = [np.array(mbs.GetObjectOutputBody(b, exu.OutputVariableType.AngularVelocity)) for b in (shaft, housing)]
    assert sum(spin) == pytest.approx([0, 0, 200.0], abs=1e-5)


def test_without_faces_nothing_changes():
    """A model has as many objects without faces as with them; the faces' columns of the history are nan."""
    counts = []
    for bearing in (_bearing(), dataclasses.replace(_bearing(), thrust=None)):
        mbs, joint, _ = _rotor(bearing)
        counts.append(mbs.systemData.NumberOfObjects())
        _run(mbs, 1e-4, 2)
    assert counts[0] == counts[1]
    assert np.all(np.isnan(joint.history.thrust_force))
    assert joint.element.faces is None


def test_refused():
    with pytest.raises(ehd.InputError, match=r"outside the thrust faces of 'main'.*axial position 5e-05"):
        _rotor(_bearing(), start=5e-5)
    mbs, _, _ = _rotor(_bearing(profile=ehd.TaperLand(pads=4, depth=3e-5)), load=(0, 0, 1e9))
    with pytest.raises(ehd.FilmError, match="thrust faces have a film"):
        _run(mbs, 1e-3, 10)


OIL = ehd.oil("ISO VG 46")
THERMAL = {
    "lumped": ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=5.0),
    "field": ehd.FilmEnergy(supply_temperature=313.15),
}


@pytest.mark.parametrize("kind", THERMAL)
def test_heated_faces_in_a_run(kind, tmp_path):
    """Faces thin out as the joint warms up; a run from a file ends as the whole one; a rotor has its steady film."""
    bearing = dataclasses.replace(
        _bearing(profile=ehd.TaperLand(pads=4, depth=3e-5)), lubricant=OIL, thermal=THERMAL[kind]
    )
    load = (0.0, -800.0, 300.0)
    whole, joint, _ = _rotor(bearing, load=load, mass=30.0)
    _run(whole, 0.02, 80)
    loss = joint.history.thrust_power_loss
    assert joint.history.film_temperature[-1] > 316.0 and loss[-1] < 0.9 * loss[0]
    half, _, _ = _rotor(bearing, load=load, mass=30.0)
    _run(half, 0.01, 40)
    ehd.SaveState(half, tmp_path / "half.npz")
    rest, again, _ = _rotor(bearing, load=load, mass=30.0)
    settings = exu.SimulationSettings()
    ehd.ConfigureSolver(settings)
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.02, 40
    ehd.SolveDynamic(rest, settings, restart=tmp_path / "half.npz")
    # a restart's steps are as long to 1e-14 of a second
    assert again.history.film_temperature[-1] == pytest.approx(joint.history.film_temperature[-1], rel=1e-9)
    assert again.history.thrust_force[-1] == pytest.approx(joint.history.thrust_force[-1], rel=1e-6)
    ends = ehd.SolveEquilibrium(rest, 200.0)
    motion = ends.motion[0, 0]
    tilt = tuple(motion[2:4])
    known = ehd.equilibrium(bearing, speed=200.0, load=load[:2], axial_load=load[2], tilt=tilt)
    assert motion[:2] == pytest.approx(known.position, abs=1e-6 * C)
    assert ends.coordinates[0, 2] == pytest.approx(known.film.faces.axial_position, abs=1e-5 * C)
