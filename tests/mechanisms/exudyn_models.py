"""Mechanisms of Exudyn's examples and test models, written anew from their data: masses, lengths, axes, loads.

`TABLE` has what they run on; ``python -m tests.mechanisms.exudyn_models`` prints the table of examples/README.md.

Source: J. Gerstmayr, Exudyn, github.com/jgerstmayr/EXUDYN, folder main/pythonDev, the file that every function names.
Each adds its bodies and ideal joints to a system and returns a `Model`.
"""

from __future__ import annotations

import dataclasses
import logging
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import exudyn as exu
import numpy as np

import exudyn_ehd as ehd
from tests.mechanisms.exudyn_data.machines import chain, hydraulic_arms, one_cylinder, scissors, two_cylinders
from tests.mechanisms.exudyn_data.model import Model, position
from tests.mechanisms.exudyn_data.planar import floating_crank, four_bars, slider_crank
from tests.mechanisms.exudyn_data.rotors import flexible_rotor, rigid_rotor
from tests.mechanisms.exudyn_data.spatial import bricard, spatial_crank


@dataclasses.dataclass(frozen=True, kw_only=True)
class Case:
    """A model and what it runs on.

    Viscosity is ``oil`` (Pa s/m2) times the square of the radial clearance: the Sommerfeld number then stays. Loads of
    joints are compared unless constraints share them in more than one way (``determinate``). Clearances are two to
    compare with ideal joints, and one for the energy.
    """

    make: Callable[[exu.MainSystem], Model]
    span: float
    steps: int
    radius: float
    length: float
    oil: float
    options: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    determinate: bool = True
    start: float = 0.0
    clearances: Sequence[float] = (80e-6, 40e-6, 20e-6)

    def bearing(self, clearance: float) -> ehd.JournalBearing:
        """Bearing with a radial clearance [m]."""
        return ehd.JournalBearing(
            journal_radius=self.radius,
            length=self.length,
            radial_clearance=clearance,
            lubricant=ehd.Lubricant(viscosity=self.oil * clearance**2),
            film=ehd.FiniteLength(n_theta=32, n_z=6),
        )


