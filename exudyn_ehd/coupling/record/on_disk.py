"""Rows of a record on disk, for runs whose records are too long for memory.

A file begins with a line of JSON that says what it is, padded to `HEAD` bytes; rows of doubles follow, each written
whole and in order. What is there can be read at any time, also after the program was killed: a row that was cut off
does not count.
"""

from __future__ import annotations

import bisect
import dataclasses
import json
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
FORMAT = "exudyn_ehd rows 5"
# Numbers in a row, and bytes.
WIDE = WIDTH + 2
BYTES = 8 * WIDE
NAME = "{name}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class File:
    """``record`` of a joint: accepted steps go to a file, and memory holds the last ones only.

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
    """Rows of a record in a file as they were, read when they are asked for.

    Attributes
    ----------
    path : path
    joint : str
        Whose they are, for messages.
    head : bytes
        Of the file; empty as long as there is none.
    settled : int
        Rows that no others will replace.
    """

    path: pathlib.Path
    joint: str
    head: bytes = b""
    settled: int = 0

    def begin(self, known: Mapping[str, Any]) -> RowsOnDisk:
        """Begin a new file, with a head that says what a reader has to know: who still reads the old one keeps it."""
        head = {"format": FORMAT, "record": secrets.token_hex(8), **known}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.unlink(missing_ok=True)
        new = RowsOnDisk(self.path, self.joint, (json.dumps(head).ljust(HEAD - 1) + "\n").encode())
        self.path.write_bytes(new.head)
        return new

    def add(self, rows: np.ndarray, number: int) -> RowsOnDisk:
        """Write rows (n, WIDE) behind the others; those after the first ``number`` may be replaced by the next.

        Raises
        ------
        RunError
            If the file is another joint's by now.
        """
        with open(self.path, "r+b") as file:
            self._require_head(file)
            file.seek(HEAD + BYTES * self.settled)
            file.write(np.ascontiguousarray(rows).tobytes())
            file.truncate()
        return self._replace(settled=self.settled + number)

    def mapped(self) -> np.ndarray:
        """Rows (n, WIDE) of the file, which are read where they are asked for.

        Raises
        ------
        RunError
            If the file is another one by now.
        """
        if not self.settled:
            return np.empty((0, WIDE))
        with open(self.path, "rb") as file:
            self._require_head(file)
        return np.memmap(self.path, dtype=float, mode="r", offset=HEAD, shape=(self.settled, WIDE))

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
    """Refuse a path that holds something else than a record."""
    if path.exists() and (not path.is_file() or (path.stat().st_size and read_head(path) is None)):
        raise InputError(
            f"CreateLubricatedJoint.record: '{path}' holds something else than a record and is not replaced; name "
            "another path in File(...)."
        )


def open_rows(path: str | pathlib.Path) -> RowsOnDisk:
    """Open the whole rows that a file of `RowsOnDisk` has by now."""
    path = pathlib.Path(path).absolute()
    with open(path, "rb") as file:
        head = file.read(HEAD)
    return RowsOnDisk(path, path.name, head, (os.path.getsize(path) - HEAD) // BYTES)


def between(rows: np.ndarray, start: float, end: float) -> np.ndarray:
    """Copy of the rows from ``start`` to ``end``, s."""
    first, last = bisect.bisect_left(rows[:, TIME], start), bisect.bisect_right(rows[:, TIME], end)
    # one more on either side, for times that are meant to be the limits
    return np.array(rows[max(0, first - 1) : last + 1])
