"""Points of error against time: which are worth their time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_ehd.status import InputError
from tests.benchmarks.accuracy.table import Row


def pareto_front(times: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Indices of the points that no other beats in both time and error, fastest first.

    Of points with equal time and error the first counts.
    """
    if len(times) != len(errors):
        raise InputError(f"pareto_front: times and errors must be as many, got {len(times)} and {len(errors)}.")
    front: list[int] = []
    best = np.inf
    for k in sorted(range(len(times)), key=lambda k: (times[k], errors[k], k)):
        if errors[k] < best:
            front.append(k)
            best = errors[k]
    return front


def cheapest(rows: Sequence[Row], error: float) -> Row | None:
    """The fastest row whose error with that of its reference on top is within ``error``; None if there is none."""
    within = [row for row in rows if row.timed and row.error + row.reference_error <= error]
    return min(within, key=lambda row: row.seconds, default=None)
