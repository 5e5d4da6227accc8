"""Run the hard cases and the film solver's record, and print their tables.

    python tests/hard_cases/report.py                       # all cases, 2000 random states per closure
    python tests/hard_cases/report.py --states 100000       # the long record
    python tests/hard_cases/report.py --states 100000 --write

``--only TEXT`` picks cases, ``--write`` replaces what stands between the markers of README.md beside this file.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import pathlib
import re
import sys
import warnings

HERE = pathlib.Path(__file__).resolve().parent
GUIDE = HERE / "README.md"
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import hard_random  # noqa: E402
import hard_registry  # noqa: E402

# Warnings that the tests expect of odd sizes, as their settings name them.
EXPECTED = re.findall(r'"ignore:(.*?):UserWarning"', (HERE.parents[1] / "pyproject.toml").read_text(encoding="utf-8"))
SEED = 20
SHORT = 2000


def case_rows(only: str) -> tuple[list[str], bool]:
    """One line per case; whether all passed."""
    rows, good = [], True
    for case in hard_registry.load_cases():
        if only not in case.name:
            continue
        try:
            # Exudyn announces the failures that some cases ask for
            with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
                warnings.simplefilter("error")
                for message in EXPECTED:
                    warnings.filterwarnings("ignore", message, UserWarning)
                o = hard_registry.perform(case)
        except Exception as error:
            good = False
            rows.append(f"| {case.name} | **fail**: {str(error)[:60] or type(error).__name__} | | | | | |")
        else:
            gap = f"{1e6 * o.minimum_gap:.3g}"
            rows.append(f"| {case.name} | pass | {gap} | {o.steps} | {o.rejected} | {o.newton:.1f} | {o.seconds:.1f} |")
        print(rows[-1], flush=True)
    return rows, good


def record_rows(states: int) -> tuple[list[str], bool]:
    """One line per closure; whether there were no failures."""
    rows, good = [], True
    for name, campaign in hard_random.CAMPAIGNS.items():
        r = campaign(states, SEED)
        good = good and not r.failures
        closure = re.sub(r"^\w+", r"`\g<0>`", name)
        rows.append(
            f"| {closure} | {r.states} | {r.failures} | {r.solid} | {r.worst} | {r.mean:.1f} | {r.balance:.0e} | "
            f"{1e3 * r.seconds / r.states:.2f} |"
        )
        print(rows[-1], flush=True)
        for failed in r.failed:
            if failed[0] != hard_random.SOLID:
                print("   ", failed, file=sys.stderr)
    return rows, good


CASE_HEAD = [
    "| case | | minimum film thickness, µm | steps | rejected | Newton / step | s |",
    "|---|---|---|---|---|---|---|",
]
RECORD_HEAD = [
    "| closure | states | failures | oil solid | worst | mean | balance | ms |",
    "|---|---|---|---|---|---|---|---|",
]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--states", type=int, default=SHORT, help="random states per closure; 0: none, a written record stays"
    )
    parser.add_argument("--only", default="", help="cases whose name contains this text")
    parser.add_argument("--write", action="store_true", help="put the tables into README.md beside this file")
    arguments = parser.parse_args()
    if arguments.write and arguments.only:
        parser.error("--write needs all cases; leave --only out")
    print(*CASE_HEAD, sep="\n")
    cases, passed = case_rows(arguments.only)
    records, solved = [], True
    if arguments.states:
        print("\n" + "\n".join(RECORD_HEAD))
        records, solved = record_rows(arguments.states)
    if arguments.write:
        text = GUIDE.read_text(encoding="utf-8")
        tables = [("hard cases", CASE_HEAD + cases)] + [("film record", RECORD_HEAD + records)] * bool(arguments.states)
        for key, lines in tables:
            marked = re.compile(rf"(<!-- {key} -->\n).*?(<!-- end -->)", re.DOTALL)
            if not marked.search(text):
                raise SystemExit(f"{GUIDE} has no marker <!-- {key} -->")
            text = marked.sub(lambda m, lines=lines: m.group(1) + "\n".join(lines) + "\n" + m.group(2), text)
        GUIDE.write_text(text, encoding="utf-8")
    return 0 if passed and solved else 1


if __name__ == "__main__":
    sys.exit(main())
