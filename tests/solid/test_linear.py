"""Factors and equations known by products against dense solutions."""

import numpy as np
import pytest
from scipy.sparse import csc_matrix, diags, random_array

from exudyn_ehd.solid.total_lagrange import solve_by_products, sparse_factor


@pytest.mark.parametrize("seed", range(12))
def test_factors_of_random_matrices(seed):
    """Positive and negative pivots, patterns without structure, one or several right-hand sides."""
    rng = np.random.default_rng(seed)
    n, density = int(rng.integers(1, 120)), rng.choice([0.0, 0.02, 0.1, 0.6])
    A = random_array((n, n), density=density, rng=rng)
    A = csc_matrix(A + A.T + diags(rng.choice([-1.0, 1.0], n) * (2.0 + n * density)))
    right = rng.standard_normal((n, 3))
    factor, exact = sparse_factor(A), np.linalg.solve(A.toarray(), right)
    # round-off times a condition below 1e4
    assert np.allclose(factor.solve(right), exact, rtol=1e-9, atol=1e-12)
    assert np.allclose(factor.solve(right[:, 0]), exact[:, 0], rtol=1e-9, atol=1e-12)


def test_a_singular_matrix_raises():
    with pytest.raises(RuntimeError):
        sparse_factor(csc_matrix((3, 3)))


@pytest.mark.parametrize("tolerance", [1e-3, 1e-10])
@pytest.mark.parametrize("seed", range(4))
def test_equations_known_by_products(seed, tolerance):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(20, 120))
    A, right = np.diag(np.geomspace(1.0, 100.0, n)) + 0.1 * rng.standard_normal((n, n)), rng.standard_normal(n)
    asked = []

    def product(x):
        asked.append(x)
        return A @ x

    x = solve_by_products(product, right, tolerance, n)
    # round-off of the residual that is updated, over the true one
    assert np.linalg.norm(right - A @ x) < 1.01 * tolerance
    assert len(asked) <= n


@pytest.mark.parametrize("right", [np.zeros(3), np.full(3, np.nan)])
def test_nothing_to_solve(right):
    assert not solve_by_products(lambda x: x, right, 0.0, 5).any()
