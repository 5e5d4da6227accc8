"""Measured friction in mixed lubrication (Sander et al., 2015; digitised): the course, not the numbers.

The table gives the friction torque of a test bearing at two mean pressures over speed. Bearing and oil below are of
that size (diameter 48 mm, length 25 mm, clearance 30 um, hot engine oil); roughness and boundary friction are
assumed. What must come out without fitting them: torque falls with speed to a minimum near the measured one (327 and
545 rpm; measured between 300 and 500) and rises again, and the minimum moves up in speed with the load. The torque
at 3000 rpm, all of it fluid friction, is proportional to a viscosity that is not known: within a factor of 2.5.
"""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import exudyn_ehd as ehd

with open(Path(__file__).parent / "data" / "sander2015_mixed_friction.csv", encoding="utf-8") as _file:
    ROWS = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(_file)]
BEARING = ehd.JournalBearing(
    journal_radius=0.024,
    length=0.025,
    radial_clearance=30e-6,
    lubricant=ehd.Lubricant(viscosity=0.009),
    film=ehd.FiniteLength(n_theta=128, n_z=12),
    asperity=ehd.GreenwoodTripp(composite_roughness=0.35e-6, composite_modulus=1e11, friction_coefficient=0.05),
    roughness=ehd.PatirCheng(composite_roughness=0.35e-6),
)


def measured(pressure):
    rows = sorted((r["rpm"], r["M_friction_Nm"]) for r in ROWS if r["pbar_MPa"] == pressure)
    return np.array(rows).T


def computed(pressure, rpm):
    load = pressure * 1e6 * 2 * BEARING.journal_radius * BEARING.length
    return ehd.stribeck(BEARING, load=load, speeds=np.asarray(rpm) * math.pi / 30)


@pytest.mark.parametrize("pressure", [5.0, 10.0])
def test_course_over_speed(pressure):
    rpm, torque = measured(pressure)
    curve = computed(pressure, rpm)
    lowest = rpm[np.argmin(torque)]
    assert 200 <= lowest <= 1000
    fine = np.geomspace(50, 3000, 25)
    found = fine[np.argmin(computed(pressure, fine).friction_torque)]
    print(
        f"minimum at {found:.0f} rpm, measured {lowest:.0f}; "
        f"at 3000 rpm {curve.friction_torque[-1]:.3g} Nm, measured {torque[-1]}"
    )
    assert lowest / 2 < found < 2 * lowest
    assert 0.4 < curve.friction_torque[-1] / torque[-1] < 2.5
    assert curve.contact_load_share[0] > 10 * curve.contact_load_share[-1]


def test_minimum_moves_up_with_the_load():
    fine = np.geomspace(50, 3000, 25)
    low, high = (fine[np.argmin(computed(p, fine).friction_torque)] for p in (5.0, 10.0))
    assert high > low
