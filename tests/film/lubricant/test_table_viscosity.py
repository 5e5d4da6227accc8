"""`TableViscosity`: round trips of other laws, slope, what lies outside its points, and its films."""

from __future__ import annotations

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.lubricant import ISO_GRADES, MULTIGRADES, SAE_GRADES, TABLE_UNIT


def table_of(oil, low, high, step):
    """Return the table of an oil's law."""
    T = np.arange(low, high + 0.5 * step, step)
    return ehd.TableViscosity(temperatures=T, viscosities=oil.temperature_law.viscosity(T, oil.density))


@pytest.mark.parametrize(("step", "walther", "vogel"), [(10.0, 1.2e-4, 2.1e-3), (20.0, 7e-4, 0.012)])
def test_round_trip_of_all_oils(measured, step, walther, vogel):
    """Tables from 0 to 120 degrees Celsius of Walther's law (ISO, multigrade) and Vogel's (SAE single grades)."""
    for names, limit in ((ISO_GRADES | MULTIGRADES, walther), (SAE_GRADES, vogel)):
        worst = 0.0
        for oil in (ehd.oil(name) for name in names):
            law, T = table_of(oil, 273.15, 393.15, step), np.linspace(273.15, 393.15, 999)
            worst = max(
                worst, np.abs(law.viscosity(T, 870.0) / oil.temperature_law.viscosity(T, oil.density) - 1.0).max()
            )
            np.testing.assert_allclose(law.viscosity(np.array(law.temperatures), 870.0), law.viscosities, rtol=1e-12)
        measured(f"{step:g} K", worst, limit)


def test_two_points_are_a_straight_line():
    """ln ln (mu / 1e-5) is linear in ln T, as Walther's law without its constant."""
    law, T = (
        ehd.TableViscosity(temperatures=[313.15, 373.15], viscosities=[0.04, 0.006]),
        np.linspace(313.15, 373.15, 9),
    )
    y = np.log(np.log(law.viscosity(T, 870.0) / TABLE_UNIT))
    np.testing.assert_allclose(np.diff(y) / np.diff(np.log(T)), (y[-1] - y[0]) / np.log(373.15 / 313.15), rtol=1e-10)


def test_any_table_falls_everywhere_and_has_no_kinks():
    rng = np.random.default_rng(7)
    for _ in range(20):
        T = 270.0 + np.cumsum(rng.uniform(2.0, 30.0, 7))
        mu = 10.0 ** -np.cumsum(rng.uniform(0.02, 0.5, 7))
        law = ehd.TableViscosity(temperatures=T, viscosities=mu)
        at = np.linspace(T[0] - 50.0, T[-1] + 100.0, 20001)
        found = law.viscosity(at, 870.0)
        assert np.all(np.diff(found) <= 0.0)
        for one in T:
            before, after = (
                np.diff(np.log(law.viscosity(one + s * np.array([1e-4, 2e-4]), 1.0)))[0] / s for s in (-1, 1)
            )
            assert before == pytest.approx(after, abs=5e-8)


def test_film_of_a_table_is_that_of_its_oil(make_bearing):
    """Steady film with a temperature field, by `oil` and by its table; the lubricant at another temperature."""
    oil = ehd.oil("ISO VG 46", temperature=330.0)
    law = table_of(oil, 290.0, 400.0, 10.0)
    measured = replace(oil, viscosity=None, temperature_law=law)
    assert measured.viscosity == pytest.approx(oil.viscosity, rel=1e-4)
    assert measured.at(350.0).viscosity == pytest.approx(oil.at(350.0).viscosity, rel=2e-4)
    assert hash(law) == hash(ehd.TableViscosity(temperatures=list(law.temperatures), viscosities=law.viscosities))
    films = [
        ehd.steady(
            make_bearing(
                0.5, lubricant=lubricant, thermal=ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=500.0)
            ),
            speed=200.0,
            eccentricity_ratio=0.6,
        )
        for lubricant in (oil, measured)
    ]
    np.testing.assert_allclose(films[1].temperature, films[0].temperature, atol=0.02)
    np.testing.assert_allclose(films[1].force[:2], films[0].force[:2], rtol=1e-3)


