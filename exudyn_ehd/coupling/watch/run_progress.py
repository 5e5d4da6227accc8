"""How far a run is, where somebody looks: steps per second, time left, the thinnest film so far."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.watch.solver_state import hooked
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.progress import Progress, is_shown


class Steps(Protocol):
    """What is asked of the record of a joint."""

    @property
    def thinnest(self) -> float:
        """The minimum film thickness of all its steps, m; nan before the first."""


class RunProgress:
    """Function after a step of Exudyn.

    Parameters
    ----------
    settings : exudyn.SimulationSettings
    films : sequence of pairs
        Names of the joints and their records.
    after_step : function or None
        The user's own, called first.
    """

    def __init__(
        self,
        settings: exu.SimulationSettings,
        films: Sequence[tuple[str, Steps]],
        after_step: Callable[[exu.MainSystem, float], object] | None,
    ) -> None:
        run = settings.timeIntegration
        self.films, self.after_step = films, after_step
        self.start, self.span = run.startTime, run.endTime - run.startTime
        self.line: Progress | None = None
        self.steps, self.last = 0, (0, 0.0)

    def __call__(self, mbs: exu.MainSystem, t: float) -> bool:
        """Whether the run goes on behind the step to ``t``."""
        goes_on = bool(self.after_step(mbs, t)) if self.after_step else True
        if self.line is None:
            # kernels are compiled before the first call, which is behind the initial state
            self.line, self.last = Progress("exudyn_ehd"), (0, time.perf_counter())
            return goes_on
        self.steps += 1
        if self.line.is_due:
            now = time.perf_counter()
            rate = (self.steps - self.last[0]) / (now - self.last[1])
            self.last = self.steps, now
            self.line.tell((t - self.start) / self.span, f", t = {t:.4g} s, {rate:.3g} steps/s{self._worst()}")
        return goes_on

    def close(self) -> None:
        """Take the line away."""
        if self.line is not None:
            self.line.close()

    def _worst(self) -> str:
        """The thinnest film, in words."""
        films = [(steps.thinnest, name) for name, steps in self.films]
        gap, name = min(((gap, name) for gap, name in films if np.isfinite(gap)), default=(np.nan, ""))
        return f", minimum film thickness {shown('length', gap)} in '{name}'" if name else ""


@contextmanager
def run_progress(
    mbs: exu.MainSystem, settings: exu.SimulationSettings, films: Sequence[tuple[str, Steps]]
) -> Iterator[None]:
    """Show the progress of the run within, unless Exudyn's own does; the user's function comes back then."""
    if not is_shown() or settings.timeIntegration.verboseMode > 0:
        yield
        return
    with hooked(mbs, "PostStep", lambda own: RunProgress(settings, films, own)) as progress:
        try:
            yield
        finally:
            progress.close()
