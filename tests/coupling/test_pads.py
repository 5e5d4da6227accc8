"""`CreateTiltingPadBearing`: pads as bodies against the linear theory of `equilibrium`, in any place and attitude."""

import dataclasses
import gc
import weakref

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import RigidBodyInertia
from scipy.linalg import eig, expm

import exudyn_ehd as ehd
from tests.sampling import sample

PADS = ehd.TiltingPads(
    journal_radius=0.05,
    length=0.05,
    radial_clearance=60e-6,
    lubricant=ehd.Lubricant(viscosity=0.02),
    preload=0.4,
    pad_thickness=0.015,
    pad_mass=0.3,
    pad_inertia=1e-4,
    film=ehd.FiniteLength(n_theta=64, n_z=6),
)
SPEED, LOAD, MASS = 300.0, np.array([1000.0, -4000.0]), 400.0
INITIAL = exu.ConfigurationType.Initial


def scene(pads=PADS, *, attitude=None, place=(0.0, 0.0, 0.0), velocity=None, spin=SPEED, load=LOAD, **options):
    """A shaft that hardly loses its speed, under a constant load, in pads on ground or on a heavy moving housing."""
    mbs, A = scenes.new_system(), np.eye(3) if attitude is None else attitude
    drift = np.zeros(3) if velocity is None else np.asarray(velocity)
    inertia = RigidBodyInertia(MASS, np.diag([1e6, 1e6, 1e6]))
    axes = {"referencePosition": list(place), "referenceRotationMatrix": A, "initialVelocity": list(drift)}
    shaft = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=list(A @ [0.0, 0.0, spin]), **axes)
    if velocity is None:
        housing = mbs.CreateGround(referencePosition=list(place), referenceRotationMatrix=A)
    else:
        housing = mbs.CreateRigidBody(inertia=RigidBodyInertia(1e12, 1e12 * np.eye(3)), **axes)
    mbs.CreateForce(itemNumber=shaft, loadVector=list(A @ [*load, 0.0]))
    held = {"axial": ehd.Held(), "tilt": ehd.Held()}
    joint = ehd.CreateTiltingPadBearing(
        mbs,
        name="pads",
        itemNumbers=[housing, shaft],
        position=list(place),
        axis=list(A[:, 2]),
        bearing=pads,
        **(held | options),
    )
    mbs.Assemble()
    return mbs, joint


def move_journal(mbs, joint, shift):
    """Displace the journal in the initial state by (3,), global."""
    node = joint.pads[0].element.sides[1].nodes[0]
    q = np.array(mbs.systemData.GetODE2Coordinates(INITIAL))
    q[mbs.systemData.GetNodeLTGODE2(int(node))[:3]] += shift
    mbs.systemData.SetODE2Coordinates(q.tolist(), INITIAL)


def run(mbs, end_time, steps, **options):
    settings = ehd.ConfigureSolver(exu.SimulationSettings(), **options)
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, end_time
    ehd.SolveDynamic(mbs, settings)


def system(rest, mass=MASS):
    """State matrix of the coordinates of a result, and their rates, with the shaft's mass."""
    M = rest.mass.copy()
    M[0, 0] = M[1, 1] = mass
    k = len(M)
    lower = -np.linalg.solve(M, np.hstack((rest.stiffness, rest.damping)))
    return np.vstack((np.hstack((np.zeros((k, k)), np.eye(k))), lower))


@pytest.mark.parametrize("change", sample([{}, {"pivot_stiffness": 3e8, "pivot_offset": 0.55, "first_pivot": 0.3}], 1))
def test_free_vibration_is_that_of_the_whole_matrices(change):
    """The free vibration of shaft and pads follows K, C and M to a hundredth, and so do frequency and damping."""
    mbs, joint = scene(dataclasses.replace(PADS, **change))
    rest = joint.place_in_equilibrium(load=LOAD)
    assert rest.loaded.all()
    shift = np.array([2e-7, 1e-7])
    move_journal(mbs, joint, [*shift, 0.0])
    end_time, steps = 0.015, 450
    run(mbs, end_time, steps)
    history, A = joint.history, system(rest)
    k = len(A) // 2
    states = [np.concatenate((shift, np.zeros(2 * k - 2)))]
    step = expm(A * end_time / steps)
    for _ in range(steps):
        states.append(step @ states[-1])
    linear = np.array(states)
    # shifts of flexible pivots follow from forces, which jump at the start
    late = slice(20, None)
    moved, tilted = history.position - rest.position, history.tilts - rest.tilts
    assert np.abs(moved - linear[:, :2])[late].max() < 0.01 * np.abs(linear[late, :2]).max()
    assert np.abs(tilted - linear[:, 2:7])[late].max() < 0.01 * np.abs(linear[late, 2:7]).max()
    if change:
        return
    # the part of every slow mode in the run, by left eigenvectors, decays and turns as its eigenvalue says
    values, left = eig(A, left=True, right=False)
    q = np.hstack((moved, tilted))
    states = np.hstack((q, np.gradient(q, history.time, axis=0)))
    modes = np.flatnonzero((np.abs(values.imag) > 100.0) & (np.abs(values) < 1000.0))
    assert modes.size == 4
    for k in modes:
        part = np.log((states @ left[:, k].conj())[40:241:200])
        turns = part[1] - part[0] + 2j * np.pi * np.arange(-2, 3)
        found = turns / (history.time[240] - history.time[40])
        assert np.abs(found - values[k]).min() < 0.01 * abs(values[k])


