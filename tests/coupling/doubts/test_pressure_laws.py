"""Films near the end of their oil's pressure law: told once, early, with the load that they can carry."""

import dataclasses
import re
import warnings

import pytest
import scenes

import exudyn_ehd as ehd

BEARING = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=20e-6,
    lubricant=ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=2e-8)),
    film=ehd.FiniteLength(n_theta=96, n_z=8),
)
AREA = 2.0 * BEARING.journal_radius * BEARING.length
SPEED = 300.0


def told(bearing, load):
    """Warnings about the law in a run that starts in equilibrium, and the run's history."""
    mbs, joint = scenes.loaded_journal(bearing, [0.0, -load, 0.0], speed=SPEED)
    mbs.Assemble()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ehd.OverloadWarning)
        joint.place_in_equilibrium(load=(0.0, -load))
        ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(2e-4, 10)))
    return [str(each.message) for each in caught if "largest load" in str(each.message)], joint.history


def test_a_film_near_the_end_of_its_law_is_told_once_with_what_it_can_carry():
    (text,), history = told(BEARING, 16e3)
    assert history.time.size == 11 and "BarusPressure(coefficient=2e-08)" in text and "ModalBush" in text
    peak, mean, largest = (float(re.search(rf"{part} (\S+) MPa", text)[1]) for part in ("is", r"length\)", "about"))
    assert peak == pytest.approx(1e-6 * history.peak_pressure[0], rel=5e-3)
    assert mean == pytest.approx(1e-6 * 16e3 / AREA, rel=5e-3)
    # at the end a vertex alone carries the peak, coarse grids 8 % more than fine ones
    fine = dataclasses.replace(BEARING, film=ehd.FiniteLength(n_theta=192, n_z=12))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ehd.GridWarning)
        ehd.equilibrium(fine, speed=SPEED, load=(0.0, -0.96 * 1e6 * largest * AREA))
        with pytest.raises(ehd.FilmError, match="no position found"):
            ehd.equilibrium(fine, speed=SPEED, load=(0.0, -1.05 * 1e6 * largest * AREA))


@pytest.mark.parametrize(
    "bearing",
    [
        dataclasses.replace(BEARING, lubricant=ehd.Lubricant(viscosity=0.02)),
        dataclasses.replace(BEARING, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=6e10, poisson_ratio=0.33)),
    ],
    ids=["no law", "liner"],
)
def test_other_films_have_no_such_end(bearing):
    assert told(bearing, 16e3)[0] == []


def test_two_thirds_of_the_largest_load_are_not_told():
    """19.1 kN on fine grids."""
    assert told(BEARING, 0.67 * 19.1e3)[0] == []
