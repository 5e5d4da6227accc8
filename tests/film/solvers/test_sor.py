"""The paper's scheme: twin of the difference equations, convergence, relaxation, tangent, what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.solvers.sor import best_relaxation, coefficients, sor_solve
from exudyn_ehd.joint.model.build import build_model

MOTION = np.array([8e-6, -12e-6, 1e-4, -2e-4, 2e-4, 1e-3, 5e-3, -8e-3, 150.0, 0.02])


def _dense_solution(H, H_t, vx, vz, dx, dz):
    """Plain twin: scaled Eq. (9) as a dense system, p = 0 at both ends."""
    n, m = H.shape
    A, b = np.zeros((n * m, n * m)), np.zeros(n * m)
    for i in range(n):
        for j in range(m):
            r = i * m + j
            if j in (0, m - 1):
                A[r, r] = 1.0
                continue
            h, east, west = H[i, j], ((i + 1) % n, j), (i - 1, j)
            north, south = (i, j + 1), (i, j - 1)
            hx, hz = (H[east] - H[west]) / (2 * dx), (H[north] - H[south]) / (2 * dz)
            for (a, c), sign, slope, d in (
                (east, 1, hx, dx),
                (west, -1, hx, dx),
                (north, 1, hz, dz),
                (south, -1, hz, dz),
            ):
                A[r, (a % n) * m + c] += h**3 / d**2 + sign * 3 * h**2 * slope / (2 * d)
            A[r, r] -= 2 * h**3 / dx**2 + 2 * h**3 / dz**2
            b[r] = vx * hx + vz * hz + H_t[i, j]
    return np.linalg.solve(A, b).reshape(n, m)


def test_twin():
    n, m = 24, 7
    theta, z = 2 * np.pi * np.arange(n) / n, np.linspace(-1.0, 1.0, m)
    H = 1.0 - 0.6 * np.cos(theta)[:, None] - 0.1 * np.outer(np.sin(theta), z)
    H_t = 3.0 * np.sin(theta)[:, None] * np.ones(m)
    dx, dz = theta[1], z[1] - z[0]
    fixed = np.zeros((n, m), dtype=bool)
    fixed[:, 0] = fixed[:, -1] = True
    P = np.zeros((n, m))
    a = coefficients(H, H_t, True, (10.0, 2.0), (dx, dz))
    assert sor_solve(a, fixed, 1.6, 1e-14, 10_000, P) > 0
    exact = _dense_solution(H, H_t, 10.0, 2.0, dx, dz)
    # The sweeps stop at relative changes of 1e-14.
    assert np.abs(P - exact).max() < 1e-11 * np.abs(exact).max()


def test_second_order_and_the_same_limit_as_finite_volumes(make_bearing, measured):
    def load(n_theta, n_z):
        film = ehd.ClassicSOR(n_theta=n_theta, n_z=n_z, tolerance=1e-11)
        return ehd.steady(
            make_bearing(film=film, cavitation=ehd.Gumbel()), speed=100.0, eccentricity_ratio=0.6
        ).sommerfeld_number

    coarse, middle, fine = load(48, 12), load(96, 24), load(192, 48)
    order = math.log2(abs(coarse - middle) / abs(middle - fine))
    # Clipping at whole vertices leaves a ripple of the same order.
    assert 1.6 < order < 2.6
    reference = ehd.steady(
        make_bearing(film=ehd.FiniteLength(n_theta=384, n_z=24), cavitation=ehd.Gumbel()),
        speed=100.0,
        eccentricity_ratio=0.6,
    ).sommerfeld_number
    measured("load against finite volumes", abs(fine / reference - 1.0), 5e-4)


def test_rule_11_stops_early(make_bearing, measured):
    """The load at the paper's tolerance 1e-5 is off by more than the tolerance, but by less than the grid's error."""

    def force(tolerance):
        film = ehd.ClassicSOR(n_theta=96, n_z=24, tolerance=tolerance)
        return ehd.steady(make_bearing(film=film, cavitation=ehd.Gumbel()), speed=100.0, eccentricity_ratio=0.8).force[
            :2
        ]

    exact = force(1e-13)
    error = np.linalg.norm(force(1e-5) - exact) / np.linalg.norm(exact)
    assert error > 1e-5
    measured("true error at tolerance 1e-5", error, 1e-3)


def test_best_relaxation_needs_the_fewest_sweeps(make_bearing):
    """The chosen factor is within 20 % of the best of a scan, here at eccentricity ratio 0.8."""

    def sweeps(relaxation):
        film = ehd.ClassicSOR(n_theta=64, n_z=16, tolerance=1e-8, relaxation=relaxation)
        bearing = make_bearing(film=film, cavitation=ehd.Gumbel())
        return ehd.steady(bearing, speed=100.0, eccentricity_ratio=0.8).iterations

    assert sweeps(None) <= 1.2 * min(sweeps(r) for r in (1.0, 1.5, 1.7, 1.75, 1.8, 1.85, 1.9, 1.95))
    assert 1.0 < best_relaxation(8, 0.1, 0.25) < best_relaxation(64, 0.1, 0.03) < 2.0


def test_tangent_against_differences(make_bearing):
    film = ehd.ClassicSOR(n_theta=32, n_z=8, tolerance=1e-15)
    model = build_model(make_bearing(film=film, cavitation=ehd.Gumbel()))
    evaluation = model.evaluate(MOTION)
    tangent, active = evaluation.tangent(), model.solver.work.active.copy()
    scale = np.array([1e-6, 1e-6, 1e-4, 1e-4, 1e-3, 1e-3, 1e-2, 1e-2, 10.0, 0.1])
    for k in range(10):
        step = np.zeros(10)
        step[k] = 1e-4 * scale[k]
        wrenches = []
        for sign in (1.0, -1.0):
            wrenches.append(model.evaluate(MOTION + sign * step).wrench)
            np.testing.assert_array_equal(model.solver.work.active, active)
        numeric = (wrenches[0] - wrenches[1]) / (2e-4 * scale[k])
        size = np.array([1.0] * 3 + [0.025] * 3) * np.linalg.norm(evaluation.wrench[:3]) / scale[k]
        # Differences of second order: 1e-8 of the curvature; sweeps stop at 1e-15, over 1e-4.
        assert np.all(np.abs(numeric - tangent[:, k]) < 1e-6 * size), k


def test_depends_on_the_state_alone(make_bearing):
    model = build_model(make_bearing(film=ehd.ClassicSOR(n_theta=32, n_z=8), cavitation=ehd.Gumbel()))
    first = model.evaluate(MOTION).wrench
    model.evaluate(0.5 * MOTION)
    np.testing.assert_array_equal(model.evaluate(MOTION).wrench, first)


def test_supply_is_refused(make_bearing):
    groove = (ehd.AxialGroove(angle=1.5, width_angle=0.4, pressure=1e5),)
    with pytest.raises(ehd.InputError, match=r"supply must be \(\) with film=ClassicSOR"):
        make_bearing(film=ehd.ClassicSOR(), cavitation=ehd.Gumbel(), supply=groove)


def test_equilibrium(make_bearing, measured):
    """It carries loads like the other films."""
    results = []
    for film in (ehd.ClassicSOR(n_theta=128, n_z=32, tolerance=1e-9), ehd.FiniteLength(n_theta=128, n_z=16)):
        bearing = make_bearing(film=film, cavitation=ehd.Gumbel())
        results.append(ehd.equilibrium(bearing, speed=100.0, load=(0.0, -2000.0)))
    # Grid errors of both, 0.2 % of the load.
    measured("eccentricity ratio", abs(results[0].eccentricity_ratio - results[1].eccentricity_ratio), 2e-3)


def test_divergence_is_reported(make_bearing):
    """The scheme loses its diagonal in a gap that changes severalfold between points; finite volumes do not."""
    bearing = make_bearing(film=ehd.ClassicSOR(n_theta=16, n_z=8, relaxation=1.99), cavitation=ehd.Gumbel())
    with pytest.raises(ehd.FilmError, match="NOT_CONVERGED"):
        ehd.steady(bearing, speed=100.0, eccentricity_ratio=0.995)


@pytest.mark.parametrize(
    "values, message",
    [
        ({"n_theta": 8}, "n_theta must be an integer >= 16"),
        ({"n_z": 2}, "n_z must be an integer >= 4"),
        ({"tolerance": 0.0}, "tolerance must be > 0"),
        ({"relaxation": 2.0}, "between 0 and 2"),
    ],
)
def test_refused_values(values, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.ClassicSOR(**values)


def test_needs_gumbel(make_bearing):
    with pytest.raises(ehd.InputError, match=r"cavitation=Gumbel\(\)"):
        make_bearing(film=ehd.ClassicSOR())
