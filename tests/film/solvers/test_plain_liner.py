"""Elastic liner: kernels against readable twins, limits, independence of the start, refusals."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.solvers.liner import failure
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.solvers.winkler import Liner

GRID = bearing_grid(0.02, 0.03, 32, 6)
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber()]
every_closure = pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)


def gaps(eps, angle=0.3, rate=0.0):
    """Gap at vertices and links and the gap's rate of a parallel journal."""

    def row(x):
        return np.outer(1.0 - eps * np.cos(x - angle), np.ones(GRID.z.size))

    return row(GRID.x), row(GRID.x_face), -rate * np.outer(np.cos(GRID.x), np.ones(GRID.z.size))


def solve(closure, beta, eps=0.6, rate=0.0, cold=True, solver=None, delta_old=None, step=0.0):
    solver = solver or FilmSolver(GRID, closure, liner=Liner())
    solver.elements.beta = beta
    solver.H[:], solver.HF[:], solver.H_t[:] = gaps(eps, rate=rate)
    solver.elements.delta_old = delta_old
    if cold:
        solver.forget()
    status, _ = solver.solve(50.0, 3.0, closure.cavity_pressure, None, step)
    assert status is ehd.Status.CONVERGED
    return solver


def balance(rigid, P, D, vx, vz, beta, inverse_step, delta_old):
    """Outflow - inflow + squeeze of every vertex, link by link; D is the pressure that the liner feels."""
    n, m = P.shape
    r = np.zeros((n, m))
    for i in range(n):
        for j in range(m):
            h = rigid[1, i, j] + beta * (D[i, j] + D[(i + 1) % n, j]) / 2
            d = beta * (D[(i + 1) % n, j] - D[i, j]) / 2
            mean_cube = ((h - d) ** 3 + (h - d) ** 2 * (h + d) + (h - d) * (h + d) ** 2 + (h + d) ** 3) / 4
            q = GRID.width_z[j] * (vx * h - mean_cube * GRID.link_x[i] * (P[(i + 1) % n, j] - P[i, j]))
            r[i, j] += q
            r[(i + 1) % n, j] -= q
            if j + 1 < m:
                h = (rigid[0, i, j] + rigid[0, i, j + 1] + beta * (D[i, j] + D[i, j + 1])) / 2
                d = beta * (D[i, j + 1] - D[i, j]) / 2
                mean_cube = ((h - d) ** 3 + (h - d) ** 2 * (h + d) + (h - d) * (h + d) ** 2 + (h + d) ** 3) / 4
                q = GRID.width_x[i] * (vz * h - mean_cube * GRID.link_z[j] * (P[i, j + 1] - P[i, j]))
                r[i, j] += q
                r[i, j + 1] -= q
            rate = rigid[2, i, j] + (beta * D[i, j] - delta_old[i, j]) * inverse_step
            r[i, j] += rate * GRID.width_x[i] * GRID.width_z[j]
    return r


@every_closure
def test_balance(closure):
    """The kernels' balance of a state that no film has, against its twin: rounding."""
    rng, pc = np.random.default_rng(4), 0.1
    solver = FilmSolver(GRID, closure, liner=Liner())
    e = solver.elements
    e.beta, solver.vx, solver.vz, e.rates = 0.02, 2.0, -1.0, e.rates._replace(liner=3.0)
    solver.system.cavity_pressure = pc
    e.rigid[:] = [0.3 + rng.random(GRID.shape), 0.3 + rng.random(GRID.shape), rng.normal(size=GRID.shape)]
    e.rigid_film[:] = e.rigid[0]
    e.deflection_old[:] = rng.random(GRID.shape)
    P = e.P
    P[:] = 1.0 + rng.normal(size=GRID.shape)
    D = np.where(GRID.fixed | (not closure.clips), P, np.maximum(P, pc))
    norm, smallest = e.balance()
    assert smallest > 0.0 and norm > 0.0
    expected = balance(e.rigid, P, D, 2.0, -1.0, 0.02, 3.0, e.deflection_old)
    np.testing.assert_allclose(e.residual, expected, atol=1e-12)


