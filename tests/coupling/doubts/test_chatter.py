"""Explicit solvers beyond their stability limit: a linear film with the limit in closed form, a real film, and no false
alarm."""

import exudyn as exu
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.doubts import LIMIT, ChatterWatch
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

CLEARANCE, LENGTH, MASS, SPIN = 50e-6, 0.025, 2.0, 300.0
BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=LENGTH,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=48, n_z=8),
)
# of v' = -lambda v: |R(z)| = 1 at z = step * lambda
LIMITS = {
    exu.DynamicSolverType.ExplicitEuler: 2.0,
    exu.DynamicSolverType.ExplicitMidpoint: 2.0,
    exu.DynamicSolverType.RK33: 2.5127,
    exu.DynamicSolverType.RK44: 2.7853,
}
POLYNOMIALS = {
    exu.DynamicSolverType.ExplicitEuler: (1, 1),
    exu.DynamicSolverType.ExplicitMidpoint: (1, 1, 1 / 2),
    exu.DynamicSolverType.RK33: (1, 1, 1 / 2, 1 / 6),
    exu.DynamicSolverType.RK44: (1, 1, 1 / 2, 1 / 6, 1 / 24),
}


def rotor(load=(0.0, -500.0), position=(0.0, 0.0)):
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    inertia = InertiaCylinder(MASS / (0.1 * np.pi * 0.025**2), 0.1, 0.025, 2)
    body = mbs.CreateRigidBody(
        inertia=inertia,
        nodeType=exu.NodeType.RotationRxyz,
        referencePosition=[0, 0, 0],
        initialDisplacement=[*position, 0],
        initialAngularVelocity=[0, 0, SPIN],
        gravity=[load[0] / MASS, load[1] / MASS, 0],
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="pin", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING
    )
    mbs.Assemble()
    return mbs, joint


def largest_damping(load):
    at = ehd.equilibrium(BEARING, speed=SPIN, load=load).damping
    return float(np.linalg.eigvalsh(0.5 * (at + at.T))[-1])


def run(mbs, end, step, solver):
    ehd.SolveDynamic(mbs, scenes.settings(end, round(end / step)), solverType=solver)


@pytest.mark.parametrize("solver", LIMITS, ids=str)
@pytest.mark.parametrize("share", [0.9, 1.03])
def test_linear_damper_at_the_limit(solver, share):
    """A journal that a Runge-Kutta method takes through v' = -lambda v, exactly: d = v (1 - R) / lambda."""
    z = share * LIMITS[solver]
    growth = sum(a * (-z) ** k for k, a in enumerate(POLYNOMIALS[solver]))
    assert (abs(growth) > 1.0) == (share > 1.0)
    watch, step = ChatterWatch(BEARING), 1e-5
    motion, seen = np.zeros(10), []
    motion[4] = 0.1 * CLEARANCE / step
    for k in range(60):
        seen.append(watch.sees_chatter(k * step, motion))
        motion[0] += motion[4] * (1.0 - growth) / z * step
        motion[4] *= growth
    assert any(seen) == (share > 1.0)


@pytest.mark.parametrize("steps", [4, 8, 50])
@pytest.mark.parametrize("tilt", [False, True])
def test_resolved_oscillations_are_none(steps, tilt):
    """Four steps per period are few, but the motion is that of the step's end points."""
    watch, step = ChatterWatch(BEARING), 1e-5
    size, at = (CLEARANCE / LENGTH, 2) if tilt else (0.5 * CLEARANCE, 0)
    for k in range(400):
        angle, motion = 2.0 * np.pi * k / steps, np.zeros(10)
        motion[[at, at + 4]] = size * np.sin(angle), size * 2.0 * np.pi / (steps * step) * np.cos(angle)
        assert not watch.sees_chatter(k * step, motion)


def test_two_steps_per_period_are_chatter_in_any_direction():
    for at, size in ((0, CLEARANCE), (1, CLEARANCE), (2, CLEARANCE / LENGTH), (3, CLEARANCE / LENGTH)):
        watch, motion = ChatterWatch(BEARING), np.zeros(10)
        for k in range(100):
            motion[[at, at + 4]] = 0.1 * size * (-1) ** k, 1e4 * size * (-1) ** k
            if watch.sees_chatter(1e-5 * k, motion):
                break
        assert k == LIMIT // 2


def test_kicks_are_chatter_and_external_hits_are_none():
    """Every fourth step throws the journal, as an unstable film does; every tenth one, as a gear or a hammer could."""
    for every, expected in ((4, True), (10, False)):
        watch, motion, seen = ChatterWatch(BEARING), np.zeros(10), False
        for k in range(400):
            motion[4] = 0.1 if k % every == 0 else motion[4] * 0.3
            motion[0] = 1e-5 * motion[4] * 0.1
            seen = seen or watch.sees_chatter(1e-5 * k, motion)
        assert seen == expected


