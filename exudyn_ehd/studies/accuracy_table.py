"""Measured errors of film models over (eps, L/D, tilt, elasticity): what `recommend` rests on.

All relative results of a plain bearing depend on four numbers: the eccentricity ratio eps, L/D, the tilt (share of
the mid-plane's minimum film thickness that it takes at one end) and, where the bore deflects, on

    kappa = a mu omega / (psi^2 c),    a = displacement of the bore per pressure,

with `ElasticLiner.compliance` for a liner and `bore_compliance`, a thick cylinder's under uniform pressure, for a solid
bush. A solid bush of another thickness deflects nearly alike at the same kappa; measured on bushes half as thick as
the radius (`THICKNESS`), with modes of `TOLERANCE`: errors are those of the film on this bush. Finer modes, and
meshes, deflect next to the ends within less than an interval of a coarse film, whose errors are then larger.

Every cell holds the largest error over several directions of the eccentricity, spread over one column of the coarsest
grid, with the estimated error of its reference added. Closure: Swift-Stieber.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import pathlib

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.models import Film, FiniteLength, ShortBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.tables import read_rows

DATA = pathlib.Path(__file__).parent / "data"
FILE = "cells.csv"
NAMES = ("load", "attitude", "friction", "peak pressure", "minimum film thickness", "leakage", "stiffness", "damping")
AXES = ("length_to_diameter", "tilt_ratio", "elasticity", "eccentricity_ratio")
HEAD = ("kind", *AXES, "setting", "seconds", *NAMES)
GRIDS = ((32, 4), (48, 6), (64, 8), (96, 10), (128, 12), (192, 16))
FILMS: dict[str, Film] = {
    **{f"2D {n} x {m}": FiniteLength(n_theta=n, n_z=m) for n, m in GRIDS},
    "short 64 x 8": ShortBearing(n_theta=64),
    "map": ImpedanceMap(),
}
THICKNESS = 0.5
TOLERANCE = 0.02


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cell:
    """Errors of one setting at one point.

    Attributes
    ----------
    kind : str
        "rigid", "liner" or "solid" bore.
    length_to_diameter, tilt_ratio, elasticity, eccentricity_ratio : float
        The point; elasticity is kappa of the module's docstring.
    setting : str
        One of `FILMS`.
    errors : dict
        By quantity, one of `NAMES`; nan where the model does not know it.
    seconds : float
        Processor time per evaluation with tangent.
    """

    kind: str
    length_to_diameter: float
    tilt_ratio: float
    elasticity: float
    eccentricity_ratio: float
    setting: str
    errors: dict[str, float]
    seconds: float


@functools.cache
def read_cells(path: pathlib.Path = DATA / FILE) -> tuple[Cell, ...]:
    """All cells of a table."""
    out = []
    for row in read_rows(path, HEAD)[0]:
        errors = {n: float(row[n]) if row[n] else math.nan for n in NAMES}
        axes = {n: float(row[n]) for n in AXES}
        out.append(Cell(kind=row["kind"], **axes, setting=row["setting"], errors=errors, seconds=float(row["seconds"])))
    return tuple(out)


def bore_compliance(thickness: float, radius: float, youngs_modulus: float, poisson_ratio: float) -> float:
    """Radial displacement of a bore per uniform pressure, m/Pa.

    Cylinder of ``radius`` inside, held at radius + thickness, plane strain. Lamé: u = A r + B / r with u(b) = 0,
    sigma_r(a) = -p, sigma_r = 2 (lambda + G) A - 2 G B / r^2.
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
