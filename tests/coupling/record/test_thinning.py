"""Thinned records: accepted steps as they were, none of the worst ones missing, and bounded memory."""

import tracemalloc

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record import history as rows_of
from exudyn_ehd.coupling.record.record import MOST_ROWS, Record
from tests.coupling.record.test_on_disk import Bearing, model, random_row, same, settings
from tests.sampling import sample

RULES = {
    "7 steps": ehd.Every(steps=7),
    "1000 steps": ehd.Every(steps=1000),
    "5 ms": ehd.Period(seconds=5e-3),
    "1 s": ehd.Period(seconds=1.0),
}


class OnLiner(Bearing):
    bush = ehd.ElasticLiner(thickness=5e-4, youngs_modulus=1e9)


def records(rule, path=None, bearing=Bearing):
    """A record of all rows and one that is thinned."""
    whole, thinned = Record(bearing), Record(bearing)
    thinned.thin(rule)
    if path is not None:
        thinned.keep_on_disk(path, "main")
    return whole, thinned


def require_thinned(whole, thinned, rule):
    """The rows of ``thinned`` are steps of ``whole`` with its extremes, and the errors of the steps between them."""
    at = thinned.step_count
    assert at[0] == 0 and at[-1] == whole.time.size - 1
    for name in rows_of._NAMES[:-1]:
        np.testing.assert_array_equal(getattr(thinned, name), getattr(whole, name)[at], err_msg=name)
    np.testing.assert_array_equal(
        thinned.step_error, np.fmax.reduceat(whole.step_error, np.concatenate([[0], at[:-1] + 1]))
    )
    load = np.hypot(*whole.force[:, :2].T)
    spans = rule.spans(np.arange(whole.time.size), whole.time)
    for span in np.unique(spans):
        own = np.flatnonzero(spans == span)
        kept = at[(at >= own[0]) & (at <= own[-1])]
        assert 1 <= kept.size <= 5 and kept[-1] == own[-1]
        for values in (-whole.minimum_gap, whole.peak_pressure, load):
            assert values[kept].max() == values[own].max()


@pytest.mark.slow
@pytest.mark.parametrize("on_disk", [False, True], ids=["memory", "file"])
@pytest.mark.parametrize("name", sample(list(RULES), 0, 2))
def test_any_course_gives_steps_of_the_whole_record(name, on_disk, tmp_path):
    """Repeated last times, times that run back, readings in between, tangents that are missing, a liner."""
    for seed in range(2):
        rng, rule, path = np.random.default_rng(seed), RULES[name], tmp_path / f"{seed}.rows"
        whole, thinned = records(rule, path if on_disk else None, OnLiner if seed else Bearing)
        time = 0.0
        for _ in range(1500):
            if rng.random() < 0.001:
                time *= 0.5
            elif rng.random() < 0.9:
                time += rng.uniform(1e-4, 1e-3)
            row = random_row(rng, time)
            if rng.random() < 0.3:
                row[rows_of.TANGENT.start :] = np.nan
            for record in (whole, thinned):
                record.append(row)
            if rng.random() < 0.01:
                final = random_row(rng, time + 1e-5) if rng.random() < 0.5 else None
                require_thinned(whole.snapshot(final), thinned.snapshot(final), rule)
                if on_disk:
                    require_thinned(whole.snapshot(final), ehd.load_history(path), rule)
            assert whole.thinnest == thinned.thinnest and whole.last_time == thinned.last_time
            assert len(thinned._rows) <= MOST_ROWS
        require_thinned(whole.snapshot(None), thinned.snapshot(None), rule)


def test_a_file_ends_with_the_rows_that_are_kept(tmp_path):
    """A step that is the worst in every way takes the places of three rows that the file has already."""
    rng, (_, thinned) = np.random.default_rng(0), records(RULES["1000 steps"], tmp_path / "main.rows")
    for k in range(600):
        row = random_row(rng, 1e-4 * k)
        if k == 590:
            row[rows_of.MINIMUM_GAP], row[rows_of.PEAK_PRESSURE], row[rows_of.FORCE] = 1e-7, 1e9, 1e6
        thinned.append(row)
        if k in (300, 595):
            found = thinned.snapshot(None)
            same(ehd.load_history(tmp_path / "main.rows"), found)
    assert found.step_count.tolist() == [0, 590, 595]


