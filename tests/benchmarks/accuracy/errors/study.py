"""A study: scene + ladder of settings + references -> table of errors and times.

Errors are told apart by what they are measured against. Every model that a study names may have a reference: three
settings finer than the finest rung of that model, from which `converged` estimates the reference's own error. The first
reference is that of the scene's dearest model; a rung's ``error`` is measured against it and holds what its model
leaves out, its ``own_error`` against its own model's reference and holds the discretisation alone.

Times are processor time of one thread. The first run of a setting is apart (compilation); then all settings run in
turns, so that a disturbance of the machine meets them alike, and the median counts with the quartiles as spread.
References are not timed and run side by side.
"""

from __future__ import annotations

import math
import os
import platform
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_ehd.status import EHDError, InputError, require_integer
from exudyn_ehd.studies.film_errors import Converged, converged
from tests.benchmarks.accuracy.scenes.setting import Outcome, QuantityOfInterest, Scene, Setting
from tests.benchmarks.accuracy.table import Row

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Reference:
    """Converged solution of one model.

    Parameters
    ----------
    model : str
        As in `Setting.model`.
    levels : three Settings
        Coarse to fine; the finest is the reference.
    ratio : float
        Refinement from level to level.
    formal_order : float
        Of the scheme.
    """

    model: str
    levels: tuple[Setting, Setting, Setting]
    ratio: float
    formal_order: float = 2.0


@dataclass(frozen=True, kw_only=True)
class Study:
    """Scene, ladder and references.

    Parameters
    ----------
    name : str
        Of the table's file.
    title : str
    scene : Scene
    settings : tuple of Setting
        The ladder; labels are unique.
    references : tuple of Reference
        The dearest model first.
    quantities : tuple of str
        Names of the scene's quantities that this ladder is about; empty: all.
    """

    name: str
    title: str
    scene: Scene
    settings: tuple[Setting, ...]
    references: tuple[Reference, ...]
    quantities: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        labels = [s.label for s in self.settings]
        if len(set(labels)) != len(labels) or not labels:
            raise InputError(f"Study.settings must be some with unique labels, got {labels}.")
        if not self.references:
            raise InputError("Study.references must hold at least that of the dearest model.")
        known = {q.name for q in self.scene.quantities}
        unknown = set(self.quantities) - known
        if unknown:
            raise InputError(f"Study.quantities must be among {sorted(known)}, got {sorted(unknown)}.")

    @property
    def measured(self) -> tuple[QuantityOfInterest, ...]:
        """The scene's quantities that count here."""
        return tuple(q for q in self.scene.quantities if not self.quantities or q.name in self.quantities)


@dataclass
class _Measured:
    """Results and times of one setting, as far as they have been measured."""

    outcome: Outcome | None = None
    run: Callable[[], Outcome] | None = None
    setup: float = math.nan
    cold: float = math.nan
    warm: float = math.nan
    seconds: tuple[float, ...] = ()
    failure: str = ""


def run_study(
    study: Study,
    *,
    repeats: int = 7,
    budget: float = math.inf,
    processes: int = 1,
    reference_processes: int = 1,
    progress: Progress | None = print,
) -> list[Row]:
    """Compute a study's table.

    Parameters
    ----------
    study : Study
    repeats : int
        Timed runs per setting.
    budget : float
        Processor time in s after which a setting that has run three times is not repeated further.
    processes : int
        More than 1: settings run side by side through Exudyn's `ParameterVariation`; errors are the same, times are not
        measured.
    reference_processes : int
        How many of the references' settings run side by side, after the timed ones.
    progress : function or None
        Gets a line per step.

    Returns
    -------
    list of Row

    Raises
    ------
    EHDError
        If a reference can't be computed; a rung that fails is recorded with its message instead.
    """
    require_integer("run_study: repeats", repeats, at_least=1)
    require_integer("run_study: processes", processes, at_least=1)
    require_integer("run_study: reference_processes", reference_processes, at_least=1)
    references = [s for reference in study.references for s in reference.levels]
    say = progress if progress is not None else (lambda text: None)
    if processes > 1:
        rungs = [_Measured(outcome=o, failure=f) for o, f in _in_parallel(study, study.settings, processes)]
    else:
        rungs = [_first(study, setting, say) for setting in study.settings]
        _repeat(rungs, repeats, budget, say)
    workers = max(processes, reference_processes)
    if workers > 1:
        say(f"{study.name}: {len(references)} settings of references, {workers} side by side")
        levels = _in_parallel(study, references, workers)
    else:
        levels = [_attempt(study, setting, say) for setting in references]
    found = _references(study, levels)
    return [
        row for setting, rung in zip(study.settings, rungs, strict=True) for row in _rows(study, setting, rung, found)
    ]


def _attempt(study: Study, setting: Setting, say: Progress) -> tuple[Outcome | None, str]:
    say(f"{study.name}: reference, {setting.label}")
    return compute(study, setting)


