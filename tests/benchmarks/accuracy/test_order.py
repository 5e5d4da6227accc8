"""Tests of the order check, on made-up times, and of its choice of the rungs that are timed."""

import itertools
import math

import pytest

from tests.benchmarks.accuracy import catalogue, order
from tests.benchmarks.accuracy.__main__ import main
from tests.benchmarks.accuracy.table import DATA, Row, read_table


def _check(*tables):
    turns = iter(tables)
    return order.check("made up", lambda: next(turns), len(tables))


def test_kept_and_changed():
    apart = {"a": (1.0, 0.1), "b": (2.0, 0.1), "c": (2.1, 0.2)}
    assert _check(apart, apart, apart) == order.OrderCheck(name="made up", pairs=3, apart=2, changed=())
    swapped = apart | {"a": (3.0, 0.1)}
    found = _check(apart, swapped, apart)
    assert found.changed == (("a", "b"), ("a", "c"))
    assert "order changed: a and b; a and c" in str(found)
    # within the spreads of one run there is no order to keep
    wide = apart | {"a": (3.0, 2.0)}
    assert _check(apart, wide, apart).changed == ()
    assert order.pairs_apart([]) == {}


@pytest.mark.parametrize("name", catalogue.full_catalogue())
def test_chosen_rungs_are_few_and_apart(name):
    study = catalogue.full_catalogue()[name]()
    shipped = {row.setting: row.seconds for row in read_table(DATA / f"{name}.csv", Row)[0] if row.timed}
    chosen = order.chosen_rungs(study)
    times = [shipped[setting.label] for setting in chosen]
    assert 2 <= len(chosen) <= order.MOST
    assert sum(times) <= order.BUDGET or len(chosen) == 2
    assert all(a <= b for a, b in itertools.pairwise(times))


def test_times_of_a_study():
    study = catalogue.quick_catalogue()["steady_800_film"]()
    times = order.times_of(study, study.settings[:2], 3)
    assert set(times) == {setting.label for setting in study.settings[:2]}
    assert all(seconds > 0.0 and spread >= 0.0 and math.isfinite(spread) for seconds, spread in times.values())


def test_command_line(monkeypatch, capsys):
    def found(names, *, runs, progress):
        return [order.OrderCheck(name=n, pairs=3, apart=2, changed=(("a", "b"),) * (runs == 4)) for n in names]

    monkeypatch.setattr(order, "check_order", found)
    main(["--check-order", "--only", "steady_800"])
    # film, tilted film, closure, bush
    assert "8 pairs apart in 3 runs, 0 changed" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["--check-order", "--runs", "4"])
