"""Pictures of the shipped tables: every point of the front labelled, no label on another; the command line."""

import re

import pytest
from matplotlib.text import Annotation

from exudyn_ehd.status import FilmError
from tests.benchmarks.accuracy.__main__ import main
from tests.benchmarks.accuracy.report import pictures
from tests.benchmarks.accuracy.report.front import cheapest, pareto_front
from tests.benchmarks.accuracy.table import DATA, Cost, Row, read_table
from tests.sampling import sample


def _block(name, quantity):
    return [row for row in read_table(DATA / f"{name}.csv", Row)[0] if row.quantity == quantity]


@pytest.mark.parametrize(
    ("name", "quantity"),
    sample([("steady_800_film", "load"), ("orbit_film", "path"), ("orbit_integration", "path")], 0),
)
def test_every_point_of_the_front_is_labelled_apart(name, quantity):
    rows = _block(name, quantity)
    figure = pictures.work_precision(rows, name, "run")
    figure.draw_without_rendering()
    (axes,) = figure.axes
    labels = [a for a in axes.texts if isinstance(a, Annotation)]
    timed = [row for row in rows if row.timed]
    front = pareto_front([row.seconds for row in timed], [row.error for row in timed])
    assert {a.get_text() for a in labels} == {pictures.short_label(timed[k]) for k in front}
    boxes = [
        Annotation.get_window_extent(a) if a.arrow_patch is None else super(Annotation, a).get_window_extent()
        for a in labels
    ]
    for i, a in enumerate(boxes):
        for b in boxes[i + 1 :]:
            assert not a.overlaps(b)
    assert axes.get_xlabel().startswith("processor time per run")


def test_the_papers_settings_stand_in_the_table():
    rows = _block("steady_800_film", "load")
    (paper,) = (row for row in rows if "(paper)" in row.setting)
    best = cheapest(rows, paper.error)
    assert best.seconds < paper.seconds
    assert paper.own_error < paper.error


def test_summary():
    lines = pictures.summary_rows([(read_table(DATA / "steady_800_film.csv", Row)[0], "steady")])
    text = pictures.summary_text(lines)
    assert "| steady | load | Swift-Stieber" in text
    assert len(lines) == 7


def test_scenes_are_listed(capsys):
    main(["--list"])
    assert "orbit_film" in capsys.readouterr().out


@pytest.mark.slow
def test_pictures_are_drawn_from_the_command_line(tmp_path):
    main(["--draw", "--only", "steady_800_film", "--results", str(tmp_path)])
    assert (tmp_path / "steady_800_film_load.png").stat().st_size > 10_000
    assert (tmp_path / "summary.png").stat().st_size > 10_000
    assert "within 1 %" in (tmp_path / "summary.md").read_text()


def test_a_table_that_fails_leaves_the_others_alone(tmp_path, monkeypatch, capsys):
    """Nothing is written for it, the rest is measured, and the command says so in the end."""

    def fail(**options):
        raise FilmError("no film today")

    def one(**options):
        return [Cost(what="a", per="step", seconds=1.0, low=1.0, high=1.0)]

    monkeypatch.setattr("tests.benchmarks.accuracy.costs.effects.measure_effects", fail)
    monkeypatch.setattr("tests.benchmarks.accuracy.costs.once.measure_once", one)
    with pytest.raises(SystemExit, match="effect_factors: no film today"):
        main(["--results", str(tmp_path), "--only", "effect_factors", "paid_once"])
    assert not (tmp_path / "effect_factors.csv").exists()
    assert (tmp_path / "paid_once.csv").exists()
    assert re.search(r"\[2/2\] paid_once: \d+ s", capsys.readouterr().out)
