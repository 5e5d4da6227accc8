"""Writes the table of kernels that first films compile: ``python -m tests.benchmarks.first_films``.

Every film runs in a process of its own with an empty cache, and every compilation is noted. A line of
``first_films.txt`` has a group, a kernel as ``module:function`` and the types of its arguments, as numba writes them.
"""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
import sys
import tempfile
from typing import Any

import exudyn_ehd as ehd
from exudyn_ehd.__main__ import FILM, run_bodies

TABLE = pathlib.Path(__file__).parent / "first_films.txt"
PACKAGE = "exudyn_ehd."
SIZE = {"journal_radius": 0.01, "length": 0.02, "radial_clearance": 20e-6}
FILMS = ("swift", "elrod", "bodies")
CAVITATION = {"swift": ehd.SwiftStieber(), "elrod": ehd.ElrodAdams(cavity_pressure=-1e5)}

Note = tuple[str, str]


def note_compilations() -> list[Note]:
    """A list that numba's compilations of the package's kernels fill from now on: kernel, and types of arguments."""
    from numba.core import dispatcher

    found: list[Note] = []
    compile_one = dispatcher._FunctionCompiler.compile

    def noted(self: Any, arguments: tuple[Any, ...], return_type: Any) -> Any:
        if self.py_func.__module__.startswith(PACKAGE):
            name = f"{self.py_func.__module__.removeprefix(PACKAGE)}:{self.py_func.__name__}"
            found.append((name, ", ".join(map(str, arguments))))
        return compile_one(self, arguments, return_type)

    dispatcher._FunctionCompiler.compile = noted
    return found


def run_film(cavitation: str) -> None:
    """A steady film."""
    bearing = ehd.JournalBearing(**SIZE, lubricant=ehd.Lubricant(viscosity=0.02), cavitation=CAVITATION[cavitation])
    ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.7)


def notes_of(film: str) -> list[Note]:
    """Kernels that a film compiles, as noted by a process with an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        call = [sys.executable, "-m", "tests.benchmarks.first_films", film]
        environment = os.environ | {"NUMBA_CACHE_DIR": folder}
        text = subprocess.run(call, env=environment, capture_output=True, text=True, check=True).stdout
    return [(name, arguments) for name, arguments in json.loads(text.splitlines()[-1])]


def lines_of(notes: dict[str, list[Note]]) -> list[str]:
    """The table: what both films need is ``film``, what one of them needs has its name."""
    users: dict[Note, list[str]] = {}
    for film, of_film in notes.items():
        for note in of_film:
            users.setdefault(note, []).append(film)
    groups = {note: "film" if {"swift", "elrod"} <= set(of) else of[0] for note, of in users.items()}
    return sorted(f"{group} | {name} | {arguments}" for (name, arguments), group in groups.items())


if __name__ == "__main__":
    if len(sys.argv) > 1:
        seen = note_compilations()
        if sys.argv[1] == "bodies":
            run_bodies(FILM)
        else:
            run_film(sys.argv[1])
        print()
        print(json.dumps(seen))
    else:
        every = {film: notes_of(film) for film in FILMS}
        TABLE.write_text("\n".join(lines_of(every)) + "\n", encoding="utf-8")
