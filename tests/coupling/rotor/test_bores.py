"""Rotors on flexible bushes and journals: against rigid bearings, the whole linear problem of rotor and bores, and runs
in time."""

import itertools

import exudyn as exu
import numpy as np
import pytest
import scipy
from rigid_rotors import CLEARANCE, WEIGHT, bearing, bush_mesh, inertia_of, plastic, shaft

import exudyn_ehd as ehd
from tests.sampling import sample

SPEED = 300.0
BORES = {
    "modes": {"bush": ehd.ModalBush(mesh=bush_mesh(), material=plastic(), tolerance=0.2)},
    "mesh": {"bush": ehd.ANCFBush(mesh=bush_mesh(), material=plastic())},
    "journal": {
        "journal": ehd.ElasticJournal(material=plastic(), span=(-0.02, 0.02), held=ehd.HeldEnds(), tolerance=0.2)
    },
}


@pytest.mark.parametrize("name", list(BORES))
def test_a_very_stiff_bore_is_a_rigid_one(name):
    ((kind, surface),) = BORES[name].items()
    changes = {"mesh": bush_mesh()} if kind == "bush" else {"span": surface.span, "held": surface.held}
    stiff = type(surface)(material=plastic(youngs_modulus=1e16), **changes)
    rigid, found = (
        ehd.SolveEquilibrium(shaft(place=0.05, film=bearing(**options))[0], SPEED) for options in ({}, {kind: stiff})
    )
    np.testing.assert_allclose(found.motion[0, :, :4], rigid.motion[0, :, :4], atol=1e-5 * CLEARANCE)
    vibrations = found.eigenvalues[0][found.eigenvalues[0].imag > 0.0]
    np.testing.assert_allclose(vibrations, rigid.eigenvalues[0][rigid.eigenvalues[0].imag > 0.0], rtol=1e-4)


def whole_stiffness(result, s):
    """Dynamic stiffness of the rotor's motions and of all coordinates of the bores together, which have no mass."""
    M, D, K = (part[0] for part in (result.mass_matrix, result.damping_matrix, result.stiffness_matrix))
    corner, right, below, bores = s**2 * M + s * D + K, [], [], []
    for memory in result.memories[0]:
        slow, own = (k + s * c for k, c in (memory.slow, memory.response.rest))
        corner = corner + memory.loads @ (own[:4, :4] - slow) @ memory.places
        right.append(memory.loads @ own[:4, 4:])
        below.append(own[4:, :4] @ memory.places)
        bores.append(own[4:, 4:] + memory.response.stiffness)
    return np.block([[corner, np.hstack(right)], [np.vstack(below), scipy.linalg.block_diag(*bores)]])


def middle(values, low, high):
    """Middle of the widest gap between values within two limits."""
    edges = np.sort([low, *values[(values > low) & (values < high)], high])
    k = np.argmax(np.diff(edges))
    return 0.5 * (edges[k] + edges[k + 1])


def number_inside(result, left, right, low, high):
    """Number of eigenvalues in a rectangle, by the turns of the determinant around it."""
    corners = [left + 1j * low, right + 1j * low, right + 1j * high, left + 1j * high, left + 1j * low]
    path = np.concatenate([np.linspace(a, b, 600) for a, b in itertools.pairwise(corners)])
    signs = [np.linalg.slogdet(whole_stiffness(result, s))[0] for s in path]
    turns = np.diff(np.unwrap(np.angle(signs)))
    assert np.abs(turns).max() < 1.5
    return turns.sum() / (2.0 * np.pi)


