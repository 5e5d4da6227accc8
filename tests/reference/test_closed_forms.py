"""The closed forms against tables, against each other, and against quadrature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.reference import elastic_rings, long_bearing, petroff, short_bearing, slider

EPS = (0.1, 0.5, 0.9)


@pytest.mark.parametrize("eps", EPS)
def test_long_bearing_load_is_the_integral_of_its_pressure(eps):
    # Trapezoidal sums of smooth periodic integrands converge exponentially: 1e-10 is rounding of the sum.
    theta = np.linspace(0.0, 2.0 * np.pi, 4001)
    p = np.array([long_bearing.full_sommerfeld_pressure(eps, t) for t in theta])
    radial, tangential = np.trapezoid(p * np.cos(theta), theta), np.trapezoid(p * np.sin(theta), theta)
    assert abs(radial) < 1e-10 * tangential
    assert 0.5 * tangential == pytest.approx(long_bearing.full_sommerfeld_load(eps), rel=1e-10)
    # Half film: the integrand has a kink at both ends of [0, pi], so the trapezoidal rule is of second order: 1e-5.
    half = theta <= np.pi + 1e-9
    r, t = np.trapezoid((p * np.cos(theta))[half], theta[half]), np.trapezoid((p * np.sin(theta))[half], theta[half])
    assert 0.5 * math.hypot(r, t) == pytest.approx(long_bearing.half_sommerfeld_load(eps), rel=1e-5)
    assert math.atan2(t, -r) == pytest.approx(long_bearing.half_sommerfeld_attitude(eps), rel=1e-5)


@pytest.mark.parametrize("eps", EPS)
def test_long_bearing_torques_differ_by_the_moment_of_the_load(eps):
    # T_journal - T_bush = e F at an attitude of 90 degrees; in units of Petroff's torque that is eps So / pi.
    difference = long_bearing.full_sommerfeld_journal_torque(eps) - long_bearing.full_sommerfeld_bush_torque(eps)
    assert difference == pytest.approx(eps * long_bearing.full_sommerfeld_load(eps) / math.pi, rel=1e-13)


@pytest.mark.parametrize("eps", (0.1, 0.5, 0.7))
def test_short_bearing_stiffness_and_threshold(eps):
    # Moving along the load changes nothing but the load itself: K e_attitude is the derivative of the load with eps.
    K, C = np.array(short_bearing.stiffness(eps)), np.array(short_bearing.damping(eps))
    step, phi = 1e-5, short_bearing.attitude(eps)
    slope = (short_bearing.load(eps + step, 1.0) - short_bearing.load(eps - step, 1.0)) / (2.0 * step)
    turn = (short_bearing.attitude(eps + step) - short_bearing.attitude(eps - step)) / (2.0 * step)
    expected = np.array([slope / short_bearing.load(eps, 1.0), -turn])
    np.testing.assert_allclose(K @ [math.cos(phi), math.sin(phi)], expected, rtol=1e-7)  # central differences
    assert C[0, 1] == pytest.approx(C[1, 0], rel=1e-12)
    ratio, mass = short_bearing.whirl_threshold(eps)
    # At the threshold one pair of eigenvalues lies on the imaginary axis, at the whirl frequency.
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-K / mass, -C / mass]])
    s = np.linalg.eigvals(first_order)
    worst = s[np.argmax(s.real)]
    assert abs(worst.real) < 1e-10
    assert abs(worst.imag) == pytest.approx(ratio, rel=1e-9)


@pytest.mark.parametrize("eps", (-0.9, -0.3, 0.0, 0.3, 0.9))
def test_short_bearing_squeeze_is_its_quadrature(eps):
    x, w = np.polynomial.legendre.leggauss(200)
    half = 0.5 * np.pi
    closing = half * np.sum(w * np.cos(half * x) ** 2 / (1.0 - eps * np.cos(half * x)) ** 3)
    opening = half * np.sum(w * np.cos(half * x) ** 2 / (1.0 + eps * np.cos(half * x)) ** 3)
    assert short_bearing.squeeze_force(eps, cavitated=True) == pytest.approx(closing, rel=1e-10)
    assert short_bearing.squeeze_force(eps, cavitated=False) == pytest.approx(closing + opening, rel=1e-10)


def test_petroff_published_loss():
    # d 10 mm, psi 1e-5, L 5 mm, mu 0.001 Pa s, 150 against 120 revolutions per second: 2.790537 W.
    # The number depends on whether journal or bore radius is meant, which is worth psi = 1e-5: 2e-5.
    assert petroff.power(1e-3, 2.0 * math.pi * 30.0, 5e-3, 5e-3, 5e-8) == pytest.approx(2.790537, rel=2e-5)


def test_plane_slider_load_is_the_integral_of_its_pressure():
    x, w = np.polynomial.legendre.leggauss(60)
    args = (0.01, 2.0, 0.05, 4e-5, 2e-5)
    p = [slider.plane_slider_pressure(*args, 0.025 * (1.0 + s)) for s in x]
    assert 0.025 * float(np.dot(w, p)) == pytest.approx(slider.plane_slider_load(*args), rel=1e-12)


def test_conical_gap_published_pressures():
    # Published to whole pascals: 1e-6.
    for z, expected in ((0.25, 1998536.0), (0.5, 1972128.0), (0.75, 1519941.0)):
        p = slider.conical_gap_pressure(
            z * 0.025,
            viscosity=1e-3,
            length=0.025,
            inlet=1e-5,
            slope=6e-4,
            speed=22.0,
            gap_rate=-0.0132,
            pressures=(0.8e5, 10e5),
        )
        assert p == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("a", "b", "E", "strain", "stress", "hoop"),
    [
        (0.225, 0.275, 1e6, 1.12173750e-06, 1.20375000e-06, 5.05),
        (0.03, 0.05, 2.1e11, 3.31964286e-13, 3.46428571e-13, 2.125),
    ],
)
def test_thick_cylinder_table(a, b, E, strain, stress, hoop):
    assert elastic_rings.bore_displacement(a, b, 1.0, E, 0.3, plane_strain=True) == pytest.approx(strain, rel=1e-8)
    assert elastic_rings.bore_displacement(a, b, 1.0, E, 0.3, plane_strain=False) == pytest.approx(stress, rel=1e-8)
    assert elastic_rings.lame_stresses(a, b, 1.0, a) == pytest.approx((-1.0, hoop), rel=1e-8)
    assert elastic_rings.lame_stresses(a, b, 1.0, b)[0] == pytest.approx(0.0, abs=1e-14)


def test_thin_ring_table():
    stiffness = 1e6 * 0.05**3 / 12.0
    assert elastic_rings.diametral_shortening(1000.0, 0.25, stiffness) == pytest.approx(0.223168, rel=1e-5)
    assert elastic_rings.diametral_lengthening(1000.0, 0.25, stiffness) == pytest.approx(0.204930, rel=1e-5)
    assert elastic_rings.moment_under_load(1000.0, 0.25) == pytest.approx(79.577472, rel=1e-8)
