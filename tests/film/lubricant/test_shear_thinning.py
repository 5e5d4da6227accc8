"""Carreau's law: formula, limits, derivatives, and the tangent viscosity along the sliding direction."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.shear_thinning import power_table, powers, thin_conductance, thin_flux, thin_viscosity

LAW = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)
TABLE = power_table(-0.2)


def test_limits():
    assert LAW.ratio(0.0) == 1.0
    assert LAW.ratio(1e30) == pytest.approx(0.2, abs=1e-9)  # (1e24)^-0.4 is left
    steep = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)
    assert steep.ratio(2e12) / steep.ratio(1e12) == pytest.approx(2.0**-0.4, rel=1e-10)  # power law n - 1
    assert ehd.CarreauShear(relaxation_time=1e-6, exponent=1.0).ratio(1e7) == 1.0


@pytest.mark.parametrize("n", [0.05, 0.5, 0.9, 1.0])
def test_table_of_powers(n):
    """Quintic Hermite on 2048 intervals, up to a rate of 50 / lambda and beyond."""
    e = 0.5 * (n - 1.0)
    table = power_table(e)
    speed, gap = -2.0, np.append(1e300, 2.0 / np.geomspace(1e-6, 1e4, 4001))[None]
    found = np.empty_like(gap)
    powers(gap, speed, e, table, found)
    np.testing.assert_allclose(found, (1.0 + (speed / gap) ** 2) ** e, rtol=1e-12)
    mirrored = np.empty_like(gap)
    powers(-gap, speed, e, table, mirrored)  # what a solver tries on its way must not leave the table
    np.testing.assert_array_equal(mirrored, found)


@pytest.mark.parametrize("vx", [0.0, 40.0, -150.0])
def test_viscosity_kernel(vx):
    """Formula at the rate 2 R vx / (c H), and its derivatives against central differences."""
    H = np.random.default_rng(3).uniform(0.2, 2.0, (4, 3))
    k = 2.0 * 0.025 * 1e-6 / 25e-6

    def ratio(h, v):
        return LAW.ratio(2.0 * 0.025 * v / (25e-6 * h))

    r, r_h, r_v = (np.empty_like(H) for _ in range(3))
    thin_viscosity(H, vx, k, 0.6, 0.2, TABLE, r, r_h, r_v)
    d = 1e-5
    np.testing.assert_allclose(r, ratio(H, vx), rtol=1e-12)  # the table of powers
    np.testing.assert_allclose(
        r_h, (ratio(H + d, vx) - ratio(H - d, vx)) / (2 * d), atol=1e-8
    )  # step^2 and rounding / step
    np.testing.assert_allclose(r_v, (ratio(H, vx + d) - ratio(H, vx - d)) / (2 * d), atol=1e-10)


@pytest.mark.parametrize("tangent", [True, False])
def test_conductance_kernel(tangent):
    """H^3 over the viscosity that a small disturbance meets: d(mu G)/dG along the sliding, mu across it."""
    H = np.random.default_rng(4).uniform(0.2, 2.0, (4, 3))
    k, vx = 2e-3, 150.0

    def conductance(h, v):
        g, out_h, out_v = h**3, 3.0 * h**2, np.zeros_like(h)
        thin_conductance(h, v, k, 0.6, 0.2, TABLE, tangent, g, out_h, out_v)
        return g, out_h, out_v

    g, g_h, g_v = conductance(H, vx)
    rate, d = k * vx / H / 1e-6, 1.0
    stress = [LAW.ratio(rate + s * d) * (rate + s * d) for s in (-1.0, 1.0)]
    met = (stress[1] - stress[0]) / (2.0 * d) if tangent else LAW.ratio(rate)
    np.testing.assert_allclose(g, H**3 / met, rtol=1e-9)  # rounding of stresses of size 1e5
    s = 1e-5
    np.testing.assert_allclose(
        g_h, (conductance(H + s, vx)[0] - conductance(H - s, vx)[0]) / (2 * s), rtol=1e-7, atol=1e-8
    )
    np.testing.assert_allclose(
        g_v, (conductance(H, vx + s)[0] - conductance(H, vx - s)[0]) / (2 * s), rtol=1e-6, atol=1e-9
    )


@pytest.mark.parametrize("vx", [0.0, 150.0, -4e4])
def test_conductances_from_scratch(vx):
    """`thin_flux` is H^3 and its derivatives through `thin_conductance`, also
    beyond the table's end (a rate of 50 / lambda)."""
    gap_x, H = np.random.default_rng(5).uniform(0.2, 2.0, (2, 5, 4))
    gap_z, *found = (np.empty_like(H) for _ in range(7))
    law = (vx, 2e-3, 0.6, 0.2, TABLE)
    thin_flux(H, gap_x, *law, gap_z, *found)
    np.testing.assert_array_equal(gap_z, np.column_stack((0.5 * (H[:, :-1] + H[:, 1:]), H[:, -1])))
    for gap, tangent, (g, g_h, g_v) in ((gap_x, True, found[:3]), (gap_z, False, found[3:])):
        expected = gap**3, 3.0 * gap**2, np.zeros_like(gap)
        thin_conductance(gap, *law, tangent, *expected)
        np.testing.assert_allclose(g, expected[0], rtol=1e-14)
        np.testing.assert_allclose(g_h, expected[1], rtol=1e-13)
        np.testing.assert_allclose(g_v, expected[2], rtol=1e-13)


def test_couette_shear_of_a_bearing_is_the_law():
    """Concentric film: friction torque = Petroff's with the viscosity at the rate R omega / c."""
    torque = []
    for law in (None, LAW):
        oil = ehd.Lubricant(viscosity=0.02, shear_law=law)
        b = ehd.JournalBearing(journal_radius=0.025, length=0.05, radial_clearance=25e-6, lubricant=oil)
        torque.append(ehd.steady(b, speed=500.0, eccentricity_ratio=0.0).friction_torque)
    assert torque[1] / torque[0] == pytest.approx(LAW.ratio(0.025 * 500.0 / 25e-6), rel=1e-12)


def test_input_errors():
    with pytest.raises(ehd.InputError, match=r"CarreauShear\.relaxation_time"):
        ehd.CarreauShear(relaxation_time=0.0, exponent=0.5)
    with pytest.raises(ehd.InputError, match="must not exceed 1"):
        ehd.CarreauShear(relaxation_time=1e-6, exponent=1.5)
    grid = ehd.slider_grid(0.1, 0.1, 10, 4)
    with pytest.raises(ehd.InputError, match="shear_law must be None"):
        ehd.solve_film(grid, np.full(grid.shape, 1e-5), lubricant=ehd.Lubricant(viscosity=0.02, shear_law=LAW))