@pytest.mark.parametrize("seed", sample([1, 2, 3, 4], 1))
def test_no_vibration_is_missed_and_none_stands_twice(seed):
    """Random rotors; each of their vibrations solves the whole dynamic stiffness, whose determinant counts them."""
    rng, counted = np.random.default_rng(seed), 0
    for name in ("modes", "journal"):
        mass, load = float(np.exp(rng.uniform(np.log(5.0), np.log(1000.0)))), float(rng.uniform(300.0, 3000.0))
        scale = {"transverse": 0.01 * mass * rng.uniform(0.3, 3.0), "polar": 0.005 * mass, "weight": load / mass}
        rotor = shaft(mass=mass, place=rng.uniform(0.0, 0.1), film=bearing(**BORES[name]), **scale)[0]
        speed = float(rng.uniform(100.0, 700.0))
        found = ehd.SolveEquilibrium(rotor, speed)
        values = found.eigenvalues[0]
        for value, mode in zip(values, found.modes[0].T, strict=True):
            terms = [
                value**2 * found.mass_matrix[0] @ (y := found.directions[0].T @ mode),
                value * found.damping_matrix[0] @ y,
                found.stiffness_matrix[0] @ y,
                *(memory.beyond(value) @ y for memory in found.memories[0]),
            ]
            assert np.abs(sum(terms)).max() < 1e-6 * max(np.abs(term).max() for term in terms), (name, value)
        # sides that pass eigenvalues by
        left, low = middle(values.real, -0.45 * speed, -0.1 * speed), middle(values.imag, 0.1 * speed, 0.6 * speed)
        box = left, speed, low, 40.0 * speed
        inside = (values.real > box[0]) & (values.real < box[1]) & (values.imag > box[2]) & (values.imag < box[3])
        assert np.sum(inside) == pytest.approx(number_inside(found, *box), abs=1e-6)
        counted += np.sum(inside)
    assert counted > 0


