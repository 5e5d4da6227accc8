"""Rotors in two films against `equilibrium`, closed forms of the rigid rotor, and time integration."""

import itertools

import exudyn as exu
import numpy as np
import pytest
from rigid_rotors import (
    CLEARANCE,
    EULER,
    SPAN,
    TAIT_BRYAN,
    VECTOR,
    WEIGHT,
    bearing,
    bush_mesh,
    fixed,
    inertia_of,
    plastic,
    shaft,
    sprung,
    three_bodies,
)

import exudyn_ehd as ehd
from exudyn_ehd.coupling.rotor import vibrations
from tests.sampling import sample

SPEED = 300.0


@pytest.fixture(scope="module")
def reference():
    return ehd.SolveEquilibrium(shaft(place=0.05)[0], [SPEED, 600.0])


def test_a_symmetric_rotor_is_two_single_bearings():
    """Place, K, C, threshold speed and whirl ratio of half the rotor on one film."""
    mbs, *_ = shaft(mass=20.0, transverse=0.3, polar=0.1)
    found = ehd.SolveThreshold(mbs, 600.0, 2500.0)
    speed = float(found.speeds[0])
    single = ehd.equilibrium(bearing(), speed=speed, load=(0.0, -10.0 * WEIGHT))
    for k in (0, 1):
        np.testing.assert_allclose(found.motion[0, k, :2], single.position, rtol=1e-10)
        np.testing.assert_allclose(found.stiffness[0, k, :2, :2], single.stiffness, rtol=1e-10)
        np.testing.assert_allclose(found.damping[0, k, :2, :2], single.damping, rtol=1e-10)
    assert found.attitude_angle[0] == pytest.approx(single.attitude_angle, rel=1e-10)
    # half of the rotor's mass is the critical one there
    assert single.critical_mass == pytest.approx(10.0, rel=1e-7)
    vibration = found.eigenvalues[0, np.argmax(found.eigenvalues[0].real)]
    assert abs(vibration.real) < 1e-8 * speed
    assert abs(vibration.imag) / speed == pytest.approx(single.whirl_ratio, rel=1e-8)


OIL = {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)}
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
PIN = ehd.ElasticJournal(material=STEEL, span=(-0.02, 0.02), held=ehd.HeldEnds(), tolerance=0.2)
MEMORIES = {
    "oil content": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "liner": {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=3e8)},
    "oil content, liner": {
        "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5),
        "bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=3e8),
    },
    "pockets": {
        "supply": tuple(
            ehd.Pocket(
                angle=angle,
                width_angle=1.1,
                length=0.012,
                supply=ehd.Orifice(diameter=4e-4, supply_pressure=3e6, compressible_volume=1e-5, bulk_modulus=1e9),
            )
            for angle in (0.1, 1.7, 3.2, 4.8)
        ),
    },
    "bush": {"bush": ehd.ModalBush(mesh=bush_mesh(), material=plastic(), tolerance=0.2)},
    "mesh": {"bush": ehd.ANCFBush(mesh=bush_mesh(), material=plastic())},
    "oil content, bush, journal": {
        "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5),
        "bush": ehd.ModalBush(mesh=bush_mesh(), material=plastic(), tolerance=0.2),
        "journal": ehd.ElasticJournal(material=plastic(), span=(-0.02, 0.02), held=ehd.HeldEnds(), tolerance=0.2),
    },
    "heat": {"lubricant": ehd.oil("ISO VG 46"), "thermal": ehd.LumpedThermal(supply_temperature=313.0)},
    "wear": {
        "asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=2e9),
        "wear": ehd.ArchardWear(wear_rate=1e-16),
    },
}


