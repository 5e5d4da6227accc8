"""Raimondi and Boyd, A solution for the finite journal bearing and its application to analysis and design, III (1958).

Columns of an independent solver for the same rows (the printed ones are design
charts). Inlet: p = 0 on the line of maximum gap. Friction with the whole clearance
sheared. Flows in units of R c N L, N in revolutions per second. Grid 96 x 10.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

SPEED = 100.0


@pytest.mark.parametrize("ratio", (1.0, 0.5, 0.25))
def test_friction_load_and_side_flow(table, make_bearing, measured, ratio):
    bearing = make_bearing(ratio, inlet=ehd.MaximumGap())
    R, c, L = bearing.journal_radius, bearing.radial_clearance, bearing.length
    unit = R * c * L * SPEED / (2.0 * math.pi)
    worst = dict.fromkeys(("S", "phi", "friction", "side flow", "mean over peak"), 0.0)
    for row in (r for r in table("raimondi_boyd1958") if r["L_over_D"] == ratio):
        film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=row["eps"])
        load = float(np.hypot(*film.force[:2]))
        errors = {
            "S": 1.0 / (2.0 * math.pi * film.sommerfeld_number) / row["S_own"] - 1.0,
            "phi": math.degrees(film.attitude_angle) / row["phi_own"] - 1.0,
            "friction": -film.friction_torque / (load * c) / row["f_own"] - 1.0,
            "side flow": film.leakage / unit / (row["QsQ_own"] * row["Q_own"]) - 1.0,
            "mean over peak": load / (2.0 * R * L) / film.peak_pressure / row["Ppmax_own"] - 1.0,
        }
        worst = {key: max(worst[key], abs(errors[key])) for key in worst}
        # Charts read by hand and computed by relaxation in 1958: 4 % in f, and the rows up to eps 0.9 only.
        if row["eps"] <= 0.9:
            assert -film.friction_torque / (load * c) == pytest.approx(row["f_R_over_c"], rel=0.04)
    # eps up to 0.97: the 96 x 10 grid is off by 1.2 % in load and friction there; flow and angle are easier.
    for name, limit in zip(worst, (0.015, 0.015, 0.015, 0.015, 0.03), strict=True):
        measured(name, worst[name], limit)


@pytest.mark.parametrize("ratio", (1.0, 0.5, 0.25))
def test_flow_through_the_inlet_line(table, measured, ratio):
    """Q through the largest gap, from the balance of the inlet column of `solve_film`.

    The column feeds the difference between what leaves in the sense of rotation and the Couette flow U h L / 2 that the
    ruptured film brings; Q is the sum.
    """
    R, c, mu = 0.025, 25e-6, 0.02
    grid = ehd.bearing_grid(R, 2.0 * ratio * R, 96, 10, start_angle=0.0, open_ring=True)
    worst = 0.0
    for row in (r for r in table("raimondi_boyd1958") if r["L_over_D"] == ratio):
        gap = np.repeat(c * (1.0 + row["eps"] * np.cos(grid.x))[:, None], grid.z.size, axis=1)
        film = ehd.solve_film(grid, gap, lubricant=ehd.Lubricant(viscosity=mu), surface_speed=(R * SPEED, 0.0))
        arriving = 0.5 * R * SPEED * 0.5 * (gap[0, 0] + gap[-1, 0]) * 2.0 * ratio * R
        flow = film.inflow[0].sum() + arriving
        unit = R * c * 2.0 * ratio * R * SPEED / (2.0 * math.pi)
        worst = max(worst, abs(flow / unit / row["Q_own"] - 1.0))
    measured("inlet flow", worst, 0.015)