def on_a_housing(film, turned):
    """A rotor of 20 kg in two films of one housing of 5 kg on springs; the housing's mass contains the bushes."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    housing = mbs.CreateRigidBody(inertia=inertia_of(5.0, 0.05, 0.05, turned), gravity=-WEIGHT * turned[:, 1])
    body = mbs.CreateRigidBody(inertia=inertia_of(20.0, 0.3, 0.1, turned), gravity=-WEIGHT * turned[:, 1])
    mbs.CreateRigidBodySpringDamper(
        itemNumbers=[ground, housing],
        stiffness=np.kron(np.diag([1.0, 0.0]), turned @ np.diag([2e7, 1e7, 3e7]) @ turned.T)
        + np.kron(np.diag([0.0, 1.0]), 1e5 * np.eye(3)),
        damping=np.kron(np.diag([1.0, 0.0]), 1e3 * np.eye(3)) + np.kron(np.diag([0.0, 1.0]), 10.0 * np.eye(3)),
        useIntrinsicFormulation=False,
    )
    joints = [
        ehd.CreateLubricatedJoint(
            mbs, name, [housing, body], z * turned[:, 2], turned[:, 2], bearing=film, rotationMatrixAxes=turned
        )
        for name, z in (("left", -0.1), ("right", 0.1))
    ]
    axes = [*map(int, np.abs(turned[:, 2]).round()), 0, 0, 0]
    mbs.CreateGenericJoint(itemNumbers=[ground, body], position=[0, 0, 0], constrainedAxes=axes)
    mbs.Assemble()
    return mbs, joints


@pytest.mark.parametrize("axis", [2, 0])
def test_a_mesh_counts_as_a_rigid_part_of_its_housing(axis):
    """The vibrations on springs are those with a rigid bearing in a housing of the same mass."""
    turned = np.roll(np.eye(3), axis - 2, axis=0)
    stiff = ehd.ANCFBush(mesh=bush_mesh(), material=plastic(youngs_modulus=1e16))
    rigid, found = (
        ehd.SolveEquilibrium(on_a_housing(bearing(**options), turned)[0], SPEED) for options in ({}, {"bush": stiff})
    )
    np.testing.assert_allclose(found.mass_matrix[0].trace(), rigid.mass_matrix[0].trace(), rtol=1e-6)
    ours, theirs = (r.eigenvalues[0][r.eigenvalues[0].imag > 0.0] for r in (found, rigid))
    np.testing.assert_allclose(ours, theirs, rtol=1e-3)


def test_a_mesh_and_its_modes_agree():
    """One bush, in a housing that vibrates."""
    modes = ehd.ModalBush(mesh=bush_mesh(), material=plastic(), tolerance=0.02)
    bushes = modes, BORES["mesh"]["bush"]
    found = [ehd.SolveEquilibrium(on_a_housing(bearing(bush=bush), np.eye(3))[0], SPEED) for bush in bushes]
    np.testing.assert_allclose(found[1].motion[0, :, :2], found[0].motion[0, :, :2], atol=0.01 * CLEARANCE)
    ours, theirs = (r.eigenvalues[0][r.eigenvalues[0].imag > 0.0] for r in found)
    np.testing.assert_allclose(ours, theirs, rtol=0.02)


def history_of(mbs, result, speed, joint, turns, steps):
    """Times and eccentricities (n, 2) of a run from the equilibrium."""
    result.place(mbs, speed)
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = turns * 2.0 * np.pi / speed
    settings.timeIntegration.numberOfSteps = turns * steps
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings, spectralRadius=0.9)
    ehd.SolveDynamic(mbs, settings)
    return joint.history.time, joint.history.eccentricity


@pytest.mark.parametrize("name", ["modes", "journal", pytest.param("mesh", marks=pytest.mark.slow), "modes, pockets"])
def test_a_run_that_starts_in_the_equilibrium_stays_there(name):
    feed = ehd.Orifice(diameter=4e-4, supply_pressure=3e6, compressible_volume=1e-6)
    supply = tuple(ehd.Pocket(angle=0.5 * np.pi * k, width_angle=1.0, length=0.012, supply=feed) for k in range(4))
    options = {"supply": supply} if name.endswith("pockets") else {}
    mbs, joints = on_a_housing(bearing(**BORES[name.partition(",")[0]], **options), np.eye(3))
    result = ehd.SolveEquilibrium(mbs, SPEED)
    _, e = history_of(mbs, result, SPEED, joints[0], 1, 10)
    assert np.abs(e - result.motion[0, 0, :2]).max() < 1e-4 * CLEARANCE


@pytest.mark.slow
@pytest.mark.parametrize("name", ["modes", "journal"])
def test_a_free_vibration_has_the_foretold_frequency_and_damping(name):
    """After a small push, once the quick motions have died out."""
    film = bearing(**BORES[name])
    single = ehd.equilibrium(film, speed=SPEED, load=(0.0, -600.0))
    mass = 1.6 * single.critical_mass
    rotor = {"mass": mass, "transverse": 0.01 * mass, "polar": 0.005 * mass, "weight": 1200.0 / mass}

    def push(mbs, ground, body, turn):
        mbs.CreateForce(
            itemNumber=body,
            loadVector=[1, 0, 0],
            loadVectorUserFunction=lambda mbs, t, v: [10.0 * np.sin(SPEED * t) ** 2 * (SPEED * t < np.pi), 0.0, 0.0],
        )

    mbs, _, joints = shaft(film=film, extra=push, **rotor)
    result = ehd.SolveEquilibrium(mbs, SPEED)
    values = result.eigenvalues[0]
    foretold = values[np.argmax(np.where(values.imag > 0.0, values.real, -np.inf))]
    t, e = history_of(mbs, result, SPEED, joints[0], 16, 100)
    x = (e - result.motion[0, 0, :2])[t > 0.5 * t[-1]]
    # one vibration: two coefficients, of both directions
    step = t[1] - t[0]
    before, here, after = (part.ravel() for part in (x[:-20], x[10:-10], x[20:]))
    a, b = np.linalg.lstsq(np.column_stack((here, before)), after, rcond=None)[0]
    root = max(np.roots([1.0, -a, -b]), key=lambda z: z.imag)
    measured = np.log(root) / (10.0 * step)
    assert measured.imag == pytest.approx(foretold.imag, rel=0.02)
    assert measured.real == pytest.approx(foretold.real, abs=0.02 * abs(foretold.imag) / (2.0 * np.pi))
