"""Growth of cost with the film's grid, the modes of a bush and the joints in a model: times and fitted exponents.

``t ~ n^k``: k is the slope of a straight line through log t over log n. Processor time of one thread, median of several
rounds in turns.
"""

from __future__ import annotations

import math
import pathlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.film.cavitation.closures import ElrodAdams, SwiftStieber
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.tables import format_seconds
from tests.benchmarks.accuracy.scenes import mechanisms
from tests.benchmarks.accuracy.scenes.measured import STEEL
from tests.benchmarks.accuracy.table import read_rows, write_rows

RADIUS, CLEARANCE, SPEED = 0.03, 30e-6, 100.0 * math.pi
GRIDS = ((48, 8), (96, 16), (192, 32), (288, 48))
TOLERANCES = (0.2, 0.08, 0.04, 0.02, 0.01, 0.005)
JOINTS = (1, 10, 100)
STEPS = 20
HEAD = ("what", "size", "n", "seconds", "exponent", "last_exponent")


@dataclass(frozen=True, kw_only=True)
class Growth:
    """Times (s) over a size, and the exponent fitted to them.

    Attributes
    ----------
    name, size_name : str
    sizes : tuple of int
    seconds : tuple of float
    """

    name: str
    size_name: str
    sizes: tuple[int, ...]
    seconds: tuple[float, ...]

    @property
    def exponent(self) -> float:
        """k of t ~ n^k."""
        return exponent(self.sizes, self.seconds)

    @property
    def last_exponent(self) -> float:
        """k between the two largest sizes."""
        return exponent(self.sizes[-2:], self.seconds[-2:])


def exponent(sizes: tuple[int, ...], seconds: tuple[float, ...]) -> float:
    """Slope of log t over log n."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def measure(runs: Mapping[int, Callable[[], None]], repeats: int) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Median time of every run, all in turns; the first round is not counted."""
    times: dict[int, list[float]] = {n: [] for n in runs}
    for round_ in range(repeats + 1):
        for n, run in runs.items():
            start = time.process_time()
            run()
            if round_ > 0:
                times[n].append(time.process_time() - start)
    return tuple(times), tuple(float(np.median(t)) for t in times.values())


def plain_bearing(**options: Any) -> JournalBearing:
    """A steel-like journal, L/D 1.1, c/R 1e-3, 9 mPa s."""
    values: dict[str, Any] = {
        "journal_radius": RADIUS,
        "length": 0.066,
        "radial_clearance": CLEARANCE,
        "lubricant": Lubricant(viscosity=9e-3),
    }
    return JournalBearing(**(values | options))


def motions(count: int = 12) -> np.ndarray:
    """Positions at eccentricity ratio 0.8, a degree apart, on a path of a third of the spin."""
    angle = 0.3 + np.radians(np.arange(count))
    e, v = 0.8 * CLEARANCE, 0.3 * SPEED * 0.8 * CLEARANCE
    out = np.zeros((count, 10))
    out[:, 0], out[:, 1] = e * np.cos(angle), e * np.sin(angle)
    out[:, 4], out[:, 5] = -v * np.sin(angle), v * np.cos(angle)
    out[:, 8] = SPEED
    return out


def _evaluate(model: Any, states: np.ndarray, tangent: bool, history: Any = None) -> None:
    for state in states:
        evaluation = model.evaluate(state, history, 1e-4)
        if tangent:
            evaluation.tangent()


def grid_growth(cavitation: Any, tangent: bool, repeats: int, grids: tuple[tuple[int, int], ...] = GRIDS) -> Growth:
    """Evaluation of the film over the number of its vertices."""
    runs = {}
    states = motions()
    for n, m in grids:
        model = build_model(plain_bearing(film=FiniteLength(n_theta=n, n_z=m), cavitation=cavitation))
        history = model.initial_history(states[0])
        runs[n * (m + 1)] = partial(_evaluate, model, states, tangent, history)
    sizes, seconds = measure(runs, repeats)
    name = f"{type(cavitation).__name__}, " + ("force and tangent" if tangent else "force")
    return Growth(name=name, size_name="film vertices", sizes=sizes, seconds=tuple(s / len(states) for s in seconds))


