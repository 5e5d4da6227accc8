"""``python -m exudyn_ehd.studies``: redo the shipped tables and pictures; see ``--help``."""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
import time
from collections.abc import Callable

from exudyn_ehd.status import EHDError
from exudyn_ehd.studies import (
    bush_costs,
    catalogue,
    cells,
    effect_costs,
    growth,
    guide,
    once_costs,
    order,
    pictures,
)
from exudyn_ehd.studies.costs import Cost, format_costs, write_costs
from exudyn_ehd.studies.study import Study, machine, run_study
from exudyn_ehd.studies.table import format_rows, read_rows, write_atomic, write_rows

DATA = cells.DATA
CELLS, GROWTH = "cells", "growth"
# Of one setting: processor time in s after which it is not timed more than three times.
BUDGET = 2.0
# Processes that time every bore, and runs in each: seconds with a nodal bush.
BUSH_BLOCKS, BUSH_TURNS = 5, 2


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
        "--guide",
        type=pathlib.Path,
        metavar="README",
        help="put the shipped tables between this file's markers and stop",
    )
    parser.add_argument(
        "--check-order", action="store_true", help="time the shipped studies in several runs, compare the order, stop"
    )
    parser.add_argument("--runs", type=int, default=3, help="runs of --check-order")
    parser.add_argument("--list", action="store_true", help="list what there is and stop")
    options = parser.parse_args(arguments)
    if options.guide:
        guide.renew(options.guide, DATA)
        return
    if options.check_order:
        _check_order(_chosen(order.checkable(), options.only), options.runs)
        return
    studies = catalogue.quick_catalogue() if options.quick else catalogue.full_catalogue()
    tables = DATA if options.ship or options.draw else options.results
    others = {} if options.quick or options.processes > 1 else _other_tables(tables, options.repeats)
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
    """Of this process and those it started, s."""
    return sum(os.times()[:4])


def _other_tables(folder: pathlib.Path, repeats: int) -> dict[str, Callable[[], None]]:
    """Tables that are no study of errors, by name."""
    turns = max(repeats, 3)

    def write(name: str, costs: list[Cost], note: str) -> None:
        print(format_costs(costs))
        write_costs(folder / f"{name}.csv", costs, [note, f"processor time; {machine()}"])

    def all_cells() -> None:
        note = (
            f"errors: worst over 8 directions, with the reference's own; time per evaluation with tangent; {machine()}"
        )
        cells.measure_all(folder, _say, note)

    def all_growths() -> None:
        found = growth.all_growths(min(repeats, 3))
        print(growth.growth_text(found))
        growth.write_growths(folder / f"{GROWTH}.csv", found, f"median processor time; {machine()}")

    return {
        guide.EFFECT_FACTORS: lambda: write(
            guide.EFFECT_FACTORS,
            effect_costs.measure_effects(blocks=turns, progress=_say),
            f"effects over their base; medians and quartiles over {turns} blocks in turns, each the best of 8 rounds",
        ),
        guide.BUSH_COSTS: lambda: write(
            guide.BUSH_COSTS,
            bush_costs.measure_bushes(blocks=BUSH_BLOCKS, turns=BUSH_TURNS, progress=_say),
            f"bores in a run; medians and quartiles over {BUSH_BLOCKS} processes of {BUSH_TURNS} turns",
        ),
        guide.PAID_ONCE: lambda: write(
            guide.PAID_ONCE, once_costs.measure_once(progress=_say), "what is paid once; medians over 2 turns"
        ),
        CELLS: all_cells,
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
    beside = os.cpu_count() or 1
    rows = run_study(
        study, repeats=repeats, budget=BUDGET, processes=processes, reference_processes=beside, progress=_say
    )
    times = f"median and quartiles of {min(repeats, 3)} to {repeats} runs in turns"
    write_rows(path, rows, [study.title, f"time per {study.scene.per}; {machine()}; {times}"])
    print(format_rows(rows))


def draw(tables: list[pathlib.Path], folder: pathlib.Path) -> None:
    """Pictures and summary of tables that exist."""
    found = [read_rows(path) for path in tables if path.exists()]
    if not found:
        return
    pictures.write_pictures(folder, [(rows, notes[0], pictures.unit_of(notes)) for rows, notes in found])
    lines = pictures.summary_rows([(rows, notes[0]) for rows, notes in found])
    if lines:
        write_atomic(folder / "summary.md", pictures.summary_text(lines))
        pictures.save(pictures.summary_figure(lines, found[0][1][1].split(";")[1].strip()), folder / "summary.png")


def main_text() -> str:
    """What the command does."""
    return "Measure what accuracy costs in time: errors against converged references, times on one thread, tables as CSV, pictures."


def _say(text: str) -> None:
    print(f"  {text}", flush=True)


if __name__ == "__main__":
    main()
