"""The bearing in space: hill and journal at their places."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from exudyn_ehd.pictures import bearing3d
from exudyn_ehd.status import InputError


def test_hill_is_proportional_to_the_pressure():
    theta, z = np.linspace(0.0, 2.0 * np.pi, 9), np.linspace(-1.0, 1.0, 3)
    p = np.array([0.0, 1e6, 2e6])[None, :] * np.ones((9, 1))
    points = bearing3d.pressure_surface(theta, z, p)
    np.testing.assert_allclose(np.hypot(points[..., 0], points[..., 1]) - 1.0, bearing3d.HILL * p / 2e6, atol=1e-15)
    np.testing.assert_allclose(np.arctan2(points[2, :, 1], points[2, :, 0]), theta[2])


def test_journal_touches_the_bore_where_the_gap_vanishes(film):
    """The drawn gap over the drawn clearance is the gap of the rigid surfaces
    over c, at both ends of a tilted journal."""
    bearing = film.bearing
    z = film.z[[0, -1]] / bearing.journal_radius
    theta = film.theta
    points = bearing3d.journal_surface(film, np.linspace(0.0, 2.0 * np.pi, 721), z)
    gap = 1.0 - np.hypot(points[..., 0], points[..., 1]).max(axis=0)
    smallest = film.gap[:, [0, -1]].min(axis=0) / bearing.radial_clearance * bearing3d.CLEARANCE
    # the film's own gap is the first order in c/R of the circles', here drawn
    # at c/R = 0.22, and sampled every 7.5 degrees
    np.testing.assert_allclose(gap, smallest, atol=2e-3)
    assert theta.size == 48


def test_picture_has_a_labelled_bar_and_names_what_is_not_to_scale(film, tmp_path):
    figure = film.plot_bearing(path=tmp_path / "bearing.png")
    assert figure.axes[1].get_ylabel() == "pressure [MPa]"
    assert "not to scale" in figure.axes[0].get_title()
    assert (tmp_path / "bearing.png").stat().st_size > 10_000


def test_every_facet_has_four_finite_corners(film, monkeypatch):
    """Matplotlib pads shorter polygons with uninitialised memory, which then scales the axes."""
    drawn, collection = [], bearing3d.Poly3DCollection
    monkeypatch.setattr(
        bearing3d, "Poly3DCollection", lambda polygons, **style: drawn.append(polygons) or collection(polygons, **style)
    )
    film.plot_bearing()
    (corners,) = map(np.asarray, drawn)
    assert corners.shape[1:] == (4, 3)
    assert np.abs(corners).max() < 1.0 + bearing3d.HILL + 1e-9


def test_flat_axes_are_refused(film):
    with pytest.raises(InputError, match="ax must be 3d"):
        film.plot_bearing(ax=Figure().add_subplot())