@pytest.mark.parametrize("options", MEMORIES.values(), ids=list(MEMORIES))
def test_a_symmetric_rotor_in_films_that_remember_is_two_single_bearings(options):
    """Rotor of the critical mass of `equilibrium`: one vibration neither grows nor decays; response to unbalance."""
    film, load = bearing(**options), 600.0
    single = ehd.equilibrium(film, speed=SPEED, load=(0.0, -load))
    mass = single.critical_mass
    mbs, body, _ = shaft(mass=2.0 * mass, transverse=0.01 * mass, polar=0.005 * mass, weight=load / mass, film=film)
    found = ehd.SolveEquilibrium(mbs, SPEED)
    np.testing.assert_allclose(found.motion[0, :, :2], [single.position] * 2, rtol=1e-7)
    values = found.eigenvalues[0]
    vibration = values[np.argmax(values.real)]
    assert abs(vibration.real) < 1e-5 * SPEED
    assert abs(vibration.imag) / SPEED == pytest.approx(single.whirl_ratio, rel=1e-6)
    # an eigenvalue of the whole dynamic stiffness each, with its mode
    for value, mode in zip(values, np.moveaxis(found.modes[0], 1, 0), strict=True):
        y = found.directions[0].T @ mode
        terms = [
            value**2 * found.mass_matrix[0] @ y,
            value * found.damping_matrix[0] @ y,
            found.stiffness_matrix[0] @ y,
        ]
        terms += [memory.beyond(value) @ y for memory in found.memories[0]]
        assert np.abs(sum(terms)).max() < 1e-6 * max(np.abs(term).max() for term in terms)
    unbalance = 1e-6 * mass
    response = found.unbalance_response({body: unbalance})
    (Z,) = single.dynamic_stiffness([SPEED])
    expected = np.linalg.solve(2.0 * (Z - SPEED**2 * mass * np.eye(2)), unbalance * SPEED**2 * np.array([1.0, -1j]))
    np.testing.assert_allclose(response.films[0, 0], expected, rtol=1e-5)


def slowest_motion(result, speed):
    """Largest real part of the eigenvalues that Newton's method for det T(s) = 0 finds from many first guesses."""
    M, D, K = result.mass_matrix[0], result.damping_matrix[0], result.stiffness_matrix[0]
    scale = np.abs(K).max()

    def determinant(s):
        return np.linalg.det((K + s * D + s * s * M + sum(memory.beyond(s) for memory in result.memories[0])) / scale)

    found = []
    for decay, frequency in itertools.product((-0.01, 0.05, 0.15, 0.5, 1.0), (0.0, 0.3, 0.49, 0.8, 1.2)):
        s = speed * complex(-decay, frequency)
        for _ in range(40):
            slope = (determinant(s * (1.0 + 1e-6)) - determinant(s * (1.0 - 1e-6))) / (2e-6 * s)
            step = determinant(s) / slope
            s -= step
            if not abs(step) > 1e-8 * abs(s):
                found.append(s.real)
                break
    assert len(found) > 3
    return max(found)


