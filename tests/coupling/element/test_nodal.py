"""The nodal bush under a film in Exudyn: forces cancel, exact Jacobian, agreement with the modal bush."""

from __future__ import annotations

import dataclasses

import exudyn.itemInterface as eii
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder
from scenes import NODE_TYPES, marker_loads, new_system, rotation, settings

import exudyn_ehd as ehd

SPEED = 3000 * 2 * np.pi / 60
C = 30e-6
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
BEARING = ehd.JournalBearing(
    journal_radius=0.03,
    length=0.066,
    radial_clearance=C,
    lubricant=ehd.Lubricant(viscosity=9e-3),
    film=ehd.FiniteLength(n_theta=48, n_z=8),
    bush=ehd.ANCFBush(mesh=CYLINDER, material=STEEL),
)


def scene(housing, bearing=BEARING, load=15e3):
    mbs = new_system()
    A, spin = np.eye(3), np.array([0.0, 0.0, SPEED])
    if housing == "ground":
        item = mbs.CreateGround()
    else:
        A = rotation([0.4, -0.7, 0.3])
        inertia = InertiaCylinder(7800, 0.1, 0.08, 2, 0.05)
        turn = A @ [3.0, -2.0, 5.0]
        item = mbs.CreateRigidBody(referenceRotationMatrix=A, inertia=inertia, initialAngularVelocity=list(turn))
        spin = A @ spin + turn
    journal = mbs.CreateRigidBody(
        referenceRotationMatrix=A,
        initialDisplacement=list(A @ [0.4 * C, -0.5 * C, 0.0]),
        initialAngularVelocity=list(spin),
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
    )
    if load:
        mbs.CreateForce(itemNumber=journal, localPosition=[0, 0, 3e-3], loadVector=[0, -load, 0])
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[item, journal],
        position=[0, 0, 0],
        axis=list(A[:, 2]),
        bearing=bearing,
        axial=ehd.Held() if housing == "ground" else ehd.Free(),
    )
    mbs.Assemble()
    return mbs, joint


def state(mbs, joint, seed=0):
    places = mbs.systemData.GetObjectLTGODE2(joint.objectNumber)
    q, q_t = (np.array(f())[places] for f in (mbs.systemData.GetODE2Coordinates, mbs.systemData.GetODE2Coordinates_t))
    rng, n = np.random.default_rng(seed), joint.element.rigid_size
    q[n:] += 1e-7 * rng.normal(size=len(q) - n)
    q_t[n:] += 1e-4 * rng.normal(size=len(q) - n)
    return q, q_t


@pytest.mark.parametrize("housing", ["ground", "body"])
def test_force_and_moment_on_journal_and_bush_cancel(housing):
    mbs, joint = scene(housing)
    element = joint.element
    q, q_t = state(mbs, joint)
    force = np.array(element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist()))
    a, b = element.sides
    nodal = force[element.rigid_size :].reshape(-1, 3)
    _, _, on_journal, moment = marker_loads(element, element.last.evaluation.wrench, force)
    arm = b.frame[:, 3] - a.frame[:, 3]
    # rounding of sums over a hundred nodes
    assert np.abs(nodal.sum(axis=0) + on_journal).max() < 1e-12 * np.abs(on_journal).max()
    total = np.cross(element.arms, nodal).sum(axis=0) + moment + np.cross(arm, on_journal)
    assert np.abs(total).max() < 1e-10 * np.abs(moment).max()
    assert np.all(force[: a.size] == 0.0)


@pytest.mark.parametrize("housing", ["ground", "body"])
def test_jacobian_is_the_derivative_of_the_force(housing):
    mbs, joint = scene(housing)
    element = joint.element
    q, q_t = state(mbs, joint)
    exact = [-np.array(element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), *f)) for f in ((1.0, 0.0), (0.0, 1.0))]
    rng = np.random.default_rng(1)
    n = element.rigid_size
    for which, step in ((0, 1e-10), (1, 1e-7)):
        for j in [*range(n), *rng.integers(n, len(q), 12)]:
            d = np.zeros(len(q))
            d[j] = step
            up, down = (
                np.array(
                    element.force(mbs, 0.0, 0, (q + s * d * (which == 0)).tolist(), (q_t + s * d * which).tolist())
                )
                for s in (1, -1)
            )
            numeric = (up - down) / (2 * step)
            # lever arms change by displacement / radius = 1e-5, which the Jacobian leaves out
            assert np.abs(numeric - exact[which][:, j]).max() < 3e-5 * np.abs(exact[which]).max()


