"""Machines of Exudyn: scissors, engines, arms with hydraulic cylinders, a chain drive."""

from __future__ import annotations

import functools
import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.utilities import (
    InertiaCuboid,
    InertiaCylinder,
    RotationMatrixZ,
    SmoothStep,
)

from tests.mechanisms.exudyn_data.model import GRAVITY, Model, pin, planar, weight


def spot(mbs, body, x=0.0, y=0.0):
    """Rigid marker of a planar body."""
    return mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0.0]))


def scissors(mbs):
    """TestModels/scissorPrismaticRevolute2D.py: three scissors that a spring opens, a bar slides in their pivots.

    The source starts at rest, from where the spring throws it to pi/4 rad/s within 0.1 ms, at which its damper holds
    it. Here it has that speed from the start.
    """
    length, count, stiffness, gravity = 0.8, 3, 1e4, 0.1 * GRAVITY
    ground = mbs.CreateGround()
    kind = {"stiffness": [stiffness] * 3, "damping": [0.01 * stiffness] * 3}
    bodies, joints, workers = [], [], []

    turn = 0.25 * math.pi

    def bar(place, angle, speed):
        velocity = [turn * place, 0.0, -speed]
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[place, place, angle], initialVelocities=velocity))
        bodies.append(mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=1.0, inertia=1.0)))
        mbs.AddLoad(eii.Force(markerNumber=spot(mbs, bodies[-1]), loadVector=[0.0, -gravity, 0.0]))
        return bodies[-1], node

    diagonal, _ = bar(0.0, 0.25 * math.pi, 0.5 * turn)
    workers.append(
        mbs.AddObject(eii.CartesianSpringDamper(markerNumbers=[spot(mbs, diagonal), spot(mbs, ground)], **kind))
    )
    last = None
    for k in range(count):
        (flat, flat_node), (upright, upright_node) = bar(k * length, 0.0, 0.0), bar(k * length, 0.5 * math.pi, turn)
        if last is None:
            joints += [pin(mbs, (body, 0.0), (ground, 0.0)) for body in (flat, upright)]
            fixed = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
            angles = [
                mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=2)) for n in (flat_node, upright_node)
            ]
            mbs.AddObject(eii.CoordinateConstraint(markerNumbers=[fixed, angles[0]]))
            workers.append(
                mbs.AddObject(
                    eii.ObjectConnectorCoordinateSpringDamper(
                        markerNumbers=[fixed, angles[1]], stiffness=1e4, damping=1e4, offset=-turn
                    )
                )
            )
        else:
            slide = [spot(mbs, upright), spot(mbs, diagonal, math.sqrt(2.0) * k * length)]
            mbs.AddObject(
                eii.ObjectJointPrismatic2D(
                    markerNumbers=slide, axisMarker0=[1, 0, 0], normalMarker1=[0, 1, 0], constrainRotation=False
                )
            )
            joints += [
                pin(mbs, (flat, 0.0), (upright, 0.0)),
                pin(mbs, (flat, -length), (last[1], length)),
                pin(mbs, (upright, -length), (last[0], length)),
            ]
        last = flat, upright
    potential = weight(bodies, [1.0] * len(bodies), np.array([0.0, -gravity, 0.0]))
    return Model(bodies, joints[1], potential, workers=workers)


