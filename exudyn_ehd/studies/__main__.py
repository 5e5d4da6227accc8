"""``python -m exudyn_ehd.studies``: redo the shipped tables and pictures; see ``--help``."""

from __future__ import annotations

import argparse
import pathlib
import time

from exudyn_ehd.studies import catalogue
from exudyn_ehd.studies.study import machine, run_study
from exudyn_ehd.studies.table import format_rows, write_rows

DATA = pathlib.Path(__file__).parent / "data"


def main(arguments: list[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m exudyn_ehd.studies", description=main_text())
    parser.add_argument("--quick", action="store_true", help="few rungs, about a minute")
    parser.add_argument(
        "--results", type=pathlib.Path, help="folder; default results/studies, with --ship the package's data"
    )
    parser.add_argument(
        "--only", nargs="*", default=[], metavar="NAME", help="studies whose name contains one of these"
    )
    parser.add_argument("--repeats", type=int, default=7, help="timed runs per setting")
    parser.add_argument("--processes", type=int, default=1, help="more than 1: side by side, errors only, no times")
    parser.add_argument("--ship", action="store_true", help="write into the package's data")
    parser.add_argument("--list", action="store_true", help="list the studies and stop")
    options = parser.parse_args(arguments)
    studies = catalogue.quick_catalogue() if options.quick else catalogue.full_catalogue()
    names = [n for n in studies if not options.only or any(part in n for part in options.only)]
    if options.list:
        print("\n".join(names))
        return
    folder = options.results or (DATA if options.ship else pathlib.Path("results/studies"))
    start = time.perf_counter()
    for k, name in enumerate(names):
        print(f"[{k + 1}/{len(names)}] {name}, {time.perf_counter() - start:.0f} s so far", flush=True)
        study = studies[name]()
        rows = run_study(study, repeats=options.repeats, budget=4.0, processes=options.processes, progress=_say)
        notes = [
            study.title,
            f"time per {study.scene.per}; {machine()}; median and quartiles of up to {options.repeats} runs in turns",
        ]
        write_rows(folder / f"{name}.csv", rows, notes)
        print(format_rows(rows))
    print(f"tables in {folder}, {time.perf_counter() - start:.0f} s")


def main_text() -> str:
    """What the command does."""
    return (
        "Measure what accuracy costs in time: errors against converged references, times on one thread, tables as CSV."
    )


def _say(text: str) -> None:
    print(f"  {text}", flush=True)


if __name__ == "__main__":
    main()
