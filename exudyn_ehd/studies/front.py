"""Points of error against time: which are worth their time, and whether their order is kept."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

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
    times = [{r.setting: (r.seconds, r.spread) for r in reversed(rows) if r.timed} for rows in tables]
    return [pair for pair, kept in pairs_apart(times).items() if not kept]


def pairs_apart(tables: Sequence[Mapping[str, tuple[float, float]]]) -> dict[tuple[str, str], bool]:
    """Pairs whose times differ by more than both spreads in every table; True if with one sign in all of them.

    Parameters
    ----------
    tables : sequence of mappings
        Time and spread by name, s; names that are missing in one table don't count.
    """
    names = sorted(set.intersection(*(set(table) for table in tables))) if tables else []
    out = {}
    for a, b in itertools.combinations(names, 2):
        differences = [table[a][0] - table[b][0] for table in tables]
        if all(abs(d) > table[a][1] + table[b][1] for d, table in zip(differences, tables, strict=True)):
            out[a, b] = max(differences) < 0.0 or min(differences) > 0.0
    return out
