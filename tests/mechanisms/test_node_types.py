"""The real film gives the same motion whatever the journal's node type and solver."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd

CLEARANCE = 50e-6
SPEED = 200.0
END = 2e-3


def _history(node, *, steps, solver=None):
    mbs = exu.SystemContainer().AddSystem()
    body = mbs.CreateRigidBody(
        inertia=InertiaCuboid(density=7800, sideLengths=[0.05, 0.05, 0.1]),
        nodeType=node,
        referencePosition=[0, 0, 0],
        initialDisplacement=[0.3 * CLEARANCE, 0, 0],
        initialAngularVelocity=[0, 0, SPEED],
        gravity=[0, -200.0, 0],
    )
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.005),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="journal", itemNumbers=[mbs.CreateGround(), body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = END
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings, relativeTolerance=1e-9)
    if solver is None:
        mbs.SolveDynamic(settings)
    else:
        mbs.SolveDynamic(settings, solverType=solver)
    return joint.history


@pytest.fixture(scope="module")
def reference():
    return _history(exu.NodeType.RotationRxyz, steps=100)


@pytest.mark.parametrize("node", [exu.NodeType.RotationEulerParameters, exu.NodeType.RotationRotationVector])
def test_node_types(reference, node):
    got = _history(node, steps=100)
    assert np.ptp(reference.eccentricity[:, 1]) > 0.05 * CLEARANCE
    # Newton stops at 1e-9 of the residual; the attitude is integrated to another error of second order, which enters
    # the film only through the spin's drop by friction
    assert np.allclose(got.eccentricity, reference.eccentricity, atol=1e-5 * CLEARANCE)
    assert np.allclose(got.force, reference.force, atol=1e-4 * np.abs(reference.force).max())


@pytest.mark.slow
@pytest.mark.parametrize("node", [exu.NodeType.RotationRxyz, exu.NodeType.RotationRotationVector])
def test_explicit_and_implicit_solvers(node):
    implicit = _history(node, steps=400)
    explicit = _history(node, steps=2000, solver=exu.DynamicSolverType.RK44)
    at = [np.interp(implicit.time, explicit.time, explicit.eccentricity[:, k]) for k in (0, 1)]
    # the implicit integrator's own error at 400 steps, second order in the step
    assert np.allclose(np.column_stack(at), implicit.eccentricity, atol=1e-3 * CLEARANCE)
