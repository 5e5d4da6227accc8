"""Forces that alternate from step to step are told from whatever a film does by itself."""

import numpy as np
import pytest

from exudyn_ehd.joint.audit.resolution import LIMIT, watched

AREA = 8e-4


def bursts(y, t=None, x=0.0):
    y = np.asarray(y, dtype=float)
    t = np.arange(y.size) * 1e-4 if t is None else t
    return watched(t, np.column_stack((np.broadcast_to(x, y.shape), y, np.zeros_like(y))), AREA).most


K = np.arange(300)
SIGN = (-1.0) ** K


@pytest.mark.parametrize("size", [0.06, 0.5, 5.0])
def test_alternation_that_lasts(size):
    assert bursts(1000.0 * (1.0 + size * SIGN)) >= LIMIT


def test_size_below_a_twentieth_is_none():
    # d is twice the alternation, so that a tenth is reached at a twentieth
    assert bursts(1000.0 * (1.0 + 0.045 * SIGN)) == 0


@pytest.mark.parametrize("rate", [0.5, 0.8, 0.95])
def test_alternation_that_fades_is_one_burst(rate):
    y = 1000.0 * (1.0 + np.where(K > 50, SIGN * rate ** (K - 50.0), 0.0))
    assert 1 <= bursts(y) <= 2


@pytest.mark.parametrize("rate", [0.5, 0.8])
def test_alternation_that_is_thrown_anew_rings(rate):
    assert bursts(1000.0 * (1.0 + SIGN * rate ** (K % 20))) >= LIMIT


def test_uneven_steps_are_no_alternation():
    h = np.where(K % 2, 1e-4, 4e-5)
    t = np.cumsum(h)
    assert bursts(1e6 * t**2 + 100.0, t) == 0
    assert bursts(1000.0 * np.sin(400.0 * t), t) == 0


@pytest.mark.parametrize("steps", [4, 5, 8, 30, 200])
def test_resolved_oscillations_are_quiet(steps):
    angle = 2.0 * np.pi * K / steps
    assert bursts(1000.0 * np.sin(angle)) == 0
    assert bursts(1000.0 * np.sin(angle), x=1000.0 * np.cos(angle)) == 0


def test_impacts_over_some_steps_are_quiet_and_within_one_ring():
    phase = K % 15
    assert bursts(10.0 + 1000.0 * np.exp(-(((phase - 7.0) / 2.0) ** 2))) == 0
    assert bursts(10.0 + 1000.0 * (phase == 7)) >= LIMIT


def test_a_jump_is_no_alternation():
    assert bursts(np.where(K > 100, 1000.0, 10.0)) == 0
    assert bursts(np.where((K // 30) % 2, 1000.0, -1000.0)) == 0


def test_rounding_beside_nothing_is_quiet():
    assert bursts(1e-6 * SIGN) == 0
    assert bursts(1000.0 * np.cos(2.0 * np.pi * K / 100) + 1.0 * SIGN) == 0


def test_a_time_that_steps_back_begins_anew():
    y = 1000.0 * (1.0 + 0.5 * SIGN)
    t = np.concatenate((K[:290] * 1e-4, K[:10] * 1e-4))
    assert bursts(y[:290]) >= LIMIT and bursts(y, t) <= 1


def test_balls_ring_in_any_direction():
    """Forces turned into any direction ring as those along y."""
    rng, y = np.random.default_rng(3), 1000.0 * (1.0 + 0.5 * SIGN)
    t = 1e-4 * K
    for _ in range(5):
        way = rng.normal(size=3)
        force = np.outer(y, way / np.linalg.norm(way))
        assert watched(t, force, AREA).most == bursts(y)
