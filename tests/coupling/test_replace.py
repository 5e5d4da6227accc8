"""Films in the place of joints that a model has: the same frame, numbers that stay, refusals by name."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerKinematicTreeRigid,
    NodeGenericODE2,
    ObjectJointGeneric,
    ObjectJointRevolute2D,
    ObjectJointRevoluteZ,
    ObjectKinematicTree,
    SensorObject,
)
from exudyn.utilities import InertiaCuboid, RotationVector2RotationMatrix

import exudyn_ehd as ehd
from tests.sampling import sample

CLEARANCE, STEPS, TIME = 20e-6, 100, 0.02
BEARING = ehd.JournalBearing(
    journal_radius=0.01,
    length=0.06,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.05),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)
LINK = InertiaCuboid(density=7800.0, sideLengths=[0.3, 0.03, 0.03])


def solve(mbs, **options):
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = STEPS, TIME
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings, **options)


def pendulum(place, turn, make, planar=False):
    """A link turned by ``turn`` (3, 3) that falls about ``place`` (3,), on the joint that ``make`` adds."""
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    # Exudyn's explicit solvers take no Euler parameters
    kind = {"create2D": True} if planar else {"nodeType": exu.NodeType.RotationRxyz}
    link = mbs.CreateRigidBody(
        inertia=LINK,
        referencePosition=list(place + turn @ [0.1, 0.0, 0.0]),
        referenceRotationMatrix=turn,
        gravity=[0.0, -9.81, 0.0],
        **kind,
    )
    joint = make(mbs, [ground, link], place, turn)
    return mbs, joint, link


def end(mbs, link):
    return np.array(mbs.GetObjectOutputBody(link, exu.OutputVariableType.Position, [-0.1, 0.0, 0.0]))


def revolute(mbs, items, place, turn):
    return mbs.CreateRevoluteJoint("pivot", items, list(place), list(turn[:, 2]))


def generic(free):
    def make(mbs, items, place, turn):
        axes = [1, 1, 1, *(int(k != free) for k in range(3))]
        # the free axis is the link's z
        frame = np.roll(turn, free - 2, axis=1)
        return mbs.CreateGenericJoint("pivot", items, list(place), rotationMatrixAxes=frame, constrainedAxes=axes)

    return make


def revolute_2d(mbs, items, place, turn):
    points = ([*place], [-0.1, 0.0, 0.0])
    markers = [
        mbs.AddMarker(MarkerBodyPosition(bodyNumber=b, localPosition=p)) for b, p in zip(items, points, strict=True)
    ]
    return mbs.AddObject(ObjectJointRevolute2D(name="pivot", markerNumbers=markers))


@pytest.mark.parametrize(
    "make", [revolute, generic(0), generic(1), generic(2), revolute_2d], ids=["Z", "x", "y", "z", "2D"]
)
@pytest.mark.parametrize("journal", sample([0, 1], 1))
def test_film_takes_the_joints_place(make, journal):
    rng = np.random.default_rng(5)
    place, planar = rng.uniform(-1.0, 1.0, 3), make is revolute_2d
    turn = RotationVector2RotationMatrix([0.0, 0.0, 0.7] if planar else rng.uniform(-1.5, 1.5, 3))
    place[2] *= not planar
    mbs, number, link = pendulum(place, turn, make, planar)
    joint = ehd.ReplaceJoint(mbs, number, bearing=BEARING, journal=journal)
    data = mbs.GetObject(number)
    assert not data["activeConnector"] and not data["Vshow"] and data["name"] == "pivot"
    assert joint.name == "film of pivot"
    # no planar joint holds along its axis, all others did
    assert (joint.constraintNumber is None) == planar
    solve(mbs)
    assert np.linalg.norm(end(mbs, link) - place) < CLEARANCE
    # the link falls about the joint's axis alone, as on an ideal joint
    turned = np.array(mbs.GetObjectOutputBody(link, exu.OutputVariableType.RotationMatrix, [0, 0, 0])).reshape(3, 3)
    assert turned[:, 2] @ turn[:, 2] > 1.0 - (2.0 * CLEARANCE / BEARING.length) ** 2
    ideal, _, other = pendulum(place, turn, make, planar)
    solve(ideal)
    away = np.array(ideal.GetObjectOutputBody(other, exu.OutputVariableType.Position, [0.15, 0.0, 0.0]))
    here = np.array(mbs.GetObjectOutputBody(link, exu.OutputVariableType.Position, [0.15, 0.0, 0.0]))
    start = place + turn @ [0.25, 0.0, 0.0]
    assert np.linalg.norm(away - start) > 20.0 * CLEARANCE
    assert np.linalg.norm(here - away) < 4.0 * CLEARANCE + 0.05 * np.linalg.norm(away - start)


def chain(count):
    """Links on each other, every joint a revolute one."""
    mbs = exu.SystemContainer().AddSystem()
    items, joints = [mbs.CreateGround()], []
    for k in range(count):
        items.append(
            mbs.CreateRigidBody(inertia=LINK, referencePosition=[0.1 + 0.2 * k, 0, 0], gravity=[0.0, -9.81, 0.0])
        )
        joints.append(mbs.CreateRevoluteJoint(f"pivot {k}", items[-2:], [0.2 * k, 0, 0], [0, 0, 1]))
    return mbs, joints


def test_all_joints_of_a_model_at_once():
    mbs, joints = chain(3)
    mbs.SetObjectParameter(joints[1], "activeConnector", False)
    films = ehd.ReplaceJoints(mbs, bearing=BEARING)
    assert sorted(films) == [int(joints[0]), int(joints[2])]
    mbs, joints = chain(3)
    films = ehd.ReplaceJoints(mbs, bearing=lambda k: BEARING if k == int(joints[1]) else None)
    assert list(films) == [int(joints[1])]
    solve(mbs)
    assert films[int(joints[1])].history.time.size == STEPS + 1
    with pytest.raises(ehd.InputError, match=r"ReplaceJoints.types must be some of JointRevoluteZ"):
        ehd.ReplaceJoints(mbs, bearing=BEARING, types=("Ground",))


def test_a_model_in_which_nothing_is_replaced_says_so():
    """No joint at all, all of them replaced already, no bearing."""
    mbs, _ = chain(0)
    with pytest.raises(ehd.InputError, match=r"no active joint of type JointRevoluteZ, .* with one rotation free"):
        ehd.ReplaceJoints(mbs, bearing=BEARING)
    mbs, _ = chain(2)
    with pytest.raises(ehd.InputError, match=r"ReplaceJoints.bearing must be JournalBearing"):
        ehd.ReplaceJoints(mbs, bearing=None)
    assert len(ehd.ReplaceJoints(mbs, bearing=BEARING)) == 2
    with pytest.raises(ehd.InputError, match=r"no active joint"):
        ehd.ReplaceJoints(mbs, bearing=BEARING)
    mbs, _ = chain(1)
    assert ehd.ReplaceJoints(mbs, bearing=lambda k: None) == {}


def constrained(*axes):
    return lambda mbs, items, place, turn: mbs.CreateGenericJoint("pivot", items, list(place), constrainedAxes=[*axes])


def moved(mbs, items, place, turn):
    return mbs.CreateGenericJoint(
        "pivot",
        items,
        list(place),
        constrainedAxes=[1, 1, 1, 1, 1, 0],
        offsetUserFunction=lambda mbs, t, item, parameters: [0.0] * 6,
    )


def read(mbs, items, place, turn):
    joint = revolute(mbs, items, place, turn)
    mbs.AddSensor(SensorObject(name="load", objectNumber=joint, outputVariableType=exu.OutputVariableType.ForceLocal))
    return joint


def inactive(mbs, items, place, turn):
    joint = revolute(mbs, items, place, turn)
    mbs.SetObjectParameter(joint, "activeConnector", False)
    return joint


def turned(angle, generic):
    """A joint whose marker on the link is turned about its x by ``angle``, half a turn for antiparallel axes."""

    def make(mbs, items, place, turn):
        frames = np.eye(4), np.eye(4)
        frames[0][:3, :3], frames[0][:3, 3] = turn, place
        frames[1][:3, :3], frames[1][:3, 3] = RotationVector2RotationMatrix([angle, 0.0, 0.0]), [-0.1, 0.0, 0.0]
        markers = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=b, localHT=f)) for b, f in zip(items, frames, strict=True)]
        if generic:
            return mbs.AddObject(
                ObjectJointGeneric(name="pivot", markerNumbers=markers, constrainedAxes=[1, 1, 1, 1, 1, 0])
            )
        return mbs.AddObject(ObjectJointRevoluteZ(name="pivot", markerNumbers=markers))

    return make


@pytest.mark.parametrize("journal", sample([0, 1], 1))
@pytest.mark.parametrize("generic", [False, True])
def test_antiparallel_axes_are_those_of_one_joint(journal, generic):
    """The film takes the housing's axis, so that the journal's sense changes nothing; 1e-6 of the clearance is rounding
    of positions near 1 m, which the run enlarges."""
    rng = np.random.default_rng(11 + journal)
    place, turn = rng.uniform(-1.0, 1.0, 3), RotationVector2RotationMatrix(rng.uniform(-1.5, 1.5, 3))
    ends = []
    for angle in (0.0, np.pi):
        mbs, number, link = pendulum(place, turn, turned(angle, generic))
        joint = ehd.ReplaceJoint(mbs, number, bearing=BEARING, journal=journal)
        solve(mbs)
        ends.append((end(mbs, link), joint.history.friction_torque[-1]))
    sense = 1.0 if journal else -1.0  # of the joint's axis where the link is the housing
    assert np.abs(ends[1][0] - ends[0][0]).max() < 1e-6 * CLEARANCE
    assert ends[1][1] == pytest.approx(sense * ends[0][1], rel=1e-6)
    mbs, number, _ = pendulum(place, turn, turned(0.01, generic))
    with pytest.raises(ehd.InputError, match=r"pivot.*must be parallel .*; turn one of the markers"):
        ehd.ReplaceJoint(mbs, number, bearing=BEARING, journal=journal)


def elbow():
    """A link on the link of a kinematic tree, the tree's marker first."""
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(
        NodeGenericODE2(
            referenceCoordinates=[0.0],
            initialCoordinates=[0.0],
            initialCoordinates_t=[0.0],
            numberOfODE2Coordinates=1,
        )
    )
    tree = mbs.AddObject(
        ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[exu.JointType.RevoluteZ],
            linkParents=[-1],
            jointTransformations=exu.Matrix3DList([np.eye(3)]),
            jointOffsets=exu.Vector3DList([[0, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([LINK.InertiaCOM()]),
            linkCOMs=exu.Vector3DList([[0.1, 0, 0]]),
            linkMasses=[LINK.mass],
        )
    )
    body = mbs.CreateRigidBody(inertia=LINK, referencePosition=[0.3, 0, 0])
    markers = [
        mbs.AddMarker(MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=0, localPosition=[0.2, 0, 0])),
        mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[-0.1, 0, 0])),
    ]
    return mbs, mbs.AddObject(ObjectJointRevoluteZ(name="elbow", markerNumbers=markers))


