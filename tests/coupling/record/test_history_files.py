"""Histories on disk, and their summary by revolutions."""

import csv
import dataclasses
import pickle

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record.history import COLUMNS, make_row
from exudyn_ehd.coupling.record.record import Record
from exudyn_ehd.coupling.record.revolutions import revolution_times
from exudyn_ehd.status import InputError

OMEGA = 100.0
TURN = 2.0 * np.pi / OMEGA


def made_up(time, omega, **quantities):
    """A history of a bearing with c = 20 um, L = 20 mm."""

    class Bearing:
        radial_clearance, journal_radius, length = 20e-6, 0.01, 0.02

    record = Record(Bearing)
    for k, t in enumerate(time):
        motion = np.zeros(10)
        motion[0], motion[8] = 1e-6 * k, omega[k]
        values = {name: v[k] for name, v in quantities.items()}
        record.append(make_row(t, motion, (0.05 * (k % 7), 0.06 * (k % 5)), np.arange(6.0) + k, values))
    return record.snapshot(None)


@pytest.fixture
def history():
    """Two and a half turns at constant spin, in steps of a fiftieth."""
    t = np.linspace(0.0, 2.5 * TURN, 126)
    phase = OMEGA * t
    return made_up(
        t,
        np.full(126, OMEGA),
        minimum_gap=10e-6 + 4e-6 * np.cos(phase - 0.3 * np.pi) + 1e-7 * t / TURN,
        minimum_gap_angle=np.mod(phase, 2.0 * np.pi),
        minimum_gap_z=0.01 * np.sign(np.sin(phase)),
        peak_pressure=5e6 + 2e6 * np.sin(phase),
        peak_angle=0.5 * np.ones(126),
        power_loss=30.0 + 10.0 * np.sin(phase) ** 2,
        friction_torque=-0.3 + 0.1 * np.cos(phase),
        leakage=1e-6 * (1.0 + t / TURN),
    )


def test_saved_histories_come_back_bit_for_bit(history, tmp_path):
    path = tmp_path / "runs" / "bearing.npz"
    history.save(path)
    again = ehd.load_history(path)
    for field in dataclasses.fields(history):
        np.testing.assert_array_equal(getattr(again, field.name), getattr(history, field.name))
        assert type(getattr(again, field.name)) is type(getattr(history, field.name))
    # nothing but the file is left
    assert list(path.parent.iterdir()) == [path]
    sent = pickle.loads(pickle.dumps(history))
    np.testing.assert_array_equal(sent.peak_pressure, history.peak_pressure)
    assert sent.length == history.length


