"""Films of accepted steps, kept while a run goes on; the memory they take is bounded."""

from __future__ import annotations

import math
from collections.abc import Callable

from exudyn_ehd.joint.model.fields import FilmFields
from exudyn_ehd.status import require_integer, require_number


class FilmRecorder:
    """Films at regular instants.

    Parameters
    ----------
    period : float
        Time between two films, s; 0 keeps every accepted step.
    frames : int
        Most films that are kept, at least 2. When they are full, every second one is dropped, and from then on only
        every second instant is kept: the films always span the whole run evenly.
    """

    def __init__(self, period: float, frames: int) -> None:
        where = "LubricatedJoint.record_films"
        self.period = require_number(f"{where}: period", period, "s", at_least=0.0)
        self.frames = require_integer(f"{where}: frames", frames, at_least=2)
        self.begin_anew()

    def begin_anew(self) -> None:
        """Drop all films."""
        self.films: list[FilmFields] = []
        self.stride, self.due = 1, -1
        self.first = self.last = math.nan

    def offer(self, time: float, take: Callable[[], FilmFields]) -> None:
        """Keep the film of an accepted step if its instant has come; time that runs back starts a new record."""
        if time == self.last:
            return
        if time < self.last:
            self.begin_anew()
        if math.isnan(self.first):
            self.first = time
        self.last = time
        # 1e-9: a step that ends a rounding before the instant is meant to be there
        due = math.floor((time - self.first) / self.period + 1e-9) if self.period > 0.0 else self.due + 1
        if due == self.due:
            return
        self.due = due
        if due % self.stride == 0 and len(self.films) == self.frames:
            self.films = self.films[::2]
            self.stride *= 2
        if due % self.stride == 0:
            self.films.append(take())
