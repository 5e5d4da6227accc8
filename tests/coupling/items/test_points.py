"""Mass points in joints: bodies that move without turning, against rigid bodies whose rotations are held."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.utilities import InertiaCuboid

import exudyn_ehd as ehd

CRANK, ROD, MASS, SPEED, STEPS = 0.05, 0.15, 0.5, 60.0, 25
BEARING = ehd.JournalBearing(
    journal_radius=0.01,
    length=0.012,
    radial_clearance=20e-6,
    lubricant=ehd.Lubricant(viscosity=0.05),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)


def body(mbs, inertia, place, angle=0.0, velocity=(0.0, 0.0), spin=0.0, *, planar):
    kind = {"create2D": True} if planar else {"nodeType": exu.NodeType.RotationRxyz}
    return mbs.CreateRigidBody(
        inertia=inertia,
        referencePosition=[*place, 0.0],
        referenceRotationMatrix=scenes.rotation([0.0, 0.0, angle]),
        initialVelocity=[*velocity, 0.0],
        initialAngularVelocity=[0.0, 0.0, spin],
        **kind,
    )


def guided(mbs, place, velocity, *, point, planar):
    """A slider along x; as a rigid body it is as heavy and can't turn."""
    if point:
        slider = mbs.CreateMassPoint(
            referencePosition=[*place, 0.0], initialVelocity=[*velocity, 0.0], mass=MASS, create2D=planar
        )
    else:
        slider = body(mbs, InertiaCuboid(MASS / 1e-3, [0.1, 0.1, 0.1]), place, velocity=velocity, planar=planar)
    node = mbs.GetObject(slider)["nodeNumber"]
    ground = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    for coordinate in range(1, len(mbs.GetNode(node)["referenceCoordinates"])):
        marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[ground, marker]))
    return slider


def run(is_journal, **slider):
    """Run crank, rod and slider on three films from the crank's spin; return their places and the slider's history."""
    mbs, planar = scenes.new_system(), slider["planar"]
    pin, slope = np.array([0.0, CRANK]), -np.arcsin(CRANK / ROD)
    end = np.array([ROD * np.cos(slope), 0.0])
    # the rod only moves along x where the crank stands upright
    velocity = np.array([-CRANK * SPEED, 0.0])
    bars = [InertiaCuboid(7800.0, [length, 0.02, 0.02]) for length in (CRANK, ROD)]
    crank = body(mbs, bars[0], 0.5 * pin, 0.5 * np.pi, 0.5 * velocity, SPEED, planar=planar)
    rod = body(mbs, bars[1], 0.5 * (pin + end), slope, velocity, planar=planar)
    block = guided(mbs, end, velocity, **slider)
    axis = [0, 0, 1]
    items = [rod, block] if is_journal else [block, rod]
    wrist = ehd.CreateLubricatedJoint(mbs, "wrist pin", items, [*end, 0.0], axis, BEARING)
    ends = ([mbs.CreateGround(), crank], [0, 0, 0]), ([crank, rod], [*pin, 0.0])
    for k, (items, place) in enumerate(ends):
        ehd.CreateLubricatedJoint(mbs, f"other {k}", items, place, axis, BEARING, axial=ehd.Held(), tilt=ehd.Held())
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.01, STEPS, tolerance=1e-9)))
    where = [mbs.GetObjectOutputBody(b, exu.OutputVariableType.Position, [0.0] * 3) for b in (crank, rod, block)]
    return np.array(where), wrist.history


@pytest.mark.parametrize(("planar", "is_journal"), [(True, True), (False, False)])
def test_a_slider_of_a_point_is_one_of_a_body_that_can_not_turn(planar, is_journal):
    where, history = run(is_journal, point=True, planar=planar)
    expected, of_body = run(is_journal, point=False, planar=planar)
    assert np.ptp(history.motion[:, 8]) > 0.2 * SPEED * CRANK / ROD
    # both solve the same equations to the tolerance of Newton's method
    assert np.abs(where - expected).max() < 1e-6 * BEARING.radial_clearance
    scale = np.abs(of_body.force).max()
    assert scale > 20.0
    assert np.abs(history.force - of_body.force).max() < 1e-5 * scale


