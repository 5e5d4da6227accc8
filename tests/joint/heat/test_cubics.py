"""Film with a viscosity that varies over its height: flows, stresses and heat against the velocity's own integrals."""

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, simpson

from exudyn_ehd.joint.heat.across import (
    LOBATTO,
    at_heights,
    at_points,
    flow_factors,
    flow_shapes,
    heat_tilts,
    surfaces,
    weighed,
)

ZETA = np.linspace(0.0, 1.0, 2001)
HEIGHTS = 0.5 * (1.0 + np.polynomial.legendre.leggauss(5)[0])


def profiles(seed):
    """Fluidities at the points and over the height, velocities of sliding by 1 and of a pressure gradient of -1."""
    points = np.random.default_rng(seed).uniform(0.5, 2.0, 4)
    fluid = np.polyval(np.polyfit(LOBATTO, points, 3), ZETA)
    F0, F1 = (cumulative_simpson(fluid * ZETA**r, x=ZETA, initial=0.0) for r in (0, 1))
    return points[None, None], fluid, F0 / F0[-1], F1[-1] / F0[-1] * F0 - F1


@pytest.mark.parametrize("seed", range(3))
def test_flows_stress_and_heat_are_those_of_the_velocity(seed):
    points, fluid, slides, pressed = profiles(seed)
    conductance, carrier, shear = (float(f[0, 0]) for f in flow_factors(points))
    assert conductance == pytest.approx(12.0 * simpson(pressed, x=ZETA), rel=1e-9)
    assert carrier == pytest.approx(2.0 * simpson(slides, x=ZETA), rel=1e-9)
    assert shear == pytest.approx(1.0 / simpson(fluid, x=ZETA), rel=1e-9)
    for shape, below, velocity in zip(flow_shapes(points)[:2], flow_shapes(points)[2:], (slides, pressed), strict=True):
        velocity = velocity / simpson(velocity, x=ZETA)
        np.testing.assert_allclose(shape[0, 0], np.interp(HEIGHTS, ZETA, velocity), atol=1e-6)
        flow = cumulative_simpson(velocity, x=ZETA, initial=0.0)
        np.testing.assert_allclose(below[0, 0], np.interp(HEIGHTS, ZETA, flow), atol=1e-6)
    # stress times slope of the velocity: of sliding, of the pressure gradient, and of both together
    stresses = 1.0 / simpson(fluid, x=ZETA), -(ZETA - simpson(fluid * ZETA, x=ZETA) / simpson(fluid, x=ZETA))
    own, driven, both = heat_tilts(points)
    for found, stress in zip((own, driven), stresses, strict=True):
        heat = stress**2 * fluid
        assert found[0, 0] == pytest.approx(simpson((2 * ZETA - 1) * heat, x=ZETA) / simpson(heat, x=ZETA), abs=1e-8)
    crossed = simpson((2 * ZETA - 1) * -stresses[0] * stresses[1] * fluid, x=ZETA)
    assert both[0, 0] == pytest.approx(crossed, abs=1e-8)


def test_equal_temperatures_are_the_plain_film():
    fluid = np.full((2, 3, 4), 0.7)
    np.testing.assert_allclose(flow_factors(fluid)[:2], [np.full((2, 3), 0.7), np.ones((2, 3))], rtol=1e-14)
    np.testing.assert_allclose(flow_factors(fluid)[2], 1.0 / 0.7, rtol=1e-14)


@pytest.mark.parametrize("outward", [(None, None), (400.0, None), (None, 3e3), (600.0, 2e3)], ids=str)
def test_conduction_of_a_heated_film(outward):
    """An even heating q between outer temperatures has T'' = -q / k, which the cubic holds exactly."""
    k, h, heat, outside, area = 0.13, 5e-5, 4e8, (320.0, 335.0), 2e-6
    far = [1e30 if U is None else U for U in outward]
    # k T' = U_b (T - w_b) at y = 0 and -k T' = U_j (T - w_j) at y = h, with T = c_0 + c_1 y - q y^2 / (2 k)
    matrix = [[-1.0, k / far[0]], [1.0, h + k / far[1]]]
    c = np.linalg.solve(matrix, [-outside[0], outside[1] + heat * h / far[1] + 0.5 * heat * h**2 / k])

    def exact(zeta):
        return c[0] + c[1] * h * zeta - 0.5 * heat * (h * zeta) ** 2 / k

    mean = simpson(exact(ZETA), x=ZETA)
    tilt = 3.0 * simpson((2.0 * ZETA - 1.0) * exact(ZETA), x=ZETA)
    T, passed, lost = surfaces(np.full((1, 1), k / h), np.full((1, 1), area), outward)
    fields = np.array([mean, tilt, *outside])
    np.testing.assert_allclose(T[:, 0, 0] @ fields, exact(np.array([0.0, 1.0])), rtol=1e-9)
    np.testing.assert_allclose(passed[:, 0, 0] @ fields, area * k * np.array([c[1], heat * h / k - c[1]]), rtol=1e-7)
    np.testing.assert_allclose(lost[:, 0, 0] @ fields, [heat * h * area, 0.0], atol=1e-7 * heat * h * area)
    state = np.array([mean, tilt, *(T[:, 0, 0] @ fields)])
    np.testing.assert_allclose(at_points(state[:, None, None])[0, 0], exact(LOBATTO), rtol=1e-9)
    at = at_heights(T)
    np.testing.assert_allclose(at[0, 0] @ fields, exact(HEIGHTS), rtol=1e-9)
    np.testing.assert_allclose(weighed(np.ones((1, 1, 5)), at)[:, 0, 0] @ fields, [mean, tilt / 3.0], rtol=1e-7)
