"""The modal bush in Exudyn: momentum, Jacobian, free journals on every closure, Newton's cost."""

from __future__ import annotations

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder, RigidBodyInertia
from scenes import marker_loads, new_system, rotation, settings

import exudyn_ehd as ehd
from tests.sampling import sample

SPEED = 3000 * 2 * np.pi / 60
C = 30e-6
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=3, radial=2, circumferential=20)
BEARING = ehd.JournalBearing(
    journal_radius=0.03,
    length=0.066,
    radial_clearance=C,
    lubricant=ehd.Lubricant(viscosity=9e-3),
    film=ehd.FiniteLength(n_theta=48, n_z=8),
    bush=ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.1),
)


def scene(bearing, *, housing="ground", load=15e3, offset=3e-3, matrix=None):
    """Journal of 6.6 kg with all six coordinates under a load that swings around, off the mid-plane."""
    mbs = new_system()
    A = np.eye(3) if matrix is None else matrix
    if housing == "ground":
        item = mbs.CreateGround()
    else:
        item = mbs.CreateRigidBody(
            referenceRotationMatrix=A,
            inertia=InertiaCylinder(7800, 0.1, 0.08, 2, 0.05),
            initialVelocity=[0.3, -0.2, 0.1],
            initialAngularVelocity=list(A @ [3.0, -2.0, 5.0]),
        )
    e = A @ [0.4 * C, -0.5 * C, 0.0]
    spin = A @ [3.0, -2.0, 5.0 + SPEED] if housing != "ground" else [0, 0, SPEED]
    journal = mbs.CreateRigidBody(
        referenceRotationMatrix=A,
        initialDisplacement=list(e),
        initialVelocity=[0.3, -0.2, 0.1] if housing != "ground" else [0, 0, 0],
        initialAngularVelocity=list(spin),
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[item, journal],
        position=[0, 0, 0],
        axis=list(A[:, 2]),
        bearing=bearing,
        axial=ehd.Held() if housing == "ground" else ehd.Free(),
    )
    if load:
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, offset]))

        def swing(mbs, t, vector):
            return [0.4 * load * np.sin(314.0 * t), -load * (1 - 0.3 * np.cos(314.0 * t)), 0]

        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, -load, 0], loadVectorUserFunction=swing))
    mbs.Assemble()
    return mbs, joint, item, journal


def run(mbs, steps, step=1e-4, full_newton=True):
    mbs.SolveDynamic(settings(steps * step, steps, tolerance=1e-8, full_newton=full_newton))
    return mbs.sys["dynamicSolver"].it


CLOSURES = {
    "swift": ehd.SwiftStieber(),
    "gumbel": ehd.Gumbel(),
    "elrod": ehd.ElrodAdams(cavity_pressure=-1e5),
    "gumbel in cells": ehd.Gumbel(line_in_cells=True),
    "elrod in cells": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True),
}


@pytest.mark.parametrize("closure", sample(list(CLOSURES)))
def test_free_journal_runs_over_load_periods_and_newton_costs_what_it_does_on_a_rigid_bore(closure):
    results = {}
    for bush in (None, BEARING.bush):
        bearing = dataclasses.replace(BEARING, bush=bush, cavitation=CLOSURES[closure])
        mbs, joint, _, _ = scene(bearing)
        cost = run(mbs, 300)
        results[bush is None] = cost.newtonStepsCount / 300, joint.history
    assert abs(results[False][0] - results[True][0]) < 1.0
    rigid, elastic = results[True][1], results[False][1]
    assert len(elastic.time) == 301
    assert np.all(elastic.minimum_gap > 0.0)
    # the flexible bore lowers the peak (by 3 to 6 % here) and lets the journal go further
    assert 0.85 < elastic.peak_pressure[100:].max() / rigid.peak_pressure[100:].max() < 0.99
    assert np.abs(elastic.motion[100:, 2:4]).max() > 1e-5


