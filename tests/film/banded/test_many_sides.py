"""Columns and tiles of right-hand sides against dense algebra."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.many_sides import TILE, make_tiles, solve_columns, solve_in_tiles


def by_columns(factor, count, width, b):
    x = b.copy()
    solve_columns(np.zeros(b.shape[1], dtype=np.int64), *factor, count, width, x)
    return x


def by_tiles(factor, count, width, b):
    given = len(b.T) // 2
    x = make_tiles(np.ascontiguousarray(b.T[:given]), b.shape[1])
    for s in range(given, b.shape[1]):
        x[s // TILE, :count, s % TILE] = b[:, s]
    solve_in_tiles(*factor, count, width, x)
    whole = x.transpose(1, 0, 2).reshape(len(x[0]), -1)
    assert not whole[count:].any() and not whole[:, b.shape[1] :].any()
    return whole[:count, : b.shape[1]]


@pytest.mark.parametrize("count, width", [(1, 1), (3, 2), (7, 3), (8, 7), (30, 5), (41, 12), (45, 44)])
@pytest.mark.parametrize(
    "solve, sides", [(by_columns, 1), (by_columns, 9), (by_tiles, 1), (by_tiles, TILE), (by_tiles, TILE + 9)]
)
def test_twins(factors, solve, count, width, sides):
    f = factors(count, width)
    b = np.random.default_rng(1).normal(size=(count, sides))
    x = solve((f.upper, f.lower, f.inverse, False), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.A.T, b), rtol=1e-11, atol=1e-13)
    x = solve((f.band, f.band, f.band_inverse, True), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.symmetric, b), rtol=1e-11, atol=1e-13)