RUNS = {
    "rigid pivots": {},
    "flexible pivots": {"pivot_stiffness": 1e9},
    "heat": {"lubricant": ehd.oil("ISO VG 46"), "thermal": ehd.LumpedThermal(supply_temperature=313.0)},
}


@pytest.mark.parametrize("change", sample(list(RUNS), 0))
def test_a_damped_run_ends_in_the_equilibrium(change):
    pads = dataclasses.replace(PADS, **RUNS[change])
    mbs, joint = scene(pads)
    # a larger jump tips the upper pad over
    joint.place_in_equilibrium(load=0.85 * LOAD)
    # the oil is as cold as its supply at the start
    run(mbs, *((0.4, 400) if pads.thermal else (0.1, 250)))
    history = joint.history
    rest = ehd.equilibrium(pads, speed=float(joint.pads[0].history.motion[-1, 8]), load=tuple(LOAD))
    assert np.hypot(*(history.position[0] - rest.position)) > 2e-6
    assert history.position[-1] == pytest.approx(rest.position, abs=2e-9)
    assert history.tilts[-1] == pytest.approx(rest.tilts, abs=1e-7)
    assert history.minimum_gap[-1] == pytest.approx(rest.minimum_gap, rel=1e-3)
    assert history.peak_pressure[-1] == pytest.approx(rest.peak_pressure, rel=1e-3)
    assert history.power_loss[-1] == pytest.approx(rest.power_loss, rel=1e-3)
    assert history.force[-1, :2] == pytest.approx(-LOAD, rel=1e-4)


def test_place_in_equilibrium_starts_at_rest():
    mbs, joint = scene(dataclasses.replace(PADS, pivot_stiffness=1e9))
    # twice, as the second call begins where the first one has moved all
    joint.place_in_equilibrium(load=0.5 * LOAD)
    rest = joint.place_in_equilibrium(load=LOAD)
    assert rest.loaded.all()
    run(mbs, 1e-3, 10)
    history = joint.history
    assert history.position == pytest.approx(np.tile(rest.position, (11, 1)), abs=1e-11)
    assert history.force[0, :2] == pytest.approx(-LOAD, rel=1e-6)
    assert history.tilts == pytest.approx(np.tile(rest.tilts, (11, 1)), rel=1e-4)
    # tilts of the record are the rotations that Exudyn's joints measure
    turned = [mbs.GetObjectOutput(pivot, exu.OutputVariableType.Rotation)[2] for pivot in joint.pivots]
    assert history.tilts[-1] == pytest.approx(turned, abs=1e-9)
    assert len(joint.bodies) == len(joint.pivots) == len(joint.springs) == len(joint.pads) == 5
    assert joint.pads[2].name == "pads pad 3"


@pytest.mark.slow
def test_neither_place_nor_attitude_nor_motion_of_the_model_matter():
    """A turned model on a housing that moves through space has the histories of the one on ground."""
    found = []
    attitude = scenes.rotation(np.array([0.7, -1.1, 0.4]))
    for options in ({}, {"attitude": attitude, "place": (0.3, -2.0, 1.0), "velocity": attitude @ [3.0, 1.0, 2.0]}):
        pads = dataclasses.replace(PADS, first_pivot=0.2)
        # pads count from the housing's own x
        mbs, joint = scene(pads, **options)
        rest = joint.place_in_equilibrium(load=LOAD)
        move_journal(mbs, joint, options.get("attitude", np.eye(3)) @ [2e-6, -1e-6, 0.0])
        run(mbs, 2e-3, 80, relativeTolerance=1e-8)
        found.append((joint.history, rest))
    (one, first), (other, second) = found
    assert second.position == pytest.approx(first.position, rel=1e-9)
    assert np.ptp(one.position, axis=0).max() > 5e-7
    assert other.position == pytest.approx(one.position, abs=1e-12)
    assert other.tilts == pytest.approx(one.tilts, abs=1e-9)
    assert other.force == pytest.approx(one.force, abs=1e-3 * np.abs(one.force).max())


