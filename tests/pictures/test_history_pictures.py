"""Orbit, load and traces show the history's values, with units."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from exudyn_ehd.pictures.histories import plot_load, plot_orbit, plot_traces, plot_waterfall, spectra
from exudyn_ehd.pictures.records import unit_for
from exudyn_ehd.status import InputError


def line(ax, label):
    (found,) = [one for one in ax.lines if one.get_label() == label]
    return np.column_stack(found.get_data())


def test_orbit_is_the_history_in_the_clearance_circle(history):
    figure = plot_orbit(history, ends=True)
    (ax,) = figure.axes
    np.testing.assert_allclose(line(ax, "mid-plane"), 1e6 * history.eccentricity, rtol=1e-15)
    np.testing.assert_allclose(np.hypot(*line(ax, "clearance 20 µm").T), 20.0)
    np.testing.assert_allclose(
        line(ax, "at z = +L/2")[:, 0], 1e6 * (history.motion[:, 0] + 0.01 * history.motion[:, 2])
    )
    np.testing.assert_allclose(
        line(ax, "at z = -L/2")[:, 0], 1e6 * (history.motion[:, 0] - 0.01 * history.motion[:, 2])
    )
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [µm]", "y [µm]")
    assert ax.get_aspect() == 1.0


def test_two_orbits_share_a_circle(history):
    ax = Figure().add_subplot()
    plot_orbit(history, text="first", ax=ax)
    plot_orbit(history, text="second", ax=ax)
    assert sum(one.get_label().startswith("clearance") for one in ax.lines) == 1
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["clearance 20 µm", "first", "second"]


def test_load_is_opposite_to_the_force_on_the_journal(history):
    figure = plot_load(history)
    (ax,) = figure.axes
    angle, size = line(ax, "load on the bush").T
    tips = np.column_stack([size * np.cos(angle), size * np.sin(angle)])
    np.testing.assert_allclose(tips, -history.force[:, :2], atol=1e-10)
    assert ax.get_title() == "load of the journal on the bush [N]"
    with pytest.raises(InputError, match="must be polar"):
        plot_load(history, ax=Figure().add_subplot())


def test_traces_over_time_and_angle(history):
    figure = plot_traces(history)
    upper, lower = figure.axes
    np.testing.assert_allclose(upper.lines[0].get_data(), [1e3 * history.time, 1e6 * history.minimum_gap])
    np.testing.assert_allclose(lower.lines[0].get_data(), [1e3 * history.time, 1e-6 * history.peak_pressure])
    assert [ax.get_ylabel() for ax in figure.axes] == ["minimum film\nthickness [µm]", "peak pressure [MPa]"]
    assert lower.get_xlabel() == "time [ms]"
    crank = 2.0 * np.pi * history.time / 0.02
    figure = plot_traces(history, ["peak_pressure"], angle=crank, angle_text="crank angle")
    (ax,) = figure.axes
    np.testing.assert_allclose(ax.lines[0].get_xdata(), np.degrees(crank))
    assert ax.get_xlabel() == "crank angle [°]"
    assert list(np.diff(ax.get_xticks())[:3]) == [45.0] * 3


def test_traces_below_zero_are_seen(history):
    history.axial_position = -3e-6 + 1e-6 * np.sin(2.0 * np.pi * history.time / 0.02)
    (ax,) = plot_traces(history, "axial_position").axes
    low, high = ax.get_ylim()
    assert low < -4.0 and high == 0.0
    plot_traces(history, "minimum_gap", ax=ax)
    assert ax.get_ylim()[0] == low and ax.get_ylim()[1] > 1e6 * history.minimum_gap.max()


def test_traces_refuse_what_can_not_be_drawn(history):
    with pytest.raises(InputError, match="scalars of a history, got 'force'; known are axial_position"):
        plot_traces(history, ["force"])
    with pytest.raises(InputError, match="this film has no supply flow"):
        plot_traces(history, ["supply_flow"])
    with pytest.raises(InputError, match=r"shape \(41,\) as history.time, got \(3,\)"):
        plot_traces(history, angle=np.zeros(3))
    with pytest.raises(InputError, match="as many axes as quantities"):
        plot_traces(history, ax=[Figure().add_subplot()])


@pytest.fixture
def run_up(history):
    """Two seconds of steps of two lengths: a run-up from 30 to 90 Hz, 3 um at half of it and 1 um at 20 Hz."""
    t = np.concatenate([np.arange(0.0, 1.0, 1e-3), np.arange(1.0, 2.0, 5e-4)])
    motion = np.zeros((t.size, 10))
    motion[:, 8] = 2.0 * np.pi * (30.0 + 30.0 * t)
    turned = 2.0 * np.pi * (30.0 * t + 15.0 * t**2)
    motion[:, 0] = 5e-6 + 3e-6 * np.cos(0.5 * turned) + 1e-6 * np.cos(2.0 * np.pi * 20.0 * t)
    gap = 10e-6 + 2e-6 * np.sin(2.0 * np.pi * 33.0 * t)
    made = {"time": t, "motion": motion, "eccentricity": motion[:, :2], "minimum_gap": gap}
    return SimpleNamespace(**(vars(history) | made))


def test_spectra_have_the_frequencies_and_amplitudes_of_the_history(run_up):
    frequency, time, amplitude = spectra(run_up, "minimum_gap", window=0.5)
    at = frequency[amplitude.argmax(axis=0)]
    # four frequencies within 1 / window; unequal steps are interpolated
    np.testing.assert_allclose(at, 33.0, atol=0.5)
    np.testing.assert_allclose(amplitude.max(axis=0), 2e-6, rtol=0.02)
    assert time[0] == pytest.approx(0.25, abs=1e-3) and 1.6 < time[-1] < 1.76


def test_waterfall_over_the_speed_shows_the_whirl_on_the_line_of_half_of_it(run_up):
    figure = plot_waterfall(run_up, speed=run_up.motion[:, 8], window=0.25)
    ax, bar = figure.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("frequency [Hz]", "speed [1/min]")
    assert bar.get_ylabel() == "amplitude: x of the journal [µm]"
    half, rpm = line(ax, "0.5 x speed").T
    np.testing.assert_allclose(half, rpm / 120.0)
    frequency, _, amplitude = spectra(run_up, window=0.25)
    whirl = frequency[np.where(frequency[:, None] > 24.0, amplitude, 0.0).argmax(axis=0)]
    # the frequency rises by 3.75 Hz within a window
    np.testing.assert_allclose(whirl[half > 28.0], half[half > 28.0], atol=1.0)
    (mesh,) = ax.collections
    shown = mesh.get_array()
    assert shown.max() == pytest.approx(1e6 * amplitude.max()) and shown.min() >= 0.999e-3 * shown.max()
    assert ax.get_xlim()[1] <= 1.21 * rpm.max() / 60.0


def test_waterfall_over_the_time_has_the_spin_s_lines_and_all_frequencies_where_nothing_turns(run_up):
    (ax, _) = plot_waterfall(run_up).axes
    spin, time = line(ax, "1 x speed").T
    assert ax.get_ylabel() == "time [s]"
    np.testing.assert_allclose(spin, 30.0 + 30.0 * time, rtol=1e-3)
    run_up.motion[:, 8] = 0.0
    (ax, _) = plot_waterfall(run_up).axes
    assert ax.get_xlim()[1] > 700.0


def test_waterfall_refuses_what_has_no_spectra(run_up):
    with pytest.raises(InputError, match=r"at least 16 of the history's 2999 steps.* got 15 steps in 0\.01 s"):
        plot_waterfall(run_up, window=0.01)
    with pytest.raises(InputError, match=r"shape \(3000,\) as history.time and rise, or fall, .*got shape \(3,\)"):
        plot_waterfall(run_up, speed=np.arange(3.0))
    with pytest.raises(InputError, match="rise, or fall, throughout"):
        plot_waterfall(run_up, speed=np.sin(run_up.time * 3.0))
    with pytest.raises(InputError, match="plot_waterfall: quantities must be scalars of a history, got 'force'"):
        plot_waterfall(run_up, "force")


@pytest.mark.parametrize("plot", [plot_orbit, plot_load, plot_traces, plot_waterfall])
def test_a_history_without_steps_is_no_empty_picture(history, plot):
    history.time = history.time[:0]
    with pytest.raises(InputError, match=rf"{plot.__name__}: the history has no steps; run a solver first"):
        plot(history)


@pytest.mark.parametrize(
    ("kind", "value", "symbol", "shown"),
    [
        ("pressure", -3e6, "MPa", -3.0),
        ("pressure", 2e4, "kPa", 20.0),
        ("length", 12e-6, "µm", 12.0),
        ("length", 0.02, "mm", 20.0),
        ("temperature", 313.15, "°C", 40.0),
        ("flow", 2e-6, "cm³/s", 2.0),
        ("force", 0.0, "kN", 0.0),
        ("power", np.nan, "kW", np.nan),
    ],
)
def test_units(kind, value, symbol, shown):
    unit = unit_for(kind, value)
    assert unit.symbol == symbol
    assert float(unit(value)) == pytest.approx(shown, nan_ok=True)


def test_style_leaves_the_users_settings_alone(history):
    import matplotlib

    before = dict(matplotlib.rcParams)
    plot_orbit(history)
    assert dict(matplotlib.rcParams) == before
