"""Two temperatures across the film: limits, balance of heat, power, exact tangents, refusals."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.heat.power import heat_and_exchange
from exudyn_ehd.joint.model.build import build_model

SUPPLY, C, SPEED = 313.15, 25e-6, 500.0
VOGEL = ehd.VogelTemperature(first=(SUPPLY, 0.03), second=(373.15, 0.006))
GROOVE = (ehd.AxialGroove(angle=0.2 + math.pi, width_angle=0.52, length=0.0159, pressure=1e5),)
UNSUPPLIED = ehd.ElrodAdams(cavity_pressure=-1e5)
WALLS = {
    "bush": ehd.Conduction(thickness=0.01, conductance=5.0, expansion=1e-5),
    "journal": ehd.Conduction(thickness=0.02, conductance=1.0, initial_temperature=350.0),
}
GIVEN = {"bush_coefficient": 2000.0, "journal_coefficient": 1e5, "journal_temperature": 350.0}
SCENES = {
    "swift": ({}, {}),
    "adiabatic": ({}, {"supply": GROOVE}),
    "given": (GIVEN, {"cavitation": ehd.FullSommerfeld()}),
    "mixed at a groove": (GIVEN | {"carry_over": 0.7}, {"supply": GROOVE}),
    "walls": (WALLS, {"cavitation": UNSUPPLIED}),
}
SCALE = np.array([C, C, 1e-3, 1e-3, 1e-2, 1e-2, 0.5, 0.5, SPEED, 1.0])


def bearing(energy, across=2, law=VOGEL, **options):
    thermal = ehd.FilmEnergy(supply_temperature=SUPPLY, conductivity=0.13, across=across, **energy)
    return ehd.JournalBearing(
        **{
            "journal_radius": 0.02,
            "length": 0.02,
            "radial_clearance": C,
            "film": ehd.FiniteLength(n_theta=48, n_z=8),
            "lubricant": ehd.Lubricant(temperature_law=law),
            "thermal": thermal,
        }
        | options
    )


def motion(turn=0.0, speed=SPEED, tilt=2e-4):
    out = np.zeros(10)
    out[:4] = 0.6 * C * math.cos(turn), 0.6 * C * math.sin(turn), tilt, 0.0
    out[4:6], out[8], out[9] = (2e-3, -1e-3), speed, 0.3
    return out


def warmed(model, steps=5, speed=SPEED, tilt=2e-4):
    """History after some steps with a journal that turns about the bearing's axis."""
    history = model.initial_history(motion(speed=speed, tilt=tilt))
    for k in range(steps):
        evaluation = model.evaluate(motion(0.05 * k, speed, tilt), history, 2e-4)
        history = evaluation.history()
    return evaluation, history


@pytest.mark.parametrize("cavitation", [ehd.SwiftStieber(), UNSUPPLIED], ids=["swift", "elrod"])
def test_an_oil_that_does_not_thin_has_the_film_of_one_temperature(cavitation):
    law = ehd.ReynoldsTemperature(point=(SUPPLY, 0.03), coefficient=1e-14)
    one, two = (warmed(build_model(bearing(GIVEN, across, law=law, cavitation=cavitation)))[0] for across in (1, 2))
    np.testing.assert_allclose(two.wrench, one.wrench, atol=1e-12 * np.abs(one.wrench).max())
    np.testing.assert_allclose(two.tangent(), one.tangent(), atol=1e-12 * np.abs(one.tangent()).max())


@pytest.mark.slow
@pytest.mark.parametrize("speed", [SPEED, -SPEED], ids=["forth", "back"])
@pytest.mark.parametrize("scene", SCENES)
def test_heat_balances_and_tangents_are_exact(scene, speed):
    energy, options = SCENES[scene]
    model = build_model(bearing(energy, **options))
    thermal = model.effects.thermal
    _, history = warmed(model, speed=speed)
    at = motion(0.3, speed)
    for step in (2e-4, 1e-2, 3.0):
        evaluation = model.evaluate(at, history, step)
        new = evaluation.history()
        _check_balance(thermal.balance(evaluation.film, new.temperature))
        tangent, rng = evaluation.tangent(), np.random.default_rng(2)
        for _ in range(3):
            change = rng.normal(size=10) * SCALE
            ends = [model.evaluate(at + s * 1e-6 * change, history, step).wrench for s in (1.0, -1.0)]
            error = np.abs(tangent @ change - (ends[0] - ends[1]) / 2e-6)
            assert np.all(error < 1e-6 * np.abs(tangent * SCALE).max(axis=1))
        history = new
    at[4:] = 0.0
    at[8] = speed
    settled = settled_history(model, at)
    evaluation = model.evaluate(at, settled)
    _check_balance(thermal.balance(evaluation.film, settled.temperature))
    # what the flows' drag puts in is what they dissipate, though a gradient pulls the surfaces unevenly
    heat, _ = heat_and_exchange(evaluation.film, 1.0)
    work = evaluation.quantities()["power_loss"]
    assert options.get("supply") or heat == pytest.approx(work, rel=1e-9)