def test_an_unloaded_pad_rests_on_its_leading_edge_in_contact():
    """Without preload the upper pads sprag in a run, too, and the contact holds them where `equilibrium` has them."""
    pads = dataclasses.replace(PADS, preload=0.0, contact=ehd.RegularisedWall(onset=4e-6), first_pivot=-0.5 * np.pi)
    mbs, joint = scene(pads, load=(0.0, -6000.0))
    rest = joint.place_in_equilibrium(load=(0.0, -5000.0))
    assert rest.minimum_gaps[2] < 4e-6
    run(mbs, 0.02, 100)
    last = ehd.equilibrium(pads, speed=SPEED, load=(0.0, -6000.0))
    assert joint.history.position[-1] == pytest.approx(last.position, abs=1e-8)
    assert joint.pads[2].history.minimum_gap[-1] == pytest.approx(last.minimum_gaps[2], rel=0.02)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::exudyn_ehd.RingingWarning", "ignore::exudyn_ehd.GridWarning")
def test_pads_without_preload_flutter_at_about_half_the_spin():
    """Under a turning load the pads beside the loaded one flutter (M. L. Adams, S. Payandeh, J. Lubrication Technology
    105 (1983) 377), and slap on the shaft; with preload they follow it at its own frequency."""
    shares, turning = [], 2500.0
    for preload in (0.0, 0.5):
        contact = ehd.RegularisedWall(onset=2e-6)
        pads = dataclasses.replace(PADS, preload=preload, contact=contact, first_pivot=-0.5 * np.pi)
        mbs, joint = scene(pads, load=(0.0, -6000.0))
        joint.place_in_equilibrium(load=(0.0, -5990.0))

        def unbalance(mbs, t, load):
            return [turning * np.cos(SPEED * t), turning * np.sin(SPEED * t), 0.0]

        mbs.CreateForce(itemNumber=exu.ObjectIndex(0), loadVector=[1.0, 0.0, 0.0], loadVectorUserFunction=unbalance)
        mbs.Assemble()
        run(mbs, 0.4, 1600)
        gap = joint.pads[1].history.minimum_gap[800:]
        size = np.abs(np.fft.rfft((gap - gap.mean()) * np.hanning(gap.size)))
        over_spin = np.fft.rfftfreq(gap.size, 0.4 / 1600) * 2.0 * np.pi / SPEED
        low, own = (size[(over_spin > a) & (over_spin < b)].max() for a, b in ((0.3, 0.7), (0.9, 1.1)))
        shares.append(low / own)
    assert shares[0] > 0.5 and shares[1] < 0.05, shares


def test_weight_of_the_pads_goes_through_the_pivots():
    """Pads have their centres of mass in their pivots: their weight loads the housing alone."""
    histories = []
    for gravity in ((0.0, 0.0, 0.0), (0.0, -50.0, 0.0)):
        mbs, joint = scene(gravity=gravity)
        joint.place_in_equilibrium(load=LOAD)
        run(mbs, 1e-3, 5)
        histories.append(joint.history)
    assert histories[1].tilts == pytest.approx(histories[0].tilts, rel=1e-6)


@pytest.mark.slow
def test_a_system_goes_when_nobody_holds_it():
    mbs, joint = scene()
    joint.place_in_equilibrium(load=LOAD)
    run(mbs, 1e-4, 1)
    known, container = weakref.ref(joint.pads[0].element), mbs.variables.pop("container")
    del mbs, joint, container
    gc.collect()
    assert known() is None


