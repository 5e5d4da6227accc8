"""The pictures' type is their own, whatever others have left in matplotlib's settings."""

import inspect
import io

import exudyn.plot
import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from exudyn_ehd.pictures.bush import Frame, contour_figure, plot_bearing
from exudyn_ehd.pictures.files import Frames
from exudyn_ehd.pictures.histories import plot_load, plot_orbit, plot_traces
from exudyn_ehd.pictures.maps import PRESSURE, plot_map
from exudyn_ehd.pictures.style import styled
from exudyn_ehd.solid.mesh import HollowCylinder
from tests.benchmarks.accuracy.report.pictures import summary_figure, work_precision
from tests.benchmarks.accuracy.table import DATA, Row, read_table
from tests.sampling import sample

ROWS, _ = read_table(DATA / "steady_800_film.csv", Row)

# what other programs leave: mbs.PlotSensor of Exudyn the first
LEFT_BEHIND = {
    "font.size": 16.0,
    "axes.labelsize": "x-large",
    "axes.titlesize": "xx-large",
    "xtick.labelsize": "large",
    "ytick.labelsize": "large",
    "legend.fontsize": "large",
    "figure.titlesize": "xx-large",
    "figure.labelsize": "xx-large",
    "legend.title_fontsize": 20.0,
}


def contours():
    mesh = HollowCylinder(inner_radius=0.2, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=8).mesh()
    frames = [Frame(title=f"t = {t} s", displacements=0.1 * t * mesh.nodes, values=mesh.nodes[:, 0]) for t in (1, 2)]
    return contour_figure(mesh, frames, label="x in m")


PICTURES = {
    "map": lambda film, history: plot_map(film, PRESSURE),
    "bearing": lambda film, history: plot_bearing(film),
    "orbit": lambda film, history: plot_orbit(history, ends=True),
    "load": lambda film, history: plot_load(history),
    "traces": lambda film, history: plot_traces(history),
    "frames": lambda film, history: Frames([film], history).figure,
    "bush": lambda film, history: contours(),
    "work and precision": lambda film, history: work_precision(
        [row for row in ROWS if row.quantity == "load"], "title", "evaluation"
    ),
    "summary": lambda film, history: summary_figure([("scene", "load", "1 %", "-", "-", "-")], "note"),
}


def pixels(figure):
    """Pixels that a user's own ``savefig`` writes."""
    file = io.BytesIO()
    figure.savefig(file, dpi=60, format="rgba")
    return np.frombuffer(file.getvalue(), np.uint8)


@pytest.mark.parametrize("name", sample(list(PICTURES), 0))
def test_pictures_do_not_take_over_type_that_others_left(name, film, history):
    expected = pixels(PICTURES[name](film, history))
    with matplotlib.rc_context(LEFT_BEHIND):
        np.testing.assert_array_equal(pixels(PICTURES[name](film, history)), expected)


def test_exudyn_leaves_large_type_behind():
    """Exudyn changes matplotlib's font size for good; if this test fails, the pictures no longer need their guard."""
    assert "rcParams.update({'font.size': fontSize})" in inspect.getsource(exudyn.plot.PlotSensor)


def test_pictures_in_a_larger_figure_take_its_type(film):
    with styled(11.0):
        figure = Figure()
        ax = figure.add_subplot()
        plot_map(film, PRESSURE, ax=ax)
    texts = [ax.title, ax.xaxis.label, ax.yaxis.label, figure.axes[1].yaxis.label]
    assert [text.get_fontsize() for text in texts] == [11.0] * 4
    figure = Figure()
    plot_map(film, PRESSURE, ax=figure.add_subplot())
    assert figure.axes[0].title.get_fontsize() == 8.0
