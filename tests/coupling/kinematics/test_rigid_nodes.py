"""Kinematics of the two frames: against Exudyn's markers, invariance, balance of loads."""

import copy
import itertools

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
import toy

from exudyn_ehd.coupling.kinematics import relative, rigid_nodes
from exudyn_ehd.coupling.kinematics.relative import motion_of
from exudyn_ehd.coupling.kinematics.sides import derivatives_between, motion_between

ALL = [pair for pair in itertools.product(("ground", "EP", "Rxyz", "RotVec"), repeat=2) if pair != ("ground",) * 2]


@pytest.mark.parametrize("node", ["EP", "Rxyz", "RotVec", "2D"])
def test_frame_and_jacobians_are_exudyns(node):
    rng = np.random.default_rng(5)
    mbs = scenes.new_system()
    planar = node == "2D"
    matrix = scenes.rotation([0, 0, 0.7] if planar else [0.4, -0.8, 1.1])
    body = scenes.add_body(mbs, node, [0.1, 0.2, 0.0 if planar else 0.3], matrix)
    rho, local = rng.normal(size=3), scenes.rotation([0.3, 0.2, 0.5])
    transform = np.eye(4)
    transform[:3, :3], transform[:3, 3] = local, rho
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localHT=transform))
    data = mbs.GetNode(mbs.GetObject(body)["nodeNumber"])
    mbs.Assemble()
    reference = np.array(data["referenceCoordinates"])
    q = 0.3 * rng.normal(size=reference.size)
    if node == "EP":
        q[3:] = 0.0  # on the unit sphere
    q_t = rng.normal(size=q.size)
    if node == "EP":
        q_t[3:] -= reference[3:] * (reference[3:] @ q_t[3:])
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    kind = {"EP": rigid_nodes.EULER_PARAMETERS, "Rxyz": rigid_nodes.TAIT_BRYAN}.get(
        node, rigid_nodes.PLANAR if planar else rigid_nodes.ROTATION_VECTOR
    )
    frame, jac = np.zeros((3, 6)), np.zeros((4, 3, q.size))
    rigid_nodes.node_frame(kind, q, q_t, reference, rho, local, frame, jac)
    output, item = exu.OutputVariableType, exu.ComputeItemType
    # 1e-14: a handful of operations on numbers of order one
    for got, name in ((frame[:, 3], "Position"), (frame[:, 4], "Velocity"), (frame[:, 5], "AngularVelocity")):
        np.testing.assert_allclose(got, mbs.GetMarkerOutput(marker, getattr(output, name)), rtol=0, atol=1e-14)
    expected = mbs.GetMarkerOutput(marker, output.RotationMatrix).reshape(3, 3)
    np.testing.assert_allclose(frame[:, :3], expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(jac[0], mbs.ComputeItem(marker, item.PositionJacobian), rtol=0, atol=1e-14)
    np.testing.assert_allclose(jac[1], mbs.ComputeItem(marker, item.RotationJacobian), rtol=0, atol=1e-14)


def random_frame(rng):
    frame = np.empty((3, 6))
    frame[:, :3] = scenes.rotation(rng.normal(size=3))
    frame[:, 3:] = rng.normal(size=(3, 3))
    return frame


def near_pair(rng):
    """Housing and journal frames with axes 1e-3 apart, journal marker far along the axis, both moving fast."""
    housing, journal = random_frame(rng), random_frame(rng)
    journal[:, :3] = housing[:, :3] @ scenes.rotation(1e-3 * rng.normal(size=3)) @ scenes.rotation([0, 0, 1.3])
    journal[:, 3] = housing[:, 3] + housing[:, :3] @ [1e-4, 2e-4, 0.7]
    return housing, journal


def moved(frame, matrix, shift, spin, velocity):
    """Frame after a superposed rigid motion with rotation, translation, angular velocity and velocity."""
    out = frame.copy()
    out[:, :3] = matrix @ frame[:, :3]
    out[:, 3] = matrix @ frame[:, 3] + shift
    out[:, 5] = matrix @ frame[:, 5] + spin
    out[:, 4] = matrix @ frame[:, 4] + velocity + np.cross(spin, out[:, 3] - shift)
    return out


def test_motion_does_not_see_a_superposed_rigid_motion():
    rng = np.random.default_rng(7)
    housing, journal = near_pair(rng)
    before = motion_of(housing, journal)
    matrix, shift, spin, velocity = scenes.rotation(rng.normal(size=3)), *rng.normal(size=(3, 3))
    after = motion_of(moved(housing, matrix, shift, spin, velocity), moved(journal, matrix, shift, spin, velocity))
    # differences of velocities and positions of order one: a few units in their last place
    np.testing.assert_allclose(after, before, rtol=0, atol=2e-14)


def test_both_surfaces_spinning_together_gives_no_relative_spin():
    housing, journal = np.zeros((3, 6)), np.zeros((3, 6))
    housing[:, :3] = journal[:, :3] = scenes.rotation([0.3, 0.2, 0.1])
    housing[:, 5] = journal[:, 5] = 300.0 * housing[:, 2]
    motion = motion_of(housing, journal)
    # the unit vector of the axis is one to rounding only
    assert np.abs(motion).max() < 1e-15
    assert motion[8] == 0.0


def test_motion_does_not_depend_on_the_place_of_the_marker_along_the_axis():
    rng = np.random.default_rng(8)
    housing, journal = near_pair(rng)
    before = motion_of(housing, journal)
    shifted = journal.copy()
    arm = 0.4 * journal[:, 2]
    shifted[:, 3] += arm
    shifted[:, 4] += np.cross(journal[:, 5], arm)
    np.testing.assert_allclose(motion_of(housing, shifted), before, rtol=0, atol=2e-14)


def test_variation_is_the_derivative_of_the_motion():
    """Tilts of a fifth, coordinates that move and turn both frames and change their velocities in any way.

    Central differences with a step of 1e-5: truncation of some 1e-10, round-off of 1e-11.
    """
    rng = np.random.default_rng(17)
    frames, jacobians = [random_frame(rng) for _ in range(2)], rng.normal(size=(2, 4, 3, 7))
    frames[1][:, :3] = frames[0][:, :3] @ scenes.rotation([0.2, -0.25, 0.0]) @ scenes.rotation([0.0, 0.0, 1.3])

    def at(q, q_t):
        out = []
        for frame, (place, turn, velocity, spin), own, rate in zip(frames, jacobians, q, q_t, strict=True):
            new = frame.copy()
            new[:, :3] = scenes.rotation(turn @ own) @ frame[:, :3]
            new[:, 3] += place @ own
            new[:, 4] += velocity @ own + place @ rate
            new[:, 5] += spin @ own + turn @ rate
            out.append(new)
        return motion_of(*out)

    for found, by_rate in zip(relative.variation_of(*frames, *jacobians), (False, True), strict=True):
        for k, column in enumerate(found.T):
            step, rest = np.zeros((2, 7)), np.zeros((2, 7))
            step.flat[k] = 1e-5
            ends = [at(rest, s * step) if by_rate else at(s * step, rest) for s in (1.0, -1.0)]
            np.testing.assert_allclose(column, (ends[0] - ends[1]) / 2e-5, rtol=0, atol=1e-8 * np.abs(found).max())


def test_motion_rates_are_time_derivatives():
    """x_t, y_t, bx_t, by_t against central differences of x, y, bx, by along a screw motion of both frames.

    Step 1e-6 s at rates of order one: truncation 1e-12, rounding 1e-16 / 1e-6 = 1e-10.
    """
    housing, journal = near_pair(np.random.default_rng(9))

    def at(t):
        return motion_of(*(screwed(frame, t) for frame in (housing, journal)))

    def screwed(frame, t):
        out = frame.copy()
        out[:, :3] = scenes.rotation(frame[:, 5] * t) @ frame[:, :3]
        out[:, 3] = frame[:, 3] + t * frame[:, 4]
        return out

    slope = (at(1e-6)[:4] - at(-1e-6)[:4]) / 2e-6
    np.testing.assert_allclose(at(0.0)[4:8], slope, rtol=0, atol=2e-9)


@pytest.mark.parametrize(("housing", "journal"), ALL)
def test_force_and_moment_on_journal_and_housing_cancel(housing, journal):
    """Resultants about the global origin."""
    mbs, joint, q, q_t = scenes.pair(housing, journal, seed=4)
    element = joint.element
    given = element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())
    force_h, moment_h, force_j, moment_j = scenes.marker_loads(element, element.last.evaluation.wrench, given)
    p_h, p_j = (side.frame[:, 3] for side in element.sides)
    scale = np.abs(force_j).max()
    np.testing.assert_array_equal(force_h, -force_j)
    total = moment_h + moment_j + np.cross(p_h, force_h) + np.cross(p_j, force_j)
    # arms of order one: rounding of force times arm
    np.testing.assert_allclose(total, 0.0, rtol=0, atol=1e-15 * 10 * scale)