def test_bad_input_by_name():
    mbs = scenes.new_system()
    ground, shaft = mbs.CreateGround(), scenes.add_body(mbs, "EP")
    good = {"itemNumbers": [ground, shaft], "position": [0, 0, 0], "axis": [0, 0, 1], "bearing": PADS}
    where = "CreateTiltingPadBearing"
    for change, message in (
        ({"bearing": dataclasses.replace(PADS, pad_mass=0.0)}, f"{where}.bearing: pads are bodies and need"),
        ({"bearing": dataclasses.replace(PADS, pad_inertia=0.0)}, "pad_inertia above 0, got 0.3 kg and 0.0 kg m2"),
        ({"bearing": PADS.pad(0)}, rf"{where}.bearing must be TiltingPads\(...\)"),
        ({"axial": 1}, f"{where}.axial must be Free"),
        ({"gravity": 9.81}, f"{where}.gravity must be 3 finite numbers"),
        ({"axis": []}, "axis is missing"),
        ({"itemNumbers": [ground, ground]}, "both items are ground"),
        (
            {"itemNumbers": [mbs.CreateMassPoint(mass=1.0), shaft]},
            f"{where}.itemNumbers.0. must be a rigid body",
        ),
        ({"stepControl": 1}, "stepControl"),
        ({"useGlobalFrame": "yes"}, f"{where}.useGlobalFrame must be True or False"),
    ):
        with pytest.raises(ehd.InputError, match=message):
            ehd.CreateTiltingPadBearing(mbs, "a", **(good | change))
    joint = ehd.CreateTiltingPadBearing(mbs, "a", **good)
    with pytest.raises(ehd.InputError, match="'a pad 1' is taken"):
        ehd.CreateTiltingPadBearing(mbs, "a", **good)
    with pytest.raises(ehd.InputError, match="bearing 'a' is not assembled"):
        joint.place_in_equilibrium(load=(0.0, -1.0))
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match="'a' does not turn in the initial state"):
        joint.place_in_equilibrium(load=(0.0, -1.0))


CHANGES = {
    "rigid pivots": {},
    "flexible pivots": {"pivot_stiffness": 3e8, "pivot_offset": 0.55, "first_pivot": 0.3},
    "four pads": {"pads": 4, "extent": 1.2, "load_between_pads": False},
    "heat": RUNS["heat"] | {"preload": 0.5},
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_rotor_on_pads_against_the_matrices_of_the_bearing(change, sense):
    """Places, K and C of films, and all eigenvalues, of speeds that follow each other in a frame of any attitude."""
    pads = dataclasses.replace(PADS, **CHANGES[change])
    if sense < 0.0:
        pads = dataclasses.replace(pads, pivot_offset=1.0 - pads.pivot_offset)
    A = scenes.rotation(np.array([0.4, -0.7, 0.2]))
    mbs, joint = scene(pads, attitude=A, place=(0.3, -0.2, 0.1))
    speeds = sense * np.array([300.0] if pads.thermal else [250.0, 300.0, 600.0])
    found = ehd.SolveEquilibrium(mbs, speeds)
    assert found.joints == tuple(pad.name for pad in joint.pads)
    for k, speed in enumerate(speeds):
        rest = ehd.equilibrium(pads, speed=speed, load=tuple(LOAD))
        films = [film.motion[:2] for film in rest.films]
        np.testing.assert_allclose(found.motion[k, :, :2], films, rtol=0, atol=1e-11)
        np.testing.assert_allclose(found.minimum_gap[k], rest.minimum_gaps, rtol=1e-7)
        own = np.linalg.eigvals(system(rest))
        assert own.size == found.eigenvalues.shape[1]
        away = np.abs(found.eigenvalues[k][:, None] - own) / np.abs(own)
        assert max(away.min(axis=0).max(), away.min(axis=1).max()) < 1e-6


def two_bearings(first, second, mass=200.0):
    """A free rigid shaft across its weight in two bearings, tilting pads or round ones, at +-0.3 m."""
    mbs = scenes.new_system()
    inertia = RigidBodyInertia(mass, np.diag([8.0, 8.0, 100.0]))
    shaft = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0.0, 0.0, SPEED], gravity=[0.0, -9.81, 0.0])
    ground = mbs.CreateGround()
    for k, bearing in enumerate((first, second)):
        create = ehd.CreateTiltingPadBearing if isinstance(bearing, ehd.TiltingPads) else ehd.CreateLubricatedJoint
        axial = ehd.Held() if k == 0 else ehd.Free()
        create(mbs, f"end {k}", [ground, shaft], [0.0, 0.0, 0.6 * k - 0.3], [0.0, 0.0, 1.0], bearing, axial=axial)
    mbs.Assemble()
    return mbs, shaft


def test_symmetric_rotor_on_two_pad_bearings_is_two_single_ones():
    """Its vibrations without tilt are those of half its mass on one bearing."""
    mbs, _ = two_bearings(PADS, PADS)
    found = ehd.SolveEquilibrium(mbs, SPEED)
    rest = ehd.equilibrium(PADS, speed=SPEED, load=(0.0, -100.0 * 9.81))
    np.testing.assert_allclose(found.motion[0, :5, :2], [film.motion[:2] for film in rest.films], rtol=0, atol=1e-11)
    np.testing.assert_allclose(found.motion[0, 5:, :2], [film.motion[:2] for film in rest.films], rtol=0, atol=1e-11)
    for value in np.linalg.eigvals(system(rest, mass=100.0)):
        assert np.abs(found.eigenvalues[0] - value).min() < 1e-6 * abs(value)


