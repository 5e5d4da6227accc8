"""Spatial mechanisms of Exudyn."""

from __future__ import annotations

import math

import exudyn as exu
import numpy as np
from exudyn.utilities import InertiaCuboid, RigidBodyInertia, RotationMatrixY, RotationMatrixZ

from tests.mechanisms.exudyn_data.model import GRAVITY, Model, weight


def spatial_crank(mbs):
    """TestModels/sliderCrank3Dbenchmark.py: the spatial slider-crank of the IFToMM library, with its one revolute.

    The source's angular velocity of the rod violates the cardan joint by 0.48 rad/s, which costs 0.1 mJ in the first
    step; here it does not turn about the axis that the joint holds.
    """
    crank_length, rod_length, y, z = 0.08, 0.3, 0.1, 0.12
    pin = np.array([0.0, y, z + crank_length])
    end = np.array([math.sqrt(rod_length**2 - y**2 - (z + crank_length) ** 2), 0.0, 0.0])
    along = (end - pin) / rod_length
    across = pin - along * (along @ pin)
    across /= np.linalg.norm(across)
    turn = np.column_stack([along, -np.cross(along, across), across])
    gravity = np.array([0.0, 0.0, -GRAVITY])
    kinds = {"gravity": gravity.tolist(), "nodeType": exu.NodeType.RotationEulerParameters}
    crank = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(0.12, np.diag([1e-4, 1e-4, 1e-5])).Translated([0.0, 0.0, 0.5 * crank_length]),
        referencePosition=[0.0, y, z],
        initialAngularVelocity=[6.0, 0.0, 0.0],
        **kinds,
    )
    rod = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(0.5, np.diag([4e-4, 4e-3, 4e-3])),
        referencePosition=(0.5 * (pin + end)).tolist(),
        referenceRotationMatrix=turn,
        initialVelocity=[0.12, -0.24, 0.0],
        initialAngularVelocity=[2.4, -1.2, 0.0],
        **kinds,
    )
    slider = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(2.0, np.diag([1e-4] * 3)),
        referencePosition=end.tolist(),
        initialVelocity=[0.24, 0.0, 0.0],
        **kinds,
    )
    ground = mbs.CreateGround()
    joint = mbs.CreateGenericJoint("main", [ground, crank], [0.0, y, z], constrainedAxes=[1, 1, 1, 0, 1, 1])
    mbs.CreateGenericJoint("guide", [ground, slider], end.tolist(), constrainedAxes=[0, 1, 1, 1, 1, 1])
    mbs.CreateGenericJoint("ball", [crank, rod], pin.tolist(), constrainedAxes=[1, 1, 1, 0, 0, 0])
    mbs.CreateGenericJoint("cardan", [rod, slider], end.tolist(), constrainedAxes=[1, 1, 1, 0, 0, 1])
    centres = [(0.0, 0.0, 0.5 * crank_length), (0, 0, 0), (0, 0, 0)]
    return Model([crank, rod, slider], joint, weight([crank, rod, slider], [0.12, 0.5, 2.0], gravity, centres))


def bricard(mbs):
    """TestModels/bricardMechanism.py: a closed loop of six revolutes that turns although it is overconstrained."""
    inertia = InertiaCuboid(density=100.0, sideLengths=[1.0, 0.1, 0.1]).Translated([0.5, 0.0, 0.0])
    places = [[0, 0, 0], [1, 0, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1], [0, 0, 1]]
    half = 0.5 * math.pi
    turns = [np.eye(3), RotationMatrixZ(-half), RotationMatrixY(-half), RotationMatrixZ(math.pi), RotationMatrixZ(half)]
    axes = [[0, 1, 0], [0, 0, 1], [1, 0, 0]] * 2
    gravity = np.array([0.0, -GRAVITY, 0.0])
    ground = mbs.CreateGround()
    links, joints = [ground], []
    for k in range(6):
        if k < 5:
            links.append(
                mbs.CreateRigidBody(
                    inertia=inertia,
                    referencePosition=places[k],
                    referenceRotationMatrix=turns[k],
                    gravity=gravity.tolist(),
                )
            )
        items = [links[k], links[k + 1] if k < 5 else ground]
        joints.append(mbs.CreateRevoluteJoint(f"hinge {k}", items, places[k], axes[k]))
    bodies = links[1:]
    return Model(bodies, joints[0], weight(bodies, [1.0] * 5, gravity, [(0.5, 0.0, 0.0)] * 5))
