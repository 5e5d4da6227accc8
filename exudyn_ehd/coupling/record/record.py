"""The rows of a joint's accepted steps: all of them in memory, or some of them, or the last ones with a file;
and back from files."""

from __future__ import annotations

import contextlib
import functools
import math
import pathlib
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.record.history import COLUMNS, DIMENSIONS, FORMAT, MINIMUM_GAP, TIME, WIDTH, JointHistory
from exudyn_ehd.coupling.record.on_disk import Rows, RowsOnDisk, open_rows, read_head, read_rows
from exudyn_ehd.coupling.record.thinning import STEP_COUNT, STEP_ERROR, Every, Period, Thinner, errors_of
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.step_error import FIRST, NO_ERROR
from exudyn_ehd.status import InputError, RunError
from exudyn_ehd.storage import require_path

# Rows in memory from which on they are thinned, or go to a file.
MOST_ROWS = 256


class Record:
    """Rows of accepted steps of a bearing, or the last ones behind what was kept of the others.

    Attributes
    ----------
    end : (k,) array or None
        Row of the last state, which no further step has brought.
    thinnest : float
        Minimum film thickness of all rows, m; infinite where no film has one.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self._dimensions: dict[str, Any] = {name: float(getattr(bearing, name)) for name in DIMENSIONS}
        self._lags = isinstance(getattr(bearing, "bush", None), ElasticLiner)
        self._rows: list[np.ndarray] = []
        self._thinner: Thinner | None = None
        self._disk: RowsOnDisk | None = None
        # rows that are settled, thinned ones in memory or restored ones on their way to the file
        self._kept: list[np.ndarray] = []
        self.thinnest = math.inf
        self.end: np.ndarray | None = None

    def thin(self, rule: Every | Period) -> None:
        """Drop rows by a rule from now on."""
        d = self._dimensions
        self._thinner = Thinner(rule, d["radial_clearance"], d["length"], self._lags)

    def keep_on_disk(self, path: pathlib.Path, joint: str) -> None:
        """Let all rows but the last ones go to a file of this joint."""
        head = {"width": self.width, "names": FORMAT, "lags": self._lags, **self._dimensions}
        self._disk = RowsOnDisk(path, joint, head)

    @property
    def width(self) -> int:
        """Number of values in a stored row."""
        return WIDTH if self._thinner is None else WIDTH + 2

    @property
    def is_thinned(self) -> bool:
        """Return whether rows are dropped."""
        return self._thinner is not None

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
        if self._thinner is not None:
            self._thinner.begin_anew()
        if self._disk is not None:
            self._disk.clear()

    def write(self, final: np.ndarray | None = None) -> None:
        """Bring the rows to the file, if there is one, with ``final`` behind them; the last one stays in memory too.

        Without a file drop those that a thinned record does not keep.
        """
        if (self._disk is None and self._thinner is None) or not self._rows:
            return
        rows, self._rows = np.array(self._rows), self._rows[-1:]
        self._kept.append(rows[:-1] if self._thinner is None else self._thinner.take(rows[:-1]))
        if self._disk is not None:
            whole = np.concatenate(self._kept)
            self._disk.add(np.concatenate([whole, self._behind(final)]), len(whole))
            self._kept = []

    def _behind(self, final: np.ndarray | None) -> np.ndarray:
        """Rows (n, width) of what is not settled, with ``final`` behind them."""
        rows = np.array(self._rows if final is None else [*self._rows, final]).reshape(-1, WIDTH)
        return rows if self._thinner is None else self._thinner.look(rows)

    def rows(self, final: np.ndarray | None) -> np.ndarray:
        """Copy of all rows (n, width), with ``final`` behind them if given and later."""
        final = None if final is None or not final[TIME] > self.last_time else final
        return self._all_rows(final).column(slice(None))

    def _all_rows(self, final: np.ndarray | None) -> Rows:
        """All rows, those of the file still there, with ``final`` behind them."""
        rows = np.concatenate([*self._kept, self._behind(final)])
        return Rows(rows) if self._disk is None else self._disk.rows(rows)

    def restore(self, rows: np.ndarray) -> None:
        """Begin with these rows (n, width)."""
        if rows.ndim != 2 or rows.shape[1] != self.width:
            kinds = "of a thinned record have two columns more; " if rows.shape[1:] in ((WIDTH,), (WIDTH + 2,)) else ""
            raise InputError(
                f"LubricatedJoint.restore_state: rows must be (n, {self.width}), got {rows.shape}; {kinds}create the "
                "joint with the record of the stored run."
            )
        self.clear()
        self._rows = list(rows[:, :WIDTH].copy())
        self.thinnest = float(np.fmin.reduce(rows[:, MINIMUM_GAP], initial=math.inf))
        if self._thinner is not None and self._rows:
            self._kept, self._rows = [rows[:-1].copy()], self._rows[-1:]
            self._thinner.begin_anew(rows[-1])

    @property
    def last_time(self) -> float:
        """Time of the last row, minus infinity if there is none."""
        return float(self._rows[-1][TIME]) if self._rows else -np.inf

    def snapshot(self, final: np.ndarray | None) -> JointHistory:
        """The record, with ``final`` as its last row if given: a copy, or what reads the file."""
        # where the file can't be written any more, the rows are still known
        with contextlib.suppress(RunError):
            self.write(final)
        return history_of(self._all_rows(final), self._dimensions, self._lags)


def history_of(rows: Rows, dimensions: Mapping[str, Any], lags: bool, first: int = 0) -> JointHistory:
    """A history that makes its columns of rows when they are asked for.

    ``lags``: the bearing is on a liner; ``first``: number of steps before the rows.
    """
    return JointHistory.of_columns(functools.partial(_column, rows, dimensions, lags, first), dimensions)


def _column(rows: Rows, dimensions: Mapping[str, Any], lags: bool, first: int, name: str) -> np.ndarray:
    is_numbered = rows.width > WIDTH
    if name == "step_count":
        return rows.column(STEP_COUNT).astype(np.int64) if is_numbered else first + np.arange(rows.total)
    if name == "step_error":
        return rows.column(STEP_ERROR) if is_numbered else _step_errors(rows, dimensions, lags)
    return rows.column(COLUMNS[name])


def _step_errors(rows: Rows, dimensions: Mapping[str, Any], lags: bool) -> np.ndarray:
    lead, before, found = np.empty((0, rows.width)), NO_ERROR, [np.empty(0)]
    for part in rows.parts():
        whole = np.concatenate([lead, part])
        errors, before = errors_of(whole, dimensions["radial_clearance"], dimensions["length"], lags, before)
        found.append(errors[len(lead) :])
        lead = whole[-FIRST:]
    return np.concatenate(found)


def load_history(path: str | pathlib.Path, *, start: float = -math.inf, end: float = math.inf) -> JointHistory:
    """Read what `JointHistory.save` has written, or the `File` of a record, as far as it has come.

    Parameters
    ----------
    path : path
    start, end : float
        s: the steps with ``start <= time <= end``, as `JointHistory.between`. Of a `File` no others are read but a
        thousand before them, from which the errors of the steps are summed up. Without both the history of a `File`
        reads each of its arrays when it is asked for.

    Returns
    -------
    JointHistory

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If it holds something else, or the start lies after the end.

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
        dimensions = {name: head[name] for name in DIMENSIONS}
        if start == -math.inf and end == math.inf:
            return history_of(open_rows(path, head["width"]), dimensions, head["lags"])
        first, rows = read_rows(path, head["width"], start, end)
        return history_of(Rows(rows), dimensions, head["lags"], first).between(start, end)
    try:
        with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as data:
            values = dict(data)
    except (zipfile.BadZipFile, ValueError, EOFError, TypeError, AttributeError):
        values = {}
    if str(values.pop("format", "")) != FORMAT:
        raise InputError(
            f"load_history: '{path}' holds no history of this version; give a file written by joint.save(...)."
        )
    fields: dict[str, Any] = {name: value if value.ndim else float(value) for name, value in values.items()}
    # files of before records could be thinned have all steps
    fields.setdefault("step_count", np.arange(fields["time"].size))
    return JointHistory(**fields).between(start, end)
