"""Carreau's law: formula, limits, the profile across the film, and long bearings against the exact flow."""

import itertools

import numpy as np
import pytest
from scipy.optimize import brentq, root

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.shear_profile import EXACT, fluidity_table, gauss_points, profile
from exudyn_ehd.joint.model.build import build_study_model

LAW = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)
R, L, C, MU = 0.025, 0.05, 25e-6, 0.02


def test_limits():
    assert LAW.ratio(0.0) == 1.0
    assert LAW.ratio(1e30) == pytest.approx(0.2, abs=1e-9)  # (1e24)^-0.4 is left
    steep = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)
    assert steep.ratio(2e12) / steep.ratio(1e12) == pytest.approx(2.0**-0.4, rel=1e-10)  # power law n - 1
    assert ehd.CarreauShear(relaxation_time=1e-6, exponent=1.0).ratio(1e7) == 1.0


def _rates(law, count=6001):
    """Scaled shear rates and their stresses, from which the exact flow is interpolated."""
    x = np.append(0.0, np.geomspace(1e-4, 1e20, count))
    return x, x * law.ratio(x / law.relaxation_time)


@pytest.mark.parametrize("n, residual", [(0.05, 0.0), (0.4, 0.0), (0.6, 0.2), (0.9, 0.5), (1.0, 0.0), (0.5, 1.0)])
def test_table_of_the_fluidity(n, residual):
    """Cubics over the square of the stress: the law from its definition."""
    law = ehd.CarreauShear(relaxation_time=1.0, exponent=n, residual=residual)
    oil = fluidity_table(law)
    for x in np.geomspace(1e-3, 1e7, 60):
        stress = x * law.ratio(x)
        # a profile without pressure flow is the law
        found = profile(x, 0.0, 0.0, oil, gauss_points(6), 0.0, 0.0, EXACT)[0]
        assert found.T_x == pytest.approx(stress, rel=2e-5 if n < 0.1 else 1e-7)


@pytest.mark.parametrize("n, residual", [(0.4, 0.0), (0.6, 0.2), (0.8, 0.5)])
def test_profile_against_quadrature(n, residual):
    """Both conditions in the plane of the film with 400 points; derivatives against central differences."""
    law = ehd.CarreauShear(relaxation_time=1.0, exponent=n, residual=residual)
    oil, x, w = fluidity_table(law), *np.polynomial.legendre.leggauss(400)
    rate, stress = _rates(law)
    rng = np.random.default_rng(5)

    def flow(T, G):
        t = np.array(T)[:, None] + 0.5 * x * np.array(G)[:, None]
        size = np.hypot(*t)
        return t * np.interp(size, stress, rate) / size

    for S, G_x, G_z in rng.normal(size=(6, 3)) * [5.0, 10.0, 10.0]:
        exact = root(lambda T, S=S, G=(G_x, G_z): flow(T, G) @ (0.5 * w) - [S, 0.0], [S * law.ratio(S), 0.0])
        assert exact.success
        F = flow(exact.x, (G_x, G_z)) @ (0.25 * w * x)
        found = profile(S, G_x, G_z, oil, gauss_points(12), 0.0, 0.0, EXACT)[0]
        np.testing.assert_allclose([found.F_x, found.F_z], F, rtol=3e-3)
        np.testing.assert_allclose([found.T_x, found.T_z], exact.x, atol=3e-3 * np.hypot(G_x, G_z))
        for points in (6, 12):
            p = profile(S, G_x, G_z, oil, gauss_points(points), 0.0, 0.0, EXACT)[0]
            rows = []
            for change in np.eye(3) * 1e-5:
                ends = [
                    profile(*(np.array([S, G_x, G_z]) + s * change), oil, gauss_points(points), p.T_x, p.T_z, EXACT)[0]
                    for s in (-1.0, 1.0)
                ]
                rows.append([(b - a) / 2e-5 for a, b in zip(*ends, strict=True)])
            by_s, by_x, by_z = rows
            expected = (by_s[0], by_x[0], by_z[0], by_s[2], by_s[3], by_x[2], by_z[2], by_z[3])
            np.testing.assert_allclose(p[4:], expected, rtol=1e-5, atol=1e-7)
            assert by_x[3] == pytest.approx(by_z[2], rel=1e-5, abs=1e-7)  # the flow has a potential


