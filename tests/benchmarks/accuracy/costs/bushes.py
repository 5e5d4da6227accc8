"""Cost of a bush under a film: steps and Newton iterations of a run, the film's Jacobian, assembly of its elements.

A free journal of 6.6 kg on six coordinates (R 30 mm, L 66 mm, c 30 um, 9 mPa s, 3000 rpm, film 80 x 16, steel bush of
20 mm) under a load of 15 kN that swings at the speed of rotation, h = 0.1 ms, Newton to 1e-6; tilted cases load it
next to its middle. Runs of all bores take turns in a process; times are process times, factors those of one process.
Several processes, one after the other, tell how much these differ from one to the next: more than from turn to turn,
since the products of modal bushes feel what else shares the processor's caches.
"""

from __future__ import annotations

import math
import multiprocessing
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from exudyn.utilities import InertiaCylinder

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.api import CreateLubricatedJoint, Held
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.coupling.run.sparse import SolveDynamicSparse
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import ANCFBush, ModalBush, bore_modes
from exudyn_ehd.solid.elements.element import GAUSS27, IRONS14, Quadrature
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff, TotalLagrange
from exudyn_ehd.status import EHDError
from tests.benchmarks.accuracy.errors.study import Progress
from tests.benchmarks.accuracy.scenes.measured import STEEL
from tests.benchmarks.accuracy.table import Cost, costs_of_blocks

CLEARANCE, SPEED, LOAD, STEP = 30e-6, 100.0 * math.pi, 15e3, 1e-4
RIGID, RIGID_TILTED = "rigid", "rigid, tilted"
STEP_TIME, JACOBIAN, ASSEMBLY = "step", "film Jacobian", "force, tangent and sparse matrix"
# Where the load acts along the axis when it tilts the journal, m.
OFFSET = 3e-3


def cylinder(axial: int, radial: int, circumferential: int) -> HollowCylinder:
    """The bush, 20 mm thick."""
    return HollowCylinder(
        inner_radius=0.03, thickness=0.02, length=0.066, axial=axial, radial=radial, circumferential=circumferential
    )


