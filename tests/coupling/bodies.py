"""Every kind of body that a joint can hold: small scenes with the joint's item, a marker for Exudyn's own connectors,
and a load.

A scene function adds its body to a system and returns a `Body`. The joint point of beams lies at `PLACE` on an element
along x, from the global origin to `LENGTH`.
"""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import scenes
from exudyn.FEM import ObjectFFRFreducedOrderInterface

import exudyn_ehd as ehd
from tests.finite_elements import fem_of

LENGTH, PLACE = 0.8, 0.3
LOAD = [0.2, -1.0, 0.0]


@dataclasses.dataclass
class Body:
    """A body in a system, with what a test needs to join and mark it.

    ``item`` is what the joint gets, ``point`` its place (None: a marker gives it), ``marker`` the function that makes a
    rigid marker there.
    """

    item: Any
    point: Any
    marker: Any = None
    planar: bool = False
    nodes: Any = ()


def _load(mbs, node, factor=1.0):
    marker = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=node))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[factor * x for x in LOAD]))


def _on_body(mbs, body, x):
    return lambda: mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0, 0]))


def rigid(kind):
    def make(mbs):
        body = scenes.add_body(mbs, kind, [0.1, 0.2, 0.0])
        node = exu.NodeIndex(int(mbs.GetObject(body)["nodeNumber"]))
        _load(mbs, node)
        marker = lambda: mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[0.2, -0.2, 0]))  # noqa: E731
        return Body(body, [0.3, 0.0, 0.0], marker, kind == "2D", (node,))

    return make


CABLE = {"massPerLength": 2.0, "bendingStiffness": 20.0, "axialStiffness": 2e4}


def cable(dimension, item="element"):
    def make(mbs, scale=1.0):
        zero = [0.0] * (dimension - 1)
        node, element = {
            2: (eii.NodePoint2DSlope1, eii.ObjectANCFCable2D),
            3: (eii.NodePointSlope1, eii.ObjectANCFCable),
        }[dimension]
        nodes = [mbs.AddNode(node(referenceCoordinates=[x, *zero, 1.0, *zero])) for x in (0.0, LENGTH)]
        body = mbs.AddObject(element(nodeNumbers=nodes, length=LENGTH, **CABLE))
        _load(mbs, nodes[1])
        x = {"element": PLACE, "marker": PLACE, "node": 0.0}[item]
        rigid = _on_body(mbs, body, x)
        if item == "marker":
            own = rigid() if dimension == 2 else _position_marker(mbs, body)
            return Body(own, None, rigid, dimension == 2, nodes)
        return Body(nodes[0] if item == "node" else body, [x, 0.0, 0.0], rigid, dimension == 2, nodes)

    return make


def _position_marker(mbs, body):
    return mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[PLACE, 0, 0]))


def section(stiffness=1.0):
    s = exu.BeamSection()
    # round steel of 20 mm, softened
    s.stiffnessMatrix = stiffness * np.diag([6e5, 2e5, 2e5, 12.0, 16.0, 16.0])
    s.inertia = np.diag([2e-4, 1e-4, 1e-4])
    s.massPerLength = 2.0
    return s


def ancf_beam(item="element"):
    def make(mbs, stiffness=1.0):
        slopes = [0, 1, 0, 0, 0, 1]
        nodes = [mbs.AddNode(eii.NodePointSlope23(referenceCoordinates=[x, 0, 0, *slopes])) for x in (0.0, LENGTH)]
        body = mbs.AddObject(eii.ObjectANCFBeam(nodeNumbers=nodes, length=LENGTH, sectionData=section(stiffness)))
        _load(mbs, nodes[1])
        x = PLACE if item == "element" else 0.0
        return Body(
            body if item == "element" else nodes[0], [x, 0, 0], _on_body(mbs, body, x - 0.5 * LENGTH), False, nodes
        )

    return make


