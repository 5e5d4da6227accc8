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
