"""Vectors of four against plain sums."""

import numpy as np
from numba import njit

from exudyn_ehd.film.banded.factors import LANES, subtract_four_lanes, subtract_lanes


@njit
def _one(a, at, b, p, f):
    subtract_lanes(a, np.uint64(at), b, np.uint64(p), f)


@njit
def _four(a, at, b, p, f):
    q = p.astype(np.uint64)
    subtract_four_lanes(a, np.uint64(at), b, q[0], q[1], q[2], q[3], f[0], f[1], f[2], f[3])


def test_any_place_of_either_array():
    """Also of one array that is both, as the rows of a band are; nothing else is touched."""
    rng = np.random.default_rng(5)
    for _ in range(200):
        a, b, f = rng.normal(size=40), rng.normal(size=40), rng.normal(size=4)
        at, p = int(rng.integers(0, 12)), rng.integers(16, 36, 4)
        for source in (a, b):
            for count in (1, 4):
                target = a.copy()
                source = target if source is a else source
                expected = target.copy()
                expected[at : at + LANES] -= sum(f[k] * source[p[k] : p[k] + LANES] for k in range(count))
                if count == 1:
                    _one(target, at, source, int(p[0]), f[0])
                else:
                    _four(target, at, source, p, f)
                np.testing.assert_allclose(target, expected, rtol=1e-14, atol=1e-14)
