"""Dowson and Higginson's density against the published forms, and the transform
of a compressible film against quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.density import CompressibleLaw, density_at
from exudyn_ehd.film.lubricant.pressure_viscosity import law_at

PRESSURES = np.array([0.0, 1e6, 1e8, 5e8, 1e9, 3e9])
VISCOSITIES = {
    "constant": None,
    "barus": ehd.BarusPressure(coefficient=1e-8),
    "roelands": ehd.RoelandsPressure(coefficient=2e-8).bound(0.05),
    "barus as steep as the density": ehd.BarusPressure(coefficient=0.6e-9),
}


def test_published_forms():
    """``(5.9e8 + 1.34 p) / (5.9e8 + p)`` rounds the constants: 1 / 1.7e-9 = 5.88e8 and 0.6 / 1.7 = 0.353 for 0.34."""
    law = ehd.DowsonHigginson()
    np.testing.assert_allclose(law.ratio(PRESSURES), 1.0 + 0.6e-9 * PRESSURES / (1.0 + 1.7e-9 * PRESSURES), rtol=1e-15)
    np.testing.assert_allclose(law.ratio(PRESSURES), (5.9e8 + 1.34 * PRESSURES) / (5.9e8 + PRESSURES), atol=0.013)


def test_density_is_smooth_at_ambient_pressure_and_positive_in_tension():
    law, p = ehd.DowsonHigginson(), np.array([-1e10, -1.0, 0.0, 1.0])
    assert np.all(law.ratio(p) > 0.0)
    np.testing.assert_allclose(law.ratio_slope(p)[1:], 0.6e-9, rtol=1e-8)  # b times 1 Pa
    for at in (-3e8, 2e8, 1e9):
        slope = (law.ratio(at + 1e4) - law.ratio(at - 1e4)) / 2e4
        assert law.ratio_slope(at) == pytest.approx(slope, rel=1e-7)  # rounding of the difference


def test_flow_work_is_the_integral():
    law = ehd.DowsonHigginson()
    p = np.array([-1e8, 0.0, 1e5, 7e7, 4e8, 3e9])
    exact = [quad(lambda x: 1.0 / float(law.ratio(x)), 0.0, end, epsabs=0.0, epsrel=1e-13)[0] for end in p]
    np.testing.assert_allclose(law.flow_work(p), exact, rtol=1e-12)  # quad's own
    # of oil that is hardly compressed: p, without cancellation
    np.testing.assert_allclose(ehd.DowsonHigginson(coefficient=1e-18).flow_work(p), p, rtol=1e-8)


@pytest.mark.parametrize("name", list(VISCOSITIES))
def test_transform_is_the_integral(name):
    density, viscosity = ehd.DowsonHigginson(), VISCOSITIES[name]
    law = CompressibleLaw(density, viscosity)

    def integrand(p):
        return float(density.ratio(p)) / (1.0 if viscosity is None else float(viscosity.ratio(np.asarray(p))))

    for p in (1e5, 7e7, 4e8):
        exact = quad(integrand, 0.0, p, epsabs=0.0, epsrel=1e-12, limit=200)[0]
        assert float(law.transform(p)) == pytest.approx(exact, rel=1e-12)
    tension = quad(lambda p: np.exp((0.6e-9 - (0.0 if viscosity is None else viscosity.coefficient)) * p), 0.0, -1e8)[0]
    assert float(law.transform(-1e8)) == pytest.approx(tension, rel=1e-9)  # quad's own


@pytest.mark.parametrize("name", list(VISCOSITIES))
def test_inverse_gives_back_pressure_and_viscosity(name):
    viscosity = VISCOSITIES[name]
    law = CompressibleLaw(ehd.DowsonHigginson(), viscosity)
    p = np.linspace(-2e8, 5e8, 29).reshape(1, -1)
    q = law.transform(p)
    found, ratio, ratio_q = np.empty_like(p), np.empty_like(p), np.empty_like(p)
    assert law.inverse(q, found, ratio, ratio_q)
    # The spline's error, and rounding of q times dp/dq where the oil is thick.
    np.testing.assert_allclose(found, p, rtol=1e-11, atol=1e-4)
    above = p >= 0.0
    np.testing.assert_allclose(ratio[above], 1.0 if viscosity is None else viscosity.ratio(p[above]), rtol=1e-10)
    plus, minus, _ = (np.empty_like(p) for _ in range(3))
    h = 1e-6 * np.abs(q) + 1.0
    law.inverse(q + h, found, plus, _)
    law.inverse(q - h, found, minus, _)
    np.testing.assert_allclose(ratio_q, (plus - minus) / (2.0 * h), rtol=2e-5, atol=1e-14)  # rounding over the step


def test_no_pressure_beyond_the_range():
    law = CompressibleLaw(ehd.DowsonHigginson(), None)
    out = np.empty((3, 1, 1))
    for q in (law.q[-1], 1.001 * law.q[-1], -1.0 / 0.6e-9):
        assert not law.inverse(np.full((1, 1), q), *out)


def asked(P, scale, floor, law):
    """Density ratio and its derivative from the kernel."""
    rho, rho_P = np.empty_like(P), np.empty_like(P)
    density_at(P, scale, floor, law.kernel_table, np.empty((2, P.size)), rho, rho_P)
    return rho, rho_P


def test_weak_and_strong_tension():
    """The exponential from next to no tension on."""
    density = ehd.DowsonHigginson()
    law = CompressibleLaw(density, None)
    p = np.array([[-1e-3, -1e5, -1.65e6, -1e8, 0.0, 1e6]])
    rho, rho_P = asked(law.transform(p), 1.0, -np.inf, law)
    np.testing.assert_allclose(rho, density.ratio(p), rtol=2e-15)
    np.testing.assert_allclose(rho_P, density.ratio_slope(p) / density.ratio(p), rtol=1e-10)


class BulkModulus:
    """``rho_0 (1 + p / K)`` for p >= 0, or ``rho_0 exp(p / K)``: laws that the package does not know."""

    def __init__(self, modulus, straight):
        self.coefficient, self.straight = 1.0 / modulus, straight

    def ratio(self, p):
        x = self.coefficient * np.asarray(p)
        return np.where(self.straight & (x >= 0.0), 1.0 + x, np.exp(x))

    def ratio_slope(self, p):
        x = self.coefficient * np.asarray(p)
        return self.coefficient * np.where(self.straight & (x >= 0.0), 1.0, np.exp(x))

    def ratio_bend(self, p):
        return 0.0 * p if self.straight else self.coefficient**2 * self.ratio(p)


LAWS = {"dowson": ehd.DowsonHigginson(), "straight": BulkModulus(2e8, True), "exponential": BulkModulus(2e8, False)}


@pytest.mark.parametrize("viscosity", [None, "barus", "roelands"])
@pytest.mark.parametrize("name", LAWS)
def test_kernels_know_a_law_by_its_methods_alone(name, viscosity):
    """Random pressures from tension to 500 MPa; round-off of the splines' slopes is that of p / dp."""
    density, rng = LAWS[name], np.random.default_rng(3)
    law = CompressibleLaw(density, None if viscosity is None else VISCOSITIES[viscosity])
    p = np.append(-(10.0 ** rng.uniform(0.0, 7.5, 50)), 10.0 ** rng.uniform(0.0, np.log10(5e8), 150)).reshape(20, 10)
    table = law.kernel_table
    of_q = np.array([law_at(q, table) for q in law.transform(p).ravel()])
    ratio, s, _, ratio_q = of_q[:, 1:5].T.reshape(4, *p.shape)
    np.testing.assert_allclose(ratio, density.ratio(p), rtol=1e-12)  # that of q, where the oil is thick
    np.testing.assert_allclose(ratio_q / s, density.ratio_slope(p), rtol=1e-10)
    rho, rho_P = asked(law.transform(p), 1.0, -np.inf, law)
    inside, (_, s, *_) = law.fields(law.transform(p))
    assert inside
    np.testing.assert_allclose(rho, density.ratio(p), rtol=1e-12)  # that of q, where the oil is thick
    np.testing.assert_allclose(rho_P, density.ratio_slope(p) * s, rtol=1e-10)


