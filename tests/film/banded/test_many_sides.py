"""Columns of right-hand sides, and their products, against dense algebra."""

import numpy as np
import pytest
from scipy.sparse import random_array

from exudyn_ehd.film.banded.substitution import TILE, product, solve_columns


def solved(factor, count, width, b):
    x = b.copy()
    solve_columns(*factor, count, width, x)
    return x


@pytest.mark.parametrize("density", [0.1, 0.6, 1.0])
@pytest.mark.parametrize("sides", [1, TILE, TILE + 9])
def test_products_with_sparse_and_dense_matrices(density, sides):
    rng = np.random.default_rng(4)
    columns, matrix = rng.normal(size=(31, sides)), random_array((31, 17), density=density, rng=rng, format="csr")
    expected = matrix.toarray().T @ columns
    for given in (matrix, matrix.toarray()):
        np.testing.assert_allclose(product(given.T, columns), expected, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("count, width", [(1, 1), (3, 2), (7, 3), (8, 7), (30, 5), (41, 12), (45, 44)])
@pytest.mark.parametrize("sides", [1, 9, TILE, TILE + 9])
def test_twins(factors, count, width, sides):
    f = factors(count, width)
    b = np.random.default_rng(1).normal(size=(count, sides))
    x = solved((f.lower, f.upper, f.inverse, False), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.A, b), rtol=1e-11, atol=1e-13)
    x = solved((f.band, f.band, f.band_inverse, True), count, width, b)
    np.testing.assert_allclose(x, np.linalg.solve(f.symmetric, b), rtol=1e-11, atol=1e-13)
