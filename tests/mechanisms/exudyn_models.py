"""Mechanisms of Exudyn's examples and test models, written anew from their data: masses, lengths, axes, loads.

`TABLE` has what they run on; ``python -m tests.mechanisms.exudyn_models`` prints the table of examples/README.md.

Source: J. Gerstmayr, Exudyn, github.com/jgerstmayr/EXUDYN, folder main/pythonDev, the file that every function names.
Each adds its bodies and ideal joints to a system and returns a `Model`.
"""

from __future__ import annotations

import dataclasses
import logging
import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.utilities import InertiaCuboid, RigidBodyInertia, RotationMatrixY, RotationMatrixZ

import exudyn_ehd as ehd

GRAVITY = 9.81


@dataclasses.dataclass
class Model:
    """What a test looks at: bodies, whose places and kinetic energy count, the joint whose force counts, and the
    potential of all loads and springs as a function of the system [J]."""

    bodies: Sequence[Any]
    joint: Any
    potential: Callable[[exu.MainSystem], float]


def _position(mbs, body, local=(0.0, 0.0, 0.0)):
    return np.array(mbs.GetObjectOutputBody(body, exu.OutputVariableType.Position, list(local)))


def _weight(bodies, masses, gravity, centres=None):
    """Potential of the weight of bodies with masses [kg] under a gravity (3,), at ``centres`` of mass."""
    places = [(0.0, 0.0, 0.0)] * len(bodies) if centres is None else centres
    return lambda mbs: (
        -sum(m * float(_position(mbs, b, x) @ gravity) for b, m, x in zip(bodies, masses, places, strict=True))
    )


def _planar(mbs, length, mass, place, angle, velocity=(0.0, 0.0, 0.0)):
    """Planar bar of a ``length``, slender."""
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[*place, angle], initialVelocities=list(velocity)))
    return mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=mass * length**2 / 12.0))


def _pin(mbs, first, second):
    """Ideal joint of two planar bodies, each given with its local x."""
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=b, localPosition=[x, 0.0, 0.0])) for b, x in (first, second)
    ]
    return mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))


def four_bars(mbs):
    """TestModels/fourBarMechanismIftomm.py: IFToMM's benchmark of two coupled four-bar linkages."""
    places = [([0, 0.5], 0.5), ([0.5, 1], 0), ([1, 0.5], 0.5), ([1.5, 1], 0), ([2, 0.5], 0.5)]
    bars = []
    for place, turns in places:
        upright = turns > 0
        velocity = [0.5, 0.0, -1.0] if upright else [1.0, 0.0, 0.0]
        bars.append(_planar(mbs, 1.0, 1.0, place, turns * math.pi, velocity))
        mbs.AddLoad(
            eii.LoadMassProportional(
                markerNumber=mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=bars[-1])), loadVector=[0, -GRAVITY, 0]
            )
        )
    ground, a = mbs.CreateGround(), 0.5
    first = _pin(mbs, (ground, 0.0), (bars[0], -a))
    for k in (1, 2):
        _pin(mbs, (ground, float(k)), (bars[2 * k], -a))
    for one, other in (((0, a), (1, -a)), ((1, a), (3, -a)), ((2, a), (3, -a)), ((3, a), (4, a))):
        _pin(mbs, (bars[one[0]], one[1]), (bars[other[0]], other[1]))
    return Model(bars, first, _weight(bars, [1.0] * 5, np.array([0, -GRAVITY, 0])))


def slider_crank(mbs):
    """Examples/SliderCrank.py: a crank under a torque, its slider a mass point."""
    half = 0.25, 0.5
    crank = _planar(mbs, 0.5, 2.0, [half[0], 0.0], 0.0)
    rod = _planar(mbs, 1.0, 4.0, [2 * half[0] + half[1], 0.0], 0.0)
    slider = mbs.CreateMassPoint(referencePosition=[1.5, 0.0, 0.0], mass=1.0, create2D=True)
    joint = _pin(mbs, (mbs.CreateGround(), 0.0), (crank, -half[0]))
    _pin(mbs, (crank, half[0]), (rod, -half[1]))
    _pin(mbs, (rod, half[1]), (slider, 0.0))
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
    crank = _planar(mbs, lengths[0], 0.2, [0.05, 0.0], 0.0)
    rod = _planar(mbs, lengths[1], 0.2, [0.25, 0.0], 0.0)
    slider_node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0.4, 0.0, 0.0]))
    slider = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=slider_node, mass=0.4, inertia=0.001 * 0.4))
    joint = _pin(mbs, (frame, 0.0), (crank, -0.05))
    _pin(mbs, (crank, 0.05), (rod, -0.15))
    _pin(mbs, (rod, 0.15), (slider, 0.0))
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
    return Model([crank, rod, slider], joint, _weight([crank, rod, slider], [0.12, 0.5, 2.0], gravity, centres))


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
    return Model(bodies, joints[0], _weight(bodies, [1.0] * 5, gravity, [(0.5, 0.0, 0.0)] * 5))


@dataclasses.dataclass(frozen=True, kw_only=True)
class Case:
    """A model and what it runs on.

    Viscosity is ``oil`` (Pa s/m2) times the square of the radial clearance: the Sommerfeld number then stays. Loads of
    joints are compared unless constraints share them in more than one way (``determinate``).
    """

    make: Callable[[exu.MainSystem], Model]
    span: float
    steps: int
    radius: float
    length: float
    oil: float
    options: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    determinate: bool = True

    def bearing(self, clearance: float) -> ehd.JournalBearing:
        """Bearing with a radial clearance [m]."""
        return ehd.JournalBearing(
            journal_radius=self.radius,
            length=self.length,
            radial_clearance=clearance,
            lubricant=ehd.Lubricant(viscosity=self.oil * clearance**2),
            film=ehd.FiniteLength(n_theta=32, n_z=6),
        )


