"""Stribeck curve: regimes, limits, order of speeds, refusals."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

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
