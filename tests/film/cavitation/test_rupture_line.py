"""A rupture line inside the cells: what it solves, from wherever it starts, and what it makes of the coefficients."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.reynolds.gap import rigid_gap
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange, powers
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import Status
from tests.sampling import but_slow

LINE = SwiftStieber(line_in_cells=True)


def _films(closure, sizes=((24, 6, 2.0), (33, 7, 0.5), (48, 8, 4.0))):
    return [FilmSolver(bearing_grid(1.0, length, n, nz), closure) for n, nz, length in sizes]


def _random_film(film, rng):
    """Gaps, rates, known pressures and supplies of a random film; returns (vx, vz, pc)."""
    g, P = film.grid, film.pressure
    cos_x, sin_x, cos_f, sin_f, z = g.directions
    left = 10.0 ** rng.uniform(-2.0, 0.0)
    a, b = rng.uniform(0.0, 2.0 * np.pi, 2)
    tilt = rng.choice([0.0, rng.random()]) * left / z[-1]
    pose = np.array([(1.0 - left) * np.cos(a), (1.0 - left) * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)])
    rates = (
        rng.normal(size=4) * [1.0, 1.0, 1.0 / z[-1], 1.0 / z[-1]] * rng.choice([0.0, 10.0 ** rng.uniform(-2.0, 2.0)])
    )
    for e, cos, sin, start, out in (
        (pose, cos_x, sin_x, 1.0, film.H), (pose, cos_f, sin_f, 1.0, film.HF), (rates, cos_x, sin_x, 0.0, film.H_t)
    ):  # fmt: skip
        rigid_gap(e, cos, sin, z, start, out)
    waves = 0.4 * left * rng.random() * np.cos(z * rng.integers(0, 3))
    along = rng.integers(1, 9)
    film.H += np.cos(along * g.x)[:, None] * waves
    film.HF += np.cos(along * g.x_face)[:, None] * waves
    np.maximum(film.H, 0.3 * left, out=film.H)
    np.maximum(film.HF, 0.3 * left, out=film.HF)
    P[:, 0], P[:, -1] = rng.choice([0.0, 1.0]) * 10.0 ** rng.uniform(-2.0, 2.0, 2)
    g.fixed[:, 1:-1] = False
    if rng.random() < 0.3:
        columns, rows = rng.integers(len(g.x)) + np.arange(rng.integers(1, 4)), slice(2, rng.integers(3, len(z) - 1))
        g.fixed[columns % len(g.x), rows] = True
        P[columns % len(g.x), rows] = 10.0 ** rng.uniform(-2.0, 1.0)
    film.refresh_fixed()
    return (
        rng.choice([-1.0, 0.0, 1.0, 30.0]),
        rng.choice([0.0, rng.normal()]),
        rng.choice([0.0, -(10.0 ** rng.normal())]),
    )


def _violation(film, pc, dense_matrix):
    """Residual of ``sqrt(2 k p) + sqrt(2 r) = sqrt(f)`` at the line and of ``p r = 0`` elsewhere, over the flows."""
    s, fixed = film.system, film.grid.fixed
    p = s.pressure - pc
    r = (dense_matrix(s.kx, s.kz) @ p.ravel()).reshape(p.shape) - s.b
    flows = np.abs(s.b).max() + np.abs(s.kx * p).max() + np.abs(s.kz * p).max()
    near = fixed | np.roll(fixed, 1, 0) | np.roll(fixed, -1, 0)
    k, f = 0.5 * (s.kx + np.roll(s.kx, 1, 0)), np.where(near, 0.0, np.maximum(-s.b, 0.0))
    assert p[~fixed].min() >= 0.0
    assert r[~fixed].min() > -1e-12 * flows - 1e-25
    root = np.sqrt(2.0 * k * np.maximum(p, 0.0)) + np.sqrt(2.0 * np.maximum(r, 0.0))
    # beyond the curve's ends one of the two is zero: full film, or nothing but the cavity's pressure
    between = np.where(2.0 * k * p >= f, np.abs(r), np.abs(root - np.sqrt(f)) * np.sqrt(f))
    lack = np.where(p > 0.0, between, np.maximum(0.5 * f - r, 0.0))
    return np.where(fixed, 0.0, lack).max() / max(flows, 1e-15)


def _check_states(count, seed, dense_matrix):
    rng, most = np.random.default_rng(seed), 0
    pairs = list(zip(_films(LINE), _films(LINE), strict=True))
    for k in range(count):
        warm, cold = pairs[rng.integers(len(pairs))]
        same = rng.integers(2**31)
        known = _random_film(warm, np.random.default_rng(same))
        assert _random_film(cold, np.random.default_rng(same)) == known
        cold.forget()
        for film in (warm, cold):
            status, steps = film.solve(*known)
            assert status is Status.CONVERGED, (seed, k)
            most = max(most, steps)
        # films at rest have no peak, only what is left of the last film
        peak = np.abs(cold.pressure - known[2]).max() + 1e-3
        assert np.abs(warm.pressure - cold.pressure).max() <= 1e-12 * peak, (seed, k)
        assert _violation(cold, known[2], dense_matrix) < 1e-10, (seed, k)
    return most


def test_random_films_meet_the_conditions_from_any_start(dense_matrix):
    """The problem has one solution: of 100 random films, each after another one and alone."""
    assert _check_states(100, 1, dense_matrix) <= 60


@pytest.mark.slow
def test_many_random_films(dense_matrix):
    assert _check_states(6000, 2, dense_matrix) <= 100


def test_a_supply_that_comes_and_goes_is_that_of_a_cold_film():
    """The factor of the film before belongs to other unknowns."""
    warm, cold = (_films(LINE, ((33, 7, 2.0),))[0] for _ in range(2))
    for columns in ((), (5, 6), (7,), ()):
        cold.forget()
        for film in (warm, cold):
            film.H_t[:] = 0.0
            for gap, x in ((film.H, film.grid.x), (film.HF, film.grid.x_face)):
                gap[:] = (1.0 - 0.7 * np.cos(x))[:, None]
            film.grid.fixed[:, 1:-1] = False
            film.grid.fixed[list(columns), 3] = True
            film.pressure[list(columns), 3] = 0.2
            film.refresh_fixed()
            assert film.solve(1.0, 0.0, -1.0)[0] is Status.CONVERGED
        assert np.abs(warm.pressure - cold.pressure).max() < 1e-12 * cold.pressure.max()


def test_films_without_a_line_are_those_of_the_grid():
    """Both closures find one film, to rounding, at rest and with pressure built up everywhere by the wedge."""
    rng = np.random.default_rng(0)
    for line, plain in zip(_films(LINE), _films(SwiftStieber()), strict=True):
        for film in (line, plain):
            film.H[:] = film.HF[:] = 1.0
            film.H_t[:] = -1.0
            film.pressure[:, -1] = 0.3
            assert film.solve(0.0, 0.0, 0.0)[0] is Status.CONVERGED
        assert np.abs(line.pressure - plain.pressure).max() < 1e-13 * plain.pressure.max()
        rows = rng.normal(size=(2, line.work.count))
        found = rows.copy(), rows.copy()
        for film, lam in zip((line, plain), found, strict=True):
            film.solve_transposed(lam)
        assert np.abs(found[0] - found[1]).max() < 1e-12
        for film in (line, plain):
            film.H_t[:], film.pressure[:] = 0.0, 0.0
            assert film.solve(0.0, 0.0, 0.0)[0] is Status.CONVERGED
        assert not line.pressure.any() and line.work.count == plain.work.count


def _coefficients(film, ratio, eccentricity, directions, closure, **options):
    """Stiffness and damping in the axes of the load over W, (directions, 8), and the load."""
    c, R = 25e-6, 0.025
    bearing = ehd.JournalBearing(
        **{"lubricant": ehd.Lubricant(viscosity=0.02)} | options, journal_radius=R, length=2.0 * R * ratio,
        radial_clearance=c, film=film, cavitation=closure,
    )  # fmt: skip
    model, out, loads = build_model(bearing), [], []
    for a in directions:
        evaluation = model.evaluate(
            np.array([c * eccentricity * np.cos(a), c * eccentricity * np.sin(a), 0, 0, 0, 0, 0, 0, 100.0, 0])
        )
        force, tangent = evaluation.wrench[:2], evaluation.tangent()[:2]
        W, b = np.hypot(*force), np.arctan2(-force[1], -force[0])
        T = np.array([[np.cos(b), np.sin(b)], [-np.sin(b), np.cos(b)]])
        K, B = (T @ part @ T.T * c / W for part in (-tangent[:, :2], -50.0 * tangent[:, 4:6]))
        out.append(np.concatenate((K.ravel(), B.ravel())))
        loads.append(W)
    return np.array(out), np.array(loads)


def _error(film, ratio, eccentricity, closure, reference, directions):
    got, loads = _coefficients(film, ratio, eccentricity, directions, closure)
    mean, load = reference
    return np.abs((got - mean) / np.maximum(1.0, np.abs(mean))).max(), np.abs(loads / load - 1.0).max()


def _reference(ratio, eccentricity, sizes, closure=LINE):
    """Means over the line's place on two grids, extrapolated at order two."""
    means = []
    for n, nz in sizes:
        places = np.linspace(0.0, 2.0 * np.pi / n, 4, endpoint=False) + 0.3
        got, loads = _coefficients(ehd.FiniteLength(n_theta=n, n_z=nz), ratio, eccentricity, places, closure)
        means.append((got.mean(axis=0), loads.mean()))
    (a, f), (b, g) = means
    return b + (b - a) / 3.0, g + (g - f) / 3.0


