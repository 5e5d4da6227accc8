"""Common record of Exudyn's models: the parts that a test looks at, and the work of the other parts."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

import exudyn_ehd as ehd

GRAVITY = 9.81


@dataclasses.dataclass
class Model:
    """Parts of a model that a test looks at.

    Attributes
    ----------
    bodies : sequence
        Whose places and kinetic energy count.
    joint : object number
        The ideal joint whose force counts.
    potential : function of the system
        Of the loads and springs that have one [J].
    workers : sequence of object numbers
        Springs, dampers, actuators and contacts, whose power is taken from their generalised forces.
    torques : sequence of pairs
        Bodies under global torques (3,) [N m].
    drive : object number, optional
        A coordinate constraint that prescribes a velocity.
    films : function of a bearing, optional
        Puts the films in, where `ReplaceJoints` can't; returns them by the numbers of the ideal joints.
    """

    bodies: Sequence[Any]
    joint: Any
    potential: Callable[[exu.MainSystem], float] = lambda mbs: 0.0
    workers: Sequence[Any] = ()
    torques: Sequence[tuple[Any, Sequence[float]]] = ()
    drive: Any = None
    films: Callable[[ehd.JournalBearing], Mapping[int, ehd.LubricatedJoint]] | None = None

    def energy(self, mbs: exu.MainSystem) -> float:
        """Kinetic energy and potential [J]."""
        kind = exu.OutputVariableType.KineticEnergy
        moving = sum(float(mbs.GetObjectOutputBody(body, kind, [0.0, 0.0, 0.0])) for body in self.bodies)
        return moving + self.potential(mbs)

    def power(self, mbs: exu.MainSystem) -> float:
        """Power that workers, torques and drive put into the bodies [W]."""
        output = exu.OutputVariableType
        speeds = mbs.systemData.GetODE2Coordinates_t()
        given = sum(
            float(np.dot(torque, mbs.GetObjectOutputBody(body, output.AngularVelocity, [0, 0, 0])))
            for body, torque in self.torques
        )
        for worker in self.workers:
            forces = np.ravel(mbs.ComputeItem(worker, exu.ComputeItemType.ODE2LHS))
            given -= float(forces @ speeds[np.array(mbs.systemData.GetObjectLTGODE2(worker))])
        if self.drive is not None:
            given -= float(
                mbs.GetObjectOutput(self.drive, output.Force) * mbs.GetObjectOutput(self.drive, output.Velocity)
            )
        return given


def position(mbs, body, local=(0.0, 0.0, 0.0)):
    return np.array(mbs.GetObjectOutputBody(body, exu.OutputVariableType.Position, list(local)))


def weight(bodies, masses, gravity, centres=None):
    """Potential of the weight of bodies with masses [kg] under a gravity (3,), at ``centres`` of mass."""
    places = [(0.0, 0.0, 0.0)] * len(bodies) if centres is None else centres
    return lambda mbs: (
        -sum(m * float(position(mbs, b, x) @ gravity) for b, m, x in zip(bodies, masses, places, strict=True))
    )


def planar(mbs, length, mass, place, angle, velocity=(0.0, 0.0, 0.0)):
    """Planar bar of a ``length``, slender."""
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[*place, angle], initialVelocities=list(velocity)))
    return mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=mass * length**2 / 12.0))


def pin(mbs, first, second):
    """Ideal joint of two planar bodies, each given with its local x."""
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=b, localPosition=[x, 0.0, 0.0])) for b, x in (first, second)
    ]
    return mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))
