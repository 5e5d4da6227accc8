"""A rotor in Exudyn whose bush and journal take up the film's heat and grow."""

import dataclasses

import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd

SPEED = 300.0
WALL = ehd.Conduction(thickness=1e-3, conductance=5.0, density=400.0, expansion=1.2e-5)


def run(journal, end, steps, across=1, **options):
    thermal = ehd.FilmEnergy(supply_temperature=313.15, conductivity=0.13, bush=WALL, journal=journal, across=across)
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=20e-6,
        lubricant=ehd.oil("ISO VG 46"),
        thermal=thermal,
        end_pressures=(1e5, 1e5),
        film=ehd.FiniteLength(n_theta=32, n_z=6),
        **options,
    )
    mbs = scenes.new_system()
    ground = scenes.add_body(mbs, "ground")
    body = scenes.add_body(mbs, "RotVec", spin=(0, 0, SPEED), gravity=[0, -300.0, 0])
    joint = ehd.CreateLubricatedJoint(mbs, "rotor", [ground, body], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(end, steps)))
    return joint


@pytest.mark.slow
@pytest.mark.parametrize("across", [1, 2])
def test_a_run_ends_in_the_equilibrium_of_film_and_walls(across):
    joint = run(WALL, 1.0, 250, across)
    history = joint.history
    found = ehd.equilibrium(joint.bearing, speed=history.motion[-1, 8], load=tuple(-history.force[-1, :2]))
    film = found.film
    # friction brakes the rotor all the time, which film and walls follow with a delay
    np.testing.assert_allclose(history.eccentricity[-1], found.position, atol=1e-3 * 20e-6)
    assert history.clearance[-1] == pytest.approx(film.walls.clearance, abs=1e-4 * 20e-6)
    assert history.bush_temperature[-1] == pytest.approx(film.walls.bush[:, 0].mean(), abs=0.1)
    assert history.journal_temperature[-1] == pytest.approx(film.walls.journal[0], abs=0.1)
    # from the cold start on the journal is the hotter one and the clearance gets smaller
    assert history.clearance[0] == pytest.approx(20e-6, rel=1e-12)
    assert history.clearance[-1] < 19.95e-6


@pytest.mark.parametrize("contact", [None, ehd.RegularisedWall(onset=2e-6, pressure=1e8)], ids=["film", "wall"])
def test_a_journal_that_outgrows_the_clearance_ends_the_run_by_name(contact):
    hot = dataclasses.replace(WALL, conductance=0.0, expansion=2e-4)
    with pytest.raises(ehd.FilmError, match="seizes"):
        run(hot, 1.0, 250, contact=contact)


@pytest.mark.slow
def test_steady_films_of_such_a_journal_end_by_name():
    joint = run(WALL, 4e-3, 1)
    hot = dataclasses.replace(WALL, conductance=0.0, expansion=2e-4)
    thermal = dataclasses.replace(joint.bearing.thermal, journal=hot)
    for contact in (None, ehd.RegularisedWall(onset=2e-6, pressure=1e8)):
        bearing = dataclasses.replace(joint.bearing, thermal=thermal, contact=contact)
        with pytest.raises(ehd.FilmError):
            ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.5)