@every_closure
def test_solution_keeps_its_conditions(closure):
    """Balance at vertices under pressure, complementarity at the others; 1e-9 of the largest Couette flux."""
    s = solve(closure, 0.002, rate=10.0)
    rigid = np.array(gaps(0.6, rate=10.0))
    P = s.system.linear_pressure
    r = balance(rigid, P, s.pressure, 50.0, 3.0, 0.002, 0.0, np.zeros(GRID.shape))
    scale = 50.0 * GRID.width_z.max()
    free = ~GRID.fixed
    if type(closure) is ehd.SwiftStieber:
        assert s.pressure.min() >= 0.0
        assert np.all(r[free & (P <= 0.0)] >= -1e-9 * scale)
        free &= P > 0.0
    assert np.abs(r[free]).max() < 1e-9 * scale
    np.testing.assert_allclose(s.H, rigid[0] + 0.002 * s.pressure, atol=1e-15)


@every_closure
def test_stiff_liner_approaches_the_rigid_bore_at_first_order(closure):
    plain = FilmSolver(GRID, closure)
    plain.H[:], plain.HF[:], plain.H_t[:] = gaps(0.6)
    plain.solve(50.0, 3.0, closure.cavity_pressure)
    errors = [np.abs(solve(closure, beta).pressure - plain.pressure).max() for beta in (4e-6, 2e-6, 1e-6)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates, 1.0, atol=0.02)


@every_closure
def test_the_start_changes_no_result(closure):
    """Cold, warm from afar and warm from nearby: 1e-12 of the peak, the error at which the iteration ends."""
    cold = solve(closure, 0.003).pressure.copy()
    for eps in (0.1, 0.85, 0.6):
        warm = solve(closure, 0.003, eps=eps)
        again = solve(closure, 0.003, cold=False, solver=warm).pressure
        np.testing.assert_allclose(again, cold, atol=1e-12 * np.abs(cold).max())


def test_heavy_and_soft_films_converge():
    """Eccentricity to 0.995 and liners from stiff to soft, cold and warm; no more than 60 solves were seen, cold."""
    for eps in (0.5, 0.9, 0.99, 0.995):
        for beta in (1e-6, 1e-4, 1e-3, 1e-2, 0.1):
            solver = solve(ehd.SwiftStieber(), beta, eps=eps)
            assert solver.pressure.min() >= 0.0 and solver.H.min() > 0.0


def test_a_bore_that_touches_at_its_ends_has_no_film():
    """An element with a prescribed pressure can't deflect, so the gap closes there."""
    solver = FilmSolver(GRID, ehd.SwiftStieber(), liner=Liner())
    solver.elements.beta = 0.01
    solver.H[:], solver.HF[:], solver.H_t[:] = gaps(1.01)
    assert solver.solve(50.0, 0.0, 0.0)[0] is ehd.Status.NO_FILM


def test_rate_of_the_liner_is_backward_euler():
    """A step from a relaxed liner feeds it: the balance of the twin with the
    deflection's rate, and the steady film in the end."""
    closure, beta, step = ehd.SwiftStieber(), 0.01, 1e-3
    old = np.zeros(GRID.shape)
    s = solve(closure, beta, delta_old=old, step=step)
    P = s.pressure
    r = balance(np.array(gaps(0.6)), P, P, 50.0, 3.0, beta, 1.0 / step, old)
    assert np.abs(r[~GRID.fixed & (P > 0.0)]).max() < 1e-9 * 50.0
    for _ in range(300):
        s = solve(closure, beta, solver=s, cold=False, delta_old=s.elements.deflection.copy(), step=step)
    np.testing.assert_allclose(s.pressure, solve(closure, beta).pressure, atol=1e-8 * P.max())


