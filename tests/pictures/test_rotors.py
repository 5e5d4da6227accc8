"""Pictures of rotors: what they show, in which units."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from exudyn_ehd.pictures import curves as pictures
from exudyn_ehd.pictures.records import Unit

SPEEDS = np.array([100.0, 200.0, 300.0])
TABLE = {
    "speed": SPEEDS,
    "frequency": np.array([[50.0, 400.0], [100.0, 390.0], [150.0, np.nan]]),
    "growth": np.array([[-5.0, -300.0], [-1.0, -100.0], [2.0, np.nan]]),
    "damping_ratio": np.array([[0.1, 0.6], [0.01, 0.25], [-0.013, np.nan]]),
    "log_decrement": np.array([[0.6, 4.7], [0.06, 1.6], [-0.08, np.nan]]),
    "whirl": np.array([[1.0, -1.0], [1.0, -0.5], [0.9, np.nan]]),
}

pytestmark = pytest.mark.usefixtures("tidy_pictures")


def test_campbell_diagrams_show_every_vibration_and_what_grows(tmp_path):
    ax = pictures.plot_campbell(TABLE, path=tmp_path / "campbell.png").axes[0]
    overdamped, light = (np.asarray(dots.get_offsets()) for dots in ax.collections)
    np.testing.assert_allclose(overdamped, [[100.0 * 30.0 / np.pi, 400.0 / (2.0 * np.pi)]])
    assert len(light) == 4
    cross = ax.lines[0].get_xydata()
    np.testing.assert_allclose(cross, [[300.0 * 30.0 / np.pi, 150.0 / (2.0 * np.pi)]])
    assert ax.get_xlabel() == "speed [1/min]" and ax.get_ylabel() == "frequency [Hz]"
    assert (tmp_path / "campbell.png").stat().st_size > 10_000


def test_decrements_are_shown_where_the_campbell_diagram_is_small():
    ax = pictures.plot_stability(TABLE).axes[0]
    decays, grows = ax.lines[1].get_ydata(), ax.lines[2].get_ydata()
    assert sorted(decays) == [0.06, 0.6] and list(grows) == [-0.08]


def test_places_responses_and_maps():
    places = np.stack((np.linspace([0.5, -0.5], [0.1, 0.0], 3), np.linspace([0.6, -0.4], [0.2, 0.0], 3)), axis=1)
    ax = pictures.plot_positions(SPEEDS, places, ["left", "right"]).axes[0]
    np.testing.assert_allclose(ax.lines[1].get_xydata(), places[:, 0])
    assert ax.lines[4].get_label() == "slowest, 955 1/min"
    curves = [("disc", np.array([1e-6, 5e-6, 2e-6]), -SPEEDS / 100.0)]
    upper, lower = pictures.plot_response(SPEEDS, curves, np.array([True, True, False])).axes
    np.testing.assert_allclose(upper.lines[0].get_ydata(), [1.0, 5.0, np.nan])
    np.testing.assert_allclose(upper.lines[1].get_ydata(), [np.nan, np.nan, 2.0])
    np.testing.assert_allclose(lower.lines[0].get_ydata(), np.degrees([-1.0, -2.0, np.nan]))
    assert upper.get_ylabel() == "amplitude [µm]"
    ax = Figure().add_subplot()
    limits, thresholds = (100.0, 400.0), np.array([np.inf, 300.0, 0.0])
    pictures.plot_map(np.array([2.0, 1.0, 3.0]), thresholds, limits, ("load", Unit("kN", 1e-3)), ax=ax)
    np.testing.assert_allclose(ax.lines[0].get_xdata(), [1e-3, 2e-3, 3e-3])
    np.testing.assert_allclose(ax.lines[0].get_ydata(), np.array([300.0, 400.0, 100.0]) * 30.0 / np.pi)
    assert ax.get_xlabel() == "load [kN]"
