"""`Sump`, ``LumpedThermal.effective_rise`` and temperatures that the viscosity does not follow, in steady films."""

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
    with pytest.raises(ehd.InputError, match="supply_temperature at the mean load"):
        build_model(bearing)


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