@pytest.mark.parametrize("tilt", [ehd.Free(), ehd.Held()])
def test_trees_as_housings_are_refused_with_a_remedy_that_works(tilt):
    held = "tilt" if tilt == ehd.Held() else "axial"
    mbs, number = elbow()
    with pytest.raises(ehd.InputError, match=rf"'elbow' \(JointRevoluteZ\).* {held}=Held\(\) .*journal=0") as error:
        ehd.ReplaceJoints(mbs, bearing=BEARING, tilt=tilt)
    assert "link of a kinematic tree" in str(error.value)
    for remedy in ({"journal": 0}, {"axial": ehd.Free(), "tilt": ehd.Free()}):
        mbs, number = elbow()
        assert ehd.ReplaceJoint(mbs, number, bearing=BEARING, **({"tilt": tilt} | remedy)).name == "film of elbow"


def test_errors_of_the_new_joint_name_the_old_one():
    """Here a journal that is not in its bore; joints of one name get films of their own."""
    mbs, joints = chain(2)
    for joint in joints:
        mbs.SetObjectParameter(joint, "name", "hinge")
    films = ehd.ReplaceJoints(mbs, bearing=BEARING)
    assert [film.name for film in films.values()] == ["film of hinge", f"film of hinge (object {int(joints[1])})"]
    mbs, joints = chain(1)
    mbs.SetNodeParameter(exu.NodeIndex(0), "initialCoordinates", [1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(ehd.InputError, match=rf"object {int(joints[0])} 'pivot 0' .*outside the bore.*; check"):
        ehd.ReplaceJoints(mbs, bearing=BEARING)
    mbs, joints = chain(1)
    with pytest.raises(
        ehd.InputError, match=rf"object {int(joints[0])} 'pivot 0' .*CreateLubricatedJoint\.bearing must be Jou"
    ):
        ehd.ReplaceJoints(mbs, bearing=lambda number: ehd.FiniteLength())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (constrained(1, 1, 1, 1, 0, 0), "exactly one must be free"),
        (constrained(1, 1, 1, 1, 1, 1), "exactly one must be free"),
        (constrained(0, 1, 1, 1, 1, 0), r"free across the axis.*; leave this joint as it is"),
        (moved, r"has an offset function.*; leave this joint as it is"),
        (read, "is read by sensor 0 'load'"),
        (inactive, r"is inactive.*; set its activeConnector to True"),
        (
            lambda mbs, items, place, turn: items[1],
            r"\(RigidBody\) is none of the joints.*; put a film between two bodies",
        ),
    ],
)
def test_what_a_film_can_not_replace_is_refused(make, message):
    mbs, number, _ = pendulum(np.zeros(3), np.eye(3), make)
    with pytest.raises(ehd.InputError, match=message):
        ehd.ReplaceJoint(mbs, number, bearing=BEARING)


