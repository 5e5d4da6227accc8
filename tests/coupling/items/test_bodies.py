"""Every kind of body in a joint: exact Jacobian, and motion in time against Exudyn's own connector or an equivalent
body.

The joint carries a linear law here, so that Exudyn's RigidBodySpringDamper is the same model: the two integrate the
same equations.
"""

from __future__ import annotations

import itertools

import bodies
import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
import toy
from bodies import AGAINST_CONNECTOR, JACOBIANS
from exudyn.advancedUtilities import NumericalJacobian
from springs import DAMPING, STIFFNESS, TILTING, Spring, joined

from exudyn_ehd.coupling.items.markers import resolve
from exudyn_ehd.status import InputError
from tests.sampling import sample


def connected(make):
    """System with the body in Exudyn's RigidBodySpringDamper to ground, the same law about z."""
    mbs = scenes.new_system()
    body = make(mbs)
    ground = mbs.CreateGround()
    item = resolve(mbs, "item", body.item)
    point = item.position if body.point is None else body.point
    law = np.array([STIFFNESS, STIFFNESS, 0, TILTING, TILTING, 0])
    rate = np.array([DAMPING, DAMPING, 0, 1e-3 * TILTING, 1e-3 * TILTING, 0])
    mbs.AddObject(
        eii.ObjectConnectorRigidBodySpringDamper(
            markerNumbers=[
                mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=ground, localPosition=list(point))),
                body.marker(),
            ],
            stiffness=np.diag(law),
            damping=np.diag(rate),
            useIntrinsicFormulation=False,
        )
    )
    return mbs, body


def travel(mbs, steps=40, step=5e-4, tolerance=1e-9):
    """All coordinates (steps + 1, n) over the run; a few periods of the body on the joint's spring."""
    mbs.Assemble()
    path = []

    def note(mbs, t):
        path.append(mbs.systemData.GetODE2Coordinates().copy())
        return True

    mbs.SetPostStepUserFunction(note)
    # one Jacobian for many steps is enough for a linear mesh, and numeric ones of it take long
    full = mbs.systemData.ODE2Size() < 100
    mbs.SolveDynamic(scenes.settings(steps * step, steps, tolerance=tolerance, full_newton=full))
    return np.array(path)


def difference(got, expected):
    """Largest difference over the run, over the largest travel."""
    return np.abs(got - expected).max() / np.abs(expected - expected[0]).max()


ROLES = list(itertools.product(AGAINST_CONNECTOR, ["journal", "housing"]))


# finite elements take long: they are the housing by default
@pytest.mark.parametrize(
    ("kind", "role"),
    sample(ROLES, *(k for k, (kind, role) in enumerate(ROLES) if "FE" not in kind or role == "housing")),
)
def test_motion_is_that_of_exudyns_own_connector(kind, role, measured):
    """The connector takes tilt as angles, displacement without tilt times axial play, and damps in its own frame: all
    differences are products of two small motions, here of 1e-6 m and 1e-5 rad, against the motion itself."""
    expected = travel(connected(AGAINST_CONNECTOR[kind])[0])
    mbs, _, _ = joined(AGAINST_CONNECTOR[kind], role)
    got = travel(mbs)
    assert np.abs(expected - expected[0]).max() > 1e-6
    measured(f"{kind} as {role}", difference(got, expected), 2e-5)
    print(mbs.sys["dynamicSolver"].it.newtonStepsCount)


# planar bodies turn about z only
AXES = [(kind, axis) for kind in JACOBIANS for axis in ((0, 0, 1), (1, 0, 0)) if axis[2] or "2D" not in kind]