def _check_balance(balance):
    defect = balance["heat_in"] - balance["convected"] - balance["conducted"] - balance["stored"]
    assert abs(defect) < 1e-9 * max(map(abs, balance.values()))


def test_a_mirrored_film_has_mirrored_temperatures():
    """A journal that turns the other way, mirrored: the same load, temperatures and surfaces in mirrored places."""
    films = [
        ehd.steady(bearing({"bush_coefficient": 2000.0}), speed=speed, eccentricity_ratio=0.6)
        for speed in (SPEED, -SPEED)
    ]
    np.testing.assert_allclose(films[0].force * [1, -1, 0], films[1].force, atol=1e-8 * np.abs(films[0].force).max())
    for of in (lambda f: f.temperature, lambda f: f.walls.across[1], lambda f: f.walls.across[2]):
        there = np.roll(of(films[1])[::-1], 1, axis=0)
        np.testing.assert_allclose(of(films[0]), there, atol=1e-7)


def test_surfaces_share_the_heat_of_sliding_and_pressure_flow_unequally():
    """Constant viscosity between walls of one temperature, all heat by conduction: with the stress
    mu U / h + p' (y - h / 2) the walls' heats differ by the first moment of the stress squared over mu,

        q_bush - q_journal = int (stress^2 / mu) (1 - 2 y / h) dy = -U p' h / 3.
    """
    walls = {"bush_coefficient": 1e9, "bush_temperature": SUPPLY}
    walls |= {"journal_coefficient": 1e9, "journal_temperature": SUPPLY}
    law = ehd.ReynoldsTemperature(point=(SUPPLY, 0.03), coefficient=1e-14)
    made = bearing(walls, law=law, cavitation=ehd.FullSommerfeld())
    made = dataclasses.replace(made, thermal=dataclasses.replace(made.thermal, conductivity=100.0))
    film, model = ehd.steady(made, speed=SPEED, eccentricity_ratio=0.6), build_model(made)
    at = np.zeros(10)
    at[0], at[8] = 0.6 * C, SPEED
    settled = settled_history(model, at)
    balance = model.effects.thermal.balance(model.evaluate(at, settled).film, settled.temperature)
    slope = (np.roll(film.pressure, -1, 0) - np.roll(film.pressure, 1, 0)) / (4.0 * np.pi / 48 * 0.02)
    area = 0.02**2 * ehd.bearing_grid(0.02, 0.02, 48, 8).area
    expected = -np.sum(area * slope * film.gap) * 0.02 * SPEED / 3.0
    assert abs(expected) > 0.03 * balance["heat_in"]
    assert balance["bush"] - balance["journal"] == pytest.approx(expected, rel=2e-3)


def test_results_have_the_surfaces():
    b = bearing(GIVEN)
    film = ehd.steady(b, speed=SPEED, eccentricity_ratio=0.6)
    _, bush, journal = film.walls.across
    assert film.walls.bush is None
    assert np.mean(bush) < np.mean(film.temperature) < np.mean(journal) < 350.0
    area = ehd.bearing_grid(b.journal_radius, b.length, 48, 8).area
    assert film.walls.numbers(area)["bush_temperature"] == pytest.approx(np.sum(area * bush) / np.sum(area))


def test_refusals_name_what_does_not_go():
    b = bearing({})
    with pytest.raises(ehd.InputError, match=r"FilmEnergy.across must be 1, .* or 2, .*got 3"):
        dataclasses.replace(b.thermal, across=3)
    with pytest.raises(ehd.InputError, match=r"across=2 needs the oil's conductivity"):
        dataclasses.replace(b.thermal, conductivity=None)
    thinning = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)
    oil = dataclasses.replace(b.lubricant, shear_law=thinning)
    with pytest.raises(ehd.InputError, match=r"across=2 does not go with Lubricant.shear_law=CarreauShear"):
        dataclasses.replace(b, lubricant=oil)


@pytest.mark.parametrize("seed", range(5))
def test_steady_temperatures_converge_at_the_sides_of_a_dam(seed):
    """The two rows at a side of a dam share mean and tilt, whose slope between the rows would be round-off.

    The hottest place is as with one temperature across the film to 15 % of the rise.
    """
    rng = np.random.default_rng((83, seed))
    depth, step = C * rng.uniform(1.0, 3.0), math.radians(rng.uniform(110.0, 150.0))
    arcs = ehd.pressure_dam(depth=depth, step_angle=step, length=0.02 * rng.uniform(0.5, 0.85), pressure=1e5)
    energy = {"bush_coefficient": rng.uniform(500.0, 3000.0), "journal_coefficient": rng.uniform(100.0, 1000.0)}
    at = {"eccentricity_ratio": rng.uniform(0.2, 0.7), "direction": rng.uniform(-3.0, 3.0)}
    sense = rng.choice((-1.0, 1.0))
    one, two = (ehd.steady(bearing(energy, across, arcs=arcs), speed=sense * SPEED, **at) for across in (1, 2))
    assert two.peak_temperature - SUPPLY == pytest.approx(one.peak_temperature - SUPPLY, rel=0.15)