SHORT = ehd.TableViscosity(temperatures=(300.0, 320.0, 340.0), viscosities=(0.08, 0.03, 0.015))


def hot(make_bearing, thermal):
    return make_bearing(0.5, lubricant=ehd.Lubricant(temperature_law=SHORT), thermal=thermal)


@pytest.mark.parametrize("across", (0, 1, 2))
def test_films_outside_the_table_are_refused_by_name(make_bearing, across):
    """Their search passes through states outside, as those of films that end inside do too."""
    thermal = ehd.LumpedThermal(supply_temperature=313.15)
    if across:
        thermal = ehd.FilmEnergy(supply_temperature=313.15, conductivity=0.13, across=across)
    bearing = hot(make_bearing, thermal)
    inside = ehd.steady(bearing, speed=20.0, eccentricity_ratio=0.6)
    assert 313.15 < inside.peak_temperature < 340.0
    with pytest.raises(
        ehd.FilmError, match=r"steady: the film's temperatures reach .* TableViscosity from 300 to 340 K"
    ):
        ehd.steady(bearing, speed=700.0, eccentricity_ratio=0.6)
    with pytest.raises(ehd.FilmError, match="extend the table"):
        ehd.equilibrium(bearing, speed=700.0, load=(0.0, -3000.0))
    with pytest.raises(ehd.FilmError, match=r"stribeck at 700 rad/s: the film's temp"):
        ehd.stribeck(bearing, load=3000.0, speeds=[700.0])


def test_a_run_ends_where_its_film_leaves_the_table(make_bearing):
    """A journal that spins fast between two bodies: the error names joint, time and table."""
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    ground = mbs.CreateGround()
    shaft = mbs.CreateRigidBody(
        inertia=InertiaCylinder(density=7800, length=0.05, outerRadius=0.025, axis=2),
        initialDisplacement=[1e-5, 0, 0],
        initialAngularVelocity=[0, 0, 2000],
    )
    bearing = hot(make_bearing, ehd.LumpedThermal(supply_temperature=313.15))
    ehd.CreateLubricatedJoint(mbs, "main", [ground, shaft], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.05, 500
    ehd.ConfigureSolver(settings)
    with pytest.raises(ehd.FilmError, match=r"LubricatedJoint 'main' at t = .*TableViscosity from 300 to 340 K"):
        ehd.SolveDynamic(mbs, settings)


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ({"temperatures": (300.0,), "viscosities": (0.04,)}, "at least two"),
        ({"temperatures": (300.0, 320.0), "viscosities": (0.04,)}, "at least two"),
        ({"temperatures": (320.0, 300.0), "viscosities": (0.04, 0.02)}, "sort the points"),
        ({"temperatures": (300.0, 320.0), "viscosities": (0.02, 0.04)}, "below the one before"),
        ({"temperatures": (300.0, 320.0), "viscosities": (0.02, 0.0)}, "above 1e-05 Pa s"),
        ({"temperatures": 300.0, "viscosities": (0.02, 0.01)}, "temperatures must be"),
        ({"temperatures": (300.0, float("nan")), "viscosities": (0.02, 0.01)}, "temperatures must be"),
    ],
)
def test_input(arguments, match):
    with pytest.raises(ehd.InputError, match=match):
        ehd.TableViscosity(**arguments)


def test_given_temperatures_outside_are_refused(make_bearing):
    with pytest.raises(ehd.InputError, match=r"Lubricant\.temperature = 290\.0 K is outside the TableViscosity"):
        ehd.Lubricant(temperature_law=SHORT, temperature=290.0)
    with pytest.raises(ehd.InputError, match=r"Lubricant\.at: temperature = 350\.0 K"):
        ehd.Lubricant(temperature_law=SHORT).at(350.0)
    with pytest.raises(ehd.InputError, match=r"thermal\.supply_temperature = 295\.0 K"):
        hot(make_bearing, ehd.LumpedThermal(supply_temperature=295.0))