def modal(tolerance: float, tilted: bool) -> ModalBush:
    """Modes of 4 x 2 x 40 elements.

    With the tolerance 0.1 peak pressure and minimum film thickness are within 0.5 % of those with 0.005, up to an
    eccentricity ratio of 0.93.
    """
    return ModalBush(mesh=cylinder(4, 2, 40), material=STEEL, tolerance=tolerance, tilted=tilted)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A bore in the run of ``steps`` steps; its cost is compared with that of ``base``."""

    bush: Any
    steps: int
    tilted: bool
    base: str = RIGID
    solver: Any = exu.LinearSolverType.EigenDense

    @property
    def sparse(self) -> bool:
        """True if a mesh is part of the model."""
        return isinstance(self.bush, ANCFBush)


CASES: dict[str, Case] = {
    RIGID: Case(bush=None, steps=60, tilted=False, base=""),
    RIGID_TILTED: Case(bush=None, steps=60, tilted=True, base=""),
    "`ElasticLiner`": Case(
        bush=ElasticLiner(thickness=0.02, youngs_modulus=STEEL.youngs_modulus, poisson_ratio=STEEL.poisson_ratio),
        steps=60,
        tilted=False,
    ),
    "`ModalBush`": Case(bush=modal(0.1, False), steps=60, tilted=False),
    "`ModalBush`, tilted": Case(bush=modal(0.1, True), steps=60, tilted=True, base=RIGID_TILTED),
    "`ModalBush`, tilted, Exudyn's default solver": Case(
        bush=modal(0.1, True), steps=60, tilted=True, base=RIGID_TILTED, solver=exu.LinearSolverType.EXUdense
    ),
    "`ANCFBush`, 4 x 1 x 24 elements": Case(
        bush=ANCFBush(mesh=cylinder(4, 1, 24), material=STEEL), steps=20, tilted=True, base=RIGID_TILTED
    ),
    "`ANCFBush`, 4 x 2 x 40 elements": Case(
        bush=ANCFBush(mesh=cylinder(4, 2, 40), material=STEEL), steps=10, tilted=True, base=RIGID_TILTED
    ),
}
ASSEMBLIES: dict[str, Quadrature] = {"320 elements, 27 points": GAUSS27, "320 elements, 14 points": IRONS14}


def bearing(bush: Any) -> JournalBearing:
    """The bearing with a bush."""
    return JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=CLEARANCE,
        lubricant=Lubricant(viscosity=9e-3),
        film=FiniteLength(n_theta=80, n_z=16),
        bush=bush,
    )


def scene(bush: Any, offset: float) -> Any:
    """The assembled model; the load acts ``offset`` (m) from the middle along the axis."""
    mbs = exu.SystemContainer().AddSystem()
    journal = mbs.CreateRigidBody(
        initialDisplacement=[0.4 * CLEARANCE, -0.5 * CLEARANCE, 0.0],
        initialAngularVelocity=[0, 0, SPEED],
        inertia=InertiaCylinder(7800, 0.3, 0.03, 2),
    )
    CreateLubricatedJoint(
        mbs,
        name="bearing",
        itemNumbers=[mbs.CreateGround(), journal],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing(bush),
        axial=Held(),
    )
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=journal, localPosition=[0, 0, offset]))

    def swing(mbs: Any, t: float, vector: Any) -> list[float]:
        return [0.4 * LOAD * math.sin(SPEED * t), -LOAD * (1 - 0.3 * math.cos(SPEED * t)), 0]

    mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, -LOAD, 0], loadVectorUserFunction=swing))
    mbs.Assemble()
    return mbs


def settings(steps: int, solver: Any = exu.LinearSolverType.EigenDense) -> Any:
    """Settings of a run with this number of steps; ``solver`` solves the linear equations."""
    chosen: Any = ConfigureSolver(exu.SimulationSettings())
    chosen.timeIntegration.endTime, chosen.timeIntegration.numberOfSteps = steps * STEP, steps
    chosen.timeIntegration.verboseMode = 0
    chosen.solution.file.write = False
    chosen.linearSolver.solverType = solver
    return chosen


def seconds(function: Callable[[], Any]) -> float:
    """Processor time of one call, s."""
    start = time.process_time()
    function()
    return time.process_time() - start


def run(case: Case, steps: int) -> tuple[float, float]:
    """Processor time per step in s, and Newton iterations per step."""
    mbs = scene(case.bush, OFFSET if case.tilted else 0.0)
    if case.sparse:
        start = time.process_time()
        done = SolveDynamicSparse(mbs, settings(steps))
        return (time.process_time() - start) / steps, done.iterations / done.steps
    chosen = settings(steps, case.solver)
    spent = seconds(lambda: mbs.SolveDynamic(chosen))
    return spent / steps, mbs.sys["dynamicSolver"].it.newtonStepsCount / steps


def jacobian_run(bush: ModalBush) -> tuple[int, Callable[[], Any]]:
    """Modes of a bush and a call that gives the film's Jacobian about them."""
    model: Any = build_model(bearing(bush))
    k = model.bore.size
    place = [0.6 * CLEARANCE, 0.2 * CLEARANCE, 1e-4, -1e-4, 1e-4, -2e-4, 1e-3, 2e-3, SPEED, 0.0]
    evaluation = model.evaluate(np.concatenate((place, np.zeros(2 * k))))
    return k, lambda: evaluation.combined_tangent(1e-9, 1e-4)


def deformed_solid(rule: Quadrature, *, parallel: bool = False) -> tuple[TotalLagrange, np.ndarray]:
    """A hollow cylinder of 4 x 2 x 40 elements, and displacements of its nodes."""
    mesh = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=4, radial=2, circumferential=40).mesh()
    material = SaintVenantKirchhoff(youngs_modulus=1e6, poisson_ratio=0.3, density=7800.0)
    displacements = 1e-3 * np.random.default_rng(20).standard_normal(mesh.nodes.shape)
    return TotalLagrange(mesh=mesh, material=material, quadrature=rule, parallel=parallel), displacements


