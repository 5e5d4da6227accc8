"""Input that can't be meant is refused before anything runs, with a message that names the argument."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
import toy

from exudyn_ehd.coupling import api
from exudyn_ehd.status import InputError


@pytest.fixture
def bodies():
    mbs = scenes.new_system()
    return mbs, scenes.add_body(mbs, "ground"), scenes.add_body(mbs, "EP"), scenes.add_body(mbs, "RotVec")


def attach(mbs, items, **options):
    options.setdefault("position", [0, 0, 0])
    return toy.attach(mbs, items, toy.ToyFilm(), **options)


def test_items(bodies):
    mbs, ground, one, two = bodies
    for items in (None, [one], [one, None], [one, "two"], [one, 3.5], [one, True], [exu.ObjectIndex(99), one]):
        with pytest.raises(InputError, match="itemNumbers"):
            attach(mbs, items)
    with pytest.raises(InputError, match="same body"):
        attach(mbs, [one, one])
    node = mbs.GetObject(two)["nodeNumber"]
    with pytest.raises(InputError, match="same body"):
        attach(mbs, [two, exu.NodeIndex(int(node))])
    with pytest.raises(InputError, match="both items are ground"):
        attach(mbs, [ground, scenes.add_body(mbs, "ground")])


def test_items_without_rotation(bodies):
    mbs, ground, one, _ = bodies
    marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=one))
    with pytest.raises(InputError, match="no orientation"):
        attach(mbs, [ground, marker], position=())


@pytest.mark.parametrize("axis", [[0, 0, 0], [0, np.nan, 1], [0, 1], (), "z"])
def test_axis(bodies, axis):
    mbs, ground, one, _ = bodies
    with pytest.raises(InputError, match="axis"):
        attach(mbs, [ground, one], axis=axis)


@pytest.mark.parametrize("position", [(), [0, 0], [0, 0, np.inf], None])
def test_position(bodies, position):
    mbs, ground, one, _ = bodies
    with pytest.raises(InputError, match="position"):
        attach(mbs, [ground, one], position=position)


def test_position_beside_a_marker(bodies):
    mbs, ground, one, _ = bodies
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=one))
    with pytest.raises(InputError, match="must be \\[\\] if a marker"):
        attach(mbs, [ground, marker])


@pytest.mark.parametrize("matrix", [np.eye(2), 2 * np.eye(3), np.diag([1, 1, -1]), np.full((3, 3), np.nan), "xyz"])
def test_rotation_matrix(bodies, matrix):
    mbs, ground, one, _ = bodies
    with pytest.raises(InputError, match="rotationMatrixAxes"):
        attach(mbs, [ground, one], rotation=matrix, axis=())


def test_axis_against_rotation_matrix(bodies):
    mbs, ground, one, _ = bodies
    with pytest.raises(InputError, match="must agree"):
        attach(mbs, [ground, one], rotation=np.eye(3), axis=[0, 1, 0])
    attach(mbs, [ground, one], rotation=np.eye(3), axis=[0, 0, 2])


def test_planar_body_needs_the_z_axis():
    mbs = scenes.new_system()
    with pytest.raises(InputError, match="parallel to z"):
        attach(mbs, [scenes.add_body(mbs, "ground"), scenes.add_body(mbs, "2D")], axis=[0, 1, 1])


def test_assembled_system(bodies):
    mbs, ground, one, _ = bodies
    mbs.Assemble()
    with pytest.raises(InputError, match="assembled already"):
        api.CreateLubricatedJoint(mbs, itemNumbers=[ground, one], position=[0, 0, 0], axis=[0, 0, 1], bearing=object())


def test_missing_bearing_and_wrong_axial(bodies):
    mbs, ground, one, _ = bodies
    with pytest.raises(InputError, match="bearing"):
        api.CreateLubricatedJoint(mbs, itemNumbers=[ground, one], position=[0, 0, 0], axis=[0, 0, 1])
    with pytest.raises(InputError, match="axial"):
        api.CreateLubricatedJoint(
            mbs, itemNumbers=[ground, one], position=[0, 0, 0], axis=[0, 0, 1], bearing=object(), axial="held"
        )


def test_axes_not_parallel_at_the_start():
    """2 c / L of the toy is 0.0667 rad."""
    for angle, fits in ((0.06, True), (0.07, False)):
        mbs = scenes.new_system()
        body = scenes.add_body(mbs, "Rxyz", initialRotationMatrix=scenes.rotation([angle, 0, 0]))
        items = [scenes.add_body(mbs, "ground"), body]
        if fits:
            attach(mbs, items)
            continue
        with pytest.raises(InputError, match="not parallel within the clearance"):
            attach(mbs, items)


@pytest.mark.parametrize("node", ["EP", "Rxyz", "RotVec", "2D"])
def test_journal_outside_the_bore_at_the_start(node):
    for shift, fits in ((0.9e-3, True), (1.1e-3, False)):
        mbs = scenes.new_system()
        body = scenes.add_body(mbs, node, initialDisplacement=[0, shift, 0])
        items = [scenes.add_body(mbs, "ground"), body]
        if fits:
            attach(mbs, items)
            continue
        with pytest.raises(InputError, match="outside the bore"):
            attach(mbs, items)


def test_not_finite_initial_coordinates():
    mbs = scenes.new_system()
    node = mbs.AddNode(
        eii.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6, initialCoordinates=[np.nan, 0, 0, 0, 0, 0])
    )
    with pytest.raises(InputError, match="not finite"):
        attach(mbs, [scenes.add_body(mbs, "ground"), node])


def test_default_zero_angle():
    """x is the housing's local x projected normal to the axis, its local y if x is parallel."""
    for matrix, axis, expected in (
        (np.eye(3), [0, 0, 5], np.eye(3)),
        (np.eye(3), [1, 0, 0], np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])),
        (scenes.rotation([0, 0, 0.5]), [0, 0, 1], scenes.rotation([0, 0, 0.5])),
    ):
        mbs = scenes.new_system()
        housing = scenes.add_body(mbs, "EP", matrix=matrix)
        joint = attach(mbs, [housing, scenes.add_body(mbs, "EP")], axis=axis)
        frame = joint.element.sides[0].frame[:, :3]
        # products of a few rotation matrices
        np.testing.assert_allclose(frame, expected, rtol=0, atol=1e-15)


