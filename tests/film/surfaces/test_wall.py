"""The regularised wall: twins, derivatives, limits, and validation."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd import InputError, RegularisedWall
from exudyn_ehd.film.surfaces.contact import WallContact

ONSET, PRESSURE, RESIDUAL = 0.1, 3e6, 0.2
WALL = WallContact(RegularisedWall(onset=1e-6, pressure=PRESSURE, residual=RESIDUAL), 1e-5)


def _pressure(h):
    s = np.minimum(h / ONSET, 1.0)
    return PRESSURE * (1.0 - s) ** 2


def _limited(h):
    a = 1.0 - RESIDUAL
    return np.where(h < ONSET, ONSET * (1.0 - a * np.tanh((1.0 - h / ONSET) / a)), h)


def test_twins_and_derivatives():
    H = np.linspace(-0.5, 0.5, 40).reshape(8, 5)
    P, slope = np.empty_like(H), np.empty_like(H)
    WALL.pressure(H, P, slope)
    np.testing.assert_allclose(P, _pressure(H), rtol=1e-13)
    d = 1e-6  # central differences: truncation and rounding both near 1e-9
    np.testing.assert_allclose(slope, (_pressure(H + d) - _pressure(H - d)) / (2 * d), atol=1e-6 * PRESSURE)
    seen, link, rate, s1, s2, s_link = H.copy(), H[::-1].copy(), np.full(H.shape, 3.0), *np.empty((3, *H.shape))
    WALL.limit(seen, link, rate, s1, s2, s_link)
    np.testing.assert_array_equal(link[::-1], seen)
    np.testing.assert_array_equal(s_link[::-1], s1)
    np.testing.assert_allclose(rate, 3.0 * s1, rtol=1e-15)
    s2 /= 3.0
    np.testing.assert_allclose(seen, _limited(H), rtol=1e-13)
    np.testing.assert_allclose(s1, (_limited(H + d) - _limited(H - d)) / (2 * d), atol=1e-8)
    d = 1e-4
    np.testing.assert_allclose(s2, (_limited(H + d) - 2 * _limited(H) + _limited(H - d)) / d**2, atol=1e-3)


def test_limits_and_smoothness():
    H = np.array([[ONSET, ONSET * (1 + 1e-12), ONSET * (1 - 1e-9), -50.0]])
    P, slope, s1, s2 = (np.empty_like(H) for _ in range(4))
    WALL.pressure(H, P, slope)
    assert P[0, 0] == P[0, 1] == 0.0
    assert abs(slope[0, 2]) < 1e-6 * PRESSURE
    seen = H.copy()
    WALL.limit(seen, H.copy(), np.ones_like(H), s1, s2, np.empty_like(H))
    assert seen[0, 1] == H[0, 1]  # not a bit changes above the onset
    assert s1[0, 2] == pytest.approx(1.0, abs=1e-12)
    assert s2[0, 2] == pytest.approx(0.0, abs=1e-6)
    assert seen[0, 3] == pytest.approx(RESIDUAL * ONSET)


@pytest.mark.parametrize(
    "options",
    [
        {"onset": 0.0},
        {"onset": -1e-6},
        {"onset": 1e-6, "pressure": 0.0},
        {"onset": 1e-6, "residual": 0.001},
        {"onset": 1e-6, "residual": 0.95},
        {"onset": float("nan")},
        {"onset": "small"},
    ],
)
def test_validation(options):
    with pytest.raises(InputError, match="RegularisedWall"):
        RegularisedWall(**options)
