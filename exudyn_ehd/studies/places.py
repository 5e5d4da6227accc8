"""Computation of the rows of a study in this process or by an executor.

Rows come as ``(index, row)`` in the order in which they are finished.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from contextlib import nullcontext
from typing import Any

from exudyn_ehd.status import InputError
from exudyn_ehd.studies.rows import Function, Point, Row, evaluated

Rows = Iterator[tuple[int, Row]]
_WHERE = "parameter_study"
# Largest number of parts in which rows go to an executor: with more, sending takes longer; with fewer, the slowest
# worker ends later than the others.
_MOST_PARTS = 512


def rows_of(function: Function, points: Mapping[int, Point], processes: int, executor: Executor | None) -> Rows:
    """Compute the rows by an executor, in processes of this machine, or one after the other in this process."""
    if executor is None and processes == 1:
        yield from ((index, evaluated(function, point)) for index, point in points.items())
        return
    with ProcessPoolExecutor(processes) if executor is None else nullcontext(executor) as pool:
        yield from _on_executor(function, points, pool)


def _on_executor(function: Function, points: Mapping[int, Point], executor: Executor) -> Rows:
    """Compute the rows by an executor, which stays open; rows that have not begun are cancelled if the study ends.

    Many rows go in parts, so that sending them takes no share of the time.
    """
    if isinstance(executor, ProcessPoolExecutor):
        require_picklable(function)
    order, size = list(points), math.ceil(len(points) / _MOST_PARTS)
    parts: dict[Future[list[Row]], list[int]] = {}
    try:
        for k in range(0, len(order), size):
            part = order[k : k + size]
            try:
                future = executor.submit(_all_evaluated, function, [points[index] for index in part])
            except RuntimeError as error:
                # an executor that has broken, or was shut down, takes no more
                yield from ((index, Row({}, _lost(error))) for index in part)
                continue
            if not isinstance(future, Future):
                raise InputError(
                    f"{_WHERE}: executor must hand out futures of concurrent.futures, got those of {executor!r}; of a "
                    "dask Client give client.get_executor()."
                )
            parts[future] = part
        for future in as_completed(parts):
            lost: BaseException | None = CancelledError("by the executor") if future.cancelled() else future.exception()
            rows = future.result() if lost is None else [Row({}, _lost(lost))] * len(parts[future])
            yield from zip(parts[future], rows, strict=True)
    finally:
        for future in parts:
            future.cancel()


def _all_evaluated(function: Function, points: list[Point]) -> list[Row]:
    return [evaluated(function, point) for point in points]


def _lost(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def require_executor(executor: object) -> None:
    """Raise `InputError` for an object that is no executor, and for threads."""
    if not callable(getattr(executor, "submit", None)):
        raise InputError(
            f"{_WHERE}: executor must have a method submit like those of concurrent.futures, got {executor!r}."
        )
    if isinstance(executor, ThreadPoolExecutor):
        raise InputError(
            f"{_WHERE}: executor must compute in processes, got {type(executor).__name__}: threads of one process take "
            "turns in Python and share its log; use concurrent.futures.ProcessPoolExecutor(...)."
        )


def require_picklable(function: Any) -> None:
    """Raise `InputError` for a function that can't be sent to other processes."""
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise InputError(
            f"{_WHERE}.function can't be sent to other processes ({error}); define it at the top of a module, not as a "
            "lambda or inside another function."
        ) from None
