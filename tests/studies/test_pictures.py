"""Pictures of the shipped tables: every point labelled, no label on another; the command line; exponents of growth."""

import pathlib

import pytest
from matplotlib.text import Annotation

from exudyn_ehd.status import InputError
from exudyn_ehd.studies import cells, growth, pictures
from exudyn_ehd.studies.__main__ import main
from exudyn_ehd.studies.front import cheapest
from exudyn_ehd.studies.table import read_rows


def _block(name, quantity):
    return [row for row in read_rows(cells.DATA / f"{name}.csv")[0] if row.quantity == quantity]


@pytest.mark.parametrize(
    ("name", "quantity"), [("steady_800_film", "load"), ("orbit_film", "path"), ("orbit_integration", "path")]
)
def test_every_point_is_labelled_apart(name, quantity):
    rows = _block(name, quantity)
    figure = pictures.work_precision(rows, name, "run")
    figure.draw_without_rendering()
    (axes,) = figure.axes
    labels = [a for a in axes.texts if isinstance(a, Annotation)]
    assert len(labels) == sum(row.timed for row in rows)
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
    lines = pictures.summary_rows([(read_rows(cells.DATA / "steady_800_film.csv")[0], "steady")])
    text = pictures.summary_text(lines)
    assert "| steady | load | Swift-Stieber" in text
    assert len(lines) == 7


def test_command_line(tmp_path, capsys):
    main(["--list"])
    assert "orbit_film" in capsys.readouterr().out
    main(["--draw", "--only", "steady_800_film", "--results", str(tmp_path)])
    assert (tmp_path / "steady_800_film_load.png").stat().st_size > 10_000
    assert (tmp_path / "summary.png").stat().st_size > 10_000
    assert "within 1 %" in (tmp_path / "summary.md").read_text()


def test_exponent():
    sizes = (10, 20, 40)
    assert growth.exponent(sizes, tuple(3e-6 * n**1.7 for n in sizes)) == pytest.approx(1.7)


def test_growth_runs(tmp_path):
    found = growth.joint_growth(1, (1, 3))
    assert found.sizes == (1, 3)
    assert 0.0 < found.seconds[0] < found.seconds[1]
    growth.write_growths(tmp_path / "growth.csv", [found], "note")
    assert (tmp_path / "growth.csv").read_text().startswith("# note\nwhat,size,n,seconds")


def test_the_guide_says_what_the_tables_say():
    guide = (pathlib.Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    assert pictures.guide_text(cells.DATA) in guide


def test_the_guide_is_renewed_and_nothing_else_of_its_file(tmp_path):
    path = tmp_path / "guide.md"
    path.write_text("# Title\n\n| scene: ladder | old |\n|---|---|\n| gone | 1 |\n\nText after.\n", encoding="utf-8")
    main(["--guide", str(path)])
    assert path.read_text(encoding="utf-8") == f"# Title\n\n{pictures.guide_text(cells.DATA)}\nText after.\n"
    path.write_text("no table", encoding="utf-8")
    with pytest.raises(InputError, match="has no table"):
        main(["--guide", str(path)])
