"""Rows of a study: their computation here or by an executor, and the file that keeps those that are finished."""

from __future__ import annotations

import dataclasses
import json
import math
import numbers
import pathlib
import pickle
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from contextlib import nullcontext
from typing import Any, TypeAlias

from exudyn_ehd.progress import without_lines
from exudyn_ehd.status import InputError
from exudyn_ehd.storage import fingerprint

Point = dict[str, Any]
Function = Callable[[Point], Any]
_FORMAT = "exudyn_ehd parameter_study 1"
WHERE = "parameter_study"


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


Rows: TypeAlias = Iterator[tuple[int, Row]]


def evaluated(function: Function, point: Point) -> Row:
    """Call a function at a point; what it raises becomes the row's error, so that it does not take the others along.

    The lines that runs log are left out: a study has its table.
    """
    start, results, error = time.perf_counter(), {}, ""
    try:
        with without_lines():
            results = _as_numbers(function(dict(point)))
    except Exception as caught:
        error = _in_one_line(caught)
    return Row(results, error, time.perf_counter() - start)


def _as_numbers(value: Any) -> dict[str, float]:
    """Results of a call by name; ``value`` is the name of a single number."""
    results = value if isinstance(value, Mapping) else {"value": value}
    for name, number in results.items():
        if not isinstance(name, str) or not isinstance(number, numbers.Real):
            raise InputError(
                "parameter_study.function must return a number or a dict of numbers, got "
                f"{name!r}: {type(number).__name__}."
            )
    return {name: float(number) for name, number in results.items()}


def _in_one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def rows_of(function: Function, points: Mapping[int, Point], processes: int, executor: Executor | None) -> Rows:
    """Compute the rows by an executor, in processes of this machine, or one after the other in this process.

    They come as ``(index, row)`` in the order in which they are finished.
    """
    if executor is None and processes == 1:
        yield from ((index, evaluated(function, point)) for index, point in points.items())
        return
    with ProcessPoolExecutor(processes) if executor is None else nullcontext(executor) as pool:
        yield from _on_executor(function, points, pool)


def _on_executor(function: Function, points: Mapping[int, Point], executor: Executor) -> Rows:
    """Compute the rows by an executor, which stays open; rows that have not begun are cancelled if the study ends."""
    if isinstance(executor, ProcessPoolExecutor):
        require_picklable(function)
    futures: dict[Future[Row], int] = {}
    try:
        for index, point in points.items():
            try:
                future = executor.submit(evaluated, function, point)
            except RuntimeError as error:
                # an executor that has broken, or was shut down, takes no more
                yield index, Row({}, _in_one_line(error))
                continue
            if not isinstance(future, Future):
                raise InputError(
                    f"{WHERE}: executor must hand out futures of concurrent.futures, got those of {executor!r}; of a "
                    "dask Client give client.get_executor()."
                )
            futures[future] = index
        for future in as_completed(futures):
            lost: BaseException | None = CancelledError("by the executor") if future.cancelled() else future.exception()
            yield futures[future], future.result() if lost is None else Row({}, _in_one_line(lost))
    finally:
        for future in futures:
            future.cancel()


def require_executor(executor: object) -> None:
    """Raise `InputError` for an object that is no executor, and for threads."""
    if not callable(getattr(executor, "submit", None)):
        raise InputError(
            f"{WHERE}: executor must have a method submit like those of concurrent.futures, got {executor!r}."
        )
    if isinstance(executor, ThreadPoolExecutor):
        raise InputError(
            f"{WHERE}: executor must compute in processes, got {type(executor).__name__}: threads of one process take "
            "turns in Python and share its log; use concurrent.futures.ProcessPoolExecutor(...)."
        )


def require_picklable(function: Any) -> None:
    """Raise `InputError` for a function that can't be sent to other processes."""
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise InputError(
            f"{WHERE}.function can't be sent to other processes ({error}); define it at the top of a module, not as a "
            "lambda or inside another function."
        ) from None


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
        if not text:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._write(head)
            return
        whole = text[: text.rfind("\n") + 1]
        try:
            known, *stored = (json.loads(line) for line in whole.splitlines())
            self._rows = {_key(entry["point"]): Row(**entry["row"]) for entry in stored}
            is_study = known["format"] == _FORMAT
        except (ValueError, TypeError, KeyError):
            is_study = False
        if not is_study:
            raise InputError(f"parameter_study.file: '{path}' holds no rows of a study; name a new file.")
        if known != head:
            raise InputError(
                f"parameter_study.file: '{path}' holds rows of another function, or of this one before it was changed; "
                "name a new file, or delete this one."
            )
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
