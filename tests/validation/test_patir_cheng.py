"""Flow and shear stress factors against the constants of Patir and Cheng's tables (1978, 1979).

The numbers in the file were set against two transcriptions by others: foam-extend 4.0 (its lubricated contact; all of
C, r, A1 to A3, a1 to a6) and the EHD program of R. Boman, University of Liege (A3, a4 to a6, D and s of the isotropic
pattern). They agree. D and s of the other patterns, which only the test of reciprocity takes, have no second witness.
"""

import csv
import math
from fractions import Fraction
from pathlib import Path

import pytest

from exudyn_ehd.film.surfaces.roughness import (
    PATTERNS,
    pressure_flow_factor,
    shear_flow_factor,
    shear_stress_factor,
)

with open(Path(__file__).parent / "data" / "patir_cheng_flow_factors.csv", encoding="utf-8") as _file:
    ROWS = [{k: float(Fraction(v)) for k, v in row.items()} for row in csv.DictReader(_file)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['gamma']:.3g}")
def test_constants_and_formulas(row):
    """The published formulas written out, to rounding, and the range in which they are used as they stand."""
    g, lowest = row["gamma"], PATTERNS[row["gamma"]][2]
    assert lowest == row["H_min_valid"]
    for H in (lowest, 1.5, 3.0, 5.0, 5.1, 12.0):
        power = math.exp(-row["r"] * H) if g <= 1.0 else H ** -row["r"]
        phi = 1.0 - row["C"] * power if g <= 1.0 else 1.0 + row["C"] * power
        assert pressure_flow_factor(H, g) == pytest.approx(phi, rel=1e-13)
        if H <= 5.0:
            shear = row["A1"] * H ** row["alpha1"] * math.exp(-row["alpha2"] * H + row["alpha3"] * H * H)
        else:
            shear = row["A2"] * math.exp(-0.25 * H)
        assert shear_flow_factor(H, g) == pytest.approx(shear, rel=1e-13)
        if H <= 7.0:
            stress = row["A3"] * H ** row["alpha4"] * math.exp(-row["alpha5"] * H + row["alpha6"] * H * H)
            assert shear_stress_factor(H, g) == pytest.approx(stress, rel=1e-13)


def test_every_pattern_is_there():
    assert sorted(PATTERNS) == sorted(row["gamma"] for row in ROWS)
