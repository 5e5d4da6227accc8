"""Closures against slow readable references."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd import FullSommerfeld, Gumbel, InputError, Status, SwiftStieber, bearing_grid
from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.linear_film import clip_pressure
from exudyn_ehd.film.cavitation.rupture_line import fields_without_line
from exudyn_ehd.film.solvers.newton import solve_rupturing
from exudyn_ehd.film.solvers.solver import FilmSolver


def _random_gaps(solver, rng):
    """A smooth positive gap with its rate, not of a rigid journal."""
    g = solver.grid
    x, z = g.x[:, None], g.z[None, :]
    a, b = rng.uniform(-0.4, 0.4, 4), rng.normal(size=4)
    phase = rng.uniform(0, 6, 2)

    def gap(angle):
        return 1.0 + a[0] * np.cos(angle - phase[0]) + a[1] * np.cos(2 * angle - phase[1]) + 0.1 * a[2] * z

    solver.H[:] = gap(x)
    solver.HF[:] = gap(g.x_face[:, None])
    solver.H_t[:] = 20.0 * (b[0] * np.cos(x) + b[1] * np.sin(2 * x) + b[2] * z * np.sin(x))


def _projected_gauss_seidel(kx, kz, b, fixed, P, pc, tolerance=1e-14):
    """Slow reference of ``P >= pc, A P - b >= 0, (P - pc)(A P - b) = 0``: relax vertex by vertex, never below pc."""
    n, m = b.shape
    scale = max(1.0, float(abs(b).max() / kx.max()))
    for _ in range(20000):
        change = 0.0
        for i in range(n):
            for j in range(m):
                if fixed[i, j]:
                    continue
                up, down = (i + 1) % n, i - 1
                neighbours = [(kx[i, j], P[up, j]), (kx[down, j], P[down, j])]
                if j > 0:
                    neighbours.append((kz[i, j - 1], P[i, j - 1]))
                if j + 1 < m:
                    neighbours.append((kz[i, j], P[i, j + 1]))
                total = b[i, j] + sum(k * p for k, p in neighbours)
                new = max(pc, total / sum(k for k, _ in neighbours))
                change = max(change, abs(new - P[i, j]))
                P[i, j] = new
        if change < tolerance * scale:
            return P
    raise AssertionError("the reference did not converge")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("open_ring", "pc"), [(False, 0.0), (True, 0.0), (False, -3.0)])
def test_swift_stieber_solves_the_complementarity_problem(seed, open_ring, pc):
    rng = np.random.default_rng(seed)
    solver = FilmSolver(bearing_grid(1.0, 1.5, 16, 4, open_ring=open_ring), SwiftStieber())
    _random_gaps(solver, rng)
    solver.pressure[:, 0], solver.pressure[:, -1] = 0.0, 1.0
    status, _ = solver.solve(50.0, 5.0, pc)
    assert status is Status.CONVERGED
    s = solver.system
    start = np.where(s.fixed, s.pressure, pc)
    reference = _projected_gauss_seidel(s.kx, s.kz, s.b, s.fixed, start, pc)
    peak = reference.max() - pc
    # Gauss-Seidel contracts by more than 0.5 % per sweep here: changes of 1e-14 mean errors of 1e-11.
    np.testing.assert_allclose(s.pressure, reference, atol=1e-10 * peak)
    assert (s.pressure > pc)[~s.fixed].any()
    assert (s.pressure == pc)[~s.fixed].any()
    np.testing.assert_array_equal(solver.work.active & (s.pressure <= pc - 1e-12 * peak), False)


@pytest.mark.parametrize("short", (False, True))
def test_result_does_not_depend_on_the_start(short):
    """Over random states: from the last state, from a full film, and from pressures at all, no and random vertices."""
    rng = np.random.default_rng(3)
    grid = bearing_grid(1.0, 2.0, 32, 8)
    warm, cold = (FilmSolver(grid, SwiftStieber(), circumferential_pressure_flow=not short) for _ in range(2))
    for _ in range(60):
        state = rng.bit_generator.state
        fields = []
        for solver, start in ((warm, None), (cold, "cold"), (cold, "all"), (cold, "none"), (cold, "random")):
            rng.bit_generator.state = state
            _random_gaps(solver, rng)
            if start == "cold":
                solver.forget()
            elif start is not None:
                solver.work.warm = True
                solver.work.active[:] = {"all": True, "none": False}.get(start, rng.random(grid.shape) < 0.5)
            status, steps = solver.solve(50.0, 0.0, 0.0)
            assert status is Status.CONVERGED
            assert steps <= 40
            fields.append((solver.work.active.copy(), solver.pressure.copy()))
        for active, pressure in fields[1:]:
            np.testing.assert_array_equal(active, fields[0][0])
            # some roundings of the peak
            np.testing.assert_allclose(pressure, fields[0][1], rtol=0.0, atol=1e-13 * fields[0][1].max())


@pytest.mark.parametrize("pc", (0.0, -2.0))
def test_gumbel_is_the_clipped_full_sommerfeld_film(pc):
    for seed in range(5):
        solvers = [FilmSolver(bearing_grid(1.0, 2.0, 24, 6), k) for k in (FullSommerfeld(), Gumbel())]
        for solver in solvers:
            _random_gaps(solver, np.random.default_rng(seed))
            status, steps = solver.solve(50.0, 1.0, pc)
            assert status is Status.CONVERGED
            assert steps == 1
        full, clipped = (s.pressure for s in solvers)
        assert full.min() < pc  # otherwise nothing is tested
        np.testing.assert_array_equal(clipped, np.maximum(full, pc))
        np.testing.assert_array_equal(solvers[1].system.linear_pressure, full)
        free = ~solvers[1].grid.fixed
        np.testing.assert_array_equal(solvers[1].work.active, free & (full >= pc))


def test_clip_pressure_twin():
    rng = np.random.default_rng(0)
    linear, fixed = rng.normal(size=(9, 5)), rng.random((9, 5)) < 0.3
    P, active = np.empty((9, 5)), np.empty((9, 5), dtype=bool)
    clip_pressure(linear, fixed, 0.2, P, active)
    np.testing.assert_array_equal(P, np.where(fixed, linear, np.maximum(linear, 0.2)))
    np.testing.assert_array_equal(active, ~fixed & (linear >= 0.2))


def test_a_singular_start_is_reported():
    w, shape = Workspace(8, 4), (8, 4)
    fixed, zero, active = np.zeros(shape, dtype=bool), np.zeros(shape), np.ones(shape, dtype=bool)
    film, places = (
        (np.zeros((15, *shape)), fixed, zero, fields_without_line(shape)),
        (zero.copy(), w.residual, w.unknowns, None),
    )
    state = w.u, w.above, None
    found, *_ = solve_rupturing(w.size, 0.0, False, False, zero, active, state, film, w.symmetric, places)
    assert not found


@pytest.mark.parametrize("spec", (Gumbel, SwiftStieber))
@pytest.mark.parametrize(
    "options",
    [{"cavity_pressure": float("inf")}, {"cavity_pressure": "0"}, {"cavity_shear": -0.1}, {"cavity_shear": 1.1}],
)
def test_validation(spec, options):
    with pytest.raises(InputError, match=rf"{spec.__name__}\.{next(iter(options))}"):
        spec(**options)
