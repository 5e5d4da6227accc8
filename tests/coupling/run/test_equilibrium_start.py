"""A joint placed in equilibrium stays there from the first step on."""

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from scenes import rotation

import exudyn_ehd as ehd

CLEARANCE, SPEED, LOAD = 30e-6, 300.0, 600.0
PLAIN = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.016,
    radial_clearance=CLEARANCE,
    lubricant=ehd.oil("ISO VG 32", temperature=313.15),
    film=ehd.FiniteLength(n_theta=48, n_z=6),
)
MESH = ehd.HollowCylinder(inner_radius=0.02, thickness=0.01, length=0.016, axial=2, radial=2, circumferential=16)
SOFT = ehd.SaintVenantKirchhoff(youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
BEARINGS = {
    "plain": PLAIN,
    "oil content": dataclasses.replace(PLAIN, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5)),
    "temperature": dataclasses.replace(PLAIN, thermal=ehd.LumpedThermal(supply_temperature=313.15)),
    "liner": dataclasses.replace(PLAIN, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)),
    "modal bush": dataclasses.replace(PLAIN, bush=ehd.ModalBush(mesh=MESH, material=SOFT, tolerance=0.2, tilted=False)),
}


def scene(bearing, frame=None, planar=False):
    """A rotor driven at SPEED in a housing whose joint frame is turned."""
    A = np.eye(3) if frame is None else frame
    mbs = scenes.new_system()
    ground = mbs.CreateGround(referenceRotationMatrix=A)
    if planar:
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialVelocities=[1e-3, 0, SPEED]))
        body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=2.0, inertia=10.0))
    else:
        body = mbs.CreateRigidBody(
            referencePosition=[0.1, 0.2, 0.3],
            referenceRotationMatrix=A,
            inertia=_inertia(),
            nodeType=exu.NodeType.RotationRotationVector,
            initialAngularVelocity=list(A @ [0, 0, SPEED]),
        )
    marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=list(A @ [0.3 * LOAD, -LOAD, 0])))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="main",
        itemNumbers=[ground, body],
        position=[0, 0, 0] if planar else [0.1, 0.2, 0.3],
        axis=list(A[:, 2]),
        bearing=bearing,
    )
    mbs.Assemble()
    return mbs, joint


def _inertia():
    from exudyn.utilities import RigidBodyInertia

    # so much about the axis that friction does not slow it down within the run
    return RigidBodyInertia(mass=2.0, inertiaTensor=np.diag([5.0, 5.0, 10.0]))


@pytest.mark.parametrize("what", BEARINGS)
@pytest.mark.parametrize("planar", [True, False], ids=["planar", "spatial"])
def test_it_stays(what, planar):
    frame = None if planar else rotation([0.4, -0.7, 0.2])
    mbs, joint = scene(BEARINGS[what], frame, planar)
    eq = joint.place_in_equilibrium(load=(0.3 * LOAD, -LOAD))
    s = ehd.ConfigureSolver(scenes.settings(2e-3, 20))
    ehd.SolveDynamic(mbs, s)
    h = joint.history
    assert h.time.size == 21
    # where it was put, to rounding of metres
    assert np.abs(h.eccentricity[0] - eq.position).max() < 1e-12
    assert np.allclose(h.force[0, :2], (-0.3 * LOAD, LOAD), rtol=0.0, atol=1e-4 * LOAD)
    assert np.allclose(h.motion[0, 4:6], 0.0, atol=1e-9)
    # and it stays: the spin falls by some 1e-5 with friction, and the heat of a lumped film follows
    assert np.abs(h.eccentricity - eq.position).max() < 1e-4 * CLEARANCE
    assert np.allclose(h.force[:, :2], (-0.3 * LOAD, LOAD), rtol=0.0, atol=1e-3 * LOAD)


def test_without_it_the_journal_falls_into_its_place():
    mbs, joint = scene(PLAIN, planar=True)
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(2e-3, 20)))
    assert np.ptp(joint.history.eccentricity_ratio) > 0.1


def test_input():
    mbs, joint = scene(PLAIN, planar=True)
    with pytest.raises(ehd.InputError, match="load"):
        joint.place_in_equilibrium(load=(1.0, np.nan))
    with pytest.raises(ehd.InputError, match="speed"):
        joint.place_in_equilibrium(load=(0, -LOAD), speed="fast")
    with pytest.raises(ehd.InputError, match="does not turn"):
        joint.place_in_equilibrium(load=(0, -LOAD), speed=0.0)
    turning = dataclasses.replace(PLAIN, supply=(ehd.Hole(angle=1.0, diameter=0.006, pressure=1e5, rotating=True),))
    mbs, joint = scene(turning, planar=True)
    with pytest.raises(ehd.InputError, match=r"supply\[0\] turns with the journal"):
        joint.place_in_equilibrium(load=(0, -LOAD))
    mbs = scenes.new_system()
    ground, body = mbs.CreateGround(), scenes.add_body(mbs, "2D")
    joint = ehd.CreateLubricatedJoint(
        mbs, name="n", itemNumbers=[body, ground], position=[0, 0, 0], axis=[0, 0, 1], bearing=PLAIN
    )
    with pytest.raises(ehd.InputError, match="not assembled"):
        joint.place_in_equilibrium(load=(0, -LOAD))
    mbs.Assemble()
    with pytest.raises(ehd.InputError, match="must be a rigid body"):
        joint.place_in_equilibrium(load=(0, -LOAD), speed=100.0)