def test_local_frame_means_the_same_as_the_global_one():
    turn = scenes.rotation([0.3, 0.2, 0.1])
    frames = []
    for use_global in (True, False):
        mbs = scenes.new_system()
        housing = scenes.add_body(mbs, "EP", [1, 2, 3], turn)
        axis, position = np.array([0.0, 0.6, 0.8]), np.array([0.1, 0.2, 0.3])
        if use_global:
            axis, position = turn @ axis, turn @ position + [1, 2, 3]
        joint = attach(
            mbs, [housing, scenes.add_body(mbs, "Rxyz")], axis=axis, position=position, use_global=use_global
        )
        frames.append([side.frame.copy() for side in joint.element.sides])
    # coordinates of order one
    np.testing.assert_allclose(frames[0], frames[1], rtol=0, atol=1e-14)


def test_nodes_bodies_and_markers_are_the_same_joint():
    wrenches = []
    for kind in ("body", "node", "marker"):
        mbs = scenes.new_system()
        ground = scenes.add_body(mbs, "ground")
        body = scenes.add_body(mbs, "Rxyz", (0.1, 0, 0), velocity=(0, 0.1, 0), spin=(0, 0, 10.0))
        item, position = body, [0.05, 0, 0]
        if kind == "node":
            item = exu.NodeIndex(int(mbs.GetObject(body)["nodeNumber"]))
        elif kind == "marker":
            item = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localHT=exu.HT(translation=[-0.05, 0, 0])))
            position = []
        joint = attach(mbs, [ground, item], position=position)
        mbs.Assemble()
        wrenches.append(joint.history.motion[0])
    # 0.1 - 0.05 in two orders: rounding of velocities of order one
    np.testing.assert_allclose(wrenches[1], wrenches[0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(wrenches[2], wrenches[0], rtol=0, atol=1e-15)
