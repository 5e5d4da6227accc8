"""Many right-hand sides as columns against dense algebra."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.columns import solve_columns
from exudyn_ehd.film.banded.ldl import factor_band
from exudyn_ehd.film.banded.lu import factor_lu


@pytest.mark.parametrize("count, width", [(1, 1), (3, 2), (7, 3), (30, 5), (41, 12)])
@pytest.mark.parametrize("sides", [1, 9])
def test_twins(banded, bands, count, width, sides):
    b, inverse = np.random.default_rng(1).normal(size=(count, sides)), np.zeros(count)
    A = banded(count, width, count)
    lower, upper = bands(A, width)
    assert factor_lu(lower, upper, count, width, inverse)
    x = b.copy()
    solve_columns(upper, lower, inverse, False, count, width, x)
    np.testing.assert_allclose(x, np.linalg.solve(A.T, b), rtol=1e-11, atol=1e-13)
    A = A + A.T
    _, band = bands(A, width)
    assert factor_band(band, count, width, 0, inverse)
    x = b.copy()
    solve_columns(band, band, inverse, True, count, width, x)
    np.testing.assert_allclose(x, np.linalg.solve(A, b), rtol=1e-11, atol=1e-13)