def test_a_restored_record_goes_on(tmp_path):
    """Steps and extremes as without the stop; errors of steps begin anew behind it."""
    for path in (None, tmp_path / "main.rows"):
        rng, rule = np.random.default_rng(5), RULES["7 steps"]
        whole, thinned = records(rule, path)
        for k in range(900):
            row = random_row(rng, 1e-4 * k)
            whole.append(row), thinned.append(row)
            if k == 500:
                stored = thinned.rows(None)
                _, thinned = records(rule, None if path is None else tmp_path / "again.rows")
                thinned.restore(stored)
                assert thinned.last_time == whole.last_time and thinned.thinnest == whole.thinnest
        found, all_steps = thinned.snapshot(None), whole.snapshot(None)
        np.testing.assert_array_equal(found.minimum_gap, all_steps.minimum_gap[found.step_count])
        assert found.minimum_gap.min() == all_steps.minimum_gap.min() and found.step_count[-1] == 899
        assert found.peak_pressure.max() == all_steps.peak_pressure.max()
        before = found.step_count <= 500
        np.testing.assert_array_equal(found.step_error[before][:-1], stored[:-1, -1][: before.sum() - 1])
    with pytest.raises(ehd.InputError, match=r"rows must be \(n, \d+\).*create the joint with the record"):
        whole.restore(stored)


@pytest.mark.slow
def test_a_thinned_run_is_that_in_memory(tmp_path, caplog):
    caplog.set_level("INFO", logger="exudyn_ehd")
    rule, path, found = ehd.Every(steps=10), tmp_path / "{name}.rows", []
    for record in (None, rule, ehd.File(path=path, every=rule)):
        mbs, (joint,) = model("main", record=record)
        ehd.SolveDynamic(mbs, settings(600), updateInitialValues=True)
        found.append(joint.history)
    whole, *thinned = found
    for history in (*thinned, ehd.load_history(tmp_path / "main.rows")):
        require_thinned(whole, history, rule)
        assert history.time.size < 0.45 * whole.time.size
    assert repr(thinned[0]).startswith(f"<JointHistory of 601 steps in {thinned[0].time.size} rows")
    lines = [record.message.split(", error")[0] for record in caplog.records]
    assert len(set(lines)) == 1 and "600 steps" in lines[0]
    part = ehd.load_history(tmp_path / "main.rows", start=0.02, end=0.03)
    same(part, thinned[0].between(0.02, 0.03))
    # a run that goes on
    late = settings(900)
    late.timeIntegration.startTime, late.timeIntegration.numberOfSteps = 0.06, 300
    ehd.SolveDynamic(mbs, late)
    assert joint.history.step_count[-1] == 900
    thinned[0].save(tmp_path / "thinned.npz")
    assert ehd.load_history(tmp_path / "thinned.npz").is_thinned


@pytest.mark.parametrize("solve", sample([ehd.SolveDynamic, ehd.SolveDynamicSparse], 1))
def test_chosen_steps_are_thinned_too(solve):
    """Rejected steps leave nothing behind."""
    rule, found = ehd.Every(steps=5), []
    for record in (None, rule):
        mbs, (joint,) = model("main", record=record)
        solve(mbs, settings(100), stepControl=ehd.StepControl(error=0.02))
        found.append(joint.history)
    require_thinned(*found, rule)


def test_a_thinned_run_goes_on_from_a_stored_state(tmp_path):
    rule, state = ehd.Period(seconds=1e-3), tmp_path / "state.npz"
    mbs, (joint,) = model("main", record=rule)
    ehd.SolveDynamic(mbs, settings(100), updateInitialValues=True)
    ehd.SaveState(mbs, state)
    first = joint.history
    mbs, (joint,) = model("main", record=rule)
    ehd.SolveDynamic(mbs, settings(50 + 100), restart=state)
    again = joint.history
    np.testing.assert_array_equal(again.minimum_gap[: first.time.size], first.minimum_gap)
    assert again.step_count[-1] > first.step_count[-1] and again.time[-1] == pytest.approx(150e-4)


