"""Infinitely long bearing: closed forms (full and half Sommerfeld) and a one-dimensional Reynolds condition.

A ring without side flow: only the column of maximum gap is held at p = 0. One axial interval, 360
columns; the scheme is of second order in theta, 1/360 of a turn leaves about 1e-4 up to eps 0.9.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.reference import long_bearing

R, C, MU, SPEED, WIDTH = 0.025, 25e-6, 0.02, 100.0, 0.01


def _sealed_ring(eps, cavitation, n_theta=360):
    """Sommerfeld number, attitude angle in degrees, and pressure over mu omega / psi^2."""
    grid = ehd.bearing_grid(R, WIDTH, n_theta, 1, stretch=0.0, open_ring=True)
    fixed = np.zeros_like(grid.fixed)
    fixed[0] = True
    grid = dataclasses.replace(grid, fixed=fixed)
    gap = np.repeat(C * (1.0 + eps * np.cos(grid.x))[:, None], 2, axis=1)
    film = ehd.solve_film(
        grid, gap, lubricant=ehd.Lubricant(viscosity=MU), surface_speed=(R * SPEED, 0.0), cavitation=cavitation
    )
    p = film.pressure[:, 0] * C**2 / (MU * SPEED * R**2)
    radial = -(p * np.cos(grid.x)).sum() * grid.width_x[0]
    tangential = (p * np.sin(grid.x)).sum() * grid.width_x[0]
    return 0.5 * math.hypot(radial, tangential), math.degrees(math.atan2(tangential, radial)), p, grid.x


@pytest.mark.parametrize("eps", (0.1, 0.5, 0.9))
def test_full_sommerfeld(eps, measured):
    load, attitude, p, theta = _sealed_ring(eps, ehd.FullSommerfeld())
    exact = np.array([long_bearing.full_sommerfeld_pressure(eps, t) for t in theta])
    measured("So", abs(load / long_bearing.full_sommerfeld_load(eps) - 1.0), 1e-3)
    measured("attitude, degrees", abs(attitude - 90.0), 1e-8)
    measured("pressure over its peak", float(abs(p - exact).max() / exact.max()), 2e-3)


@pytest.mark.parametrize("eps", (0.1, 0.5, 0.9))
def test_half_sommerfeld(eps, measured):
    load, attitude, _, _ = _sealed_ring(eps, ehd.Gumbel())
    measured("So", abs(load / long_bearing.half_sommerfeld_load(eps) - 1.0), 1e-3)
    measured("attitude, degrees", abs(attitude - math.degrees(long_bearing.half_sommerfeld_attitude(eps))), 0.02)


def test_reynolds_condition_table(table, measured):
    load = attitude = peak = rupture = 0.0
    for row in table("analytic_long_bearing"):
        eps = row["eps"]
        so, phi, p, theta = _sealed_ring(eps, ehd.SwiftStieber())
        assert long_bearing.full_sommerfeld_load(eps) == pytest.approx(row["So_full_Sommerfeld_closed"], rel=1e-5)
        assert long_bearing.half_sommerfeld_load(eps) == pytest.approx(row["So_half_Sommerfeld_closed"], rel=1e-5)
        load = max(load, abs(so / row["So_ReynoldsBC_1D(own,1e-6)"] - 1.0))
        attitude = max(attitude, abs(phi - row["phi_ReynoldsBC"]))
        peak = max(peak, abs(2.0 * so / 2.0 / p.max() / row["pmean_over_pmax"] - 1.0))
        rupture = max(rupture, abs(math.degrees(theta[p > 0.0].max()) - row["th_rupture_deg"]))
    # Quadrature to 1e-6; second order in theta with the largest error at eps 0.95, where the film is ten cells long.
    measured("So", load, 2e-3)
    measured("attitude, degrees", attitude, 0.05)
    measured("mean over peak pressure", peak, 2e-3)
    measured("rupture line, degrees (columns are 1 degree apart)", rupture, 1.5)


@pytest.mark.parametrize("eps", (0.2, 0.6))
def test_mid_plane_of_a_wide_bearing(make_bearing, measured, eps):
    # At L/D = 10 the ends are felt over about one radius; the mid-plane is the long bearing to exp(-10).
    bearing = make_bearing(
        10.0, film=ehd.FiniteLength(n_theta=180, n_z=20, stretch=0.0), cavitation=ehd.FullSommerfeld()
    )
    model = build_model(bearing)
    model.evaluate(np.array([-eps * bearing.radial_clearance, 0, 0, 0, 0, 0, 0, 0, SPEED, 0], dtype=float))
    p = model.solver.pressure[:, 10] * model.scales.pressure * bearing.clearance_ratio**2 / (MU * SPEED)
    exact = np.array([long_bearing.full_sommerfeld_pressure(eps, t) for t in model.grid.x])
    # 2-degree columns, second order.
    measured("mid-plane pressure over its peak", float(abs(p - exact).max() / exact.max()), 2e-3)


@pytest.mark.parametrize("eps", (0.2, 0.6))
def test_friction_of_the_full_sommerfeld_film(make_bearing, measured, eps):
    """Journal and bush torque of a bearing tend to the closed forms with L/D: the ends cost about 1 / (L/D)."""
    shortfall = []
    for ratio in (20.0, 40.0):
        bearing = make_bearing(
            ratio, film=ehd.FiniteLength(n_theta=96, n_z=40, stretch=0.9), cavitation=ehd.FullSommerfeld()
        )
        film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=eps)
        petroff = 2.0 * math.pi * MU * SPEED * R**3 * bearing.length / C
        shortfall.append(
            (
                -film.friction_torque / petroff / long_bearing.full_sommerfeld_journal_torque(eps) - 1.0,
                film.friction_torque_bush / petroff / long_bearing.full_sommerfeld_bush_torque(eps) - 1.0,
            )
        )
    (j20, b20), (j40, b40) = shortfall
    # Extrapolated to an infinite length; the grid leaves a few 1e-4.
    measured("journal torque", abs(2.0 * j40 - j20), 1e-3)
    measured("bush torque", abs(2.0 * b40 - b20), 1e-3)
    assert j20 < 0.0 < b20
