"""Ocvirk's short bearing against its closed forms: load, attitude, K, C, whirl threshold, pure squeeze.

Half Sommerfeld film; periodic (every column is on its own, so no inlet line exists). The axial parabola is exact on any
grid, and the trapezoidal rule in theta is exact to rounding over a smooth periodic integrand but of second order over a
half film with kinks. Forces need 512 columns. Stiffness and damping are exact for the current set of unbroken columns,
which moves by whole columns: an error of first order, 0.7 % at 512 columns, so that 0.1 % takes 16384 of them (0.1 s).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.reference import short_bearing

SPEED = 100.0
FILM = ehd.ShortBearing(n_theta=512, n_z=6)
FINE_FILM = ehd.ShortBearing(n_theta=16384, n_z=4)
EPS = (0.1, 0.3, 0.5, 0.7, 0.9)


@pytest.fixture(scope="module")
def bearing(make_bearing):
    return make_bearing(0.25, film=FILM, cavitation=ehd.Gumbel())


@pytest.mark.parametrize("eps", EPS)
@pytest.mark.parametrize("direction", (0.0, 0.3))
def test_load_and_attitude(bearing, measured, eps, direction):
    film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=eps, direction=direction)
    # The edge of the film lies between two columns: second order, most at eps 0.9 where the pressure rises steepest.
    measured("So", abs(film.sommerfeld_number / short_bearing.load(eps, 0.25) - 1.0), 3e-4)
    measured("attitude, rad", abs(film.attitude_angle - short_bearing.attitude(eps)), 1e-4)


@pytest.mark.parametrize("eps", EPS)
def test_stiffness_damping_and_whirl(make_bearing, measured, eps):
    bearing = make_bearing(0.25, film=FINE_FILM, cavitation=ehd.Gumbel())
    load = short_bearing.load(eps, 0.25) * bearing.reference_force(SPEED)
    result = ehd.equilibrium(bearing, speed=SPEED, load=(load, 0.0))
    c = bearing.radial_clearance
    K, C = result.stiffness * c / load, result.damping * c * SPEED / load
    exact_K, exact_C = np.array(short_bearing.stiffness(eps)), np.array(short_bearing.damping(eps))
    measured("eps", abs(result.eccentricity_ratio / eps - 1.0), 1e-6)
    # Relative to the largest coefficient, because Kyx changes its sign near eps 0.66.
    measured("K", float(abs(K - exact_K).max() / abs(exact_K).max()), 1e-3)
    measured("C", float(abs(C - exact_C).max() / abs(exact_C).max()), 1e-3)
    ratio, mass = short_bearing.whirl_threshold(eps)
    if math.isfinite(mass):
        measured("whirl ratio", abs(result.whirl_ratio / ratio - 1.0), 1e-3)
        measured("critical mass", abs(result.critical_mass * c * SPEED**2 / load / mass - 1.0), 2e-3)
    else:
        assert math.isinf(result.critical_mass)
        assert math.isnan(result.whirl_ratio)


def test_table_of_coefficients(table):
    # Printed to six digits.
    for row in table("short_bearing_ocvirk_coefficients_stability"):
        eps = row["eps"]
        (kxx, kxy), (kyx, kyy) = short_bearing.stiffness(eps)
        (cxx, cxy), (cyx, cyy) = short_bearing.damping(eps)
        ours = (
            short_bearing.load(eps, 1.0),
            math.degrees(short_bearing.attitude(eps)),
            kxx,
            kxy,
            kyx,
            kyy,
            cxx,
            cxy,
            cyx,
            cyy,
        )
        names = ("So*(D/L)^2", "phi_deg", "Kxx(load)", "Kxy", "Kyx", "Kyy", "Bxx", "Bxy", "Byx", "Byy")
        for value, name in zip(ours, names, strict=True):
            assert value == pytest.approx(row[name], rel=1e-5, abs=1e-6)
        ratio, mass = short_bearing.whirl_threshold(eps)
        assert ratio == pytest.approx(row["whirl_ratio"], rel=1e-5)
        assert mass == pytest.approx(row["Mcrit=m*c*om^2/W"], rel=2e-5)


@pytest.mark.parametrize("eps", (-0.9, -0.5, 0.0, 0.5, 0.9))
@pytest.mark.parametrize("cavitated", (True, False))
def test_pure_squeeze(make_bearing, measured, eps, cavitated):
    bearing = make_bearing(0.25, film=FILM, cavitation=ehd.Gumbel() if cavitated else ehd.FullSommerfeld())
    R, L, c, rate = bearing.journal_radius, bearing.length, bearing.radial_clearance, 10.0
    v = math.copysign(rate, eps) * c
    film = ehd.steady(bearing, speed=0.0, eccentricity_ratio=abs(eps), velocity=(v, 0.0))
    force = -math.copysign(1.0, eps) * film.force[0] * c**2 / (0.02 * R * L**3 * rate)
    measured("force", abs(force / short_bearing.squeeze_force(eps, cavitated=cavitated) - 1.0), 1e-4)


def test_swift_stieber_equals_gumbel(make_bearing):
    """Without pressure flow in theta every column is on its own: one sign of
    pressure per column, so both closures agree."""
    results = [
        ehd.steady(
            make_bearing(0.25, film=FILM, cavitation=k), speed=SPEED, eccentricity_ratio=0.7, velocity=(1e-3, 2e-3)
        )
        for k in (ehd.Gumbel(line_in_cells=True), ehd.SwiftStieber())
    ]
    np.testing.assert_allclose(results[0].force, results[1].force, rtol=1e-12)
