"""Stribeck curve: regimes, limits, order of speeds, refusals."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.sampling import sample

ASPERITY = ehd.GreenwoodTripp(
    composite_roughness=0.4e-6, composite_modulus=1e11, friction_coefficient=0.1, transition_speed=1e-4
)


def bearing(**options):
    return ehd.JournalBearing(
        journal_radius=0.02,
        length=0.03,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=64, n_z=8),
        **options,
    )


def test_three_regimes():
    """Boundary friction at a crawl, a minimum, then friction that grows with speed; contact falls all the way."""
    curve = ehd.stribeck(bearing(asperity=ASPERITY), load=2000.0, speeds=np.geomspace(0.01, 500.0, 25))
    f = curve.friction_coefficient
    assert f[0] == pytest.approx(0.1, rel=0.3)
    lowest = int(np.argmin(f))
    assert 5 < lowest < 23
    assert np.all(np.diff(f[lowest:]) > 0.0)
    assert np.all(np.diff(curve.contact_load_share) <= 0.0)
    assert curve.contact_load_share[-1] < 1e-12 < 0.9 < curve.contact_load_share[0]
    assert curve.film_ratio[lowest] == pytest.approx(3.0, abs=1.5)
    assert np.all(np.diff(curve.eccentricity_ratio) < 0.0)
    assert curve.lowest_friction == (curve.speeds[lowest], f[lowest])
    np.testing.assert_allclose(curve.friction_torque, f * 0.02 * 2000.0)
    assert np.all(curve.contact_torque <= curve.friction_torque)
    assert np.all(curve.contact_power_loss <= curve.power_loss * (1 + 1e-12))


def test_full_film_end_is_the_equilibrium():
    """Same position, torque and flow as `equilibrium`; both stand at 1e-10 of the load."""
    b = bearing()
    curve = ehd.stribeck(b, load=500.0, speeds=[300.0])
    other = ehd.equilibrium(b, speed=300.0, load=(0.0, -500.0))
    np.testing.assert_allclose(curve.position[0], other.position, rtol=1e-8)
    assert curve.friction_torque[0] == pytest.approx(-other.film.friction_torque, rel=1e-8)
    assert curve.leakage[0] == pytest.approx(other.film.leakage, rel=1e-8)
    assert math.isnan(curve.film_ratio[0])


def test_lightly_loaded_end_is_petroff():
    """2 pi mu omega R^3 L / c over R load, for a nearly concentric journal: 1 % at eccentricity ratio below 0.05."""
    curve = ehd.stribeck(bearing(asperity=ASPERITY), load=20.0, speeds=[500.0])
    assert curve.eccentricity_ratio[0] < 0.05
    petroff = 2 * math.pi * 0.02 * 500.0 * 0.02**3 * 0.03 / 25e-6
    assert curve.friction_torque[0] == pytest.approx(petroff, rel=1e-2)


def test_order_of_speeds_does_not_matter():
    speeds = np.array([3.0, 100.0, 0.5, 20.0])
    b = bearing(asperity=ASPERITY)
    mixed, ordered = ehd.stribeck(b, load=2000.0, speeds=speeds), ehd.stribeck(b, load=2000.0, speeds=np.sort(speeds))
    np.testing.assert_allclose(np.sort(mixed.friction_coefficient), np.sort(ordered.friction_coefficient), rtol=1e-9)
    np.testing.assert_array_equal(mixed.speeds, speeds)


@pytest.mark.filterwarnings("ignore::exudyn_ehd.HotFilmWarning")
def test_a_branch_is_kept_whatever_the_other_speeds():
    """Two films carry the load at 40 rad/s, one of 320 K and one of 613 K that rubs; the curve follows the first."""
    b = ehd.JournalBearing(
        journal_radius=0.01,
        length=0.02,
        radial_clearance=20e-6,
        lubricant=ehd.oil("ISO VG 46"),
        thermal=ehd.LumpedThermal(supply_temperature=313.0),
        asperity=dataclasses.replace(ASPERITY, composite_roughness=0.5e-6, composite_modulus=7.4e10),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    fine = ehd.stribeck(b, load=2000.0, speeds=np.geomspace(500.0, 40.0, 25))
    assert fine.film_temperature[-1] < 330.0
    for speeds in ([500.0, 40.0], [500.0, 150.0, 40.0, 10.0]):
        curve = ehd.stribeck(b, load=2000.0, speeds=speeds)
        at = speeds.index(40.0)
        assert curve.friction_coefficient[at] == pytest.approx(fine.friction_coefficient[-1], rel=1e-6)
    # behind the end of the branch there is the other one alone
    assert curve.film_temperature[-1] > 500.0


@pytest.mark.parametrize("load", [10.0, 1e3, 1e5])
def test_wide_range_of_loads(load):
    rough = ehd.PatirCheng(composite_roughness=0.4e-6)
    curve = ehd.stribeck(bearing(asperity=ASPERITY, roughness=rough), load=load, speeds=[1e-3, 0.1, 10.0, 1e3])
    assert np.isfinite(curve.friction_coefficient).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"load": 0.0}, "load"),
        ({"speeds": [0.0, 1.0]}, "speeds"),
        ({"speeds": []}, "speeds"),
        ({"speeds": [np.nan]}, "speeds"),
    ],
)
def test_refused_values(options, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.stribeck(bearing(), **({"load": 100.0, "speeds": [10.0]} | options))


LAW = ehd.VogelTemperature(first=(313.15, 0.05), second=(373.15, 0.008))
MESH = ehd.HollowCylinder(inner_radius=0.020025, thickness=8e-3, length=0.03, axial=2, radial=1, circumferential=24)
SOFT = ehd.SaintVenantKirchhoff(youngs_modulus=5e9, poisson_ratio=0.3, density=2000.0)
STATES = {
    "one temperature": {"thermal": ehd.LumpedThermal(supply_temperature=313.15)},
    "field of temperature": {"thermal": ehd.FilmEnergy(supply_temperature=313.15)},
    "modes": {"bush": ehd.ModalBush(mesh=MESH, material=SOFT, tolerance=0.05)},
    "liner": {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9, poisson_ratio=0.4)},
}


@pytest.mark.parametrize("option", sample(STATES, 0))
def test_every_point_is_the_equilibrium_with_whatever_the_bearing_names(option):
    """Temperature and bore settle at each speed; random load and direction of the speeds' order."""
    rng = np.random.default_rng(len(option))
    load, speeds = float(rng.uniform(1e3, 5e3)), rng.permutation([60.0, 200.0, 600.0])
    b = dataclasses.replace(bearing(), lubricant=ehd.Lubricant(temperature_law=LAW), **STATES[option])
    curve = ehd.stribeck(b, load=load, speeds=speeds)
    for k, speed in enumerate(speeds):
        film = ehd.equilibrium(b, speed=speed, load=(0.0, -load)).film
        assert curve.friction_torque[k] == pytest.approx(-film.friction_torque, rel=1e-7)
        assert curve.minimum_gap[k] == pytest.approx(film.minimum_gap, rel=1e-7)
        if b.thermal is not None:
            along = np.trapezoid(film.temperature + 0.0 * film.gap, film.z, axis=1) / np.ptp(film.z)
            assert curve.film_temperature[k] == pytest.approx(along.mean(), rel=1e-8)
            assert curve.film_temperature[k] > 314.0
        else:
            assert math.isnan(curve.film_temperature[k])
            assert curve.bore_displacement[k] > 1e-7


