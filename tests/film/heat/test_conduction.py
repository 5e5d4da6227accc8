"""Rings of a wall against closed forms of annulus and rod, and against scipy in time; the film's parabola."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import i0, i1

import exudyn_ehd as ehd
from exudyn_ehd.film.heat.energy import through_surfaces
from exudyn_ehd.film.heat.options import Rings
from tests.sampling import sample

R, L, THICKNESS, G, K = 0.025, 0.04, 0.02, 3.0, 45.0
CAPACITY = 7800.0 * 460.0


def bush(columns, rings=8, **options):
    wall = ehd.Conduction(**({"thickness": THICKNESS, "conductance": G, "rings": rings} | options))
    return Rings(wall, R, L, columns, inward=False)


def steady(rings, heat):
    """Temperatures (columns, k) over the ambient for the heat (columns,) into the surface, W."""
    rings.bring_to(0.0)
    nothing = np.zeros((rings.columns, rings.radii.size))
    return rings.behind(np.linalg.solve(rings.matrix(), heat), nothing)


@pytest.mark.parametrize("columns", [1, 12, 15])
def test_steady_annulus_is_the_logarithmic_profile(columns):
    """T = Q / G + Q ln(r_o / r) / (2 pi k L), to rounding on any rings."""
    rings = bush(columns, rings=3)
    T = steady(rings, np.full(columns, 50.0 / columns))
    exact = 50.0 / G + 50.0 * np.log(rings.radii[-1] / rings.radii) / (2.0 * math.pi * K * L)
    np.testing.assert_allclose(T, np.tile(exact, (columns, 1)), rtol=1e-12)


@pytest.mark.parametrize("order", [1, 3])
def test_heat_that_varies_with_the_angle(order):
    """A cos(n theta) of heat: (r / R)^n and (r / R)^-n with both boundary conditions; of second order."""
    far, errors = R + THICKNESS, []
    coefficient = G / (2.0 * math.pi * far * L)
    for refine in (1, 2):
        columns = 24 * refine
        rings = bush(columns, rings=6 * refine)
        theta = 2.0 * math.pi / columns * np.arange(columns)
        flux = 1e4  # W/m2
        T = steady(rings, flux * np.cos(order * theta) * 2.0 * math.pi * R * L / columns)
        s = far / R
        # T = a rho^n + b rho^-n with rho = r / R, k dT/dr = -flux at R, -k dT/dr = coefficient T at far
        rows = [
            [-K * order / R, K * order / R],
            [(K * order / far + coefficient) * s**order, (coefficient - K * order / far) * s**-order],
        ]
        a, b = np.linalg.solve(rows, [flux, 0.0])
        rho = rings.radii / R
        exact = np.outer(np.cos(order * theta), a * rho**order + b * rho**-order)
        errors.append(np.abs(T - exact).max() / np.abs(exact).max())
    assert errors[0] < 8e-3 * order
    assert 3.6 < errors[0] / errors[1] < 4.4


def test_steady_rod_that_loses_heat_all_over_its_section():
    """k (T'' + T' / r) = g T with g = G / (pi R^2 L): I_0(m r), m^2 = g / k; of second order."""
    m, errors = math.sqrt(20.0 / (math.pi * R**2 * L) / K), []
    for count in (8, 16):
        wall = ehd.Conduction(thickness=R, conductance=20.0, rings=count)
        rings = Rings(wall, R, L, 1, inward=True)
        T = steady(rings, np.array([50.0]))
        exact = 50.0 / (2.0 * math.pi * R * L * K * m) * i0(m * rings.radii) / i1(m * R)
        errors.append(np.abs(T - exact).max() / exact[0])
        assert np.sum(rings.loss * T) == pytest.approx(50.0, rel=1e-12)
    assert errors[0] < 1e-2
    assert 3.3 < errors[0] / errors[1] < 4.7


def _fine(inward, heat, end):
    """Temperatures at the surface, on 400 cells with their values in the middle, by scipy's stiff solver."""
    far, n = (0.0 if inward else R + THICKNESS), 400
    faces = np.linspace(R, far, n + 1)
    r, volume = 0.5 * (faces[1:] + faces[:-1]), np.abs(np.diff(faces**2)) * math.pi * L
    between = K * 2.0 * math.pi * faces[1:-1] * L / abs(r[1] - r[0])
    loss = G * volume / volume.sum() if inward else np.zeros(n)
    half = K * 2.0 * math.pi * 0.5 * (r[-1] + far) * L / abs(r[-1] - far)
    outer = 0.0 if inward else 1.0 / (1.0 / half + 1.0 / G)

    def rate(_, T):
        flow = between * (T[:-1] - T[1:])
        q = -loss * T
        q[0] += heat
        q[:-1] -= flow
        q[1:] += flow
        q[-1] -= outer * T[-1]
        return q / (CAPACITY * volume)

    T = solve_ivp(rate, (0.0, end), np.zeros(n), method="BDF", rtol=1e-8, atol=1e-8).y[:, -1]
    return T[0] + heat * abs(R - r[0]) / (K * 2.0 * math.pi * R * L), float(T @ volume / volume.sum())


@pytest.mark.parametrize("inward", sample([False, True], 0))
def test_warming_up_in_time(inward):
    """Surface and mean under sudden heat after 20 s: first order in the step, and the rings' own error below it."""
    heat, end = 100.0, 20.0
    surface, mean = _fine(inward, heat, end)
    errors = []
    for steps in (50, 100):
        wall = ehd.Conduction(thickness=R if inward else THICKNESS, conductance=G, rings=24)
        rings = Rings(wall, R, L, 1, inward=inward)
        rings.bring_to(end / steps)
        T = np.zeros((1, rings.radii.size))
        for _ in range(steps):
            T = rings.behind((np.array([heat]) + rings.remembered(T)) / rings.stiffness, T)
        errors.append(T[0, 0] - surface)
        assert float(T[0] @ rings.share) == pytest.approx(mean, rel=2e-3)
    assert abs(errors[1]) < 2e-3 * surface
    assert abs(2.0 * errors[1] - errors[0]) < 1e-3 * surface


def test_a_step_keeps_the_heat():
    """Heat in = stored + given off at every step of random heat, to rounding."""
    rng, rings = np.random.default_rng(5), bush(15)
    rings.bring_to(0.7)
    T, surface = 10.0 * rng.random((15, rings.radii.size)), rng.random(15)
    new = rings.behind(surface, T)
    heat = rings.matrix() @ surface - rings.remembered(T)
    assert heat.sum() == pytest.approx(np.sum(rings.store * (new - T)) + np.sum(rings.loss * new), rel=1e-11)


@pytest.mark.parametrize("sides", [(None, None), (None, 3e3), (0.0, None), (2e3, 5e3), (1e9, 0.0)])
def test_heat_through_the_surfaces_is_that_of_a_parabola(sides):
    """T(y) = a + b y + d y^2 from its mean and both sides' conditions, solved at each of random places."""
    rng, k = np.random.default_rng(1), 0.13
    h, area, mean = 1e-5 * (1.0 + rng.random((3, 2))), rng.random((3, 2)), 330.0 + 20.0 * rng.random((3, 2))
    walls = [320.0 + 10.0 * rng.random((3, 1)), np.array([[325.0]])]
    got = sum(through_surfaces(k / h, area, sides)[..., j] * T for j, T in enumerate([mean, *walls]))
    for i in np.ndindex(h.shape):
        y, T1, T2 = h[i], walls[0][i[0], 0], 325.0
        rows, right = [[1.0, y / 2.0, y * y / 3.0]], [mean[i]]
        for U, T, at, sign in ((sides[0], T1, 0.0, 1.0), (sides[1], T2, y, -1.0)):
            value, slope = np.array([1.0, at, at * at]), sign * k * np.array([0.0, 1.0, 2.0 * at])
            rows.append(value if U is None else U * value - slope)
            right.append(T if U is None else U * T)
        _, b, d = np.linalg.solve(rows, right)
        assert got[0][i] == pytest.approx(area[i] * k * b, rel=1e-7, abs=1e-6)
        assert got[1][i] == pytest.approx(-area[i] * k * (b + 2.0 * d * y), rel=1e-7, abs=1e-6)
