"""Slopes of gap terms against numpy."""

import dataclasses

import numpy as np

from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.reynolds.gap import gap_slopes, transposed_slopes

RING = bearing_grid(1.0, 1.4, 12, 6)


def test_slopes_are_central_differences_and_have_a_transpose():
    rng = np.random.default_rng(0)
    field, other = rng.normal(size=(2, *RING.shape))
    width = RING.width_x[0]
    link, (along_x, along_z) = gap_slopes(field, RING)
    np.testing.assert_allclose(link, 0.5 * (field + np.roll(field, -1, axis=0)), rtol=1e-14)
    np.testing.assert_allclose(along_x, (np.roll(field, -1, 0) - np.roll(field, 1, 0)) / (2 * width), rtol=1e-14)
    np.testing.assert_allclose(along_z, np.gradient(field, RING.z, axis=1), rtol=1e-12, atol=1e-12)
    tx, tz = transposed_slopes(other, RING)
    np.testing.assert_allclose(
        [np.sum(tx * field), np.sum(tz * field)], [np.sum(other * along_x), np.sum(other * along_z)]
    )


def test_slopes_end_with_an_arc():
    """Columns 0 to 4 and 5 to 11 are arcs: one-sided slopes at their edges, no mean over an open link."""
    widths, links = np.full(12, 0.3), np.full(12, 1.0 / 0.3)
    widths[[0, 4, 5, 11]], links[[4, 11]] = 0.15, 0.0
    field = np.random.default_rng(0).normal(size=RING.shape)
    link, (along_x, _) = gap_slopes(field, dataclasses.replace(RING, width_x=widths, link_x=links))
    for part in (slice(0, 5), slice(5, 12)):
        own = field[part]
        np.testing.assert_allclose(along_x[part], np.gradient(own, 0.3, axis=0), rtol=1e-13)
        np.testing.assert_allclose(link[part], np.vstack((0.5 * (own[1:] + own[:-1]), own[-1:])), rtol=1e-14)