def compute(study: Study, setting: Setting) -> tuple[Outcome | None, str]:
    """Outcome of one setting, or None and what went wrong."""
    try:
        return study.scene.prepare(setting)(), ""
    except (EHDError, ValueError, RuntimeError) as error:
        return None, _first_line(error)


def _first_line(error: BaseException) -> str:
    cause = error.__cause__ if error.__cause__ is not None else error
    text = str(cause).strip() or traceback.format_exception_only(cause)[-1].strip()
    return f"{type(cause).__name__}: {text.splitlines()[0]}"[:160]


def _first(study: Study, setting: Setting, say: Progress) -> _Measured:
    """Compile and build a setting and run it once."""
    say(f"{study.name}: {setting.label}")
    measured = _Measured()
    try:
        start = time.process_time()
        measured.outcome = study.scene.prepare(setting)()
        measured.cold = time.process_time() - start
        start = time.process_time()
        measured.run = study.scene.prepare(setting)
        measured.setup = time.process_time() - start
    except (EHDError, ValueError, RuntimeError) as error:
        measured.failure = _first_line(error)
    return measured


def _repeat(rungs: Sequence[_Measured], repeats: int, budget: float, say: Progress) -> None:
    """Timed runs in turns."""
    spent = [0.0] * len(rungs)
    for round_ in range(repeats):
        say(f"  timed round {round_ + 1} of {repeats}")
        for k, rung in enumerate(rungs):
            if rung.run is None or rung.failure or (round_ >= 3 and spent[k] > budget):
                continue
            start = time.process_time()
            rung.seconds += (rung.run().seconds,)
            taken = time.process_time() - start
            rung.warm = taken if round_ == 0 else min(rung.warm, taken)
            spent[k] += taken


def _in_parallel(study: Study, settings: Sequence[Setting], processes: int) -> list[tuple[Outcome | None, str]]:
    """Outcomes of settings, side by side."""
    from exudyn.processing import ParameterVariation

    _, values = ParameterVariation(
        _one_of,
        {"index": list(range(len(settings)))},
        useMultiProcessing=True,
        numberOfThreads=processes,
        showProgress=False,
        parameterFunctionData={"study": study, "settings": settings},
    )
    return list(values)


def _one_of(parameters: dict[str, Any]) -> tuple[Outcome | None, str]:
    data = parameters["functionData"]
    return compute(data["study"], data["settings"][int(parameters["index"])])


def _references(
    study: Study, levels: Sequence[tuple[Outcome | None, str]]
) -> list[tuple[Reference, dict[str, Converged]]]:
    out = []
    for k, reference in enumerate(study.references):
        outcomes = []
        for (outcome, failure), setting in zip(levels[3 * k : 3 * k + 3], reference.levels, strict=True):
            if outcome is None:
                raise EHDError(
                    f"study {study.name}: the reference {reference.model}, {setting.label}, failed: {failure}"
                )
            outcomes.append(outcome)
        values = {
            q.name: converged(
                [o.values[q.name] for o in outcomes],
                ratio=reference.ratio,
                formal_order=reference.formal_order,
                scale=q.scale_of(outcomes[-1].values[q.name]),
            )
            for q in study.measured
            if all(q.name in o.values for o in outcomes)
        }
        out.append((reference, values))
    return out


def _rows(
    study: Study, setting: Setting, rung: _Measured, references: Sequence[tuple[Reference, dict[str, Converged]]]
) -> list[Row]:
    times: dict[str, Any] = {"setup": rung.setup, "compile": max(rung.cold - rung.setup - rung.warm, 0.0)}
    if rung.seconds:
        low, median, high = np.quantile(rung.seconds, (0.25, 0.5, 0.75)).tolist()
        times |= {"seconds": median, "low": low, "high": high}
    truth, best = references[0]
    own = next((values for reference, values in references if reference.model == setting.model), {})
    rows = []
    for q in study.measured:
        head: dict[str, Any] = {
            "study": study.name,
            "setting": setting.label,
            "family": setting.family,
            "model": setting.model,
            "quantity": q.name,
            "unit": q.unit,
            "reference": truth.model,
        }
        if rung.outcome is None:
            rows.append(Row(**head, failure=rung.failure))
            continue
        if q.name not in rung.outcome.values or q.name not in best:
            continue
        value = np.asarray(rung.outcome.values[q.name])
        head |= times | {
            "value": float(np.max(np.abs(value))),
            "newton": rung.outcome.newton,
            "films": rung.outcome.films,
            "error": q.distance(value, best[q.name].value),
            "reference_error": best[q.name].error,
        }
        if q.name in own:
            head |= {"own_error": q.distance(value, own[q.name].value), "own_reference_error": own[q.name].error}
        rows.append(Row(**head))
    return rows


def machine() -> str:
    """Cores and clock of this machine."""
    clock = ""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            mhz = [float(line.split(":")[1]) for line in file if line.startswith("cpu MHz")]
        clock = f" at {max(mhz) / 1e3:.1f} GHz" if mhz else ""
    except OSError:
        clock = f", {platform.machine()}"
    return f"{os.cpu_count()} cores{clock}, one thread used"
