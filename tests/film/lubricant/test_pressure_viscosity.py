"""Pressure laws: closed forms, tables, round trips, kernels against twins, and a film that has a closed form."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.pressure_viscosity import (
    BEYOND,
    BarusPressure,
    PressureTransform,
    RoelandsPressure,
)

ALPHA = 2e-8
MU = 0.04
PRESSURES = np.array([1e3, 1e5, 3.3e6, 5e7, 1.234e8, 3e8, 6e8])


def transform(law, mu=MU):
    return PressureTransform(law.bound(mu))


def inverse(law, q):
    q = np.atleast_2d(q)
    p, r, r_q = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    assert law.inverse(q, p, r, r_q)
    return p[0], r[0], r_q[0]


def roelands_ratio(p, mu=MU, alpha=ALPHA, p0=1.96e8):
    """Roelands' formula as handbooks print it: exp((ln mu0 + 9.67)(-1 + (1 + p / p0)^Z))."""
    a = math.log(mu) + 9.67
    return np.exp(a * (-1.0 + (1.0 + p / p0) ** (alpha * p0 / a)))


def test_barus_transform_is_its_integral():
    law = transform(BarusPressure(coefficient=ALPHA))
    exact = [quad(lambda s: math.exp(-ALPHA * s), 0.0, p, epsabs=0.0, epsrel=1e-13)[0] for p in PRESSURES]
    np.testing.assert_allclose(law.transform(PRESSURES), exact, rtol=1e-13)  # quadrature to rounding


@pytest.mark.parametrize("mu", [0.005, 0.04, 0.3])
def test_roelands_transform_is_its_integral(mu):
    law = transform(RoelandsPressure(coefficient=ALPHA), mu)
    exact = [
        quad(lambda s: 1.0 / roelands_ratio(s, mu), 0.0, p, epsabs=0.0, epsrel=1e-12, limit=200)[0] for p in PRESSURES
    ]
    np.testing.assert_allclose(law.transform(PRESSURES), exact, rtol=2e-12)  # the reference quadrature's tolerance


def test_barus_round_trip():
    law = transform(BarusPressure(coefficient=ALPHA))
    expected = np.concatenate((-PRESSURES[:5], PRESSURES[:5]))
    p, r, r_q = inverse(law, law.transform(expected))
    np.testing.assert_allclose(p, expected, rtol=1e-13)  # rounding times the viscosity ratio
    np.testing.assert_allclose(r, np.exp(ALPHA * expected), rtol=1e-13)
    np.testing.assert_allclose(r_q, ALPHA * np.exp(2.0 * ALPHA * expected), rtol=1e-10)  # of the spline


@pytest.mark.parametrize("mu", [0.005, 0.04, 0.3])
@pytest.mark.parametrize("alpha", [1e-10, 1e-8, 2.5e-8])
def test_roelands_round_trip(mu, alpha):
    law = transform(RoelandsPressure(coefficient=alpha), mu)
    expected = np.linspace(1e4, 3e8, 20001)
    p, r, r_q = inverse(law, law.transform(expected))
    np.testing.assert_allclose(p, expected, rtol=1e-12)  # spline 1e-13, rounding times the viscosity ratio
    np.testing.assert_allclose(
        r, roelands_ratio(expected, mu, alpha), rtol=1e-10
    )  # derivative of the spline: one order less
    slope = r**2 * alpha * (1.0 + expected / 1.96e8) ** (law.viscosity.Z - 1.0)
    np.testing.assert_allclose(r_q, slope, rtol=1e-5)  # second derivative: two orders and digits less


def test_roelands_is_barus_to_first_order_and_below_ambient():
    barus, roelands = transform(BarusPressure(coefficient=ALPHA)), transform(RoelandsPressure(coefficient=ALPHA))
    negative = np.array([-5e7, -1e6, -1.0])
    np.testing.assert_array_equal(roelands.transform(negative), barus.transform(negative))
    errors = [abs(float(roelands.viscosity.ratio(np.array(p))) - math.exp(ALPHA * p)) for p in (2e6, 1e6)]
    assert 3.5 < errors[0] / errors[1] < 4.5  # they part in the second order


@pytest.mark.parametrize("law", [BarusPressure(coefficient=ALPHA), RoelandsPressure(coefficient=ALPHA)])
def test_pressures_that_do_not_exist(law):
    table, out = transform(law), np.empty((3, 1, 1))
    assert table.inverse(np.full((1, 1), table.q[-1] * (1.0 - 1e-12)), *out)
    assert not table.inverse(np.full((1, 1), 1.01 * table.q[-1]), *out)
    assert not table.inverse(np.full((1, 1), np.nan), *out)


def test_barus_law_ends_where_oil_is_solid():
    """Its transform has no pressure from 1 / alpha on."""
    law = transform(BarusPressure(coefficient=ALPHA))
    assert law.q[-1] == pytest.approx((1.0 - 1e-7) / ALPHA, rel=1e-12)


@pytest.mark.parametrize("law", [BarusPressure(coefficient=ALPHA), RoelandsPressure(coefficient=ALPHA)])
def test_laws_go_on_in_a_line(law):
    """Beyond the end of its table a law continues as a straight line, from a pressure with the round-off of q."""
    law = transform(law)
    q = law.q[-1] * np.array([[1.0, 1.2]])
    p, ratio, slope = (np.empty((1, 2)) for _ in range(3))
    assert not law.inverse(q, p, ratio, slope)
    np.testing.assert_allclose(p, law.largest_pressure + BEYOND * (q - law.q[-1]), rtol=1e-10)
    np.testing.assert_array_equal(ratio, BEYOND)
    np.testing.assert_array_equal(slope, 0.0)