def assembly_run(rule: Quadrature, *, parallel: bool = False) -> Callable[[], Any]:
    """A call that gives force and tangent of `deformed_solid`."""
    solid, displacements = deformed_solid(rule, parallel=parallel)
    return lambda: (solid.force(displacements), solid.tangent(displacements))


@dataclass
class Block:
    """Measurements of one process.

    Attributes
    ----------
    steps, jacobians, assemblies : dict
        Times by name, s.
    iterations, modes : dict
        Newton iterations per step; modes of the modal bushes.
    failures : dict
        What went wrong, by name.
    """

    steps: dict[str, float] = field(default_factory=dict)
    jacobians: dict[str, float] = field(default_factory=dict)
    assemblies: dict[str, float] = field(default_factory=dict)
    iterations: dict[str, float] = field(default_factory=dict)
    modes: dict[str, float] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)


def measure_block(cases: Mapping[str, Case], turns: int, share: float) -> Block:
    """Every case in ``turns`` turns of ``share`` of its steps, Jacobians and assemblies, in this process.

    The time per step is the mean over the turns.
    """
    out = Block()
    for turn in range(turns + 1):
        for name, case in cases.items():
            if name in out.failures:
                continue
            # the first turn compiles and builds
            steps = 3 if turn == 0 else max(3, round(share * case.steps))
            try:
                spent, iterations = run(case, steps)
            except (EHDError, ValueError, RuntimeError) as error:
                out.failures[name] = str(error).splitlines()[0]
                out.steps.pop(name, None)
                continue
            if turn > 0:
                out.steps[name] = out.steps.get(name, 0.0) + spent / turns
                out.iterations[name] = iterations
    modal_cases = {name: case for name, case in cases.items() if isinstance(case.bush, ModalBush)}
    out.modes = {name: float(bore_modes(case.bush).count) for name, case in modal_cases.items()}
    calls = {name: jacobian_run(case.bush)[1] for name, case in modal_cases.items() if case.solver == Case.solver}
    out.jacobians = best_in_turns(calls, 40)
    out.assemblies = best_in_turns({name: assembly_run(rule) for name, rule in ASSEMBLIES.items()}, 8)
    return out


def measure_bushes(
    names: Mapping[str, Case] = CASES,
    *,
    blocks: int = 5,
    turns: int = 2,
    share: float = 1.0,
    progress: Progress = print,
) -> list[Cost]:
    """Cost of bores in a run, of the Jacobians of the modal ones, and of the elements' assembly.

    Parameters
    ----------
    names : mapping of `Case`
    blocks : int
        Processes, each of them new: scripts that call this must guard what they run by ``if __name__ == "__main__"``.
    turns : int
        Timed runs of every case in a process.
    share : float
        Of every case's steps.
    progress : function
        Gets a line per process.
    """
    found: list[Block] = []
    for block in range(blocks):
        progress(f"bushes: process {block + 1} of {blocks}")
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
            found.append(pool.submit(measure_block, dict(names), turns, share).result())
    failures = {name: text for block in found for name, text in block.failures.items()}
    last = found[-1]
    bases = {name: case.base for name, case in names.items() if case.base}
    times = {name: [block.steps[name] for block in found] for name in names if name not in failures}
    out = costs_of_blocks(STEP_TIME, times, bases, iterations=last.iterations, modes=last.modes)
    out += [Cost(what=name, per=STEP_TIME, failure=text) for name, text in failures.items()]
    times = {name: [block.jacobians[name] for block in found] for name in last.jacobians}
    out += costs_of_blocks(JACOBIAN, times, {}, modes=last.modes)
    times = {name: [block.assemblies[name] for block in found] for name in last.assemblies}
    return out + costs_of_blocks(ASSEMBLY, times, {})


def best_in_turns(calls: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Best processor time of every call in ``rounds`` rounds that alternate between them, s."""
    best = dict.fromkeys(calls, math.inf)
    for name in calls:
        calls[name]()
    for _ in range(rounds):
        for name, call in calls.items():
            best[name] = min(best[name], seconds(call))
    return best
