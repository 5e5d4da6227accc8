"""The long bearing against closed forms, quadrature and differences."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

GROOVE = (ehd.AxialGroove(angle=0.7, width_angle=0.2, pressure=1e5),)
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]


def _steady(make_bearing, eps, cavitation, n_theta=192, **options):
    bearing = make_bearing(
        film=ehd.LongBearing(n_theta=n_theta), cavitation=cavitation, inlet=ehd.MaximumGap(), **options
    )
    return ehd.steady(bearing, speed=100.0, eccentricity_ratio=eps)


@pytest.mark.parametrize("eps", [0.1, 0.5, 0.8, 0.95])
def test_sommerfeld(make_bearing, measured, eps):
    """So = 6 pi eps / ((2 + eps^2) sqrt(1 - eps^2)), attitude 90 degrees (Sommerfeld 1904)."""
    film = _steady(make_bearing, eps, ehd.FullSommerfeld())
    exact = 6.0 * math.pi * eps / ((2.0 + eps**2) * math.sqrt(1.0 - eps**2))
    # Second order in theta: 4.5e-5 at 192 columns.
    measured("So", abs(film.sommerfeld_number / exact - 1.0), 1e-4)
    assert film.attitude_angle == pytest.approx(math.pi / 2.0, abs=1e-9)
    assert film.leakage == 0.0


@pytest.mark.parametrize("eps", [0.1, 0.5, 0.8, 0.95])
def test_half_sommerfeld(make_bearing, measured, eps):
    """So = 3 eps sqrt(pi^2 - eps^2 (pi^2 - 4)) / ((2 + eps^2)(1 - eps^2)), tan phi = pi sqrt(1 - eps^2) / (2 eps)."""
    film = _steady(make_bearing, eps, ehd.Gumbel())
    # The clipped part starts between two vertices; the thin film at 0.95 sees more of it.
    exact = 3.0 * eps * math.sqrt(math.pi**2 - eps**2 * (math.pi**2 - 4.0)) / ((2.0 + eps**2) * (1.0 - eps**2))
    measured("So", abs(film.sommerfeld_number / exact - 1.0), 1e-3 if eps > 0.9 else 1e-4)
    phi = math.atan(math.pi * math.sqrt(1.0 - eps**2) / (2.0 * eps))
    measured("phi", abs(film.attitude_angle - phi), 1e-3)


def test_second_order(make_bearing):
    exact = 6.0 * math.pi * 0.6 / ((2.0 + 0.36) * 0.8)
    errors = [abs(_steady(make_bearing, 0.6, ehd.FullSommerfeld(), n).sommerfeld_number - exact) for n in (32, 64, 128)]
    assert 1.9 < math.log2(errors[0] / errors[1]) < 2.1
    assert 1.9 < math.log2(errors[1] / errors[2]) < 2.1


def test_mass_conserving_film_equals_swift_stieber_before_the_inlet(make_bearing, measured):
    """Both closures agree: the inlet at the maximum gap is flooded, and the cavity reaches to it."""
    loads = [
        _steady(make_bearing, 0.6, c).sommerfeld_number
        for c in (ehd.ElrodAdams(), ehd.SwiftStieber(line_in_cells=False))
    ]
    # The same set and the same pressures.
    measured("So", abs(loads[0] / loads[1] - 1.0), 1e-12)


def test_tilted_slices_are_integrated_exactly(make_bearing):
    """Loads of a tilted journal do not change with the number of slices."""
    wrenches = []
    for n_z in (4, 9):
        bearing = make_bearing(
            film=ehd.LongBearing(n_theta=64, n_z=n_z), cavitation=ehd.FullSommerfeld(), inlet=ehd.MaximumGap()
        )
        film = ehd.steady(bearing, speed=100.0, eccentricity_ratio=0.3, tilt=(1e-4, 5e-5))
        wrenches.append(np.array([*film.force[:2], *film.moment[:2] / 0.025]))
    # Four Gauss points integrate polynomials of degree seven; the load is analytic in z with its pole far away.
    np.testing.assert_allclose(wrenches[0], wrenches[1], atol=1e-5 * np.abs(wrenches[1]).max())


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_tangent_against_differences(make_bearing, closure):
    model = build_model(make_bearing(film=ehd.LongBearing(n_theta=48, n_z=3), cavitation=closure, supply=GROOVE))
    motion = np.array([8e-6, -12e-6, 1e-4, -2e-4, 2e-4, 1e-3, 5e-3, -8e-3, 150.0, 0.02])
    history = model.initial_history(0.9 * motion)
    evaluation = model.evaluate(motion, history, 1e-3)
    tangent, active = evaluation.tangent(), model.solver.work.active.copy()
    scale = np.array([1e-6, 1e-6, 1e-4, 1e-4, 1e-3, 1e-3, 1e-2, 1e-2, 10.0, 0.1])
    for k in range(10):
        step = np.zeros(10)
        step[k] = 1e-4 * scale[k]
        wrenches = []
        for sign in (1.0, -1.0):
            wrenches.append(model.evaluate(motion + sign * step, history, 1e-3).wrench)
            np.testing.assert_array_equal(model.solver.work.active, active)
        numeric = (wrenches[0] - wrenches[1]) / (2e-4 * scale[k])
        size = np.array([1.0] * 3 + [0.025] * 3) * np.linalg.norm(evaluation.wrench[:3]) / scale[k]
        # Differences of second order: 1e-8 of the curvature, rounding 1e-12 / 1e-4.
        assert np.all(np.abs(numeric - tangent[:, k]) < 1e-6 * size), k


@pytest.mark.parametrize(
    "options, message",
    [
        ({}, "needs a line of prescribed pressure"),
        ({"supply": (ehd.Hole(angle=0.0, diameter=0.02),)}, "axial grooves over the whole length"),
        ({"inlet": ehd.MaximumGap(), "end_pressures": (1e5, 0.0)}, r"must be \(0, 0\)"),
    ],
)
def test_refused(make_bearing, options, message):
    with pytest.raises(ehd.InputError, match=message):
        make_bearing(film=ehd.LongBearing(), **options)
