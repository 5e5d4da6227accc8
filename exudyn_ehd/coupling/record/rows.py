"""Numbers and errors of recorded steps, and records that keep only some of their steps, among them the worst ones.

A settled row, which later rows follow, has two more numbers: the number of its step, and the largest error of a step
since the previous row. Errors are computed over all steps before any is dropped (`exudyn_ehd.joint.step_error`).

To drop steps, they are divided into spans. In each span these steps are kept: the last one, and those with the thinnest
film, the highest pressure and the largest load across the axis. So every row is an accepted step, and the extremes of
the rows are those of the run.

Rows on disk, of records that are too long for memory
-----------------------------------------------------
A file begins with a line of JSON that describes it, padded to `HEAD` bytes. Rows of doubles follow, in order. The file
can be read at any time, also after the program was killed: an incomplete last row is ignored.
"""

from __future__ import annotations

import bisect
import dataclasses
import itertools
import json
import os
import pathlib
import secrets
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, BinaryIO, ClassVar, NamedTuple

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import (
    COLUMNS,
    FORCE,
    LOAD,
    MINIMUM_GAP,
    PEAK_PRESSURE,
    SETTLED_WIDTH,
    STEP_COUNT,
    STEP_ERROR,
    TANGENT,
    TIME,
    WIDTH,
)
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.step_error import BALL, FIRST, JOURNAL, FilmLoad, errors_behind, no_error
from exudyn_ehd.status import POSITIVE, ROUNDING, Checked, InputError, RunError, require_integer, require_type
from exudyn_ehd.storage import require_path


@dataclasses.dataclass(frozen=True, kw_only=True)
class Every(Checked):
    """Option ``record`` of a joint: every n-th accepted step is kept, and the worst ones between them.

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
    """Option ``record`` of a joint: one step per period of time is kept, and the worst ones between them; see `Every`.

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
    """Numbering of the steps of a record, with their errors, a few hundred rows at a time, and dropping by a rule.

    Parameters
    ----------
    rule : Every, Period or None
        None keeps all rows.
    bearing : JournalBearing or SphericalBearing
    """

    def __init__(self, rule: Every | Period | None, bearing: JournalBearing) -> None:
        self.rule, self._bearing = rule, bearing
        self.begin_anew()

    def begin_anew(self, last: np.ndarray | None = None) -> None:
        """Forget all rows; ``last`` (SETTLED_WIDTH,): row that comes again as the next one."""
        self.count = 0 if last is None else int(last[STEP_COUNT])
        self._known_error = np.nan if last is None else float(last[STEP_ERROR])
        # rows kept so far of the present span; the last rows, and the error of the pose there
        self._open, self._lead = np.empty((0, SETTLED_WIDTH)), np.empty((0, WIDTH))
        self._error: Sequence[np.ndarray] = no_error(BALL if isinstance(self._bearing, SphericalBearing) else JOURNAL)

    def take(self, rows: np.ndarray) -> np.ndarray:
        """Add rows (n, WIDTH); return the rows (k, SETTLED_WIDTH) to be kept of finished spans."""
        if not len(rows):
            return np.empty((0, SETTLED_WIDTH))
        whole, numbered, error = self._number(rows)
        kept, begin = self._keep(numbered)
        self._open, self._error, self._known_error = kept[begin:], error, np.nan
        self._lead, self.count = whole[-FIRST:].copy(), self.count + len(rows)
        return kept[:begin]

    def look(self, rows: np.ndarray) -> np.ndarray:
        """Return the rows (k, SETTLED_WIDTH) of the present span and later ones, as if rows (n, WIDTH) were added."""
        return self._keep(self._number(rows)[1])[0] if len(rows) else self._open

    def _number(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, Sequence[np.ndarray]]:
        """The last rows and these, these with their two numbers behind those kept of the span, error of the pose.

        Tangents that are not known are taken from the row before.
        """
        whole = np.concatenate([self._lead, rows])
        last = np.maximum.accumulate(np.where(np.isfinite(whole[:, TANGENT.start]), np.arange(len(whole)), -1))
        whole[last >= 0, TANGENT] = whole[last[last >= 0], TANGENT]
        errors, error = errors_of(self._bearing, whole, self._error)
        errors = errors[len(self._lead) :]
        errors[0] = np.fmax(errors[0], self._known_error)
        count = self.count + np.arange(len(rows))
        return whole, np.concatenate([self._open, np.column_stack([rows, count, errors])]), error

    def _keep(self, rows: np.ndarray) -> tuple[np.ndarray, int]:
        """Return the rows (n, SETTLED_WIDTH) that are kept, and the index among them at which the last span begins."""
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


def errors_of(
    bearing: JournalBearing, rows: np.ndarray, before: Sequence[np.ndarray]
) -> tuple[np.ndarray, Sequence[np.ndarray]]:
    """Errors (n,) of the steps of rows (n, WIDTH) of a journal or a ball, and the error of the pose after them.

    See `errors_behind`.
    """
    parts, motion, peak, deflection = JOURNAL, rows[:, COLUMNS["motion"]], rows[:, COLUMNS["peak_angle"]], None
    if isinstance(bearing, SphericalBearing):
        # place, velocity, angular velocity and 0
        parts, motion = BALL, motion[:, [0, 1, 2, 9, 3, 4, 5, 9]]
    if isinstance(getattr(bearing, "bush", None), ElasticLiner):
        size = rows[:, COLUMNS["bore_displacement"], None]
        deflection = size * np.stack((np.cos(peak), np.sin(peak)), axis=1)
    dimensions, load = (bearing.radial_clearance, bearing.length), FilmLoad.of(rows[:, LOAD])
    states = rows[:, TIME], motion, rows[:, TANGENT], rows[:, MINIMUM_GAP]
    return errors_behind(parts, before, *states, *dimensions, deflection, load)


