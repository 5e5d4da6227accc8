"""Integrals over the film: readable twins, the peak, and the flows through the ends."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd import FullSommerfeld, bearing_grid
from exudyn_ehd.film import loads
from exudyn_ehd.film.loads import refined_peak
from exudyn_ehd.film.solvers.solver import FilmSolver
from tests.sampling import sample


@pytest.fixture
def field():
    rng = np.random.default_rng(0)
    return rng, rng.normal(size=(2, 9, 5, 4)), rng.random((9, 5)), rng.normal(size=(9, 5))


def test_pressure_integrals(field):
    _, shapes, weight, P = field
    out = np.empty(4)
    loads.pressure_integrals(P, weight, shapes, out)
    np.testing.assert_allclose(out, -np.tensordot(P * weight, shapes[0], 2), rtol=1e-12)


def test_couette_integral_and_gradient(field):
    rng, _, weight, _ = field
    H, active, fixed = 0.2 + rng.random((9, 5)), rng.random((9, 5)) < 0.5, rng.random((9, 5)) < 0.2
    share = np.where(active | fixed, 1.0, 0.3)
    # the half control volume of a prescribed end is as full as the vertex beside it
    share[:, [0, -1]] = np.where(fixed[:, [0, -1]], share[:, [1, -2]], share[:, [0, -1]])
    whole = loads.couette_integral(H, weight, active, fixed, 0.3)
    assert whole == pytest.approx((share * weight / H).sum(), rel=1e-13)
    gradient = np.empty_like(H)
    loads.couette_gradient(H, weight, active, fixed, 0.3, gradient)
    np.testing.assert_allclose(gradient, -share * weight / H**2, rtol=1e-13)


def test_adjoint_right_hand_sides(field):
    rng, shapes, weight, _ = field
    order = np.sort(rng.choice(45, 20, replace=False))
    active, rhs = rng.random((9, 5)) < 0.7, np.empty((4, 20))
    loads.load_adjoint_rhs(order, 20, weight, shapes, active, rhs)
    whole = -((weight * active)[..., None] * shapes[0]).reshape(-1, 4).T
    np.testing.assert_allclose(rhs, whole[:, order], rtol=1e-14)


@pytest.mark.parametrize("centre", (3.1, 0.02, 6.25))
def test_refined_peak_is_exact_for_a_parabola(centre):
    # Also across the seam of the ring; the axial vertices are not equidistant.
    x = 2 * np.pi * np.arange(32) / 32
    z = np.sin(np.linspace(-1, 1, 9))
    d = np.remainder(x - centre + np.pi, 2 * np.pi) - np.pi
    P = 5.0 - 2.0 * d[:, None] ** 2 - 3.0 * (z - 0.1) ** 2
    peak, position_x, position_z = refined_peak(P, np.zeros(P.shape, dtype=bool), x, np.full(32, 1.0), z)
    assert peak == pytest.approx(5.0, rel=1e-12)
    assert np.remainder(position_x - centre + np.pi, 2 * np.pi) - np.pi == pytest.approx(0.0, abs=1e-12)
    assert position_z == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("area", ["axial", "pocket", "around"])
@pytest.mark.parametrize("eps", [0.1, 0.3, 0.6, 0.9])
def test_refined_peak_of_a_supply_is_its_pressure(make_bearing, eps, area):
    """On every grid the same: parabolas across the edge of an area rose a fifth above it."""
    areas = {
        "axial": ehd.AxialGroove(angle=2.0, width_angle=0.4, pressure=1e8),
        "pocket": ehd.Pocket(angle=2.0, width_angle=0.6, length=0.02, pressure=1e8),
        "around": ehd.CircumferentialGroove(width=0.004, pressure=1e8),
    }
    for n_theta, n_z in ((48, 6), (96, 10)):
        b = make_bearing(film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z), supply=(areas[area],))
        film = ehd.steady(b, speed=1.0, eccentricity_ratio=eps, direction=1.0)
        assert film.peak_pressure == pytest.approx(1e8, rel=1e-9)


@pytest.mark.parametrize(
    ("ratio", "eps", "share", "grid"),
    sample(
        [(1.0, 0.8, 0.8, (96, 10)), (2.0, 0.5, 0.8, (96, 10)), (1.0, 0.8, 0.9, (192, 16)), (4.0, 0.8, 0.8, (192, 16))],
        2,
    ),
)
def test_refined_peak_beside_an_end_does_not_overshoot(ratio, eps, share, grid):
    """A tilted journal's peak one row from the end, against a fine grid; parabolas alone gave 9 to 15 % too much."""

    def peak(n_theta, n_z, turn=0.0):
        R, c, angle = 0.025, 25e-6, 0.1 + turn
        slope = share * c * (1.0 - eps) / (R * ratio)
        b = ehd.JournalBearing(
            journal_radius=R,
            length=2.0 * R * ratio,
            radial_clearance=c,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
        )
        tilt = slope * np.cos(angle), slope * np.sin(angle)
        return ehd.steady(b, speed=300.0, eccentricity_ratio=eps, direction=angle, tilt=tilt).peak_pressure

    exact = peak(480, 64)
    for turn in (0.0, np.pi / grid[0], 2.1):
        assert -0.05 < peak(*grid, turn) / exact - 1.0 < 0.03


def test_end_flows_balance_supply_and_squeeze():
    """Mass: what leaves through the ends is what the inlet line supplies minus the growth of the film's volume."""
    for seed, open_ring in ((1, False), (2, True)):
        rng = np.random.default_rng(seed)
        g = bearing_grid(1.0, 2.0, 24, 6, open_ring=open_ring)
        s = FilmSolver(g, FullSommerfeld())
        s.H[:], s.HF[:] = 0.5 + rng.random(g.shape), 0.5 + rng.random(g.shape)
        s.H_t[:] = rng.normal(size=g.shape)
        s.pressure[:, 0], s.pressure[:, -1] = 2.0, 5.0
        s.solve(3.0, 1.0, -np.inf)
        y = s.system
        lower, upper = loads.end_flows(
            s.pressure, y.kz, y.fz, y.fx, s.H_t, g.width_x, g.width_z, True, np.ones(g.shape, dtype=bool)
        )
        inflow = s.inflow()
        growth = (s.H_t * np.outer(g.width_x, g.width_z)).sum()
        scale = abs(inflow).sum()
        assert inflow.sum() == pytest.approx(growth, abs=1e-12 * scale)
        if not open_ring:
            assert -lower == pytest.approx(inflow[:, 0].sum(), abs=1e-12 * scale)
            assert -upper == pytest.approx(inflow[:, -1].sum(), abs=1e-12 * scale)
            assert lower + upper == pytest.approx(-growth, abs=1e-12 * scale)