def exact_beam(kind, item="element"):
    def make(mbs, stiffness=1.0):
        node = {"EP": eii.NodeRigidBodyEP, "Rxyz": eii.NodeRigidBodyRxyz, "RotVec": eii.NodeRigidBodyRotVecLG}[kind]
        turn = [1.0, 0, 0, 0] if kind == "EP" else [0.0, 0, 0]
        nodes = [mbs.AddNode(node(referenceCoordinates=[x, 0, 0, *turn])) for x in (0.0, LENGTH)]
        body = mbs.AddObject(
            eii.ObjectBeamGeometricallyExact(nodeNumbers=nodes, length=LENGTH, sectionData=section(stiffness))
        )
        _load(mbs, nodes[1])
        x = PLACE if item == "element" else 0.0
        return Body(
            body if item == "element" else nodes[0], [x, 0, 0], _on_body(mbs, body, x - 0.5 * LENGTH), False, nodes
        )

    return make


def exact_beam_2d(mbs, stiffness=1.0):
    nodes = [mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[x, 0, 0])) for x in (0.0, LENGTH)]
    s = section(stiffness)
    body = mbs.AddObject(
        eii.ObjectBeamGeometricallyExact2D(
            nodeNumbers=nodes,
            length=LENGTH,
            massPerLength=s.massPerLength,
            crossSectionInertia=s.inertia[2, 2],
            bendingStiffness=s.stiffnessMatrix[5, 5],
            axialStiffness=s.stiffnessMatrix[0, 0],
            shearStiffness=s.stiffnessMatrix[1, 1],
        )
    )
    _load(mbs, nodes[1])
    return Body(body, [PLACE, 0, 0], None, True, nodes)


def wheel(mbs):
    node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))
    body = mbs.AddObject(eii.ObjectRotationalMass1D(nodeNumber=node, inertia=0.02, referencePosition=[0.1, 0.2, 0.0]))
    marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=0.5))
    off_centre = lambda: mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[0.05, 0, 0]))  # noqa: E731
    return Body(body, [0.15, 0.2, 0.0], off_centre, False, (node,))


def mass_point(planar, item="body"):
    """``item``: body, node, or marker beside the body's centre, with which it never turns."""

    def make(mbs):
        body = mbs.CreateMassPoint(referencePosition=[0.3, 0.1, 0.0], mass=2.0, create2D=planar)
        node = exu.NodeIndex(int(mbs.GetObject(body)["nodeNumber"]))
        _load(mbs, node)
        if item == "marker":
            beside = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, -0.1, 0.0]))
            return Body(beside, None, None, planar, (node,))
        return Body(body if item == "body" else node, [0.3, 0.0, 0.0], None, planar, (node,))

    return make


def slider(mbs):
    node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.1]))
    turn = scenes.rotation([0.3, -0.2, 0.5])
    body = mbs.AddObject(
        eii.ObjectMass1D(nodeNumber=node, mass=2.0, referencePosition=[0.1, 0.2, 0.0], referenceRotation=turn)
    )
    marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=0.5))
    off_centre = lambda: mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[0.05, 0, 0]))  # noqa: E731
    place = np.array([0.1, 0.2, 0.0]) + turn @ [0.15, 0.0, 0.0]
    return Body(body, place.tolist(), off_centre, False, (node,))