@pytest.mark.parametrize("housing", ["ground", "body"])
def test_operator_is_the_jacobian(housing):
    mbs, joint = scene(housing)
    element = joint.element
    q, q_t = state(mbs, joint)
    exact = np.array(element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), 2.0, 0.01))
    operator = element.operator(mbs, 0.0, q, q_t, 2.0, 0.01)
    rng, n, n_h = np.random.default_rng(1), element.rigid_size, element.sides[0].size
    for part in (slice(0, n_h), slice(n_h, n), slice(n, None)):
        change = np.zeros(len(q))
        change[part] = rng.normal(size=change[part].size)
        got, expected = operator(change), exact @ change
        for rows in (slice(0, n), slice(n, None)):
            # rounding of one film solve against another
            assert abs(got[rows] - expected[rows]).max() <= 1e-10 * abs(expected[rows]).max(initial=0.0)
    moved = q.copy()
    moved[n] += 1e-8
    element.force(mbs, 0.0, 0, moved.tolist(), q_t.tolist())
    with pytest.raises(RuntimeError, match="another state"):
        operator(change)


@pytest.mark.slow
def test_nodal_and_modal_bush_agree_in_a_run():
    histories = []
    mesh = dataclasses.replace(CYLINDER, axial=4, circumferential=24)
    film = ehd.FiniteLength(n_theta=80, n_z=12)
    for bush in (ehd.ANCFBush(mesh=mesh, material=STEEL), ehd.ModalBush(mesh=mesh, material=STEEL)):
        mbs, joint = scene("ground", dataclasses.replace(BEARING, bush=bush, film=film))
        run = ehd.SolveDynamicSparse(mbs, settings(20e-4, 20, tolerance=1e-6))
        histories.append(joint.history)
        assert run.rejected == 0
        if isinstance(bush, ehd.ANCFBush):
            # the iterations of full Newton on a rigid bore (4), with a factor every other step
            assert run.iterations <= 6 * run.steps and run.jacobians <= run.steps
            assert run.products <= 12 * run.iterations
        else:
            assert run.products == 0
    nodal, modal = histories
    # what the modes' default tolerance promises
    assert np.allclose(nodal.minimum_gap, modal.minimum_gap, rtol=0.01)
    assert np.allclose(nodal.peak_pressure, modal.peak_pressure, rtol=0.01)


def under_rotating_load(bush, place, load=25e3, steps=50):
    """Half a turn of a load that rotates with the journal, on six coordinates."""
    film = ehd.FiniteLength(n_theta=144, n_z=16)
    mbs = new_system()
    journal = mbs.CreateRigidBody(
        initialDisplacement=[*place, 0.0],
        initialAngularVelocity=[0, 0, SPEED],
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=dataclasses.replace(BEARING, bush=bush, film=film),
        axial=ehd.Held(),
    )
    mbs.CreateForce(
        itemNumber=journal,
        loadVector=[0, -load, 0],
        loadVectorUserFunction=lambda mbs, t, v: [load * np.sin(SPEED * t), -load * np.cos(SPEED * t), 0],
    )
    mbs.Assemble()
    solve = ehd.SolveDynamicSparse if isinstance(bush, ehd.ANCFBush) else ehd.SolveDynamic
    solve(mbs, settings(np.pi / SPEED, steps, tolerance=1e-8))
    assert len(joint.history.time) == steps + 1
    return joint.history


