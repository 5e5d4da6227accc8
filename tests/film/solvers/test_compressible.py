"""Compressible film on sliders: against the ordinary differential equation,
uniform mass flow, kernels against twins."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.film.banded.factors import number_cells
from exudyn_ehd.film.banded.workspace import assemble
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.reynolds.balance import FilmTerms, film_balance, film_slopes
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.joint.model.build import build_model

MU, U, LENGTH, H0, H1 = 0.04, 10.0, 0.05, 8e-6, 4e-6
DENSITY = ehd.DowsonHigginson()
BARUS = ehd.BarusPressure(coefficient=1e-9)
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]
IN_CELLS = [
    ehd.Gumbel(line_in_cells=True),
    ehd.SwiftStieber(line_in_cells=True),
    ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True),
]


def slider(n, pressure_law=None, closure=CLOSURES[0], density=DENSITY):
    grid = ehd.slider_grid(LENGTH, LENGTH, n, 1, sealed_sides=True)
    gap = (H0 + (H1 - H0) * grid.x[:, None]) * np.ones((1, 2))
    oil = ehd.Lubricant(viscosity=MU, pressure_law=pressure_law, density_law=density)
    return grid, ehd.solve_film(grid, gap, lubricant=oil, surface_speed=(U, 0.0), cavitation=closure)


def reference(x, pressure_law):
    """Pressure at x / L: ``rho (U h / 2 - h^3 p' / (12 mu)) = m`` integrated
    from the inlet, m by shooting to p(L) = 0."""

    def course(m, dense):
        def slope(s, p):
            h = H0 + (H1 - H0) * s
            mu = MU if pressure_law is None else MU * np.exp(pressure_law.coefficient * p)
            return LENGTH * 12.0 * mu / h**3 * (0.5 * U * h - m / DENSITY.ratio(p))

        return solve_ivp(slope, (0.0, 1.0), [0.0], method="DOP853", rtol=1e-11, atol=1e-3, dense_output=dense)

    m0 = U * H0 * H1 / (H0 + H1)
    m = brentq(lambda m: course(m, False).y[0, -1], 0.97 * m0, 1.15 * m0, xtol=1e-18, rtol=1e-14)
    return course(m, True).sol(x)[0], m


@pytest.mark.parametrize("pressure_law", [None, BARUS], ids=["constant", "barus"])
def test_slider_converges_to_the_differential_equation_with_the_second_order(pressure_law):
    errors = []
    for n in (100, 200):
        grid, film = slider(n, pressure_law)
        exact, _ = reference(grid.x, pressure_law)
        errors.append(np.abs(film.pressure[:, 0] - exact).max() / exact.max())
    print(f"peak {exact.max():.3g} Pa, errors {errors}")
    assert DENSITY.ratio(exact.max()) > 1.05  # the law matters
    assert errors[1] < 1e-4  # second order, 200 cells
    assert 3.6 < errors[0] / errors[1] < 4.4


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_converging_slider_is_the_same_with_every_closure(closure):
    grid, film = slider(100, closure=closure)
    _, expected = slider(100)
    np.testing.assert_allclose(film.pressure, expected.pressure, atol=1e-11 * expected.pressure.max())  # rounding
    exact = reference(grid.x, None)[1] * LENGTH
    inflow = film.inflow[0].sum()
    assert inflow == pytest.approx(exact, rel=1e-3)  # second order, 100 cells
    assert abs(film.inflow.sum()) < 1e-12 * inflow


def bare_solver(closure, speed):
    grid = ehd.slider_grid(LENGTH, LENGTH, 80, 6, sealed_sides=True)
    solver = FilmSolver(grid, closure, density=CompressibleLaw(DENSITY, BARUS), squeeze=False)
    gap = 1.0 + 0.7 * np.cos(2.0 * np.pi * grid.x)[:, None] + 0.05 * grid.z
    solver.H[:] = gap
    solver.HF[:] = 0.5 * (gap + np.roll(gap, -1, axis=0))
    solver.pressure_scale = 12.0 * MU * LENGTH**2 / H1**2
    assert solver.solve(speed, 0.0, -0.01)[0] is ehd.Status.CONVERGED
    return solver


def test_mass_flow_is_uniform_along_a_cavitated_slider():
    """Sum over the width on every station; Elrod-Adams carries the mass through the cavity."""
    s = bare_solver(ehd.ElrodAdams(), 3.0)
    y = s.system
    flow = (y.kx * (s.pressure - np.roll(s.pressure, -1, axis=0)) + s.couette_flows()[0]).sum(axis=1)[:-1]
    assert s.rho.max() > 1.01 and s.fill.min() < 0.9
    assert np.ptp(flow) < 1e-11 * np.abs(flow).mean()


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_balance_vanishes_where_pressure_is_unknown_and_oil_leaves_nowhere_else(closure):
    s = bare_solver(closure, 3.0)
    r = np.empty(s.grid.shape)
    film_balance(s.system.linear_pressure, s.fill if closure.conserves_mass else s.ones, s.rho, s.system.terms, r)
    free = ~s.grid.fixed if closure.clips or closure.conserves_mass else s.work.active
    size = np.abs(s.system.fx).max()
    assert np.abs(r[free]).max() < 1e-12 * size  # rounding of the fluxes
    if not closure.clips:
        assert r[~s.grid.fixed].min() > -1e-12 * size


def test_balance_equals_its_twin():
    rng = np.random.default_rng(3)
    n, m = 5, 4
    P, fill, rho = rng.random((3, n, m))
    fields = rng.normal(size=(10, n, m))
    fields[1, :, -1] = fields[3, :, -1] = 0.0  # no link behind the last row
    film = FilmTerms(*fields, np.zeros((n, m), dtype=bool))
    out = np.empty((n, m))
    film_balance(P, fill, rho, film, out)
    expected = film.area * (rho * (film.grow * fill + film.known) + film.kept)
    fill = film.prompt * fill + film.late
    for axis, k, f in ((0, film.kx, film.fx), (1, film.kz, film.fz)):
        P_b, rho_b, fill_b = (np.roll(v, -1, axis=axis) for v in (P, rho, fill))
        q = k * (P - P_b) + f * np.where(f >= 0.0, fill, fill_b) * 0.5 * (rho + rho_b)
        expected += q - np.roll(q, 1, axis=axis)
    np.testing.assert_allclose(out, expected, atol=1e-14)


def test_balance_of_a_full_film_equals_the_general_one():
    rng = np.random.default_rng(4)
    n, m = 5, 4
    P, rho = rng.random((2, n, m))
    fields = rng.normal(size=(10, n, m))
    fields[1, :, -1] = fields[3, :, -1] = 0.0  # no link behind the last row
    fields[5:7], fields[8], fields[9] = 0.0, 1.0, 0.0  # no history
    film = FilmTerms(*fields, np.zeros((n, m), dtype=bool))
    out, expected = np.empty((2, n, m))
    film_balance(P, None, rho, film, out)
    film_balance(P, np.ones((n, m)), rho, film, expected)
    np.testing.assert_allclose(out, expected, atol=1e-14)


@pytest.mark.parametrize("count", [None, 5, 7])
def test_matrix_of_a_full_film_equals_the_general_one(count):
    """All vertices of a folded ring, and films of some columns."""
    rng = np.random.default_rng(5)
    n, m = 9, 4
    rho, rho_P = 1.0 + 0.1 * rng.random((2, n, m))
    fields = rng.random(size=(10, n, m))
    fields[1, :, -1] = fields[3, :, -1] = 0.0
    fields[5:7], fields[8], fields[9] = 0.0, 1.0, 0.0
    full = np.ones((n, m), dtype=bool)
    full[:, 0] = False
    if count is not None:
        full[2 : n - count + 2] = False
    film = FilmTerms(*fields, ~full)
    order, number = np.zeros(n * m, dtype=np.int64), np.zeros((n, m), dtype=np.int64)
    unknowns, width = number_cells(full, film.kx, order, number)
    found, expected = np.full((2, 2, unknowns, width + 5), np.nan)
    for fill, sides, bands in ((None, None, found), (np.ones((n, m)), full, expected)):
        slopes = np.empty((5, n * m))
        film_slopes(fill, sides, rho, rho_P, film, slopes)
        assemble(film.kx, film.kz, slopes, number, order, unknowns, *bands)
    np.testing.assert_allclose(found, expected, atol=1e-14)


@pytest.mark.parametrize("case", ["full", "partly", "cut", "across a cavity", "history"])
def test_matrix_is_the_derivative_of_the_balance(case):
    """Central differences, which are exact as the balance is linear in every
    unknown; signs of the Couette fluxes at random."""
    rng = np.random.default_rng(6)
    n, m = 8, 5
    P, rho, rho_P = 1.0 + rng.random((3, n, m))
    fill = rng.random((n, m))
    fields = rng.random(size=(10, n, m))
    fields[2:4] -= 0.5
    if case == "cut":
        fields[0, 3] = fields[2, 3] = 0.0
    fields[1, :, -1] = fields[3, :, -1] = 0.0
    if case != "history":
        fields[5:7], fields[8], fields[9] = 0.0, 1.0, 0.0
    fixed = np.zeros((n, m), dtype=bool)
    fixed[:, 0] = True
    full = ~fixed & (rng.random((n, m)) < 0.5) if case in ("partly", "cut", "history") else ~fixed
    numbered = ~fixed
    if case == "across a cavity":
        numbered = full = ~fixed & (np.arange(n) < 5)[:, None] & (rng.random((n, m)) < 0.8)
    fill[full | fixed] = 1.0
    film = FilmTerms(*fields, fixed)
    order, number = np.zeros(n * m, dtype=np.int64), np.zeros((n, m), dtype=np.int64)
    count, width = number_cells(numbered, film.kx, order, number)
    lower, upper = np.full((2, count, width + 5), np.nan)
    slopes = np.empty((5, n * m))
    film_slopes(fill, full, rho, rho_P, film, slopes)
    assemble(film.kx, film.kz, slopes, number, order, count, lower, upper)
    A = np.zeros((count, count))
    for r in range(count):
        for d in range(min(width, count - 1 - r) + 1):
            A[r, r + d] = upper[r, d]
            if d:
                A[r + d, r] = lower[r, d]
    assert np.all(lower[:, width + 1 :] == 0.0) and np.all(upper[:, width + 1 :] == 0.0)
    expected = np.zeros((count, count))
    for q in range(count):
        at = divmod(order[q], m)
        sides = []
        for h in (0.5, -0.5):
            p, f, d, out = P.copy(), fill.copy(), rho.copy(), np.empty((n, m))
            if full[at]:
                p[at] += h
                d[at] += h * rho_P[at]
            else:
                f[at] += h
            film_balance(p, f, d, film, out)
            sides.append(out.ravel()[order[:count]])
        expected[:, q] = sides[0] - sides[1]
    np.testing.assert_allclose(A, expected, atol=1e-13)


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_warm_start_and_cold_start_agree(closure):
    s = bare_solver(closure, 3.0)
    cold = s.pressure.copy()
    assert s.solve(2.5, 0.0, -0.01)[0] is ehd.Status.CONVERGED
    assert s.solve(3.0, 0.0, -0.01)[0] is ehd.Status.CONVERGED
    np.testing.assert_allclose(s.pressure, cold, atol=1e-12 * np.abs(cold).max())  # both solved to 1e-14 of the peak


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_a_film_that_comes_to_rest_is_found_at_once(closure):
    """Its pressures are those of its ends; all that Newton's steps leave is rounding, which must not count."""
    s = bare_solver(closure, 3.0)
    s.pressure[s.grid.fixed] = 0.0
    status, steps = s.solve(0.0, 0.0, -0.01)
    assert status is ehd.Status.CONVERGED and steps <= 8
    assert np.abs(s.pressure[s.work.active]).max(initial=0.0) * s.pressure_scale < 1e-6


def test_oil_beyond_the_law_has_no_pressure():
    with pytest.raises(ehd.FilmError, match="NO_PRESSURE"):
        slider(60, ehd.BarusPressure(coefficient=3e-8))


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_journal_in_the_centre_to_rounding(closure):
    """The pressures are rounding themselves: no step becomes a small share of
    them, and vertices change sides for nothing."""
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=25e-6,
        cavitation=closure,
        film=ehd.FiniteLength(n_theta=45, n_z=4),
        lubricant=ehd.Lubricant(viscosity=0.015, density_law=DENSITY),
    )
    model, rng = build_model(bearing), np.random.default_rng(0)
    for _ in range(40):
        motion = np.zeros(10)
        motion[:2] = rng.normal(size=2) * 10.0 ** rng.uniform(-22, -17)
        motion[4:6] = rng.normal(size=2) * 10.0 ** rng.uniform(-20, -14)
        motion[8] = rng.uniform(-300, 300)
        model.forget()
        found = model.evaluate(motion, model.initial_history(motion))
        assert found.status is ehd.Status.CONVERGED
        # 500 N at an eccentricity ratio of one half
        assert np.abs(found.wrench[:2]).max() < 1e-6


