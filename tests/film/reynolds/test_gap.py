"""Gap of a tilted journal and its chain rule."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.reynolds.gap import (
    add_gap,
    largest_eccentricity,
    rigid_gap,
    rigid_gaps,
)


def _gap(pose, theta, z, base):
    """Readable twin: distance of the bore from the journal's surface along the fixed normal, scaled by c."""
    axis = np.array([pose[0] + pose[2] * z, pose[1] + pose[3] * z])
    normal = np.array([np.cos(theta), np.sin(theta)])
    return base - (axis[:, None, :] * normal[:, :, None]).sum(axis=0)


@pytest.mark.parametrize("base", (0.0, 1.0))
def test_rigid_gap(base):
    rng = np.random.default_rng(1)
    theta, z, pose = rng.uniform(0, 6, 9), np.linspace(-1, 1, 5), rng.normal(size=4)
    out = np.empty((9, 5))
    rigid_gap(pose, np.cos(theta), np.sin(theta), z, base, out)
    np.testing.assert_allclose(out, _gap(pose, theta, z, base), rtol=1e-13, atol=1e-14)


@pytest.mark.parametrize("squeeze", [True, False])
def test_rigid_gaps(squeeze):
    rng = np.random.default_rng(3)
    theta, between, z = rng.uniform(0, 6, 9), rng.uniform(0, 6, 9), np.linspace(-1, 1, 5)
    (pose, rate), out = rng.normal(size=(2, 4)), np.zeros((3, 9, 5))
    at = np.cos(theta), np.sin(theta), np.cos(between), np.sin(between), z
    smallest = rigid_gaps(pose, rate, squeeze, at, 0.7, True, *out)
    on_arc = rigid_gaps(pose, rate, squeeze, at, 0.7, False, *out)
    assert on_arc == min(out[0].min(), out[1].min())
    assert smallest == 1.0 - largest_eccentricity(pose, 0.7)
    expected = _gap(pose, theta, z, 1.0), _gap(pose, between, z, 1.0), squeeze * _gap(rate, theta, z, 0.0)
    np.testing.assert_allclose(out, expected, rtol=1e-13, atol=1e-14)


def test_largest_eccentricity_is_one_minus_the_smallest_gap():
    rng = np.random.default_rng(2)
    theta, z = np.linspace(0, 2 * np.pi, 20001), np.linspace(-0.7, 0.7, 41)
    for pose in rng.uniform(-0.5, 0.5, (20, 4)):
        # 20000 angles miss the minimum by at most (pi / 20000)^2 / 2 = 1e-8.
        assert largest_eccentricity(pose, 0.7) == pytest.approx(1.0 - _gap(pose, theta, z, 1.0).min(), abs=2e-8)


@pytest.mark.parametrize("where", ["vertex", "link"])
def test_add_gap_finds_the_smallest(where):
    rng = np.random.default_rng(4)
    H, HF, H_t, extra, rate = rng.uniform(0.5, 1.0, (5, 6, 5))
    (H if where == "vertex" else HF)[5, 4] = -1.5
    expected = H + extra, HF + 0.5 * (extra + np.roll(extra, -1, axis=0)), H_t + rate
    smallest, _ = add_gap(extra, rate, bearing_grid(1.0, 2.0, 6, 4), H, HF, H_t)
    assert smallest == min(expected[0].min(), expected[1].min()) < 0.0
    np.testing.assert_allclose((H, HF, H_t), expected, rtol=1e-15)
