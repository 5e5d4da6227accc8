"""Errors of runs by their steps where the film's heat decides: random journals under loads that turn or swing."""

import math

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import RigidBodyInertia

import exudyn_ehd as ehd

SUPPLY, PERIODS = 313.15, 3


def scenes(count):
    """Bearing, speed, load, its ratio to the speed, its alternating share and the journal's mass, by one seed."""
    rng = np.random.default_rng(1)
    for _ in range(count):
        R = 0.01 * rng.uniform(1.0, 4.0)
        L, c, mu, speed = (
            R * rng.uniform(0.6, 1.6),
            R * rng.uniform(0.7e-3, 2e-3),
            *10.0 ** rng.uniform((-2, 2), (-1.2, 3)),
        )
        load = rng.uniform(0.3, 3.0) * mu * speed * R * L * (R / c) ** 2
        ratio, share = rng.choice([1.0, 0.5, -0.5, 0.25]), rng.uniform(0.0, 1.3)
        mass = rng.uniform(0.001, 0.05) * load / (c * speed**2)
        law = ehd.ReynoldsTemperature(point=(SUPPLY, mu), coefficient=0.03)
        heat = ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=rng.choice([0.0, 2e3]))
        bearing = ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=c,
            film=ehd.FiniteLength(n_theta=64, n_z=6),
            lubricant=ehd.Lubricant(temperature_law=law),
            thermal=heat,
        )
        yield bearing, speed, load, ratio, share, mass


def run(bearing, speed, load, ratio, share, mass, steps):
    """History of a run with a number of steps per period, and the period, s."""
    nu, mbs = ratio * speed, exu.SystemContainer().AddSystem()
    inertia = RigidBodyInertia(mass=mass, inertiaTensor=1e3 * np.eye(3))
    shaft = mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0.0, 0.0, speed])

    def force(mbs, t, _):
        return [share * load * math.sin(nu * t), -load * (1.0 + share * math.cos(nu * t)), 0.0]

    mbs.CreateForce(itemNumber=shaft, loadVectorUserFunction=force)
    joint = ehd.CreateLubricatedJoint(
        mbs,
        "journal",
        [mbs.CreateGround(), shaft],
        position=[0.0, 0.0, 0.0],
        axis=[0.0, 0.0, 1.0],
        bearing=bearing,
        axial=ehd.Held(),
        tilt=ehd.Held(),
    )
    mbs.Assemble()
    settings, period = ehd.ConfigureSolver(exu.SimulationSettings()), 2.0 * math.pi / abs(nu)
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = PERIODS * steps, PERIODS * period
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    ehd.SolveDynamic(mbs, settings)
    return joint.history, period


def errors(scene, numbers):
    """Largest errors of the position over the minimum film thickness in the last period, for numbers of steps."""
    exact, period = run(*scene, 600)
    out = []
    for steps in numbers:
        h, _ = run(*scene, steps)
        off = [np.interp(h.time, exact.time, exact.motion[:, k]) - h.motion[:, k] for k in (0, 1)]
        out.append(float((np.hypot(*off) / h.minimum_gap)[h.time > (PERIODS - 1) * period].max()))
    return out


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_errors_by_the_steps_fall_with_their_square():
    """Journals under rotating and swinging loads, with 60 and 120 steps per period; one seizes."""
    found = []
    for scene in scenes(14):
        try:
            found.append(errors(scene, (60, 120)))
        except ehd.FilmError as error:
            assert "no oil is a liquid" in str(error)
    coarse, fine = np.array(found).T
    assert len(found) == 13
    # of second order; the smallest are those of the reference
    assert np.median(coarse / fine) > 3.5
    assert np.all(np.sort(fine) < [*[0.008] * 11, 0.02, 0.07])
