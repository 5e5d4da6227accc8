"""Slopes of gap terms against numpy."""

import numpy as np

from exudyn_ehd.film.reynolds.gap import gap_slopes, transposed_slopes


def test_slopes_are_central_differences_and_have_a_transpose():
    rng = np.random.default_rng(0)
    n, m, width = 12, 7, 0.3
    z = np.sort(rng.normal(size=m))
    field, other = rng.normal(size=(2, n, m))
    link, along_x, along_z, tx, tz = np.empty((5, n, m))
    widths, links = np.full(n, width), np.full(n, 1.0 / width)
    gap_slopes(field, widths, links, z, link, along_x, along_z)
    np.testing.assert_allclose(link, 0.5 * (field + np.roll(field, -1, axis=0)), rtol=1e-14)
    np.testing.assert_allclose(along_x, (np.roll(field, -1, 0) - np.roll(field, 1, 0)) / (2 * width), rtol=1e-14)
    np.testing.assert_allclose(along_z, np.gradient(field, z, axis=1), rtol=1e-12, atol=1e-12)
    transposed_slopes(other, width, z, tx, tz)
    np.testing.assert_allclose(
        [np.sum(tx * field), np.sum(tz * field)], [np.sum(other * along_x), np.sum(other * along_z)]
    )


def test_slopes_end_with_an_arc():
    """Columns 0 to 4 and 5 to 11 are arcs: one-sided slopes at their edges, no mean over an open link."""
    rng = np.random.default_rng(0)
    z, widths, links = np.linspace(-1.0, 1.0, 7), np.full(12, 0.3), np.full(12, 1.0 / 0.3)
    widths[[0, 4, 5, 11]], links[[4, 11]] = 0.15, 0.0
    field, (link, along_x, along_z) = rng.normal(size=(12, 7)), np.empty((3, 12, 7))
    gap_slopes(field, widths, links, z, link, along_x, along_z)
    for part in (slice(0, 5), slice(5, 12)):
        own = field[part]
        np.testing.assert_allclose(along_x[part], np.gradient(own, 0.3, axis=0), rtol=1e-13)
        np.testing.assert_allclose(link[part], np.vstack((0.5 * (own[1:] + own[:-1]), own[-1:])), rtol=1e-14)
