"""Measured errors of film models over (eps, L/D, tilt, elasticity): what `recommend` rests on.

All relative results of a plain bearing depend on four numbers: the eccentricity ratio eps, L/D, the tilt (share of the mid-plane's
smallest gap that it takes at one end) and, where the bore gives way, on

    kappa = a mu omega / (psi^2 c),    a = displacement of the bore per pressure,

with `ElasticLiner.compliance` for a liner and `bore_compliance`, a thick cylinder's under uniform pressure, for a solid bush. A solid
bush of another thickness gives way nearly alike at the same kappa; measured on bushes half as thick as the radius (`THICKNESS`), with modes
of `TOLERANCE`: errors are those of the film on this bush. Finer modes, and meshes, give way next to the ends within less than an interval of
a coarse film, whose errors are then larger.

Every cell holds the largest error over `DIRECTIONS` of the eccentricity, spread over one column of the coarsest grid, with the
estimated error of its reference added. Closure: Swift-Stieber.
"""

from __future__ import annotations

import csv
import dataclasses
import functools
import io
import itertools
import math
import pathlib
import time
import warnings
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FiniteLength, ShortBearing
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import Film
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.liner import ElasticLiner
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.static_modes import ModalBush
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.status import EHDError
from exudyn_ehd.studies.richardson import converged
from exudyn_ehd.studies.steady import QUANTITIES, measure_motions, motion_at, time_of_sweep
from exudyn_ehd.studies.table import write_atomic

DATA = pathlib.Path(__file__).parent / "data"
FILE = "cells.csv"
NAMES = tuple(q.name for q in QUANTITIES)
AXES = ("length_to_diameter", "tilt_ratio", "elasticity", "eccentricity_ratio")
GRIDS = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12), (192, 16))
FILMS: dict[str, Film] = {
    **{f"2D {n} x {m}": FiniteLength(n_theta=n, n_z=m) for n, m in GRIDS},
    "short 64 x 8": ShortBearing(n_theta=64),
    "map": ImpedanceMap(),
}
RIGID_LEVELS = ((96, 8), (192, 16), (384, 32))
ELASTIC_LEVELS = ((64, 5), (128, 10), (256, 20))
DIRECTIONS = 0.3 + np.radians(1.45) * np.arange(8)
THICKNESS = 0.5
TOLERANCE = 0.02
RADIUS, CLEARANCE, VISCOSITY, SPEED = 0.025, 25e-6, 0.02, 300.0


@dataclasses.dataclass(frozen=True, kw_only=True)
class Block:
    """A full grid of cells; increasing values on every axis. ``kind``: "rigid", "liner" or "solid" bore."""

    kind: str
    length_to_diameter: tuple[float, ...]
    tilt_ratio: tuple[float, ...]
    elasticity: tuple[float, ...]
    eccentricity_ratio: tuple[float, ...]

    def cells(self) -> Iterable[tuple[float, float, float, float]]:
        """All of them, in the order of `AXES`."""
        return itertools.product(self.length_to_diameter, self.tilt_ratio, self.elasticity, self.eccentricity_ratio)


RIGID = Block(
    kind="rigid", length_to_diameter=(0.25, 0.5, 1.0, 1.5), tilt_ratio=(0.0, 0.35, 0.7), elasticity=(0.0,),
    eccentricity_ratio=(0.2, 0.4, 0.6, 0.8, 0.9, 0.95),
)  # fmt: skip
LINER = Block(
    kind="liner", length_to_diameter=(0.5, 1.0), tilt_ratio=(0.0, 0.35), elasticity=(0.005, 0.02),
    eccentricity_ratio=(0.4, 0.6, 0.8, 0.9),
)  # fmt: skip
SOLID = Block(
    kind="solid", length_to_diameter=(0.5, 1.0), tilt_ratio=(0.0, 0.35), elasticity=(0.005, 0.02),
    eccentricity_ratio=(0.4, 0.6, 0.8, 0.9),
)  # fmt: skip
BLOCKS = (RIGID, LINER, SOLID)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cell:
    """Errors of one setting at one point of a block's kind; ``errors`` by quantity, nan where the model does not know it; ``seconds`` per evaluation."""

    kind: str
    length_to_diameter: float
    tilt_ratio: float
    elasticity: float
    eccentricity_ratio: float
    setting: str
    errors: dict[str, float]
    seconds: float

    @property
    def point(self) -> tuple[float, float, float, float]:
        """In the order of `AXES`."""
        return self.length_to_diameter, self.tilt_ratio, self.elasticity, self.eccentricity_ratio