def test_coefficients_do_not_know_where_the_line_lies(measured):
    """16 directions on a coarse grid: 0.6 % with the line in its cells, above 4 % with it on the grid."""
    directions, film = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.0123, ehd.FiniteLength(n_theta=64, n_z=8)
    directions += np.arange(16) * 0.7 * np.pi / 64
    reference = _reference(1.0, 0.6, ((96, 12), (192, 24)))
    measured("line in cells", _error(film, 1.0, 0.6, LINE, reference, directions)[0], 0.01)
    assert _error(film, 1.0, 0.6, SwiftStieber(line_in_cells=False), reference, directions)[0] > 0.04


@pytest.mark.slow
def test_few_rows_with_a_large_stretch(measured):
    """84 x 4 with a stretch of 0.85, as `FiniteLength` says: random bearings, the line anywhere in its cell."""
    rng, few, worst = np.random.default_rng(5), ehd.FiniteLength(n_theta=84, n_z=4, stretch=0.85), np.zeros(3)
    for k in range(16):
        ratio, eccentricity = rng.uniform(0.5, 1.1), rng.uniform(0.1, 0.8)
        # the edges of what is said, the README's bearing first
        ratio, eccentricity = (1.1, 0.5, 0.9, ratio)[k % 4], 0.8 if k < 8 else eccentricity
        reference = _reference(ratio, eccentricity, ((96, 16), (192, 32)))
        places = 2.0 * np.pi / 84 * np.arange(16) / 16 + rng.uniform(0.0, 2.0 * np.pi)
        entry, load = _error(few, ratio, eccentricity, LINE, reference, places)
        worst = np.maximum(worst, (load, entry, entry if ratio >= 0.9 else 0.0))
    measured("load", worst[0], 0.001)
    measured("entries of K and C from L/D 0.5", worst[1], 0.017)
    measured("entries of K and C from L/D 0.9", worst[2], 0.01)


