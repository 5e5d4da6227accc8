"""Figures that ``plt.show()`` shows where there is something to show them with."""

import os
import pickle
import subprocess
import sys
import types

import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg

from exudyn_ehd.pictures.curves import plot_curves
from exudyn_ehd.pictures.histories import plot_load, plot_orbit, plot_traces
from exudyn_ehd.pictures.maps import PRESSURE, plot_map
from exudyn_ehd.studies.parameters import StudyTable


@pytest.fixture(params=["list_of_windows"])
def windows(monkeypatch, request):
    """A backend, of the name given, whose windows are a list of the figures shown."""
    shown = []

    class Manager(FigureManagerBase):
        def show(self):
            shown.append(self.canvas.figure)

    class Canvas(FigureCanvasAgg):
        manager_class = Manager

    backend = types.ModuleType(request.param)
    backend.FigureCanvas, backend.FigureManager = Canvas, Manager
    monkeypatch.setitem(sys.modules, backend.__name__, backend)
    before = matplotlib.get_backend()
    plt.switch_backend(f"module://{backend.__name__}")
    yield shown
    plt.close("all")
    plt.switch_backend(before)


def test_show_shows_them_and_savefig_saves(windows, film, history, tmp_path):
    curve = ("a", np.arange(3.0), np.arange(3.0))
    figures = [
        plot_orbit(history),
        plot_load(history),
        plot_traces(history),
        plot_map(film, PRESSURE),
        plot_curves([curve], ("speed", "minimum_gap"), {}),
    ]
    # those that are written are no more to be shown
    plot_orbit(history, path=tmp_path / "orbit.png")
    plt.show()
    assert windows == figures
    figures[0].show()
    assert windows[-1] is figures[0]
    figures[0].savefig(tmp_path / "again.png")
    assert (tmp_path / "again.png").stat().st_size > 1000 and (tmp_path / "orbit.png").stat().st_size > 1000


@pytest.mark.parametrize("windows", ["windows_of_an_inline"], indirect=True)
def test_a_notebook_shows_once_what_its_cell_returns(windows, film, history):
    """IPython asks a returned figure for its formats, shows it, and behind the cell all figures of pyplot."""
    others = plt.figure()
    returned, on_axes, kept = (
        plot_orbit(history),
        plot_orbit(history, ax=others.add_subplot()),
        plot_map(film, PRESSURE),
    )
    assert on_axes is others and len(plt.get_fignums()) == 3
    for figure in (returned, others):
        assert figure._repr_mimebundle_(include=None, exclude=None) is None
    plt.show()
    assert windows == [kept]
    assert pickle.loads(pickle.dumps(returned)).axes[0].get_xlabel() == returned.axes[0].get_xlabel()


NOTEBOOK = """
from IPython.core.interactiveshell import InteractiveShell

class Shell(InteractiveShell):
    def enable_gui(self, gui=None):
        pass

shell, shown = Shell.instance(), []
shell.display_pub.publish = lambda data, *_, **__: shown.append("image/png" in data)
shell.displayhook.write_format_data = lambda data, md=None: shown.append("image/png" in data)
shell.run_line_magic("matplotlib", "inline")
shell.run_cell('''
import numpy as np
from matplotlib import pyplot as plt
from exudyn_ehd.pictures.curves import plot_curves
draw = lambda ax=None: plot_curves([("a", np.arange(3.0), np.arange(3.0))], ("speed", "load"), {}, ax=ax)
''')
counts = []
for cell in ("draw()", "figure = draw()", "draw(); draw()", "display(draw())", "figure, ax = plt.subplots(); draw(ax)"):
    shown.clear()
    assert shell.run_cell(cell).success
    counts.append(sum(shown))
assert counts == [1, 1, 2, 1, 1], counts
"""


@pytest.mark.slow
def test_ipython_shows_every_picture_once():
    pytest.importorskip("IPython")
    pytest.importorskip("matplotlib_inline")
    environment = os.environ | {"MPLBACKEND": "module://matplotlib_inline.backend_inline"}
    subprocess.run([sys.executable, "-c", NOTEBOOK], check=True, env=environment)


def test_pyplot_keeps_none_that_it_can_not_show(history):
    assert matplotlib.get_backend().lower() == "agg"
    plot_orbit(history)
    assert not plt.get_fignums()


def test_titles_and_legends(film, fed_film, history):
    assert plot_orbit(history, title="main").axes[0].get_title() == "main"
    assert plot_traces(history, title="main").get_suptitle() == "main"
    assert plot_load(history, title="main").axes[0].get_title().startswith("main\nload of")
    for its, expected in ((film, ["edge of the cavity"]), (fed_film, ["edge of the cavity", "supply area"])):
        figure = plot_map(its, PRESSURE, title="main")
        assert figure.axes[0].get_title().startswith("main\nlargest")
        assert [text.get_text() for text in figure.legends[0].get_texts()] == expected


def test_columns_of_a_study_have_the_units_of_their_size():
    """Parameters too: 25 µm, not 2.5 in a corner's 1e-5 m."""
    grid = np.array([[20e-6, 40e-6], [20e-6, 40e-6]])
    columns = {"radial_clearance": grid.ravel(), "eccentricity_ratio": np.array([0.5, 0.5, 0.8, 0.8])}
    columns |= {"peak_pressure": 1e6 * np.arange(4.0), "force_x": 1e4 * np.arange(4.0)}
    names = ("eccentricity_ratio", "radial_clearance")
    table = StudyTable(columns=columns, parameters=names, shape=(2, 2), errors=("",) * 4, units={})
    ax = table.plot("peak_pressure", along="radial_clearance").axes[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("radial clearance [µm]", "peak pressure [MPa]")
    assert np.allclose(ax.lines[0].get_xdata(), [20.0, 40.0])
    assert ax.get_legend().get_texts()[1].get_text() == "eccentricity ratio = 0.8"
    ax = table.plot("force_x").axes[0]
    assert ax.get_ylabel() == "force x [kN]" and ax.get_xlabel() == "eccentricity ratio [-]"
    assert ax.get_legend().get_texts()[0].get_text() == "radial clearance = 20 µm"
