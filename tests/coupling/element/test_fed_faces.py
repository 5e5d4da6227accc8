"""Joints whose journal's film feeds those on the end faces."""

import dataclasses
import math

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.joint.audit.indicators import with_ends
from exudyn_ehd.joint.audit.samples import RecordedSteps, recorded_states
from exudyn_ehd.joint.model.build import build_study_model

C, CJ, MU = 40e-6, 50e-6, 0.03
GROOVE = ehd.CircumferentialGroove(width=8e-3, pressure=2e5)
PADS = ehd.TaperLand(pads=4, depth=3e-5)


def _bearing(feed=True, faces=None, **options):
    own = {"inner_radius": 0.026, "outer_radius": 0.05, "clearance": C, "profile": PADS, "n_theta": 48, "n_r": 6}
    edges = {"feed": ehd.JournalLeakage()} if feed else {}
    faces = ehd.ThrustFaces(**(own | edges | (faces or {})))
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=CJ,
        lubricant=ehd.Lubricant(viscosity=MU),
        **{"film": ehd.FiniteLength(n_theta=48, n_z=6), "supply": (GROOVE,), "thrust": faces, **options},
    )


@pytest.mark.parametrize(
    ("closure", "offset"),
    (
        (ehd.SwiftStieber(), 0.0),
        pytest.param(ehd.SwiftStieber(), 0.15, marks=pytest.mark.slow),
        pytest.param(ehd.FullSommerfeld(), 0.15, marks=pytest.mark.slow),
    ),
    ids=("swift", "swift_apart", "full_apart"),
)
def test_jacobian(closure, offset):
    """Central differences of the force of both elements between two bodies that move, tilt and slide at random.

    Steps of 1e-8 m against 4e-5 m of gap: as of unfed faces, 2e-6 of the largest entry of its kind.
    """
    mbs = scenes.new_system()
    one = scenes.add_body(mbs, "Rxyz", (0.1, 0, 0), scenes.rotation([0.1, 0.2, 0.3]))
    two = scenes.add_body(mbs, "EP", (0, 0.05, 0), scenes.rotation([0.4, -0.2, 0.3]))
    bearing = _bearing(cavitation=closure)
    joint = ehd.CreateLubricatedJoint(mbs, "pin", [one, two], [0, 0, 0], [0.2, 0.1, 1.0], bearing)
    film, faces = joint.element, joint.element.faces
    if offset:
        # the same joint, with its journal's point elsewhere on the axis
        side = film.sides[1]
        side.rho += offset * side.rotation[:, 2]
        faces.offset = offset
    mbs.Assemble()
    rng, fed = np.random.default_rng(2), 0

    def force(q, q_t):
        return sum(part.force(mbs, 0.0, 0, q.tolist(), q_t.tolist()) for part in (film, faces))

    for _ in range(3):
        q, q_t = np.zeros(13), 1e-2 * rng.normal(size=13)
        q[6:9] = 1.2e-5 * rng.normal(size=3)
        q[9:] = 4e-5 * rng.normal(size=4)
        q_t[9:] += [0.0, 1.0, 2.0, 20.0]
        assert np.all(np.isfinite(force(q, q_t)))
        fed += faces._found.balanced.sum()
        for f_q, f_qt, step in ((1.0, 0.0, 1e-9), (0.0, 1.0, 1e-6)):
            force(q, q_t)
            jacobian = sum(part.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt) for part in (film, faces))
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
    assert fed


def _rotor(bearings, *, mass=30.0, speed=200.0, place=(0.0, 0.0, 0.0), turn=None, load=None, control=None):
    """A shaft that spins in one bearing or more, 0.2 m apart, under a load (3,) or a function of the time."""
    mbs = scenes.new_system()
    turn = np.eye(3) if turn is None else turn
    shaft = mbs.CreateRigidBody(
        inertia=InertiaCylinder(mass / (math.pi * 0.03**2 * 0.1), 0.1, 0.03, 2),
        initialDisplacement=list(place),
        initialRotationMatrix=turn,
        initialAngularVelocity=[0.0, 0.0, speed],
        nodeType=exu.NodeType.RotationRxyz,
    )
    ground = mbs.CreateGround()
    joints = [
        ehd.CreateLubricatedJoint(
            mbs, f"film {k}", [ground, shaft], [0, 0, 0.2 * k], [0, 0, 1], bearing, stepControl=control
        )
        for k, bearing in enumerate(bearings)
    ]
    if callable(load):
        mbs.CreateForce(itemNumber=shaft, loadVectorUserFunction=lambda mbs, t, v: load(t))
    elif load is not None:
        mbs.CreateForce(itemNumber=shaft, loadVector=list(load))
    mbs.Assemble()
    return mbs, joints


