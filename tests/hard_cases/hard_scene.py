"""Scenes of the hard cases: a rotor on one lubricated bearing, and runs that count what the solver did."""

from __future__ import annotations

import dataclasses
import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

import exudyn_ehd as ehd

RADIUS, LENGTH, CLEARANCE, VISCOSITY = 0.025, 0.025, 50e-6, 0.02
SPEED = 100.0 * math.pi


def bearing(**options):
    """R = 25 mm, L = 25 mm, c = 50 um, 0.02 Pa s on a small grid; everything can be replaced."""
    values = {
        "journal_radius": RADIUS,
        "length": LENGTH,
        "radial_clearance": CLEARANCE,
        "film": ehd.FiniteLength(n_theta=64, n_z=8),
    }
    if "lubricant" not in options:
        options["lubricant"] = ehd.Lubricant(viscosity=options.pop("viscosity", VISCOSITY))
    return ehd.JournalBearing(**(values | options))


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Run:
    """One run of Exudyn's solver.

    Attributes
    ----------
    histories : tuple of JointHistory
        One per joint.
    steps, rejected, newton : int
        Accepted steps, attempts that were not accepted, Newton iterations of all of them.
    error : Exception or None
        What ended the run.
    """

    histories: tuple[ehd.JointHistory, ...]
    steps: int
    rejected: int
    newton: int
    error: Exception | None = None

    @property
    def history(self) -> ehd.JointHistory:
        """History of the first joint."""
        return self.histories[0]

    @property
    def minimum_gap(self) -> float:
        """Minimum film thickness of all joints and steps, m; negative where surfaces press into each other."""
        return min(float(h.minimum_gap.min()) for h in self.histories)


def settings(end, step, *, start=0.0, spectral_radius=0.8, **options):
    """Exudyn's settings as `ConfigureSolver` makes them."""
    s = exu.SimulationSettings()
    s.timeIntegration.startTime = start
    s.timeIntegration.endTime = end
    s.timeIntegration.numberOfSteps = math.ceil((end - start) / step - 1e-9)
    s.timeIntegration.verboseMode = 0
    s.solution.file.write = False
    return ehd.ConfigureSolver(s, spectralRadius=spectral_radius, **options)


def solve(mbs, joints, simulation_settings, *, solver=None, fails=False, restart=None):
    """Run a dynamic solver; every value that the joints recorded must be finite.

    ``fails``: the run must end with the package's error, which is returned in the run.
    """
    attempts = [0]

    def count(mbs, t):
        attempts[0] += 1
        return True

    mbs.SetPreStepUserFunction(count)
    error = None
    try:
        ehd.SolveDynamic(
            mbs, simulation_settings, restart=restart, **({} if solver is None else {"solverType": solver})
        )
    except ehd.FilmError as caught:
        if not fails:
            raise
        error = caught
    assert fails == (error is not None), "the run should have ended with an error"
    mbs.SetPreStepUserFunction(0)
    it = mbs.sys["dynamicSolver"].it
    histories = tuple(joint.history for joint in joints)
    for history in histories:
        assert_finite(history)
    start = simulation_settings.timeIntegration.startTime
    # a run that starts at the end of the record goes on with it
    steps = int(np.count_nonzero(histories[0].time > start))
    assert steps > 0 or fails
    return Run(
        histories=histories, steps=steps, rejected=attempts[0] - steps, newton=int(it.newtonStepsCount), error=error
    )


_MAY_BE_ABSENT = (
    "supply_flow",
    "lowest_pocket_pressure",
    "highest_pocket_pressure",
    "film_temperature",
    "peak_temperature",
    "sump_temperature",
    "peak_pressure",
    "leakage",
    "contact_torque",
    "bore_displacement",
    "bush_temperature",
    "wear_depth",
    "worn_volume",
    "journal_temperature",
    "clearance",
    "axial_position",
)


def assert_finite(history):
    """No value of an accepted step is nan or infinite; a column that the film does not provide is nan throughout."""
    for field in dataclasses.fields(history):
        values = getattr(history, field.name)
        # unknown in the first steps
        if field.name == "step_error":
            continue
        may_be_absent = field.name in _MAY_BE_ABSENT or field.name.startswith("thrust_")
        if may_be_absent and np.all(np.isnan(values)):
            continue
        assert np.all(np.isfinite(values)), f"{field.name}: {np.argwhere(~np.isfinite(values))[:3].tolist()}"


