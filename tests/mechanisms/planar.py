"""Planar rotor on one lubricated bearing in ground, for tests."""

import math

import exudyn as exu
import exudyn.itemInterface as eii

import exudyn_ehd as ehd


class PlanarRotor:
    """A disc that turns at a prescribed speed and is free in x and y, in a bearing fixed to ground."""

    def __init__(self, bearing, *, mass, speed, load, position=(0.0, 0.0), velocity=(0.0, 0.0)):
        self.mbs = exu.SystemContainer().AddSystem()
        self.bearing = bearing
        mbs = self.mbs
        ground = mbs.AddObject(eii.ObjectGround())
        node = mbs.AddNode(
            eii.NodeRigidBody2D(
                referenceCoordinates=[0, 0, 0], initialCoordinates=[*position, 0], initialVelocities=[*velocity, speed]
            )
        )
        body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=1.0))
        origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
        angle = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
        self.drive = mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[origin, angle],
                offsetUserFunction=lambda mbs, t, item, offset: speed * t,
                offsetUserFunction_t=lambda mbs, t, item, offset: speed,
            )
        )
        centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
        mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[*load, 0]))
        self.joint = ehd.CreateLubricatedJoint(
            mbs, name="rotor bearing", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
        )
        mbs.Assemble()

    def run(self, end, step, *, spectral_radius=0.8, **options):
        """Integrate to ``end`` and return the joint's history."""
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = end
        settings.timeIntegration.numberOfSteps = math.ceil(end / step - 1e-9)
        settings.timeIntegration.generalizedAlpha.spectralRadius = spectral_radius
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings, **options)
        self.mbs.SolveDynamic(settings)
        return self.joint.history