@pytest.mark.parametrize(("housing", "journal"), ALL)
def test_pair_of_nodes_in_one_call_is_what_its_kernels_are_one_by_one(housing, journal):
    mbs, joint, q, q_t = scenes.pair(housing, journal, seed=5)
    rng, sides = np.random.default_rng(2), joint.element.sides
    motion = motion_between(mbs, sides, q, q_t, None)
    wrench, tangent = rng.normal(size=6), rng.normal(size=(6, 10))
    together = derivatives_between(mbs, sides, (q, q_t), wrench, tangent)
    force = relative.wrench_map(*(s.frame for s in sides), *(s.jac for s in sides)) @ wrench
    n, (a, b) = sides[0].size, (copy.deepcopy(side) for side in sides)
    loads, own, (stiffness, damping) = np.empty((4, 3)), np.empty(q.size), np.zeros((2, q.size, q.size))
    for side, part in ((a, slice(n)), (b, slice(n, None))):
        if side.size:
            side.frame[:] = side.jac[:] = np.nan
        side.update(mbs, q[part], q_t[part], None)
    relative.global_loads(a.frame, b.frame, wrench, loads)
    for side, part, load in ((a, slice(n), loads[:2]), (b, slice(n, None), loads[2:])):
        change = side.change(mbs, q[part])
        side.jac[2:] = (q_t[part] @ change).reshape(2, 3, -1)
        stiffness[part, part] = np.tensordot(load.ravel(), change, 1)
        own[part] = load.ravel() @ side.jac[:2].reshape(6, -1)
    by_q, by_qt = relative.variation_of(a.frame, b.frame, a.jac, b.jac)
    relative.tangent_matrices(a.frame, b.frame, a.jac, b.jac, loads, tangent, by_q, by_qt, stiffness, damping)
    # the same operations; compilers may contract them elsewhere
    np.testing.assert_allclose(motion, relative.motion_of(a.frame, b.frame), rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(force, own, rtol=1e-13, atol=1e-14)
    for got, expected in zip(together, (stiffness, damping, by_q, by_qt), strict=True):
        np.testing.assert_allclose(got, expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("node", ["EP", "Rxyz", "RotVec"])
def test_generalized_force_does_no_work_in_a_common_rigid_motion(node):
    mbs, joint, q, q_t = scenes.pair(node, node, seed=6)
    element = joint.element
    force = element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())
    n = element.sides[0].size
    rng = np.random.default_rng(0)
    shift, turn = rng.normal(size=3), rng.normal(size=3)
    work, scale = 0.0, 0.0
    for side, part, coordinates in zip(element.sides, (force[:n], force[n:]), (q[:n], q[n:]), strict=True):
        variation = np.empty(n)
        origin = coordinates[:3] + side.reference[:3]
        variation[:3] = shift + np.cross(turn, origin)
        variation[3:] = np.linalg.pinv(side.jac[1][:, 3:]) @ turn
        work += part @ variation
        scale += np.abs(part * variation).sum()
    # 1e-12 relative to the sum of magnitudes: the balance of force and moment in generalized coordinates
    assert abs(work) < 1e-12 * scale


def test_whole_model_rotated_and_translated_gives_the_same_wrench():
    """The scene is moved to another place and orientation, also through Exudyn's coordinates."""
    wrenches = []
    matrix, shift = scenes.rotation([0.5, -1.0, 0.7]), np.array([3.0, -2.0, 1.0])
    for a, s in ((np.eye(3), np.zeros(3)), (matrix, shift)):
        mbs = scenes.new_system()
        base = scenes.rotation([0.2, 0.1, -0.3])
        spin, velocity = a @ [0.0, 10.0, 200.0], a @ [1.0, 2.0, 3.0]
        one = scenes.add_body(mbs, "EP", s, a @ base, velocity, a @ [0.0, 10.0, 0.0])
        # journal placed eccentrically in the reference configuration through a marker of its own
        two = scenes.add_body(mbs, "EP", s + a @ [0.0, 0.1, 0.0], a @ base, velocity, spin)
        h = np.eye(4)
        h[:3, 3] = base.T @ [0.3, 0.0, 0.0]
        j = np.eye(4)
        j[:3, 3] = base.T @ [0.3 + 2e-4, -0.1 + 3e-4, 0.0]
        markers = [mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=b, localHT=x)) for b, x in ((one, h), (two, j))]
        joint = toy.attach(mbs, markers, toy.ToyFilm(), axis=a @ [0.0, 0.0, 1.0])
        mbs.Assemble()
        history = joint.history
        assert history.largest_eccentricity_ratio[0] == pytest.approx(np.hypot(0.2, 0.3), rel=1e-9)
        wrenches.append(np.concatenate([history.force[0], history.moment[0]]))
    # positions of order one against a clearance of 1e-3, stiffness on top: 1e-16 / 1e-3 and some
    np.testing.assert_allclose(wrenches[1], wrenches[0], rtol=0, atol=1e-11 * np.abs(wrenches[0]).max())
