"""Rupture line of the short bearing between its columns: stiffness, damping, tilted journals, tangent, flows, heat."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.heat.power import heat_and_exchange, powers
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import Status
from tests.reference import short_bearing

C, R, OMEGA = 25e-6, 0.025, 200.0
VERTICES = ehd.SwiftStieber(line_in_cells=False)
SMALL = ehd.ShortBearing(n_theta=48, n_z=8)


def _turned(place, angle):
    """A motion whose place, tilt and rates are turned by an angle."""
    cos, sin = np.cos(angle), np.sin(angle)
    out, turn = place.copy(), np.array([[cos, -sin], [sin, cos]])
    for k in range(0, 8, 2):
        out[k : k + 2] = turn @ place[k : k + 2]
    return out, turn


def _coefficients(model, motion, angle=0.0):
    """Stiffness and damping over W / C and W / (C omega) (2, 2, 2) of a motion turned by an angle, turned back."""
    turned, turn = _turned(motion, angle)
    film = model.evaluate(turned)
    assert film.status is Status.CONVERGED
    tangent, load = film.tangent(), np.hypot(*film.wrench[:2])
    parts = -tangent[:2, :2] * C / load, -tangent[:2, 4:6] * C * OMEGA / load
    return np.array([turn.T @ part @ turn for part in parts])


def _motion(eccentricity, tilt=0.0, length=0.0125, angle=1.9):
    """A journal off in the direction 0, tilted by a share of what closes the gap."""
    out = np.zeros(10)
    out[0], out[8] = eccentricity * C, OMEGA
    out[2:4] = tilt * (1.0 - eccentricity) * 2.0 * C / length * np.array([np.cos(angle), np.sin(angle)])
    return out


def _closed_form(eccentricity):
    """Closed-form stiffness and damping in the axes of the eccentricity, turned from those of the load."""
    attitude = short_bearing.attitude(eccentricity)
    cos, sin = np.cos(attitude), np.sin(attitude)
    axes = np.array([[cos, sin], [-sin, cos]])
    parts = np.array([short_bearing.stiffness(eccentricity), short_bearing.damping(eccentricity)])
    return np.array([axes @ part @ axes.T for part in parts])


def _errors(made, expected):
    """Largest error of stiffness and damping over their largest entries, (2,)."""
    return np.abs(made - expected).max(axis=(1, 2)) / np.abs(expected).max(axis=(1, 2))


@pytest.mark.parametrize("count", [6, pytest.param(150, marks=pytest.mark.slow)])
def test_coefficients_against_the_closed_form(make_bearing, count):
    """Any direction, default grid: of second order, where a line on the vertices is of first order."""
    rng = np.random.default_rng(3)
    cells, vertices = (
        build_model(make_bearing(0.25, film=ehd.ShortBearing(), cavitation=k)) for k in (ehd.SwiftStieber(), VERTICES)
    )
    found = []
    for eccentricity in rng.uniform(0.1, 0.9, count):
        motion, angle, expected = _motion(eccentricity), rng.uniform(0.0, 2.0 * np.pi), _closed_form(eccentricity)
        error = _errors(_coefficients(cells, motion, angle), expected)
        # 0.13 % up to eccentricity ratio 0.6, 0.19 % up to 0.8, 0.29 % up to 0.9, of second order in the columns
        assert error.max() < (0.002 if eccentricity < 0.8 else 0.003), eccentricity
        found.append((error.max(), _errors(_coefficients(vertices, motion, angle), expected).max()))
    inside, outside = np.max(found, axis=0)
    assert outside > 5.0 * inside


@pytest.mark.parametrize("count", [3, pytest.param(30, marks=pytest.mark.slow)])
def test_coefficients_of_tilted_journals(make_bearing, count):
    """Tilts up to 0.3 against 1024 columns with their line on the vertices, mean of 8 directions within a cell."""
    rng, fine_cell = np.random.default_rng(6), 2.0 * np.pi / 1024
    fine, cells, vertices = (
        build_model(make_bearing(0.25, film=ehd.ShortBearing(n_theta=n), cavitation=k))
        for n, k in ((1024, VERTICES), (160, ehd.SwiftStieber()), (160, VERTICES))
    )
    found = []
    for _ in range(count):
        motion = _motion(rng.uniform(0.1, 0.9), rng.uniform(0.0, 0.3), angle=rng.uniform(0.0, 2.0 * np.pi))
        expected = np.mean([_coefficients(fine, motion, fine_cell / 8 * k) for k in range(8)], axis=0)
        angle = rng.uniform(0.0, 2.0 * np.pi)
        found.append([_errors(_coefficients(model, motion, angle), expected).max() for model in (cells, vertices)])
    inside, outside = np.max(found, axis=0)
    # steps of the line by a row are left, up to 1.5 % on the default rows; 3 to 5 % on the vertices
    assert inside < 0.018
    assert inside < 0.6 * outside


def test_aligned_film_is_that_of_gumbel(make_bearing):
    """Each column has one sign of pressure then, so that both conditions are the same, squeeze included."""
    rng = np.random.default_rng(5)
    closures = ehd.SwiftStieber(), ehd.Gumbel(line_in_cells=True)
    models = [build_model(make_bearing(0.25, film=SMALL, cavitation=k)) for k in closures]
    for _ in range(10):
        motion, _ = _turned(_motion(rng.uniform(0.1, 0.9)), rng.uniform(0.0, 2.0 * np.pi))
        motion[4:6] = 100.0 * C * rng.normal(size=2)
        films = [model.evaluate(motion) for model in models]
        np.testing.assert_allclose(films[0].wrench, films[1].wrench, rtol=0.0, atol=1e-12 * abs(films[0].wrench).max())


def test_tilted_films_change_without_jumps(make_bearing):
    """Force over a path through a cell: vertices that join and leave, columns that rupture, and no jump."""
    model = build_model(make_bearing(0.25, film=ehd.ShortBearing(n_theta=64)))
    path = [_turned(_motion(0.6, 0.3, angle=1.0), angle)[0] for angle in np.linspace(0.0, 2.0 * np.pi / 64, 801)]
    force, sets = [], set()
    for motion in path:
        force.append(model.evaluate(motion).wrench[:2])
        sets.add(model.solver.work.active.tobytes())
    steps = np.linalg.norm(np.diff(force, axis=0), axis=1)
    assert len(sets) > 10
    assert steps.max() < 1.1 * np.median(steps)


ABOVE = ehd.SwiftStieber(cavity_pressure=-3e4)
OPTIONS = {
    "ends": {"end_pressures": (1e5, 3e4)},
    "cavity": {"cavitation": ABOVE},
    "turbulent": {
        "turbulence": ehd.NgPan(),
        "lubricant": ehd.Lubricant(viscosity=5e-4, density=1000.0),
    },
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=2e-6, journal_share=0.9), "cavitation": ABOVE},
    "piezoviscous": {
        "lubricant": ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=1e-8)),
    },
    "groove": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, length=0.01, pressure=2e5),)},
    "wall": {"contact": ehd.RegularisedWall(onset=10e-6)},
    "oval": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6)},
}


def _states(count, seed):
    """Places with tilt, rates, spin and axial speed."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        motion, _ = _turned(_motion(rng.uniform(0.1, 0.9), 0.4, angle=rng.uniform(0.0, 7.0)), rng.uniform(0.0, 7.0))
        motion[4:8] = 30.0 * C * rng.normal(size=4) * [1.0, 1.0, 1.0 / R, 1.0 / R]
        motion[8:] = rng.choice([-100.0, 300.0]), 0.1
        yield motion


