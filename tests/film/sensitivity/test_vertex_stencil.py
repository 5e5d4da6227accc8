"""Stencils by vertices against sums over unknowns."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.many_sides import TILE
from exudyn_ehd.film.sensitivity.vertex_stencil import (
    number_vertices,
    stencil_by_vertices,
    stencil_products,
    touched_columns,
)

N = 9


def stencil(places, m, seed):
    """Random stencil of `stencil.gap_stencil`'s form: itself, next and last in theta, next and last in z."""
    weight = np.random.default_rng(seed).normal(size=(len(places), 5))
    i, j = np.divmod(places, m)
    vertices = np.stack([places, (i + 1) % N * m + j, (i - 1) % N * m + j, places + 1, places - 1], axis=1)
    for column, missing in ((3, j == m - 1), (4, j == 0)):
        weight[missing, column], vertices[missing, column] = 0.0, places[missing]
    return weight, vertices


@pytest.mark.parametrize("m", [6, 7])
@pytest.mark.parametrize("columns", [(3, 4), (8, 0, 1), tuple(range(N))])
def test_transposed_stencil_of_adjoints(m, columns):
    rng = np.random.default_rng(5)
    places = np.array([i * m + j for i in columns for j in range(m) if 0 < j < m - 1 or i == 3])
    rng.shuffle(places)
    weight, vertices = stencil(places, m, 6)
    fields = rng.normal(size=(len(places), TILE))
    first, by_vertex, row = stencil_by_vertices(weight, places, (N, m))
    out = np.empty((len(row), TILE))
    stencil_products(by_vertex, row, fields, out)
    whole = np.zeros((N * m, TILE))
    np.add.at(whole, vertices.ravel(), (weight[:, :, None] * fields[:, None]).reshape(-1, TILE))
    whole = whole.reshape(N, m, TILE)
    at = (first + np.arange(len(row) // m)) % N
    assert not np.delete(whole, at, axis=0).any()
    np.testing.assert_allclose(out.reshape(-1, m, TILE), whole[at], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    "filled, first, count", [((3, 4), 2, 4), ((8, 0), 7, 4), ((1, 2, 6), 5, 8), (range(N), 0, N), (range(7), 0, N)]
)
def test_columns_with_neighbours(filled, first, count):
    numbers = np.empty((N, 4), dtype=np.int64)
    number_vertices(np.array([4 * i + 1 for i in filled]), numbers)
    assert touched_columns(numbers) == (first, count)