def test_points_take_the_place_of_joints_of_planar_models():
    mbs = scenes.new_system()
    inertia = InertiaCuboid(7800.0, [ROD, 0.02, 0.02])
    rod = body(mbs, inertia, [0.5 * ROD, 0.0], planar=True)
    point = mbs.CreateMassPoint(referencePosition=[ROD, 0.0, 0.0], mass=MASS, create2D=True)
    ground = mbs.AddNode(eii.NodePointGround())
    markers = [
        mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=ground)),
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=rod, localPosition=[-0.5 * ROD, 0, 0])),
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=rod, localPosition=[0.5 * ROD, 0, 0])),
        mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=mbs.GetObject(point)["nodeNumber"])),
    ]
    for pair in (markers[:2], markers[2:]):
        mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=pair))
    films = ehd.ReplaceJoints(mbs, bearing=BEARING)
    mbs.CreateForce(itemNumber=rod, loadVector=[0.0, -50.0, 0.0])
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.005, 50)))
    for film in films.values():
        assert film.history.largest_eccentricity_ratio[-1] < 1.0
    # the point falls with the rod's end
    assert mbs.GetObjectOutputBody(point, exu.OutputVariableType.Position, [0.0] * 3)[1] < -BEARING.radial_clearance


def test_points_turn_with_nothing():
    """A squeeze film between a point and ground: no speed, and no tilt to hold."""
    mbs = scenes.new_system()
    point = mbs.CreateMassPoint(mass=MASS, gravity=[0.0, -9.81, 0.0])
    joint = ehd.CreateLubricatedJoint(
        mbs, "damper", [mbs.CreateGround(), point], [0, 0, 0], [0, 0, 1], BEARING, tilt=ehd.Held()
    )
    assert joint.constraintNumber is None
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.01, 40)))
    assert np.all(joint.history.motion[:, [2, 3, 6, 7, 8]] == 0.0)
    # it sinks at the speed at which the film carries its weight
    last = joint.history.between(0.01)
    film = ehd.steady(
        BEARING,
        speed=0.0,
        eccentricity_ratio=last.eccentricity_ratio[0],
        direction=-0.5 * np.pi,
        velocity=(0.0, last.motion[0, 5]),
    )
    assert film.force[1] == pytest.approx(MASS * 9.81, rel=1e-3)


def test_what_a_point_can_not_carry_is_refused():
    mbs = scenes.new_system()
    ground, bearing = mbs.CreateGround(), BEARING
    point = mbs.CreateMassPoint(mass=MASS)
    where = [0, 0, 0], [0, 0, 1], bearing
    with pytest.raises(ehd.InputError, match=r"axial=Held\(\) can't hold a mass point, which is the journal"):
        ehd.CreateLubricatedJoint(mbs, "a", [ground, point], *where, axial=ehd.Held())
    flat = mbs.CreateMassPoint(mass=MASS, create2D=True)
    with pytest.raises(ehd.InputError, match="axis must be parallel to z"):
        ehd.CreateLubricatedJoint(mbs, "b", [ground, flat], [0, 0, 0], [1, 0, 0], bearing)
    node = mbs.AddNode(eii.NodePoint())
    mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=[node], massMatrix=np.eye(3)))
    with pytest.raises(ehd.InputError, match=r"no rotation of its own and is one of object 5 .* MarkerSuperElement"):
        ehd.CreateLubricatedJoint(mbs, "c", [ground, node], *where)
    with pytest.raises(ehd.InputError, match=r"node of type 1D has no rotation of its own and is no mass point"):
        ehd.CreateLubricatedJoint(mbs, "d", [ground, mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))], *where)