@pytest.mark.parametrize("name", [n if n == "ends" else pytest.param(n, marks=pytest.mark.slow) for n in OPTIONS])
def test_tangent_is_the_derivative(make_bearing, name):
    """Random states; central differences over 1e-6 of the clearance leave 1e-9, and 1e-7 where a vertex joins."""
    bearing = make_bearing(0.25, **{"film": SMALL} | OPTIONS[name])
    model, probe = build_model(bearing), build_model(bearing)
    scale = 0.1 * np.array([C, C, C / R, C / R, 100 * C, 100 * C, 100 * C / R, 100 * C / R, 100.0, 1.0])
    for motion in _states(8, 2):
        tangent, numeric = model.evaluate(motion).tangent() * scale, np.empty((6, 10))
        for k in range(10):
            step = 1e-5 * scale[k] * np.eye(10)[k]
            numeric[:, k] = (probe.evaluate(motion + step).wrench - probe.evaluate(motion - step).wrench) / 2e-5
        rows = np.abs(tangent).max(axis=1)
        rows[rows < 1e-9 * rows.max()] = np.inf
        assert (np.abs(tangent - numeric) / rows[:, None]).max() < 2e-7


def test_flows_are_those_of_the_solved_film(make_bearing):
    """The line changes what pressures do to the journal; their flows are those of the film on the vertices."""
    groove = (ehd.AxialGroove(angle=1.0, width_angle=0.3, length=0.01, pressure=2e5),)
    models = [
        build_model(make_bearing(0.25, film=SMALL, supply=groove, end_pressures=(1e4, 0.0), cavitation=k))
        for k in (ehd.SwiftStieber(), VERTICES)
    ]
    for motion in _states(8, 6):
        films = [model.evaluate(motion) for model in models]
        flows = [[f.quantities()[name] for name in ("leakage_lower", "leakage_upper", "supply_flow")] for f in films]
        np.testing.assert_allclose(*flows, rtol=1e-13)
        assert abs(films[0].wrench - films[1].wrench).max() > 1e-4 * abs(films[1].wrench).max()


def test_heat_is_the_power_loss(make_bearing):
    """The power loss of a steady aligned film is the heat of its oil, to rounding."""
    model = build_model(make_bearing(0.25, film=SMALL))
    for eccentricity in (0.2, 0.6, 0.9):
        film = model.evaluate(_turned(_motion(eccentricity), 0.7)[0]).film
        assert heat_and_exchange(film, 1.0)[0] == pytest.approx(powers(film).loss, rel=1e-9)
