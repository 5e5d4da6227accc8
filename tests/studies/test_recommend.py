"""`recommend`: what it says holds, over bearings drawn at random; where it knows nothing it says so."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError
from tests.studies.random_advice import ask, draw, true_error

SPEED = 200.0


def _bearing(ratio=0.7, **options):
    values = {
        "journal_radius": 0.02,
        "length": 0.04 * ratio,
        "radial_clearance": 30e-6,
        "lubricant": ehd.Lubricant(viscosity=0.05),
    }
    return ehd.JournalBearing(**(values | options))


def _solid(kind=ehd.ModalBush, **options):
    mesh = ehd.HollowCylinder(inner_radius=0.02, thickness=0.012, length=0.028, axial=2, radial=1, circumferential=16)
    material = ehd.SaintVenantKirchhoff(youngs_modulus=1e10, poisson_ratio=0.3, density=7800.0)
    return _bearing(bush=kind(mesh=mesh, material=material, **options))


@pytest.mark.slow
# of the films themselves, behind the advice, which warns of none
@pytest.mark.filterwarnings("ignore:.* it departs from a straight line .*:UserWarning")
def test_random_bearings():
    """The first 40 of the 200 that its record is about (studies/README.md)."""
    outcomes = [ask(draw(seed)) for seed in range(40)]
    found = [out for out in outcomes if out.advice.found]
    assert len(found) >= 0.9 * len(outcomes)
    assert sum(out.true <= out.advice.error for out in found) >= 0.95 * len(found)
    assert np.median([out.advice.error / max(out.true, 1e-12) for out in found]) <= 5.0


@pytest.mark.slow
def test_trials_warn_of_no_grid():
    """A relief that coarse grids do not see: their error is measured, and no warning leaves (it would be an error)."""
    relief = ehd.EdgeRelief(drop=2e-6, relief_length=3e-4)
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        profile=relief,
    )
    assert ehd.recommend(bearing, 0.05, "load", eccentricity_ratio=0.6, speed=300.0).found


@pytest.mark.slow
def test_solid_bush():
    bearing = _solid(tilted=True, tolerance=0.1)
    advice = ehd.recommend(bearing, 0.02, "peak pressure", eccentricity_ratio=0.7, tilt_ratio=0.2, speed=SPEED)
    assert advice.found
    assert advice.error <= 0.02


@pytest.mark.slow
def test_cheaper_for_less():
    def advice(error, quantity="peak pressure", eccentricity_ratio=0.7):
        return ehd.recommend(_bearing(), error, quantity, eccentricity_ratio=eccentricity_ratio)

    coarse, fine = advice(0.1), advice(0.005)
    assert coarse.film.n_theta < fine.film.n_theta
    assert "eps 0.7" in str(coarse)
    # a range counts with its worst end
    wide = advice(0.02, eccentricity_ratio=(0.3, 0.92))
    assert len(wide.evidence) == 8
    assert wide.film.n_theta >= advice(0.02).film.n_theta


def test_stiffness_wants_the_line_inside_the_cells():
    advice = ehd.recommend(_bearing(), 0.01, "stiffness", eccentricity_ratio=0.7)
    assert "cavitation" not in advice.options
    assert "line in cells" in advice.reason
    lined, plain = (_bearing(cavitation=ehd.SwiftStieber(line_in_cells=where)) for where in (True, False))
    assert ehd.recommend(lined, 0.01, "stiffness", eccentricity_ratio=0.7).film == advice.film
    other = ehd.recommend(plain, 0.01, "stiffness", eccentricity_ratio=0.7)
    assert other.film == advice.film
    assert other.options["cavitation"] == ehd.SwiftStieber(line_in_cells=True)


@pytest.mark.slow
def test_critical_mass():
    place = {"eccentricity_ratio": (0.2, 0.6)}
    advice = ehd.recommend(_bearing(1.0), 0.05, "critical mass", **place)
    assert "line in cells" in advice.reason
    question = dataclasses.replace(
        draw(0), bearing=_bearing(1.0), eccentricity_ratio=0.55, tilt_ratio=0.0, quantity="critical mass"
    )
    assert true_error(question, advice) <= 0.05
    stable = ehd.recommend(_bearing(1.0), 0.05, "critical mass", eccentricity_ratio=0.9)
    assert not stable.found
    assert "does not whirl" in stable.reason


@pytest.mark.slow
def test_supply():
    """The flow of a hole, from wherever the journal presses, and where it is known to press."""
    hole = ehd.Hole(angle=1.0, diameter=4e-3, pressure=2e5)
    bearing = _bearing(supply=(hole,))
    around, there = (
        ehd.recommend(bearing, 0.02, "supply flow", eccentricity_ratio=0.6, speed=SPEED, direction=direction)
        for direction in (None, 4.0)
    )
    assert around.found
    assert there.found
    question = dataclasses.replace(
        draw(0), bearing=bearing, eccentricity_ratio=0.6, tilt_ratio=0.0, quantity="supply flow"
    )
    assert true_error(question, around) <= 0.02


@pytest.mark.slow
def test_areas_that_turn_with_the_journal_are_met_at_all_angles():
    """Whatever direction is given; without an equilibrium there is no critical mass."""
    bearing = _bearing(supply=(ehd.Hole(angle=1.0, diameter=8e-3, pressure=2e5, rotating=True),))
    question = {"error": 0.05, "eccentricity_ratio": 0.6, "speed": SPEED}
    around, there = (ehd.recommend(bearing, quantity="load", direction=d, **question) for d in (None, 4.0))
    assert around.found
    assert (there.film, there.error, there.evidence) == (around.film, around.error, around.evidence)
    assert "no critical mass" in ehd.recommend(bearing, quantity="critical mass", **question).reason


@pytest.mark.parametrize(
    ("change", "place", "words"),
    [
        ({}, {"eccentricity_ratio": 0.97}, "eccentricity_ratio is 0.97"),
        ({}, {"eccentricity_ratio": 0.05}, "eccentricity_ratio is 0.05"),
        ({"length": 0.2}, {}, "L/D is 5"),
        ({}, {"tilt_ratio": 0.9}, "tilt_ratio is 0.9"),
        ({"inlet": ehd.MaximumGap()}, {}, "MaximumGap"),
    ],
)
def test_says_where_it_knows_nothing(change, place, words):
    advice = ehd.recommend(_bearing(**change), **({"eccentricity_ratio": 0.7} | place))
    assert not advice.found
    assert advice.film is None
    assert "nothing is known" in advice.reason
    assert words in advice.reason
    assert math.isnan(advice.error)


def test_nodal_bushes_take_too_long():
    advice = ehd.recommend(_solid(ehd.ANCFBush), eccentricity_ratio=0.7, speed=SPEED)
    assert not advice.found
    assert "ModalBush" in advice.reason


def test_impossible_accuracy():
    advice = ehd.recommend(_bearing(), 1e-7, "damping", eccentricity_ratio=0.9)
    assert not advice.found
    assert "the best gives" in advice.reason


def test_a_film_that_fails_is_named():
    barus = ehd.Lubricant(viscosity=0.05, pressure_law=ehd.BarusPressure(coefficient=2e-8))
    advice = ehd.recommend(_bearing(lubricant=barus), eccentricity_ratio=0.95, speed=2000.0)
    assert not advice.found
    assert "BarusPressure" in advice.reason


@pytest.mark.slow
def test_a_film_that_runs_dry_has_no_errors():
    advice = ehd.recommend(_bearing(cavitation=ehd.ElrodAdams()), eccentricity_ratio=0.5)
    assert not advice.found
    assert "needs oil from somewhere" in advice.reason


def test_refuses():
    with pytest.raises(InputError, match="eccentricity_ratio"):
        ehd.recommend(_bearing())
    for wrong in ("high", [0.5], [0.9, 0.5], float("nan")):
        with pytest.raises(InputError, match="recommend: eccentricity_ratio must be"):
            ehd.recommend(_bearing(), eccentricity_ratio=wrong)
    with pytest.raises(InputError, match="quantity"):
        ehd.recommend(_bearing(), quantity="colour", eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="supply"):
        ehd.recommend(_bearing(), quantity="supply flow", eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="error"):
        ehd.recommend(_bearing(), 1.5, eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="tilt_ratio"):
        ehd.recommend(_bearing(), eccentricity_ratio=0.5, tilt_ratio=-0.1)
    liner = ehd.ElasticLiner(thickness=0.003, youngs_modulus=1e9)
    with pytest.raises(InputError, match=r"speed.*a bush"):
        ehd.recommend(_bearing(bush=liner), eccentricity_ratio=0.5)
    with pytest.raises(InputError, match=r"speed.*end_pressures"):
        ehd.recommend(_bearing(end_pressures=(1e5, 0.0)), eccentricity_ratio=0.5)