@pytest.mark.parametrize(("kind", "axis"), AXES)
def test_jacobian_is_the_derivative_of_the_force(kind, axis):
    """A moving journal with the toy's film against central differences through the assembled system.

    Steps of 3e-8 m against 1 mm of clearance: 1e-9 of truncation, 1e-16 / 3e-5 of rounding. The rotation between the
    nodes of a geometrically exact beam turns at the interpolated angular velocity to the square of their relative
    rotation (3e-5 here); modes of an FE body change its averaged rotation to second order.
    """
    make = JACOBIANS[kind]
    mbs = scenes.new_system()
    body = make(mbs)
    item = resolve(mbs, "item", body.item)
    point = item.position if body.point is None else np.array(body.point)
    other = scenes.add_body(mbs, "2D" if body.planar else "Rxyz", point)
    joint = toy.attach(mbs, [other, body.item], toy.ToyFilm(), position=[] if item.is_marker else point, axis=axis)
    mbs.Assemble()
    rng = np.random.default_rng(3)
    n = mbs.systemData.ODE2Size()
    q, q_t = 2e-5 * rng.normal(size=n), rng.normal(size=n)
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    places = mbs.systemData.GetObjectLTGODE2(joint.objectNumber)
    # the differences of Lie group nodes and of Euler parameters that leave the unit sphere are no variations that
    # Newton takes
    if kind.endswith(("EP", "RotVec")):
        places = [i for i in places if i not in _rotations(mbs, body)]

    def lhs():
        return np.array(mbs.ComputeItem(joint.objectNumber, exu.ComputeItemType.ODE2LHS))

    own = list(mbs.systemData.GetObjectLTGODE2(joint.objectNumber))
    columns = [own.index(i) for i in places]
    for item_type, step in ((exu.ComputeItemType.JacobianODE2, 3e-8), (exu.ComputeItemType.JacobianODE2_t, 1e-4)):
        exact = np.array(mbs.ComputeItem(joint.objectNumber, item_type))[:, columns]
        numeric = NumericalJacobian(mbs, lhs, places, velocities=step == 1e-4, epsilon=step)
        np.testing.assert_allclose(exact, numeric, rtol=0, atol=2e-6 * np.abs(numeric).max())


def _rotations(mbs, body):
    """System coordinates of the rotations of the body's rigid nodes."""
    out = []
    for node in body.nodes:
        if mbs.GetNode(node)["nodeType"] in ("RigidBodyEP", "RigidBodyRotVecLG"):
            start = mbs.GetNodeODE2Index(node)
            out += range(start + 3, start + (7 if mbs.GetNode(node)["nodeType"] == "RigidBodyEP" else 6))
    return out


@pytest.mark.parametrize("kind", ["element", "node", "marker"])
def test_spatial_cable_across_the_axis_moves_like_a_planar_one(kind, measured):
    """A cable swings through a wide angle (0.9 rad) in the plane normal to the joint's axis."""
    paths = []
    for dimension in (2, 3):

        def make(mbs, dimension=dimension):
            body = bodies.cable(dimension, kind)(mbs)
            bodies._load(mbs, body.nodes[1], 30.0)
            return body

        mbs, _, _ = joined(make)
        path = travel(mbs, steps=100, step=2e-3).reshape(101, 2, 2, dimension)
        assert dimension == 2 or np.abs(path[..., 2]).max() == 0.0
        paths.append(path[..., :2])
    assert np.abs(paths[0][:, 1, 1, 0]).max() > 0.3
    # the same element in the plane
    measured(kind, difference(paths[1], paths[0]), 1e-9)


