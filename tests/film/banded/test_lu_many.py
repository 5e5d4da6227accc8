"""Banded LU with many right-hand sides against dense algebra."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.lu import PAD, factor_lu, solve_lu, solve_lu_transposed


@pytest.mark.parametrize("count, width", [(1, 1), (7, 3), (30, 5), (41, 12), (90, 40), (150, 70)])
@pytest.mark.parametrize("sides", [1, 3, 4, 9])
def test_twin(count, width, sides):
    rng = np.random.default_rng(count + sides)
    A = -rng.uniform(size=(count, count))
    A[np.abs(np.subtract.outer(np.arange(count), np.arange(count))) > width] = 0.0
    A[np.diag_indices(count)] = 1.1 + np.abs(A).sum(axis=0)
    lower, upper = (np.zeros((count + PAD, width + 1 + PAD)) for _ in range(2))
    for r in range(count):
        for d in range(min(width, count - 1 - r) + 1):
            upper[r, d] = A[r, r + d]
            if d:
                lower[r, d] = A[r + d, r]
    inverse = np.zeros(count)
    assert factor_lu(lower, upper, count, width, inverse)
    b = rng.normal(size=(sides, count))
    x, y = b.copy(), b.copy()
    solve_lu(lower, upper, inverse, count, width, x)
    solve_lu_transposed(lower, upper, inverse, count, width, y)
    np.testing.assert_allclose(x, np.linalg.solve(A, b.T).T, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(y, np.linalg.solve(A.T, b.T).T, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("width", [2, 70])
@pytest.mark.parametrize("count", [75, 76, 77])
def test_a_vanishing_pivot_is_told(count, width):
    """In every place of a panel, and behind the last whole one; elsewhere a diagonal matrix."""
    for r in (0, 1, 2, 3, count - 2, count - 1):
        lower, upper = (np.zeros((count + PAD, width + 1 + PAD)) for _ in range(2))
        upper[:count, 0] = 1.0
        upper[r, 0] = 0.0
        assert not factor_lu(lower, upper, count, width, np.zeros(count))
