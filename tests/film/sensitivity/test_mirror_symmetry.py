"""Folded halves of symmetric shapes against whole fields."""

import numpy as np
import pytest

from exudyn_ehd.film.banded.many_sides import TILE, make_tiles
from exudyn_ehd.film.sensitivity.mirror_symmetry import (
    BLOCK,
    courses,
    fold_adjoints,
    folded_displacements,
    folded_loads,
    folded_rows,
    number_vertices,
    stencil_by_vertices,
    touched_columns,
)

N = 9


def shapes(m, mirrored, evens, odds, seed):
    """Random shapes (n m, k), even or odd in z if folded, their halves, and their order."""
    rng = np.random.default_rng(seed)
    even, odd = rng.normal(size=(N, m, evens)), rng.normal(size=(N, m, odds))
    if mirrored:
        even, odd = even + even[:, ::-1], odd - odd[:, ::-1]
    order = rng.permutation(evens + odds)
    whole = np.empty((N * m, evens + odds))
    whole[:, order] = np.concatenate((even, odd), axis=2).reshape(N * m, -1)
    upper = np.ascontiguousarray(even[:, : m - mirrored]).reshape(N * (m - mirrored), evens)
    return whole, upper, np.ascontiguousarray(odd[:, :mirrored]).reshape(N * mirrored, odds), order


CASES = pytest.mark.parametrize("m, mirrored, evens, odds", [(7, 3, 5, 4), (6, 3, 4, 3), (7, 3, 5, 0), (7, 0, 6, 0)])


@CASES
def test_displacements_and_loads(m, mirrored, evens, odds):
    whole, even, odd, order = shapes(m, mirrored, evens, odds, 1)
    rng = np.random.default_rng(2)
    q, q_t = rng.normal(size=(2, evens + odds))
    place, rate = np.empty((2, N, m))
    folded_displacements(even, odd, order, q, q_t, place, rate)
    np.testing.assert_allclose(place.ravel(), whole @ q, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(rate.ravel(), whole @ q_t, rtol=1e-12, atol=1e-13)
    fields = rng.normal(size=(3, N, m))
    fields[:, 2:5] = 0.0
    out = np.empty((3, evens + odds))
    folded_loads(fields, even, odd, order, out)
    np.testing.assert_allclose(out, fields.reshape(3, -1) @ whole, rtol=1e-12, atol=1e-12)


@CASES
@pytest.mark.parametrize("first", [2, TILE - 3])
def test_rows_in_tiles(m, mirrored, evens, odds, first):
    whole, even, odd, order = shapes(m, mirrored, evens, odds, 3)
    rng = np.random.default_rng(4)
    places, weight = rng.permutation(N * m)[:20], rng.normal(size=20)
    tiles = make_tiles(np.zeros((first, 20)), first + evens + odds)
    folded_rows(even, odd, N, m, places, weight, first, tiles)
    wide = tiles.transpose(1, 0, 2).reshape(20, -1)[:, first : first + evens + odds]
    np.testing.assert_allclose(wide, (whole[places] * weight[:, None])[:, order], rtol=1e-14)


def stencil(places, m, seed):
    """Random stencil of `stencil.gap_stencil`'s form: itself, next and last in theta, next and last in z."""
    weight = np.random.default_rng(seed).normal(size=(len(places), 5))
    i, j = np.divmod(places, m)
    vertices = np.stack([places, (i + 1) % N * m + j, (i - 1) % N * m + j, places + 1, places - 1], axis=1)
    for column, missing in ((3, j == m - 1), (4, j == 0)):
        weight[missing, column], vertices[missing, column] = 0.0, places[missing]
    return weight, vertices


@CASES
@pytest.mark.parametrize("columns", [(3, 4), (8, 0, 1), tuple(range(N))])
def test_transposed_stencil_of_adjoints(m, mirrored, evens, odds, columns):
    rng = np.random.default_rng(5)
    places = np.array([i * m + j for i in columns for j in range(m) if 0 < j < m - 1 or i == 3])
    rng.shuffle(places)
    weight, vertices = stencil(places, m, 6)
    fields = rng.normal(size=(len(places), TILE))
    first, by_vertex, row = stencil_by_vertices(weight, places, (N, m))
    upper = m - mirrored
    bases = [np.zeros((u, BLOCK)) for u in (2, mirrored)]
    bases[0][:, :upper] = rng.normal(size=(2, upper))
    # as many courses as rows: the rows themselves
    bases[1][:, :mirrored] = np.eye(mirrored)
    even, odd = fold_adjoints(by_vertex, row, (N, m), mirrored, *bases, fields)
    whole = np.zeros((N * m, TILE))
    np.add.at(whole, vertices.ravel(), (weight[:, :, None] * fields[:, None]).reshape(-1, TILE))
    whole = whole.reshape(N, m, TILE)
    expected = whole[:, :upper].copy()
    expected[:, :mirrored] += whole[:, ::-1][:, :mirrored]
    count = len(even) // 2
    at = (first + np.arange(count)) % N
    assert not np.delete(whole, at, axis=0).any()
    expected = bases[0][:, :upper] @ expected[at]
    np.testing.assert_allclose(even.reshape(count, 2, TILE), expected, rtol=1e-12, atol=1e-12)
    expected = (whole - whole[:, ::-1])[at, :mirrored]
    np.testing.assert_allclose(odd.reshape(count, mirrored, TILE), expected, rtol=1e-12, atol=1e-12)
    alone = fold_adjoints(by_vertex, row, (N, m), mirrored, bases[0], np.zeros((0, BLOCK)), fields)
    np.testing.assert_allclose(alone[0], even, rtol=1e-12, atol=1e-13)
    assert len(alone[1]) == 0


@pytest.mark.parametrize("rows, rank", [(9, 5), (9, 9), (3, 2), (12, 4)])
def test_courses_along_z(rows, rank):
    rng = np.random.default_rng(8)
    shapes = rng.normal(size=(rows, rank)) @ rng.normal(size=(N, rank, 7))
    basis, coordinates = courses(shapes.reshape(N * rows, 7), N)
    assert basis.shape == (rank, max(rows, BLOCK)) and not basis[:, rows:].any()
    again = basis[:, :rows].T @ coordinates.reshape(N, rank, 7)
    np.testing.assert_allclose(again, shapes, rtol=1e-12, atol=1e-12)
    if rank == rows:
        np.testing.assert_array_equal(again, shapes)


def test_courses_of_no_shapes():
    basis, coordinates = courses(np.zeros((N * 4, 0)), N)
    assert basis.shape == (0, BLOCK) and coordinates.shape == (0, 0)


@pytest.mark.parametrize(
    "filled, first, count", [((3, 4), 2, 4), ((8, 0), 7, 4), ((1, 2, 6), 5, 8), (range(N), 0, N), (range(7), 0, N)]
)
def test_columns_with_neighbours(filled, first, count):
    numbers = np.empty((N, 4), dtype=np.int64)
    number_vertices(np.array([4 * i + 1 for i in filled]), numbers)
    assert touched_columns(numbers) == (first, count)
