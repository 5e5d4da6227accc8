"""`Sump` in steady films and in time, ``LumpedThermal.effective_rise``, temperatures that change no viscosity."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

AMBIENT = 290.0
OIL = ehd.oil("ISO VG 46")
FILM = ehd.FiniteLength(n_theta=64, n_z=8)
GROOVE = {"cavitation": ehd.ElrodAdams(), "supply": (ehd.AxialGroove(angle=1.5, width_angle=0.3, pressure=1e5),)}
WALL = ehd.Conduction(thickness=0.02, conductance=0.8, expansion=1e-5)
# every temperature that could be that of the supply is given, so that a sump changes the supply alone
HEAT = {
    "lumped": ehd.LumpedThermal(supply_temperature=AMBIENT, housing_temperature=AMBIENT, housing_conductance=3.0),
    "field": ehd.FilmEnergy(
        supply_temperature=AMBIENT, bush_temperature=AMBIENT, bush_coefficient=900.0, conductivity=0.13
    ),
    "pair": ehd.FilmEnergy(
        supply_temperature=AMBIENT, journal_temperature=AMBIENT, journal_coefficient=300.0, conductivity=0.13, across=2
    ),
    "walls": ehd.FilmEnergy(
        supply_temperature=AMBIENT,
        bush=replace(WALL, ambient_temperature=AMBIENT, clearance_temperature=AMBIENT),
        journal=replace(WALL, ambient_temperature=AMBIENT, clearance_temperature=AMBIENT),
        conductivity=0.13,
    ),
}


@pytest.mark.parametrize(
    ("kind", "options"), sample(itertools.product(HEAT, ({}, GROOVE, {"inlet": ehd.MaximumGap()})), 0, 2, 4, 6, 11)
)
def test_sump_gives_off_what_the_oil_brings(make_bearing, kind, options):
    """The film is that of a supply with the sump's temperature, from weak cooling to a sump at the ambient."""
    for conductance in (0.5, 8.0, 1e4) if kind in ("lumped", "field") else (8.0,):
        sump = ehd.Sump(conductance=conductance, ambient=AMBIENT)
        bearing = make_bearing(0.5, film=FILM, lubricant=OIL, thermal=HEAT[kind], **options)
        fed = replace(bearing, thermal=replace(HEAT[kind], supply_temperature=sump))
        film = ehd.steady(fed, speed=250.0, eccentricity_ratio=0.6, direction=-2.2)
        T = film.supply_temperature
        assert film.heat_by_oil == pytest.approx(conductance * (T - AMBIENT), rel=1e-9)
        given = replace(bearing, thermal=replace(HEAT[kind], supply_temperature=T, initial_temperature=AMBIENT))
        same = ehd.steady(given, speed=250.0, eccentricity_ratio=0.6, direction=-2.2)
        assert same.supply_temperature == T
        np.testing.assert_allclose(film.temperature, same.temperature, rtol=1e-9)
        np.testing.assert_allclose(film.force, same.force, rtol=1e-7, atol=1e-7 * np.abs(same.force).max())
        assert film.heat_to_walls == pytest.approx(same.heat_to_walls, rel=1e-7)
        assert conductance < 1e4 or T - AMBIENT < 0.05


@pytest.mark.parametrize("kind", ("lumped", "field"))
def test_equilibrium_and_stribeck_take_a_sump(make_bearing, kind):
    thermal = replace(HEAT[kind], supply_temperature=ehd.Sump(conductance=6.0, ambient=AMBIENT))
    bearing = make_bearing(0.5, film=FILM, lubricant=OIL, thermal=thermal)
    film = ehd.equilibrium(bearing, speed=250.0, load=(0.0, -1500.0)).film
    assert film.heat_by_oil == pytest.approx(6.0 * (film.supply_temperature - AMBIENT), rel=1e-8)
    curve = ehd.stribeck(bearing, load=1500.0, speeds=[250.0])
    assert curve.film_temperature[0] == pytest.approx(np.mean(film.temperature), abs=0.3)


@pytest.mark.parametrize("options", ({}, GROOVE), ids=("flooded", "groove"))
@pytest.mark.parametrize("kind", HEAT)
def test_sump_in_time(make_bearing, kind, options):
    """Backward Euler: the tank stores what the oil brings and the ambient does not take; the film is that of a supply
    with the temperature at the end of the step. In the end the tank is the steady one."""
    rng = np.random.default_rng(7)
    sump = ehd.Sump(conductance=6.0, ambient=AMBIENT, heat_capacity=0.5, initial_temperature=AMBIENT + 3.0)
    bearing = make_bearing(0.5, film=FILM, lubricant=OIL, thermal=HEAT[kind], **options)
    model = build_model(replace(bearing, thermal=replace(HEAT[kind], supply_temperature=sump)))
    motion = np.zeros(10)
    motion[:2], motion[8] = 0.6 * bearing.radial_clearance * np.array([np.cos(-2.2), np.sin(-2.2)]), 250.0
    history = model.initial_history(motion)
    assert history.sump == AMBIENT + 3.0
    for _ in range(2):
        step = 10.0 ** rng.uniform(-3.0, -1.0)
        evaluation = model.evaluate(motion, history, step)
        after = evaluation.history()
        assert evaluation.quantities()["sump_temperature"] == history.sump
        heat = model.effects.thermal.balance(evaluation.film, after.temperature)
        stored = sump.heat_capacity * (after.sump - history.sump) / step
        taken = sump.conductance * (after.sump - AMBIENT)
        assert heat["convected"] == pytest.approx(stored + taken, rel=1e-9)
        assert abs(stored) > 1e-3 * abs(taken)
        given = build_model(replace(bearing, thermal=replace(HEAT[kind], supply_temperature=after.sump)))
        same = given.evaluate(motion, replace(history, sump=None), step).history()
        np.testing.assert_allclose(after.temperature, same.temperature, rtol=1e-9)
        history = after
    if kind in ("lumped", "field"):
        for _ in range(30):
            history = model.evaluate(motion, history, 20.0).history()
        film = ehd.steady(model.bearing, speed=250.0, eccentricity_ratio=0.6, direction=-2.2)
        # the heats of temperature fields after long steps and of steady ones are 6e-3 apart, from a given supply too
        near = (7e-3 if kind == "field" else 1e-6) * (film.supply_temperature - AMBIENT)
        assert history.sump == pytest.approx(film.supply_temperature, abs=near)
    slow = replace(model.bearing.thermal, supply_temperature=replace(sump, heat_capacity=0.0))
    model = build_model(replace(bearing, thermal=slow))
    evaluation = model.evaluate(motion, model.initial_history(motion), 1e-3)
    heat = model.effects.thermal.balance(evaluation.film, evaluation.history().temperature)
    assert heat["convected"] == pytest.approx(6.0 * (evaluation.history().sump - AMBIENT), rel=1e-9)


