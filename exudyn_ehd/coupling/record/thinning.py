"""Numbers of recorded steps and their errors, and records that keep some of their steps, none of the worst ones.

A row that is settled, behind which others have come, carries two numbers more: which step it is, and the largest error
of a step since the row before. Errors are summed over all steps before any is dropped
(`exudyn_ehd.joint.step_error`).

To drop steps they are put into spans. Of each the last one is kept, and those with the thinnest film, the highest
pressure and the largest load across the axis: every row is an accepted step as it was, and the extremes of the rows
are those of the run.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable
from functools import partial
from typing import ClassVar, TypeAlias

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import (
    COLUMNS,
    FIRST_BLOCK,
    FORCE,
    LOAD,
    MINIMUM_GAP,
    PACK,
    PEAK_PRESSURE,
    STEP_COUNT,
    STEP_ERROR,
    TANGENT,
    TIME,
    WIDTH,
)
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.step_error import BLOCKS, FIRST, errors_behind, errors_of_ball
from exudyn_ehd.status import POSITIVE, ROUNDING, Checked, require_integer

Errors: TypeAlias = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Every(Checked):
    """``record`` of a joint: every n-th accepted step is kept, and the worst ones between them.

    Of each n successive steps the record keeps the last one and those with the smallest ``minimum_gap``, the largest
    ``peak_pressure`` and the largest load across the axis: up to four rows, 1.9 KB. So extremes over the record are
    those of the run, but means over its rows are not means of the run. ``step_count`` says which steps the rows are.

    `LubricatedJoint.audit`, `JointHistory.revolutions` and `UntilPeriodic` need all steps and do not accept such a
    record. After a restart the estimate ``step_error`` starts again.

    Parameters
    ----------
    steps : int
        The number n of steps of which up to four are kept, 2 or more.

    Examples
    --------
    >>> record = ehd.File(path="results/{name}.rows", every=ehd.Every(steps=20))
    """

    steps: int

    checks: ClassVar = {"steps": partial(require_integer, at_least=2)}

    def spans(self, count: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return the numbers of the spans of steps by ``count`` and time (n,): the initial state, ``steps`` each."""
        return np.ceil(count / self.steps)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Period(Checked):
    """``record`` of a joint: one step in every period of time is kept, and the worst ones between them; see `Every`.

    Parameters
    ----------
    seconds : float
        Duration of a period, s; periods end at the multiples of it.

    Examples
    --------
    >>> record = ehd.Period(seconds=1e-3)
    """

    seconds: float

    checks: ClassVar = {"seconds": partial(POSITIVE, unit="s")}

    def spans(self, count: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return the number of each step's span; spans end at multiples of ``seconds``."""
        return np.ceil(time / self.seconds - ROUNDING)


class Thinner:
    """Numbers the steps of a record with their errors, a few hundred rows at a time, and drops some by a rule.

    Parameters
    ----------
    rule : Every, Period or None
        None keeps all rows.
    errors : function
        Errors (n,) of the steps of rows (n, WIDTH) and the error of the pose behind them, for that before them.
    none : array
        Error of the pose at the beginning of a record.
    """

    def __init__(self, rule: Every | Period | None, errors: Errors, none: np.ndarray) -> None:
        self.rule, self._errors, self._none = rule, errors, none
        self.begin_anew()

    def begin_anew(self, last: np.ndarray | None = None) -> None:
        """Forget all rows; ``last`` (WIDTH + 2,): the first to come is this row once more."""
        self.count = 0 if last is None else int(last[STEP_COUNT])
        self._known_error = np.nan if last is None else float(last[STEP_ERROR])
        # what is kept so far of the span under way; the last rows as they came, and the pose's error there
        self._open, self._lead, self._error = np.empty((0, WIDTH + 2)), np.empty((0, WIDTH)), self._none

    def take(self, rows: np.ndarray) -> np.ndarray:
        """Add rows (n, WIDTH); returns those (k, WIDTH + 2) of the spans that have ended."""
        if not len(rows):
            return np.empty((0, WIDTH + 2))
        whole, numbered, error = self._number(rows)
        kept, begin = self._keep(numbered)
        self._open, self._error, self._known_error = kept[begin:], error, np.nan
        self._lead, self.count = whole[-FIRST:].copy(), self.count + len(rows)
        return kept[:begin]

    def look(self, rows: np.ndarray) -> np.ndarray:
        """Rows (k, WIDTH + 2) of the span under way and those behind it, if rows (n, WIDTH) were taken."""
        return self._keep(self._number(rows)[1])[0] if len(rows) else self._open

    def _number(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The last rows and these, these with their two numbers behind those kept of the span, error of the pose.

        Tangents that are not known are taken from the row before.
        """
        whole = np.concatenate([self._lead, rows])
        last = np.maximum.accumulate(np.where(np.isfinite(whole[:, FIRST_BLOCK]), np.arange(len(whole)), -1))
        whole[last >= 0, TANGENT] = whole[last[last >= 0], TANGENT]
        errors, error = self._errors(whole, self._error)
        errors = errors[len(self._lead) :]
        errors[0] = np.fmax(errors[0], self._known_error)
        count = self.count + np.arange(len(rows))
        return whole, np.concatenate([self._open, np.column_stack([rows, count, errors])]), error

    def _keep(self, rows: np.ndarray) -> tuple[np.ndarray, int]:
        """Return the rows (n, WIDTH + 2) that are kept, and the index among them at which the last span begins."""
        if self.rule is None:
            return rows, len(rows)
        spans = self.rule.spans(rows[:, STEP_COUNT], rows[:, TIME])
        edges = [0, *(np.flatnonzero(np.diff(spans)) + 1).tolist(), len(rows)]
        load = np.hypot(rows[:, FORCE.start], rows[:, FORCE.start + 1])
        kept = {0} if rows[0, STEP_COUNT] == 0 else set()
        for a, b in itertools.pairwise(edges):
            kept.add(b - 1)
            for values in (-rows[a:b, MINIMUM_GAP], rows[a:b, PEAK_PRESSURE], load[a:b]):
                if np.isfinite(values).any():
                    kept.add(a + int(np.nanargmax(values)))
        places = np.array(sorted(kept))
        out = rows[places]
        out[:, STEP_ERROR] = np.fmax.reduceat(rows[:, STEP_ERROR], np.concatenate([[0], places[:-1] + 1]))
        return out, int(np.searchsorted(places, edges[-2]))


def errors_of(bearing: JournalBearing, rows: np.ndarray, before: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Errors (n,) of the steps of a journal's rows (n, WIDTH), that of the pose behind them; see `errors_behind`."""
    motion, peak, deflection = rows[:, COLUMNS["motion"]], rows[:, COLUMNS["peak_angle"]], None
    if isinstance(getattr(bearing, "bush", None), ElasticLiner):
        size = rows[:, COLUMNS["bore_displacement"], None]
        deflection = size * np.stack((np.cos(peak), np.sin(peak)), axis=1)
    blocks, gap = rows[:, TANGENT].reshape(-1, *BLOCKS.shape), rows[:, MINIMUM_GAP]
    dimensions = bearing.radial_clearance, bearing.length
    return errors_behind(before, rows[:, TIME], motion, blocks, gap, *dimensions, deflection, rows[:, LOAD])


def errors_of_ball_in(bearing: SphericalBearing, rows: np.ndarray, before: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Errors (n,) of the steps of a ball's rows (n, WIDTH), and that of its place behind them; see `errors_of_ball`."""
    place, velocity, _ = np.split(rows[:, COLUMNS["motion"]][:, :9], 3, axis=1)
    known, gap, load = rows[:, PACK], rows[:, MINIMUM_GAP], rows[:, LOAD]
    return errors_of_ball(before, rows[:, TIME], place, velocity, known, gap, bearing.radial_clearance, load)