def engine(mbs, cranks):
    """Examples/pistonEngine.py: an engine in line with ``cranks`` at angles [rad], run up at a prescribed speed."""
    steel, arm, rod = 7850.0, 0.04, 0.1
    bearing, web, pin_length = 0.012, 0.01, 0.024
    pitch = bearing + 2.0 * web + pin_length
    whole = pitch * len(cranks) + bearing
    cheek = InertiaCuboid(steel, [arm, 0.016, web])
    main, throw = InertiaCylinder(steel, bearing, 0.01, 2), InertiaCylinder(steel, pin_length, 0.008, 2)
    inertia = main.Translated([0.0, 0.0, 0.5 * (whole - bearing)])
    for k, angle in enumerate(cranks):
        turn, z = RotationMatrixZ(angle), -0.5 * whole + k * pitch
        inertia += main.Translated([0.0, 0.0, z + 0.5 * bearing])
        inertia += throw.Translated(turn @ [arm, 0.0, z + bearing + web + 0.5 * pin_length])
        for place in (z + bearing + 0.5 * web, z + bearing + 1.5 * web + pin_length):
            inertia += cheek.Rotated(turn).Translated(turn @ [0.5 * arm, 0.0, place])
    kind = {"nodeType": exu.NodeType.RotationEulerParameters}
    block = mbs.CreateRigidBody(inertia=InertiaCuboid(1000.0, [1.0, 1.0, 1.0]), **kind)
    mbs.CreateGenericJoint("mount", [block, mbs.CreateGround()], [0, 0, 0], constrainedAxes=[1] * 6)
    shaft = mbs.CreateRigidBody(inertia=inertia, **kind)
    joint = mbs.CreateRevoluteJoint("main", [block, shaft], [0.0, 0.0, -0.5 * whole], [0, 0, 1])
    bodies = [block, shaft]
    for k, angle in enumerate(cranks):
        z = -0.5 * whole + k * pitch + bearing + web + 0.5 * pin_length
        lean = -math.asin(arm * math.sin(angle) / rod)
        big = RotationMatrixZ(angle) @ [arm, 0.0, z]
        turn = RotationMatrixZ(lean)
        small = big + turn @ [rod, 0.0, 0.0]
        link = mbs.CreateRigidBody(
            inertia=InertiaCuboid(steel, [rod, 0.02, 0.02]),
            referencePosition=(0.5 * (big + small)).tolist(),
            referenceRotationMatrix=turn,
            **kind,
        )
        piston = mbs.CreateRigidBody(
            inertia=InertiaCylinder(steel, 0.05, 0.02, 0, innerRadius=0.01), referencePosition=small.tolist(), **kind
        )
        mbs.CreateRevoluteJoint(f"big end {k}", [shaft, link], big.tolist(), [0, 0, 1])
        mbs.CreateRevoluteJoint(f"small end {k}", [link, piston], small.tolist(), [0, 0, 1])
        mbs.CreateGenericJoint(
            f"bore {k}", [piston, block], [0, 0, 0], constrainedAxes=[0, 1, 0, 0, 0, 1], useGlobalFrame=False
        )
        bodies += [link, piston]
    angles = [
        mbs.AddMarker(eii.MarkerNodeRotationCoordinate(nodeNumber=mbs.GetObject(b)["nodeNumber"], rotationCoordinate=2))
        for b in (block, shaft)
    ]
    return Model(bodies, joint, drive=_driven(mbs, angles, 2.0 * math.pi))


def _driven(mbs, coordinates, speed):
    """Constraint that brings two coordinates to a ``speed`` [rad/s] to each other within half a second."""
    return mbs.AddObject(
        eii.CoordinateConstraint(
            markerNumbers=coordinates,
            velocityLevel=True,
            offsetUserFunction_t=lambda mbs, t, number, offset: SmoothStep(t, 0.0, 0.5, 0.0, speed),
        )
    )


def hydraulic_arms(mbs):
    """Examples/HydraulicActuator2Arms.py: two arms that hydraulic cylinders move under control."""
    length, thick, mass = 1.0, 0.1, 120.0
    ground = mbs.CreateGround()
    arms = [
        planar(mbs, length, mass, [0.5 * length, 0.0], 0.0),
        planar(mbs, length, mass, [length, -0.5 * length], -0.5 * math.pi),
    ]
    for arm in arms:
        mbs.AddLoad(eii.Force(markerNumber=spot(mbs, arm), loadVector=[0.0, -mass * GRAVITY, 0.0]))
    joint = pin(mbs, (ground, 0.0), (arms[0], -0.5 * length))
    pin(mbs, (arms[0], 0.5 * length), (arms[1], -0.5 * length))
    near, low = 0.25 * length, 0.5 * thick
    ends = [((ground, 0.0, -near - low), (arms[0], -near, -low)), ((arms[0], near, -low), (arms[1], -near, -low))]
    reach = [math.sqrt(2.0) * near, math.sqrt(2.0) * (near - low)]
    cylinders = [
        mbs.AddObject(
            eii.HydraulicActuatorSimple(
                markerNumbers=[
                    mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=b, localPosition=[x, y, 0.0])) for b, x, y in pair
                ],
                nodeNumbers=[
                    mbs.AddNode(
                        eii.NodeGenericODE1(
                            referenceCoordinates=[0, 0], initialCoordinates=[2e6, 2e6], numberOfODE1Coordinates=2
                        )
                    )
                ],
                offsetLength=reference,
                strokeLength=0.7 * reference,
                chamberCrossSection0=0.01,
                chamberCrossSection1=0.01,
                hoseVolume0=1.0,
                hoseVolume1=1.0,
                oilBulkModulus=1e12,
                actuatorDamping=2e5,
                nominalFlow=2e-5,
                systemPressure=2e7,
                tankPressure=1e-16,
            )
        )
        for pair, reference in zip(ends, reach, strict=True)
    ]

    def control(mbs, t):
        for cylinder, reference, rate, stroke in zip(cylinders, reach, (1.0, 2.0), (0.15, 0.2), strict=True):
            aim = (max(0.5, min(1.5, 1.0 - math.cos(rate * math.pi * t))) - 0.5) * stroke + reference
            opening = 2.0 * (aim - mbs.GetObjectOutput(cylinder, exu.OutputVariableType.Distance))
            mbs.SetObjectParameter(cylinder, "valveOpening0", opening)
            mbs.SetObjectParameter(cylinder, "valveOpening1", -opening)
        return True

    mbs.SetPreStepUserFunction(control)
    return Model(arms, joint, weight(arms, [mass] * 2, np.array([0.0, -GRAVITY, 0.0])), workers=cylinders)