def test_what_needs_all_steps_refuses_a_thinned_record():
    mbs, (joint,) = model("main", record=ehd.Every(steps=10))
    with pytest.raises(ehd.InputError, match=r"until_periodic compares all steps.*'main' keeps some"):
        ehd.SolveDynamic(mbs, settings(100), until_periodic=ehd.UntilPeriodic(period=1e-3))
    ehd.SolveDynamic(mbs, settings(100))
    with pytest.raises(ehd.InputError, match=r"audit: joint 'main' keeps .* of 101 states.*need every step"):
        joint.audit()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ehd.Every(steps=1), r"Every\.steps must be"),
        (lambda: ehd.Every(steps=2.5), r"Every\.steps must be"),
        (lambda: ehd.Period(seconds=0.0), r"Period\.seconds must be"),
        (lambda: ehd.File(path="x.rows", every=10), r"File\.every must be"),
        (lambda: model("main", record=10), r"record must be"),
    ],
)
def test_rules_that_make_no_sense_are_refused(make, words):
    with pytest.raises(ehd.InputError, match=words):
        make()


@pytest.mark.slow
def test_a_history_of_a_file_reads_what_is_asked(tmp_path):
    """A column of 57 that stays, and of others nothing."""
    whole, record = Record(Bearing), Record(Bearing)
    record.keep_on_disk(tmp_path / "main.rows", "main")
    rng = np.random.default_rng(2)
    for k in range(9000):
        row = random_row(rng, 1e-4 * k)
        whole.append(row), record.append(row)
    tracemalloc.start()
    history = record.snapshot(None)
    loaded = ehd.load_history(tmp_path / "main.rows")
    assert tracemalloc.get_traced_memory()[1] < 9000 * 8 * rows_of.WIDTH / 4
    gap = history.minimum_gap
    assert tracemalloc.get_traced_memory()[0] < 2 * 9000 * 8 + 300_000
    tracemalloc.stop()
    assert history.minimum_gap is gap
    for found in (history, loaded):
        same(found, whole.snapshot(None))
        same(found.between(0.1, 0.2), whole.snapshot(None).between(0.1, 0.2))
    with pytest.raises(AttributeError, match="no attribute 'gap'"):
        history.gap  # noqa: B018
    # a new record takes the file's place: what was read stays, what was not is told
    old = record.snapshot(None)
    pressure = old.peak_pressure
    record.clear()
    for k in range(10):
        record.append(random_row(rng, 1e-4 * k))
    record.snapshot(None)
    assert old.peak_pressure is pressure
    with pytest.raises(ehd.RunError, match="another record has replaced"):
        old.minimum_gap  # noqa: B018


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["file", "thinned file", "thinned"])
def test_memory_of_ten_joints(kind, tmp_path):
    """Growth of three records in 5 000 steps, as of ten joints in a million: some 600 MB, nothing with a file."""
    rng, found = np.random.default_rng(1), []
    for k in range(3):
        record = Record(Bearing)
        if "thinned" in kind:
            record.thin(ehd.Every(steps=60))
        if "file" in kind:
            record.keep_on_disk(tmp_path / f"{k}.rows", str(k))
        found.append(record)
    rows = [random_row(rng, 0.0) for _ in range(50)]
    tracemalloc.start()
    for k in range(7001):
        row = rows[k % 50]
        row[0] = 1e-4 * k
        for record in found:
            record.append(row)
        if k == 2000:
            before = tracemalloc.get_traced_memory()[0]
    growth = (tracemalloc.get_traced_memory()[0] - before) * (10 / 3) * (1e6 / 5e3)
    tracemalloc.stop()
    print(f"{kind}: {1e-6 * growth:.1f} MB")
    # kept rows of some 60 numbers; a chunk of rows more or less at the end counts for 20 MB
    assert growth < (620e6 if kind == "thinned" else 40e6)
