"""A rigid shaft along any axis in two films, of one body or of three."""

import exudyn as exu
import exudyn.itemInterface
import numpy as np
from exudyn.utilities import RigidBodyInertia

import exudyn_ehd as ehd

EULER, TAIT_BRYAN, VECTOR = (
    exu.NodeType.RotationEulerParameters,
    exu.NodeType.RotationRxyz,
    exu.NodeType.RotationRotationVector,
)
CLEARANCE, WEIGHT, SPAN = 25e-6, 9.81, 0.4


def bearing(**options):
    return ehd.JournalBearing(
        **{
            "journal_radius": 0.025,
            "length": 0.025,
            "radial_clearance": CLEARANCE,
            "lubricant": ehd.Lubricant(viscosity=0.02),
            "film": ehd.FiniteLength(n_theta=48, n_z=6),
        }
        | options
    )


def bush_mesh(radius=0.025 + CLEARANCE):
    return ehd.HollowCylinder(inner_radius=radius, thickness=0.008, length=0.025, axial=2, radial=1, circumferential=16)


def plastic(youngs_modulus=2e9):
    return ehd.SaintVenantKirchhoff(youngs_modulus=youngs_modulus, poisson_ratio=0.35, density=1400.0)


def inertia_of(mass, transverse, polar, turn, com=(0.0, 0.0, 0.0)):
    tensor = turn @ np.diag([*np.broadcast_to(transverse, 2), polar]) @ turn.T
    return RigidBodyInertia(mass=mass, com=turn @ com, inertiaTensor=tensor, inertiaTensorAtCOM=True)


def shaft(
    *,
    mass=200.0,
    transverse=2.0,
    polar=1.0,
    place=0.0,
    com=(0.0, 0.0, 0.0),
    axis=2,
    node=EULER,
    offsets=(0.0, 0.0),
    film=None,
    weight=WEIGHT,
    held=True,
    extra=None,
    assemble=True,
):
    """One body with its node at ``place`` on the axis; ``extra`` (mbs, ground, body, turn) adds to the model."""
    mbs = exu.SystemContainer().AddSystem()
    ground, turn = mbs.CreateGround(), np.roll(np.eye(3), axis - 2, axis=0)
    body = mbs.CreateRigidBody(
        referencePosition=place * turn[:, 2],
        inertia=inertia_of(mass, transverse, polar, turn, com),
        gravity=-weight * turn[:, 1],
        nodeType=node,
    )
    joints = []
    for name, z, up in (("left", -0.5 * SPAN, offsets[0]), ("right", 0.5 * SPAN, offsets[1])):
        markers = [
            mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=ground, localPosition=turn @ [0, up, z])),
            mbs.AddMarker(exu.itemInterface.MarkerBodyRigid(bodyNumber=body, localPosition=turn @ [0, 0, z - place])),
        ]
        film_of = bearing() if film is None else film
        joints.append(ehd.CreateLubricatedJoint(mbs, name, markers, axis=turn[:, 2], bearing=film_of))
    if held:
        axes = [*map(int, turn[:, 2]), 0, 0, 0]
        mbs.CreateGenericJoint(itemNumbers=[ground, body], position=place * turn[:, 2], constrainedAxes=axes)
    if extra is not None:
        extra(mbs, ground, body, turn)
    if assemble:
        mbs.Assemble()
    return mbs, body, joints


def three_bodies(link, nodes=(EULER, EULER, EULER)):
    """Two journals of 10 kg and a disc of 20 kg between them, on the z axis; ``link`` (mbs, first, second, place)."""
    mbs = exu.SystemContainer().AddSystem()
    ground, bodies = mbs.CreateGround(), []
    for (mass, transverse, polar, z), node in zip(
        ((10.0, 0.1, 0.05, -0.15), (20.0, 0.3, 0.2, 0.0), (10.0, 0.1, 0.05, 0.15)), nodes, strict=True
    ):
        inertia = inertia_of(mass, transverse, polar, np.eye(3))
        gravity = [0, -WEIGHT, 0]
        bodies.append(mbs.CreateRigidBody(referencePosition=[0, 0, z], inertia=inertia, gravity=gravity, nodeType=node))
    for name, z, body in (("left", -0.2, bodies[0]), ("right", 0.2, bodies[2])):
        ehd.CreateLubricatedJoint(mbs, name, [ground, body], [0, 0, z], [0, 0, 1], bearing())
    mbs.CreateGenericJoint(itemNumbers=[ground, bodies[0]], position=[0, 0, -0.15], constrainedAxes=[0, 0, 1, 0, 0, 0])
    for first, second, z in ((bodies[0], bodies[1], -0.075), (bodies[1], bodies[2], 0.075)):
        link(mbs, first, second, z)
    mbs.Assemble()
    return mbs, bodies


def fixed(mbs, first, second, z):
    mbs.CreateGenericJoint(itemNumbers=[first, second], position=[0, 0, z], constrainedAxes=[1] * 6)


def sprung(stiffness, damping=0.0):
    """Link of springs (6,) with damping of its displacements."""

    def link(mbs, first, second, z):
        mbs.CreateRigidBodySpringDamper(
            itemNumbers=[first, second],
            localPosition0=[0, 0, 0.075],
            localPosition1=[0, 0, -0.075],
            stiffness=np.diag(stiffness),
            damping=np.diag([damping] * 3 + [0.0] * 3),
            useIntrinsicFormulation=False,
        )

    return link