def test_boundary_friction_is_full_however_slow_the_sliding():
    """The asperities' load rubs with their coefficient, whatever their transition speed; the rest is the film's."""
    rough = dataclasses.replace(ASPERITY, transition_speed=0.01)
    curve = ehd.stribeck(bearing(asperity=rough), load=2000.0, speeds=np.geomspace(1e-4, 300.0, 10))
    contact = 0.1 * curve.contact_load_share
    np.testing.assert_allclose(curve.contact_torque / (0.02 * 2000.0), contact, rtol=0.05, atol=1e-9)
    assert curve.contact_load_share[0] > 0.99
    assert curve.friction_coefficient[0] == pytest.approx(0.1, rel=0.02)
    assert 1.0 < curve.lowest_friction[0] < 300.0


def test_a_film_without_a_source_of_oil_is_refused():
    with pytest.raises(ehd.InputError, match=r"stribeck: .* needs oil from somewhere"):
        ehd.stribeck(bearing(cavitation=ehd.ElrodAdams()), load=500.0, speeds=[300.0])


def test_a_load_that_no_film_carries_says_where_the_curve_ends():
    with pytest.raises(
        ehd.FilmError, match=r"stribeck: no equilibrium found at 1e-06 rad/s under 1e\+05 N.*GreenwoodT"
    ) as told:
        ehd.stribeck(bearing(), load=1e5, speeds=[1e-6])
    assert str(told.value).count("stribeck: ") == 1
