"""Half Sommerfeld (Gümbel) film against an independent solver: linear solution, then negative pressure cut off.

Inlet: p = 0 on the line of maximum gap. The linear periodic film is antisymmetric
about that line, so both inlets give the same; both are tested. Grid 128 x 12.
"""

from __future__ import annotations

import math

import pytest

import exudyn_ehd as ehd


@pytest.mark.parametrize("inlet", (ehd.Periodic(), ehd.MaximumGap()))
def test_load_and_attitude(table, make_bearing, measured, inlet):
    load = attitude = 0.0
    for row in table("gumbel_steady"):
        bearing = make_bearing(
            row["B_over_D"], cavitation=ehd.Gumbel(), inlet=inlet, film=ehd.FiniteLength(n_theta=128, n_z=12)
        )
        film = ehd.steady(bearing, speed=100.0, eccentricity_ratio=row["eps"])
        load = max(load, abs(film.sommerfeld_number / row["So"] - 1.0))
        attitude = max(attitude, abs(math.degrees(film.attitude_angle) - row["beta_deg"]))
    measured("So", load, 0.005)  # the table has four digits: 0.07 % of its smallest So
    measured("attitude, degrees", attitude, 0.05)
