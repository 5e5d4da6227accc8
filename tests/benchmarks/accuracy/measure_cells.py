"""Measures the package's table of errors over (eps, L/D, tilt, elasticity), `exudyn_ehd.studies.accuracy_table`.

Every cell holds the largest error over `DIRECTIONS` of the eccentricity, spread over one column of the coarsest grid,
with the estimated error of its reference added.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import pathlib
import time
import warnings
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import Film, FiniteLength
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.total_lagrange import SaintVenantKirchhoff
from exudyn_ehd.status import EHDError
from exudyn_ehd.studies.accuracy_table import (
    AXES,
    FILE,
    FILMS,
    HEAD,
    NAMES,
    THICKNESS,
    TOLERANCE,
    Cell,
    bore_compliance,
    elasticity_parameter,
)
from exudyn_ehd.tables import write_rows
from tests.benchmarks.accuracy.errors.richardson import converged
from tests.benchmarks.accuracy.errors.study import Progress
from tests.benchmarks.accuracy.scenes.steady import QUANTITIES, measure_motions, motion_at, time_of_sweep
from tests.benchmarks.accuracy.table import number_text

RIGID_LEVELS = ((96, 8), (192, 16), (384, 32))
ELASTIC_LEVELS = ((64, 5), (128, 10), (256, 20))
DIRECTIONS = 0.3 + np.radians(1.45) * np.arange(8)
RADIUS, CLEARANCE, VISCOSITY, SPEED = 0.025, 25e-6, 0.02, 300.0


@dataclasses.dataclass(frozen=True, kw_only=True)
class Block:
    """A full grid of cells; increasing values on every axis. ``kind``: "rigid", "liner" or "solid" bore."""

    kind: str
    length_to_diameter: tuple[float, ...]
    tilt_ratio: tuple[float, ...]
    elasticity: tuple[float, ...]
    eccentricity_ratio: tuple[float, ...]


RIGID = Block(
    kind="rigid",
    length_to_diameter=(0.25, 0.5, 1.0, 1.5),
    tilt_ratio=(0.0, 0.35, 0.7),
    elasticity=(0.0,),
    eccentricity_ratio=(0.2, 0.4, 0.6, 0.8, 0.9, 0.95),
)
LINER = Block(
    kind="liner",
    length_to_diameter=(0.5, 1.0),
    tilt_ratio=(0.0, 0.35),
    elasticity=(0.005, 0.02),
    eccentricity_ratio=(0.4, 0.6, 0.8, 0.9),
)
SOLID = Block(
    kind="solid",
    length_to_diameter=(0.5, 1.0),
    tilt_ratio=(0.0, 0.35),
    elasticity=(0.005, 0.02),
    eccentricity_ratio=(0.4, 0.6, 0.8, 0.9),
)
BLOCKS = (RIGID, LINER, SOLID)


def cell_bearing(
    kind: str, length_to_diameter: float, elasticity: float, film: Film, *, tilted: bool = False
) -> JournalBearing:
    """A bearing with the cell's L/D and kappa at the spin `SPEED`; ``tilted``: a solid bush has modes odd in z."""
    length = 2.0 * RADIUS * length_to_diameter
    plain = JournalBearing(
        journal_radius=RADIUS,
        length=length,
        radial_clearance=CLEARANCE,
        lubricant=Lubricant(viscosity=VISCOSITY),
        film=film,
    )
    if kind == "rigid":
        return plain
    thickness = THICKNESS * RADIUS
    if kind == "liner":
        liner = ElasticLiner(thickness=thickness, youngs_modulus=1e9)
        modulus = 1e9 * elasticity_parameter(plain, liner.compliance, SPEED) / elasticity
        return dataclasses.replace(plain, bush=dataclasses.replace(liner, youngs_modulus=modulus))
    modulus = elasticity_parameter(plain, bore_compliance(thickness, RADIUS, 1.0, 0.3), SPEED) / elasticity
    bush = ModalBush(
        mesh=HollowCylinder(
            inner_radius=RADIUS, thickness=thickness, length=length, axial=4, radial=2, circumferential=32
        ),
        material=SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0),
        tolerance=TOLERANCE,
        tilted=tilted,
    )
    return dataclasses.replace(plain, bush=bush)


def _motions(bearing: JournalBearing, eccentricity_ratio: float, tilt_ratio: float) -> np.ndarray:
    return np.array([motion_at(bearing, SPEED, eccentricity_ratio, tilt_ratio, d) for d in DIRECTIONS])


def measure_block(block: Block, progress: Progress = print) -> list[Cell]:
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
        rigid = block.kind == "rigid"
        models = {name: build(film) for name, film in FILMS.items() if rigid or isinstance(film, FiniteLength)}
        for tilt, eps in itertools.product(tilts, block.eccentricity_ratio):
            motions = np.array([motion_at(levels[0].bearing, SPEED, eps, tilt, d) for d in DIRECTIONS])
            out += _measure(block.kind, models, levels, motions, (ratio, tilt, kappa, eps))
    return out


def _measure(
    kind: str, models: dict[str, Any], levels: Sequence[Any], motions: np.ndarray, point: tuple[float, ...]
) -> list[Cell]:
    fine = [measure_motions(model, motions)[0] for model in levels]
    references = {
        q.name: converged([f[q.name] for f in fine], ratio=2.0, formal_order=2.0, scale=q.scale_of(fine[-1][q.name]))
        for q in QUANTITIES
    }
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
    rows = [
        [
            c.kind,
            *(getattr(c, axis) for axis in AXES),
            c.setting,
            *(number_text(x, 3) for x in (c.seconds, *(c.errors[n] for n in NAMES))),
        ]
        for c in cells
    ]
    write_rows(path, [HEAD, *rows], notes=[note], line_end="\n")


def measure_all(folder: pathlib.Path, progress: Progress = print, note: str = "") -> None:
    """Measure all blocks and write them."""
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        cells = [cell for block in BLOCKS for cell in measure_block(block, progress)]
    write_cells(folder / FILE, cells, note)
    progress(f"cells: {len(cells)} rows, {time.perf_counter() - start:.0f} s")