# The spatial crank's and the engines' one main bearing is overhung: its tilt is held, as the ideal joint holds it.
TABLE = {
    "fourBarMechanismIftomm": Case(make=four_bars, span=0.4, steps=400, radius=0.02, length=0.02, oil=2e7),
    "SliderCrank": Case(make=slider_crank, span=0.4, steps=600, radius=0.02, length=0.02, oil=2e7),
    "sliderCrankFloatingTest": Case(make=floating_crank, span=0.2, steps=300, radius=0.02, length=0.02, oil=1e7),
    "sliderCrank3Dbenchmark": Case(
        make=spatial_crank, span=0.2, steps=400, radius=0.01, length=0.02, oil=5e7, options={"tilt": ehd.Held()}
    ),
    "bricardMechanism": Case(make=bricard, span=0.2, steps=200, radius=0.05, length=0.1, oil=2e7, determinate=False),
    "scissorPrismaticRevolute2D": Case(make=scissors, span=0.5, steps=200, radius=0.02, length=0.02, oil=2e8),
    "pistonEngine, one cylinder": Case(
        make=one_cylinder, span=0.6, steps=300, radius=0.01, length=0.012, oil=5e7, options={"tilt": ehd.Held()}
    ),
    "pistonEngine, two cylinders": Case(
        make=two_cylinders, span=0.6, steps=300, radius=0.01, length=0.012, oil=5e7, options={"tilt": ehd.Held()}
    ),
    "HydraulicActuator2Arms": Case(
        make=hydraulic_arms, start=1.0 / 6.0, span=0.25, steps=300, radius=0.025, length=0.1, oil=5e8
    ),
    "rigidRotor3Drunup": Case(make=rigid_rotor, span=0.1, steps=400, radius=0.02, length=0.02, oil=4e7),
    "flexibleRotor3Dtest": Case(
        make=flexible_rotor, span=0.1, steps=400, radius=0.02, length=0.04, oil=1e8, clearances=(40e-6, 20e-6, 20e-6)
    ),
    "chainDriveExample": Case(
        make=chain, span=0.04, steps=400, radius=0.0015, length=0.012, oil=2e8, clearances=(14e-6, 7e-6, 14e-6)
    ),
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
        Mechanical energy that has gone and not come from elsewhere; power loss of all films over time [J].
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
    films: Mapping[int, ehd.LubricatedJoint] = {}
    if clearance is not None:
        bearing = case.bearing(clearance)
        films = model.films(bearing) if model.films else ehd.ReplaceJoints(mbs, bearing=bearing, **case.options)
    given: list[tuple[float, float]] = []
    if model.workers or model.torques or model.drive is not None:
        mbs.SetPostStepUserFunction(lambda mbs, t: not given.append((t, model.power(mbs))))
    sensor = films[int(model.joint)].AddSensor("Force") if films else None
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.startTime = case.start
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = case.start + case.span, case.steps
    settings.solution.file.write = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenDense
    settings.linearSolver.ignoreSingularJacobian = not case.determinate
    ehd.ConfigureSolver(settings)
    before, start = model.energy(mbs), time.process_time()
    ehd.SolveDynamic(mbs, settings)
    seconds = time.process_time() - start
    records = [film.history for film in films.values()]
    counts = mbs.sys["dynamicSolver"].it
    return Outcome(
        places=np.array([position(mbs, body) for body in model.bodies]),
        force=_force(mbs, model.joint) if sensor is None else mbs.GetSensorStoredData(sensor)[-1, 1:],
        lost=before - model.energy(mbs) + (float(np.trapezoid(*np.transpose(given)[::-1])) if given else 0.0),
        dissipated=sum(float(np.trapezoid(record.power_loss, record.time)) for record in records),
        joints=len(films),
        steps=records[0].time.size - 1 if records else case.steps,
        iterations=counts.newtonStepsCount,
        eccentricity=max((float(r.largest_eccentricity_ratio.max()) for r in records), default=0.0),
        seconds=seconds,
    )


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


def outcomes(case: Case) -> tuple[Outcome, Outcome, Outcome, Outcome]:
    """On ideal joints, and with the three clearances."""
    coarse, fine, real = case.clearances
    second = run(case, fine)
    return run(case), run(case, coarse), second, second if real == fine else run(case, real)


def energy_error(real: Outcome, ideal: Outcome) -> float:
    """Error of the energy balance over the energy that the films dissipate. The error of the run without films (of its
    integrator, and the sum over time of the power of springs and drives) is subtracted."""
    return abs((real.lost - ideal.lost) / real.dissipated - 1.0)


def main() -> None:
    """Print the table."""
    logging.getLogger("exudyn_ehd").setLevel("ERROR")
    exu.config.printToConsole = False
    run(TABLE["SliderCrank"], 40e-6)  # compiles
    for name, case in TABLE.items():
        ideal, coarse, fine, real = outcomes(case)
        far, near = distance(coarse, ideal), distance(fine, ideal)
        forces = f"{far[1]:.2%}, {near[1]:.2%}" if case.determinate else "not unique"
        places = f"{1e3 * far[0]:.3g}, {1e3 * near[0]:.3g}"
        clearances = ", ".join(f"{1e6 * c:.0f}" for c in case.clearances)
        print(
            f"| `{name}` | {real.joints} | {clearances} | {places} | {forces} | {real.eccentricity:.2f} "
            f"| {energy_error(real, ideal):.2%} | {real.steps} ({case.steps}) | {real.iterations} "
            f"({ideal.iterations}) | {real.seconds:.2g} ({ideal.seconds:.1g}) |",
            flush=True,
        )


if __name__ == "__main__":
    main()