GROOVE = ehd.AxialGroove(angle=1.0, width_angle=0.3, pressure=2e5)
FILMS = {
    "finite": {"film": ehd.FiniteLength(n_theta=48, n_z=6)},
    "short": {"film": ehd.ShortBearing(n_theta=48, n_z=6)},
    "long": {"film": ehd.LongBearing(n_theta=48, n_z=3), "supply": (GROOVE,)},
}
CASES = [("finite", closure) for closure in IN_CELLS] + [(name, c) for name in ("short", "long") for c in CLOSURES]


@pytest.mark.parametrize(("name", "closure"), CASES, ids=lambda c: c if isinstance(c, str) else type(c).__name__)
def test_films_go_to_those_of_an_incompressible_oil(make_bearing, name, closure):
    """The less compressible an oil is, the less its films differ."""
    rng, film = np.random.default_rng(8), FILMS[name]
    if closure.conserves_mass:
        closure = dataclasses.replace(closure, cavity_pressure=-1e5)
    elif name == "short" and isinstance(closure, ehd.SwiftStieber):
        closure = ehd.SwiftStieber(line_in_cells=False)
    incompressible = build_model(make_bearing(1.0, cavitation=closure, **film))
    differences = np.empty((6, 2))
    for state in differences:
        motion = np.zeros(10)
        motion[:2] = 25e-6 * rng.uniform(0.2, 0.9) * np.array([np.cos(a := rng.uniform(0.0, 2.0 * np.pi)), np.sin(a)])
        motion[8] = 300.0
        expected = incompressible.evaluate(motion).wrench[:2]
        for k, coefficient in enumerate((1e-11, 1e-13)):
            oil = ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson(coefficient=coefficient))
            dense = build_model(make_bearing(1.0, cavitation=closure, lubricant=oil, **film))
            state[k] = np.hypot(*(dense.evaluate(motion).wrench[:2] - expected)) / np.hypot(*expected)
    assert np.all(differences[:, 0] < 0.01)  # a peak of 100 MPa compresses it by 0.1 %
    assert np.all(differences[:, 1] < 0.03 * differences[:, 0])  # in proportion, but for vertices that change sides


