"""Columns of right-hand sides against dense algebra."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.substitution import TILE, solve_columns


def solved(factor, count, width, b):
    x = b.copy()
    solve_columns(*factor, count, width, x)
    return x


@pytest.mark.parametrize("count, width", [(1, 1), (3, 2), (7, 3), (8, 7), (30, 5), (41, 12), (45, 44)])
@pytest.mark.parametrize("sides", [1, 9, TILE, TILE + 9])
def test_twins(factors, count, width, sides):
    f = factors(count, width)
    b = np.random.default_rng(1).normal(size=(count, sides))
    x = solved((f.lower, f.upper, f.inverse, False), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.A, b), rtol=1e-11, atol=1e-13)
    x = solved((f.band, f.band, f.band_inverse, True), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.symmetric, b), rtol=1e-11, atol=1e-13)