def bore_compliance(thickness: float, radius: float, youngs_modulus: float, poisson_ratio: float) -> float:
    """Radial displacement of a bore per uniform pressure, m/Pa: cylinder of ``radius`` inside, held at radius + thickness, plane strain.

    Lame: u = A r + B / r with u(b) = 0, sigma_r(a) = -p, sigma_r = 2 (lambda + G) A - 2 G B / r^2.
    """
    G = youngs_modulus / (2.0 * (1.0 + poisson_ratio))
    lam = 2.0 * G * poisson_ratio / (1.0 - 2.0 * poisson_ratio)
    a, b = radius, radius + thickness
    # B = -A b^2 from u(b) = 0
    A = -1.0 / (2.0 * (lam + G) + 2.0 * G * b * b / (a * a))
    return A * (a - b * b / a)


def elasticity_parameter(bearing: JournalBearing, compliance: float, speed: float) -> float:
    """kappa of the module's docstring."""
    pressure = bearing.lubricant.viscosity * abs(speed) / bearing.clearance_ratio**2
    return compliance * pressure / bearing.radial_clearance


def cell_bearing(
    kind: str, length_to_diameter: float, elasticity: float, film: Film, *, tilted: bool = False
) -> JournalBearing:
    """A bearing with the cell's L/D and kappa at the spin `SPEED`; ``tilted``: a solid bush has modes that are odd in z."""
    length = 2.0 * RADIUS * length_to_diameter
    plain = JournalBearing(
        journal_radius=RADIUS, length=length, radial_clearance=CLEARANCE, lubricant=Lubricant(viscosity=VISCOSITY),
        film=film,
    )  # fmt: skip
    if kind == "rigid":
        return plain
    thickness = THICKNESS * RADIUS
    if kind == "liner":
        liner = ElasticLiner(thickness=thickness, youngs_modulus=1.0)
        modulus = elasticity_parameter(plain, liner.compliance, SPEED) / elasticity
        return dataclasses.replace(plain, bush=dataclasses.replace(liner, youngs_modulus=modulus))
    modulus = elasticity_parameter(plain, bore_compliance(thickness, RADIUS, 1.0, 0.3), SPEED) / elasticity
    bush = ModalBush(
        mesh=HollowCylinder(
            inner_radius=RADIUS, thickness=thickness, length=length, axial=4, radial=2, circumferential=32
        ),
        material=SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0),
        tolerance=TOLERANCE,
        tilted=tilted,
    )  # fmt: skip
    return dataclasses.replace(plain, bush=bush)


def _motions(bearing: JournalBearing, eccentricity_ratio: float, tilt_ratio: float) -> np.ndarray:
    return np.array([motion_at(bearing, SPEED, eccentricity_ratio, tilt_ratio, d) for d in DIRECTIONS])


def true_values(
    bearing: JournalBearing, eccentricity_ratio: float, tilt_ratio: float, film: Film
) -> dict[str, np.ndarray]:
    """Quantities over the directions with another film model."""
    model: Any = build_model(dataclasses.replace(bearing, film=film))
    return measure_motions(model, _motions(bearing, eccentricity_ratio, tilt_ratio))[0]


