"""Tables survive the disk; fronts and the cheapest setting on made-up points."""

import dataclasses
import math

import pytest

from exudyn_ehd.status import InputError
from exudyn_ehd.tables import format_seconds
from tests.benchmarks.accuracy.report.front import cheapest, pareto_front
from tests.benchmarks.accuracy.table import Row, format_rows, read_table, write_table


def _row(setting="a", seconds=1.0, error=0.1, spread=0.0, **more):
    return Row(
        study="s",
        setting=setting,
        family="f",
        model="m",
        quantity="load",
        unit="N",
        value=12.5,
        error=error,
        reference="m",
        reference_error=1e-4,
        seconds=seconds,
        low=seconds - spread,
        high=seconds + spread,
        **more,
    )


def _same(a, b):
    for x, y in zip(dataclasses.astuple(a), dataclasses.astuple(b), strict=True):
        assert x == y or (math.isnan(x) and math.isnan(y))


def test_round_trip(tmp_path):
    rows = [
        _row(setting='comma, "quote"', seconds=1.23456e-5, newton=2.25),
        _row(failure="FilmError: x, y", error=math.nan),
    ]
    path = tmp_path / "deep" / "table.csv"
    write_table(path, Row, rows, ["title, with comma", "machine"])
    back, notes = read_table(path, Row)
    assert notes == ["title, with comma", "machine"]
    for row, again in zip(rows, back, strict=True):
        _same(row, again)
    # six digits are stable: writing what was read gives the same file
    write_table(tmp_path / "again.csv", Row, back, notes)
    assert (tmp_path / "again.csv").read_bytes() == path.read_bytes()


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "table.csv"
    write_table(path, Row, [_row("old")])
    old = path.read_bytes()

    def fail(*_):
        raise OSError("disk full")

    monkeypatch.setattr("exudyn_ehd.storage.os.replace", fail)
    with pytest.raises(OSError, match="disk full"):
        write_table(path, Row, [_row("new")])
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


def test_refuses_other_columns(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="columns"):
        read_table(path, Row)


def test_text():
    text = format_rows([_row(), _row(setting="b", failure="FilmError: no film", error=math.nan)])
    assert "itself good to 0.01 %" in text
    assert "FilmError: no film" in text
    assert [format_seconds(t) for t in (2.0, 3.4e-3, 2.1e-6, 5e-8)] == ["2 s", "3.4 ms", "2.1 us", "50 ns"]


def test_pareto_front():
    times, errors = [1.0, 2.0, 3.0, 2.5, 1.0], [0.1, 0.05, 0.06, 0.05, 0.2]
    assert pareto_front(times, errors) == [0, 1]
    assert pareto_front([], []) == []
    with pytest.raises(InputError):
        pareto_front([1.0], [])


def test_cheapest_counts_the_references_error():
    rows = [
        _row("fast", 1.0, 0.0099),
        _row("faster", 0.5, 0.00995),
        _row("slow", 2.0, 1e-3),
        _row("untimed", math.nan, 0.0),
    ]
    assert cheapest(rows, 0.01).setting == "fast"
    assert cheapest(rows, 0.1).setting == "faster"
    assert cheapest(rows, 1e-5) is None
