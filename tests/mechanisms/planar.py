"""Planar rotor on one lubricated bearing in ground, for tests."""

import math

import exudyn as exu
import exudyn.itemInterface as eii

import exudyn_ehd as ehd


class PlanarRotor:
    """A disc that turns at a prescribed speed and is free in x and y, in a bearing fixed to ground.

    ``speed``: a number, or functions of time for angle and speed; ``load``: (2,), or a function of time.
    """

    def __init__(self, bearing, *, mass, speed, load, position=(0.0, 0.0), velocity=(0.0, 0.0)):
        self.mbs = exu.SystemContainer().AddSystem()
        self.bearing = bearing
        mbs = self.mbs
        angle_at, speed_at = speed if isinstance(speed, tuple) else (lambda t: speed * t, lambda t: speed)
        load_at = load if callable(load) else lambda t: load
        ground = mbs.AddObject(eii.ObjectGround())
        node = mbs.AddNode(
            eii.NodeRigidBody2D(
                referenceCoordinates=[0, 0, 0],
                initialCoordinates=[*position, 0],
                initialVelocities=[*velocity, speed_at(0.0)],
            )
        )
        body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=1.0))
        origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
        angle = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
        self.drive = mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[origin, angle],
                offsetUserFunction=lambda mbs, t, item, offset: angle_at(t),
                offsetUserFunction_t=lambda mbs, t, item, offset: speed_at(t),
            )
        )
        centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
        mbs.AddLoad(
            eii.LoadForceVector(
                markerNumber=centre,
                loadVector=[*load_at(0.0), 0],
                loadVectorUserFunction=(lambda mbs, t, value: [*load_at(t), 0.0]) if callable(load) else 0,
            )
        )
        self.joint = ehd.CreateLubricatedJoint(
            mbs, name="rotor bearing", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
        )
        mbs.Assemble()

    def run(self, end, step, *, spectral_radius=0.8, **options):
        """Integrate to ``end`` and return the joint's history."""
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = end
        settings.timeIntegration.numberOfSteps = math.ceil(end / step - 1e-9)
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings, spectralRadius=spectral_radius, **options)
        self.mbs.SolveDynamic(settings)
        return self.joint.history
