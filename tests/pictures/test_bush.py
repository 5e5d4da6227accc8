"""Pictures in space without a display: contours of bushes; hill and journal of a bearing at their places."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from exudyn_ehd.pictures import bush
from exudyn_ehd.pictures.bush import Frame, contour_figure
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.status import InputError
from tests.solid_tetrahedra import tet_mesh

CYLINDER = HollowCylinder(inner_radius=0.2, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=8)
MESH = CYLINDER.mesh()


@pytest.mark.parametrize("MESH", [MESH, tet_mesh(CYLINDER)], ids=["hexahedra", "tetrahedra"])
def test_figure_has_one_panel_per_frame_and_a_labelled_bar(tmp_path, MESH):
    frames = [
        Frame(title=f"t = {t} s", displacements=0.1 * t * MESH.nodes, values=t * MESH.nodes[:, 0]) for t in (1, 2, 3)
    ]
    figure = contour_figure(MESH, frames, label="x in m")
    titles = [axes.get_title() for axes in figure.axes]
    assert titles[:3] == ["t = 1 s", "t = 2 s", "t = 3 s"]
    assert figure.axes[3].get_ylabel() == "x in m"
    figure.savefig(tmp_path / "bush.png", dpi=40)
    assert (tmp_path / "bush.png").stat().st_size > 2000


def test_no_frames_are_refused_and_a_constant_field_is_drawn():
    with pytest.raises(InputError, match="at least one Frame"):
        contour_figure(MESH, [], label="")
    still = Frame(title="", displacements=0 * MESH.nodes, values=np.zeros(len(MESH.nodes)))
    contour_figure(MESH, [still], label="zero")


def test_hill_is_proportional_to_the_pressure():
    theta, z = np.linspace(0.0, 2.0 * np.pi, 9), np.linspace(-1.0, 1.0, 3)
    p = np.array([0.0, 1e6, 2e6])[None, :] * np.ones((9, 1))
    points = bush.pressure_surface(theta, z, p)
    np.testing.assert_allclose(np.hypot(points[..., 0], points[..., 1]) - 1.0, bush.HILL * p / 2e6, atol=1e-15)
    np.testing.assert_allclose(np.arctan2(points[2, :, 1], points[2, :, 0]), theta[2])


def test_journal_touches_the_bore_where_the_gap_vanishes(film):
    """The drawn gap over the drawn clearance is the gap of the rigid surfaces
    over c, at both ends of a tilted journal."""
    bearing = film.bearing
    z = film.z[[0, -1]] / bearing.journal_radius
    theta = film.theta
    points = bush.journal_surface(film, np.linspace(0.0, 2.0 * np.pi, 721), z)
    gap = 1.0 - np.hypot(points[..., 0], points[..., 1]).max(axis=0)
    smallest = film.gap[:, [0, -1]].min(axis=0) / bearing.radial_clearance * bush.CLEARANCE
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
    drawn, collection = [], bush.Poly3DCollection
    monkeypatch.setattr(
        bush, "Poly3DCollection", lambda polygons, **style: drawn.append(polygons) or collection(polygons, **style)
    )
    film.plot_bearing()
    (corners,) = map(np.asarray, drawn)
    assert corners.shape[1:] == (4, 3)
    assert np.abs(corners).max() < 1.0 + bush.HILL + 1e-9


def test_flat_axes_are_refused(film):
    with pytest.raises(InputError, match="ax must be 3d"):
        film.plot_bearing(ax=Figure().add_subplot())
