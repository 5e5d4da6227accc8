"""Finite-element bodies in absolute coordinates: derivatives of their frame at any turn, its power, turning rings."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from turning import spinning_ring

import exudyn_ehd as ehd
from exudyn_ehd.coupling.items.markers import FittedSide

COUNT = 7


def random_side(rng, strain=0.05):
    """Side on random nodes, some held, and a state that is turned anywhere and strained."""
    X = rng.normal(size=(COUNT, 3))
    weights = rng.uniform(0.5, 1.5, COUNT)
    weights /= weights.sum()
    free = np.flatnonzero(np.repeat(np.arange(COUNT) != 2, 3))
    frame = scenes.rotation(rng.normal(size=3))
    places = free, np.arange(free.size)
    side = FittedSide([], free.size, X, places, weights, X.mean(axis=0) + 0.3 * rng.normal(size=3), frame)
    # the held node is the pivot
    R = scenes.rotation(rng.uniform(0.5, 3.1) * np.array(_unit(rng)))
    x = X[2] + (X - X[2]) @ R.T + strain * rng.normal(size=(COUNT, 3))
    q = (x - X).ravel()[free]
    return side, q, rng.normal(size=q.size), R


def _unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def central(function, q, step=1e-6):
    columns = [(function(q + step * e) - function(q - step * e)) / (2 * step) for e in np.eye(q.size)]
    return np.stack(columns, axis=-1)


def axial(matrices):
    """Axial vectors (3, n) of skew matrices (3, 3, n)."""
    return 0.5 * np.array(
        [matrices[2, 1] - matrices[1, 2], matrices[0, 2] - matrices[2, 0], matrices[1, 0] - matrices[0, 1]]
    )


@pytest.mark.parametrize("seed", range(5))
def test_derivatives_are_those_of_the_frame_at_any_turn(seed):
    rng = np.random.default_rng(seed)
    side, q, q_t, _ = random_side(rng)
    force, moment = rng.normal(size=3), rng.normal(size=3)

    def at(q, what):
        side.update(None, q, q_t, None)
        return what(side).copy()

    place = central(lambda q: at(q, lambda s: s.frame[:, 3]), q)
    turned = central(lambda q: at(q, lambda s: s.frame[:, :3]), q)
    rates = central(lambda q: at(q, lambda s: s.frame[:, 4:]), q)
    push = central(lambda q: at(q, lambda s: s.jac[0].T @ force + s.jac[1].T @ moment), q)
    side.update(None, q, q_t, None)
    A, change = side.frame[:, :3], side.change(None, q)
    geometric = np.tensordot(np.concatenate((force, moment)), change, 1)
    np.testing.assert_allclose(side.jac[0], place, atol=1e-8)
    np.testing.assert_allclose(side.jac[1], axial(np.einsum("ijn,kj->ikn", turned, A)), atol=1e-8)
    np.testing.assert_allclose(side.frame[:, 4:], np.stack([place @ q_t, side.jac[1] @ q_t], axis=1), atol=1e-8)
    np.testing.assert_allclose((q_t @ change).reshape(2, 3, -1), rates.transpose(1, 0, 2), atol=1e-7)
    np.testing.assert_allclose(geometric, push, atol=1e-7)


def test_rigid_motion_is_found_exactly_and_loads_keep_their_power():
    rng = np.random.default_rng(11)
    for _ in range(20):
        side, q, _, R = random_side(rng, strain=0.0)
        start = side.frame.copy()
        omega = rng.normal(size=3)
        side.update(None, q, np.zeros(q.size), None)
        # a spin about the held node
        nodes = side.reference + side._points(q)
        q_t = np.cross(omega, nodes - side.reference[2]).ravel()[side.rows]
        side.update(None, q, q_t, None)
        np.testing.assert_allclose(side.frame[:, :3], R @ start[:, :3], atol=1e-13)
        np.testing.assert_allclose(side.frame[:, 5], omega, atol=1e-12)
        np.testing.assert_allclose(side.frame[:, 4], np.cross(omega, side.frame[:, 3] - side.reference[2]), atol=1e-12)
        force, moment = rng.normal(size=3), rng.normal(size=3)
        push = side.jac[0].T @ force + side.jac[1].T @ moment
        assert push @ q_t == pytest.approx(force @ side.frame[:, 4] + moment @ omega, rel=1e-12)


@pytest.mark.parametrize(
    ("role", "turns"),
    [
        ("journal", 1),
        pytest.param("journal", 10, marks=pytest.mark.slow),
        pytest.param("housing", 10, marks=pytest.mark.slow),
    ],
)
def test_finite_elements_that_turn_feel_one_friction_torque(role, turns, measured):
    """80 steps a turn: without a film Exudyn's integrator keeps the ring's angular momentum to 0.2 % then."""
    speed, steps = 300.0, 80 * turns
    mbs, ring, joint = spinning_ring(speed, role)
    settings = ehd.ConfigureSolver(scenes.settings(turns * 2 * np.pi / speed, steps))
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    first = ring.momentum()[1][2]
    ehd.SolveDynamic(mbs, settings)
    history = joint.history
    sign = 1.0 if role == "journal" else -1.0
    torque, spin = sign * history.moment[:, 2], sign * history.motion[:, 8]
    assert torque.max() < 0.8 * torque.min() < 0.0
    # what the film takes is what the ring loses, and it loses it as a rigid ring does
    lost = (ring.momentum()[1][2] - first) / first
    measured("momentum", abs(lost - np.trapezoid(torque, history.time) / first), 3e-3)
    measured("spin", abs(spin[-1] / spin[0] - 1.0 - lost), 1e-4)
    measured("Newton iterations per step", mbs.sys["dynamicSolver"].it.newtonStepsCount / steps, 3.0)


def add_mesh_marker(mbs, nodes, weights=None):
    container = exu.MatrixContainer()
    size = sum(len(mbs.GetNode(node)["referenceCoordinates"]) for node in nodes)
    container.SetWithDenseMatrix(np.eye(size), useDenseMatrix=True)
    body = mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=nodes, massMatrix=container))
    return mbs.AddMarker(
        eii.MarkerSuperElementRigid(
            bodyNumber=body,
            meshNodeNumbers=list(range(len(nodes))),
            weightingFactors=[1.0 / len(nodes)] * len(nodes) if weights is None else weights,
        )
    )


@pytest.mark.parametrize(
    ("points", "weights", "rigid", "message"),
    [
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [1.0, 1.0, 1.0], False, "add up to 1, got 3"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], None, False, "on one line"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], None, True, "type RigidBodyRxyz"),
    ],
)
def test_markers_that_fix_no_rotation_are_refused(points, weights, rigid, message):
    mbs = scenes.new_system()
    ground = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=mbs.CreateGround()))
    if rigid:
        nodes = [mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[*p, 0, 0, 0])) for p in points]
    else:
        nodes = [mbs.AddNode(eii.NodePoint(referenceCoordinates=p)) for p in points]
    bearing = ehd.JournalBearing(
        journal_radius=0.02, length=0.02, radial_clearance=4e-5, lubricant=ehd.Lubricant(viscosity=0.005)
    )
    with pytest.raises(ehd.InputError, match=rf"itemNumbers\[1\].*{message}"):
        ehd.CreateLubricatedJoint(
            mbs,
            itemNumbers=[ground, add_mesh_marker(mbs, nodes, weights)],
            position=[],
            axis=[0, 0, 1],
            bearing=bearing,
        )