def _check_same(found, expected):
    """Films that are solved to some roundings of their largest entries."""
    for a, b in ((found.wrench, expected.wrench), (found.tangent(), expected.tangent())):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-12 * np.abs(b).max())


@pytest.mark.parametrize("closure", IN_CELLS, ids=lambda c: type(c).__name__)
def test_line_inside_the_cells_does_not_depend_on_the_start(make_bearing, closure):
    rng, oil = np.random.default_rng(9), ehd.Lubricant(viscosity=0.02, density_law=DENSITY, pressure_law=BARUS)
    bearing = make_bearing(1.0, cavitation=closure, film=ehd.FiniteLength(n_theta=48, n_z=6), lubricant=oil)
    warm, cold = build_model(bearing), build_model(bearing)
    for _ in range(25):
        e, a, b = 1.0 - 10.0 ** rng.uniform(-1.0, 0.0), *rng.uniform(0.0, 2.0 * np.pi, 2)
        motion = np.zeros(10)
        motion[:2] = 25e-6 * e * np.array([np.cos(a), np.sin(a)])
        motion[2:4] = 0.6 * (1.0 - e) * 25e-6 / 0.025 * np.array([np.cos(b), np.sin(b)])
        motion[8] = rng.choice([300.0, -300.0])
        found = warm.evaluate(motion)
        cold.forget()
        expected = cold.evaluate(motion)
        assert found.status is expected.status is ehd.Status.CONVERGED
        _check_same(found, expected)


@pytest.mark.parametrize("closure", [*CLOSURES, *IN_CELLS], ids=repr)
def test_vertices_that_a_turning_supply_leaves_have_no_memory(make_bearing, closure):
    """A hole that turns by a column or more between two films: the next is that of a model that saw no other."""
    rng, hole = np.random.default_rng(10), ehd.Hole(angle=0.4, diameter=9e-3, pressure=3e5, rotating=True)
    oil = ehd.Lubricant(viscosity=0.02, density_law=DENSITY)
    film = ehd.FiniteLength(n_theta=48, n_z=6)
    bearing = make_bearing(1.0, cavitation=closure, film=film, lubricant=oil, supply=(hole,), end_pressures=(1e5, 3e4))
    warm, motion = build_model(bearing), np.zeros(10)
    motion[8] = 300.0
    for k in range(20):
        a = 0.05 * k
        motion[:2] = 25e-6 * (0.6 + 0.1 * np.sin(a)) * np.array([np.cos(a), np.sin(a)])
        spin = 0.2 * k + rng.uniform(0.0, 0.2)
        _check_same(warm.evaluate(motion, spin=spin), build_model(bearing).evaluate(motion, spin=spin))