def test_jacobian_is_the_derivative_of_the_force():
    mbs, joint, _, _ = scene(BEARING, housing="body", matrix=rotation([0.4, -0.7, 0.3]))
    element = joint.element
    rng = np.random.default_rng(3)
    q = np.array(mbs.systemData.GetODE2Coordinates())[mbs.systemData.GetObjectLTGODE2(joint.objectNumber)]
    q_t = np.array(mbs.systemData.GetODE2Coordinates_t())[mbs.systemData.GetObjectLTGODE2(joint.objectNumber)]
    n = element.rigid_size
    q[n:] += 2e-7 * rng.normal(size=len(q) - n)
    q_t[n:] += 1e-4 * rng.normal(size=len(q) - n)
    stiffness = -np.array(element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 1.0, 0.0))
    damping = -np.array(element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 0.0, 1.0))

    def force(a, b):
        return np.array(element.force(mbs, 0.0, 0, a.tolist(), b.tolist()))

    for exact, which, step in ((stiffness, 0, 1e-10), (damping, 1, 1e-7)):
        numeric = np.empty_like(exact)
        for j in range(len(q)):
            d = np.zeros(len(q))
            d[j] = step
            change = [force(q + s * d, q_t) if which == 0 else force(q, q_t + s * d) for s in (1, -1)]
            numeric[:, j] = (change[0] - change[1]) / (2 * step)
        rows = abs(exact).max(axis=1, keepdims=True)
        # steps of 1e-10 m in a 1e-5 m gap: rounding 1e-16 / 1e-5 of the force, times the span of units in a row
        assert np.all(abs(exact - numeric) < 1e-5 * rows + 1e-12 * abs(exact).max())


def test_force_and_moment_on_journal_and_housing_cancel_on_a_turning_housing():
    mbs, joint, housing, journal = scene(BEARING, housing="body", matrix=rotation([0.4, -0.7, 0.3]), load=0.0)
    records = []

    solids = InertiaCylinder(7800, 0.1, 0.08, 2, 0.05), InertiaCylinder(7800, 0.3, 0.03, 2)
    inertia = [(s.Mass(), np.array(s.InertiaCOM())) for s in solids]

    def momentum():
        total = np.zeros(6)
        for body in (housing, journal):
            m, tensor = inertia[body is journal]
            p = mbs.GetObjectOutputBody(body, exu.OutputVariableType.Position, [0, 0, 0])
            v = mbs.GetObjectOutputBody(body, exu.OutputVariableType.Velocity, [0, 0, 0])
            A = mbs.GetObjectOutputBody(body, exu.OutputVariableType.RotationMatrix, [0, 0, 0]).reshape(3, 3)
            w = mbs.GetObjectOutputBody(body, exu.OutputVariableType.AngularVelocityLocal, [0, 0, 0])
            total[:3] += m * v
            total[3:] += m * np.cross(p, v) + A @ (tensor @ w)
        return total

    def watch(trial):
        force = original_bound(trial)
        a, b = joint.element.sides
        F = trial.evaluation.wrench
        loads = marker_loads(joint.element, F, force)
        records.append(
            (
                np.abs(loads[0] + loads[2]).max() / np.abs(F[:3]).max(),
                np.abs(loads[1] + loads[3] + np.cross(b.frame[:, 3] - a.frame[:, 3], loads[2])).max()
                / np.abs(F[3:]).max(),
            )
        )
        return force

    original_bound = joint.element._generalized_force
    joint.element._generalized_force = watch
    before = momentum()
    run(mbs, 50, 5e-5)
    after = momentum()
    # rounding of the wrench's transformation
    assert np.max(records) < 1e-10
    # momentum of the whole: linear to Newton's tolerance, angular to the integrator's second order (spin 314 rad/s)
    assert np.allclose(after[:3], before[:3], rtol=0, atol=1e-7 * np.abs(before[:3]).max())
    assert np.allclose(after[3:], before[3:], rtol=0, atol=2e-3 * np.abs(before[3:]).max())


@pytest.mark.slow
def test_modes_follow_the_film_at_every_accepted_step():
    mbs, joint, _, _ = scene(BEARING)
    run(mbs, 50)
    q = np.array(mbs.GetNodeOutput(joint.element.bore_nodes[0], exu.OutputVariableType.Coordinates))
    element = joint.element
    load = element.look(mbs, mbs.systemData.GetTime(), exu.ConfigurationType.Current).evaluation.bore.load
    # modes in equilibrium apart from the inertia of their numerical mass
    assert np.allclose(element.stiffness * q, load, rtol=0, atol=1e-3 * np.abs(load).max())
    assert np.abs(q).max() > 1e-7