def test_pressure_at_an_instant_is_that_of_the_deflection():
    """A liner that has no time to deflect keeps its pressure; 1e-6 s against a period of 0.1 s: below 1e-3."""
    s = solve(ehd.SwiftStieber(), 0.01)
    before = s.pressure.copy()
    after = solve(ehd.SwiftStieber(), 0.01, eps=0.5, delta_old=s.elements.deflection.copy(), solver=s).pressure
    np.testing.assert_allclose(after, before, atol=1e-3 * before.max())


def test_compliance():
    """t / E for nu = 0; K_nu = 1.3 * 0.4 / 0.7 for nu = 0.3."""
    assert ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9, poisson_ratio=0.0).compliance == pytest.approx(1e-12)
    assert ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9).compliance == pytest.approx(1e-12 * 0.52 / 0.7)


@pytest.mark.parametrize(("option", "value"), [("thickness", 0.0), ("youngs_modulus", -1.0), ("poisson_ratio", 0.5)])
def test_refused_values(option, value):
    with pytest.raises(ehd.InputError, match=rf"ElasticLiner\.{option}"):
        ehd.ElasticLiner(**({"thickness": 1e-3, "youngs_modulus": 1e9} | {option: value}))


@pytest.mark.parametrize("closure", CLOSURES[1:], ids=lambda c: type(c).__name__)
def test_a_film_at_rest_carries_nothing(closure):
    """A soft liner, nearly touched, without speed or rate: no pressure against
    the one that would open it to its clearance, 1 / beta."""
    solver = FilmSolver(GRID, closure, liner=Liner())
    solver.elements.beta = 0.1
    solver.H[:], solver.HF[:], _ = gaps(0.994)
    solver.H_t[:] = 0.0
    assert solver.solve(0.0, 0.0, 0.0)[0] is ehd.Status.CONVERGED
    assert np.abs(solver.pressure).max() < 1e-12 / solver.elements.beta


def test_a_film_that_breaks_always_exists():
    """Soft to stiff liners, nearly touched, under speeds and rates of any
    direction and two orders of size: 150 films from afar and from a dry guess."""
    rng, solver = np.random.default_rng(3), FilmSolver(GRID, ehd.SwiftStieber(), liner=Liner())
    for k in range(150):
        x, rate = 0.3 + GRID.x, 10.0 ** rng.uniform(-1.0, 4.0) * rng.choice([0.0, 1.0])
        waves = rng.normal(size=2)[:, None] * np.array([np.cos(x), np.sin(x)])
        solver.elements.beta = 10.0 ** rng.uniform(-5.0, 0.5)
        solver.H[:], solver.HF[:], _ = gaps(rng.choice([0.5, 0.9, 0.99, 0.995]))
        solver.H_t[:] = rate * np.outer(waves.sum(axis=0), GRID.z / GRID.z.max() if k % 2 else np.ones(GRID.z.size))
        if k % 3 == 0:
            solver.forget()
        status, _ = solver.solve(rng.choice([-50.0, 0.0, 15.0, 150.0]), rng.choice([0.0, 10.0]), 0.0)
        assert status is ehd.Status.CONVERGED, k
        assert solver.pressure.min() >= 0.0


def test_separation_pulls_a_soft_liner_shut():
    """Without cavitation the film between surfaces that part, followed from a stiff to a
    soft liner, loses its smallest gap before it ends: to 1 % of the rigid one and less, so
    that no film of a softer liner is left to be found. Without separation it never ends."""
    closure, beta, factor = ehd.FullSommerfeld(), 1e-4, 2.0
    solver = solve(closure, beta, eps=0.5, rate=-30.0)
    while factor > 1.001:
        solver.elements.beta = factor * beta
        solver.H[:], solver.HF[:], solver.H_t[:] = gaps(0.5, rate=-30.0)
        before = solver.pressure.copy()
        if solver.solve(50.0, 3.0, -np.inf)[0] is ehd.Status.CONVERGED:
            beta, smallest = solver.elements.beta, solver.H.min()
        else:
            factor = factor**0.5
            solver.pressure[:] = before
            solver.work.warm = True
    assert smallest < 0.01 * 0.5
    solver.elements.beta = 4.0 * beta
    solver.H[:], solver.HF[:], solver.H_t[:] = gaps(0.5, rate=-30.0)
    assert solver.solve(50.0, 3.0, -np.inf)[0] is ehd.Status.NO_FILM
    assert solve(closure, 1e4, eps=0.5).H.min() > 0.1


