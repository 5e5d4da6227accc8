"""Record of a joint's accepted steps: rows in memory, all or some, or in a file; films, in a bounded amount of memory.

Histories are read back from files.
"""

from __future__ import annotations

import contextlib
import copy
import functools
import math
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import (
    COLUMNS,
    DIMENSIONS,
    FORMAT,
    MINIMUM_GAP,
    SETTLED_WIDTH,
    STEP_COUNT,
    TIME,
    WIDTH,
    JointHistory,
    has_gaps,
)
from exudyn_ehd.coupling.record.rows import (
    Every,
    Period,
    RowsOnDisk,
    Thinner,
    between,
    open_rows,
    read_head,
    require_own,
)
from exudyn_ehd.joint.model.results import FilmFields
from exudyn_ehd.status import ROUNDING, InputError, RunError, require_integer, require_number
from exudyn_ehd.storage import read_arrays, require_path

# Number of rows in memory from which on they are settled: numbered, and thinned or written to a file. Larger: more
# memory, fewer writes.
MOST_ROWS = 256


class Record:
    """Rows of accepted steps of a bearing.

    Parameters
    ----------
    bearing : JournalBearing or SphericalBearing

    Attributes
    ----------
    end : (k,) array or None
        Row of the last state, which is not the start of a further step.
    thinnest : float
        Minimum film thickness of all rows, m; infinite if no film has one.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self._dimensions: dict[str, Any] = {name: float(getattr(bearing, name)) for name in DIMENSIONS}
        self._bearing, self._thinner = bearing, Thinner(None, bearing)
        self._disk: RowsOnDisk | None = None
        # rows as they came, the last of which may be replaced; settled ones, thinned or on their way to the file
        self._rows: list[np.ndarray] = []
        self._kept: list[np.ndarray] = []
        self.thinnest = math.inf
        self.end: np.ndarray | None = None

    def thin(self, rule: Every | Period) -> None:
        """Drop rows by a rule, from the next row on."""
        self._thinner = Thinner(rule, self._bearing)

    def keep_on_disk(self, path: pathlib.Path, joint: str) -> None:
        """Write all rows except the last ones to a file of this joint, from the next row on."""
        require_own(path)
        self._disk = RowsOnDisk(path, joint)

    @property
    def path(self) -> pathlib.Path | None:
        """File of the rows; None if they stay in memory."""
        return None if self._disk is None else self._disk.path

    @property
    def is_thinned(self) -> bool:
        """Return whether rows are dropped."""
        return self._thinner.rule is not None

    def append(self, row: np.ndarray) -> None:
        """Add an accepted step; one at the time of the last replaces it, an earlier one starts a new record."""
        self.end = None
        if row[TIME] < self.last_time:
            self.clear()
        elif row[TIME] == self.last_time:
            self._rows.pop()
        if len(self._rows) >= MOST_ROWS:
            self.write()
        self._rows.append(row)
        if row[MINIMUM_GAP] < self.thinnest:
            self.thinnest = float(row[MINIMUM_GAP])

    def clear(self) -> None:
        """Begin a new record."""
        self._rows, self.thinnest, self._kept, self.end = [], math.inf, [], None
        self._thinner.begin_anew()
        if self._disk is not None:
            self._disk = RowsOnDisk(self._disk.path, self._disk.joint)

    def write(self, final: np.ndarray | None = None) -> None:
        """Settle all rows except the last one of a record that is thinned or in a file; a file also gets ``final``.

        Raises
        ------
        RunError
            If they can't be written.
        """
        if not self._rows or (self._disk is None and not self.is_thinned):
            return
        rows, self._rows = np.array(self._rows), self._rows[-1:]
        self._kept.append(self._thinner.take(rows[:-1]))
        if self._disk is None:
            return
        whole, disk = np.concatenate(self._kept), self._disk
        try:
            if not disk.head:
                self._disk = disk.begin({"names": FORMAT, **self._dimensions})
            self._disk = self._disk.add(np.concatenate([whole, self._thinner.look(self._pending(final))]), len(whole))
        except OSError as error:
            raise RunError(
                f"LubricatedJoint '{disk.joint}': its record can't be written to '{disk.path}' ({error.strerror}); "
                "make room there, or name another path in File(...)."
            ) from error
        self._kept = []

    def _pending(self, final: np.ndarray | None) -> np.ndarray:
        """Rows (n, WIDTH) that are not settled, followed by ``final``."""
        return np.array(self._rows if final is None else [*self._rows, final]).reshape(-1, WIDTH)

    def rows(self, final: np.ndarray | None) -> np.ndarray:
        """Copy of all rows (n, SETTLED_WIDTH), followed by ``final`` if it is given and later."""
        final = None if final is None or not final[TIME] > self.last_time else final
        earlier = [] if self._disk is None else [self._disk.mapped()]
        return np.concatenate([*earlier, *self._kept, self._thinner.look(self._pending(final))])

    def restore(self, rows: np.ndarray) -> None:
        """Begin a record with given rows (n, SETTLED_WIDTH), which for a record of all steps must be complete.

        After the rows of a thinned record, the estimate of errors starts again.
        """
        if rows.ndim != 2 or rows.shape[1] != SETTLED_WIDTH or (not self.is_thinned and has_gaps(rows[:, STEP_COUNT])):
            raise InputError(
                f"LubricatedJoint.restore_state: rows must be (n, {SETTLED_WIDTH}), got {rows.shape}, and those of a "
                "thinned record need a thinned one; create the joint with the record of the stored run."
            )
        self.clear()
        self.thinnest = float(np.fmin.reduce(rows[:, MINIMUM_GAP], initial=math.inf))
        if self.is_thinned and len(rows):
            self._kept, rows = [rows[:-1].copy()], rows[-1:]
            self._thinner.begin_anew(rows[0])
        self._rows = list(rows[:, :WIDTH].copy())

    @property
    def last_time(self) -> float:
        """Time of the last row, minus infinity if there is none."""
        return float(self._rows[-1][TIME]) if self._rows else -np.inf

    def snapshot(self, final: np.ndarray | None) -> JointHistory:
        """Return the record as a history, with ``final`` as its last row if given; it is a copy, or reads the file."""
        # if the file cannot be written any more, the rows in memory are still used
        if self._disk is not None:
            with contextlib.suppress(RunError):
                self.write(final)
        disk, kept, rows, is_thinned = self._disk, list(self._kept), self._pending(final), self.is_thinned
        # numbers and errors of the last steps are made when they are asked for
        numbered = functools.cache(functools.partial(copy.copy(self._thinner).look, rows))

        def parts(name: str) -> list[np.ndarray]:
            last = numbered() if is_thinned or name in ("step_error", "step_count") else rows
            return [*kept, last] if disk is None else [disk.mapped(), *kept, last]

        return history_of(parts, self._dimensions)


def history_of(parts: Callable[[str], Sequence[np.ndarray]], dimensions: Mapping[str, Any]) -> JointHistory:
    """Return a history that computes a column, from parts with rows (n, k), when it is first used."""

    def column(name: str) -> np.ndarray:
        values = np.concatenate([part[:, COLUMNS[name]] for part in parts(name)])
        return values.astype(np.int64) if name == "step_count" else values

    return JointHistory.of_columns(column, dimensions)


def load_history(path: str | pathlib.Path, *, start: float = -math.inf, end: float = math.inf) -> JointHistory:
    """Read a history from a file of `JointHistory.save`, or from the `File` of a record, during its run as well.

    Parameters
    ----------
    path : path
    start, end : float, default -inf, inf
        First and last time, s: the steps with ``start <= time <= end``, as `JointHistory.between`. Of a `File` only
        these steps are read; without ``start`` and ``end`` each array is read when it is first used.

    Returns
    -------
    JointHistory

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If the file holds something else, or ``start`` lies after ``end``.

    Examples
    --------
    After the example of `JointHistory`:

    >>> again = ehd.load_history("main.npz")
    >>> bool((again.force == history.force).all())
    True
    """
    require_path("load_history", path)
    head = read_head(path)
    if head is not None and head["names"] == FORMAT:
        rows, dimensions = open_rows(path), {name: head[name] for name in DIMENSIONS}
        if start == -math.inf and end == math.inf:
            return history_of(lambda _: [rows.mapped()], dimensions)
        part = between(rows.mapped(), start, end)
        return history_of(lambda _: [part], dimensions).between(start, end)
    if (values := read_arrays(path, FORMAT)) is None:
        raise InputError(
            f"load_history: '{path}' holds no history of this version; give a file written by joint.save(...)."
        )
    fields: dict[str, Any] = {name: value if value.ndim else float(value) for name, value in values.items()}
    return JointHistory(**fields).between(start, end)


class FilmRecorder:
    """Films at regular instants.

    Parameters
    ----------
    period : float
        Time between two films, s; 0 keeps every accepted step.
    frames : int
        Largest number of films, at least 2. When it is reached, every second film is dropped, and from then on only
        every second instant is kept. So the films always span the whole run evenly.
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
        # a step that ends before the instant by round-off counts as reaching it
        due = math.floor((time - self.first) / self.period + ROUNDING) if self.period > 0.0 else self.due + 1
        if due == self.due:
            return
        self.due = due
        if due % self.stride == 0 and len(self.films) == self.frames:
            self.films = self.films[::2]
            self.stride *= 2
        if due % self.stride == 0:
            self.films.append(take())
