"""Planar mechanisms of Exudyn."""

from __future__ import annotations

import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from tests.mechanisms.exudyn_data.model import GRAVITY, Model, pin, planar, weight


def four_bars(mbs):
    """TestModels/fourBarMechanismIftomm.py: IFToMM's benchmark of two coupled four-bar linkages."""
    places = [([0, 0.5], 0.5), ([0.5, 1], 0), ([1, 0.5], 0.5), ([1.5, 1], 0), ([2, 0.5], 0.5)]
    bars = []
    for place, turns in places:
        upright = turns > 0
        velocity = [0.5, 0.0, -1.0] if upright else [1.0, 0.0, 0.0]
        bars.append(planar(mbs, 1.0, 1.0, place, turns * math.pi, velocity))
        mbs.AddLoad(
            eii.LoadMassProportional(
                markerNumber=mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=bars[-1])), loadVector=[0, -GRAVITY, 0]
            )
        )
    ground, a = mbs.CreateGround(), 0.5
    first = pin(mbs, (ground, 0.0), (bars[0], -a))
    for k in (1, 2):
        pin(mbs, (ground, float(k)), (bars[2 * k], -a))
    for one, other in (((0, a), (1, -a)), ((1, a), (3, -a)), ((2, a), (3, -a)), ((3, a), (4, a))):
        pin(mbs, (bars[one[0]], one[1]), (bars[other[0]], other[1]))
    return Model(bars, first, weight(bars, [1.0] * 5, np.array([0, -GRAVITY, 0])))


def slider_crank(mbs):
    """Examples/SliderCrank.py: a crank under a torque, its slider a mass point."""
    half = 0.25, 0.5
    crank = planar(mbs, 0.5, 2.0, [half[0], 0.0], 0.0)
    rod = planar(mbs, 1.0, 4.0, [2 * half[0] + half[1], 0.0], 0.0)
    slider = mbs.CreateMassPoint(referencePosition=[1.5, 0.0, 0.0], mass=1.0, create2D=True)
    joint = pin(mbs, (mbs.CreateGround(), 0.0), (crank, -half[0]))
    pin(mbs, (crank, half[0]), (rod, -half[1]))
    pin(mbs, (rod, half[1]), (slider, 0.0))
    mbs.CreateCoordinateConstraint(itemNumbers=[None, slider], coordinates=[None, 1])
    mbs.CreateTorque(itemNumber=crank, loadVector=[0.0, 0.0, 10.0])
    node = mbs.GetObject(crank)["nodeNumber"]

    def turned(mbs):
        return -10.0 * float(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates)[2])

    return Model([crank, rod, slider], joint, turned)


def floating_crank(mbs):
    """TestModels/sliderCrankFloatingTest.py: a slider-crank on a frame that springs hold, its damping left out."""
    frame_node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0]))
    frame = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=frame_node, mass=2.0, inertia=1.0))
    ground = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    for k in range(3):
        own = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=frame_node, coordinate=k))
        mbs.AddObject(eii.ObjectConnectorCoordinateSpringDamper(markerNumbers=[ground, own], stiffness=5000.0))
    lengths = 0.1, 0.3
    crank = planar(mbs, lengths[0], 0.2, [0.05, 0.0], 0.0)
    rod = planar(mbs, lengths[1], 0.2, [0.25, 0.0], 0.0)
    slider_node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0.4, 0.0, 0.0]))
    slider = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=slider_node, mass=0.4, inertia=0.001 * 0.4))
    joint = pin(mbs, (frame, 0.0), (crank, -0.05))
    pin(mbs, (crank, 0.05), (rod, -0.15))
    pin(mbs, (rod, 0.15), (slider, 0.0))
    guide = [
        mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=b, localPosition=[x, 0, 0]))
        for b, x in ((frame, 0.4), (slider, 0))
    ]
    mbs.AddObject(eii.ObjectJointPrismatic2D(markerNumbers=guide, constrainRotation=True))
    node = mbs.GetObject(crank)["nodeNumber"]
    angle = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=angle, load=0.1))

    def potential(mbs):
        output = exu.OutputVariableType.Coordinates
        spring = 2500.0 * float(np.sum(np.square(mbs.GetNodeOutput(frame_node, output))))
        return spring - 0.1 * float(mbs.GetNodeOutput(node, output)[2])

    return Model([frame, crank, rod, slider], joint, potential)
