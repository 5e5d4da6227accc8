"""Density on a liner: a readable balance, the rigid and the incompressible limit, conservation."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.solvers.winkler import Liner

# kernels of both effects together take longer to compile than these tests to run
pytestmark = pytest.mark.slow
GRID = bearing_grid(0.02, 0.03, 32, 6)
# ten times the coefficients of mineral oil, for the pressures of these films, 3e6 Pa
SCALE, DENSITY = 1e5, ehd.DowsonHigginson(coefficient=6e-9, saturation=1.7e-8)
VX, VZ, BETA, STEP = 50.0, 3.0, 0.003, 1e-3
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]
every_closure = pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)


def on_liner(closure, density=DENSITY):
    law = None if density is None else CompressibleLaw(density, None)
    return FilmSolver(GRID, closure, density=law, liner=Liner(oil=law))


def solve(solver, beta=BETA, eps=0.6, mass_old=None, delta_old=None, step=0.0):
    """Film of a parallel journal that approaches, with unknowns of 0.5 and 1 at the ends."""
    solver.pressure_scale = SCALE
    if solver.elements is not None:
        solver.elements.beta, solver.elements.delta_old = beta, delta_old
    solver.H[:], solver.HF[:], solver.H_t[:] = undeformed(eps)
    solver.pressure[:, 0], solver.pressure[:, -1] = 0.5, 1.0
    status, _ = solver.solve(VX, VZ, solver.closure.cavity_pressure, mass_old, step)
    assert status is ehd.Status.CONVERGED
    return solver


def undeformed(eps):
    along = np.ones(GRID.z.size)
    gaps = [np.outer(1.0 - eps * np.cos(x - 0.3), along) for x in (GRID.x, GRID.x_face)]
    return np.array([*gaps, -20.0 * np.outer(np.cos(GRID.x), along)])


def pressures(solver):
    """Scaled true pressures (n, m)."""
    return solver.oil_fields(solver.law, None).P


def transformed(p):
    """Integral of rho dp of Dowson and Higginson's law, scaled, in closed form."""
    a, b, p = DENSITY.coefficient, DENSITY.saturation, p * SCALE
    above = np.maximum(p, 0.0)
    dense = above + a / b * (above - np.log1p(b * above) / b)
    return np.where(p >= 0.0, dense, np.expm1(a * np.minimum(p, 0.0)) / a) / SCALE


def balance(P, p, fill, beta, eps, delta_old, mass_old):
    """Mass balance of every vertex (n, m), outflow plus storage, for the unknowns P and the elements' pressures p."""
    rigid, on_links, rate = undeformed(eps)
    rho, D = DENSITY.ratio(p * SCALE), beta * p
    H, area = rigid + D, np.outer(GRID.width_x, GRID.width_z)

    def after(v):
        return np.roll(v, -1, axis=0)

    h, d = on_links + 0.5 * (D + after(D)), 0.5 * (after(D) - D)
    q = VX * h * fill * 0.5 * (rho + after(rho)) - h * (h**2 + d**2) * GRID.link_x[:, None] * (after(P) - P)
    q *= GRID.width_z
    r = q - np.roll(q, 1, axis=0)
    h, d = 0.5 * (H[:, :-1] + H[:, 1:]), 0.5 * np.diff(D)
    q = VZ * h * fill[:, :-1] * 0.5 * (rho[:, :-1] + rho[:, 1:])
    q = (q - h * (h**2 + d**2) * GRID.link_z * np.diff(P)) * GRID.width_x[:, None]
    r[:, :-1] += q
    r[:, 1:] -= q
    if mass_old is not None:
        return r + area * (rho * fill * H - mass_old) / STEP
    feeding = 0.0 if delta_old is None else (D - delta_old) / STEP
    return r + area * rho * fill * (rate + feeding)


@pytest.mark.parametrize("motion", ["steady", "step"])
@every_closure
def test_solution_meets_the_readable_balance(closure, motion):
    """1e-11 of the largest flow: the error at which the iteration ends, times the largest conductance."""
    solver, mass, delta = on_liner(closure), None, None
    if motion == "step":
        before = solve(solver, eps=0.55)
        delta, mass = before.elements.deflection, before.content if closure.conserves_mass else None
    s = solve(solver, mass_old=mass, delta_old=delta, step=STEP if motion == "step" else 0.0)
    P, fill = s.system.linear_pressure, s.fill if closure.conserves_mass else np.ones(GRID.shape)
    p = pressures(s)
    assert DENSITY.ratio(p.max() * SCALE) > 1.01 and s.elements.deflection.max() > 0.09  # both matter
    pressed = np.maximum(P, 0.0) if closure.clips else P
    np.testing.assert_allclose(transformed(p), pressed, atol=1e-11 * p.max())
    r = balance(P, p, fill, BETA, 0.6, delta, mass)
    flow = np.abs(VX * s.H).max() * GRID.width_z.max()
    unknown = ~GRID.fixed if closure.clips or closure.conserves_mass else s.work.active
    assert np.abs(r[unknown]).max() < 1e-11 * flow
    assert r[~GRID.fixed].min() > -1e-11 * flow


@every_closure
def test_stiff_liner_approaches_the_compressible_film_at_first_order(closure):
    rigid = pressures(solve(FilmSolver(GRID, closure, density=CompressibleLaw(DENSITY, None))))
    found = [pressures(solve(on_liner(closure), beta)) for beta in (2e-6, 1e-6, 1e-13)]
    first, second, rest = (np.abs(p - rigid).max() / rigid.max() for p in found)
    assert second < 1e-2 and first / second == pytest.approx(2.0, rel=0.02)  # next order
    assert rest < 1e-9  # errors at which both iterations end


@every_closure
def test_faint_density_law_approaches_the_incompressible_film_at_first_order(closure):
    plain = solve(on_liner(closure, None)).pressure.copy()
    laws = [ehd.DowsonHigginson(coefficient=a, saturation=1.7e-8) for a in (2e-11, 1e-11, 1e-18)]
    found = [pressures(solve(on_liner(closure, law))) for law in laws]
    first, second, rest = (np.abs(p - plain).max() / plain.max() for p in found)
    assert 0.0 < second < 1e-2 and first / second == pytest.approx(2.0, rel=0.02)  # next order
    assert rest < 1e-9  # errors at which both iterations end


def test_mass_is_kept_over_a_transient():
    """An orbit on a soft liner: what enters is what rho fill H gains, to 1e-10 of the flows at every step."""
    s = solve(on_liner(ehd.ElrodAdams()), 0.01, 0.3)
    mass, delta, lowest, densest = s.content, s.elements.deflection, 1.0, 1.0
    for k in range(60):
        solve(s, 0.01, 0.85 * (0.6 + 0.4 * np.sin(0.2 * k)), mass, delta, 4e-4)
        inflow, gain = s.inflow(), (s.content - mass) * s.area / 4e-4
        assert inflow.sum() == pytest.approx(gain.sum(), abs=1e-10 * (np.abs(inflow).sum() + np.abs(gain).sum()))
        lowest, densest = min(lowest, s.fill.min()), max(densest, s.rho.max())
        mass, delta = s.content, s.elements.deflection
    assert lowest < 0.8 and densest > 1.02
