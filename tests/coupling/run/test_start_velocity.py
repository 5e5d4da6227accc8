"""Initial velocities that do not fit the joints."""

import warnings

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.coupling.run.solve import warn_of_misfit

CLEARANCE = 30e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.04,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
    contact=ehd.RegularisedWall(onset=3e-6),
)
STEP = 1e-4


def swing(count, miss):
    """Hinged bars that turn at 3 rad/s about the first hinge, of which ``miss`` says whether they move as they turn."""
    mbs = exu.SystemContainer().AddSystem()
    last = mbs.CreateGround()
    for k in range(count):
        bar = mbs.CreateRigidBody(
            inertia=InertiaCuboid(7800, [0.8, 0.05, 0.05]),
            referencePosition=[0.8 * k + 0.4, 0, 0],
            initialAngularVelocity=[0, 0, 3.0],
            initialVelocity=[0, 0 if miss else 3.0 * (0.8 * k + 0.4), 0],
        )
        mbs.CreateRevoluteJoint(f"hinge {k}", itemNumbers=[last, bar], position=[0.8 * k, 0, 0], axis=[0, 0, 1])
        last = bar
    ehd.ReplaceJoints(mbs, bearing=BEARING, tilt=ehd.Held())
    mbs.Assemble()
    return mbs


def run(mbs, steps):
    settings = ehd.ConfigureSolver(exu.SimulationSettings())
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = steps * STEP, steps
    settings.solution.file.write = False
    return ehd.SolveDynamic(mbs, settings)


def test_velocities_across_all_bores_are_told_at_the_start():
    """The first hinge misses 0.4 m x 3 rad/s; the second one 0.8 m x 3 rad/s, as both its bars turn about middles at
    rest."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.filterwarnings("error", "SolveDynamic: the initial")
        with pytest.raises(
            ehd.PlausibilityWarning,
            match=r"bores by 2.4 m/s in LubricatedJoint 'film of hinge 1' \(clearance 3e-05 m\), "
            r"1.2 m/s in LubricatedJoint 'film of hinge 0' .*; for an impact that is meant",
        ):
            run(swing(2, miss=True), 2)
    # with those of the mechanism nothing is told: warnings are errors here
    assert run(swing(2, miss=False), 2)


def told(motion, bearing, step):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_of_misfit([("joint", motion, bearing)], step)
    return bool(caught)


def test_orbits_whirl_and_resolved_impacts_are_not_told():
    rng = np.random.default_rng(8)
    for _ in range(200):
        c, omega = 10.0 ** rng.uniform(-5.5, -3.5), 10.0 ** rng.uniform(-1.0, 4.0)
        bearing = ehd.JournalBearing(
            journal_radius=1e3 * c, length=1e3 * c, radial_clearance=c, lubricant=ehd.Lubricant(viscosity=0.02)
        )
        angle, motion = rng.uniform(0.0, 6.0), np.zeros(10)
        motion[8] = rng.choice([-1.0, 1.0]) * omega
        # an orbit as fast as the journal turns, at all of the clearance, in steps of up to half a radian
        motion[4:6] = c * omega * np.array([np.cos(angle), np.sin(angle)])
        assert not told(motion, bearing, rng.uniform(0.01, 0.5) / omega)
        # an impact without spin that twenty steps resolve, whatever its speed
        speed = 10.0 ** rng.uniform(-3.0, 1.0)
        motion[4:6], motion[8] = speed * np.array([np.cos(angle), np.sin(angle)]), 0.0
        assert not told(motion, bearing, 0.05 * c / speed)
        # beyond its bore within one step
        assert told(motion, bearing, 1.1 * c / speed)
        # tilting counts at the ends
        motion[4:6], motion[6] = 0.0, 2.0 * speed / bearing.length
        assert told(motion, bearing, 1.1 * c / speed) and not told(motion, bearing, 0.9 * c / speed)
        # far faster than any orbit, and not resolved
        motion[4:8], motion[8] = [speed, 0.0, 0.0, 0.0], speed / (200.0 * c)
        assert told(motion, bearing, 0.2 * c / speed) and not told(motion, bearing, 0.05 * c / speed)