def test_heat_is_the_power_of_the_motion():
    """Power balance of steady films, less the work that presses oil out: oil at the line has the cavity pressure."""
    rng = np.random.default_rng(3)
    bearing = ehd.JournalBearing(
        journal_radius=0.025, length=0.03, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=8), cavitation=SwiftStieber(line_in_cells=True, cavity_pressure=-2e4),
    )  # fmt: skip
    model = build_model(bearing)
    for _ in range(5):
        e, a = 25e-6 * rng.uniform(0.3, 0.95), rng.uniform(0.0, 2.0 * np.pi)
        film = model.evaluate(np.array([e * np.cos(a), e * np.sin(a), 0, 0, 0, 0, 0, 0, 300.0, 0.0])).film
        pressed_out = -bearing.cavitation.cavity_pressure * film.parts.flow_scale * -np.sum(OilFlows(film, 1.0).outside)
        assert np.any(model.solver.line.s < 1.0)
        assert heat_and_exchange(film, 1.0)[0] == pytest.approx(powers(film).loss - pressed_out, rel=1e-9)


def test_what_does_not_know_the_line_is_refused(make_bearing):
    with pytest.raises(ehd.InputError, match="line_in_cells=True does not go with"):
        make_bearing(
            1.0, cavitation=LINE, film=ehd.ShortBearing(), lubricant=ehd.Lubricant(viscosity=0.02, shear_law=CARREAU)
        )
    make_bearing(1.0, film=ehd.ShortBearing(), lubricant=ehd.Lubricant(viscosity=0.02, shear_law=CARREAU))