def bearing_on_liner(closure, modulus, length, n_theta, n_z):
    from exudyn_ehd.joint.model.build import build_model

    return build_model(
        ehd.JournalBearing(
            journal_radius=0.01, length=length, radial_clearance=2e-5, lubricant=ehd.Lubricant(viscosity=0.04),
            film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z), cavitation=closure,
            bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=modulus),
        )
    )  # fmt: skip


@pytest.mark.parametrize("closure", CLOSURES[1:], ids=lambda c: type(c).__name__)
def test_a_journal_that_only_slides_along_meets_no_pressure(closure):
    """Aligned, a hair from the bore: the flows balance to rounding at no
    pressure, and no step of Newton's would ever be small."""
    model = bearing_on_liner(closure, 1e8, 0.005, 64, 16)
    evaluation = model.evaluate(np.array([1.9e-5, 4.4e-6, 0, 0, 0, 0, 0, 0, 0, -0.57]))
    assert evaluation.status is ehd.Status.CONVERGED
    assert np.abs(model.solver.pressure).max() * model.solver.elements.beta < 1e-10
    assert np.all(np.isfinite(evaluation.tangent()))


def test_suction_that_is_cut_off_spoils_no_balance():
    """A linear film 1e5 times deeper below the cavity pressure than above it:
    the balance of the pressures holds to 1e-9 of its flows."""
    model = bearing_on_liner(ehd.Gumbel(), 7e10, 0.04, 64, 10)
    model.evaluate(
        np.array([-2.08374301e-06, -1.98784312e-05, 0, 0, -2.16895329e-05, 2.79668814e-05, -2.7e-03, -1.4e-04, 0, 0])
    )
    s = model.solver
    P = s.system.linear_pressure
    assert P.min() < -1e5 * P.max() < 0.0
    e = s.elements
    e.balance()
    flow = np.abs(e.rigid[2] * s.area).max()
    assert np.abs(e.residual[~model.grid.fixed]).max() < 1e-9 * flow


@pytest.mark.slow
def test_suction_that_runs_away_is_balanced_or_refused():
    """Nearly touched on a very soft liner, sliding along: Newton's linear pressure may run away where it is cut off."""
    model = bearing_on_liner(ehd.Gumbel(), 22720070.59878464, 0.02, 64, 16)
    pose = [1.897821657490344e-05, 6.05064336175497e-06, 0.0, 0.0]
    rates = [5.530549888546489e-08, 2.4800040097862752e-08, 5.4381030559481384e-06, 4.051467557530033e-06]
    evaluation = model.evaluate(np.array([*pose, *rates, 0.0, -1.2016321297850399]))
    if evaluation.status is ehd.Status.CONVERGED:
        e = model.solver.elements
        e.balance()
        assert np.abs(e.residual[~model.grid.fixed]).max() < 1e-6 * np.abs(e.film.system.terms.fz).max()
    else:
        assert evaluation.status is ehd.Status.NOT_CONVERGED
        assert np.isnan(evaluation.wrench).all()


def test_status_of_films_that_are_not_found():
    """Tension that may pull the liner shut: no film to be found; else the closure did not settle."""
    for closure, cavity_load, status in (
        (ehd.FullSommerfeld(), 0.0, ehd.Status.NO_FILM),
        (ehd.SwiftStieber(), -20.0, ehd.Status.NO_FILM),
        (ehd.SwiftStieber(), -1.0, ehd.Status.NOT_CONVERGED),
        (ehd.Gumbel(), 0.0, ehd.Status.NOT_CONVERGED),
    ):
        solver = FilmSolver(GRID, closure, liner=Liner())
        e = solver.elements
        e.beta, e.rigid[0], e.cavity_load = 0.01, 0.1, cavity_load
        assert failure(e) is status
