"""Asperity contact and average gap against quadrature and their readable twins."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

import exudyn_ehd as ehd
from exudyn_ehd.film.surfaces.roughness import AsperityContact, AverageGap, greenwood_tripp_integral

CLEARANCE = 20e-6
SIGMA = 0.5e-6
ASPERITY = ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=1e11)


def integral(order, u):
    """F_order(u) by quadrature, split where the integrand bends."""
    start = max(0.0, -u)

    def density(s):
        return s**order * math.exp(-0.5 * (s + u) ** 2) / math.sqrt(2 * math.pi)

    return quad(density, 0.0, start + 14.0, points=[start], epsabs=0.0, epsrel=1e-12, limit=400)[0]


def contact(u):
    """Pressure over the pressure scale and its slope by u of the kernel, at u = h / sigma (k,)."""
    model = AsperityContact(ASPERITY, CLEARANCE)
    H = np.atleast_2d(u) * SIGMA / CLEARANCE
    P, slope = np.full(H.shape, np.nan), np.full(H.shape, np.nan)
    model.pressure(H, P, slope)
    return P[0] / ASPERITY.pressure_scale, slope[0] / ASPERITY.pressure_scale * SIGMA / CLEARANCE


def test_pressure_function_equals_quadrature():
    """Below 1e-6 relative everywhere, on the table, on the series below -8 and
    down to 1e-16 of the value at contact."""
    u = np.concatenate((np.linspace(-14.0, 7.9, 120), [-8.0, -7.999999, -8.000001]))
    exact = np.array([integral(2.5, x) for x in u])
    np.testing.assert_allclose(contact(u)[0], exact, rtol=1e-6)


def test_slope_is_the_derivative_of_the_pressure():
    """F_5/2' = -5/2 F_3/2; the interpolant's slope is one order less accurate, 2e-5 relative at u = 7.9."""
    u = np.linspace(-12.0, 7.9, 90)
    exact = np.array([-2.5 * integral(1.5, x) for x in u])
    np.testing.assert_allclose(contact(u)[1], exact, rtol=2e-5)


def test_pressure_is_smooth_where_its_branches_meet():
    """Value and slope at u = -8 and u = 8 from both sides; 1e-7 of the value covers the series' cut-off."""
    for at in (-8.0, 8.0):
        value, slope = contact(np.array([at - 1e-9, at + 1e-9]))
        np.testing.assert_allclose(value[0], value[1], rtol=1e-7, atol=1e-14)
        np.testing.assert_allclose(slope[0], slope[1], rtol=2e-6, atol=1e-13)


def test_beyond_eight_sigma_there_is_no_contact():
    value, slope = contact(np.array([8.0, 10.0, 1e6]))
    assert not value.any() and not slope.any()


@pytest.mark.parametrize("order", [0.0, 1.0, 2.0, 2.5])
def test_parabolic_cylinder_form(order):
    u = np.linspace(-5.0, 5.0, 11)
    np.testing.assert_allclose(greenwood_tripp_integral(order, u), [integral(order, x) for x in u], rtol=1e-10)


def test_pressure_scale():
    """16 sqrt(2) pi / 15 (eta beta sigma)^2 sqrt(sigma / beta) E', worked out
    by hand for 0.05, 0.01 and 1e11 Pa: 118.48 MPa."""
    assert ASPERITY.pressure_scale == pytest.approx(118.4768e6, rel=1e-6)


def test_composite_modulus_of_equal_bodies():
    assert ehd.composite_modulus((2.1e11, 2.1e11), (0.3, 0.3)) == pytest.approx(2.1e11 / (2 * 0.91), rel=1e-14)
    with pytest.raises(ehd.InputError, match=r"composite_modulus: .* two numbers each, .*, got 1 and 2\."):
        ehd.composite_modulus((2.1e11,), (0.3, 0.3))


def test_average_gap_is_the_mean_of_the_clipped_gap():
    """h_T = E[max(h + s, a sigma)] by quadrature; 1e-13 is rounding of values around one."""
    sigma, a = 0.03, 0.02
    x = np.linspace(-6.0, 12.0, 60)
    H = np.atleast_2d(x * sigma)
    link, rate = H.copy(), np.full(H.shape, 0.7)
    slope, bend, link_slope = np.empty(H.shape), np.empty(H.shape), np.empty(H.shape)
    AverageGap(sigma, a).limit(H, link, rate, slope, bend, link_slope)
    y = x - a
    exact = a + np.array(
        [
            quad(
                lambda s, y=v: max(y + s, 0.0) * norm.pdf(s),
                -v,
                -v + 20 + max(v, 0),
                epsabs=1e-14,
                limit=200,
                points=[0.0],
            )[0]
            for v in y
        ]
    )
    np.testing.assert_allclose(H[0] / sigma, exact, atol=1e-12)
    np.testing.assert_allclose(slope[0], norm.cdf(y), atol=2e-12)
    np.testing.assert_allclose(bend[0] / 0.7 * sigma, norm.pdf(y), atol=1e-10)
    np.testing.assert_allclose(rate, 0.7 * slope, rtol=1e-15)
    np.testing.assert_array_equal(link, H)
    np.testing.assert_array_equal(link_slope, slope)


def test_average_gap_stays_positive_however_deep():
    H = np.linspace(-2.0, 0.0, 201)[None]
    AverageGap(0.01, 0.02).limit(H, H.copy(), np.zeros(H.shape), *(np.empty(H.shape) for _ in range(3)))
    assert H.min() >= 0.02 * 0.01
    assert np.all(np.diff(H[0]) >= 0.0)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("composite_roughness", 0.0),
        ("composite_modulus", -1.0),
        ("density_radius_roughness", 0.0),
        ("roughness_radius_ratio", math.nan),
        ("friction_coefficient", -0.1),
        ("friction_coefficient", 10.0),
        ("transition_speed", 0.0),
        ("residual_film", 0.5),
    ],
)
def test_refused_values(option, value):
    values = {"composite_roughness": 1e-6, "composite_modulus": 1e11} | {option: value}
    with pytest.raises(ehd.InputError, match=rf"GreenwoodTripp\.{option}"):
        ehd.GreenwoodTripp(**values)