def measure_block(block: Block, progress: Any = print) -> list[Cell]:
    """Errors and times of every film at every cell of a block."""
    out = []
    # only a solid bush is another one for tilted journals
    groups = [[t for t in block.tilt_ratio if (t > 0.0) is tilted] for tilted in (False, True)]
    if block.kind != "solid":
        groups = [list(block.tilt_ratio)]
    for ratio, kappa, tilts in itertools.product(block.length_to_diameter, block.elasticity, groups):
        if not tilts:
            continue
        progress(f"cells: {block.kind}, L/D {ratio:g}, elasticity {kappa:g}, tilt {', '.join(f'{t:g}' for t in tilts)}")

        def build(film: Film, ratio: float = ratio, kappa: float = kappa, tilted: bool = tilts[-1] > 0.0) -> Any:
            return build_model(cell_bearing(block.kind, ratio, kappa, film, tilted=tilted))

        fine = RIGID_LEVELS if block.kind == "rigid" else ELASTIC_LEVELS
        levels = [build(FiniteLength(n_theta=n, n_z=m)) for n, m in fine]
        models: dict[str, Any] = {}
        for name, film in FILMS.items():
            if block.kind == "rigid" or isinstance(film, FiniteLength):
                models[name] = build(film)
        for tilt, eps in itertools.product(tilts, block.eccentricity_ratio):
            motions = _motions(levels[0].bearing, eps, tilt)
            out += _measure(block.kind, models, levels, motions, (ratio, tilt, kappa, eps))
    return out


def _measure(
    kind: str, models: dict[str, Any], levels: Sequence[Any], motions: np.ndarray, point: tuple[float, ...]
) -> list[Cell]:
    fine = [measure_motions(model, motions)[0] for model in levels]
    references = {
        q.name: converged(
            [f[q.name] for f in fine], ratio=2.0, formal_order=2.0, scale=q.scale_of(fine[-1][q.name])
        )
        for q in QUANTITIES
    }  # fmt: skip
    out = []
    for name, model in models.items():
        try:
            values = measure_motions(model, motions)[0]
        except EHDError:
            # a map refuses tilted journals
            continue
        errors = {
            q.name: q.distance(values[q.name], references[q.name].value) + references[q.name].error
            if q.name in values
            else math.nan
            for q in QUANTITIES
        }
        seconds = float(np.median([time_of_sweep(model, motions) for _ in range(3)]))
        out.append(Cell(kind=kind, **dict(zip(AXES, point, strict=True)), setting=name, errors=errors, seconds=seconds))
    return out


def write_cells(path: pathlib.Path, cells: Iterable[Cell], note: str) -> None:
    """CSV with one row per cell and setting; three digits."""
    text = io.StringIO()
    text.write(f"# {note}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["kind", *AXES, "setting", "seconds", *NAMES])
    for cell in cells:
        numbers = [cell.errors[n] for n in NAMES]
        writer.writerow(
            [
                cell.kind,
                *cell.point,
                cell.setting,
                f"{cell.seconds:.3g}",
                *("" if math.isnan(x) else f"{x:.3g}" for x in numbers),
            ]
        )
    write_atomic(path, text.getvalue())


@functools.cache
def read_cells(path: pathlib.Path = DATA / FILE) -> tuple[Cell, ...]:
    """What `write_cells` wrote."""
    lines = path.read_text(encoding="utf-8").splitlines()
    out = []
    for row in csv.DictReader(line for line in lines if not line.startswith("# ")):
        errors = {n: float(row[n]) if row[n] else math.nan for n in NAMES}
        axes = {n: float(row[n]) for n in AXES}
        out.append(Cell(kind=row["kind"], **axes, setting=row["setting"], errors=errors, seconds=float(row["seconds"])))
    return tuple(out)


def measure_all(folder: pathlib.Path = DATA, progress: Any = print, note: str = "") -> None:
    """Measure all blocks and write them."""
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        cells = [cell for block in BLOCKS for cell in measure_block(block, progress)]
    write_cells(folder / FILE, cells, note)
    progress(f"cells: {len(cells)} rows, {time.perf_counter() - start:.0f} s")
