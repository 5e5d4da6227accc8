"""Films that neither oil nor steel bears are told of."""

import warnings

import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.balance.limits import HIGHEST_PEAK

BEARING = ehd.JournalBearing(
    journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02)
)


def test_steady_films_warn_from_where_no_material_bears_them():
    """The peak is proportional to the speed."""
    peak = ehd.steady(BEARING, speed=100.0, eccentricity_ratio=0.98).peak_pressure
    limit = 100.0 * HIGHEST_PEAK / peak
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ehd.steady(BEARING, speed=0.99 * limit, eccentricity_ratio=0.98)
    with pytest.warns(ehd.OverloadWarning, match="steady: the film has a peak pressure of 3.03e\\+09 Pa") as told:
        ehd.steady(BEARING, speed=1.01 * limit, eccentricity_ratio=0.98)
    assert len(told) == 1 and told[0].filename == __file__


def test_a_film_that_a_load_has_found_warns_once():
    with pytest.warns(ehd.OverloadWarning, match="equilibrium: ") as told:
        ehd.equilibrium(BEARING, speed=300.0, load=(0.0, -2e6))
    assert sum(w.category is ehd.OverloadWarning for w in told) == 1


def wall(**options):
    stop = ehd.RegularisedWall(onset=2e-6, **options)
    oil = ehd.Lubricant(viscosity=0.05)
    return ehd.JournalBearing(journal_radius=0.012, length=0.03, radial_clearance=20e-6, lubricant=oil, contact=stop)


def test_a_wall_that_carries_what_no_bearing_does():
    """Through the contact: a warning from a mean of 1 GPa on, and no result beyond a clearance's depth."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ehd.steady(wall(), speed=300.0, eccentricity_ratio=1.01).contact_load > 1e5
    with pytest.warns(ehd.OverloadWarning, match="with its contact 6.9.e\\+09 Pa on the projected area"):
        assert ehd.steady(wall(), speed=300.0, eccentricity_ratio=1.3).peak_pressure < HIGHEST_PEAK
    for call in (
        lambda: ehd.steady(wall(), speed=300.0, eccentricity_ratio=2.1),
        lambda: ehd.equilibrium(wall(), speed=300.0, load=(0.0, -5e7)),
    ):
        with pytest.raises(ehd.FilmError, match=r"pressed through its contact by .*, minimum film thickness -2"):
            call()
    with pytest.warns(ehd.OverloadWarning, match="equilibrium: "):
        ehd.equilibrium(wall(pressure=1e11), speed=300.0, load=(0.0, -5e7))