class Rotor:
    """A rigid rotor whose journal runs in one lubricated bearing.

    Parameters
    ----------
    bearing : JournalBearing
    mass : float
        kg.
    load : (float, float) or callable
        N, constant or a function of time.
    speed : float or (callable, callable)
        Prescribed spin, rad/s, or angle and spin as functions of time; None: free, with ``spin`` at the start.
    position, velocity : (float, float)
        Of the journal at the start, m and m/s.
    tilt : (float, float)
        Slopes of its axis at the start (spatial rotors).
    spatial : bool
        Six degrees of freedom in place of three; the load then acts at ``load_z``.
    inertia : float
        About the axis, kg m2; spatial rotors have half of it about the others.
    housing : callable
        Function of the system that returns the housing's object; None: ground.
    """

    def __init__(
        self,
        bearing,
        *,
        mass=2.0,
        load=(0.0, 0.0),
        speed=SPEED,
        position=(0.0, 0.0),
        velocity=(0.0, 0.0),
        tilt=(0.0, 0.0),
        spatial=False,
        load_z=0.0,
        inertia=1e-3,
        spin=0.0,
        housing=None,
        name="rotor bearing",
        step_control=None,
    ):
        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        self.bearing, self.mass, self.load = bearing, mass, load if callable(load) else (lambda t: load)
        self.housing = mbs.AddObject(eii.ObjectGround()) if housing is None else housing(mbs)
        angle = None if speed is None else speed if isinstance(speed, tuple) else (lambda t: speed * t, lambda t: speed)
        start = spin if angle is None else angle[1](0.0)
        if spatial:
            self.node = mbs.AddNode(
                eii.NodeRigidBodyRxyz(
                    referenceCoordinates=[0.0] * 6,
                    initialCoordinates=[*position, 0.0, -tilt[1], tilt[0], 0.0],
                    initialVelocities=[*velocity, 0.0, 0.0, 0.0, start],
                )
            )
            self.body = mbs.AddObject(
                eii.ObjectRigidBody(
                    mass=mass, inertia=[inertia / 2, inertia / 2, inertia, 0, 0, 0], nodeNumber=self.node
                )
            )
        else:
            self.node = mbs.AddNode(
                eii.NodeRigidBody2D(
                    referenceCoordinates=[0, 0, 0],
                    initialCoordinates=[*position, 0.0],
                    initialVelocities=[*velocity, start],
                )
            )
            self.body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=self.node, mass=mass, inertia=inertia))
        if angle is not None:
            self._turn(angle, 5 if spatial else 2)
        centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=self.body, localPosition=[0.0, 0.0, load_z]))
        function = self.load
        mbs.AddLoad(
            eii.LoadForceVector(
                markerNumber=centre,
                loadVector=[0.0, 0.0, 0.0],
                loadVectorUserFunction=lambda mbs, t, vector: [*function(t), 0.0],
            )
        )
        self.joint = ehd.CreateLubricatedJoint(
            mbs,
            name=name,
            itemNumbers=[self.housing, self.body],
            position=[0, 0, 0],
            axis=[0, 0, 1],
            bearing=bearing,
            stepControl=step_control,
        )

    def _turn(self, angle, coordinate):
        mbs = self.mbs
        origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
        turned = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=self.node, coordinate=coordinate))
        mbs.AddObject(
            eii.ObjectConnectorCoordinate(
                markerNumbers=[origin, turned],
                offsetUserFunction=lambda mbs, t, item, offset: float(angle[0](t)),
                offsetUserFunction_t=lambda mbs, t, item, offset: float(angle[1](t)),
            )
        )

    def spring(self, coordinate, stiffness, damping=0.0, rest=0.0):
        """Spring and damper from a coordinate of the rotor to ground."""
        mbs = self.mbs
        origin = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0))
        moved = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=self.node, coordinate=coordinate))
        mbs.AddObject(
            eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[origin, moved], stiffness=stiffness, damping=damping, offset=rest
            )
        )

    def run(self, end, step, *, solver=None, fails=False, restart=None, **options):
        """Integrate to ``end``; options go to `settings`."""
        if not self.mbs.systemIsConsistent:
            self.mbs.Assemble()
        return solve(
            self.mbs, [self.joint], settings(end, step, **options), solver=solver, fails=fails, restart=restart
        )

    def momentum_error(self, history):
        """Momentum gained minus impulse of film and load, over the impulses:
        the steps' own equation of motion, integrated.

        Second order in the step; holds for rotors that only film and load act on.
        """
        t = history.time
        load = np.array([self.load(s) for s in t])
        force = history.force[:, :2] + load
        impulse = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(t)[:, None], axis=0)
        gained = self.mass * (history.motion[-1, 4:6] - history.motion[0, 4:6])
        size = np.sum(np.diff(t) * 0.5 * (np.hypot(*load[1:].T) + np.hypot(*load[:-1].T)))
        size += np.sum(np.diff(t) * np.hypot(*history.force[1:, :2].T))
        return float(np.hypot(*(gained - impulse))) / size
