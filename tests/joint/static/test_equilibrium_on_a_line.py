"""`equilibrium` with ``inlet=MaximumGap()``: the line of ambient pressure follows the journal, as in design charts."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.reference import short_bearing

SPEED = 100.0
LINE = ehd.MaximumGap()
FILM = ehd.FiniteLength(n_theta=64, n_z=8)


def force_at(bearing, speed, position, velocity=(0.0, 0.0)):
    """Force (2,) of the film at a position (2,), m, by `steady`; a film with a temperature finds its own."""
    ratio, angle = np.hypot(*position) / bearing.radial_clearance, math.atan2(position[1], position[0])
    return ehd.steady(bearing, speed=speed, eccentricity_ratio=ratio, direction=angle, velocity=velocity).force[:2]


def test_any_load_is_carried(make_bearing):
    """Loads over five decades in all directions, both senses of rotation, all films and cavities, walls and heat."""
    rng, films = np.random.default_rng(2), (FILM, FILM, ehd.ShortBearing(), ehd.LongBearing())
    cavities = (ehd.SwiftStieber(), ehd.SwiftStieber(line_in_cells=False), ehd.Gumbel(), ehd.FullSommerfeld())
    heat = ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=5.0)
    for _ in range(60):
        bearing = make_bearing(
            rng.uniform(0.1, 2.0), film=rng.choice(films), cavitation=rng.choice(cavities), inlet=LINE,
            lubricant=ehd.oil("ISO VG 46"), thermal=rng.choice((None, heat)),
            contact=rng.choice((None, ehd.RegularisedWall(onset=1e-6))),
            profile=rng.choice((None, ehd.Crown(drop=3e-6))),
        )  # fmt: skip
        speed, angle = rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(0.0, 2.5), rng.uniform(-math.pi, math.pi)
        size = 10.0 ** rng.uniform(-3.0, 0.0) * bearing.reference_force(speed)
        load = size * np.array([math.cos(angle), math.sin(angle)])
        rest = ehd.equilibrium(bearing, speed=speed, load=tuple(load))
        assert rest.residual < 1e-9 and rest.iterations < 60
        np.testing.assert_allclose(rest.film.force[:2], -load, atol=1e-8 * size)
        np.testing.assert_allclose(force_at(bearing, speed, rest.position), -load, atol=1e-7 * size)
        # the line is opposite to the journal
        away = rest.film.theta[0] - math.atan2(*rest.position[::-1]) - math.pi
        assert abs(math.remainder(away, 2.0 * math.pi)) < 1e-12


@pytest.mark.parametrize("cavity", (ehd.SwiftStieber(), ehd.SwiftStieber(line_in_cells=False), ehd.FullSommerfeld()))
def test_stiffness_follows_the_line_and_damping_does_not(make_bearing, cavity):
    """Differences of films of `steady`: at positions around the equilibrium, each with its line, and with velocities.

    Not with Gümbel's film: it ruptures exactly on a column, the one of the smallest gap.
    """
    rng = np.random.default_rng(4)
    bearing = make_bearing(0.5, inlet=LINE, film=FILM, cavitation=cavity)
    speed, angle = rng.choice((-1.0, 1.0)) * SPEED, rng.uniform(-math.pi, math.pi)
    load = rng.uniform(0.1, 2.0) * bearing.reference_force(speed) * np.array([math.cos(angle), math.sin(angle)])
    rest = ehd.equilibrium(bearing, speed=speed, load=tuple(load))
    x, shift = rest.position, 1e-4 * bearing.radial_clearance
    step, slow = shift * np.eye(2), shift * SPEED * np.eye(2)
    K = [(force_at(bearing, speed, x - s) - force_at(bearing, speed, x + s)) / (2.0 * shift) for s in step]
    C = [(force_at(bearing, speed, x, -v) - force_at(bearing, speed, x, v)) / (2.0 * shift * SPEED) for v in slow]
    np.testing.assert_allclose(rest.stiffness, np.transpose(K), atol=1e-6 * np.abs(K).max())
    np.testing.assert_allclose(rest.damping, np.transpose(C), atol=1e-6 * np.abs(C).max())
    np.testing.assert_array_equal(rest.settled_stiffness, rest.stiffness)


def test_settled_stiffness_follows_the_line(make_bearing):
    heat = ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=5.0)
    bearing = make_bearing(0.5, inlet=LINE, film=FILM, lubricant=ehd.oil("ISO VG 46"), thermal=heat)
    rest = ehd.equilibrium(bearing, speed=SPEED, load=(300.0, -900.0))
    x, shift = rest.position, 1e-4 * bearing.radial_clearance
    K = [(force_at(bearing, SPEED, x - s) - force_at(bearing, SPEED, x + s)) / (2.0 * shift) for s in shift * np.eye(2)]
    np.testing.assert_allclose(rest.settled_stiffness, np.transpose(K), atol=1e-5 * np.abs(K).max())
    assert np.abs(rest.settled_stiffness - rest.stiffness).max() > 0.01 * np.abs(K).max()


@pytest.mark.parametrize("eps", (0.2, 0.6))
def test_short_bearing_keeps_its_closed_form(make_bearing, eps):
    """Ocvirk's half Sommerfeld film begins at the largest gap by itself: load, attitude, K, C, critical mass."""
    film = ehd.ShortBearing(n_theta=16384, n_z=4)
    bearing = make_bearing(0.25, film=film, cavitation=ehd.Gumbel(), inlet=LINE)
    load, c = short_bearing.load(eps, 0.25) * bearing.reference_force(SPEED), bearing.radial_clearance
    rest = ehd.equilibrium(bearing, speed=SPEED, load=(load, 0.0))
    assert rest.eccentricity_ratio == pytest.approx(eps, rel=1e-6)
    assert rest.attitude_angle == pytest.approx(short_bearing.attitude(eps), rel=1e-6)
    for found, exact in (
        (rest.stiffness * c / load, short_bearing.stiffness(eps)),
        (rest.damping * c * SPEED / load, short_bearing.damping(eps)),
    ):
        np.testing.assert_allclose(found, exact, atol=1e-3 * np.abs(exact).max())
    ratio, mass = short_bearing.whirl_threshold(eps)
    assert rest.whirl_ratio == pytest.approx(ratio, rel=1e-3)
    assert rest.critical_mass * c * SPEED**2 / load == pytest.approx(mass, rel=2e-3)


@pytest.mark.parametrize(
    ("options", "load", "tilt", "match"),
    [
        ({}, (0.0, 0.0), (0.0, 0.0), "the gap is the same"),
        ({}, (0.0, -100.0), (1e-4, 0.0), "tilt="),
        ({"cavitation": ehd.ElrodAdams()}, (0.0, -100.0), (0.0, 0.0), "ElrodAdams"),
        ({"profile": ehd.OutOfRound(order=2, amplitude=1e-6)}, (0.0, -100.0), (0.0, 0.0), "OutOfRound"),
        ({"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9)}, (0.0, -100.0), (0.0, 0.0), "bush"),
        ({"end_pressures": (1e5, 0.0)}, (0.0, -100.0), (0.0, 0.0), "end_pressures"),
    ],
)
def test_refuses_what_does_not_turn_with_the_line(make_bearing, options, load, tilt, match):
    with pytest.raises(ehd.InputError, match=match):
        ehd.equilibrium(make_bearing(1.0, inlet=LINE, **options), speed=SPEED, load=load, tilt=tilt)
