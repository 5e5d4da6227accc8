"""Rows of a study: what one call returns, and the file that keeps those that are finished."""

from __future__ import annotations

import dataclasses
import json
import logging
import math
import numbers
import pathlib
import time
from collections.abc import Callable, Mapping
from typing import Any

from exudyn_ehd.status import InputError
from exudyn_ehd.storage import fingerprint

Point = dict[str, Any]
Function = Callable[[Point], Any]
_FORMAT = "exudyn_ehd parameter_study 1"


@dataclasses.dataclass(frozen=True)
class Row:
    """Result of one call.

    Attributes
    ----------
    results : dict
        Numbers by name; empty if it failed.
    error : str
        Reason of a failure, in one line; empty without one.
    seconds : float
        Wall time; nan if the call never returned.
    """

    results: dict[str, float]
    error: str = ""
    seconds: float = math.nan


def evaluated(function: Function, point: Point) -> Row:
    """Call a function at a point; what it raises becomes the row's error, so that it does not take the others along.

    The lines that runs log are left out: a study has its table.
    """
    start, log = time.perf_counter(), logging.getLogger("exudyn_ehd")
    level, results, error = log.level, {}, ""
    log.setLevel(max(level, logging.WARNING))
    try:
        results = as_numbers(function(dict(point)))
    except Exception as caught:
        error = " ".join(f"{type(caught).__name__}: {caught}".split())
    finally:
        log.setLevel(level)
    return Row(results, error, time.perf_counter() - start)


def as_numbers(value: Any) -> dict[str, float]:
    """Results of a call by name; ``value`` is the name of a single number."""
    results = value if isinstance(value, Mapping) else {"value": value}
    for name, number in results.items():
        if not isinstance(name, str) or not isinstance(number, numbers.Real):
            raise InputError(
                "parameter_study.function must return a number or a dict of numbers, got "
                f"{name!r}: {type(number).__name__}."
            )
    return {name: float(number) for name, number in results.items()}


class RowFile:
    """Rows of one study on disk, a line of JSON each, written as soon as they are finished.

    A line that was cut off with its writer is dropped. Rows that failed are not written: a second call computes them.

    Parameters
    ----------
    path : path
        New, or written by a study of the same function.
    function : callable
        Function of which the rows are results; a file of another one raises an error.
    """

    def __init__(self, path: str | pathlib.Path, function: Function) -> None:
        self._path = pathlib.Path(path)
        self._rows: dict[str, Row] = {}
        head = {"format": _FORMAT, "function": fingerprint(function)}
        text = self._path.read_bytes().decode("utf-8", "replace") if self._path.exists() else ""
        whole = text[: text.rfind("\n") + 1]
        lines = whole.splitlines()
        if not lines and not text:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._write(head)
            return
        try:
            stored = [json.loads(line) for line in lines]
            known, rows = stored[0], {_key(entry["point"]): Row(**entry["row"]) for entry in stored[1:]}
        except (ValueError, TypeError, KeyError, IndexError):
            known, rows = {}, {}
        if not isinstance(known, dict) or known.get("format") != _FORMAT:
            raise InputError(f"parameter_study.file: '{path}' holds no rows of a study; name a new file.")
        if known != head:
            raise InputError(
                f"parameter_study.file: '{path}' holds rows of another function, or of this one before it was changed; "
                "name a new file, or delete this one."
            )
        self._rows = rows
        if whole != text:
            self._path.write_text(whole, encoding="utf-8")

    def find(self, point: Point) -> Row | None:
        """The finished row of a point, if there is one."""
        return self._rows.get(_key(point))

    def add(self, point: Point, row: Row) -> None:
        """Write a row that did not fail."""
        if not row.error:
            self._write({"point": point, "row": dataclasses.asdict(row)})

    def _write(self, entry: Mapping[str, Any]) -> None:
        with open(self._path, "a", encoding="utf-8") as file:
            file.write(json.dumps(entry) + "\n")


def _key(point: Mapping[str, Any]) -> str:
    return json.dumps(point, sort_keys=True)
