"""Supply areas in a joint: fixed in the housing, and in a journal that turns."""

import math

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

SPEED = 200.0


def _bearing(**options):
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=72, n_z=8),
        **options,
    )


def _run(bearing, steps=40):
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    body = mbs.CreateRigidBody(
        inertia=InertiaCuboid(density=7800, sideLengths=[0.05, 0.05, 0.1]),
        nodeType=exu.NodeType.RotationRxyz,
        referencePosition=[0, 0, 0],
        initialAngularVelocity=[0, 0, SPEED],
        gravity=[0, -500.0, 0],
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="supplied", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = steps * 2e-4
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    mbs.SolveDynamic(settings)
    return joint.history


@pytest.mark.parametrize("cavitation", [ehd.SwiftStieber(), ehd.ElrodAdams()])
def test_housing_groove_feeds_the_film(cavitation):
    groove = ehd.AxialGroove(angle=0.5 * math.pi, width_angle=0.3, length=0.02, pressure=2e5)
    history = _run(_bearing(supply=(groove,), cavitation=cavitation))
    assert np.all(np.isfinite(history.force))
    # oil flows in at the groove, and what flows in leaves at the ends (and, with a history, fills the cavity)
    assert np.all(history.supply_flow[5:] > 0.0)
    assert history.supply_flow[-1] == pytest.approx(history.leakage[-1], rel=0.5)


def test_groove_in_the_journal_turns_with_it():
    groove = ehd.AxialGroove(angle=0.0, width_angle=0.3, length=0.02, pressure=5e5, rotating=True)
    bearing = _bearing(supply=(groove,))
    history = _run(bearing)
    model = build_model(bearing)
    # the spin hardly changes over 8 ms: the angle follows from the recorded speeds by the trapezoidal rule
    angle = np.concatenate(
        [[0.0], np.cumsum(0.5 * (history.motion[1:, 8] + history.motion[:-1, 8]) * np.diff(history.time))]
    )
    for k in (0, 7, 20, 33):
        expected = model.evaluate(history.motion[k], None, 0.0, angle[k]).wrench
        # the rule is off by 1e-9 rad
        assert np.allclose(history.force[k], expected[:3], rtol=1e-8, atol=1e-8 * np.abs(expected[:3]).max())
    still = model.evaluate(history.motion[20], None, 0.0, 0.0).wrench
    assert not np.allclose(history.force[20], still[:3], rtol=1e-3)


def test_a_recess_drags_the_housing_as_it_brakes_the_journal():
    """Two free bodies: the housing gains the spin that the journal loses, by the recess's 4 mu U / d as well."""
    size, depth = math.pi, 4e-4
    inertia = InertiaCuboid(density=7800, sideLengths=[0.05, 0.05, 0.1])

    def spins(depth):
        pocket = ehd.Pocket(angle=0.0, width_angle=size, length=0.02, pressure=0.0, depth=depth)
        mbs = exu.SystemContainer().AddSystem()
        bodies = [
            mbs.CreateRigidBody(
                inertia=inertia,
                nodeType=exu.NodeType.RotationRxyz,
                referencePosition=[0, 0, 0],
                initialAngularVelocity=[0, 0, spin],
                returnDict=True,
            )
            for spin in (0.0, SPEED)
        ]
        ehd.CreateLubricatedJoint(
            mbs,
            itemNumbers=[body["bodyNumber"] for body in bodies],
            position=[0, 0, 0],
            axis=[0, 0, 1],
            bearing=_bearing(supply=(pocket,), cavitation=ehd.FullSommerfeld()),
        )
        mbs.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.01, 20
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings)
        mbs.SolveDynamic(settings)
        kind = exu.OutputVariableType.AngularVelocity
        return np.array([mbs.GetNodeOutput(body["nodeNumber"], kind)[2] for body in bodies])

    deep, shallow = spins(None), spins(depth)
    # round-off of Newton's method
    assert deep.sum() == pytest.approx(SPEED, rel=1e-9) and shallow.sum() == pytest.approx(SPEED, rel=1e-9)
    # concentric; the slip falls by the rate of both bodies together
    area, lands = size * 0.025 * 0.02, (2.0 * math.pi * 0.03 - size * 0.02) * 0.025
    rates = [
        2.0 * 0.02 * 0.025**2 * (lands / 50e-6 + more) / inertia.InertiaCOM()[2, 2]
        for more in (0.0, 4.0 * area / depth)
    ]
    for found, rate in zip((deep, shallow), rates, strict=True):
        assert found[1] - found[0] == pytest.approx(SPEED * math.exp(-0.01 * rate), rel=1e-5)
