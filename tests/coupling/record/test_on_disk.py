"""Records in files: bit for bit those in memory, readable after a kill, and never another's or something else's."""

import subprocess
import sys
import tracemalloc
from pathlib import Path

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record import history as rows_of
from exudyn_ehd.coupling.record.history import make_row
from exudyn_ehd.coupling.record.record import Record
from exudyn_ehd.coupling.record.rows import HEAD, RowsOnDisk
from exudyn_ehd.joint.step_error import LOAD_COLUMNS, FilmLoad

ROOT = Path(__file__).parents[3]


class Bearing:
    radial_clearance, journal_radius, length = 20e-6, 0.01, 0.02


def same(a, b):
    for name in rows_of._NAMES:
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)


def random_row(rng, time):
    values = {"minimum_gap": rng.uniform(1e-6, 9e-6), "peak_pressure": rng.uniform(1e6, 9e6)}
    return make_row(time, rng.normal(size=10), (0.3, 0.4), rng.normal(size=6), values, rng.normal(size=16))


@pytest.mark.slow
def test_any_course_gives_the_record_in_memory(tmp_path):
    """Repeated last times, times that run back, readings in between, a restored state."""
    for seed in range(6):
        rng = np.random.default_rng(seed)
        kept, stored = Record(Bearing), Record(Bearing)
        stored.keep_on_disk(tmp_path / f"{seed}.rows", "main")
        time = 0.0
        for k in range(1500):
            if rng.random() < 0.002:
                time *= 0.5
            elif rng.random() < 0.9:
                time += rng.uniform(1e-4, 1e-3)
            row = random_row(rng, time)
            for record in (kept, stored):
                record.append(row)
            if rng.random() < 0.01:
                final = random_row(rng, time + 1e-5) if rng.random() < 0.5 else None
                same(kept.snapshot(final), stored.snapshot(final))
                same(ehd.load_history(tmp_path / f"{seed}.rows"), kept.snapshot(final))
            assert kept.thinnest == stored.thinnest and kept.last_time == stored.last_time
            if k == 900:
                rows = kept.rows(None)
                np.testing.assert_array_equal(rows, stored.rows(None))
                kept.restore(rows), stored.restore(rows)
        same(kept.snapshot(None), stored.snapshot(None))


@pytest.mark.slow
def test_a_part_of_a_long_file_is_read_alone(tmp_path, monkeypatch):
    """Bit for bit; no more rows are touched."""
    path, record = tmp_path / "long.rows", Record(Bearing)
    record.keep_on_disk(path, "main")
    rng, time = np.random.default_rng(4), 0.0
    for _ in range(4000):
        time += rng.uniform(0.5, 1.5) * 1e-4
        row = random_row(rng, time)
        # a film that keeps nine tenths of its errors from step to step
        blocks = np.tile(np.eye(2).ravel(), 4) * np.repeat([-1000.0, -1.0, -1000.0, -1.0], 4)
        row[rows_of.TANGENT][: blocks.size] = blocks
        load = FilmLoad.of(rng.normal(size=sum(LOAD_COLUMNS)) * 1e-3)
        row[rows_of.LOAD] = np.concatenate(load._replace(mass=[1e-6, 0.0, 1e-6, 0.0, 1e-6, 0.0]))
        record.append(row)
    whole = record.snapshot(None)
    for start, end in ((0.3, 0.301), (whole.time[2000], whole.time[2100]), (0.399, 9.0), (-1.0, 0.02), (7.0, 8.0)):
        part, expected = ehd.load_history(path, start=start, end=end), whole.between(start, end)
        for name in rows_of._NAMES:
            np.testing.assert_array_equal(getattr(part, name), getattr(expected, name), err_msg=name)
    assert ehd.load_history(path, start=0.2, end=0.3).time.size > 900
    with pytest.raises(ehd.InputError, match="start must not lie after end"):
        ehd.load_history(path, start=0.3, end=0.2)
    whole.save(tmp_path / "whole.npz")
    same(ehd.load_history(tmp_path / "whole.npz", start=0.1, end=0.2), whole.between(0.1, 0.2))


def memory_of_records():
    """Bytes that lines of the package hold: threads of a parallel test run take some, too."""
    own = tracemalloc.Filter(True, str(Path(rows_of.__file__).parent / "*"))
    return sum(block.size for block in tracemalloc.take_snapshot().filter_traces([own]).traces)


def test_memory_does_not_grow(tmp_path):
    """Less than 50 bytes a step for what would take 416: 500 MB for ten joints and a million steps."""
    record, rng = Record(Bearing), np.random.default_rng(1)
    record.keep_on_disk(tmp_path / "long.rows", "main")
    rows = [random_row(rng, 0.0) for _ in range(50)]
    tracemalloc.start()
    for k in range(5000):
        rows[k % 50][0] = 1e-4 * k
        record.append(rows[k % 50])
        if k == 2000:
            before = memory_of_records()
    after = memory_of_records()
    tracemalloc.stop()
    assert before > 0 and (after - before) / 3000 < 1.0
    assert record.snapshot(None).time.size == 5000


def model(*names, record):
    mbs = exu.SystemContainer().AddSystem()
    ground, joints = mbs.CreateGround(), []
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    for name in names:
        shaft = mbs.CreateRigidBody(
            inertia=InertiaCylinder(7800, 0.5, 0.025, 2), initialAngularVelocity=[0, 0, 314], gravity=[0, -9.81, 0]
        )
        joints.append(
            ehd.CreateLubricatedJoint(mbs, name, [ground, shaft], [0, 0, 0], [0, 0, 1], bearing, record=record)
        )
    mbs.Assemble()
    return mbs, joints


