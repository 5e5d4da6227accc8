"""Rotors of Exudyn, on films in the place of their spring bearings; on rigid bearings in the ideal model."""

from __future__ import annotations

import math

import exudyn.itemInterface as eii

import exudyn_ehd as ehd
from tests.mechanisms.exudyn_data.model import Model

# Bearings of both rotors, from the middle [m]; their springs in the source, which set the speed [N/m].
HALF, STIFFNESS = 0.5, 800.0


def _disc(mbs, mass, radius, width, place, speed):
    """Disc that turns about x at a ``speed`` [rad/s]; its centre of mass at ``place`` off the axis turns with it."""
    across = 0.25 * mass * radius**2 + mass * width**2 / 12.0
    node = mbs.AddNode(
        eii.NodeRigidBodyEP(
            referenceCoordinates=[*place, 1, 0, 0, 0],
            initialVelocities=[0.0, 0.0, speed * place[1], 0.0, 0.5 * speed, 0.0, 0.0],
        )
    )
    return mbs.AddObject(
        eii.ObjectRigidBody(nodeNumber=node, mass=mass, inertia=[0.5 * mass * radius**2, across, across, 0, 0, 0])
    )


def _driven(mbs, body, torque):
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=body))
    mbs.AddLoad(eii.Torque(markerNumber=marker, loadVector=[torque, 0.0, 0.0]))


def rigid_rotor(mbs):
    """Examples/rigidRotor3Drunup.py: a rotor out of balance under a torque, from four times its critical speed.

    A rigid shaft in two bearings: a ball joint and one that slides, each a film.
    """
    mass, off = 2.0, 0.74 * 2e-3
    ground = mbs.CreateGround()
    rotor = _disc(mbs, mass, 0.75, 0.2, [0.0, off, 0.0], 4.0 * math.sqrt(2.0 * STIFFNESS / mass))
    _driven(mbs, rotor, 0.2)
    ideal = [
        mbs.CreateGenericJoint(name, [ground, rotor], [x, 0, 0], constrainedAxes=[held, 1, 1, 0, 0, 0])
        for name, x, held in (("left", -HALF, 1), ("right", HALF, 0))
    ]

    def films(bearing):
        made = {}
        for number, x, axial in zip(ideal, (-HALF, HALF), (ehd.Held(), ehd.Free()), strict=True):
            mbs.SetObjectParameter(number, "activeConnector", False)
            made[int(number)] = ehd.CreateLubricatedJoint(
                mbs, f"film at {x}", [ground, rotor], [x, 0, 0], [1, 0, 0], bearing, axial=axial
            )
        return made

    return Model([rotor], ideal[0], films=films, torques=((rotor, (0.2, 0.0, 0.0)),))


def flexible_rotor(mbs):
    """Examples/flexibleRotor3Dtest.py: two discs with springs between them, each in one bearing, from four times the
    critical speed of the source.

    Films hold the directions of the shafts, the more the thinner they are: their limit are revolute joints, in which
    the springs between the discs twist.
    """
    width, off, stiffness = 0.1, 2e-3, 3200.0
    damping = 2.0 * math.sqrt(stiffness) * 0.2
    ground, speed = mbs.CreateGround(), 4.0 * math.sqrt(STIFFNESS)
    discs = [_disc(mbs, 1.0, 0.5, width, [x, off, 0.0], speed) for x in (-0.5 * width, 0.5 * width)]
    _driven(mbs, discs[0], 0.5)
    joint = mbs.CreateRevoluteJoint("left", [ground, discs[0]], [-HALF, 0, 0], [1, 0, 0])
    mbs.CreateGenericJoint("right", [ground, discs[1]], [HALF, 0, 0], constrainedAxes=[0, 1, 1, 0, 1, 1])
    springs = []
    for k in range(4):
        y, z = 0.5 * math.sin(0.5 * math.pi * k), 0.5 * math.cos(0.5 * math.pi * k)
        markers = [
            mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=disc, localPosition=[x, y, z]))
            for disc, x in zip(discs, (0.5 * width, -0.5 * width), strict=True)
        ]
        springs.append(
            mbs.AddObject(
                eii.CartesianSpringDamper(markerNumbers=markers, stiffness=[stiffness] * 3, damping=[damping] * 3)
            )
        )
    return Model(discs, joint, workers=springs, torques=((discs[0], (0.5, 0.0, 0.0)),))