def test_an_interrupted_save_leaves_the_old_file(history, tmp_path, monkeypatch):
    path = tmp_path / "bearing.npz"
    history.save(path)
    before = path.read_bytes()

    def breaks(file, **fields):
        file.write(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "savez_compressed", breaks)
    with pytest.raises(KeyboardInterrupt):
        history.save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_other_files_are_refused(history, tmp_path):
    with pytest.raises(InputError, match=r"must end in \.npz, got 'a\.txt'"):
        history.save("a.txt")
    np.savez(tmp_path / "other.npz", time=[1.0])
    np.save(tmp_path / "plain.npy", [1.0])
    (tmp_path / "text.npz").write_text("no archive")
    (tmp_path / "empty.npz").write_bytes(b"")
    for name in ("other.npz", "plain.npy", "text.npz", "empty.npz"):
        with pytest.raises(InputError, match="holds no history of this version"):
            ehd.load_history(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        ehd.load_history(tmp_path / "absent.npz")


def test_csv_has_every_column_with_its_unit(history, tmp_path):
    history.to_csv(tmp_path / "history.csv")
    with open(tmp_path / "history.csv", newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    assert head[:4] == ["time [s]", "x [m]", "y [m]", "bx [rad]"]
    assert all(name.endswith("]") for name in head), "every column has a unit"
    values = np.array(rows, dtype=float)
    read = dict(zip([name.split(" [")[0] for name in head], values.T, strict=True))
    np.testing.assert_array_equal(read["omega"], history.motion[:, 8])
    np.testing.assert_array_equal(read["moment_z"], history.moment[:, 2])
    np.testing.assert_array_equal(read["minimum_gap"], history.minimum_gap)
    # what the film does not provide stays nan
    assert np.isnan(read["film_temperature"]).all()


def test_revolutions_of_a_turning_journal(history):
    table = history.revolutions()
    assert len(table) == 2
    np.testing.assert_allclose(table.start, [0.0, TURN], atol=1e-12)
    np.testing.assert_allclose(table.end, [TURN, 2.0 * TURN], rtol=1e-12)
    # the cosine's minimum at phase 1.3 pi is met by step 32.5: both neighbours are equal apart from the small trend
    np.testing.assert_allclose(table.minimum_gap_time, [32 * TURN / 50, 82 * TURN / 50], rtol=1e-12)
    np.testing.assert_allclose(table.minimum_gap, history.minimum_gap[[32, 82]], rtol=0)
    np.testing.assert_allclose(table.minimum_gap_angle, 2.0 * np.pi * 32 / 50, rtol=1e-9)
    np.testing.assert_allclose(table.minimum_gap_z, -0.01)
    np.testing.assert_allclose(table.peak_pressure, history.peak_pressure[[12, 62]].max(), rtol=1e-9)
    np.testing.assert_allclose(table.peak_angle, 0.5)
    # the trapezoidal rule is exact for these trigonometric sums over a whole period, and for the linear trend
    np.testing.assert_allclose(table.mean_power_loss, 35.0, rtol=1e-9)
    np.testing.assert_allclose(table.mean_friction_torque, -0.3, rtol=1e-9)
    np.testing.assert_allclose(table.mean_leakage, [1.5e-6, 2.5e-6], rtol=1e-9)
    np.testing.assert_allclose(table.largest_eccentricity_ratio, 0.24)
    np.testing.assert_allclose(table.largest_load, np.hypot([50, 100], [51, 101]))


def test_table_as_text_and_csv(history, tmp_path):
    table = history.revolutions()
    lines = str(table).splitlines()
    assert len(lines) == 3 and "mean_power_loss [W]" in lines[0] and "minimum_gap_z [mm]" in lines[0]
    table.to_csv(tmp_path / "turns.csv")
    with open(tmp_path / "turns.csv", newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    assert len(rows) == 2 and head[:2] == ["start [s]", "end [s]"]
    assert all(name.endswith("]") for name in head)


def test_turning_backwards_counts_and_swinging_needs_a_period():
    t = np.linspace(0.0, 1.0, 201)
    np.testing.assert_allclose(revolution_times(t, np.full(201, -4.0 * np.pi)), [0.0, 0.5, 1.0], atol=1e-12)
    # forward by 1.5 turns, back to where it was, forward by 3: the second turn ends on the way forward
    there_and_back = np.concatenate([np.full(100, 1.5), np.full(100, -1.5), np.full(101, 3.0)]) * 2.0 * np.pi
    times = revolution_times(np.linspace(0.0, 3.0, 301), there_and_back)
    np.testing.assert_allclose(times, [0.0, 2.0 / 3.0, 2.0 + 2.0 / 3.0, 3.0], atol=0.02)
    # a hair short of a turn, back, and on through it
    edges = np.array([0.0, 0.2, 0.5, 1.0])
    rates = 2.0 * np.pi * np.diff([0.0, 0.9999, 0.1, 2.0]) / np.diff(edges)
    steps = np.sort(np.concatenate([t, edges[1:3]]))
    spin = np.concatenate([np.full(np.sum((t >= a) & (t <= b)), rate) for a, b, rate in zip(edges, edges[1:], rates)])
    np.testing.assert_allclose(revolution_times(steps, spin)[1], 0.5 + 0.9 / 1.9 * 0.5, atol=1e-9)
    swing = made_up(t, np.cos(2.0 * np.pi * t), minimum_gap=np.cos(2.0 * np.pi * t), power_loss=np.ones(201))
    with pytest.raises(InputError, match=r"not turned once against the housing; give period="):
        swing.revolutions()
    table = swing.revolutions(period=0.25)
    assert len(table) == 4
    np.testing.assert_allclose(table.minimum_gap_time, [0.25, 0.5, 0.5, 0.75], atol=1e-12)
    assert np.isnan(table.peak_pressure).all() and np.isnan(table.mean_leakage).all()
    with pytest.raises(InputError, match="period must not exceed the history's 1 s, got 2 s"):
        swing.revolutions(period=2.0)
    with pytest.raises(InputError, match="no recorded step between"):
        swing.revolutions(period=0.001)
    with pytest.raises(InputError, match=r"keeps 2 of 201 states.*record all steps"):
        dataclasses.replace(swing.between(0.5, 0.505), step_count=np.array([0, 200])).revolutions()
    with pytest.raises(InputError, match="no steps; run a solver first"):
        made_up([0.0], [1.0]).revolutions()


def test_place_of_the_smallest_gap_is_in_the_record(history):
    row = np.arange(64.0)
    assert row[COLUMNS[ehd.Quantity.MINIMUM_GAP_Z.value]].size == 1
    assert history.minimum_gap_angle.shape == history.time.shape


def test_part_of_a_history(history):
    part = history.between(0.5 * TURN, 1.5 * TURN)
    # 50 steps per turn, both ends included
    assert part.time.size == 51
    assert part.time[0] == pytest.approx(0.5 * TURN) and part.time[-1] == pytest.approx(1.5 * TURN)
    np.testing.assert_array_equal(part.motion, history.motion[25:76])
    assert part.radial_clearance == history.radial_clearance
    assert history.between().time.size == history.time.size and history.between(9.0).time.size == 0
    with pytest.raises(InputError, match="start must not lie after end"):
        history.between(2.0, 1.0)
