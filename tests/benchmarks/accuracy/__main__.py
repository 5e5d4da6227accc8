"""``python -m tests.benchmarks.accuracy``: redo the shipped tables and pictures; see ``--help``."""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
import time
from collections.abc import Callable

from exudyn_ehd.status import EHDError
from exudyn_ehd.storage import replacing
from tests.benchmarks.accuracy import catalogue, order
from tests.benchmarks.accuracy.costs import bushes, effects, growth, once
from tests.benchmarks.accuracy.errors.study import Study, machine, run_study
from tests.benchmarks.accuracy.report import guide, pictures
from tests.benchmarks.accuracy.table import DATA, Cost, Row, format_costs, format_rows, read_table, write_table

GROWTH = "growth"
# Of one setting: processor time in s after which it is not timed more than three times.
BUDGET = 2.0
# Processes that time every bore, and runs in each: seconds with a nodal bush.
BUSH_BLOCKS, BUSH_TURNS = 5, 2
DESCRIPTION = (
    "Measure what accuracy costs in time: errors against converged references, times on one thread, tables as CSV, "
    "pictures."
)


def main(arguments: list[str] | None = None) -> None:
    """Command line."""
    options = _parser().parse_args(arguments)
    if options.guide:
        guide.renew(guide.READMES, DATA, guide.PICTURE)
        return
    if options.check_order:
        _check_order(_chosen(order.checkable(), options.only), options.runs)
        return
    studies = catalogue.quick_catalogue() if options.quick else catalogue.full_catalogue()
    tables = DATA if options.ship or options.draw else options.results
    others = {} if options.quick or options.processes > 1 else _other_tables(tables, options.repeats, options.ship)
    names = _chosen([*studies, *others], options.only)
    if options.list:
        print("\n".join(names))
        return

    def measure(name: str) -> None:
        if name in others:
            others[name]()
        else:
            _measure(studies[name](), tables / f"{name}.csv", options.repeats, options.processes)

    failed = {} if options.draw else _measure_all(names, measure)
    draw([tables / f"{name}.csv" for name in names if name in studies], options.results)
    print(f"tables in {tables}, pictures in {options.results}")
    if failed:
        sys.exit("\n".join(["these tables are not renewed:", *(f"  {name}: {why}" for name, why in failed.items())]))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.accuracy", description=DESCRIPTION)
    add = parser.add_argument
    add("--quick", action="store_true", help="few rungs, about a minute")
    add("--results", type=pathlib.Path, default=pathlib.Path("results/accuracy"), help="folder")
    add("--only", nargs="*", default=[], metavar="NAME", help="what has one of these in its name; see --list")
    add("--repeats", type=int, default=5, help="timed runs per setting")
    add("--processes", type=int, default=1, help="more than 1: side by side, errors only, no times")
    add("--ship", action="store_true", help="write the tables where they are shipped")
    add("--draw", action="store_true", help="measure nothing, draw the shipped tables")
    add("--guide", action="store_true", help="put the shipped tables between the markers of the READMEs and stop")
    text = "time the shipped studies in several runs, compare the order, stop"
    add("--check-order", action="store_true", help=text)
    add("--runs", type=int, default=3, help="runs of --check-order")
    add("--list", action="store_true", help="list what there is and stop")
    return parser


def _chosen(names: list[str], parts: list[str]) -> list[str]:
    return [name for name in names if not parts or any(part in name for part in parts)]


def _measure_all(names: list[str], measure: Callable[[str], None]) -> dict[str, str]:
    """Measure table by table; returns what went wrong by name: one table that fails leaves the others alone."""
    failed = {}
    start, busy = time.perf_counter(), _processor_time()
    for k, name in enumerate(names):
        begin, busy_before = time.perf_counter(), _processor_time()
        _say(f"[{k + 1}/{len(names)}] {name}")
        try:
            measure(name)
        except (EHDError, ValueError, RuntimeError, OSError) as error:
            failed[name] = str(error).splitlines()[0] if str(error) else type(error).__name__
        now, busy_now = time.perf_counter(), _processor_time()
        _say(
            f"[{k + 1}/{len(names)}] {name}: {now - begin:.0f} s, {now - start:.0f} s in all; of the processors "
            f"{busy_now - busy_before:.0f} s, {busy_now - busy:.0f} s in all"
        )
    return failed


def _processor_time() -> float:
    """Processor time of this process and those it started, s."""
    return sum(os.times()[:4])


def _other_tables(folder: pathlib.Path, repeats: int, ship: bool) -> dict[str, Callable[[], None]]:
    """Tables that are no study of errors, by name."""
    turns = max(repeats, 3)

    def write(name: str, costs: list[Cost], note: str) -> None:
        print(format_costs(costs))
        write_table(folder / f"{name}.csv", Cost, costs, [note, f"processor time; {machine()}"])

    def all_effects() -> None:
        note = f"medians and quartiles over {turns} blocks in turns, each the best of 8 rounds"
        found = effects.measure_effects(blocks=turns, progress=_say)
        write(guide.EFFECT_FACTORS, found, f"effects over their base; {note}")

    def all_bushes() -> None:
        note = f"medians and quartiles over {BUSH_BLOCKS} processes of {BUSH_TURNS} turns"
        found = bushes.measure_bushes(blocks=BUSH_BLOCKS, turns=BUSH_TURNS, progress=_say)
        write(guide.BUSH_COSTS, found, f"bores in a run; {note}")

    def all_once() -> None:
        write(guide.PAID_ONCE, once.measure_once(progress=_say), "what is paid once; medians over 2 turns")

    def all_growths() -> None:
        found = growth.all_growths(min(repeats, 3))
        print(growth.growth_text(found))
        growth.write_growths(folder / f"{GROWTH}.csv", found, f"median processor time; {machine()}")

    return {
        guide.EFFECT_FACTORS: all_effects,
        guide.BUSH_COSTS: all_bushes,
        guide.PAID_ONCE: all_once,
        GROWTH: all_growths,
    }


def _check_order(names: list[str], runs: int) -> None:
    start = time.perf_counter()
    found = order.check_order(names, runs=runs, progress=_say)
    apart, changed = sum(c.apart for c in found), sum(len(c.changed) for c in found)
    print(f"{apart} pairs apart in {runs} runs, {changed} changed their order; {time.perf_counter() - start:.0f} s")
    if changed:
        sys.exit(1)


def _measure(study: Study, path: pathlib.Path, repeats: int, processes: int) -> None:
    rows = run_study(
        study,
        repeats=repeats,
        budget=BUDGET,
        processes=processes,
        reference_processes=os.cpu_count() or 1,
        progress=_say,
    )
    times = f"median and quartiles of {min(repeats, 3)} to {repeats} runs in turns"
    write_table(path, Row, rows, [study.title, f"time per {study.scene.per}; {machine()}; {times}"])
    print(format_rows(rows))


def draw(tables: list[pathlib.Path], folder: pathlib.Path) -> None:
    """Pictures and summary of tables that exist."""
    found = [read_table(path, Row) for path in tables if path.exists()]
    if not found:
        return
    pictures.write_pictures(folder, [(rows, notes[0], pictures.unit_of(notes)) for rows, notes in found])
    lines = pictures.summary_rows([(rows, notes[0]) for rows, notes in found])
    if lines:
        with replacing(folder / "summary.md") as file:
            file.write(pictures.summary_text(lines))
        pictures.save(pictures.summary_figure(lines, found[0][1][1].split(";")[1].strip()), folder / "summary.png")


def _say(text: str) -> None:
    print(f"  {text}", flush=True)


if __name__ == "__main__":
    main()