def test_a_squeeze_alone_knows_no_direction():
    """Without sliding the flow is along the gradient, and as large in every direction, to the table's accuracy."""
    law = ehd.CarreauShear(relaxation_time=1.0, exponent=0.5, residual=0.1)
    oil, points = fluidity_table(law), gauss_points(6)
    sizes = []
    for angle in np.linspace(0.0, np.pi, 7):
        G = 30.0 * np.array([np.cos(angle), np.sin(angle)])
        p = profile(0.0, *G, oil, points, 1.0, -1.0, EXACT)[0]
        assert abs(p.T_x) + abs(p.T_z) < 1e-9
        np.testing.assert_allclose([p.F_x * G[1], 0.0], [p.F_z * G[0], 0.0], atol=1e-9)
        sizes.append(np.hypot(p.F_x, p.F_z))
    np.testing.assert_allclose(sizes, sizes[0], rtol=1e-12)


def _newton(low, high, of, steps=60):
    """Roots between two bounds by Newton's steps, bisection where they leave them; ``of``: values (rising), slopes."""
    x = 0.5 * (low + high)
    for _ in range(steps):
        value, slope = of(x)
        low, high = np.where(value < 0.0, x, low), np.where(value < 0.0, high, x)
        step, last = x - value / slope, x
        x = np.where((step >= low) & (step <= high), step, 0.5 * (low + high))
        if np.all(np.abs(x - last) <= 1e-8 * np.abs(x)):
            break
    return x


class LongFilm:
    """Infinitely long bearing with the exact flow across the film, root by root at every angle; no code of the package.

    The gap is ``c (1 + eps cos(theta))``, the journal's surface moves with U towards growing theta.
    """

    def __init__(self, law, eps, U, closing=0.0, count=181, heights=24, mu=MU):
        self.theta = np.linspace(0.0, 2.0 * np.pi, count)
        self.h = C * (1.0 + eps * np.cos(self.theta))
        self.U, self.closing, self.mu, self.law = U, closing, mu, law
        zeta, w = np.polynomial.legendre.leggauss(heights)
        # both halves on their own: the law has a bend where the stress is nothing
        self.zeta, self.w = np.append(0.25 * (zeta - 1.0), 0.25 * (zeta + 1.0)), 0.25 * np.append(w, w)
        self.rates, self.stresses = _rates(law)
        self.steeps = np.gradient(self.rates, self.stresses)

    def moments(self, mean, slope):
        """Integrals over the gap of the shear rate and of its derivative to the stress, times 1, zeta, zeta^2."""
        stress = mean[:, None] + self.zeta * self.h[:, None] * slope[:, None]
        t, k = np.abs(stress) * self.law.relaxation_time / self.mu, self.law.relaxation_time
        rate = np.sign(stress) * np.interp(t, self.stresses, self.rates) / k
        steep = np.interp(t, self.stresses, self.steeps) / self.mu
        weights = np.stack([self.w, self.w * self.zeta, self.w * self.zeta**2], axis=1)
        return (rate @ weights).T, (steep @ weights).T

    def flow(self, slope):
        """Mean stress, pressure flow (m2/s) and its derivative, under a pressure gradient at every angle."""
        bound = np.abs(slope) * self.h + self.mu * abs(self.U) / self.h + 1e-300

        def excess(mean):
            rate, steep = self.moments(mean, slope)
            return rate[0] * self.h - self.U, steep[0] * self.h

        mean = _newton(-bound, bound, excess)
        rate, (whole, first, second) = self.moments(mean, slope)
        return mean, -(self.h**2) * rate[1], -(self.h**3) * (second - first**2 / whole)

    def slope(self, flow):
        """Pressure gradients that make a pressure flow (m2/s) at every angle; those of thick oil bound them."""

        def excess(slope):
            _, found, by = self.flow(slope)
            return flow - found, -by

        bound = 12.0 * self.mu * np.abs(flow) / self.h**3 + 1e-3
        return _newton(-bound, bound, excess)

    def pressure(self, flow):
        """Pressure of a total flow at theta = 0, with what the closing bore drives out of the gap behind it."""
        # dh/dt = closing cos(theta): the journal moves towards theta = pi
        driven = flow - R * self.closing * np.sin(self.theta) - 0.5 * self.U * self.h
        slopes = self.slope(driven)
        step = np.diff(self.theta) * R
        return np.append(0.0, np.cumsum(0.5 * (slopes[1:] + slopes[:-1]) * step)), slopes

    def full(self):
        """Pressure, gradient of the full film: the flow that brings the pressure back to nothing."""
        reach = 0.5 * abs(self.U) * self.h.max()
        flow = 0.0 if self.U == 0.0 else brentq(lambda q: self.pressure(q)[0][-1], -reach, reach, rtol=1e-5)
        return self.pressure(flow)

    def force(self, P):
        """Force per length on the journal, along theta = 0 and across."""
        rows = [P * f(self.theta) for f in (np.cos, np.sin)]
        return -R * np.array([np.trapezoid(row, self.theta) for row in rows])


