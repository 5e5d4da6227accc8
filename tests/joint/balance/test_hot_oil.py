"""Films hotter than oil bears: warned of, refused by name, and told by the audit, at temperatures in closed form."""

import dataclasses
import math
import re
import warnings

import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.limits import HOT, HOTTEST

R, L, C, SUPPLY, OMEGA = 0.025, 0.05, 25e-6, 320.0, 300.0
LAW = ehd.ReynoldsTemperature(point=(SUPPLY, 0.02), coefficient=0.03)
OIL = ehd.Lubricant(temperature_law=LAW, temperature=SUPPLY, density=870.0, specific_heat=2000.0)


def concentric(temperature, kind):
    """A film without through-flow that Petroff's loss keeps at a temperature, by the heat transfer that it takes."""
    area = 2.0 * math.pi * R * L
    transfer = float(LAW.viscosity(temperature, 870.0)) * (R * OMEGA) ** 2 / C / (temperature - SUPPLY)
    thermal = (
        ehd.LumpedThermal(supply_temperature=SUPPLY, housing_conductance=transfer * area)
        if kind == "lumped"
        else ehd.FilmEnergy(supply_temperature=SUPPLY, bush_coefficient=transfer)
    )
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=OIL,
        thermal=thermal,
        film=ehd.FiniteLength(n_theta=32, n_z=6, stretch=0.0),
    )


def steady(temperature, kind):
    return ehd.steady(concentric(temperature, kind), speed=OMEGA, eccentricity_ratio=0.0)


@pytest.mark.parametrize("kind", ["lumped", "field"])
def test_films_are_told_from_where_oil_does_not_bear_them(kind):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cool = steady(HOT - 0.5, kind)
    audited = cool.audit()["oil temperature"]
    assert audited.value == pytest.approx(HOT - 0.5, abs=0.1) and not audited.matters
    place = r"steady: the film is at \d+\.?\d* K" + ("," if kind == "lumped" else r" at theta = .* rad, z = .* m,")
    for temperature in (HOT + 0.5, HOTTEST - 0.5):
        with pytest.warns(ehd.HotFilmWarning, match=place + ".* do not bear 423.15 K for long; let more oil"):
            hot = steady(temperature, kind)
        finding = hot.audit()["oil temperature"]
        assert finding.matters and finding.on is None and "mineral oils" in finding.advice
    with pytest.raises(ehd.FilmError, match=place + ".* no oil is a liquid above 700 K: the bearing seizes; let more"):
        steady(HOTTEST + 0.5, kind)


def test_a_curve_tells_its_fastest_hot_film():
    made = concentric(HOT + 40.0, "lumped")
    with pytest.warns(ehd.HotFilmWarning) as told:
        curve = ehd.stribeck(made, load=1.0, speeds=[0.5 * OMEGA, OMEGA, 1.02 * OMEGA])
    (text,) = [str(w.message) for w in told]
    assert text.startswith(f"stribeck at {1.02 * OMEGA:.4g} rad/s: the film is at {curve.film_temperature[2]:.4g} K")
    assert (curve.film_temperature > HOT).tolist() == [False, True, True]


def test_isothermal_films_have_no_temperature_to_tell():
    made = dataclasses.replace(concentric(HOT, "lumped"), thermal=None)
    with pytest.raises(KeyError):
        ehd.steady(made, speed=OMEGA, eccentricity_ratio=0.0).audit()["oil temperature"]


@pytest.mark.slow
def test_asperities_that_rub_the_oil_away_are_no_film():
    """A small fast bearing: beyond an eccentricity ratio of 0.85 heat takes more of its load than the gap gives."""
    law = ehd.ReynoldsTemperature(point=(SUPPLY, 0.027), coefficient=0.03)
    made = ehd.JournalBearing(
        journal_radius=7.3e-3,
        length=11.2e-3,
        radial_clearance=7.9e-6,
        lubricant=ehd.Lubricant(temperature_law=law, temperature=SUPPLY),
        thermal=ehd.LumpedThermal(supply_temperature=SUPPLY),
        asperity=ehd.GreenwoodTripp(composite_roughness=0.5e-6, composite_modulus=1.15e11),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    for ratio in (0.97, 1.0):
        with pytest.raises(ehd.FilmError, match="no oil is a liquid above 700 K"):
            ehd.steady(made, speed=550.0, eccentricity_ratio=ratio)
    for load in (2600.0, 1e4, 1e5):
        with pytest.raises(ehd.FilmError, match=r"carries at least .*the bearing seizes") as error:
            ehd.equilibrium(made, speed=550.0, load=(0.0, -load))
        # a search without an end takes some times the film solves of one with
        assert int(re.search(r"in (\d+) steps", str(error.value)).group(1)) < 400


@pytest.mark.parametrize("kind", ["lumped", "field"])
def test_a_load_that_is_carried_is_not_to_blame(kind):
    """Under hardly any load no oil flows through, and it is the heat that finds no way out."""
    thermal = {"lumped": ehd.LumpedThermal, "field": ehd.FilmEnergy}[kind](supply_temperature=SUPPLY)
    bearing = dataclasses.replace(concentric(HOT, kind), thermal=thermal, lubricant=ehd.oil("ISO VG 46"))
    with pytest.raises(ehd.FilmError, match="carries the load, but its heat finds no balance") as told:
        ehd.equilibrium(bearing, speed=3.0 * OMEGA, load=(0.0, -1.0))
    assert "let oil flow through" in str(told.value) and "may carry no such load" not in str(told.value)


def test_a_cool_film_is_not_to_blame():
    """A load onto the edge of an arc has no position, whatever the temperature."""
    thermal = ehd.LumpedThermal(supply_temperature=SUPPLY)
    size = {"journal_radius": R, "length": L, "radial_clearance": C, "lubricant": OIL, "thermal": thermal}
    halves = ehd.JournalBearing(**size, arcs=ehd.offset_halves(preload=0.6))
    with pytest.raises(ehd.FilmError, match="onto the trailing edge of arcs") as told:
        ehd.equilibrium(halves, speed=-OMEGA, load=(-3e3, -3e3))
    assert "heat limits the load" not in str(told.value)