def test_spatial_cable_along_the_axis_is_held_like_by_a_cartesian_spring(measured):
    law = [0, STIFFNESS, STIFFNESS], [0, DAMPING, DAMPING]
    paths = []
    for connector in (True, False):

        def make(mbs):
            body = bodies.cable(3)(mbs)
            marker = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=body.nodes[1]))
            mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0.3]))
            return body

        if connector:
            mbs = scenes.new_system()
            body = make(mbs)
            ground = mbs.AddMarker(
                eii.MarkerBodyPosition(bodyNumber=mbs.CreateGround(), localPosition=[bodies.PLACE, 0, 0])
            )
            on_cable = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body.item, localPosition=[bodies.PLACE, 0, 0]))
            mbs.AddObject(
                eii.ObjectConnectorCartesianSpringDamper(
                    markerNumbers=[ground, on_cable], stiffness=law[0], damping=law[1]
                )
            )
        else:
            mbs, _, _ = joined(make, axis=(1, 0, 0), tilting=0.0)
        paths.append(travel(mbs))
    # axial play times tilt, and the lever of the force about the cable's axis: products of motions of 1e-4 m and rad
    measured("along", difference(paths[1], paths[0]), 1e-4)


@pytest.mark.parametrize("role", ["journal", "housing"])
def test_exact_beam_along_its_length_moves_like_exudyns_own_connector(role, measured):
    """One element does not bend under a force that its velocities share linearly between the nodes: the arc that Exudyn
    draws between them and the chord are the same line, and the two models differ by products of small motions only.
    Exudyn's element sums large forces, which forbids a Newton tolerance below 1e-7."""

    def make(mbs):
        body = bodies.exact_beam("Rxyz")(mbs, stiffness=100.0)
        bodies._load(mbs, body.nodes[1], 10.0)
        return body

    got, expected = (travel(mbs, tolerance=1e-7) for mbs in (joined(make, role)[0], connected(make)[0]))
    measured(role, difference(got, expected), 1e-5)


def test_planar_exact_beam_along_its_length_moves_like_a_spatial_one(measured):
    planar = travel(joined(bodies.exact_beam_2d)[0])
    spatial = travel(joined(bodies.exact_beam("Rxyz"))[0])[:, [0, 1, 5, 6, 7, 11]]
    # the same element in the plane
    measured("planar against spatial", difference(planar, spatial), 1e-9)


def test_position_on_a_soft_exact_beam_has_the_velocity_as_its_rate():
    """Velocity against central differences of step 1e-6 s at 1 rad/s; Exudyn's own output for a point between the nodes
    does not agree with them."""
    mbs, _, joint = joined(bodies.exact_beam("Rxyz"))
    side = joint.element.sides[1]
    rng = np.random.default_rng(4)
    q, q_t = 1e-3 * rng.normal(size=12), rng.normal(size=12)
    places = []
    for s in (1e-6, -1e-6):
        side.update(mbs, q + s * q_t, q_t, None)
        places.append(side.frame[:, 3].copy())
    side.update(mbs, q, q_t, None)
    np.testing.assert_allclose((places[0] - places[1]) / 2e-6, side.frame[:, 4], rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["Rxyz", "EP", "RotVec"])
def test_frame_on_an_exact_beam_is_exudyns_but_for_the_arc(kind):
    mbs = scenes.new_system()
    body = bodies.exact_beam(kind)(mbs)
    marker = body.marker()
    side = resolve(mbs, "item", marker).side(np.array(body.point), np.eye(3))
    mbs.Assemble()
    q = np.zeros(side.size)
    half = side.size // 2
    # both nodes turn alike: the element is straight
    turn = np.array([0.3, 0.2, -0.4])
    if kind == "EP":
        angle = np.linalg.norm(turn)
        turn = np.array([np.cos(angle / 2) - 1, *(np.sin(angle / 2) * turn / angle)])
    q[3:half] = q[half + 3 :] = turn
    q_t = 0.3 * np.random.default_rng(1).normal(size=side.size)
    if kind == "EP":
        unit = turn + [1, 0, 0, 0]
        for place in (slice(3, half), slice(half + 3, None)):
            q_t[place] -= unit * (unit @ q_t[place])
    mbs.systemData.SetODE2Coordinates(q.tolist())
    mbs.systemData.SetODE2Coordinates_t(q_t.tolist())
    side.update(mbs, q, q_t, None)
    output = exu.OutputVariableType
    # rounding of a few products
    for got, name in (
        (side.frame[:, 3], "Position"),
        (side.frame[:, 4], "Velocity"),
        (side.frame[:, 5], "AngularVelocity"),
    ):
        np.testing.assert_allclose(got, mbs.GetMarkerOutput(marker, getattr(output, name)), rtol=0, atol=1e-12)
    matrix = mbs.GetMarkerOutput(marker, output.RotationMatrix).reshape(3, 3)
    np.testing.assert_allclose(side.frame[:, :3], matrix, rtol=0, atol=1e-12)