TWO_LOBES = ehd.two_lobe(preload=0.3)
DIFFICULT = {
    "light rotor on hard liners": (2.0, 1200.0, {**OIL, "bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e10)}),
    "light rotor on soft liners": (2.0, 1200.0, {**OIL, "bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)}),
    "oil without a cavity": (200.0, 9.81, {**OIL, "end_pressures": (2e6, 2e6)}),
    "hardly a cavity": (200.0, 9.81, {**OIL, "end_pressures": (3e5, 3e5)}),
    "two lobes": (200.0, 9.81, {**OIL, "arcs": TWO_LOBES}),
    "light rotor, elastic journal": (2.0, 1200.0, {"journal": PIN}),
}


@pytest.mark.parametrize("name", sample(list(DIFFICULT), 2))
def test_growth_is_that_of_the_slowest_motion(name):
    mass, weight, options = DIFFICULT[name]
    mbs, _, _ = shaft(mass=mass, transverse=0.02 * mass, polar=0.01 * mass, weight=weight, film=bearing(**options))
    found = ehd.SolveEquilibrium(mbs, SPEED)
    assert found.growth[0] == pytest.approx(slowest_motion(found, SPEED), rel=1e-6)


def test_motions_that_are_not_found_are_no_result(monkeypatch):
    mbs, _, _ = shaft(film=bearing(**OIL))
    found = ehd.SolveEquilibrium(mbs, SPEED)
    monkeypatch.setattr(vibrations, "_refined", lambda M, D, K, films, s, y: (s, None))
    with pytest.raises(ehd.FilmError, match="the vibrations at 300 rad/s are not all found"):
        found.growth  # noqa: B018


def test_an_eigenvalue_that_is_exact_to_round_off_is_found():
    """A first guess at which the dynamic stiffness is singular, with a vector that is not in balance yet."""
    M, D, K = np.eye(2), np.diag([3.0, 1.0]), np.diag([2.0, 7.0])
    for s in (-1.0, -2.0):
        found, y = vibrations._refined(M, D, K, [], complex(s), np.array([1.0, 1e-5], dtype=complex))
        assert found == s
        np.testing.assert_allclose(np.abs(y), [1.0, 0.0], atol=1e-12)


def unstable_motions(result):
    """Number of eigenvalues with a positive real part, by the turns of det T along the imaginary axis.

    ``det T(s)`` behaves as s^2n far away, and stable films have no poles on the right: of n half turns from 0 to
    infinity every root on the right takes two.
    """
    M, D, K = result.mass_matrix[0], result.damping_matrix[0], result.stiffness_matrix[0]
    signs = []
    for nu in (0.0, *np.geomspace(1e-2, 1e8, 1000)):
        T = K + 1j * nu * D - nu**2 * M + sum(memory.beyond(1j * nu) for memory in result.memories[0])
        signs.append(np.linalg.slogdet(T)[0])
    angles = np.unwrap(np.angle(signs))
    return len(M) - (angles[-1] - angles[0]) / np.pi


@pytest.mark.parametrize(("mass", "speed"), sample([(20.0, 300.0), (200.0, 300.0), (4000.0, 600.0)], 1))
@pytest.mark.parametrize("name", ["oil content", "liner", "oil content, liner", "bush", "oil content, bush, journal"])
def test_no_vibration_in_films_that_remember_is_missed(name, mass, speed):
    """Nyquist counts the unstable ones, and no vibration stands twice, in a rotor that is not symmetric."""
    film = bearing(**MEMORIES[name])
    scale = {"transverse": 0.01 * mass, "polar": 0.005 * mass, "weight": 200.0 * WEIGHT / mass}
    found = ehd.SolveEquilibrium(shaft(place=0.05, mass=mass, film=film, **scale)[0], speed)
    values = found.eigenvalues[0]
    assert np.sum(values.real > 0.0) == pytest.approx(unstable_motions(found), abs=0.02)
    swinging = values[values.imag > 0.0]
    apart = np.abs(swinging[:, None] - swinging) / np.abs(swinging) + np.eye(swinging.size)
    assert swinging.size >= 2 and apart.min() > 1e-3
    assert np.isfinite(found.campbell()["frequency"]).sum() == swinging.size


@pytest.mark.parametrize("seed", sample([1, 2, 3, 4], 1))
def test_no_vibration_stands_twice(seed):
    """Random symmetric rotors, whose vibrations come in neighbours; each solves the whole dynamic stiffness."""
    rng, names = np.random.default_rng(seed), ["oil content", "liner", "oil content, liner", "pockets", "bush"]
    for name in names * 3:
        mass, load = float(np.exp(rng.uniform(np.log(5.0), np.log(1000.0)))), float(rng.uniform(300.0, 3000.0))
        scale = {"transverse": 0.01 * mass * rng.uniform(0.3, 3.0), "polar": 0.005 * mass, "weight": load / mass}
        rotor = shaft(mass=mass, film=bearing(**MEMORIES[name]), **scale)[0]
        found = ehd.SolveEquilibrium(rotor, float(rng.uniform(100.0, 700.0)))
        there = np.isfinite(found.eigenvalues[0])
        values, modes = found.eigenvalues[0, there], found.directions[0].T @ found.modes[0][:, there]
        assert np.sum(values.imag > 0.0) >= 2 and np.all(np.diff(values.imag) >= 0.0)
        modes /= np.linalg.norm(modes, axis=0)
        for k, (value, y) in enumerate(zip(values, modes.T, strict=True)):
            close = np.abs(values[:k] - value) < 1e-5 * abs(value)
            assert not np.any(close & (np.abs(y.conj() @ modes[:, :k]) > 1.0 - 1e-5)), (name, mass, value)
            M, D, K = (part[0] for part in (found.mass_matrix, found.damping_matrix, found.stiffness_matrix))
            terms = [
                value**2 * M @ y,
                value * D @ y,
                K @ y,
                *(memory.beyond(value) @ y for memory in found.memories[0]),
            ]
            assert np.abs(sum(terms)).max() < 1e-5 * max(np.abs(term).max() for term in terms)


def test_a_vertical_rotor_at_the_exact_centre_has_the_coefficients_of_a_slight_load():
    """Without a load, and with one that moves it by 1e-5 of the clearance."""
    fine = bearing(film=ehd.FiniteLength())
    free, loaded = (
        ehd.SolveEquilibrium(shaft(weight=weight, film=fine)[0], [SPEED]) for weight in (0.0, 1e-5 * WEIGHT)
    )
    assert np.abs(free.motion[0, :, :2]).max() < 1e-9 * CLEARANCE
    for name in ("stiffness", "damping"):
        centre, near = (getattr(r, name)[0, :, :2, :2] for r in (free, loaded))
        # one direction of the slight load against the mean: the grid's error, below 2e-3
        np.testing.assert_allclose(centre, near, rtol=0.0, atol=2e-3 * np.abs(near).max())


def test_a_vertical_rotor_at_the_exact_centre_of_unfed_grooves_has_no_coefficients():
    groove = ehd.AxialGroove(angle=1.0, width_angle=0.3)
    mbs = shaft(weight=0.0, film=bearing(supply=(groove,)))[0]
    with pytest.raises(ehd.FilmError, match=r"joint '.*': at the exact centre"):
        ehd.SolveEquilibrium(mbs, [SPEED])


def test_eigenvalues_are_those_of_the_rigid_rotor_on_its_coefficients(reference):
    """m e'' = f, Jt and i Omega Jp by hand, from K and C (4, 4) of the films about the centre of mass."""
    for k, speed in enumerate(reference.speeds):
        K, C = np.zeros((2, 4, 4))
        for film, z in enumerate((-0.5 * SPAN - 0.05, 0.5 * SPAN - 0.05)):
            at = np.eye(4)
            at[0, 2] = at[1, 3] = z
            K += at.T @ reference.stiffness[k, film] @ at
            C += at.T @ reference.damping[k, film] @ at
        # slopes (bx, by) are rotations (-by, bx): gyroscopic moments couple them
        C[2, 3], C[3, 2] = C[2, 3] + speed * 1.0, C[3, 2] - speed * 1.0
        M = np.diag([200.0, 200.0, 2.0, 2.0])
        matrix = np.block([[np.zeros((4, 4)), np.eye(4)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
        expected = np.linalg.eigvals(matrix)
        for value in reference.eigenvalues[k]:
            assert np.abs(expected - value).min() < 1e-6 * abs(value)


@pytest.mark.parametrize("node", [EULER, TAIT_BRYAN, VECTOR])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_results_depend_neither_on_the_node_nor_on_the_axis(reference, node, axis):
    found = ehd.SolveEquilibrium(shaft(place=0.05, node=node, axis=axis)[0], SPEED)
    np.testing.assert_allclose(found.eccentricity_ratio[0], reference.eccentricity_ratio[0], rtol=1e-8)
    np.testing.assert_allclose(found.eigenvalues[0], reference.eigenvalues[0], rtol=0, atol=1e-6 * SPEED)


def test_a_rotor_that_turns_the_other_way_is_its_mirror_image(reference):
    found = ehd.SolveEquilibrium(shaft(place=0.05)[0], -SPEED)
    np.testing.assert_allclose(found.motion[0, :, :2], reference.motion[0, :, :2] * [-1.0, 1.0], atol=1e-9 * CLEARANCE)
    np.testing.assert_allclose(found.attitude_angle[0], reference.attitude_angle[0], rtol=1e-8)
    np.testing.assert_allclose(found.eigenvalues[0], reference.eigenvalues[0], rtol=0, atol=1e-6 * SPEED)
    np.testing.assert_allclose(found.campbell()["whirl"][0], reference.campbell()["whirl"][0], atol=1e-6)


def test_bodies_that_are_fixed_to_each_other_are_one():
    transverse = 0.1 + 0.3 + 0.1 + 2.0 * 10.0 * 0.15**2
    one = ehd.SolveEquilibrium(shaft(mass=40.0, transverse=transverse, polar=0.3)[0], SPEED)
    three = ehd.SolveEquilibrium(three_bodies(fixed, (EULER, TAIT_BRYAN, VECTOR))[0], SPEED)
    np.testing.assert_allclose(three.eigenvalues, one.eigenvalues, rtol=0, atol=1e-7 * SPEED)
    np.testing.assert_allclose(three.motion[0, :, :4], one.motion[0, :, :4], atol=1e-8 * CLEARANCE)


def test_a_torsionally_soft_shaft_twists_against_the_driven_body():
    torsion = 1e5
    mbs, bodies = three_bodies(sprung([1e8, 1e8, 1e9, 1e6, 1e6, torsion]))
    values = ehd.SolveEquilibrium(mbs, SPEED).eigenvalues[0]
    chain = np.linalg.solve(np.diag([0.2, 0.05]), torsion * np.array([[2.0, -1.0], [-1.0, 1.0]]))
    for frequency in np.sqrt(np.linalg.eigvals(chain).real):
        assert np.abs(values.imag - frequency).min() < 1e-6 * frequency
    # the same named one by one
    named = ehd.SolveEquilibrium(mbs, SPEED, rotors=[bodies])
    np.testing.assert_allclose(named.eigenvalues[0], values, rtol=0, atol=1e-6 * SPEED)


def amplitudes_of_a_run(result, film, speed, unbalance, steps, turns):
    """Amplitudes (2, 2) of x and y of both journals in the last turn of a run with an unbalance."""

    def load(mbs, shaft, shaft_body, turn):
        torque = -float(result.wrench[0, :, 5].sum())
        mbs.CreateTorque(itemNumber=shaft_body, loadVector=[0, 0, torque])
        force = unbalance * speed**2
        mbs.CreateForce(
            itemNumber=shaft_body,
            loadVector=[1, 0, 0],
            loadVectorUserFunction=lambda mbs, t, v: [force * np.cos(speed * t), force * np.sin(speed * t), 0.0],
        )

    run, _, joints = shaft(place=0.05, extra=load, film=film)
    result.place(run, speed)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * np.pi / speed
    settings.timeIntegration.numberOfSteps = turns * steps
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(run, settings)
    out = []
    for k, joint in enumerate(joints):
        history = joint.history
        e, t = history.eccentricity[-steps:] - result.motion[0, k, :2], history.time[-steps:]
        out.append(2.0 * np.mean(e * np.exp(-1j * speed * t)[:, None], axis=0))
    return np.array(out)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "options"),
    [(150.0, {}), (300.0, {}), (500.0, {}), (300.0, MEMORIES["oil content"]), (300.0, MEMORIES["liner"])],
)
def test_what_a_run_does_under_unbalance_is_foretold(speed, options):
    """Amplitude and phase of the run's last turn, from an undisturbed start."""
    film = bearing(**options)
    mbs, body, _ = shaft(place=0.05, film=film)
    result = ehd.SolveEquilibrium(mbs, speed)
    unbalance = 0.002 * CLEARANCE * result.stiffness[0, 0, 0, 0] / speed**2
    # films with a memory begin flooded, which takes some turns to fade away, with and without an unbalance; memories
    # are integrated with errors of first order in the step, which are extrapolated with oil content
    turns, *all_steps = {"cavitation": (24, 60, 120), "bush": (12, 240)}.get(next(iter(options), ""), (12, 80))
    found = []
    for steps in all_steps:
        found.append(amplitudes_of_a_run(result, film, speed, unbalance, steps, turns))
        if options:
            found[-1] -= amplitudes_of_a_run(result, film, speed, 0.0, steps, turns)
    measured = found[0] if len(found) == 1 else 2.0 * found[1] - found[0]
    foretold = result.unbalance_response({body: unbalance}).films[0]
    assert np.all(np.abs(measured - foretold).max(axis=1) < 0.01 * np.abs(foretold).max(axis=1))


@pytest.mark.slow
def test_a_shaft_of_beams_turns_unstable_where_the_example_of_whirl_has_it(example):
    """Against its linear theory by hand, without gyroscopic moments and the bushes' moments; and its unbalance."""
    whirl = example("rotor_oil_whirl")
    film = whirl.bearing(quick=True)
    by_hand = whirl.LinearRotor(4, film).threshold()
    rotor = whirl.Rotor(4, film, lambda t: 0.0, lambda t: 0.0)
    found = ehd.SolveThreshold(rotor.mbs, 0.95 * by_hand, 1.05 * by_hand)
    assert found.speeds[0] == pytest.approx(by_hand, rel=2e-4)


def test_speeds_and_orbits_of_geared_rotors():
    """Two shafts beside each other, one twice as fast the other way: as each of them alone."""
    single = ehd.SolveEquilibrium(shaft(place=0.05)[0], [SPEED]).eigenvalues[0]
    fast = ehd.SolveEquilibrium(shaft(place=0.05)[0], [-2.0 * SPEED]).eigenvalues[0]

    def beside(mbs, ground, body, turn):
        other = mbs.CreateRigidBody(
            referencePosition=[1.0, 0, 0.05], inertia=inertia_of(200.0, 2.0, 1.0, np.eye(3)), gravity=[0, -WEIGHT, 0]
        )
        for name, z in (("third", -0.2), ("fourth", 0.2)):
            ehd.CreateLubricatedJoint(mbs, name, [ground, other], [1.0, 0, z], [0, 0, 1], bearing())
        mbs.CreateGenericJoint(itemNumbers=[ground, other], position=[1, 0, 0], constrainedAxes=[0, 0, 1, 0, 0, 0])

    mbs, body, _ = shaft(place=0.05, extra=beside)
    both = ehd.SolveEquilibrium(mbs, SPEED, ratios=[1.0, -2.0])
    expected = np.concatenate((single, fast))
    expected = expected[np.lexsort((expected.real, expected.imag))]
    np.testing.assert_allclose(both.eigenvalues[0], expected, rtol=0, atol=1e-6 * SPEED)
    response, alone = both.unbalance_response({body: 1e-4}), ehd.SolveEquilibrium(shaft(place=0.05)[0], SPEED)
    np.testing.assert_allclose(
        response.amplitude("left"), alone.unbalance_response({body: 1e-4}).amplitude("left"), rtol=1e-6
    )
    assert response.amplitude("third")[0] < 1e-9 * response.amplitude("left")[0]


def test_unbalances_add_up_and_turn_with_the_shaft(reference):
    body = exu.ObjectIndex(1)
    one, turned = (reference.unbalance_response({body: value}) for value in (1e-4, 1e-4j))
    np.testing.assert_allclose(turned.films, 1j * one.films, rtol=1e-12)
    np.testing.assert_allclose(turned.phase("left") - one.phase("left"), np.pi / 2.0, rtol=1e-9)
    back = ehd.SolveEquilibrium(shaft(place=0.05)[0], -SPEED).unbalance_response({body: 1e-4})
    np.testing.assert_allclose(back.amplitude(body), one.amplitude(body)[:1], rtol=1e-7)
    np.testing.assert_allclose(back.phase(body), one.phase(body)[:1], rtol=1e-6)
    # slow speeds: the film's spring against the force; the journal's body runs within its films
    forward, backward = one.orbit(body)
    np.testing.assert_allclose(one.amplitude(body), np.abs(forward) + np.abs(backward))


@pytest.mark.parametrize("options", MEMORIES.values(), ids=list(MEMORIES))
def test_a_run_begins_in_the_equilibrium_with_the_films_memory(options):
    """Forces and losses of the first rows are those of the result, and the journals stay."""
    run, _, joints = shaft(place=0.05, film=bearing(**options))
    result = ehd.SolveEquilibrium(run, SPEED)
    result.place(run, SPEED)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 1e-4, 4
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(run, settings)
    for k, joint in enumerate(joints):
        history, force = joint.history, result.wrench[0, k, :3]
        np.testing.assert_allclose(history.force, [force] * 5, rtol=0, atol=2e-4 * np.linalg.norm(force))
        np.testing.assert_allclose(history.power_loss, result.power_loss[0, k], rtol=1e-3)
        np.testing.assert_allclose(history.eccentricity, [result.motion[0, k, :2]] * 5, rtol=0, atol=1e-4 * CLEARANCE)


def test_the_state_of_a_run_and_its_history_stay_as_they_are():
    mbs, _, joints = shaft(place=0.05)
    ehd.SolveEquilibrium(mbs, SPEED).place(mbs, SPEED)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 1e-3, 5
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    coordinates, film = np.array(mbs.systemData.GetODE2Coordinates()), joints[0].element.force
    ehd.SolveEquilibrium(mbs, SPEED)
    np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates(), coordinates)
    assert mbs.systemData.GetTime() == pytest.approx(1e-3) and joints[0].history.time.size == 6
    assert mbs.GetObjectParameter(joints[0].objectNumber, "forceUserFunction")["function"] == film
    # started in equilibrium, it stays there
    assert np.ptp(joints[0].history.eccentricity, axis=0).max() < 1e-6 * CLEARANCE


@pytest.mark.slow
def test_thrust_faces_take_part_with_their_exact_tangent():
    """Place, stiffness and damping along the axis are those of the faces alone, whatever their cavities."""
    b = {"journal_radius": 0.025, "length": 0.03, "radial_clearance": 40e-6, "lubricant": ehd.Lubricant(viscosity=0.02)}
    pads = ehd.TaperLand(pads=4, depth=20e-6)
    faces = ehd.ThrustFaces(inner_radius=0.025, outer_radius=0.04, clearance=40e-6, profile=pads, n_theta=32)
    kind = ehd.JournalBearing(**b, film=ehd.FiniteLength(n_theta=32, n_z=4), thrust=faces)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    rotor = mbs.CreateRigidBody(inertia=inertia_of(20.0, 0.3, 0.1, np.eye(3)))
    ground, load = mbs.CreateGround(), np.array([30.0, -100.0, 400.0])
    joint = ehd.CreateLubricatedJoint(mbs, "film", [ground, rotor], [0, 0, 0], [0, 0, 1], kind)
    mbs.CreateForce(itemNumber=rotor, loadVector=load)
    mbs.Assemble()
    found = ehd.SolveEquilibrium(mbs, 600.0)
    motion, place = found.motion[0, 0], found.coordinates[0, 2]
    known = ehd.steady(
        kind,
        speed=600.0,
        eccentricity_ratio=float(np.hypot(*motion[:2]) / 40e-6),
        direction=float(np.arctan2(motion[1], motion[0])),
        tilt=tuple(motion[2:4]),
        axial_position=float(place),
    )
    np.testing.assert_allclose(known.force + known.faces.force, -load, atol=1e-6 * 400.0)
    along = found.directions[0].T @ np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    assert along @ found.stiffness_matrix[0] @ along == pytest.approx(known.faces.axial_stiffness, rel=1e-4)
    assert along @ found.damping_matrix[0] @ along == pytest.approx(known.faces.axial_damping, rel=1e-4)
    # Exudyn sees the faces again
    assert mbs.GetObjectParameter(joint.objectNumber, "forceUserFunction")["function"] == joint.element.force


def test_a_light_rotor_far_from_the_origin_is_found():
    """The rounding of its place, 7e-15 m, times the films' stiffness is 1e-6 of their loads."""
    places = []
    for far in (0.0, 50.0):
        mbs = exu.SystemContainer().AddSystem()
        ground, origin = mbs.CreateGround(), np.array([far, -far, 0.0])
        inertia = inertia_of(2.0, 0.02, 0.002, np.eye(3))
        body = mbs.CreateRigidBody(referencePosition=origin, inertia=inertia, gravity=[0, -WEIGHT, 0])
        for name, z, axial in (("left", -0.1, ehd.Held()), ("right", 0.1, ehd.Free())):
            at = origin + [0.0, 0.0, z]
            ehd.CreateLubricatedJoint(mbs, name, [ground, body], at, [0, 0, 1], bearing(), axial=axial)
        mbs.Assemble()
        places.append(ehd.SolveEquilibrium(mbs, SPEED).motion[0, :, :2])
    np.testing.assert_allclose(places[1], places[0], rtol=0.0, atol=1e-6 * CLEARANCE)


def test_films_beyond_their_oil_are_told():
    """Outside the table an error, above 150 degrees Celsius a warning, as by `equilibrium`."""

    def rotor(law, supply):
        oil, heat = ehd.Lubricant(temperature_law=law), ehd.LumpedThermal(supply_temperature=supply)
        return ehd.SolveEquilibrium(shaft(film=bearing(lubricant=oil, thermal=heat))[0], [SPEED])

    table = ehd.TableViscosity(temperatures=(300.0, 330.0, 341.0), viscosities=(0.06, 0.02, 0.015))
    with pytest.raises(ehd.FilmError, match=r"SolveEquilibrium, joint '.*': the film's temperatures .* 300 to 341 K"):
        rotor(table, 340.0)
    with pytest.warns(ehd.HotFilmWarning, match="SolveEquilibrium, joint"):
        rotor(ehd.WaltherTemperature(first=(313.15, 46e-6), second=(373.15, 7e-6)), 423.0)
