"""Films thinner than surfaces are rough say so, once; those that model contact, or are thick, do not."""

import warnings

import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling import doubts


def run(load, speed=300.0, **options):
    """A journal that starts where its film carries the load, or next to it."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=64, n_z=6),
        **options,
    )
    mbs, joint = scenes.loaded_journal(bearing, [0.0, -load, 0.0], speed)
    mbs.Assemble()
    joint.place_in_equilibrium(load=(0.0, -load))
    settings = scenes.settings(2e-3, 10, tolerance=1e-8)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


def test_a_smooth_film_below_the_roughness_of_good_surfaces_warns_once():
    with pytest.warns(ehd.ThinFilmWarning) as told:
        history = run(4e4, speed=10.0)
    (text,) = [str(w.message) for w in told if w.category is ehd.ThinFilmWarning]
    assert "'bearing': at t = " in text
    assert "asperity=GreenwoodTripp" in text
    assert history.minimum_gap.min() < doubts.GOOD_SURFACE
    first = history.time[history.minimum_gap < doubts.GOOD_SURFACE][0]
    assert float(text.split("t = ")[1].split(" s ")[0]) == pytest.approx(first)


@pytest.mark.parametrize(
    ("load", "options"),
    [
        (2e3, {}),
        (4e4, {"speed": 10.0, "asperity": ehd.GreenwoodTripp(composite_roughness=3e-7, composite_modulus=1e11)}),
        (4e4, {"speed": 10.0, "contact": ehd.RegularisedWall(onset=5e-7, pressure=1e10)}),
    ],
    ids=["thick", "asperities", "wall"],
)
def test_thick_films_and_those_with_contact_say_nothing(load, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error", ehd.ThinFilmWarning)
        run(load, **options)


def test_small_bearings_have_finer_surfaces():
    bearing = ehd.JournalBearing(
        journal_radius=5e-4, length=5e-4, radial_clearance=1e-6, lubricant=ehd.Lubricant(viscosity=0.02)
    )
    assert doubts.smooth_limit(bearing) == pytest.approx(0.05e-6)