# The spatial crank's one bearing is overhung: its tilt is held, as the ideal joint holds it.
TABLE = {
    "fourBarMechanismIftomm": Case(make=four_bars, span=0.4, steps=400, radius=0.02, length=0.02, oil=2e7),
    "SliderCrank": Case(make=slider_crank, span=0.4, steps=600, radius=0.02, length=0.02, oil=2e7),
    "sliderCrankFloatingTest": Case(make=floating_crank, span=0.2, steps=300, radius=0.02, length=0.02, oil=1e7),
    "sliderCrank3Dbenchmark": Case(
        make=spatial_crank, span=0.2, steps=400, radius=0.01, length=0.02, oil=5e7, options={"tilt": ehd.Held()}
    ),
    "bricardMechanism": Case(make=bricard, span=0.2, steps=200, radius=0.05, length=0.1, oil=2e7, determinate=False),
}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """End of a run.

    Attributes
    ----------
    places : ndarray (k, 3)
        Of the bodies [m].
    force : ndarray (3,)
        Of the model's joint, global, on its first body [N].
    lost, dissipated : float
        Mechanical energy that has gone; power loss of all films over time [J].
    joints, steps, iterations : int
        Films; steps in time, those halved included, and Newton's.
    eccentricity : float
        Largest eccentricity ratio.
    seconds : float
        CPU time.
    """

    places: np.ndarray
    force: np.ndarray
    lost: float
    dissipated: float
    joints: int
    steps: int
    iterations: int
    eccentricity: float
    seconds: float


def run(case: Case, clearance: float | None = None) -> Outcome:
    """Run a model on ideal joints, or with all its revolute joints on films of a radial clearance [m]."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    model = case.make(mbs)
    films = {} if clearance is None else ehd.ReplaceJoints(mbs, bearing=case.bearing(clearance), **case.options)
    sensor = films[int(model.joint)].AddSensor("Force") if films else None
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = case.span, case.steps
    settings.solution.file.write = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenDense
    settings.linearSolver.ignoreSingularJacobian = not case.determinate
    ehd.ConfigureSolver(settings)
    before, start = _energy(mbs, model), time.process_time()
    ehd.SolveDynamic(mbs, settings)
    seconds = time.process_time() - start
    records = [film.history for film in films.values()]
    counts = mbs.sys["dynamicSolver"].it
    return Outcome(
        places=np.array([_position(mbs, body) for body in model.bodies]),
        force=_force(mbs, model.joint) if sensor is None else mbs.GetSensorStoredData(sensor)[-1, 1:],
        lost=before - _energy(mbs, model),
        dissipated=sum(float(np.trapezoid(record.power_loss, record.time)) for record in records),
        joints=len(films),
        steps=records[0].time.size - 1 if records else case.steps,
        iterations=counts.newtonStepsCount,
        eccentricity=max((float(r.largest_eccentricity_ratio.max()) for r in records), default=0.0),
        seconds=seconds,
    )


def _energy(mbs: exu.MainSystem, model: Model) -> float:
    kind = exu.OutputVariableType.KineticEnergy
    moving = sum(float(mbs.GetObjectOutputBody(body, kind, [0.0, 0.0, 0.0])) for body in model.bodies)
    return moving + model.potential(mbs)


def _force(mbs: exu.MainSystem, joint: Any) -> np.ndarray:
    """Global force of an ideal joint on its first body."""
    output = exu.OutputVariableType
    if mbs.GetObject(joint)["objectType"] == "JointRevolute2D":
        return np.array(mbs.GetObjectOutput(joint, output.Force))
    frame = np.array(mbs.GetObjectOutput(joint, output.HomogeneousTransformation)).reshape(4, 4)
    return frame[:3, :3] @ mbs.GetObjectOutput(joint, output.ForceLocal)


def distance(one: Outcome, other: Outcome) -> tuple[float, float]:
    """Largest distance of places [m], and of the forces over the second one's."""
    force = np.linalg.norm(one.force - other.force) / np.linalg.norm(other.force)
    return float(np.abs(one.places - other.places).max()), float(force)


def main() -> None:
    """Print the table."""
    logging.getLogger("exudyn_ehd").setLevel("ERROR")
    exu.config.printToConsole = False
    run(TABLE["SliderCrank"], 40e-6)  # compiles
    for name, case in TABLE.items():
        ideal, coarse, fine, real = (run(case, c) for c in (None, 80e-6, 40e-6, 20e-6))
        far, near = distance(coarse, ideal), distance(fine, ideal)
        forces = f"{far[1]:.2%}, {near[1]:.2%}" if case.determinate else "not unique"
        places = f"{1e3 * far[0]:.3f}, {1e3 * near[0]:.3f}"
        print(
            f"| `{name}` | {real.joints} | {places} | {forces} | {real.eccentricity:.2f} "
            f"| {abs(real.lost / real.dissipated - 1.0):.2%} | {real.steps} ({case.steps}) | {real.iterations} "
            f"({ideal.iterations}) | {real.seconds:.2g} ({ideal.seconds:.1g}) |",
            flush=True,
        )


if __name__ == "__main__":
    main()
