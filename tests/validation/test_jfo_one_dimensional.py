"""Mass-conserving cavitation against three one-dimensional films with exact solutions.

* Pocketed slider: parameters of D. Fowell, A. V. Olver, A. D. Gosman, H. A. Spikes, I. Pegg, J. Tribology 129
  (2007) 827; flow, pressure and film fraction from the closed form of every part between rupture and reformation.
* Parabolic slider with ambient pressure at both ends: quadrature of the one-dimensional film.
* Oscillating squeeze film, after L. Ausas, M. Jai, G. Buscaglia, J. Tribology 131 (2009)
  031702: ``h^3 p'' = 2 d(fill h)/dt``, h(t) = 0.125 cos(4 pi t) + 0.375, p(0) = p(1) = 0.025;
  the edge Sigma(t) of the cavity comes from an ordinary differential equation, good to 6e-4.

In one dimension a slider with sealed sides and one interval across is used.
"""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import exudyn_ehd as ehd

DATA = pathlib.Path(__file__).parent / "data"
FLOW = 5.229635e-7
REFORMATION = 3.61126e-3
SLIDER = 10e-3


def _pocket_gap(x):
    return 1.05e-6 - 0.05e-6 * x / SLIDER + np.where((x > 2e-3) & (x < 5e-3), 1e-6, 0.0)


def _pocket(n):
    grid = ehd.slider_grid(SLIDER, 1.0, n, 1, sealed_sides=True)
    x = grid.x * SLIDER
    film = ehd.solve_film(
        grid,
        np.repeat(_pocket_gap(x)[:, None], 2, axis=1),
        lubricant=ehd.Lubricant(viscosity=0.01),
        surface_speed=(1.0, 0.0),
        cavitation=ehd.ElrodAdams(),
        boundary=1e5,
        stepped_gap=True,
    )
    return x, film


def test_pocket_flow_converges_to_the_closed_form(measured):
    errors = [abs(_pocket(n)[1].inflow[0].sum() / FLOW - 1.0) for n in (100, 200, 400)]
    measured("flow at 200 cells", errors[1], 1e-3)
    # The rupture edge lies on a face and is met to half a cell, so that the flow converges with first order.
    assert errors[0] > 1.8 * errors[1] > 3.2 * errors[2]


@pytest.mark.parametrize("n", [100, 200, 400])
def test_pocket_reforms_within_one_cell(n):
    x, film = _pocket(n)
    last = x[film.fill[:, 0] < 1.0].max()
    assert abs(last - REFORMATION) <= SLIDER / n


def test_pocket_pressure_and_fill(measured):
    ref = np.genfromtxt(DATA / "jfo_fowell_pocket_slider_profile.csv", delimiter=",", names=True)
    x, film = _pocket(200)
    exact = np.interp(x, ref["x_m"], ref["p_Pa"])
    # One cell of uncertainty in the reformation moves the pressure behind it by slope * cell = 0.7 % of the peak.
    measured("pressure / peak", np.abs(film.pressure[:, 0] - exact).max() / exact.max(), 7e-3)
    cavity = (x > 2.1e-3) & (x < 3.5e-3)
    fill = np.interp(x, ref["x_m"], ref["filled_fraction"])
    # As the flow, which the cavity carries: V h fill = q.
    measured("fill in the cavity", np.abs(film.fill[:, 0] / fill - 1.0)[cavity].max(), 1e-3)


def test_mean_gap_is_first_order_at_the_steps_and_stepped_gap_is_not():
    """A linear film over a step: constant gaps, full film; stepped links give the exact flow at every grid."""
    h1, h2, p0 = 2e-6, 1e-6, 1e5
    mu, U, L = 0.01, 1.0, SLIDER
    exact = (0.5 * U * (h1**-2 + h2**-2) + 0.0) / (h1**-3 + h2**-3)
    for n, stepped in ((10, True), (40, True), (40, False)):
        grid = ehd.slider_grid(L, 1.0, n, 1, sealed_sides=True)
        gap = np.repeat(np.where(grid.x * L < L / 2, h1, h2)[:, None], 2, axis=1)
        film = ehd.solve_film(
            grid,
            gap,
            lubricant=ehd.Lubricant(viscosity=mu),
            surface_speed=(U, 0.0),
            cavitation=ehd.FullSommerfeld(),
            boundary=p0,
            stepped_gap=stepped,
        )
        error = abs(film.inflow[0].sum() / exact - 1.0)
        if stepped:
            assert error < 1e-12
        else:
            assert 1e-4 < error < 2.0 / n


