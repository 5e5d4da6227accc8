"""Arrays that kernels hand on without their counters."""

import sys

import numpy as np
import pytest
from numba import njit

from exudyn_ehd.film.banded.lending import lend


@njit
def _flat_sum(parts):
    (a, b), (c, factor), nothing = parts
    total = 0.0
    for field in (a.reshape(-1), b.reshape(-1), c):
        for value in field:
            total += value
    return factor * total if nothing is None else np.nan


@njit
def _through(parts):
    return _flat_sum(lend(parts))


@njit
def _write(a, value):
    lent = lend(a)
    lent[1:, 0] = value
    return lent.size


@njit
def _made_here(n):
    own = np.arange(n) * 1.0
    total = 0.0
    for _ in range(3):
        total += lend(own).sum()
    return total + own[-1]


def test_lent_arrays_are_the_same_ones():
    a, b, c = np.arange(12.0).reshape(4, 3), np.ones((2, 2)), np.arange(5.0)
    parts = (a, b), (c, 2.0), None
    assert _through(parts) == _flat_sum(parts) == 2.0 * (a.sum() + b.sum() + c.sum())
    assert _write(a, 7.0) == a.size
    np.testing.assert_array_equal(a[:, 0], [0.0, 7.0, 7.0, 7.0])


def test_owners_keep_their_count():
    a = np.zeros((4, 3))
    _write(a, 1.0)
    held = sys.getrefcount(a)
    for _ in range(100):
        _write(a, 1.0)
    assert sys.getrefcount(a) == held


@pytest.mark.parametrize("n", [5, 100_000])
def test_an_array_of_the_kernel_lives_as_long_as_its_name(n):
    assert _made_here(n) == 3.0 * n * (n - 1) / 2.0 + n - 1