def test_two_links_of_one_tree_close_a_loop(measured):
    """The joint between two links of the same tree, which share the tree's node, against Exudyn's connector."""
    paths = []
    for connector in (True, False):
        mbs = scenes.new_system()
        body = bodies.tree(mbs, parents=(-1, 0, 0))
        tree = mbs.GetMarker(body.item)["objectNumber"]
        # in the reference configuration both points are at 0.4, 0.05, 0
        first = mbs.AddMarker(
            eii.MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=1, localPosition=[0.1, 0.05, 0])
        )
        if connector:
            mbs.AddObject(
                eii.ObjectConnectorRigidBodySpringDamper(
                    markerNumbers=[first, body.item],
                    stiffness=np.diag([STIFFNESS, STIFFNESS, 0, TILTING, TILTING, 0]),
                    damping=np.diag([DAMPING, DAMPING, 0, 1e-3 * TILTING, 1e-3 * TILTING, 0]),
                    useIntrinsicFormulation=False,
                )
            )
        else:
            toy.attach(mbs, [first, body.item], Spring(True))
        paths.append(travel(mbs))
    # the housing moves: products of small motions as above
    measured("loop", difference(paths[1], paths[0]), 2e-5)


def test_what_a_body_cannot_do_is_said_before_anything_runs():
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    body = bodies.cable(3)(mbs)
    for axis, match in (((1, 1, 0), "along or across the cable"), ((0, 0, 1), "must lie on the element")):
        with pytest.raises(InputError, match=match):
            toy.attach(mbs, [ground, body.item], Spring(True), position=[0.9 if axis[0] == 0 else 0.3, 0, 0], axis=axis)
    with pytest.raises(InputError, match="none exists on spatial cables"):
        toy.attach(mbs, [ground, body.item], Spring(True), position=body.point, axis=(1, 0, 0), axial=toy.api.Held())
    beam = bodies.ancf_beam("node")(mbs)
    with pytest.raises(InputError, match="must be that of the node"):
        toy.attach(mbs, [ground, beam.item], Spring(True), position=[0.1, 0, 0])
    tree = mbs.GetMarker(bodies.tree(mbs).item)["objectNumber"]
    with pytest.raises(InputError, match="MarkerKinematicTreeRigid"):
        toy.attach(mbs, [ground, tree], Spring(True), position=[0, 0, 0])
    ring = bodies.nodal_ring(mbs).item
    with pytest.raises(InputError, match="MarkerSuperElementRigid"):
        toy.attach(mbs, [ground, mbs.GetMarker(ring)["bodyNumber"]], Spring(True), position=[0, 0, 0])
    with pytest.raises(InputError, match="same body"):
        toy.attach(mbs, [ring, ring], Spring(True))
    flat = bodies.cable(2)(mbs)
    with pytest.raises(InputError, match="parallel to z"):
        toy.attach(mbs, [ground, flat.item], Spring(True), position=flat.point, axis=(1, 0, 0))


def test_journal_outside_the_bore_on_a_cable():
    mbs = scenes.new_system()
    node = mbs.AddNode(eii.NodePoint2DSlope1(referenceCoordinates=[0, 0, 1, 0], initialCoordinates=[0, 6e-3, 0, 0]))
    with pytest.raises(InputError, match="outside the bore"):
        toy.attach(mbs, [mbs.CreateGround(), node], Spring(True), position=[0, 0, 0])