def settings(steps):
    out = exu.SimulationSettings()
    out.timeIntegration.endTime, out.timeIntegration.numberOfSteps = 1e-4 * steps, steps
    out.timeIntegration.verboseMode = 0
    out.solution.file.write = False
    return ehd.ConfigureSolver(out) or out


@pytest.mark.slow
def test_a_run_in_a_file_is_the_run_in_memory(tmp_path):
    histories = []
    for record in (None, ehd.File(path=tmp_path / "runs" / "{name}.rows")):
        mbs, joints = model("a/b", "right", record=record)
        ehd.SolveDynamic(mbs, settings(600))
        if record is not None:
            # complete but for the state that is accepted with the next step, before anybody asks for the history
            assert ehd.load_history(tmp_path / "runs" / "right.rows").time.size >= 600
        histories.append([joint.history for joint in joints])
    for kept, stored, name in zip(*histories, ("a_b", "right"), strict=True):
        assert kept.time.size == 601
        same(kept, stored)
        same(kept, ehd.load_history(tmp_path / "runs" / f"{name}.rows"))
    # a run that goes on, and a new one
    ehd.SolveDynamic(mbs, settings(300))
    assert joints[1].history.time.size == 301
    assert ehd.load_history(tmp_path / "runs" / "right.rows").time.size == 301


@pytest.mark.slow
def test_a_killed_run_leaves_its_rows(tmp_path):
    code = f"""
import os, sys
sys.path.insert(0, {str(ROOT)!r})
import exudyn_ehd as ehd
from tests.coupling.record.test_on_disk import model, settings
mbs, joints = model("main", record=ehd.File(path={str(tmp_path / "main.rows")!r}))
mbs.SetPreStepUserFunction(lambda mbs, t: os._exit(9) if t > 0.07 else True)
ehd.SolveDynamic(mbs, settings(1000))
"""
    assert subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True).returncode == 9
    left = ehd.load_history(tmp_path / "main.rows")
    mbs, joints = model("main", record=None)
    ehd.SolveDynamic(mbs, settings(left.time.size - 1))
    whole = joints[0].history
    assert 500 < left.time.size == whole.time.size
    np.testing.assert_allclose(left.minimum_gap, whole.minimum_gap, rtol=1e-9)
    # a row that was cut off does not count
    raw = (tmp_path / "main.rows").read_bytes()
    (tmp_path / "main.rows").write_bytes(raw[:-13])
    assert ehd.load_history(tmp_path / "main.rows").time.size == left.time.size - 1
    (tmp_path / "main.rows").write_bytes(raw[:HEAD])
    assert ehd.load_history(tmp_path / "main.rows").time.size == 0


def test_a_file_of_two_joints_is_refused(tmp_path):
    with pytest.raises(ehd.InputError, match=r"record: another joint .*both\.rows'; put \{name\} into the path"):
        model("left", "right", record=ehd.File(path=tmp_path / "both.rows"))


@pytest.mark.slow
def test_a_file_that_another_system_replaces_is_told(tmp_path):
    systems = [model("both", record=ehd.File(path=tmp_path / "{name}.rows")) for _ in range(2)]
    for mbs, _ in systems:
        ehd.SolveDynamic(mbs, settings(600))
    with pytest.raises(ehd.EHDError, match=r"'both': another record has replaced.*'\{name\}' in it"):
        _ = systems[0][1][0].history.time


def test_what_is_no_record_is_not_replaced(tmp_path):
    (tmp_path / "model.py").write_text("print('mine')\n")
    for path in (tmp_path / "model.py", "/dev/null"):
        with pytest.raises(ehd.InputError, match=r"record: .*holds something else than a record.*name another path"):
            model("main", record=ehd.File(path=path))
    assert (tmp_path / "model.py").read_text() == "print('mine')\n"
    with pytest.raises(ehd.InputError, match=r"record must be File"):
        model("main", record=str(tmp_path / "main.rows"))
    with pytest.raises(ehd.InputError, match="path must be"):
        ehd.File(path=tmp_path)


def test_a_full_disk_ends_the_run_by_name_and_leaves_the_history(tmp_path, monkeypatch):
    add, calls = RowsOnDisk.add, []

    def full(self, rows, settled):
        calls.append(1)
        if len(calls) > 2:
            monkeypatch.setattr("builtins.open", no_room)
        try:
            return add(self, rows, settled)
        finally:
            monkeypatch.setattr("builtins.open", opened)

    opened = open

    def no_room(path, mode="r", *args, **kwargs):
        if str(path).endswith("main.rows") and mode == "r+b":
            raise OSError(28, "No space left on device")
        return opened(path, mode, *args, **kwargs)

    monkeypatch.setattr(RowsOnDisk, "add", full)
    mbs, joints = model("main", record=ehd.File(path=tmp_path / "main.rows"))
    with pytest.raises(ehd.EHDError, match=r"'main': its record can't be written.*No space left.*make room"):
        ehd.SolveDynamic(mbs, settings(2000))
    # two parts are on disk, the third and the row that it stopped at are in memory
    history = joints[0].history
    assert 700 < history.time.size < 800 and np.all(np.isfinite(history.force))