def test_a_tank_warms_up_exponentially(make_bearing):
    """Constant power P: T = T_a + P / G (1 - exp(-G t / C)), to the first order of the steps."""
    sump = ehd.Sump(conductance=10.0, ambient=AMBIENT, heat_capacity=300.0)
    bearing = make_bearing(0.5, film=FILM, thermal=ehd.LumpedThermal(supply_temperature=sump))
    model, errors = build_model(bearing), []
    motion = np.array([1.5e-5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 250.0, 0.0])
    for count in (40, 80):
        history = model.initial_history(motion)
        for _ in range(count):
            evaluation = model.evaluate(motion, history, 60.0 / count)
            history = evaluation.history()
        exact = evaluation.quantities()["power_loss"] / 10.0 * (1.0 - np.exp(-2.0))
        errors.append((history.sump - AMBIENT) / exact - 1.0)
    assert abs(2.0 * errors[1] - errors[0]) < 1e-3
    assert 1e-3 < abs(errors[1]) < 0.6 * abs(errors[0]) < 0.02


@pytest.mark.parametrize("supply", (AMBIENT, ehd.Sump(conductance=5.0, ambient=AMBIENT)))
def test_effective_temperature_is_that_of_iso_7902(make_bearing, supply):
    """T_eff is the mean of inlet and outlet, T_ex = T_en + P / (rho c_p Q); the film is isothermal at T_eff."""
    thermal = ehd.LumpedThermal(supply_temperature=supply, effective_rise=0.5)
    bearing = make_bearing(0.5, lubricant=OIL, thermal=thermal)
    film = ehd.steady(bearing, speed=250.0, eccentricity_ratio=0.6)
    outlet = film.supply_temperature + film.heat_by_oil / (OIL.density * OIL.specific_heat * film.oil_flow)
    assert film.heat_by_oil == pytest.approx(film.power_loss, rel=1e-9)
    assert film.temperature == pytest.approx(0.5 * (film.supply_temperature + outlet), rel=1e-12)
    plain = replace(bearing, thermal=None, lubricant=OIL.at(film.temperature))
    isothermal = ehd.steady(plain, speed=250.0, eccentricity_ratio=0.6)
    np.testing.assert_allclose(film.force, isothermal.force, rtol=1e-9, atol=1e-9)
    mixed = ehd.steady(
        replace(bearing, thermal=replace(thermal, effective_rise=1.0)), speed=250.0, eccentricity_ratio=0.6
    )
    assert mixed.temperature > film.temperature + 5.0


@pytest.mark.parametrize("kind", HEAT)
def test_oil_of_constant_viscosity_carries_its_temperature_along(make_bearing, kind):
    """Without a law of the temperature the film is the isothermal one; the temperature is that of a flat law."""
    thermal, oil = replace(HEAT[kind], supply_temperature=AMBIENT), ehd.Lubricant(viscosity=0.02)
    if kind == "walls":
        thermal = replace(
            thermal, bush=replace(thermal.bush, expansion=0.0), journal=replace(thermal.journal, expansion=0.0)
        )
    bearing = make_bearing(0.5, film=FILM, lubricant=oil, thermal=thermal)
    film = ehd.steady(bearing, speed=250.0, eccentricity_ratio=0.6)
    isothermal = ehd.steady(replace(bearing, thermal=None), speed=250.0, eccentricity_ratio=0.6)
    np.testing.assert_allclose(film.force, isothermal.force, rtol=1e-11, atol=1e-9)
    flat = replace(oil, temperature_law=ehd.ReynoldsTemperature(point=(AMBIENT, 0.02), coefficient=0.0))
    same = ehd.steady(replace(bearing, lubricant=flat), speed=250.0, eccentricity_ratio=0.6)
    np.testing.assert_allclose(film.temperature, same.temperature, rtol=1e-12)
    assert film.peak_temperature > AMBIENT + 10.0
    assert film.heat_by_oil + film.heat_to_walls == pytest.approx(film.power_loss, rel=3e-3)


@pytest.mark.slow
def test_audit_counts_a_constant_viscosity_as_no_heating(make_bearing):
    """It advises a law of the temperature, and keeps the bearing's way of heating."""
    thermal = ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=3.0)
    bearing = make_bearing(0.5, film=FILM, thermal=thermal)
    audit = ehd.steady(bearing, speed=250.0, eccentricity_ratio=0.6).audit()
    assert (audit["heating"].on, audit["heating"].matters) == (False, True)
    better = audit.improved(bearing)
    assert better.thermal is thermal and better.lubricant.temperature_law is not None
