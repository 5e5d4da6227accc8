"""Rows of a record on disk, for runs whose records are too long for memory.

A file begins with a line of JSON that says what it is, padded to `HEAD` bytes; rows of doubles follow, each written
whole and in order. What is there can be read at any time, also after the program was killed: a row that was cut off
does not count.
"""

from __future__ import annotations

import bisect
import dataclasses
import json
import math
import os
import pathlib
import secrets
from collections.abc import Mapping
from typing import Any, BinaryIO, NamedTuple

import numpy as np

from exudyn_ehd.coupling.record.history import TIME, WIDTH
from exudyn_ehd.coupling.record.thinning import Every, Period
from exudyn_ehd.status import InputError, RunError, require_type
from exudyn_ehd.storage import require_path

HEAD = 512
FORMAT = "exudyn_ehd rows 4"
# Numbers in a row, and bytes.
WIDE = WIDTH + 2
BYTES = 8 * WIDE
NAME = "{name}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class File:
    """``record`` of `CreateLubricatedJoint`: accepted steps go to a file, and memory holds the last ones only.

    A step takes 0.5 KB on disk. `load_history` reads the file, during a run and after a kill as well. A history of it
    reads each of its arrays when it is asked for: 8 bytes a step and number. A new record of the joint replaces the
    file.

    Parameters
    ----------
    path : path
        Of a file of its own for each joint; "{name}" in it stands for the joint's name.
    every : Every, Period or None
        Keep some of the steps; None: all of them.

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
        """The path of a joint.

        Parameters
        ----------
        name : str
            Of the joint; characters that part folders become ``_``.

        Returns
        -------
        pathlib.Path
        """
        plain = "".join("_" if letter in "/\\:" else letter for letter in name)
        return pathlib.Path(str(self.path).replace(NAME, plain))


class RowsOnDisk:
    """The earlier rows of a record.

    Parameters
    ----------
    path : path
    joint : str
        Its name.
    head : dict
        What a reader has to know.
    """

    def __init__(self, path: pathlib.Path, joint: str, head: Mapping[str, Any]) -> None:
        self.path, self.joint, self.count = path, joint, 0
        if path.exists() and (not path.is_file() or (path.stat().st_size and read_head(path) is None)):
            raise InputError(
                f"CreateLubricatedJoint.record: '{path}' holds something else than a record and is not replaced; name "
                "another path in File(...)."
            )
        self._known, self._head = dict(head), b""

    def add(self, rows: np.ndarray, settled: int) -> None:
        """Write rows (n, k) behind the others; those after the ``settled`` first ones may be replaced by the next call.

        Raises
        ------
        RunError
            If they can't be written, or the file is another joint's by now.
        """
        try:
            if not self._head:
                self._begin()
            with open(self.path, "r+b") as file:
                _require_head(file, self._head, self.path, self.joint)
                file.seek(HEAD + BYTES * self.count)
                file.write(np.ascontiguousarray(rows).tobytes())
                file.truncate()
        except OSError as error:
            raise RunError(
                f"LubricatedJoint '{self.joint}': its record can't be written to '{self.path}' ({error.strerror}); "
                "make room there, or name another path in File(...)."
            ) from error
        self.count += settled

    def _begin(self) -> None:
        """A new file: who still reads the old one keeps it."""
        head = {"format": FORMAT, "record": secrets.token_hex(8), **self._known}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.unlink(missing_ok=True)
        self._head = (json.dumps(head).ljust(HEAD - 1) + "\n").encode()
        self.path.write_bytes(self._head)

    def rows(self, behind: np.ndarray) -> Rows:
        """Return all settled rows for reading, with others (n, k) behind them."""
        return Rows(behind, self.count, self.path, self.joint, self._head)

    def clear(self) -> None:
        """Begin anew at the next rows."""
        self.count, self._head = 0, b""


class Rows(NamedTuple):
    """Rows in memory, and before them those of a file as it was, read when they are asked for.

    Attributes
    ----------
    behind : (n, k) array
        Rows in memory.
    settled : int
        Rows in the file.
    path : path
    joint : str
        Whose they are, for messages.
    head : bytes
        Of the file.
    """

    behind: np.ndarray
    settled: int = 0
    path: pathlib.Path = pathlib.Path()
    joint: str = ""
    head: bytes = b""

    def column(self, where: int | slice) -> np.ndarray:
        """One column (n,), or several (n, k).

        Raises
        ------
        RunError
            If the file is another one by now.
        """
        return np.concatenate([self.mapped()[:, where], self.behind[:, where]])

    def mapped(self) -> np.ndarray:
        """Rows of the file, which are read where they are asked for."""
        if not self.settled:
            return self.behind[:0]
        with open(self.path, "rb") as file:
            _require_head(file, self.head, self.path, self.joint)
        return np.memmap(self.path, dtype=float, mode="r", offset=HEAD, shape=(self.settled, WIDE))


def _require_head(file: BinaryIO, head: bytes, path: pathlib.Path, joint: str) -> None:
    if file.read(HEAD) != head:
        raise RunError(
            f"LubricatedJoint '{joint}': another record has replaced the one in '{path}'; give every "
            f"joint a File(...) with a path of its own, or '{NAME}' in it, and read arrays of a history, or save it, "
            "before the next run."
        )


def read_head(path: str | pathlib.Path) -> dict[str, Any] | None:
    """Head of a file of `RowsOnDisk` of this version; None if it is something else."""
    with open(path, "rb") as file:
        try:
            head = json.loads(file.read(HEAD))
        except ValueError:
            return None
    return head if isinstance(head, dict) and head.get("format") == FORMAT else None


def open_rows(path: str | pathlib.Path, start: float, end: float) -> Rows:
    """The whole rows (n, WIDE) that a file of `RowsOnDisk` has by now, or those from ``start`` to ``end``, s."""
    path = pathlib.Path(path).absolute()
    with open(path, "rb") as file:
        head = file.read(HEAD)
    rows = Rows(np.empty((0, WIDE)), (os.path.getsize(path) - HEAD) // BYTES, path, path.name, head)
    if start == -math.inf and end == math.inf:
        return rows
    mapped = rows.mapped()
    # one more on either side, for times that are meant to be the limits
    first, last = bisect.bisect_left(mapped[:, TIME], start), bisect.bisect_right(mapped[:, TIME], end)
    return Rows(np.array(mapped[max(0, first - 1) : last + 1]))
