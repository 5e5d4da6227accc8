"""A rupture line inside the cells on liners, and with density and shear laws."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.grid import bearing_grid, slider_grid
from exudyn_ehd.joint.heat.power import heat_and_exchange, powers
from exudyn_ehd.joint.model.build import build_model
from tests.film.cavitation.test_rupture_line import _coefficients

pytestmark = pytest.mark.slow

C, R, L = 25e-6, 0.025, 0.05
LINE, PLAIN = (ehd.SwiftStieber(line_in_cells=where) for where in (True, False))
DENSE, THIN = ehd.DowsonHigginson(), ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)
LINER = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)


def _oil(**laws):
    return {"lubricant": ehd.Lubricant(viscosity=0.02, **laws)}


CASES = {
    "shear": _oil(shear_law=THIN),
    "density": _oil(density_law=DENSE),
    "both": _oil(shear_law=THIN, density_law=DENSE),
    "liner": {"bush": LINER},
    "soft liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e7)},
    "liner, wall": {"bush": LINER, "contact": ehd.RegularisedWall(onset=0.4 * C, pressure=2e7)},
    "liner, laws": _oil(density_law=DENSE, shear_law=THIN, pressure_law=ehd.BarusPressure(coefficient=1e-8))
    | {"bush": LINER},
}


def _model(cavitation=LINE, film=None, **options):
    plain = {
        "journal_radius": R, "length": L, "radial_clearance": C, "film": film or ehd.FiniteLength(n_theta=48, n_z=8),
        "cavitation": cavitation,
    }  # fmt: skip
    return build_model(ehd.JournalBearing(**plain | _oil() | options))


def _motion(rng, most):
    """Eccentric and tilted, at rest or in motion, with either spin."""
    left, (a, b) = rng.uniform(0.1, most), rng.uniform(0.0, 2.0 * np.pi, 2)
    tilt = rng.uniform(0.0, 0.5) * (1.0 - left) * C / R
    rates = rng.normal(size=4) * 30.0 * C * np.array([1.0, 1.0, 1.0 / R, 1.0 / R]) * rng.choice([0.0, 1.0])
    place = C * left * np.cos(a), C * left * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)
    return np.array([*place, *rates, rng.choice([-100.0, 50.0, 300.0]), rng.choice([0.0, 1.0])])


@pytest.mark.parametrize("name", CASES)
def test_films_do_not_know_their_start(name):
    """Random states, each after another one and alone, some of them close by."""
    rng = np.random.default_rng(7)
    warm, cold = (_model(end_pressures=(1e5, 3e4), **CASES[name]) for _ in range(2))
    found, last = 0, None
    for _ in range(60):
        motion = _motion(rng, 1.0 if "liner" in name else 0.97)
        if last is not None and rng.random() < 0.5:
            motion = last + 0.02 * (motion - last)
        last = motion
        cold.solver.forget()
        status = [model.evaluate(motion).status for model in (warm, cold)]
        assert status[0] is status[1]
        if status[0] is ehd.Status.CONVERGED:
            found += 1
            peak = np.abs(cold.solver.pressure).max()
            assert np.abs(warm.solver.pressure - cold.solver.pressure).max() < 1e-12 * peak
    assert found > 50


# Soft liners that close in on a journal: from a dry guess Newton's method alone comes to rest elsewhere.
# Bearing's length, journal's motion and what else there is.
CREEPING = (
    (0.02, [1.1907e-5, 1.5754e-5, -1.027e-5, 3.5576e-8, -0.35015, 0.46135, -54.548, 27.06, 3000.0, 0.0],
     {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=4.6625e8), "end_pressures": (1.532e5, 4.1334e5),
      "film": ehd.FiniteLength(n_theta=96), "contact": ehd.RegularisedWall(onset=6e-7, pressure=1e9)}),
    (0.02, [5.5929e-6, -1.92e-5, 1.8593e-7, -6.7994e-8, -0.14829, -0.10721, -4.5135, 1.987, -1427.8, 0.0],
     {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=7.7013e7), "end_pressures": (9.4135e5, 6.834e5),
      "film": ehd.FiniteLength(n_theta=96),
      "asperity": ehd.GreenwoodTripp(composite_roughness=4e-7, composite_modulus=1e11)}),
)  # fmt: skip


@pytest.mark.parametrize(("length", "motion", "options"), CREEPING, ids=("wall", "asperities"))
def test_pseudo_time_leads_to_films_with_their_line(length, motion, options):
    """Alone, and after a film close by: the same."""
    options = {"journal_radius": 0.01, "length": length, "radial_clearance": 2e-5, **options}
    oil = ehd.Lubricant(viscosity=0.04)
    model = _model(ehd.SwiftStieber(cavity_pressure=-1e5), **(options | {"lubricant": oil}))
    found = []
    for k in range(2):
        film = model.evaluate(np.array(motion))
        assert film.status is ehd.Status.CONVERGED
        assert film.iterations > 100 or k
        found.append(model.solver.pressure.copy())
        assert np.any(model.solver.line.s < 1.0)
        assert model.evaluate(np.array(motion) * (1.0 - 1e-4)).status is ehd.Status.CONVERGED
    assert np.abs(found[1] - found[0]).max() < 1e-12 * found[0].max()


VANISHING = {
    "shear": _oil(shear_law=ehd.CarreauShear(relaxation_time=1e-11, exponent=0.7)),
    "density": _oil(density_law=ehd.DowsonHigginson(coefficient=1e-20)),
    "liner": {"bush": ehd.ElasticLiner(thickness=1e-6, youngs_modulus=1e17)},
}


def _fed_in(line):
    """N (n, m) of `exudyn_ehd.film.cavitation.rupture_line`."""
    return np.where(line.s < 1.0, 0.5 * line.f * (1.0 - line.s) ** 2, 0.0)


@pytest.mark.parametrize("name", VANISHING)
def test_what_vanishes_leaves_the_plain_film(name):
    """Wrench, tangent and what the line feeds in."""
    rng = np.random.default_rng(1)
    plain, other = _model(), _model(**VANISHING[name])
    for _ in range(10):
        motion = _motion(rng, 0.9)
        expected, got = plain.evaluate(motion), other.evaluate(motion)
        assert np.abs(got.wrench - expected.wrench).max() < 1e-9 * np.abs(expected.wrench).max()
        assert np.abs(got.tangent() - expected.tangent()).max() < 1e-7 * np.abs(expected.tangent()).max()
        assert np.abs(_fed_in(other.solver.line) - _fed_in(plain.solver.line)).max() < 1e-7


@pytest.mark.parametrize(
    ("name", "eccentricity", "most"), (("shear", 0.6, 0.013), ("density", 0.6, 0.013), ("liner", 0.6, 0.004))
)
def test_coefficients_do_not_know_where_the_line_lies(name, eccentricity, most, measured):
    """16 directions on 48x6: within 1.3 % with the line in its cells, 8 % and more with it on the grid."""
    options = CASES[name]
    directions = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.0123 + np.arange(16) * 0.7 * np.pi / 48

    def found(n, nz, closure, where):
        return _coefficients(ehd.FiniteLength(n_theta=n, n_z=nz), 1.0, eccentricity, where, closure, **options)[0]

    means = [
        found(n, nz, LINE, np.linspace(0.0, 2.0 * np.pi / n, 4, endpoint=False) + 0.3).mean(axis=0)
        for n, nz in ((96, 12), (192, 24))
    ]
    mean = means[1] + (means[1] - means[0]) / 3.0
    error = [np.abs((found(48, 6, c, directions) - mean) / np.maximum(1.0, np.abs(mean))).max() for c in (LINE, PLAIN)]
    measured(name, error[0], most)
    assert error[1] > 0.07


def test_damping_of_a_slow_motion_that_the_liner_follows():
    """Against steps that are long, from the deflection that the film had at their start; the line's own rests."""
    model, motion = _model(**CASES["liner"]), np.array([0.6 * C, 0.3 * C, 0, 0, 0, 0, 0, 0, 100.0, 0.0])
    tangent, step, speed = model.evaluate(motion).tangent(slow_motion=True)[:2, 4:6], 100.0, 1e-5 * C
    for k in range(2):
        force = []
        for way in (speed, -speed):
            before, moving = motion.copy(), motion.copy()
            before[k] -= way * step
            moving[4 + k] = way
            history = model.evaluate(before, model.initial_history(before), step).history()
            force.append(model.evaluate(moving, history, step).wrench[:2])
        slope = (force[0] - force[1]) / (2.0 * speed)
        assert np.abs(slope - tangent[:, k]).max() < 1e-4 * np.abs(tangent).max()