def test_rounding_and_impacts_are_none():
    watch, rng, motion = ChatterWatch(BEARING), np.random.default_rng(1), np.zeros(10)
    for k in range(500):
        # positions that stand still up to their last digits; velocity jumps every tenth step
        motion[0] = 1e-8 * CLEARANCE * rng.standard_normal()
        assert not watch.sees_chatter(1e-5 * k, motion)
    for k in range(500):
        place, rate = k % 20, 1.0 if k % 20 < 10 else -1.0
        motion[0], motion[4] = 1e-6 * min(place, 20 - place), 0.1 * rate
        assert not watch.sees_chatter(1.0 + 1e-5 * k, motion)


@pytest.mark.parametrize("solver", LIMITS, ids=str)
def test_step_beyond_the_limit_raises(solver):
    load = (0.0, -500.0)
    step = 1.1 * LIMITS[solver] * MASS / largest_damping(load)
    at = ehd.equilibrium(BEARING, speed=SPIN, load=load).position
    mbs, joint = rotor(load, at)
    with pytest.raises(ehd.FilmError, match=r"'pin' at t = .* explicit solver's step .* smaller steps") as caught:
        run(mbs, 1000 * step, step, solver)
    text = str(caught.value)
    assert "eccentricity ratio" in text and "implicit" in text and "N s/m" in text
    h = joint.history
    # found before the journal is driven away, and all steps are kept
    assert h.time.size > LIMIT // 2
    assert np.all(np.isfinite(h.motion))
    assert np.hypot(*(h.eccentricity[-1] - at)) < 0.02 * CLEARANCE


@pytest.mark.parametrize(
    ("solver", "eccentricity_ratio", "share"),
    [
        (exu.DynamicSolverType.ExplicitEuler, 0.95, 30.0),
        # thrown out of the thin film by ever other amounts, and back
        (exu.DynamicSolverType.RK33, 0.95, 3.0),
        (exu.DynamicSolverType.RK33, 0.8, 10.0),
        (exu.DynamicSolverType.VelocityVerlet, 0.95, 6.0),
        # a wrong place in a film of a fiftieth of the clearance, held without any jump
        (exu.DynamicSolverType.RK44, 0.98, 1.5),
    ],
    ids=str,
)
def test_step_far_beyond_the_limit_raises(solver, eccentricity_ratio, share):
    at = eccentricity_ratio * CLEARANCE * np.array([0.5, -0.866])
    film = build_model(BEARING).evaluate(np.array([*at, *6 * [0.0], SPIN, 0.0]))
    load, damping = tuple(-film.wrench[:2]), -film.tangent()[:2, 4:6]
    damping = float(np.linalg.eigvalsh(0.5 * (damping + damping.T))[-1])
    step = share * LIMITS.get(solver, 2.0) * MASS / damping
    mbs, joint = rotor(load, tuple(at))
    with pytest.raises(ehd.FilmError, match=r"'pin' at t = .* explicit solver's step .* smaller steps"):
        run(mbs, 2000 * step, step, solver)
    assert np.all(np.isfinite(joint.history.motion))


@pytest.mark.parametrize("solver", sample(list(LIMITS), 3), ids=str)
def test_step_well_below_the_limit_agrees_with_the_implicit_solver(solver):
    load, end = (0.0, -500.0), 0.004
    step = end / np.ceil(end / (0.5 * LIMITS[solver] * MASS / largest_damping(load)))
    mbs, joint = rotor(load)
    run(mbs, end, step, solver)
    explicit = joint.history.eccentricity[-1]
    mbs, joint = rotor(load)
    run(mbs, end, end / 800, exu.DynamicSolverType.GeneralizedAlpha)
    implicit = joint.history.eccentricity[-1]
    assert np.hypot(*implicit) > 0.1 * CLEARANCE
    # forward Euler's own error: half a step of some 10 us in a motion of some ms
    assert np.abs(explicit - implicit).max() < 2e-3 * CLEARANCE


def test_automatic_steps_stay_below_the_limit():
    load = (0.0, -500.0)
    step = 4.0 * 3.3 * MASS / largest_damping(load)
    mbs, joint = rotor(load)
    run(mbs, 100 * step, step, exu.DynamicSolverType.DOPRI5)
    assert np.diff(joint.history.time).min() < 0.5 * step


def test_implicit_solvers_are_not_watched():
    mbs, joint = rotor()
    step = 4.0 * 2.8 * MASS / largest_damping((0.0, -500.0))
    run(mbs, 100 * step, step, exu.DynamicSolverType.GeneralizedAlpha)
    assert joint.element.steps._chatter is None