@pytest.mark.parametrize("n", [100, 200, 400])
def test_parabolic_slider(n, measured):
    length = 76.2e-3
    ref = np.genfromtxt(DATA / "jfo_parabolic_slider_patm.csv", delimiter=",", names=True)
    grid = ehd.slider_grid(length, 1.0, n, 1, sealed_sides=True)
    x = grid.x * length
    gap = 25.4e-6 + 25.4e-6 * (2.0 * x / length - 1.0) ** 2
    film = ehd.solve_film(
        grid,
        np.repeat(gap[:, None], 2, axis=1),
        lubricant=ehd.Lubricant(viscosity=0.039),
        surface_speed=(4.57, 0.0),
        cavitation=ehd.ElrodAdams(),
        boundary=101325.0,
    )
    cell = length / n
    cavity = x[film.fill[:, 0] < 1.0]
    measured("rupture, cells", abs(cavity.min() - 51.833e-3) / cell, 1.0)
    measured("reformation, cells", abs(cavity.max() - 75.641e-3) / cell, 1.0)
    # Second order: 5e-4 at 100 cells.
    measured("peak pressure", abs(film.pressure.max() / 3.66666e6 - 1.0), 6e-4 * (100 / n) ** 2)
    inside = (x > 53.0e-3) & (x < 74.5e-3)
    fill = np.interp(x, ref["x_m"], ref["fill"])
    # First order: the cavity's flow is that at the rupture, met to half a cell of a gap that opens by 2.2 % per mm.
    measured("fill", np.abs(film.fill[:, 0] - fill)[inside].max(), 8e-3 * 100 / n)


@pytest.fixture(scope="module")
def squeeze():
    """500 cells, 2960 steps of 2.5e-4: times, cavity edge, fill extremes and the largest error of the oil balance."""
    n, step = 500, 2.5e-4
    grid = ehd.slider_grid(1.0, 1.0, n, 1, sealed_sides=True)
    area = np.outer(grid.width_x, grid.width_z)
    ones = np.ones(grid.shape)
    lubricant = ehd.Lubricant(viscosity=1.0 / 6.0)
    content = 0.5 * ones
    times, edges, balances, fills, rises = [], [], [], [], []
    for k in range(1, round(0.74 / step) + 1):
        t = k * step
        film = ehd.solve_film(
            grid,
            (0.125 * np.cos(4.0 * np.pi * t) + 0.375) * ones,
            lubricant=lubricant,
            cavitation=ehd.ElrodAdams(),
            boundary=0.025,
            history=content,
            step=step,
        )
        balances.append(np.sum(film.inflow) * step - np.sum(area * (film.content - content)))
        content = film.content
        cavity = grid.x[film.fill[:, 0] < 1.0]
        times.append(t)
        edges.append(cavity.min() if cavity.size else 0.5)
        fills.append((film.fill.min(), film.fill.max()))
        rises.append(cavity.size > 0)
    return step, np.array(times), np.array(edges), np.array(balances), np.array(fills), np.array(rises)


@pytest.mark.slow
def test_squeeze_opens_and_closes_within_one_step(squeeze):
    step, times, _, _, _, open_ = squeeze
    assert abs(times[open_][0] - 0.25008) <= step
    assert abs(times[open_][-1] + step - 0.73239) <= step


@pytest.mark.slow
def test_squeeze_cavity_edge(squeeze, measured):
    _, times, edges, *_ = squeeze
    ref = np.genfromtxt(DATA / "jfo_oscillating_squeeze_sigma.csv", delimiter=",", names=True, usecols=(0, 3))
    inside = (times > 0.25008 + 0.002) & (times < 0.73239)
    exact = np.interp(times[inside], ref["t"], ref["Sigma"])
    # 1 % of the scale 0.5; one cell is 0.4 % of it.
    measured("Sigma / 0.5", np.abs(edges[inside] - exact).max() / 0.5, 0.01)
    measured("Sigma_min", abs(edges.min() - 0.02301), 0.002)


@pytest.mark.slow
def test_squeeze_balances_the_oil_and_keeps_the_fill_in_bounds(squeeze):
    _, _, _, balances, fills, _ = squeeze
    # Content 0.25 to 0.5; the sum of all errors over 2960 steps.
    assert np.abs(balances).sum() < 1e-10 * 0.25
    assert fills.min() >= 0.0 and fills.max() <= 1.0


def test_history_is_checked():
    grid = ehd.slider_grid(1.0, 1.0, 10, 1, sealed_sides=True)
    ones = np.ones(grid.shape)
    oil = ehd.Lubricant(viscosity=0.1)
    with pytest.raises(ehd.InputError, match="step must be > 0"):
        ehd.solve_film(grid, ones, lubricant=oil, cavitation=ehd.ElrodAdams(), history=ones)
    with pytest.raises(ehd.InputError, match="conserve mass"):
        ehd.solve_film(grid, ones, lubricant=oil, history=ones, step=1.0)
    with pytest.raises(ehd.InputError, match="not both"):
        ehd.solve_film(grid, ones, lubricant=oil, cavitation=ehd.ElrodAdams(), history=ones, step=1.0, gap_rate=ones)
    with pytest.raises(ehd.InputError, match="shape"):
        ehd.solve_film(grid, ones, lubricant=oil, cavitation=ehd.ElrodAdams(), history=ones[1:], step=1.0)