def chain(mbs):
    """Examples/chainDriveExample.py: thirty links on two sprockets of which one is driven and one hangs on a spring."""
    teeth, free, roller, pitch, width = 16, 7, 0.005, 0.03, 0.012
    tooth = 2.0 * math.pi / teeth
    radius = pitch / (2.0 * math.sin(0.5 * tooth))
    gravity = [0.0, -GRAVITY, 0.0]
    wheel = {"inertia": InertiaCylinder(100.0, 0.95 * width, radius, 2), "gravity": gravity, "create2D": True}
    ground, drop = mbs.CreateGround(), -free * pitch
    hung = mbs.CreateGround(referencePosition=[0.0, drop, 0.0])
    wheels = [mbs.CreateRigidBody(referencePosition=[0.0, y, 0.0], **wheel) for y in (0.0, drop)]
    hubs = [spot(mbs, body) for body in wheels]
    stands = [spot(mbs, body) for body in (ground, hung)]
    joint = mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=[stands[0], hubs[0]]))
    still = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
    angle = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.GetObject(wheels[0])["nodeNumber"], coordinate=2))
    drive = _driven(mbs, [still, angle], math.pi)
    mbs.AddObject(eii.SphericalJoint(markerNumbers=[stands[1], hubs[1]], constrainedAxes=[1, 0, 0]))
    workers = [
        mbs.AddObject(
            eii.LinearSpringDamper(
                markerNumbers=[stands[1], hubs[1]], stiffness=1000.0, damping=100.0, axisMarker0=[0, 1, 0], force=10.0
            )
        ),
        mbs.AddObject(eii.TorsionalSpringDamper(markerNumbers=[stands[0], hubs[1]], damping=0.01)),
    ]
    half = teeth // 2
    places = [((-radius, drop + k * pitch), 0.5 * math.pi) for k in range(free)]
    for side, y in ((-1.0, 0.0), (1.0, drop)):
        for k in range(half):
            turned = k * tooth
            places.append(
                (
                    (side * radius * math.cos(turned), y - side * radius * math.sin(turned)),
                    -side * 0.5 * math.pi - turned - 0.5 * tooth,
                )
            )
        if side < 0.0:
            places += [((radius, -k * pitch), -0.5 * math.pi) for k in range(free)]
    links = [
        mbs.CreateRigidBody(
            referencePosition=[*place, 0.0],
            inertia=InertiaCuboid(1000.0, [pitch, width, width]),
            referenceRotationMatrix=RotationMatrixZ(turn),
            gravity=gravity,
            create2D=True,
        )
        for place, turn in places
    ]
    fronts = [spot(mbs, link) for link in links]
    for k, link in enumerate(links):
        markers = [spot(mbs, link, pitch), fronts[(k + 1) % len(links)]]
        mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))
    outline = []
    for k in range(4 * teeth):
        turned = (k - 0.5) / (4 * teeth) * 2.0 * math.pi
        r = radius - roller + 2.0 * roller * (k % 4 > 1)
        outline.append([-r * math.cos(turned), -r * math.sin(turned)])
    segments = np.hstack([outline, np.roll(outline, 1, axis=0)])
    for hub in hubs:
        data = mbs.AddNode(
            eii.NodeGenericData(initialCoordinates=[-1, 0, 0] * len(outline), numberOfDataCoordinates=3 * len(outline))
        )
        workers.append(
            mbs.AddObject(
                eii.ObjectContactCurveCircles(
                    markerNumbers=[hub, *fronts],
                    nodeNumber=data,
                    circlesRadii=[roller] * len(links),
                    segmentsData=exu.MatrixContainer(segments),
                    contactStiffness=5e4,
                    contactDamping=10.0,
                )
            )
        )
    bodies = [*wheels, *links]
    masses = [100.0 * math.pi * radius**2 * 0.95 * width] * 2 + [1000.0 * pitch * width**2] * len(links)
    return Model(bodies, joint, weight(bodies, masses, np.array(gravity)), workers=workers, drive=drive)


one_cylinder = functools.partial(engine, cranks=(0.0,))
two_cylinders = functools.partial(engine, cranks=(0.0, math.pi))
