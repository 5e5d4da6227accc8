"""Derivatives of sums over a film to the gaps around vertices, against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd import bearing_grid
from exudyn_ehd.film.reynolds.gap import Gradients, join, link_rows

N, M = 9, 5


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def entries(rng, count=30):
    """Random entries; those to a vertex behind an end are zero."""
    places, by = rng.integers(N * M, size=count), rng.normal(size=(10, count))
    by[3, places % M == M - 1] = by[4, places % M == 0] = 0.0
    return Gradients(rng.integers(7, size=count), places, by)


def change(gradients, count, H, HF, H_t, v):
    """Change (count,) of the sums with the gaps at vertices and on links, the rate and the speeds."""
    cell, face, rate, speed = gradients.fields(-np.eye(count), (N, M))
    return np.tensordot(cell, H, 2) + np.tensordot(face, HF, 2) + np.tensordot(rate, H_t, 2) + speed @ v


@pytest.mark.parametrize("on_liner", [False, True])
def test_rows_of_links_are_the_derivatives_of_the_balances(rng, on_liner):
    by, by_speed, follows, (H, HF, H_t) = *rng.normal(size=(3, 4, N, M)), rng.normal(size=(3, N, M))
    by[2:, :, -1] = by_speed[1:3, :, -1] = 0.0  # no link behind the last row
    storage, v, order, out = (
        rng.normal(size=(2, N, M)),
        rng.normal(size=2),
        rng.permutation(N * M)[:20],
        np.empty((10, 20)),
    )
    flat = (x.reshape(4, -1) for x in (by, by_speed))
    link_rows(order, 20, M, *flat, follows.reshape(4, -1) if on_liner else None, storage, out)
    D, E, own, link = follows if on_liner else (0.0 * H, 0.0 * H, 0.0 * H + 1.0, 0.0 * H + 1.0)

    def mean(field, axis):
        return 0.5 * (field + np.roll(field, -1, axis))

    def lean(axis):
        return 0.5 * (np.roll(E * H, -1, axis) - E * H)

    along = by[0] * link * (HF + mean(D * H, 0)) + by[1] * lean(0) + by_speed[0] * v[0]
    across = by[2] * mean(own * H, 1) + by[3] * lean(1) + by_speed[2] * v[0] + by_speed[1] * v[1]
    balance = (
        along - np.roll(along, 1, axis=0) + across - np.roll(across, 1, axis=1) + storage[1] * H + storage[0] * H_t
    )
    got = change(Gradients(np.arange(20), order, out), 20, H, HF, H_t, v)
    np.testing.assert_allclose(got, balance.ravel()[order], rtol=1e-12, atol=1e-13)


def test_columns_matrices_and_fields_are_the_same_derivatives(rng):
    g = join(entries(rng), entries(rng, 12))
    assert len(g.rows) == 42
    shapes, motion = rng.normal(size=(2, N, M, 4)), rng.normal(size=10)
    gap, rate = shapes @ motion[:4], shapes[0] @ motion[4:8]
    expected = change(g, 7, gap[0], gap[1], rate, motion[8:])
    np.testing.assert_allclose(motion @ g.columns(shapes, 7), expected, rtol=1e-12)
    H, H_t = rng.normal(size=(2, N, M))
    mean = 0.5 * (H + np.roll(H, -1, axis=0))
    got = g.matrix((N, M), 7, 2.0, 0.0) @ H.ravel() + g.matrix((N, M), 7, 0.0, 3.0) @ H_t.ravel()
    np.testing.assert_allclose(got, change(g, 7, 2.0 * H, 2.0 * mean, 3.0 * H_t, np.zeros(2)), rtol=1e-12)
    weights, rows = rng.normal(size=(N, M)), rng.integers(7, size=N * M)
    one = g.weighed(weights).columns(shapes, 1)[:, 0]
    np.testing.assert_allclose(one, g.weighed(weights, rows).columns(shapes, 7).sum(axis=1), rtol=1e-12)


def test_chain_rule_to_the_true_gap(rng):
    g, (slope, bend, face_slope) = entries(rng), rng.normal(size=(3, N, M))
    (H, HF, H_t), v = rng.normal(size=(3, N, M)), rng.normal(size=2)
    expected = change(g, 7, slope * H, face_slope * HF, slope * H_t + bend * H, v)
    before = g.by.copy()
    # bend counts where the rate is stored, at the vertex itself
    np.testing.assert_allclose(change(g.to_true_gap(slope, bend, face_slope), 7, H, HF, H_t, v), expected, rtol=1e-12)
    assert np.array_equal(g.by, before)


def test_shapes_of_the_gap_are_those_of_a_journal():
    grid = bearing_grid(0.025, 0.02, 32, 4)
    x, y, bx, by = 0.3, -0.2, 0.15, 0.4
    for shape, theta in zip(grid.gap_shapes, (grid.x, grid.x_face), strict=True):
        c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
        expected = -(x + grid.z * bx) * c - (y + grid.z * by) * s
        np.testing.assert_allclose(shape @ (x, y, bx, by), expected, rtol=1e-13, atol=1e-15)
    fields = np.random.default_rng(2).normal(size=(3, *grid.shape))
    np.testing.assert_allclose(grid.by_pose(fields, 1), np.tensordot(fields, grid.gap_shapes[1], 2), rtol=1e-12)
