"""Contour pictures without a display."""

import numpy as np
import pytest

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