@pytest.mark.slow
def test_modal_bush_under_a_rotating_load(measured):
    """Within 1 % of the nodes with the modes of the default tolerance, within 0.1 % with many; on a film that is fine
    for them."""
    mesh = dataclasses.replace(CYLINDER, axial=4, radial=2, circumferential=40)
    start = ehd.equilibrium(dataclasses.replace(BEARING, bush=None), speed=SPEED, load=(0.0, -25e3)).position
    rigid, nodal = under_rotating_load(None, start), under_rotating_load(ehd.ANCFBush(mesh=mesh, material=STEEL), start)
    assert nodal.peak_pressure.max() < 0.93 * rigid.peak_pressure.max()
    for tolerance, limit in ((0.07, 0.01), (0.005, 0.001)):
        bush = ehd.ModalBush(mesh=mesh, material=STEEL, tolerance=tolerance, tilted=False)
        modal = under_rotating_load(bush, start)
        # the nodes' inertia responds to the start for some steps
        peak = modal.peak_pressure[5:].max() / nodal.peak_pressure[5:].max()
        measured(f"peak pressure, tolerance {tolerance}", abs(peak - 1.0), limit)
        gap = modal.minimum_gap.min() / nodal.minimum_gap.min()
        measured(f"minimum film thickness, tolerance {tolerance}", abs(gap - 1.0), limit)


@pytest.mark.slow
def test_own_solver_follows_exudyns_full_newton_on_a_moving_housing():
    motions, steps = [], 8
    for own in (False, True):
        mbs, joint = scene("body", load=0.0)
        options = settings(steps * 5e-5, steps, tolerance=1e-8)
        if own:
            run = ehd.SolveDynamicSparse(mbs, options)
        else:
            mbs.SolveDynamic(options)
            full = mbs.sys["dynamicSolver"].it.newtonStepsCount
        motions.append(joint.history.motion[:, :4])
    # both to a relative residual of 1e-8; the iterations of full Newton, and up to one more per step
    assert abs(motions[1] - motions[0]).max() < 1e-6 * C
    assert run.iterations <= full + steps


RUBBER = dataclasses.replace(CYLINDER, inner_radius=0.03 + C, thickness=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "modulus", "load"),
    [
        (ehd.NeoHooke, 1e7, 600.0),
        pytest.param(ehd.SaintVenantKirchhoff, 1e7, 600.0, marks=pytest.mark.slow),
        pytest.param(ehd.NeoHooke, 1e7, 60.0, marks=pytest.mark.slow),
        pytest.param(ehd.SaintVenantKirchhoff, 1e8, 3e3, marks=pytest.mark.slow),
        pytest.param(ehd.NeoHooke, 3e9, 1e4, marks=pytest.mark.slow),
    ],
)
def test_steady_films_on_soft_bushes_are_those_of_a_static_solve(law, modulus, load):
    """The mesh in Exudyn's own static solver, from a start at another position."""
    bush = ehd.ANCFBush(mesh=RUBBER, material=law(youngs_modulus=modulus, poisson_ratio=0.3, density=1200.0))
    bearing = dataclasses.replace(BEARING, bush=bush)
    eq = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -load))
    mbs = new_system()
    journal = mbs.CreateRigidBody(
        initialDisplacement=[*(0.8 * eq.position), 0.0],
        initialAngularVelocity=[0.0, 0.0, SPEED],
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
        nodeType=NODE_TYPES["Rxyz"],
    )
    ground = mbs.CreateGround()
    joint = ehd.CreateLubricatedJoint(mbs, "b", [ground, journal], [0, 0, 0], [0, 0, 1], bearing)
    mbs.CreateForce(itemNumber=journal, loadVector=[0.0, -load, 0.0])
    zero = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    node = mbs.GetObject(journal)["nodeNumber"]
    for c in range(2, 6):
        marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=c))
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[zero, marker]))
    mbs.Assemble()
    mbs.SolveStatic(settings(1.0, 1))
    h, film = joint.history, eq.film
    assert np.abs(h.eccentricity[-1] - eq.position).max() < 1e-6 * C
    assert h.minimum_gap[-1] == pytest.approx(film.minimum_gap, rel=1e-6)
    assert h.peak_pressure[-1] == pytest.approx(film.peak_pressure, rel=1e-6)
    assert np.allclose(h.force[-1, :2], film.force[:2], rtol=0, atol=1e-6 * load)
    assert h.bore_displacement[-1] == pytest.approx(np.abs(film.bore_displacement).max(), rel=1e-6)
