"""Writes the table of kernels that first films compile: ``python -m tests.benchmarks.first_films``.

Every film runs in a process of its own with an empty cache, and every compilation is noted with its callees and its
time. The kernel that takes longest together with all that waits for it comes first.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from typing import Any

from numba.core import types
from numba.core.types.containers import BaseTuple

import exudyn_ehd as ehd
from exudyn_ehd.__main__ import FILM, run_bodies
from exudyn_ehd.kernels.ahead import HELPER_VARIABLE, PACKAGE, SCALARS, TABLE, find

SIZE = {"journal_radius": 0.01, "length": 0.02, "radial_clearance": 20e-6}
FILMS = ("swift", "elrod", "bodies")
CAVITATION = {"swift": ehd.SwiftStieber(), "elrod": ehd.ElrodAdams(cavity_pressure=-1e5)}

LETTERS = {kind: letter for letter, kind in SCALARS.items()}

Note = dict[str, Any]


def write_type(kind: types.Type) -> str:
    """Text of the type of an argument, which `read_types` reads.

    Raises
    ------
    ValueError
        For a type that no kernel of the table has.
    """
    if kind in LETTERS:
        return LETTERS[kind]
    if isinstance(kind, BaseTuple):
        items = " ".join(write_type(item) for item in kind)
        cls = getattr(kind, "instance_class", tuple)
        name = "" if cls is tuple else f"{cls.__module__.removeprefix(f'{PACKAGE}.')}:{cls.__qualname__}"
        return f"{name}({items})"
    if (
        isinstance(kind, types.Array)
        and kind.mutable
        and kind.aligned
        and kind.layout in "CA"
        and kind.dtype in LETTERS
    ):
        return f"{LETTERS[kind.dtype]}{kind.ndim}{'A' if kind.layout == 'A' else ''}"
    raise ValueError(f"write_type: no text for {kind}")


def note_compilations() -> list[Note]:
    """A list that numba's compilations of the package's kernels fill from now on."""
    from numba.core import dispatcher

    found: list[Note] = []
    stack: list[Note] = []
    compile_one, call = dispatcher._FunctionCompiler.compile, dispatcher.Dispatcher.get_call_template

    def name(function: Any) -> str:
        return f"{function.__module__.removeprefix(f'{PACKAGE}.')}:{function.__name__}"

    def noted(self: Any, arguments: tuple[Any, ...], return_type: Any) -> Any:
        note: Note = {"function": name(self.py_func), "after": [], "inner": 0.0}
        stack.append(note)
        start = time.process_time()
        try:
            return compile_one(self, arguments, return_type)
        finally:
            stack.pop()
            duration = time.process_time() - start
            note["own"] = duration - note.pop("inner")
            if stack:
                stack[-1]["inner"] += duration
            if self.py_func.__module__.startswith(PACKAGE):
                note["arguments"] = write_arguments(arguments)
                found.append(note)

    def called(self: Any, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        if stack:
            stack[-1]["after"].append(name(self.py_func))
        return call(self, arguments, keywords)

    dispatcher._FunctionCompiler.compile, dispatcher.Dispatcher.get_call_template = noted, called
    return found


def write_arguments(arguments: tuple[Any, ...]) -> str | None:
    """Text of the types of arguments; None if the table can't have them."""
    try:
        return " ".join(write_type(kind) for kind in arguments)
    except ValueError:
        return None


def run_film(cavitation: str) -> None:
    """A steady film."""
    bearing = ehd.JournalBearing(**SIZE, lubricant=ehd.Lubricant(viscosity=0.02), cavitation=CAVITATION[cavitation])
    ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.7)


def notes_of(film: str) -> list[Note]:
    """Kernels that a film compiles, as noted by a process with an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": folder, HELPER_VARIABLE: "0"}
        call = [sys.executable, "-m", "tests.benchmarks.first_films", film]
        text = subprocess.run(call, env=environment, capture_output=True, text=True, check=True).stdout
    return json.loads(text.splitlines()[-1])


def _is_kernel(name: str) -> bool:
    """Return whether a module has a kernel of this name; one made within a function has none."""
    try:
        return hasattr(find(name), "signatures")
    except AttributeError:
        return False


def lines_of(notes: dict[str, list[Note]]) -> list[str]:
    """The table: what both films need is ``film``, what one of them needs has its name."""
    found: dict[tuple[str, str], Note] = {}
    users: dict[tuple[str, str], set[str]] = {}
    for film, of_film in notes.items():
        for note in of_film:
            if note["arguments"] is not None and _is_kernel(note["function"]):
                key = note["function"], note["arguments"]
                users.setdefault(key, set()).add(film)
                found.setdefault(key, note)
    names = {function for function, _ in found}
    callers = {name: [key for key, note in found.items() if name in note["after"]] for name in names}

    def path(key: tuple[str, str]) -> float:
        """Time of a kernel and of the longest row of those that wait for it, s."""
        return float(found[key]["own"]) + max(
            (path(other) for other in callers[key[0]] if other[0] != key[0]), default=0
        )

    lines = []
    for key in sorted(found, key=path, reverse=True):
        of = users[key]
        group = "film" if {"swift", "elrod"} <= of else next(film for film in notes if film in of)
        after = sorted(set(found[key]["after"]) & names - {key[0]})
        lines.append(f"{group} | {key[0]} | {key[1]} | {' '.join(after)}".rstrip())
    return lines


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
