"""Check of the shipped tables: the order of their times is reproducible.

Points whose times differ by more than both spreads must keep their order over several runs. Every study is timed anew
on some of its rungs, a few seconds each; errors need no check, since they are reproducible to rounding.
"""

from __future__ import annotations

import itertools
import pathlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.benchmarks.accuracy import catalogue
from tests.benchmarks.accuracy.costs import effects
from tests.benchmarks.accuracy.errors.study import Progress, Study
from tests.benchmarks.accuracy.scenes.setting import Setting
from tests.benchmarks.accuracy.table import DATA, Row, read_table

Times = Mapping[str, tuple[float, float]]
# Of one study: rungs, and the sum of their shipped times, s; two rungs are timed in any case.
MOST, BUDGET = 6, 1.2
EFFECTS = "effect_factors"
CHECKED_EFFECTS = ("`Gumbel`", "`ElrodAdams`", "`PatirCheng`", "`FilmEnergy`", "`ElasticLiner`", "`ShortBearing`")


@dataclass(frozen=True, kw_only=True)
class OrderCheck:
    """Outcome for one study.

    Attributes
    ----------
    name : str
    pairs : int
        All of the timed rungs.
    apart : int
        Of these, those whose times differ by more than both spreads in every run.
    changed : tuple of pairs
        Of these, those that did not keep their order.
    """

    name: str
    pairs: int
    apart: int
    changed: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        text = f"{self.name}: {self.apart} of {self.pairs} pairs apart in every run, "
        if not self.changed:
            return text + "all keep their order"
        return text + "order changed: " + "; ".join(" and ".join(pair) for pair in self.changed)


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


def chosen_rungs(study: Study, data: pathlib.Path = DATA) -> tuple[Setting, ...]:
    """Some of the study's rungs, evenly over their shipped times, as many as `MOST` and `BUDGET` allow."""
    path = data / f"{study.name}.csv"
    shipped = {row.setting: row.seconds for row in read_table(path, Row)[0] if row.timed} if path.exists() else {}
    known = sorted((s for s in study.settings if s.label in shipped), key=lambda s: shipped[s.label])
    for count in range(min(MOST, len(known)), 2, -1):
        picked = [known[round(k)] for k in np.linspace(0, len(known) - 1, count)]
        if sum(shipped[s.label] for s in picked) <= BUDGET:
            return tuple(picked)
    # the fastest, and the next one that is a third slower
    slower = [s for s in known[1:] if shipped[s.label] > 1.3 * shipped[known[0].label]]
    return tuple(known[:1] + (slower[:1] or known[1:2]))


def times_of(study: Study, settings: Sequence[Setting], repeats: int) -> dict[str, tuple[float, float]]:
    """Median and half the distance of the quartiles, timed in turns; the first run of every setting is not counted."""
    runs = {setting.label: study.scene.prepare(setting) for setting in settings}
    times: dict[str, list[float]] = {label: [] for label in runs}
    for turn in range(repeats + 1):
        for label, run in runs.items():
            seconds = run().seconds
            if turn > 0:
                times[label].append(seconds)
    quartiles = {label: np.quantile(found, (0.25, 0.5, 0.75)).tolist() for label, found in times.items()}
    return {label: (median, 0.5 * (high - low)) for label, (low, median, high) in quartiles.items()}


def _effect_times() -> Times:
    found = effects.measure_effects(CHECKED_EFFECTS, blocks=5, rounds=2, progress=lambda text: None)
    return {cost.what: (cost.seconds, cost.spread) for cost in found if cost.per == effects.EVALUATION}


def check(name: str, measure: Callable[[], Times], runs: int) -> OrderCheck:
    """Compare the times of several runs of ``measure``."""
    tables = [measure() for _ in range(runs)]
    count = len(tables[0])
    apart = pairs_apart(tables)
    return OrderCheck(
        name=name,
        pairs=count * (count - 1) // 2,
        apart=len(apart),
        changed=tuple(pair for pair, kept in apart.items() if not kept),
    )


def check_order(
    names: Sequence[str] | None = None, *, runs: int = 3, repeats: int = 5, progress: Progress = print
) -> list[OrderCheck]:
    """Time rungs of shipped studies in several runs and compare the order.

    Parameters
    ----------
    names : of `checkable`, or None for all
    runs : int
    repeats : int
        Timed runs per rung in each.
    progress : function
        Gets a line per study.
    """
    out = []
    makers = catalogue.full_catalogue()
    for name in checkable() if names is None else names:
        if name == EFFECTS:
            out.append(check(name, _effect_times, runs))
        else:
            study = makers[name]()
            settings = chosen_rungs(study)

            def measure(study: Study = study, settings: Sequence[Setting] = settings) -> Times:
                return times_of(study, settings, repeats)

            out.append(check(name, measure, runs))
        progress(str(out[-1]))
    return out


def checkable() -> list[str]:
    """Names of the studies that `check_order` can check."""
    return [EFFECTS, *catalogue.full_catalogue()]