@pytest.mark.parametrize("cavity_pressure", [0.0, -5e4])
def test_a_film_that_forgets_is_found_as_a_first_one_is(make_bearing, cavity_pressure):
    """A solver that forgets its film is as fast as a new one: old pressures must not stay in the new cavity.

    The line of a full film has at most half of the columns to go, one in each iteration.
    """
    bearing = make_bearing(4.0, cavitation=SwiftStieber(cavity_pressure=cavity_pressure))
    rng, model, c = np.random.default_rng(8), build_model(bearing), bearing.radial_clearance
    for _ in range(12):
        e, a = rng.uniform(0.3, 0.95), rng.uniform(0.0, 2.0 * np.pi)
        motion = np.array([e * c * np.cos(a), e * c * np.sin(a), 0, 0, 0, 0, 0, 0, rng.choice([-100.0, 100.0]), 0])
        model.forget()
        found, first = model.evaluate(motion), build_model(bearing).evaluate(motion)
        assert found.status is first.status is Status.CONVERGED
        assert found.iterations == first.iterations <= model.grid.shape[0] // 2


def test_a_line_that_has_far_to_go(make_bearing):
    """The line moves by a column a step, and has 240 to go."""
    bearing = make_bearing(4.0, film=ehd.FiniteLength(n_theta=480, n_z=9))
    c = bearing.radial_clearance
    motion = np.array([0.56 * c, 0.28 * c, 0, 0, 0, 0, 0, 0, 100.0, 0])
    found = build_model(bearing).evaluate(motion)
    assert found.status is Status.CONVERGED
    assert found.iterations > 100


CARREAU = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)
PLACES = {
    "plain": ({}, True),
    "long": ({"film": ehd.LongBearing(), "supply": (ehd.AxialGroove(angle=2.0, width_angle=0.3),)}, True),
    "map": ({"film": ehd.ImpedanceMap()}, True),
    "short": ({"film": ehd.ShortBearing()}, True),
    "short, shear": (
        {"film": ehd.ShortBearing(), "lubricant": ehd.Lubricant(viscosity=0.02, shear_law=CARREAU)},
        False,
    ),
    "liner": ({"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)}, True),
    "density": ({"lubricant": ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson())}, True),
    "shear": (
        {"lubricant": ehd.Lubricant(viscosity=0.02, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7))},
        True,
    ),
}


@pytest.mark.parametrize("name", but_slow(PLACES, "map", "liner", "density"))
def test_where_the_line_lies_by_default(make_bearing, name):
    """Inside the cells where the film knows it; None is bit by bit what `JournalBearing.closure` names."""
    options, in_cells = PLACES[name]
    bearing = make_bearing(1.0, **options)
    assert bearing.cavitation.line_in_cells is None
    assert bearing.closure == SwiftStieber(line_in_cells=in_cells)
    motion = np.array([0.7 * bearing.radial_clearance, 0, 0, 0, 0, 0, 0, 0, 100.0, 0.0])
    models = [build_model(b) for b in (bearing, make_bearing(1.0, **{**options, "cavitation": bearing.closure}))]
    wrenches = [m.evaluate(motion, m.initial_history(motion), 1e-4).wrench for m in models]
    np.testing.assert_array_equal(*wrenches)
    if name != "map":
        solver = models[0].solver
        assert (solver.line is not None or solver.system.column_line is not None) == in_cells


def test_other_closures_do_not_leave_it_open(make_bearing):
    for closure in (ehd.Gumbel(), ehd.FullSommerfeld(), ehd.ElrodAdams(cavity_pressure=-1e5)):
        assert make_bearing(1.0, cavitation=closure).closure is closure
        assert closure.line_in_cells is False


def test_the_option_is_a_truth_or_open():
    with pytest.raises(ehd.InputError, match=r"SwiftStieber\.line_in_cells must be True or False"):
        SwiftStieber(line_in_cells="cell")
    with pytest.raises(ehd.InputError, match=r"Gumbel\.line_in_cells must be True or False"):
        ehd.Gumbel(line_in_cells=None)
    assert SwiftStieber().line_in_cells is None