def _long(law, eps, U, closing=0.0, n_theta=192):
    oil = ehd.Lubricant(viscosity=MU, shear_law=law)
    b = ehd.JournalBearing(
        journal_radius=R, length=L, radial_clearance=C, lubricant=oil, film=ehd.LongBearing(n_theta=n_theta, n_z=2),
        inlet=ehd.MaximumGap(), cavitation=ehd.FullSommerfeld(),
    )  # fmt: skip
    # the gap is largest at theta = 0, so that the journal lies at theta = pi
    model = build_study_model(b, 0.0)
    out = model.evaluate(np.array([-eps * C, 0.0, 0.0, 0.0, -closing, 0.0, 0.0, 0.0, U / R, 0.0]))
    assert out.status is ehd.Status.CONVERGED
    return out


CASES = [
    # lambda |U| / c (of the closing speed R / c in a squeeze), exponent, residual, eccentricity ratio, direction
    (4.0, 0.5, 0.0, 0.8, 1.0),
    (30.0, 0.4, 0.1, 0.5, -1.0),
    (100.0, 0.6, 0.2, 0.6, 0.0),
]
RANGE = [
    (We, *law, eps, direction)
    for k, (We, law, eps) in enumerate(
        itertools.product((0.01, 3.0, 100.0, 1e4), ((0.4, 0.0), (0.6, 0.2), (0.8, 0.5)), (0.1, 0.6, 0.95))
    )
    for direction in ((1.0, -1.0, 0.0)[(k + k // 3) % 3],)
]


def _compare(We, n, residual, eps, direction, count, heights):
    U = 10.0 * direction
    closing = 10.0 * C / R if direction == 0.0 else 0.0
    law = ehd.CarreauShear(relaxation_time=We * C / 10.0, exponent=n, residual=residual)
    exact = LongFilm(law, eps, U, closing, count, heights)
    P, slopes = exact.full()
    out = _long(law, eps, U, closing)
    force = exact.force(P) * L
    np.testing.assert_allclose(out.wrench[:2], force, atol=3e-3 * np.hypot(*force))
    if direction != 0.0:
        mean = exact.flow(slopes)[0]
        # the pressure's part is its moment about the journal's centre
        torque = -np.trapezoid(mean - 0.5 * slopes * exact.h * -1.0, exact.theta) * R * R * L
        friction = out.quantities()["friction_torque"]
        assert friction == pytest.approx(torque, rel=5e-3)


@pytest.mark.parametrize("case", CASES)
def test_long_bearing_is_exact(case):
    """Load within 0.3 % of the exact flow, friction within 0.5 %: turning both ways, and squeezed."""
    _compare(*case, count=61, heights=12)


@pytest.mark.slow
@pytest.mark.parametrize("case", RANGE)
def test_long_bearing_is_exact_over_the_range(case):
    """Rates from hardly thinning to a power law, thin and thick films, as `test_long_bearing_is_exact`."""
    _compare(*case, count=181, heights=24)


def test_couette_shear_of_a_bearing_is_the_law():
    """Concentric film: friction torque = Petroff's with the viscosity at the rate R omega / c."""
    torque = []
    for law in (None, LAW):
        oil = ehd.Lubricant(viscosity=0.02, shear_law=law)
        b = ehd.JournalBearing(journal_radius=0.025, length=0.05, radial_clearance=25e-6, lubricant=oil)
        torque.append(ehd.steady(b, speed=500.0, eccentricity_ratio=0.0).friction_torque)
    assert torque[1] / torque[0] == pytest.approx(LAW.ratio(0.025 * 500.0 / 25e-6), rel=1e-9)  # the table


def test_input_errors():
    with pytest.raises(ehd.InputError, match=r"CarreauShear\.relaxation_time"):
        ehd.CarreauShear(relaxation_time=0.0, exponent=0.5)
    with pytest.raises(ehd.InputError, match="must be between 0 and 1"):
        ehd.CarreauShear(relaxation_time=1e-6, exponent=1.5)
    grid = ehd.slider_grid(0.1, 0.1, 10, 4)
    with pytest.raises(ehd.InputError, match="shear_law must be None"):
        ehd.solve_film(grid, np.full(grid.shape, 1e-5), lubricant=ehd.Lubricant(viscosity=0.02, shear_law=LAW))