def free_pair(bush, moving):
    """Journal in a bush on ground or on a body, on coordinates that explicit solvers take."""
    mbs, kind = new_system(), {"nodeType": exu.NodeType.RotationRxyz}
    housing = mbs.CreateRigidBody(inertia=InertiaCylinder(7800, 0.1, 0.08, 2, 0.05), **kind)
    journal = mbs.CreateRigidBody(
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2), initialAngularVelocity=[0, 0, SPEED], **kind
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[housing if moving else mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=dataclasses.replace(BEARING, bush=bush),
    )
    mbs.Assemble()
    return mbs, joint


@pytest.mark.parametrize("moving", [False, True])
def test_explicit_solvers_refuse_modes_without_mass(moving):
    """Their numerical mass would be integrated: half the force, or none, without a word."""
    mbs, joint = free_pair(BEARING.bush, moving)
    solvers = exu.DynamicSolverType
    for kind in (solvers.RK44, solvers.DOPRI5, solvers.ExplicitEuler):
        with pytest.raises(ehd.InputError, match=r"'b'.*ModalBush have no mass.*implicit solver"):
            ehd.SolveDynamic(mbs, settings(1e-6, 2), solverType=kind, storeSolver=False)
        with pytest.raises(exu.ExudynError) as caught:
            mbs.SolveDynamic(settings(1e-6, 2), solverType=kind)
        assert isinstance(caught.value.__cause__, ehd.InputError)
    ehd.SolveDynamic(mbs, settings(1e-6, 2))
    assert len(joint.history.time) == 3


@pytest.mark.filterwarnings("ignore:.* the solver at work is not in mbs.sys")
def test_explicit_solvers_that_are_not_stored_end_after_some_steps():
    """They ask at the start of every step, or but once in it; implicit ones, and looks in between, do not."""
    mbs, joint = free_pair(BEARING.bush, False)
    solvers = exu.DynamicSolverType
    for kind in (solvers.RK44, solvers.DOPRI5, solvers.ExplicitEuler, solvers.VelocityVerlet):
        with pytest.raises(exu.ExudynError) as caught:
            mbs.SolveDynamic(settings(1e-6, 20), solverType=kind, storeSolver=False)
        assert isinstance(caught.value.__cause__, ehd.InputError)
        # velocity Verlet asks behind the step
        assert len(joint.history.time) < 5 + (kind == solvers.VelocityVerlet)
    for _ in range(5):
        mbs.SolveDynamic(settings(1e-6, 5), storeSolver=False)
        mbs.ComputeODE2Eigenvalues(ignoreAlgebraicEquations=True)


@pytest.mark.slow
def test_small_fast_bearings_are_like_large_slow_ones():
    """The modes' numerical mass was that of a period, 6e-6 s: half the force of a rotor of 77 000 rad/s."""

    def forces(length, time):
        mbs, mass = new_system(), length * time
        radius, clearance = 0.02 * length, 2e-5 * length
        mesh = ehd.HollowCylinder(
            inner_radius=radius + clearance, thickness=0.3 * radius, length=radius, axial=1, radial=1, circumferential=8
        )
        steel = ehd.SaintVenantKirchhoff(
            youngs_modulus=2.1e11 / time, poisson_ratio=0.3, density=7800 * time / length**2
        )
        bearing = ehd.JournalBearing(
            journal_radius=radius,
            length=radius,
            radial_clearance=clearance,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=32, n_z=4),
            bush=ehd.ModalBush(mesh=mesh, material=steel, tolerance=0.2),
        )
        journal = mbs.CreateRigidBody(
            inertia=RigidBodyInertia(mass=0.5 * mass, inertiaTensor=2e-3 * mass * length**2 * np.eye(3)),
            initialAngularVelocity=[0, 0, 300.0 / time],
            nodeType=exu.NodeType.RotationRxyz,
        )
        unit = length**2 / time
        mbs.CreateForce(itemNumber=journal, loadVector=[0, -500.0 * unit, 0])
        joint = ehd.CreateLubricatedJoint(mbs, "b", [mbs.CreateGround(), journal], [0, 0, 0], [0, 0, 1], bearing)
        mbs.Assemble()
        ehd.SolveDynamic(mbs, settings(5e-3 * time, 30))
        return joint.history.force / unit

    large = forces(1.0, 1.0)
    np.testing.assert_allclose(forces(2.0**-6, 2.0**-8), large, rtol=0.0, atol=1e-5 * np.abs(large).max())