def test_a_joint_that_slides_keeps_sliding():
    mbs, number, _ = pendulum(np.zeros(3), np.eye(3), constrained(1, 1, 0, 1, 1, 0))
    assert ehd.ReplaceJoint(mbs, number, bearing=BEARING).constraintNumber is None


def test_calls_that_can_not_be_meant():
    mbs, number, _ = pendulum(np.zeros(3), np.eye(3), revolute)
    with pytest.raises(ehd.InputError, match=r"journal must be 0 or 1"):
        ehd.ReplaceJoint(mbs, number, bearing=BEARING, journal=2)
    with pytest.raises(ehd.InputError, match=r"objectNumber .*; give exu\.ObjectIndex\(2\)"):
        ehd.ReplaceJoint(mbs, 2, bearing=BEARING)
    with pytest.raises(ehd.InputError, match=r"objectNumber .*; give exu\.ObjectIndex\(\.\.\.\)"):
        ehd.ReplaceJoint(mbs, "hinge", bearing=BEARING)
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match="assembled already"):
        ehd.ReplaceJoint(mbs, number, bearing=BEARING)


def test_explicit_solvers_name_the_joint():
    mbs, number, _ = pendulum(np.zeros(3), np.eye(3), revolute)
    ehd.ReplaceJoint(mbs, number, bearing=BEARING, axial=ehd.Free())
    with pytest.raises(ehd.InputError, match=rf"inactive ones like object {int(number)} 'pivot'"):
        solve(mbs, solverType=exu.DynamicSolverType.RK44)
