"""Residuals with the bushes' part beside Exudyn's, against Exudyn's own."""

from contextlib import contextmanager

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid

import exudyn_ehd as ehd
from exudyn_ehd.coupling.bush.residual import BushResiduals
from exudyn_ehd.coupling.items.object_mass import as_sparse
from exudyn_ehd.coupling.run.start_guess import motion

MESH = ehd.HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=8).mesh()
SOFT = ehd.SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)


def model(kind):
    """A bush that falls on its supports, beside nothing or bodies whose masses Exudyn keeps or asks for."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    low, top = MESH.generatrix(MESH.outer, -np.pi / 2), MESH.generatrix(MESH.outer, np.pi / 2)
    bush = ehd.CreateFlexibleBush(
        mbs,
        bush=ehd.ANCFBush(mesh=MESH, material=SOFT, damping=ehd.Rayleigh(mass_rate=2.0, stiffness_time=1e-4)),
        outer=ehd.FreeOuter(),
        supports=[ehd.Support(nodes=low.nodes), ehd.Support(nodes=top.nodes, directions=(True, False, False))],
        loads=[ehd.Gravity(acceleration=(0.0, -9.81, 0.0))],
        initialVelocity=(0.0, -1.0, 0.5),
    )
    if kind == "mass point":
        mbs.CreateMassPoint(mass=2.0, gravity=[0, -9.81, 0], initialVelocity=[1, 2, 3])
    if kind == "disc":
        mbs.CreateRigidBody(
            inertia=InertiaCuboid(density=2000.0, sideLengths=[0.6, 0.7, 0.3]),
            initialAngularVelocity=[0, 0, 3],
            create2D=True,
        )
    if kind == "pendulum":
        body = mbs.CreateRigidBody(
            inertia=InertiaCuboid(density=2000.0, sideLengths=[0.6, 0.7, 0.3]),
            gravity=[0, -9.81, 0],
            initialAngularVelocity=[0, 0, 3],
        )
        mbs.CreateSphericalJoint(itemNumbers=[mbs.CreateGround(), body], position=[0, 0, 0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 3, 3e-3
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    return container, mbs, bush, settings


@pytest.mark.parametrize(("kind", "times"), [("alone", 1), ("mass point", 1), ("pendulum", 3), ("disc", 3)])
def test_residual_and_its_measure_are_exudyn_s(monkeypatch, kind, times):
    compared, without = [], BushResiduals.without_masses

    @contextmanager
    def compare(self, mbs, solver, settings):
        # beside the solution, where the residual would be rounding
        accelerations = motion(mbs)[2]
        solution = accelerations.copy()
        accelerations += np.sin(np.arange(1.0, len(solution) + 1))
        # Exudyn keeps a constant mass matrix of the system, from which the bush's is missing after the first time
        whole = len(compared) < times
        if kind == "disc":
            # whose constant mass is not taken for granted: the bush's is taken out of it every time
            solver.ComputeMassMatrix(mbs)
        measure, expected = solver.ComputeNewtonResidual(mbs, settings), np.array(solver.GetSystemResidual())
        with without(self, mbs, solver, settings):
            if whole:
                assert self(solver, mbs, settings) == pytest.approx(measure, rel=1e-12)
                # sums in another order
                np.testing.assert_allclose(self.vector, expected, atol=1e-12 * np.abs(expected).max())
            compared.append(whole)
            accelerations[:] = solution
            yield

    monkeypatch.setattr(BushResiduals, "without_masses", compare)
    _container, mbs, bush, settings = model(kind)
    mass = as_sparse(mbs.GetObjectParameter(bush.objectNumber, "massMatrix"))
    ehd.SolveDynamicSparse(mbs, settings)
    assert sum(compared) == times
    after = as_sparse(mbs.GetObjectParameter(bush.objectNumber, "massMatrix"))
    assert mass.nnz > 0 and abs(mass - after).max() == 0.0
    assert (
        mbs.GetObjectParameter(bush.objectNumber, "forceUserFunction")["function"].__self__.equations is bush.equations
    )


def test_objects_that_users_have_changed_stay_with_exudyn():
    _container, mbs, bush, settings = model("alone")
    force = mbs.GetObjectParameter(bush.objectNumber, "forceUserFunction")["function"]
    called = []

    def counted(*arguments):
        called.append(1)
        return force(*arguments)

    mbs.SetObjectParameter(bush.objectNumber, "forceUserFunction", counted)
    run = ehd.SolveDynamicSparse(mbs, settings)
    # with the initial accelerations
    assert len(called) > run.iterations + run.steps