def mode_growth(repeats: int, tolerances: tuple[float, ...] = TOLERANCES) -> Growth:
    """Evaluation of the film on a modal bush over the number of modes."""
    runs = {}
    mesh = HollowCylinder(inner_radius=RADIUS, thickness=0.02, length=0.066, axial=4, radial=2, circumferential=32)
    for tolerance in tolerances:
        model: Any = build_model(plain_bearing(bush=ModalBush(mesh=mesh, material=STEEL, tolerance=tolerance)))
        modes = model.bore.size
        states = np.concatenate((motions(), np.zeros((12, 2 * modes))), axis=1)
        runs[modes] = partial(_evaluate, model, states, True)
    sizes, seconds = measure(runs, repeats)
    return Growth(
        name="modal bush, force and tangent", size_name="modes", sizes=sizes, seconds=tuple(s / 12 for s in seconds)
    )


def joint_growth(repeats: int, counts: tuple[int, ...] = JOINTS) -> Growth:
    """Step of a model over the number of its joints: independent rotors, sparse linear solver."""
    motion = mechanisms.ConstantSpin(spin=SPEED)
    runs = {}
    for count in counts:
        mbs, _ = mechanisms.rotors(
            plain_bearing(film=FiniteLength(n_theta=64, n_z=8)),
            count,
            mass=2.0,
            load=(0.0, -2000.0),
            angle=motion.angle,
            spin=motion.spin_at,
        )
        settings: Any = exu.SimulationSettings()
        settings.timeIntegration.endTime = STEPS * 1e-4
        settings.timeIntegration.numberOfSteps = STEPS
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        ConfigureSolver(settings)
        runs[count] = partial(mbs.SolveDynamic, settings)
    sizes, seconds = measure(runs, repeats)
    return Growth(name="step of a model", size_name="joints", sizes=sizes, seconds=tuple(s / STEPS for s in seconds))


def all_growths(repeats: int = 7) -> list[Growth]:
    """Everything that is reported."""
    return [
        grid_growth(SwiftStieber(), False, repeats),
        grid_growth(SwiftStieber(), True, repeats),
        grid_growth(ElrodAdams(cavity_pressure=-1e5), True, repeats),
        mode_growth(repeats),
        joint_growth(repeats),
    ]


def growth_text(growths: list[Growth]) -> str:
    """Table for people."""
    out = []
    for g in growths:
        times = ", ".join(f"{n}: {format_seconds(t)}" for n, t in zip(g.sizes, g.seconds, strict=True))
        out.append(f"{g.name} ~ ({g.size_name})^{g.exponent:.2f}, at the end {g.last_exponent:.2f};  {times}")
    return "\n".join(out)


def write_growths(path: pathlib.Path, growths: list[Growth], note: str) -> None:
    """CSV, one row per size."""
    rows = [
        [g.name, g.size_name, n, f"{t:.4g}", f"{g.exponent:.3f}", f"{g.last_exponent:.3f}"]
        for g in growths
        for n, t in zip(g.sizes, g.seconds, strict=True)
    ]
    write_rows(path, [HEAD, *rows], [note])


def read_growths(path: pathlib.Path) -> tuple[list[Growth], list[str]]:
    """Read the rows that `write_growths` wrote, and their notes."""
    rows, notes = read_rows(path, HEAD)
    points: dict[tuple[str, str], list[tuple[int, float]]] = {}
    for row in rows:
        points.setdefault((row["what"], row["size"]), []).append((int(row["n"]), float(row["seconds"])))
    found = [
        Growth(name=name, size_name=size, sizes=tuple(n for n, _ in p), seconds=tuple(t for _, t in p))
        for (name, size), p in points.items()
    ]
    return found, notes