def test_rotor_between_a_round_bearing_and_pads_stays_in_its_equilibrium():
    round_bearing = ehd.JournalBearing(
        journal_radius=0.05, length=0.05, radial_clearance=60e-6, lubricant=PADS.lubricant, film=PADS.film
    )
    mbs, shaft = two_bearings(PADS, round_bearing)
    found = ehd.SolveEquilibrium(mbs, SPEED)
    np.testing.assert_allclose(found.wrench[0, 5, :2], [0.0, 981.0], rtol=0, atol=1.0)
    found.place(mbs, SPEED)
    run(mbs, 0.01, 50)
    node = mbs.GetObject(shaft)["nodeNumber"]
    now = np.array(mbs.GetNodeOutput(node, exu.OutputVariableType.Displacement))
    was = mbs.GetNodeOutput(node, exu.OutputVariableType.Displacement, configuration=INITIAL)
    assert np.abs(now - was)[:2].max() < 1e-9


def test_pads_with_cavities_follow_at_the_frequency_of_the_motion():
    """Stiffness and damping of `reduced` against those of the rotor's equations, from the kinematics of its bodies."""
    # a trailing edge under pressure reforms the film behind a cavity
    cavities = {"cavitation": ehd.ElrodAdams(), "pads": 3, "extent": 1.9, "edge_pressures": (0.0, 2e5)}
    pads = dataclasses.replace(PADS, **cavities, preload=0.7, load_between_pads=False)
    rest = ehd.equilibrium(pads, speed=SPEED, load=tuple(LOAD))
    mbs, joint = scene(pads)
    found = ehd.SolveEquilibrium(mbs, SPEED)
    first = found.layout.nodes[int(joint.pads[0].element.sides[1].nodes[0])]
    rows = found.directions[0, first : first + 2]
    parts = found.stiffness_matrix[0], found.damping_matrix[0], found.mass_matrix[0]
    for nu in (50.0, 300.0, 900.0):
        delayed = sum(memory.beyond(1j * nu) for memory in found.memories[0])
        Z = parts[0] + 1j * nu * parts[1] - nu**2 * parts[2] + delayed
        own = np.linalg.inv(rows @ np.linalg.solve(Z, rows.T)) + nu**2 * MASS * np.eye(2)
        K, C = rest.reduced(nu)
        assert np.abs(K + 1j * nu * C - own).max() < 2e-6 * np.abs(own).max()
        slow = dataclasses.replace(rest, memories=()).reduced(nu)
        assert nu < 100.0 or np.abs(slow[0] + 1j * nu * slow[1] - own).max() > 1e-4 * np.abs(own).max()


@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.ElrodAdams()])
def test_free_vibration_of_a_rotor_on_pads_is_that_of_its_eigenvalues(closure):
    """Within a hundredth of the motion."""
    mbs, joint = scene(dataclasses.replace(PADS, cavitation=closure))
    found = ehd.SolveEquilibrium(mbs, SPEED)
    found.place(mbs, SPEED)
    shift = np.array([2e-7, 1e-7])
    move_journal(mbs, joint, [*shift, 0.0])
    end_time, steps = 0.015, 450
    run(mbs, end_time, steps)
    values, modes = found.eigenvalues[0], found.modes[0]
    first = found.layout.nodes[int(joint.pads[0].element.sides[1].nodes[0])]
    # all directions at rest but the journal's, as in the run
    start = np.zeros(len(modes))
    start[first : first + 2] = shift
    parts = np.linalg.lstsq(np.vstack((modes, modes * values)), np.append(start, np.zeros_like(start)).astype(complex))[
        0
    ]
    history = joint.history
    linear = (modes[first : first + 2] @ (parts[:, None] * np.exp(np.outer(values, history.time)))).real.T
    moved = history.position - history.position[-1] + linear[-1]
    assert np.abs(moved - linear)[5:].max() < 0.01 * np.abs(linear[5:]).max()


def test_rotor_whose_pad_is_not_loaded_is_refused():
    mbs, _ = scene(dataclasses.replace(PADS, preload=0.0), load=np.array([0.0, -20e3]))
    with pytest.raises(ehd.FilmError, match=r"pad \d of the bearing is not loaded.*preload"):
        ehd.SolveEquilibrium(mbs, SPEED)