def test_density_kernel_equals_its_twin():
    density = ehd.DowsonHigginson()
    law = CompressibleLaw(density, VISCOSITIES["barus"])
    p = np.array([[-2e7, -1e5, 0.0, 3e6, 2e8, 5e8]])
    scale, floor = 1e5, -1.0
    P = law.transform(p) / scale
    rho, rho_P = asked(P, scale, floor, law)
    kept = np.maximum(p, float(-np.log1p(1e5 * law.alpha) / law.alpha))
    np.testing.assert_allclose(rho, density.ratio(kept), rtol=1e-12)  # the spline's
    assert rho_P[0, 0] == 0.0
    slope = density.ratio_slope(p) * np.exp(1e-8 * p) / density.ratio(p) * scale
    np.testing.assert_allclose(rho_P[0, 2:], slope[0, 2:], rtol=1e-10)
    beyond = np.full((1, 1), 2.0 * law.q[-1] / scale)
    rho, rho_P = asked(beyond, scale, floor, law)
    assert rho[0, 0] == pytest.approx(float(density.ratio(law.largest_pressure)), rel=1e-6)  # at the range's end
    assert rho_P[0, 0] == 0.0


@pytest.mark.parametrize(
    ("floor", "beyond"), [(1e6, 9e5), (-np.inf, 1e12)], ids=["below the floor", "beyond the range"]
)
def test_cut_pressures_have_a_density(floor, beyond):
    law, P = CompressibleLaw(ehd.DowsonHigginson(), None), np.array([[2e6, beyond]])
    rho, rho_P = asked(P, 1.0, floor, law)
    assert np.all(rho > 1.0) and rho_P[0, 0] > 0.0 and rho_P[0, 1] == 0.0


@pytest.mark.parametrize("name", ["coefficient", "saturation"])
@pytest.mark.parametrize("value", [0.0, -1e-9, np.nan, 0.6])
def test_impossible_coefficients_are_refused(name, value):
    with pytest.raises(ehd.InputError, match=f"DowsonHigginson.{name}"):
        ehd.DowsonHigginson(**{name: value})


def test_law_is_an_object():
    with pytest.raises(ehd.InputError, match=r"Lubricant\.density_law must be DowsonHigginson"):
        ehd.Lubricant(viscosity=0.02, density_law="dowson")
