"""A free body that carries its bearing off its centre, and what a run must keep: momentum and energy of everything."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import scenes
from elastic_scene import CYLINDER, HOUSING, STEEL, bearing
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.run.system_matrix import Factors, SystemMatrix

RING = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.05, axial=1, radial=1, circumferential=6)
ARM, TURN, PUSH = np.array([0.05, -0.02, 0.0]), 40.0, 8e3
BUSH = ehd.ANCFBush(mesh=CYLINDER, material=STEEL)
JOURNAL = InertiaCylinder(7800, 0.3, 0.03, 2)
START = np.array([0.3, -0.2, 0.0])


def planar_tree(mbs, inertia):
    """Free planar body as a tree of two sliders and a hinge; it starts in motion."""
    joints, k, zero = exu.JointType, 3, [0.0] * 3
    node = mbs.AddNode(
        eii.NodeGenericODE2(
            referenceCoordinates=zero,
            initialCoordinates=zero,
            initialCoordinates_t=[*START[:2], TURN],
            numberOfODE2Coordinates=k,
        )
    )
    none, masses = np.zeros((3, 3)), [0.0, 0.0, inertia.Mass()]
    body = mbs.AddObject(
        eii.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[joints.PrismaticX, joints.PrismaticY, joints.RevoluteZ],
            linkParents=[-1, 0, 1],
            jointTransformations=exu.Matrix3DList([np.eye(3)] * k),
            jointOffsets=exu.Vector3DList([[0.0, 0, 0]] * k),
            linkInertiasCOM=exu.Matrix3DList([none, none, inertia.InertiaCOM()]),
            linkCOMs=exu.Vector3DList([[0.0, 0, 0]] * k),
            linkMasses=masses,
            baseOffset=[0.0, 0, 0],
        )
    )

    def marker(point):
        return mbs.AddMarker(
            eii.MarkerKinematicTreeRigid(objectNumber=body, linkNumber=k - 1, localPosition=list(point))
        )

    return marker(ARM), marker(np.zeros(3))


def rod(housing, bush=BUSH):
    """A free body that turns in its plane carries the bearing off its centre; its item is planar, in space, or a tree's
    link."""
    mbs = scenes.new_system()
    motion = {"initialVelocity": list(START), "initialAngularVelocity": [0, 0, TURN]}
    if housing == "tree":
        item, centre = planar_tree(mbs, HOUSING)
    else:
        # additive angles, like the planar body's: the integrator then does the same
        kind = {"create2D": True} if housing == "planar" else {"nodeType": exu.NodeType.RotationRxyz}
        body = mbs.CreateRigidBody(inertia=HOUSING, **kind, **motion)
        if housing == "space":
            mbs.CreateGenericJoint(
                itemNumbers=[mbs.CreateGround(), body], position=[0, 0, 0], constrainedAxes=[0, 0, 1, 1, 1, 0]
            )
        item = body
        centre = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))
    place = ARM + 30e-6 * np.array([0.4, -0.5, 0.0])
    journal = mbs.CreateRigidBody(
        referencePosition=list(ARM),
        initialDisplacement=list(place - ARM),
        inertia=JOURNAL,
        initialVelocity=list(START + TURN * np.array([-place[1], place[0], 0.0])),
        initialAngularVelocity=[0, 0, TURN + 314.0],
        create2D=True,
    )
    if housing == "tree":
        journal = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, 0]))
    force = lambda mbs, t, v: [PUSH, PUSH * np.cos(2000.0 * t), 0.0]  # noqa: E731
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0, 0, 0], loadVectorUserFunction=force))
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="b",
        itemNumbers=[item, journal],
        position=[] if housing == "tree" else list(ARM),
        axis=[0, 0, 1],
        rotationMatrixAxes=np.eye(3),
        bearing=bearing(bush),
    )
    mbs.Assemble()
    return mbs, joint


def total(mbs, modes=(), matrix=None):
    """Linear momentum in the plane and kinetic energy of everything; ``modes`` are nodes without position, ``matrix``
    the `SystemMatrix`."""
    q_t = np.array(mbs.systemData.GetODE2Coordinates_t())
    n, flow = len(q_t), np.zeros(len(q_t))
    matrix = SystemMatrix(mbs) if matrix is None else matrix
    for part in matrix.parts + matrix.meshes:
        for rows, columns, values in part(mbs, Factors(1.0, 0.0, 0.0, 1.0, 1.0)):
            own = (rows < n) & (columns < n)
            np.add.at(flow, rows[own], values[own] * q_t[columns[own]])
    ways = np.zeros((2, n))
    for i in set(range(mbs.systemData.NumberOfNodes())) - {int(node) for node in modes}:
        places = mbs.systemData.GetNodeLTGODE2(i)
        if len(places):
            ways[0, places[0]] = ways[1, places[1]] = 1.0
    return ways @ flow, 0.5 * q_t @ flow
