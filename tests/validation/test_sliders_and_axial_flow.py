"""Films without a journal: plane slider, parabolic slider with a cavity, axial
flow through a cone, Petroff's friction."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.reference import petroff, slider


@pytest.mark.parametrize("closure", (ehd.SwiftStieber(), ehd.FullSommerfeld(), ehd.Gumbel()))
def test_plane_slider(closure, measured):
    U, mu, L, h1, h2 = 2.0, 0.01, 0.05, 4e-5, 2e-5
    grid = ehd.slider_grid(L, 0.01, 200, 1, sealed_sides=True)
    x = grid.x * L
    gap = np.repeat((h1 + (h2 - h1) * x / L)[:, None], 2, axis=1)
    film = ehd.solve_film(grid, gap, lubricant=ehd.Lubricant(viscosity=mu), surface_speed=(U, 0.0), cavitation=closure)
    exact = np.array([slider.plane_slider_pressure(mu, U, L, h1, h2, s) for s in x])
    # Second order in 1/200 of the length.
    measured("pressure over its peak", float(abs(film.pressure[:, 0] - exact).max() / exact.max()), 2e-4)
    load = slider.plane_slider_load(mu, U, L, h1, h2) * 0.01
    measured("load", abs(film.load / load - 1.0), 2e-4)


def test_parabolic_slider_with_a_cavity_below_ambient(table, measured):
    """``h = hmin + (hmax - hmin)(2x/L - 1)^2``, ends at 101325 Pa, cavity at 0 Pa (absolute).

    The table is the mass-conserving solution. Up to the rupture point it and
    Swift-Stieber's are the same, because inlet pressure and ``p = p_cav, p' = 0`` at
    rupture fix them; behind it they differ. Gauge pressures: cavity at -101325 Pa.
    """
    L, h0, h1, U, mu, ambient = 76.2e-3, 25.4e-6, 50.8e-6, 4.57, 0.039, 101325.0
    grid = ehd.slider_grid(L, 0.01, 800, 1, sealed_sides=True)
    x = grid.x * L
    gap = np.repeat((h0 + (h1 - h0) * (2.0 * x / L - 1.0) ** 2)[:, None], 2, axis=1)
    film = ehd.solve_film(
        grid,
        gap,
        lubricant=ehd.Lubricant(viscosity=mu),
        surface_speed=(U, 0.0),
        cavitation=ehd.SwiftStieber(cavity_pressure=-ambient),
    )
    p = film.pressure[:, 0] + ambient
    measured("peak pressure", abs(p.max() / 3.66666e6 - 1.0), 1e-4)
    rupture = x[np.flatnonzero(p <= 1e-3)[0]]
    measured("rupture point, m (one cell is 95 um)", abs(rupture - 51.833e-3), L / 800)
    rows = [r for r in table("jfo_parabolic_slider_patm") if r["x_m"] < 50e-3]
    exact = np.interp(x[x < 49e-3], [r["x_m"] for r in rows], [r["p_Pa"] for r in rows])
    # Linear interpolation between the table's points (0.3 mm) costs about 1e-4 of the peak.
    measured("pressure over its peak", float(abs(p[x < 49e-3] - exact).max() / 3.66666e6), 5e-4)
    assert p[-1] == ambient


@pytest.mark.parametrize(("n_z", "limit"), [(100, 4e-4), (200, 1e-4)])
def test_axial_flow_through_a_conical_gap(measured, n_z, limit):
    """``h = 10 um + 6e-4 z``, 25 mm long, axial speed 22 m/s, dh/dt = -0.0132 m/s, ends at 0.8 and 10 bar.

    Any inlet: nothing varies in theta. The limits fall by four with the axial step: second order.
    """
    R, B = 0.05, 0.025
    grid = ehd.bearing_grid(R, B, 16, n_z, stretch=0.0)
    z = grid.z * R + B / 2.0
    gap = np.tile(1e-5 + 6e-4 * z, (16, 1))
    boundary = np.zeros(grid.shape)
    boundary[:, 0], boundary[:, -1] = 0.8e5, 10e5
    film = ehd.solve_film(
        grid,
        gap,
        lubricant=ehd.Lubricant(viscosity=1e-3),
        surface_speed=(0.0, 22.0),
        boundary=boundary,
        gap_rate=np.full(grid.shape, -0.0132),
    )
    worst = 0.0
    for share, printed in ((4, 1998536.0), (2, 1972128.0), (4 / 3, 1519941.0)):
        j = round(n_z / share)
        exact = slider.conical_gap_pressure(
            z[j],
            viscosity=1e-3,
            length=B,
            inlet=1e-5,
            slope=6e-4,
            speed=22.0,
            gap_rate=-0.0132,
            pressures=(0.8e5, 10e5),
        )
        assert exact == pytest.approx(printed, rel=1e-6)
        worst = max(worst, float(abs(film.pressure[:, j] / exact - 1.0).max()))
    measured(f"pressure, {n_z} intervals", worst, limit)


@pytest.mark.parametrize("closure", (ehd.SwiftStieber(), ehd.FullSommerfeld(), ehd.Gumbel()))
def test_petroff(closure):
    """d 10 mm, psi 1e-5, L 5 mm, mu 0.001 Pa s, 150 against 120 revolutions per second: 2.790537 W."""
    speed = 2.0 * math.pi * (150.0 - 120.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # psi = 1e-5 is outside the usual range, and says so
        bearing = ehd.JournalBearing(
            journal_radius=5e-3,
            length=5e-3,
            radial_clearance=5e-8,
            lubricant=ehd.Lubricant(viscosity=1e-3),
            cavitation=closure,
        )
    film = ehd.steady(bearing, speed=speed, eccentricity_ratio=0.0)
    exact = petroff.torque(1e-3, speed, 5e-3, 5e-3, 5e-8)
    assert -film.friction_torque == pytest.approx(exact, rel=1e-12)
    assert film.friction_torque_bush == pytest.approx(exact, rel=1e-12)
    # Journal and bore radius differ by psi, which the published digits depend on.
    assert film.power_loss == pytest.approx(2.790537, rel=2e-5)
    assert math.isnan(film.attitude_angle)


def test_friction_tends_to_petroff(make_bearing):
    bearing = make_bearing(1.0)
    exact = petroff.torque(0.02, 100.0, bearing.journal_radius, bearing.length, bearing.radial_clearance)
    # Even in eps: halving eps divides the excess over Petroff's torque by four.
    excess = [
        -ehd.steady(bearing, speed=100.0, eccentricity_ratio=eps).friction_torque / exact - 1.0 for eps in (0.02, 0.01)
    ]
    assert excess[0] / excess[1] == pytest.approx(4.0, rel=0.02)
    assert excess[1] < 3e-4


def test_end_pressures_drive_the_axial_flow_of_a_concentric_annulus(make_bearing):
    # Q = pi R c^3 dp / (6 mu L) from the high to the low end; the pressure falls linearly.
    bearing = make_bearing(1.0, end_pressures=(3e5, 1e5))
    film = ehd.steady(bearing, speed=0.0, eccentricity_ratio=0.0)
    np.testing.assert_allclose(
        film.pressure, 2e5 - 2e5 * film.z[None, :] / bearing.length * np.ones((96, 1)), rtol=1e-12
    )
    assert abs(film.leakage) < 1e-20