def _watch(joint):
    """Largest difference of the flows of balanced edges over these, by accepted steps."""
    found = []

    def see(trial):
        both = joint.element.faces._found
        assert both.journal is trial.evaluation
        b = both.balanced
        found.append(np.abs((both.taken - both.given)[b] / both.given[b]).max(initial=0.0))
        assert np.all(both.taken[~b] >= both.given[~b])

    joint.element.steps.observers.append(see)
    return found


def test_held_in_its_place():
    """Off the middle and tilted: the films of `steady`, and what histories and sensors say of them."""
    bearing = _bearing()
    _, (joint,) = _rotor([bearing], place=(1e-5, -2e-5, 12e-6), turn=scenes.rotation([2e-4, 1e-4, 0.0]))
    film, faces = joint.film(), joint.element.faces
    x, y, bx, by = film.motion[:4]
    place = faces.place(joint.element.sides, film.motion)
    known = ehd.steady(
        bearing,
        speed=film.motion[8],
        eccentricity_ratio=math.hypot(x, y) / CJ,
        direction=math.atan2(y, x),
        tilt=(bx, by),
        axial_position=place,
    )
    # rates of the tilted axis are zero to rounding
    assert np.abs(film.motion[4:8]).max() < 1e-12
    assert film.pressure == pytest.approx(known.pressure, abs=1e-9 * known.pressure.max())
    assert film.pressure[0, [0, -1]] == pytest.approx(known.faces.edge_pressures, rel=1e-9)
    assert film.force == pytest.approx(known.force, rel=1e-9)
    wrench = faces.wrench(joint.element.sides)
    assert wrench[:3] == pytest.approx(known.faces.force, rel=1e-9)
    assert wrench[3:] == pytest.approx(known.faces.moment, rel=1e-9)
    assert abs(known.faces.edge_pressures[0] - known.faces.edge_pressures[1]) > 1e4


FIRST, SECOND = np.array([0.0, -800.0, 0.0]), np.array([300.0, -1500.0, 1500.0])


def _changing(t):
    return FIRST + min(max((t - 0.01) / 0.03, 0.0), 1.0) * (SECOND - FIRST)


@pytest.mark.slow
def test_moving_journal_goes_where_equilibrium_says():
    """A heavy shaft placed under one load, which changes to another one and stays.

    Films settle within some 10 ms: in the end they are those of the steady load. On the way flows are the same to 1e-9,
    and Newton's method takes as many iterations as between faces with given pressures.
    """
    counts = []
    for feed in (True, False):
        bearing = _bearing(feed)
        mbs, (joint,) = _rotor([bearing], mass=300.0, load=_changing)
        start = joint.place_in_equilibrium(load=FIRST[:2])
        missed = _watch(joint) if feed else [0.0]
        ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.09, 180)))
        counts.append(mbs.sys["dynamicSolver"].it.newtonStepsCount)
        assert max(missed) < 1e-9
        history = joint.history
        stays = history.time < 0.01
        # the spin falls by 1e-3 meanwhile
        assert np.abs(history.eccentricity[stays] - start.position).max() < 1e-3 * CJ
        assert np.abs(history.axial_position[stays]).max() < 1e-3 * C
        assert history.leakage[0] == pytest.approx(start.film.leakage, rel=1e-9)
        motion = history.motion[-1]
        end = ehd.equilibrium(
            bearing, speed=motion[8], load=tuple(SECOND[:2]), tilt=tuple(motion[2:4]), axial_load=SECOND[2]
        )
        assert motion[:2] == pytest.approx(end.position, abs=5e-4 * CJ)
        assert history.axial_position[-1] == pytest.approx(end.film.faces.axial_position, abs=1e-3 * C)
        assert history.leakage[-1] == pytest.approx(end.film.leakage, rel=1e-3)
        assert history.thrust_force[-1] == pytest.approx(-SECOND[2], rel=1e-3)
        assert history.thrust_torque[-1] == pytest.approx(end.film.faces.friction_torque, rel=1e-3)
        if feed:
            ends = joint.film().pressure[0, [0, -1]]
            assert ends == pytest.approx(end.film.faces.edge_pressures, rel=2e-3)
            # the bearing's ends have none
            assert np.all(ends > 1e5)
    assert counts[0] <= 1.1 * counts[1]


def _settings(end, steps, start=0.0):
    settings = scenes.settings(end, steps)
    settings.timeIntegration.startTime = start
    return ehd.ConfigureSolver(settings)