def test_heat_is_the_power_of_the_motion():
    """Power balance of steady films: oil that appears at the line has the cavity pressure."""
    for name in ("shear", "density", "liner"):
        model = _model(**CASES[name])
        film = model.evaluate(np.array([0.6 * C, 0.4 * C, 0, 0, 0, 0, 0, 0, 300.0, 0.0])).film
        assert np.any(model.solver.line.s < 1.0)
        assert heat_and_exchange(film, 1.0)[0] == pytest.approx(powers(film).loss, rel=1e-8)


def test_a_film_of_any_gap_with_a_density():
    """On a ring and on a slider that opens; a density that hardly changes leaves the film of constant density."""
    for grid in (bearing_grid(R, L, 48, 8), slider_grid(0.1, 0.05, 48, 8)):
        gap = C * (1.0 - 0.6 * np.cos(2.0 * np.pi * np.arange(grid.shape[0]) / grid.shape[0]))
        films = [
            ehd.solve_film(
                grid, np.tile(gap[:, None], (1, grid.shape[1])), surface_speed=(3.0, 0.0), cavitation=LINE,
                lubricant=ehd.Lubricant(viscosity=0.02, density_law=law),
            )
            for law in (None, ehd.DowsonHigginson(coefficient=1e-18), ehd.DowsonHigginson(coefficient=1e-8))
        ]  # fmt: skip
        assert films[1].load == pytest.approx(films[0].load, rel=1e-7)
        assert films[2].load == pytest.approx(films[0].load, rel=0.1)
        assert films[2].load != pytest.approx(films[0].load, rel=1e-4)
