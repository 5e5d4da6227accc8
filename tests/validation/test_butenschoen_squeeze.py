"""Butenschoen (thesis, 1976): pure radial squeeze, ``So_V = F psi^2 / (L D mu d(eps)/dt)``.

Inlet: periodic film (`Periodic`), Swift-Stieber. eps < 0 means that the journal moves towards the centre. A few printed
digits of the source are wrong, so the values of an independent solver (within 0.7 % of the printed ones elsewhere)
count. Grid 96 x 10 (the default) up to eps 0.95; 192 x 10 above, where the pressure peak is 10 degrees wide.
"""

from __future__ import annotations

import math

import pytest

import exudyn_ehd as ehd
from tests.sampling import sample

RATE = 10.0


@pytest.mark.parametrize("ratio", (1.0, 0.5, 0.4, 0.166667, 0.125))
@pytest.mark.parametrize("direction", sample((0.0, 1.0), 1))
def test_squeeze_force(table, make_bearing, measured, ratio, direction):
    bearing = make_bearing(ratio, film=ehd.FiniteLength(n_theta=96, n_z=10), inlet=ehd.Periodic())
    rows = [r for r in table("butenschoen1976_squeeze") if r["B_over_D"] == ratio and r["So_V_own"] != ""]
    assert len(rows) > 20
    unit = bearing.reference_force(RATE)
    fine = make_bearing(ratio, film=ehd.FiniteLength(n_theta=192, n_z=10), inlet=ehd.Periodic())
    worst = high = sideways = 0.0
    axis = math.cos(direction), math.sin(direction)
    for row in rows:
        eps = row["eps(neg: moving to centre)"]
        v = math.copysign(RATE, eps) * bearing.radial_clearance
        film = ehd.steady(
            bearing if abs(eps) <= 0.95 else fine,
            speed=0.0,
            eccentricity_ratio=abs(eps),
            direction=direction,
            velocity=(v * axis[0], v * axis[1]),
        )
        along = -math.copysign(1.0, eps) * (film.force[0] * axis[0] + film.force[1] * axis[1]) / unit
        across = (-film.force[0] * axis[1] + film.force[1] * axis[0]) / unit
        if abs(eps) <= 0.95:
            worst = max(worst, abs(along / row["So_V_own"] - 1.0))
            sideways = max(sideways, abs(across / along))
        else:
            high = max(high, abs(along / row["So_V_own"] - 1.0))
    # Independent solver good to 0.1 %; 1 % leaves room for the film's edge, which snaps to cells.
    measured("So_V up to eps 0.95", worst, 0.01)
    measured("So_V above eps 0.95", high, 0.01)
    # No force across the motion, apart from the same snapping when the motion is not along a column.
    measured("force across the motion", sideways, 1e-10 if direction == 0.0 else 0.005)
