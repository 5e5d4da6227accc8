"""Journals that a constraint keeps parallel to their bore: overhung links on films that could not carry them."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import MarkerNodeRigid
from exudyn.utilities import InertiaCuboid, RotationVector2RotationMatrix

import exudyn_ehd as ehd
from tests.sampling import sample

CLEARANCE = 20e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.01),
    film=ehd.FiniteLength(n_theta=32, n_z=6),
)
NODES = {
    "Euler parameters": exu.NodeType.RotationEulerParameters,
    "rotation vector": exu.NodeType.RotationRotationVector,
    "Tait-Bryan angles": exu.NodeType.RotationRxyz,
}
OVERHANG = np.array([0.1, 0.0, 0.3])


def fall(node, make, seed):
    """A link whose centre lies beside the joint's axis and plane falls about an axis at random; its end."""
    rng = np.random.default_rng(seed)
    place, turn = rng.uniform(-1.0, 1.0, 3), RotationVector2RotationMatrix(rng.uniform(-1.5, 1.5, 3))
    mbs = exu.SystemContainer().AddSystem()
    link = mbs.CreateRigidBody(
        inertia=InertiaCuboid(density=7800.0, sideLengths=[0.3, 0.03, 0.03]),
        referencePosition=list(place + turn @ OVERHANG),
        referenceRotationMatrix=turn,
        nodeType=node,
        gravity=[0.0, -9.81, 0.0],
    )
    joint = make(mbs, [mbs.CreateGround(), link], list(place), list(turn[:, 2]))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 200, 0.02
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    here = np.array(mbs.GetObjectOutputBody(link, exu.OutputVariableType.Position, [0.15, 0.0, 0.0]))
    return joint, here - (place + turn @ (OVERHANG + [0.15, 0.0, 0.0]))


def film(**options):
    return lambda mbs, items, place, axis: ehd.CreateLubricatedJoint(
        mbs, "pivot", items, place, axis, BEARING, **options
    )


@pytest.mark.parametrize("axial", [ehd.Free(), ehd.Held()])
@pytest.mark.parametrize("node", sample(list(NODES), 0))
def test_constraint_carries_what_tilts(node, axial):
    seed = 3
    with pytest.raises(ehd.FilmError, match="pivot"):
        fall(NODES[node], film(axial=ehd.Held()), seed)
    joint, moved = fall(NODES[node], film(axial=axial, tilt=ehd.Held()), seed)
    history = joint.history
    assert np.abs(history.motion[:, 2:4]).max() < 1e-6 * CLEARANCE / BEARING.length
    # an aligned film has no moment across the axis, but for what Newton's method leaves in the rates
    assert np.abs(history.moment[:, :2]).max() < 1e-3 * BEARING.length * np.abs(history.force).max()
    if axial == ehd.Held():
        ideal = fall(NODES[node], lambda mbs, *where: mbs.CreateRevoluteJoint("pivot", *where), seed)[1]
        assert np.linalg.norm(ideal) > 100.0 * CLEARANCE
        assert np.linalg.norm(moved - ideal) < 2.0 * CLEARANCE + 0.03 * np.linalg.norm(ideal)


def test_markers_and_numbers_of_the_constraint():
    def on_marker(mbs, items, place, axis):
        node = mbs.GetObject(items[1])["nodeNumber"]
        marker = mbs.AddMarker(MarkerNodeRigid(nodeNumber=node))
        return ehd.CreateLubricatedJoint(mbs, "pivot", [items[0], marker], [], axis, BEARING, tilt=ehd.Held())

    # the marker is where the link's centre is, so that nothing tilts
    joint, _ = fall(exu.NodeType.RotationRxyz, on_marker, 3)
    assert joint.mbs.GetObject(joint.constraintNumber)["constrainedAxes"] == [0, 0, 0, 1, 1, 0]
    assert np.abs(joint.history.motion[:, 2:4]).max() < 1e-6 * CLEARANCE / BEARING.length


def test_planar_joints_need_none():
    mbs = exu.SystemContainer().AddSystem()
    disc = mbs.CreateRigidBody(inertia=InertiaCuboid(density=7800.0, sideLengths=[0.1] * 3), create2D=True)
    items = [mbs.CreateGround(), disc]
    joint = ehd.CreateLubricatedJoint(mbs, "a", items, [0, 0, 0], [0, 0, 1], BEARING, tilt=ehd.Held())
    assert joint.constraintNumber is None


def test_what_is_no_option_is_refused():
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(ehd.InputError, match=r"CreateLubricatedJoint.tilt"):
        ehd.CreateLubricatedJoint(mbs, "a", [None, None], [0, 0, 0], [0, 0, 1], BEARING, tilt=True)