HEAD = 512
FORMAT = "exudyn_ehd rows 6"
# A settled row in a file.
ROW = np.dtype((float, SETTLED_WIDTH))
NAME = "{name}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class File:
    """Option ``record`` of a joint: accepted steps are written to a file, and only the last ones are in memory.

    A step takes 0.5 KB on disk. `load_history` reads the file, also during a run and after a run was killed. A history
    reads an array from the file when the array is first used, 8 bytes of memory per step and component. A new record of
    the joint replaces the file: to keep it, name another path or `JointHistory.save` it before the next run.

    Parameters
    ----------
    path : path
        Path of the file, one for each joint; "{name}" in it stands for the joint's name.
    every : Every, Period or None, default None
        Rule by which some of the steps are kept; None: all of them.

    Examples
    --------
    >>> record = ehd.File(path="results/{name}.rows")
    >>> record.of("main").as_posix()
    'results/main.rows'
    """

    path: str | pathlib.Path
    every: Every | Period | None = None

    def __post_init__(self) -> None:
        require_path("File", self.path)
        require_type("File.every", self.every, Every, Period, type(None))

    def of(self, name: str) -> pathlib.Path:
        """Path of the file of a joint.

        Parameters
        ----------
        name : str
            Name of the joint; characters that separate folders become ``_``.

        Returns
        -------
        pathlib.Path
        """
        plain = "".join("_" if letter in "/\\:" else letter for letter in name)
        return pathlib.Path(str(self.path).replace(NAME, plain))


class RowsOnDisk(NamedTuple):
    """Rows of a record in a file, which are read when they are used.

    Attributes
    ----------
    path : path
    joint : str
        Name of the joint, for messages.
    head : bytes
        Head of the file; empty without a file.
    settled : int
        Number of rows that will not be replaced.
    """

    path: pathlib.Path
    joint: str
    head: bytes = b""
    settled: int = 0

    def begin(self, known: Mapping[str, Any]) -> RowsOnDisk:
        """Begin a new file, with a head of data for readers; histories that read the old file keep it."""
        head = {"format": FORMAT, "record": secrets.token_hex(8), **known}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.unlink(missing_ok=True)
        new = RowsOnDisk(self.path, self.joint, (json.dumps(head).ljust(HEAD - 1) + "\n").encode())
        self.path.write_bytes(new.head)
        return new

    def add(self, rows: np.ndarray, number: int) -> RowsOnDisk:
        """Append rows (n, SETTLED_WIDTH); the next call may replace those after the first ``number``.

        Raises
        ------
        RunError
            If the file is another joint's by now.
        """
        with open(self.path, "r+b") as file:
            self._require_head(file)
            file.seek(HEAD + ROW.itemsize * self.settled)
            file.write(np.ascontiguousarray(rows).tobytes())
            file.truncate()
        return self._replace(settled=self.settled + number)

    def mapped(self) -> np.ndarray:
        """Memory map of the rows (n, SETTLED_WIDTH) of the file.

        Raises
        ------
        RunError
            If the file is another one by now.
        """
        if not self.settled:
            return np.empty((0, SETTLED_WIDTH))
        with open(self.path, "rb") as file:
            self._require_head(file)
        return np.memmap(self.path, dtype=float, mode="r", offset=HEAD, shape=(self.settled, SETTLED_WIDTH))

    def _require_head(self, file: BinaryIO) -> None:
        if file.read(HEAD) != self.head:
            raise RunError(
                f"LubricatedJoint '{self.joint}': another record has replaced the one in '{self.path}'; give every "
                f"joint a File(...) with a path of its own, or '{NAME}' in it, and read arrays of a history, or save "
                "it, before the next run."
            )


def read_head(path: str | pathlib.Path) -> dict[str, Any] | None:
    """Head of a file of `RowsOnDisk` of this version; None if it is something else."""
    with open(path, "rb") as file:
        try:
            head = json.loads(file.read(HEAD))
        except ValueError:
            return None
    return head if isinstance(head, dict) and head.get("format") == FORMAT else None


def require_own(path: pathlib.Path) -> None:
    """Raise `InputError` for a path of a file that is not a record."""
    if path.exists() and (not path.is_file() or (path.stat().st_size and read_head(path) is None)):
        raise InputError(
            f"CreateLubricatedJoint.record: '{path}' holds something else than a record and is not replaced; name "
            "another path in File(...)."
        )


def open_rows(path: str | pathlib.Path) -> RowsOnDisk:
    """Open the complete rows of a file of `RowsOnDisk`."""
    path = pathlib.Path(path).absolute()
    with open(path, "rb") as file:
        head = file.read(HEAD)
    return RowsOnDisk(path, path.name, head, (os.path.getsize(path) - HEAD) // ROW.itemsize)


def between(rows: np.ndarray, start: float, end: float) -> np.ndarray:
    """Copy of the rows from ``start`` to ``end``, s."""
    first, last = bisect.bisect_left(rows[:, TIME], start), bisect.bisect_right(rows[:, TIME], end)
    # one more on either side, for times that are meant to be the limits
    return np.array(rows[max(0, first - 1) : last + 1])