def tree(mbs, parents=(-1, 0, 1)):
    """Three links; the joint is on the last one."""
    joints = exu.JointType
    types = [joints.RevoluteZ, joints.RevoluteX, joints.PrismaticY]
    k = len(types)
    zero = [0.0] * k
    node = mbs.AddNode(
        eii.NodeGenericODE2(
            referenceCoordinates=zero, initialCoordinates=zero, initialCoordinates_t=zero, numberOfODE2Coordinates=k
        )
    )
    body = mbs.AddObject(
        eii.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=types,
            linkParents=list(parents),
            jointTransformations=exu.Matrix3DList([np.eye(3)] * k),
            jointOffsets=exu.Vector3DList([[0, 0, 0], [0.3, 0, 0], [0.3, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([0.02 * np.eye(3)] * k),
            linkCOMs=exu.Vector3DList([[0.1, 0.02, 0.0]] * k),
            linkMasses=[1.0] * k,
            baseOffset=[0.0, 0, 0],
            gravity=LOAD,
            jointPositionOffsetVector=zero,
            jointVelocityOffsetVector=zero,
            jointPControlVector=[0.0, 20.0, 2e3],
            jointDControlVector=[0.1, 0.1, 1.0],
        )
    )
    at = {"objectNumber": body, "linkNumber": k - 1, "localPosition": [0.1, 0.05, 0.0]}
    marker = mbs.AddMarker(eii.MarkerKinematicTreeRigid(**at))
    return Body(marker, None, lambda: marker, False, (node,))


@functools.cache
def ring(axial=1, radial=1, circumferential=12):
    """Soft ring of 50/70 mm radius as FEMinterface, and its mesh."""
    mesh = ehd.HollowCylinder(
        inner_radius=0.05, thickness=0.02, length=0.06, axial=axial, radial=radial, circumferential=circumferential
    ).mesh()
    material = ehd.SaintVenantKirchhoff(youngs_modulus=5e8, poisson_ratio=0.3, density=2000.0)
    return fem_of(mesh, material), mesh


def _averaged(mbs, body, nodes):
    weights = np.full(len(nodes), 1.0 / len(nodes))
    return mbs.AddMarker(
        eii.MarkerSuperElementRigid(bodyNumber=body, meshNodeNumbers=nodes, weightingFactors=weights.tolist())
    )


def reduced_ring(kind="EulerParameters"):
    def make(mbs):
        fem, mesh = ring()
        fem.ComputeHurtyCraigBamptonModes([list(mesh.outer.nodes), list(mesh.bore.nodes)], 4)
        cms = ObjectFFRFreducedOrderInterface(fem, rigidBodyNodeType=f"NodeType.Rotation{kind}")
        parts = cms.AddObjectFFRFreducedOrder(mbs)
        node = exu.NodeIndex(int(parts["nRigidBody"]))
        load = mbs.AddMarker(
            eii.MarkerSuperElementPosition(
                bodyNumber=parts["oFFRFreducedOrder"],
                meshNodeNumbers=[int(mesh.outer.nodes[5])],
                weightingFactors=[1.0],
            )
        )
        mbs.AddLoad(eii.LoadForceVector(markerNumber=load, loadVector=[0.02 * x for x in LOAD]))
        marker = _averaged(mbs, parts["oFFRFreducedOrder"], mesh.bore.nodes.tolist())
        return Body(marker, None, lambda: marker, False, (node, exu.NodeIndex(int(parts["nGenericODE2"]))))

    return make


def nodal_ring(mbs):
    fem, mesh = ring()
    body, nodes = fem.CreateLinearFEMObjectGenericODE2(mbs)
    _load(mbs, nodes[int(mesh.outer.nodes[5])], 0.02)
    marker = _averaged(mbs, body, mesh.bore.nodes.tolist())
    return Body(marker, None, lambda: marker, False, tuple(nodes))


AGAINST_CONNECTOR = {
    "rigid EP": rigid("EP"),
    "rigid Rxyz": rigid("Rxyz"),
    "rigid RotVec": rigid("RotVec"),
    "rigid 2D": rigid("2D"),
    "cable 2D element": cable(2),
    "cable 2D node": cable(2, "node"),
    "cable 2D marker": cable(2, "marker"),
    "ANCF beam element": ancf_beam(),
    "ANCF beam node": ancf_beam("node"),
    "exact beam node EP": exact_beam("EP", "node"),
    "exact beam node Rxyz": exact_beam("Rxyz", "node"),
    "wheel": wheel,
    "slider": slider,
    "tree": tree,
    "reduced FE body EP": reduced_ring(),
    "reduced FE body Rxyz": reduced_ring("Rxyz"),
    "nodal FE body": nodal_ring,
}


# Geometrically exact beams on RotVec nodes are left out: Exudyn's own model of them needs a hundred Newton steps per
# time step here.
JACOBIANS = AGAINST_CONNECTOR | {
    "mass point": mass_point(False),
    "mass point node": mass_point(False, "node"),
    "mass point marker": mass_point(False, "marker"),
    "mass point 2D": mass_point(True),
    "mass point 2D marker": mass_point(True, "marker"),
    "exact beam node RotVec": exact_beam("RotVec", "node"),
    "cable 3D element": cable(3),
    "cable 3D node": cable(3, "node"),
    "cable 3D marker": cable(3, "marker"),
    "exact beam element": exact_beam("Rxyz"),
    "exact beam 2D element": exact_beam_2d,
}
