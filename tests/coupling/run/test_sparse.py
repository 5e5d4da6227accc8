"""The package's sparse factorisation on a model with a film element and a flexible bush."""

import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest

import exudyn_ehd as ehd


def _model(load=-500.0, function=0):
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(
        eii.NodeRigidBodyRxyz(referenceCoordinates=[0] * 6, initialVelocities=[0, 0, 0, 0, 0, 100 * math.pi])
    )
    body = mbs.AddObject(eii.ObjectRigidBody(nodeNumber=node, mass=2.0, inertia=[1e-2, 1e-2, 1e-2, 0, 0, 0]))
    centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0, load, 0], loadVectorUserFunction=function))
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="film", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    bush = ehd.ANCFBush(
        mesh=ehd.HollowCylinder(inner_radius=0.1, thickness=0.02, length=0.05, axial=1, radial=1, circumferential=8),
        material=ehd.SaintVenantKirchhoff(youngs_modulus=1e8, poisson_ratio=0.3, density=1000.0),
    )
    ehd.CreateFlexibleBush(mbs, "bush", bush=bush, outer=ehd.FixedOuter(), position=(1, 0, 0))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = 5e-3
    settings.timeIntegration.numberOfSteps = 50
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    return mbs, joint, settings


def test_same_orbit_as_exudyns_own_solver():
    mbs, joint, settings = _model()
    mbs.SolveDynamic(settings)
    expected = joint.history
    mbs, joint, settings = _model()
    ehd.SolveDynamicSparse(mbs, settings)
    got = joint.history
    assert np.allclose(got.time, expected.time)
    # both iterate to a relative residual of 1e-6
    assert np.allclose(got.eccentricity, expected.eccentricity, atol=1e-4 * 50e-6)


def test_a_film_that_fails_is_named():
    mbs, joint, settings = _model(load=-1e6)
    joint.stop_at(pressure=1e12)
    with pytest.raises(
        ehd.FilmError, match=r"'film' can't be evaluated at t = .* gap closed .* last accepted state"
    ) as caught:
        ehd.SolveDynamicSparse(mbs, settings)
    assert isinstance(caught.value.__cause__, exu.ExudynError)
    h = joint.history
    assert h.time.size > 1 and np.all(np.isfinite(h.motion))


def test_newton_that_does_not_converge_is_explained():
    mbs, joint, settings = _model()
    chosen = settings.linearSolver.solverType
    settings.timeIntegration.newton.relativeTolerance = 1e-13
    settings.timeIntegration.newton.absoluteTolerance = 1e-300
    settings.timeIntegration.newton.maxIterations = 1
    with pytest.raises(ehd.RunError, match=r"SolveDynamicSparse: .*'film': eccentricity ratio .* ConfigureSolver"):
        ehd.SolveDynamicSparse(mbs, settings)
    assert settings.linearSolver.solverType == chosen
    assert joint.history.time.size >= 1


def test_errors_of_other_user_functions_pass():
    def load(mbs, t, vector):
        if t > 2e-3:
            raise ValueError("no such load")
        return vector

    mbs, joint, settings = _model(function=load)
    with pytest.raises(exu.ExudynError) as caught:
        ehd.SolveDynamicSparse(mbs, settings)
    assert not isinstance(caught.value, ehd.EHDError)
    assert "no such load" in str(caught.value) or isinstance(caught.value.__cause__, ValueError)
    assert 1e-3 < joint.history.time[-1] <= 2e-3 + 1e-9
