"""Rows of right-hand sides against dense algebra, for every factor."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.substitution import solve_ldl, solve_lu, solve_lu_transposed


@pytest.mark.parametrize("count, width", [(1, 1), (2, 1), (7, 3), (30, 5), (41, 12), (90, 40), (150, 70)])
@pytest.mark.parametrize("sides", [1, 2, 3, 4, 5, 6, 9])
def test_twins(factors, count, width, sides):
    f = factors(count, width)
    b = np.random.default_rng(sides).normal(size=(sides, count))
    for solve, factor, A in (
        (solve_lu, (f.lower, f.upper, f.inverse), f.A),
        (solve_lu_transposed, (f.lower, f.upper, f.inverse), f.A.T),
        (solve_ldl, (f.band, f.band_inverse), f.symmetric),
    ):
        x = b.copy()
        solve(*factor, count, width, x)
        np.testing.assert_allclose(x, np.linalg.solve(A, b.T).T, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("sides", [1, 4, 7])
def test_rows_of_any_order(factors, sides):
    """Right-hand sides from numpy's indexing need not lie row after row in memory."""
    f = factors(60, 5)
    b = np.random.default_rng(sides).normal(size=(sides, 60))
    for place in (np.asfortranarray, lambda rows: np.repeat(rows, 2, axis=1)[:, ::2]):
        for solve, factor, A in (
            (solve_lu, (f.lower, f.upper, f.inverse), f.A),
            (solve_lu_transposed, (f.lower, f.upper, f.inverse), f.A.T),
            (solve_ldl, (f.band, f.band_inverse), f.symmetric),
        ):
            x = place(b.copy())
            solve(*factor, 60, 5, x)
            np.testing.assert_allclose(x, np.linalg.solve(A, b.T).T, rtol=1e-11, atol=1e-13)
