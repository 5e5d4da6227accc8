"""``python -m exudyn_ehd.studies``: redo the shipped tables and pictures; see ``--help``."""

from __future__ import annotations

import argparse
import pathlib
import time

from exudyn_ehd.status import InputError
from exudyn_ehd.studies import catalogue, cells, growth, pictures
from exudyn_ehd.studies.study import Study, machine, run_study
from exudyn_ehd.studies.table import format_rows, read_rows, write_atomic, write_rows

DATA = cells.DATA
CELLS, GROWTH = "cells", "growth"


def main(arguments: list[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m exudyn_ehd.studies", description=main_text())
    parser.add_argument("--quick", action="store_true", help="few rungs, about a minute")
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results/studies"), help="folder")
    parser.add_argument(
        "--only", nargs="*", default=[], metavar="NAME", help="what has one of these in its name; see --list"
    )
    parser.add_argument("--repeats", type=int, default=5, help="timed runs per setting")
    parser.add_argument("--processes", type=int, default=1, help="more than 1: side by side, errors only, no times")
    parser.add_argument("--ship", action="store_true", help="write the tables into the package's data")
    parser.add_argument("--draw", action="store_true", help="measure nothing, draw the shipped tables")
    parser.add_argument(
        "--guide", type=pathlib.Path, metavar="README", help="renew the guide's table in this file and stop"
    )
    parser.add_argument("--list", action="store_true", help="list what there is and stop")
    options = parser.parse_args(arguments)
    studies = catalogue.quick_catalogue() if options.quick else catalogue.full_catalogue()
    extra = [] if options.quick or options.processes > 1 else [CELLS, GROWTH]
    names = [n for n in [*studies, *extra] if not options.only or any(part in n for part in options.only)]
    if options.list:
        print("\n".join(names))
        return
    if options.guide:
        renew_guide(options.guide)
        return
    tables = DATA if options.ship or options.draw else options.results
    start = time.perf_counter()
    for k, name in enumerate([] if options.draw else names):
        _say(f"[{k + 1}/{len(names)}] {name}, {time.perf_counter() - start:.0f} s so far")
        if name == CELLS:
            cells.measure_all(
                tables, _say, f"errors with those of their references; time per evaluation with tangent; {machine()}"
            )
        elif name == GROWTH:
            found = growth.all_growths(options.repeats)
            print(growth.growth_text(found))
            growth.write_growths(tables / f"{GROWTH}.csv", found, f"median processor time; {machine()}")
        else:
            _measure(studies[name](), tables / f"{name}.csv", options.repeats, options.processes)
    draw([tables / f"{name}.csv" for name in names if name in studies], options.results)
    print(f"tables in {tables}, pictures in {options.results}, {time.perf_counter() - start:.0f} s")


def _measure(study: Study, path: pathlib.Path, repeats: int, processes: int) -> None:
    rows = run_study(study, repeats=repeats, budget=4.0, processes=processes, progress=_say)
    times = f"median and quartiles of {min(repeats, 3)} to {repeats} runs in turns"
    write_rows(path, rows, [study.title, f"time per {study.scene.per}; {machine()}; {times}"])
    print(format_rows(rows))


def draw(tables: list[pathlib.Path], folder: pathlib.Path) -> None:
    """Pictures and summary of tables that exist."""
    found = [read_rows(path) for path in tables if path.exists()]
    if not found:
        return
    pictures.write_pictures(
        folder, [(rows, notes[0], notes[1].split(";")[0].removeprefix("time per ")) for rows, notes in found]
    )
    lines = pictures.summary_rows([(rows, notes[0]) for rows, notes in found])
    if lines:
        write_atomic(folder / "summary.md", pictures.summary_text(lines))
        pictures.save(pictures.summary_figure(lines, found[0][1][1].split(";")[1].strip()), folder / "summary.png")


def renew_guide(path: pathlib.Path) -> None:
    """Put the table of the shipped data in place of the one in a Markdown file."""
    before, head, rest = path.read_text(encoding="utf-8").partition(f"| {pictures.HEADINGS[0]} |")
    if not head:
        raise InputError(f"--guide: {path} has no table that begins with '| {pictures.HEADINGS[0]} |'.")
    after = rest.partition("\n\n")[2]
    write_atomic(path, f"{before}{pictures.guide_text(DATA)}\n{after}")


def main_text() -> str:
    """What the command does."""
    return "Measure what accuracy costs in time: errors against converged references, times on one thread, tables as CSV, pictures."


def _say(text: str) -> None:
    print(f"  {text}", flush=True)


if __name__ == "__main__":
    main()
