"""Many right-hand sides in tiles against dense algebra."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.ldl import factor_band
from exudyn_ehd.film.banded.lu import factor_lu
from exudyn_ehd.film.banded.tiles import TILE, make_tiles, solve_in_tiles


def solve(factor, count, width, b):
    given = len(b.T) // 2
    x = make_tiles(np.ascontiguousarray(b.T[:given]), b.shape[1])
    for s in range(given, b.shape[1]):
        x[s // TILE, :count, s % TILE] = b[:, s]
    solve_in_tiles(*factor, count, width, x)
    whole = x.transpose(1, 0, 2).reshape(len(x[0]), -1)
    assert not whole[count:].any() and not whole[:, b.shape[1] :].any()
    return whole[:count, : b.shape[1]]


@pytest.mark.parametrize("count, width", [(1, 1), (3, 2), (7, 3), (8, 7), (30, 5), (41, 12), (45, 44)])
@pytest.mark.parametrize("sides", [1, TILE, TILE + 9])
def test_twins(banded, bands, count, width, sides):
    b, inverse = np.random.default_rng(1).normal(size=(count, sides)), np.zeros(count)
    A = banded(count, width, count)
    lower, upper = bands(A, width)
    assert factor_lu(lower, upper, count, width, inverse)
    x = solve((upper, lower, inverse, False), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(A.T, b), rtol=1e-11, atol=1e-13)
    A = A + A.T
    _, band = bands(A, width)
    assert factor_band(band, count, width, 0, inverse)
    x = solve((band, band, inverse, True), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(A, b), rtol=1e-11, atol=1e-13)
