"""Points of error against time: which are worth their time, and whether their order is kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_ehd.status import InputError
from exudyn_ehd.studies.table import Row


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


def order_changes(tables: Sequence[Sequence[Row]]) -> list[tuple[str, str]]:
    """Pairs of settings whose times differ by more than both spreads in every table, yet not with one sign.

    Parameters
    ----------
    tables : sequence of sequences of Row
        The same rows from several runs; a setting's time is taken from its first row.
    """
    times = [{row.setting: row for row in reversed(rows) if row.timed} for rows in tables]
    names = sorted(set.intersection(*(set(t) for t in times))) if times else []
    changed = []
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            differences = [t[a].seconds - t[b].seconds for t in times]
            apart = all(abs(d) > t[a].spread + t[b].spread for d, t in zip(differences, times, strict=True))
            if apart and min(differences) < 0.0 < max(differences):
                changed.append((a, b))
    return changed