@pytest.mark.slow
def test_a_run_goes_on_from_its_state(tmp_path):
    """From a file, in a new system: to what is left of the flows."""
    bearing = _bearing()
    whole, (joint,) = _rotor([bearing], load=_changing)
    ehd.SolveDynamic(whole, _settings(0.02, 80))
    half, _ = _rotor([bearing], load=_changing)
    ehd.SolveDynamic(half, _settings(0.01, 40))
    ehd.SaveState(half, tmp_path / "half.npz")
    rest, (second,) = _rotor([bearing], load=_changing)
    ehd.SolveDynamic(rest, _settings(0.02, 40, 0.01), restart=tmp_path / "half.npz")
    one, two = joint.history, second.history
    for name in ("eccentricity", "axial_position", "leakage", "thrust_force", "thrust_torque"):
        a, b = getattr(one, name), getattr(two, name)
        assert b == pytest.approx(a, abs=1e-10 * np.abs(a).max())


@pytest.mark.slow
def test_two_bearings_on_threads():
    """Each holds the shaft in one direction; the bits are those of one thread."""
    bearings = [_bearing(faces={"lower": False}), _bearing(faces={"upper": False})]
    runs = []
    for threads in (1, 2):
        mbs, joints = _rotor(bearings, load=(0.0, -900.0, 300.0))
        missed = [_watch(joint) for joint in joints]
        ehd.SolveDynamic(mbs, _settings(0.01, 50), threads=threads)
        assert 0.0 < max(map(max, missed)) < 1e-9
        runs.append([joint.history for joint in joints])
    for one, two in zip(*runs, strict=True):
        for name in ("motion", "axial_position", "leakage", "thrust_force"):
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))


@pytest.mark.slow
def test_step_control_watches_fed_faces():
    """Steps that a push makes coarse; with a control the gap of the faces changes by no more than it says."""
    bearing = _bearing(faces={"profile": None, "contact": ehd.RegularisedWall(onset=0.1 * C)})
    changes = []
    for control in (None, ehd.StepControl(largest_gap_change=0.05)):
        mbs, (joint,) = _rotor([bearing], load=(0.0, -800.0, 2e5), control=control)
        ehd.SolveDynamic(mbs, _settings(1e-3, 10))
        gap = joint.history.thrust_minimum_gap
        changes.append((np.abs(np.diff(gap)) / np.maximum(gap[:-1], 0.1 * C)).max())
    assert changes[0] > 0.1
    assert changes[1] < 0.05


@pytest.mark.slow
def test_audit_sees_the_recorded_films():
    """Its films, solved again from the record, have the leakage and the ends that the run's had."""
    bearing = _bearing()
    mbs, (joint,) = _rotor([bearing], load=_changing)
    ehd.SolveDynamic(mbs, _settings(0.05, 200))
    history = joint.history
    names = [field.name for field in dataclasses.fields(RecordedSteps)]
    record = RecordedSteps(**{name: getattr(history, name) for name in names})
    model = build_study_model(dataclasses.replace(bearing, thrust=None), 0.0)
    states = with_ends(bearing, model, record, recorded_states(model, record))
    assert len(states) > 2
    for state in states:
        film, k = state.evaluate(model).quantities(), state.recorded
        assert film["leakage"] == pytest.approx(history.leakage[k], rel=1e-9)
        assert film["peak_pressure"] == pytest.approx(history.peak_pressure[k], rel=1e-9)
    audit = joint.audit()
    assert audit["thrust faces"].on
    assert all(finding.change is None or finding.change.found for finding in audit.findings)


@pytest.mark.slow
def test_a_whole_shaft_in_equilibrium():
    """Place, stiffness and damping are those of `equilibrium`, along the axis those of its faces."""
    bearing, load = _bearing(), np.array([30.0, -400.0, 900.0])
    mbs, _ = _rotor([bearing], load=load)
    found = ehd.SolveEquilibrium(mbs, 300.0)
    motion, place = found.motion[0, 0], found.coordinates[0, 2]
    known = ehd.equilibrium(bearing, speed=300.0, load=tuple(load[:2]), tilt=tuple(motion[2:4]), axial_load=load[2])
    assert motion[:2] == pytest.approx(known.position, abs=1e-6 * CJ)
    assert place == pytest.approx(known.film.faces.axial_position, abs=1e-6 * C)
    axes = found.directions[0].T @ np.eye(6)[:, :3]
    K, D = (axes.T @ matrix[0] @ axes for matrix in (found.stiffness_matrix, found.damping_matrix))
    assert K[:2, :2] == pytest.approx(known.stiffness, rel=1e-5)
    assert D[:2, :2] == pytest.approx(known.damping, rel=1e-5)
    # the flow through the journal's film pulls at it, too
    assert K[2, 2] == pytest.approx(known.film.faces.axial_stiffness, rel=1e-3)
    assert D[2, 2] == pytest.approx(known.film.faces.axial_damping, rel=1e-3)