def test_kernels_equal_their_readable_twins():
    q = np.random.default_rng(2).uniform(-2e7, 4.5e7, (6, 5))
    q[0, 0] = 0.0
    law = transform(RoelandsPressure(coefficient=ALPHA))

    def barus_twin(x):
        p = -math.log(1.0 - ALPHA * x) / ALPHA
        return p, math.exp(ALPHA * p), ALPHA * math.exp(2.0 * ALPHA * p)

    def roelands_twin(x):
        if x <= 0.0:
            return barus_twin(x)
        k = max(i for i in range(len(law.q) - 1) if law.q[i] <= x)
        w, poly = law.kernel_table.table[k, 0], np.polynomial.Polynomial(law.kernel_table.table[k, 1:])
        t = (x - law.q[k]) * w
        return poly(t), w * poly.deriv()(t), w**2 * poly.deriv(2)(t)

    inside, out = law.fields(q)
    assert inside
    np.testing.assert_array_equal(out[3:], [np.ones_like(q), np.zeros_like(q)])
    for at, x in np.ndenumerate(q):
        np.testing.assert_allclose(
            [o[at] for o in out[:3]], roelands_twin(x), rtol=1e-12, atol=1e-8
        )  # order of summation


def slider(pressure_law, cavitation, n=400):
    """Plane inclined slider without side flow: h from 40 to 20 um over 50 mm, U 10 m/s, mu 0.04 Pa s."""
    grid = ehd.slider_grid(0.05, 0.05, n, 1, sealed_sides=True)
    gap = 20e-6 * (2.0 - grid.x[:, None]) * np.ones((1, 2))
    oil = ehd.Lubricant(viscosity=MU, pressure_law=pressure_law)
    return grid, ehd.solve_film(grid, gap, lubricant=oil, surface_speed=(10.0, 0.0), cavitation=cavitation)


def slider_closed_form(x):
    """Isoviscous pressure of that slider: p = c (1/h - 1/h0 - h_m/2 (1/h^2 - 1/h0^2)), c = 6 mu U L / (h0 - h1)."""
    h0, h1 = 40e-6, 20e-6
    h, hm = h0 + (h1 - h0) * x, 2.0 * h0 * h1 / (h0 + h1)
    c = 6.0 * MU * 10.0 * 0.05 / (h0 - h1)
    return c * ((1.0 / h - 1.0 / h0) - 0.5 * hm * (1.0 / h**2 - 1.0 / h0**2))


@pytest.mark.parametrize("cavitation", [ehd.FullSommerfeld(), ehd.SwiftStieber(), ehd.Gumbel()])
def test_barus_slider_has_the_closed_form(cavitation):
    """The transformed pressure of a Barus film is the isoviscous one: p = -ln(1 - alpha p_iso) / alpha."""
    alpha = 5e-8
    grid, film = slider(BarusPressure(coefficient=alpha), cavitation)
    iso = slider_closed_form(grid.x)
    exact = -np.log1p(-alpha * iso) / alpha
    assert exact.max() > 1.05 * iso.max()  # the law matters
    np.testing.assert_allclose(film.pressure[:, 0], exact, atol=2e-5 * exact.max())  # second order, 400 cells


def test_piezoviscous_slider_converges_with_the_second_order():
    alpha, errors = 5e-8, []
    for n in (100, 200):
        grid, film = slider(BarusPressure(coefficient=alpha), ehd.SwiftStieber(), n)
        exact = -np.log1p(-alpha * slider_closed_form(grid.x)) / alpha
        errors.append(np.abs(film.pressure[:, 0] - exact).max())
    assert 3.5 < errors[0] / errors[1] < 4.5


def test_film_with_a_law_solves_the_untransformed_equation():
    """The flux -h^3 / (12 mu(p)) dp/dx + U h / 2 of the solution is uniform, with mu(p) written out."""
    grid, film = slider(RoelandsPressure(coefficient=5e-8), ehd.FullSommerfeld(), 2000)
    p, x, h = film.pressure[1:-1, 0], 0.05 * grid.x[1:-1], film.gap[1:-1, 0]
    flux = -(h**3) / (12.0 * MU * roelands_ratio(p, MU, 5e-8)) * np.gradient(p, x) + 5.0 * h
    np.testing.assert_allclose(flux[5:-5], flux.mean(), rtol=1e-5)  # second-order differences on 2000 cells


def test_no_pressure_is_reported():
    with pytest.raises(ehd.FilmError, match="NO_PRESSURE"):
        slider(BarusPressure(coefficient=1e-6), ehd.SwiftStieber())


def test_input_errors_name_argument_and_next_step():
    with pytest.raises(ehd.InputError, match=r"BarusPressure\.coefficient must be > 0 1/Pa"):
        BarusPressure(coefficient=0.0)
    with pytest.raises(ehd.InputError, match=r"RoelandsPressure\.reference_pressure"):
        RoelandsPressure(coefficient=1e-8, reference_pressure=-1.0)
    with pytest.raises(ehd.InputError, match="use BarusPressure"):
        ehd.Lubricant(viscosity=1e-5, pressure_law=RoelandsPressure(coefficient=1e-8))
    with pytest.raises(ehd.InputError, match=r"Lubricant\.pressure_law must be BarusPressure"):
        ehd.Lubricant(viscosity=0.01, pressure_law="Barus")
